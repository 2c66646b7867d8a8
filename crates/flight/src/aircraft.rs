//! The aircraft as data: mass, rigid aerodynamics, engines, elastic part, sensors.

use crate::Error;
use crate::aerodynamics::RigidAerodynamics;
use crate::sensor::Sensor;
use albatross_numerics::Mat;
use albatross_strip::quasi_steady::ReferenceDimensions;
use albatross_strip::{AeroelasticModel, GeneralizedForces};

/// Everything that stays constant while the aircraft flies. Body axes: x forward, y right, z down, origin at the
/// centre of gravity.
#[derive(Debug, Clone)]
pub struct Aircraft {
    /// Mass \[kg\].
    pub mass: f64,
    /// Inertia tensor about the centre of gravity, body axes \[kg m²\].
    pub inertia: [[f64; 3]; 3],
    /// Acceleration of gravity \[m/s²\].
    pub gravity: f64,
    /// Reference area, chord and span.
    pub reference: ReferenceDimensions,
    /// Names of the controls, in the order of every array of controls.
    pub controls: Vec<String>,
    /// Coefficients of the rigid aircraft about the centre of gravity.
    pub rigid: RigidAerodynamics,
    /// Engines that share the one thrust input.
    pub engines: Vec<Engine>,
    /// Modes and strips; none for a rigid aircraft.
    pub elastic: Option<ElasticPart>,
    /// Outputs.
    pub sensors: Vec<Sensor>,
}

/// One engine. Its thrust is a share of the thrust input.
#[derive(Debug, Clone, PartialEq)]
pub struct Engine {
    /// Share of the total thrust.
    pub share: f64,
    /// Where the thrust acts, body axes from the centre of gravity \[m\].
    pub position: [f64; 3],
    /// Unit vector of the thrust, body axes.
    pub direction: [f64; 3],
    /// Displacement of the engine along the thrust per unit of each mode; empty if the thrust does no work on modes.
    pub modal_work: Vec<f64>,
}

impl Engine {
    /// All thrust along body x through the centre of gravity, doing no work on the modes.
    pub fn through_cg() -> Self {
        Self {
            share: 1.0,
            position: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
            modal_work: Vec::new(),
        }
    }
}

/// The elastic part: Eq. 10 and the rows of Eqs. 7 and 8.
#[derive(Debug, Clone)]
pub struct ElasticPart {
    /// Structure, strips, shapes, lags and the generalised forces of the modes on themselves.
    pub model: AeroelasticModel,
    /// The same sums on rigid-body test shapes: body forces and moments, 6 x modes.
    pub rigid_rows: GeneralizedForces,
    /// `Q_X` for `[alpha, beta, p_hat, q_hat, r_hat]`, modes x 5.
    pub q_x: Mat<f64>,
    /// `Q_u` for the controls, modes x controls.
    pub q_u: Mat<f64>,
    /// `Q_0`, the load at zero variables, one per mode.
    pub q_0: Vec<f64>,
    /// Incidence that a control's lift is worth on each strip, `c_l,delta / c_l,alpha`; strips x controls.
    pub control_incidence: Mat<f64>,
}

/// How the air follows the elastic motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fidelity {
    /// Lag states and apparent mass.
    #[default]
    Unsteady,
    /// Circulation without lag, no apparent mass.
    QuasiSteady,
    /// No modes.
    Rigid,
}

/// How a control's lift on the strips builds up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControlAerodynamics {
    /// At once: the paper's choice, which it names as a cause of too large peaks.
    #[default]
    QuasiSteady,
    /// Through the strips' own Wagner states.
    Lagged,
}

/// The shape from which the modes' amplitudes are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShapeReference {
    /// The unloaded (jig) shape: the modes carry the whole load, `eta` is not zero in trim.
    Jig,
    /// The trimmed flight shape: aerodynamic data describe it already, `eta = 0` in trim.
    #[default]
    Trimmed,
}

/// How attitude is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Attitude {
    /// Euler angles phi, theta, psi (3-2-1); singular at theta = 90 deg.
    #[default]
    Euler,
    /// Unit quaternion with scalar part first.
    Quaternion,
}

/// Choices of the model that a flight point is evaluated with.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModelOptions {
    /// How the air follows the elastic motion.
    pub fidelity: Fidelity,
    /// How a control's lift on the strips builds up.
    pub control_aerodynamics: ControlAerodynamics,
    /// The shape from which the modes' amplitudes are counted.
    pub shape_reference: ShapeReference,
    /// How attitude is kept.
    pub attitude: Attitude,
    /// Whether the horizontal position is a state.
    pub position: bool,
}

impl Aircraft {
    /// Index of a control.
    ///
    /// # Errors
    /// [`Error::UnknownControl`] with the names there are.
    pub fn control_index(&self, name: &str) -> Result<usize, Error> {
        self.controls
            .iter()
            .position(|c| c == name)
            .ok_or_else(|| Error::UnknownControl {
                name: name.to_owned(),
                known: self.controls.join(", "),
            })
    }
}
