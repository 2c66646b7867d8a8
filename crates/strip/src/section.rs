//! The typical section: one strip with plunge and pitch, the smallest model that flutters.

use crate::Error;
use crate::elastic::{AeroelasticModel, Structure};
use crate::forces::Split;
use crate::kernels::Lag;
use crate::shapes::StripShapes;
use crate::strip::{Strip, StripTheory};
use albatross_numerics::Mat;

/// A section of unit span on two springs. Any coherent system of units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TypicalSection {
    /// Mass per span.
    pub mass: f64,
    /// Static moment about the elastic axis per span, positive with the centre of gravity aft.
    pub static_moment: f64,
    /// Moment of inertia about the elastic axis per span.
    pub inertia: f64,
    /// Stiffness in plunge per span.
    pub plunge_stiffness: f64,
    /// Stiffness in pitch per span.
    pub pitch_stiffness: f64,
    /// Semi-chord b.
    pub semi_chord: f64,
    /// Elastic axis aft of mid chord, in semi-chords (Theodorsen's `a`).
    pub axis: f64,
    /// Lift slope \[1/rad\].
    pub cl_alpha: f64,
}

impl TypicalSection {
    /// The aeroelastic model with coordinates plunge (up) and pitch (nose up) of the elastic axis.
    ///
    /// # Errors
    /// As [`AeroelasticModel::try_new`].
    pub fn model(&self, lags: &[Lag]) -> Result<AeroelasticModel, Error> {
        let b = self.semi_chord;
        let x_mid = -self.axis * b;
        let strip = Strip {
            y: 0.0,
            z: 0.0,
            width: 1.0,
            chord: 2.0 * b,
            x_ac: x_mid - 0.5 * b,
            x_lra: 0.0,
            cl_alpha: self.cl_alpha,
            dihedral_rad: 0.0,
        };
        // A point at x moves by h - x theta: a mass aft of the axis couples with a minus sign.
        let mass = [
            [self.mass, -self.static_moment],
            [-self.static_moment, self.inertia],
        ];
        let structure = Structure {
            mass: Mat::from_fn(2, 2, |i, j| mass[i][j]),
            damping: Mat::zeros(2, 2),
            stiffness: Mat::from_fn(2, 2, |i, j| {
                if i != j {
                    0.0
                } else {
                    [self.plunge_stiffness, self.pitch_stiffness][i]
                }
            }),
        };
        let shapes = StripShapes::try_new(
            Mat::from_fn(1, 2, |_, k| [1.0, 0.0][k]),
            Mat::from_fn(1, 2, |_, k| [0.0, 1.0][k]),
        )?;
        AeroelasticModel::try_new(
            structure,
            vec![strip],
            shapes,
            &StripTheory::default(),
            Split::default(),
            lags,
        )
    }
}
