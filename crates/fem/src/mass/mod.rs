//! The mass matrix of a deck.
//!
//! | card | mass |
//! |---|---|
//! | CONM1 | its 6x6 matrix, turned from its frame |
//! | CONM2 | rigid mass at an offset, with inertia about its centre, turned from its frame |
//! | CBAR, CBEAM | (rho A + nsm) L, half at each end of the element; element offsets are rigid arms |
//! | CBEAM | structural mass on the neutral axis, the rest at its own centre (N1, N2 and M1, M2 of PBEAM); beside that, the inertia of its sections about these lines, (rho (I1 + I2) + nsi) L |
//! | CROD, CONROD | (rho A + nsm) L, half at each grid |
//! | PARAM,WTMASS | factor on all of them |
//!
//! With [`BarMass::Coupled`] the bending mass of bars is consistent with the cubic deflection of a beam. Anything
//! else in a deck that can carry mass is listed in [`DeckMass::other`]: sums over this matrix are then incomplete.

mod bars;
mod other;

pub(crate) use bars::end_offsets;

use albatross_nastran::Deck;
use albatross_nastran::deck::{Conm2Frame, Id};
use albatross_nastran::frames::Frames;
use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::context::Context;
use crate::error::Error;
use crate::mass_model::{MassModel, rigid_block};
use crate::rigid::rotation_blocks;

/// How the mass of bars and beams is spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BarMass {
    /// Half of the element's mass at each end: Nastran's default.
    #[default]
    Lumped,
    /// Consistent with the beam's cubic deflection: Nastran with PARAM,COUPMASS,1.
    Coupled,
}

/// The mass of a deck, and what of it is missing here.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DeckMass {
    /// The mass by grid, after PARAM,WTMASS.
    pub model: MassModel,
    /// Cards that carry, or may carry, mass that `model` lacks, as text. Empty when the model is complete.
    pub other: Vec<String>,
    /// Those of `other` that are bars or beams whose section is not known.
    pub(crate) left_out_by_elements: Vec<String>,
    /// Remarks on what was assumed.
    pub notes: Vec<String>,
}

impl DeckMass {
    /// Assembles the mass of a deck.
    ///
    /// # Errors
    /// [`Error::MissingCard`] for a grid, property, material or coordinate system that a mass card names and the
    /// deck lacks; [`Error::BadMass`] for numbers that are not finite, [`Error::BadElement`] for elements without
    /// length.
    pub fn assemble(deck: &Deck, frames: &Frames, bar_mass: BarMass) -> Result<Self, Error> {
        let mut mass = Self::default();
        let context = Context { deck, frames };
        concentrated(&context, &mut mass.model)?;
        bars::add(&context, bar_mass, &mut mass)?;
        mass.left_out_by_elements.clone_from(&mass.other);
        mass.left_out_by_elements.extend(other::bush_masses(deck));
        mass.other.extend(other::masses(deck));
        scale(&mut mass.model, weight_to_mass(deck)?)?;
        Ok(mass)
    }

    /// Why sums over the model are not the whole mass; `None` when they are.
    #[must_use]
    pub fn incomplete(&self) -> Option<String> {
        (!self.other.is_empty()).then(|| {
            format!(
                "the deck has mass that is not in the mass matrix: {}",
                self.other.join("; ")
            )
        })
    }
}

fn check_finite(context: &Context<'_>, name: &str, id: Id, block: &Matrix6<f64>) -> Result<(), Error> {
    if block.iter().all(|m| m.is_finite()) {
        return Ok(());
    }
    Err(Error::BadMass {
        card: context.card(name, id),
        problem: "its mass is not finite; correct the numbers on the card".into(),
    })
}

fn concentrated(context: &Context<'_>, model: &mut MassModel) -> Result<(), Error> {
    for conm1 in context.deck.conm1.values() {
        let grid = context.grid("CONM1", conm1.id, conm1.grid)?;
        let a = rotation_blocks(&context.axes("CONM1", conm1.id, conm1.cid, grid.position)?);
        let local = Matrix6::from_fn(|i, j| conm1.mass[i][j]);
        let block = a * local * a.transpose();
        check_finite(context, "CONM1", conm1.id, &block)?;
        model.add(conm1.grid, grid.position, &block);
    }
    for conm2 in context.deck.conm2.values() {
        let grid = context.grid("CONM2", conm2.id, conm2.grid)?;
        let given = Vector3::from(conm2.offset);
        let (axes, offset) = match conm2.frame {
            Conm2Frame::BasicPosition => (Matrix3::identity(), given - grid.position),
            Conm2Frame::System(cid) => {
                let axes = context.axes("CONM2", conm2.id, cid, grid.position)?;
                (axes, axes * given)
            }
        };
        let j_local = Matrix3::from(conm2.inertia_tensor()).transpose();
        let block = rigid_block(conm2.mass, offset, &(axes * j_local * axes.transpose()));
        check_finite(context, "CONM2", conm2.id, &block)?;
        model.add(conm2.grid, grid.position, &block);
    }
    Ok(())
}

/// The factor of PARAM,WTMASS. The deck takes a value that is no number for none; here that would be a silent 1.
fn weight_to_mass(deck: &Deck) -> Result<f64, Error> {
    match deck.param("WTMASS") {
        Some(param) if param.as_real().is_none() => Err(Error::BadMass {
            card: "PARAM WTMASS".into(),
            problem: format!("its value is `{}`; it must be a positive number", param.value),
        }),
        _ => Ok(deck.weight_to_mass()),
    }
}

fn scale(model: &mut MassModel, weight_to_mass: f64) -> Result<(), Error> {
    if !(weight_to_mass.is_finite() && weight_to_mass > 0.0) {
        return Err(Error::BadMass {
            card: "PARAM WTMASS".into(),
            problem: format!(
                "the factor from weight to mass is {weight_to_mass}; it must be a positive number"
            ),
        });
    }
    model.grids.values_mut().for_each(|g| g.matrix *= weight_to_mass);
    model.couplings.values_mut().for_each(|m| *m *= weight_to_mass);
    Ok(())
}
