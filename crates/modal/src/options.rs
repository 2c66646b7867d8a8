//! What a basis is made of, and how strictly it is checked.

use crate::error::Error;
use crate::mean_axes::OnViolation;
use albatross_fem::BarMass;

/// Which modes make the basis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Selection {
    /// The first elastic modes in order of frequency.
    FirstElastic(usize),
    /// These numbers of the file, in this order, whatever they are.
    Numbers(Vec<usize>),
    /// All elastic modes.
    All,
}

/// Scale of the modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Normalisation {
    /// As in the file, with the file's generalised masses.
    #[default]
    AsGiven,
    /// Generalised mass 1.
    UnitMass,
}

/// Options of a basis.
#[derive(Debug, Clone, PartialEq)]
pub struct BasisOptions {
    /// Modes to take.
    pub modes: Selection,
    /// Subcase; `None` takes the first that has eigenvectors.
    pub subcase: Option<u32>,
    /// Below this frequency a mode is taken as rigid, unless its shape is not a rigid motion, Hz. Default 0.05: rigid
    /// modes come out below 0.01 Hz in double precision, and no aircraft bends that slowly.
    pub rigid_threshold_hz: f64,
    /// Largest coupling of an elastic mode with rigid motion, `|phi^T M R| / sqrt(mu M_RR)`. Default 1e-6. Seven
    /// printed digits alone give a few 1e-8 on a model of a hundred grids.
    pub mean_axes_tolerance: f64,
    /// What to do beyond the tolerance.
    pub on_violation: OnViolation,
    /// Scale of the modes.
    pub normalisation: Normalisation,
    /// How bars carry their mass; `None` follows PARAM,COUPMASS and the program.
    pub bar_mass: Option<BarMass>,
}

impl Default for BasisOptions {
    fn default() -> Self {
        Self {
            modes: Selection::All,
            subcase: None,
            rigid_threshold_hz: 0.05,
            mean_axes_tolerance: 1e-6,
            on_violation: OnViolation::Refuse,
            normalisation: Normalisation::AsGiven,
            bar_mass: None,
        }
    }
}

impl BasisOptions {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let refuse = |option, value| {
            Err(Error::BadOption {
                option,
                value,
                expected: "a positive number",
            })
        };
        let positive = |v: f64| v.is_finite() && v > 0.0;
        if !positive(self.rigid_threshold_hz) {
            return refuse("rigid_threshold_hz", self.rigid_threshold_hz);
        }
        if !positive(self.mean_axes_tolerance) {
            return refuse("mean_axes_tolerance", self.mean_axes_tolerance);
        }
        Ok(())
    }
}
