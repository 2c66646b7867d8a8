//! Forces of each body (`.fb`).

use serde::{Deserialize, Serialize};

use super::{AxisOrientation, Reference};

/// Content of an `.fb` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyForces {
    /// Axes of the moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Bodies, mirror images included.
    pub bodies: Vec<BodyForce>,
}

/// Forces of one body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyForce {
    /// Number, from 1.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Length.
    pub length: f64,
    /// Surface area.
    pub area: f64,
    /// Volume.
    pub volume: f64,
    /// Lift over `q Sref`.
    pub c_lift: f64,
    /// Drag over `q Sref`.
    pub c_drag: f64,
    /// Pitching moment over `q Sref Cref`.
    pub c_m: f64,
    /// Side force over `q Sref`.
    pub c_y: f64,
    /// Yawing moment over `q Sref Bref`.
    pub c_n: f64,
    /// Rolling moment over `q Sref Bref`.
    pub c_roll: f64,
}
