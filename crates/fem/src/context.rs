//! What every card needs: the deck to look others up, resolved positions and frames.

use albatross_nastran::Deck;
use albatross_nastran::deck::{Id, Mat1};
use albatross_nastran::frames::{Frames, ResolvedGrid};
use nalgebra::{Matrix3, Vector3};

use crate::error::Error;

pub(crate) struct Context<'a> {
    pub(crate) deck: &'a Deck,
    pub(crate) frames: &'a Frames,
}

impl Context<'_> {
    /// Name of a card for messages, with file and line when known.
    pub(crate) fn card(&self, name: &str, id: Id) -> String {
        match self.deck.origins.of(name, id) {
            Some(origin) => format!("{origin}: {name} {id}"),
            None => format!("{name} {id}"),
        }
    }

    pub(crate) fn grid(&self, name: &str, id: Id, grid: Id) -> Result<&ResolvedGrid, Error> {
        self.frames
            .grid(grid)
            .ok_or_else(|| self.missing(name, id, format!("GRID {grid}")))
    }

    /// Unit vectors of coordinate system `cid` at a position.
    pub(crate) fn axes(&self, name: &str, id: Id, cid: Id, at: Vector3<f64>) -> Result<Matrix3<f64>, Error> {
        let system = self.frames.system(cid);
        let system = system.ok_or_else(|| self.missing(name, id, format!("coordinate system {cid}")))?;
        Ok(system.displacement_axes(at))
    }

    /// The material of an element. An element without a material that the deck has cannot be judged.
    pub(crate) fn material(&self, name: &str, id: Id, mid: Id) -> Result<&Mat1, Error> {
        let material = self.deck.materials.get(&mid);
        material.ok_or_else(|| self.missing(name, id, format!("MAT1 {mid}")))
    }

    pub(crate) fn missing(&self, name: &str, id: Id, missing: String) -> Error {
        Error::MissingCard {
            card: self.card(name, id),
            missing,
        }
    }

    pub(crate) fn bad_element(&self, name: &str, id: Id, problem: impl Into<String>) -> Error {
        Error::BadElement {
            card: self.card(name, id),
            problem: problem.into(),
        }
    }

    pub(crate) fn bad_constraint(&self, name: &str, id: Id, problem: impl Into<String>) -> Error {
        Error::BadConstraint {
            card: self.card(name, id),
            problem: problem.into(),
        }
    }
}
