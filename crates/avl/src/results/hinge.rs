//! Hinge moments (`.hm`).

use serde::{Deserialize, Serialize};

use super::AxisOrientation;

/// Content of an `.hm` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HingeMoments {
    /// Axes; MRF only.
    pub axes: Option<AxisOrientation>,
    /// Reference area.
    pub s_ref: f64,
    /// Reference chord.
    pub c_ref: f64,
    /// One entry per control, in AVL's order.
    pub controls: Vec<HingeMoment>,
}

/// Hinge moment of one control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HingeMoment {
    /// Name, up to 16 characters.
    pub name: String,
    /// Hinge moment over `q Sref Cref`.
    pub c_hinge: f64,
    /// Deflection in degrees (times gain); AVL 3.5x.
    pub deflection_deg: Option<f64>,
    /// Moment in N m, when the run case has density and speed; AVL 3.5x.
    pub moment_n_m: Option<f64>,
}
