//! Run-case file (`.run`).

use serde::{Deserialize, Serialize};

/// Content of a `.run` file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFile {
    /// Run cases, in the order of the file.
    pub cases: Vec<RunCase>,
}

/// One run case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunCase {
    /// Number after `Run case`.
    pub index: usize,
    /// Text after the colon.
    pub title: String,
    /// `variable -> constraint = value`, in the order of the file.
    pub constraints: Vec<Constraint>,
    /// `name = value unit`, in the order of the file.
    pub parameters: Vec<ParameterValue>,
}

/// What one variable is driven by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Constraint {
    /// `alpha`, `beta`, `pb/2V`, `qc/2V`, `rb/2V` or a control's name.
    pub variable: String,
    /// A variable's name, `CL`, `CY`, `Cl roll mom`, `Cm pitchmom` or `Cn yaw  mom`.
    pub target: String,
    /// Value of the target: degrees for angles and controls.
    pub value: f64,
}

/// One parameter of a run case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterValue {
    /// Which.
    pub parameter: Parameter,
    /// Value, in the unit printed after it.
    pub value: f64,
    /// Unit as printed; may be empty.
    pub unit: String,
}

/// The parameters of a run case, in AVL's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum Parameter {
    Alpha,
    Beta,
    RollRate,
    PitchRate,
    YawRate,
    Lift,
    ProfileDrag,
    Bank,
    Elevation,
    Heading,
    Mach,
    Velocity,
    Density,
    Gravity,
    TurnRadius,
    LoadFactor,
    XCg,
    YCg,
    ZCg,
    Mass,
    Ixx,
    Iyy,
    Izz,
    Ixy,
    Iyz,
    Izx,
    ViscClAlpha,
    ViscClSpeed,
    ViscCmAlpha,
    ViscCmSpeed,
}
