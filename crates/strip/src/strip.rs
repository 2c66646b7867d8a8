//! The strip: a piece of lifting surface of constant chord, with its own lift slope.
//!
//! Equations: THEORY (10a), (10b), (10c), (10d), (10e).

use crate::Error;
use std::f64::consts::PI;

/// One aerodynamic strip. Structural axes: x aft, y right, z up; SI.
///
/// The chord is rigid and streamwise. Points on it: aerodynamic centre `x_ac` (quarter chord), mid chord
/// `x_ac + c/4`, three-quarter chord `x_ac + c/2`; the load reference axis (LRA) crosses it at `x_lra`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Strip {
    /// Lateral position of the strip's middle \[m\].
    pub y: f64,
    /// Height of the strip's middle \[m\].
    pub z: f64,
    /// Width along the surface's span, seen along the chord \[m\]; area = chord x width.
    pub width: f64,
    /// Chord `c` \[m\].
    pub chord: f64,
    /// Aerodynamic centre, streamwise \[m\].
    pub x_ac: f64,
    /// Load reference axis at this strip, streamwise \[m\].
    pub x_lra: f64,
    /// Lift slope `dc_l/dalpha` of the strip for its own incremental incidence \[1/rad\].
    pub cl_alpha: f64,
    /// Angle of the surface above the horizontal plane, positive where z grows with y \[rad\]; 90 deg for a fin.
    pub dihedral_rad: f64,
}

/// Where the downwash of a strip is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DownwashPoint {
    /// The three-quarter chord, exact for a lift slope of 2 pi.
    #[default]
    ThreeQuarter,
    /// `x_ac + c cl_alpha / (4 pi)`: Yates's modified strip theory (NACA RM L57L10, 1958).
    Yates,
}

/// Choices of the strip theory that the matrices depend on.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StripTheory {
    /// Where the downwash is taken.
    pub downwash_point: DownwashPoint,
    /// Factor on the apparent mass `pi rho b^2`; `cos(sweep)` in theories of the section normal to the span.
    pub apparent_mass_factor: f64,
}

impl Default for StripTheory {
    fn default() -> Self {
        Self {
            downwash_point: DownwashPoint::ThreeQuarter,
            apparent_mass_factor: 1.0,
        }
    }
}

impl StripTheory {
    /// Checks the numbers among the choices.
    ///
    /// # Errors
    /// [`Error::BadOption`] for a factor on the apparent mass that is negative or not finite.
    pub fn check(&self) -> Result<(), Error> {
        let value = self.apparent_mass_factor;
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(Error::BadOption {
            option: "the factor on the apparent mass",
            value,
            expected: "zero or more: 1, or the cosine of the sweep",
        })
    }
}

impl Strip {
    /// Semi-chord `b = c/2` \[m\].
    pub fn semi_chord(&self) -> f64 {
        0.5 * self.chord
    }

    /// Mid chord, streamwise \[m\].
    pub fn x_mid(&self) -> f64 {
        self.x_ac + 0.25 * self.chord
    }

    /// Three-quarter chord, streamwise \[m\].
    pub fn x_three_quarter(&self) -> f64 {
        self.x_ac + 0.5 * self.chord
    }

    /// The point whose motion makes the downwash \[m\].
    pub fn x_downwash(&self, point: DownwashPoint) -> f64 {
        match point {
            DownwashPoint::ThreeQuarter => self.x_three_quarter(),
            DownwashPoint::Yates => self.x_ac + self.chord * self.cl_alpha / (4.0 * PI),
        }
    }

    /// Area \[m²\].
    pub fn area(&self) -> f64 {
        self.chord * self.width
    }

    /// Lift per `rho V w`: `k = c cl_alpha dy / 2` \[m²\].
    pub fn lift_factor(&self) -> f64 {
        0.5 * self.area() * self.cl_alpha
    }

    /// Apparent mass per density: `m = pi b^2 dy` \[m³\].
    pub fn apparent_mass_per_density(&self) -> f64 {
        PI * self.semi_chord().powi(2) * self.width
    }

    /// Checks the numbers that the theory divides by or that must be finite.
    ///
    /// # Errors
    /// [`Error::BadStrip`] names the strip, the quantity and the value.
    pub fn check(&self, index: usize) -> Result<(), Error> {
        let finite = [
            ("y", self.y),
            ("z", self.z),
            ("x_ac", self.x_ac),
            ("x_lra", self.x_lra),
            ("cl_alpha", self.cl_alpha),
            ("dihedral_rad", self.dihedral_rad),
        ];
        for (quantity, value) in finite {
            if !value.is_finite() {
                return Err(Error::BadStrip {
                    index,
                    quantity,
                    value,
                    expected: "a finite number",
                });
            }
        }
        for (quantity, value) in [("width", self.width), ("chord", self.chord)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::BadStrip {
                    index,
                    quantity,
                    value,
                    expected: "a positive length",
                });
            }
        }
        Ok(())
    }
}
