//! Stiffness of elements as blocks between points, in basic axes.
//!
//! | card | stiffness |
//! |---|---|
//! | CBAR | uniform beam: tension, torsion, bending in two planes with I12, shear by K1, K2; pins and offsets |
//! | CBEAM | the same with sections that vary along the shear-centre line, and a neutral axis beside it |
//! | CROD, CONROD | tension E A / L and torsion G J / L |
//! | CELAS1, CELAS2 | a scalar spring between two freedoms, in their CD systems |
//! | CBUSH | six springs at a point that is rigidly joined to both grids |

mod beam;
mod rod;
mod section;
mod spring;

pub(crate) use spring::scalar_end;

use albatross_nastran::deck::Id;
use nalgebra::Matrix6;

use crate::context::Context;
use crate::error::Error;

/// Stiffness between two grids (or a grid and the ground) in basic axes: blocks AA, AB, BB.
#[derive(Debug, Clone)]
pub(crate) struct GridPair {
    pub(crate) a: Id,
    /// `None`: the ground.
    pub(crate) b: Option<Id>,
    pub(crate) blocks: [Matrix6<f64>; 3],
}

/// A value on the diagonal of one freedom, or between two: k [1, -1; -1, 1].
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScalarPair {
    pub(crate) ends: [Option<usize>; 2],
    pub(crate) value: f64,
}

/// All elements of a deck.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stiffness {
    pub(crate) pairs: Vec<GridPair>,
    pub(crate) scalars: Vec<ScalarPair>,
    pub(crate) remarks: Vec<String>,
}

impl Stiffness {
    pub(crate) fn assemble(context: &Context<'_>, freedoms: &crate::dofs::Freedoms) -> Result<Self, Error> {
        let mut stiffness = Self::default();
        beam::add(context, &mut stiffness)?;
        rod::add(context, &mut stiffness)?;
        spring::add(context, freedoms, &mut stiffness)?;
        Ok(stiffness)
    }
}
