//! Points and coordinate systems: GRID, GRDSET, SPOINT and the six CORDij cards.

use serde::{Deserialize, Serialize};

use super::{Components, Id};

/// A geometric point (GRID).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Grid {
    /// Point number.
    pub id: Id,
    /// Coordinate system of [`position`](Self::position); 0 is the basic system.
    pub cp: Id,
    /// Coordinates in system `cp`: (x, y, z), (r, theta in degrees, z) or (rho, theta in degrees, phi in
    /// degrees). Resolve chains of systems with [`Frames`](crate::frames::Frames).
    pub position: [f64; 3],
    /// Coordinate system of displacements, constraints and printed eigenvectors; 0 is the basic system.
    pub cd: Id,
    /// A fluid point (CD = -1), which has a pressure and no displacement.
    pub fluid: bool,
    /// Permanent single-point constraints.
    pub ps: Components,
    /// Superelement number; 0 is the residual structure.
    pub seid: Id,
}

/// Defaults for blank fields of GRID (GRDSET). The reader has already applied them to [`Grid`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Grdset {
    /// Default position system.
    pub cp: Id,
    /// Default displacement system.
    pub cd: Id,
    /// Default constraints.
    pub ps: Components,
    /// Default superelement.
    pub seid: Id,
}

/// What the three coordinates of a system mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoordinateKind {
    /// CORDxR: x, y, z.
    Rectangular,
    /// CORDxC: r, theta (degrees from the local x axis), z.
    Cylindrical,
    /// CORDxS: rho, theta (degrees from the local z axis), phi (degrees from the local x-z plane).
    Spherical,
}

/// How a system is placed: its origin, a point on the local z axis, a point in the local x-z half plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum CoordinateDefinition {
    /// CORD1x: by three grid points.
    Grids {
        /// Origin, point on the z axis, point in the x-z half plane.
        grids: [Id; 3],
    },
    /// CORD2x: by three points given in another system.
    Points {
        /// The system in which the points are given; 0 is the basic system.
        reference: Id,
        /// Origin A.
        a: [f64; 3],
        /// Point B on the local z axis.
        b: [f64; 3],
        /// Point C in the local x-z half plane.
        c: [f64; 3],
    },
}

/// A coordinate system (CORD1R, CORD1C, CORD1S, CORD2R, CORD2C, CORD2S).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoordinateSystem {
    /// System number, above 0.
    pub id: Id,
    /// Rectangular, cylindrical or spherical.
    pub kind: CoordinateKind,
    /// Where it is.
    pub definition: CoordinateDefinition,
}
