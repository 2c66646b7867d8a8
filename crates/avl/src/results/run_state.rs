//! Flight condition and total forces: the `.ft` file, and the head of `.st` and `.sb`.

use serde::{Deserialize, Serialize};

use super::AxisOrientation;

/// The content of an `.ft` file is exactly the run state.
pub type TotalForces = RunState;

/// Reference area, lengths and moment point, in the geometry file's unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Reference area.
    pub s_ref: f64,
    /// Reference chord.
    pub c_ref: f64,
    /// Reference span.
    pub b_ref: f64,
    /// Moment reference point, x aft.
    pub x_ref: f64,
    /// Moment reference point, y right.
    pub y_ref: f64,
    /// Moment reference point, z up.
    pub z_ref: f64,
}

/// A name and a number, as in `elevator = -0.01128`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedValue {
    /// Name, up to 16 characters.
    pub name: String,
    /// Value: degrees times the control's gain for controls, design units for design variables.
    pub value: f64,
}

/// Flight condition, total forces and control deflections of one AVL solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// Title of the geometry file (`Configuration:`).
    pub title: String,
    /// Number of surfaces, mirror images included.
    pub n_surfaces: usize,
    /// Number of strips.
    pub n_strips: usize,
    /// Number of vortices.
    pub n_vortices: usize,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Axes of the x and z forces, of the roll and yaw moments and of the rates.
    pub axes: AxisOrientation,
    /// Title of the run case.
    pub run_case: String,
    /// Angle of attack, in degrees.
    pub alpha_deg: f64,
    /// Sideslip, in degrees.
    pub beta_deg: f64,
    /// Mach number; the text layout prints 3 decimals.
    pub mach: f64,
    /// Roll rate `p b / 2V` in body axes.
    pub pb_2v: f64,
    /// Pitch rate `q c / 2V`.
    pub qc_2v: f64,
    /// Yaw rate `r b / 2V` in body axes.
    pub rb_2v: f64,
    /// Roll rate `p' b / 2V` in stability axes.
    pub pb_2v_stability: f64,
    /// Yaw rate `r' b / 2V` in stability axes.
    pub rb_2v_stability: f64,
    /// x force coefficient (`CXtot`).
    pub c_x: f64,
    /// y force coefficient (`CYtot`).
    pub c_y: f64,
    /// z force coefficient (`CZtot`).
    pub c_z: f64,
    /// Rolling moment coefficient (`Cltot`), body axes.
    pub c_roll: f64,
    /// Pitching moment coefficient (`Cmtot`).
    pub c_m: f64,
    /// Yawing moment coefficient (`Cntot`), body axes.
    pub c_n: f64,
    /// Rolling moment coefficient in stability axes (`Cl'tot`).
    pub c_roll_stability: f64,
    /// Yawing moment coefficient in stability axes (`Cn'tot`).
    pub c_n_stability: f64,
    /// Lift coefficient (`CLtot`).
    pub c_lift: f64,
    /// Drag coefficient (`CDtot`).
    pub c_drag: f64,
    /// Profile drag (`CDvis`).
    pub c_drag_viscous: f64,
    /// Induced drag from surface integration (`CDind`).
    pub c_drag_induced: f64,
    /// Lift in the Trefftz plane (`CLff`).
    pub c_lift_trefftz: f64,
    /// Induced drag in the Trefftz plane (`CDff`).
    pub c_drag_trefftz: f64,
    /// Side force in the Trefftz plane (`CYff`).
    pub c_y_trefftz: f64,
    /// Span efficiency (`e`).
    pub span_efficiency: f64,
    /// Control variables in AVL's order (d01, d02, ...), in degrees per unit gain.
    pub controls: Vec<NamedValue>,
    /// Design variables in AVL's order (g01, ...).
    pub designs: Vec<NamedValue>,
}

impl RunState {
    /// Value of the control variable of this name (degrees where the gain is 1).
    pub fn control(&self, name: &str) -> Option<f64> {
        self.controls.iter().find(|c| c.name == name).map(|c| c.value)
    }
}
