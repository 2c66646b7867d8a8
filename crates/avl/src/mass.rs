//! Mass file (`.mass`).

use serde::{Deserialize, Serialize};

/// Content of a `.mass` file. Items are in the file's units, after its multipliers and adders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MassFile {
    /// `Lunit`: length of one unit of the geometry file.
    pub length_unit: Unit,
    /// `Munit`: mass of one unit of this file.
    pub mass_unit: Unit,
    /// `Tunit`.
    pub time_unit: Unit,
    /// `g`, in the named units (m/s^2 where these are SI); AVL takes 1 when the line is missing.
    pub gravity: Option<f64>,
    /// `rho`, in the named units (kg/m^3 where these are SI); AVL takes 1 when the line is missing.
    pub density: Option<f64>,
    /// Mass items.
    pub items: Vec<MassItem>,
}

/// Size and name of a unit, as in `Lunit = 0.0254 m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    /// Size of the file's unit in the named unit: 0.0254.
    pub factor: f64,
    /// Name: `m`.
    pub name: String,
}

/// One line of masses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MassItem {
    /// Mass.
    pub mass: f64,
    /// Position x aft, y right, z up, in the axes of the geometry file.
    pub position: [f64; 3],
    /// Ixx, Iyy, Izz about the item's own centre.
    pub moments: [f64; 3],
    /// Products Ixy, Ixz, Iyz, positive sum of `m x y` and so on: the tensor entries are their negatives.
    pub products: [f64; 3],
    /// Text after `!`.
    pub comment: String,
}
