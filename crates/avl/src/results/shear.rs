//! Shear and bending moment along each surface (`.vm`).

use serde::{Deserialize, Serialize};

/// Content of a `.vm` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearMoments {
    /// Title of the geometry file.
    pub title: String,
    /// Mach number.
    pub mach: f64,
    /// Angle of attack, in degrees.
    pub alpha_deg: f64,
    /// Sideslip, in degrees.
    pub beta_deg: f64,
    /// Lift coefficient.
    pub c_lift: f64,
    /// Reference area.
    pub s_ref: f64,
    /// Reference span.
    pub b_ref: f64,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<ShearSurface>,
}

/// Shear and moment of one surface. Each surface is integrated by itself: nothing is carried across to another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearSurface {
    /// Number, from 1.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Smallest `2Y/Bref`.
    pub eta_min: f64,
    /// Largest `2Y/Bref`.
    pub eta_max: f64,
    /// Root, one per strip, tip.
    pub stations: Vec<ShearStation>,
}

/// Shear and moment at one station.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearStation {
    /// `2Y/Bref`.
    pub eta: f64,
    /// `Vz / (q Sref)`.
    pub shear: f64,
    /// `Mx / (q Bref Sref)`.
    pub moment: f64,
}
