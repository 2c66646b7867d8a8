//! The structural modes of a case from its deck alone.

use crate::Error;
use crate::case::{ElementMass, ModeChoice, StructureCase};
use albatross_fem::{BarMass, FemModel, ModelOptions, ModesOptions};
use albatross_nastran::{Deck, ModalResults};

/// Rigid-body modes that a free structure has, and some elastic ones beyond those asked for, so that the last pair is
/// not cut.
const BEYOND: usize = 6 + 2;

impl From<ElementMass> for BarMass {
    fn from(choice: ElementMass) -> Self {
        match choice {
            ElementMass::Lumped => Self::Lumped,
            ElementMass::Coupled => Self::Coupled,
        }
    }
}

/// Modes of the deck, as many as the case needs, and remarks.
///
/// # Errors
/// [`Error::Fem`].
pub fn solve(deck: &Deck, structure: &StructureCase) -> Result<(ModalResults, Vec<String>), Error> {
    let options = ModelOptions {
        bar_mass: structure.solve.and_then(|s| s.mass).map(BarMass::from),
        subcase: structure.subcase,
        ..ModelOptions::default()
    };
    let model = FemModel::assemble(deck, &options)?;
    let count = match &structure.modes {
        ModeChoice::Lowest(n) => n.saturating_add(BEYOND),
        ModeChoice::Numbers(numbers) => numbers.iter().copied().max().unwrap_or(0),
    };
    let modes = model.modes(&ModesOptions {
        count: Some(count),
        ..ModesOptions::default()
    })?;
    let mut notes: Vec<String> = model.remarks.iter().chain(&modes.remarks).cloned().collect();
    notes.push(format!(
        "{} modes up to {:.4} Hz computed from {}",
        modes.len(),
        modes.frequencies_hz.last().copied().unwrap_or(0.0),
        structure.deck
    ));
    Ok((modes.results(&model, &structure.deck), notes))
}
