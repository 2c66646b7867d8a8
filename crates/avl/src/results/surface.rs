//! Forces of each surface (`.fn`).

use serde::{Deserialize, Serialize};

use super::{AxisOrientation, Reference};

/// Content of an `.fn` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceForces {
    /// Axes of the moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<SurfaceForce>,
}

/// Forces of one surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceForce {
    /// Number, from 1.
    pub index: usize,
    /// Name; mirror images end in ` (YDUP)`.
    pub name: String,
    /// Area.
    pub area: f64,
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
    /// Induced drag over `q Sref`.
    pub c_drag_induced: f64,
    /// Profile drag over `q Sref`.
    pub c_drag_viscous: f64,
    /// Average chord.
    pub average_chord: f64,
    /// Lift over `q` times the surface's own area.
    pub cl_local: f64,
    /// Drag over `q` times the surface's own area.
    pub cd_local: f64,
    /// Profile drag over `q` times the surface's own area.
    pub cdv_local: f64,
    /// Moment about the leading edge; AVL up to 3.35 only.
    pub cm_le_local: Option<f64>,
}
