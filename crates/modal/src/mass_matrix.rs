//! The mass matrix on a list of grids, as blocks, with products for shapes on that list.

use albatross_fem::MassModel;
use albatross_nastran::deck::Id;
use nalgebra::{Matrix6, Vector6};
use std::collections::BTreeMap;

use crate::error::Error;

/// The mass matrix on an ordered list of grids, with products for shapes on that list.
#[derive(Debug, Clone, PartialEq)]
pub struct MassMatrix {
    blocks: Vec<Matrix6<f64>>,
    couplings: Vec<(usize, usize, Matrix6<f64>)>,
}

impl MassMatrix {
    /// The matrix of `model` on `grids`.
    ///
    /// # Errors
    /// [`Error::NoMassMatrix`] that names grids with mass which `grids` lacks.
    pub fn on_grids(model: &MassModel, grids: &[Id]) -> Result<Self, Error> {
        let index: BTreeMap<Id, usize> = grids.iter().enumerate().map(|(i, &id)| (id, i)).collect();
        let outside = model.grids_outside(|id| index.contains_key(&id));
        if !outside.is_empty() {
            return Err(Error::NoMassMatrix {
                operation: "the mean-axes check",
                reason: format!(
                    "grids {} carry mass but have no eigenvector in the results; print them with \
                     DISPLACEMENT(PRINT) = ALL, or a SET that holds them",
                    crate::text::ranges(&outside)
                ),
            });
        }
        let blocks = grids
            .iter()
            .map(|id| model.grids.get(id).map_or_else(Matrix6::zeros, |g| g.matrix))
            .collect();
        let couplings = model
            .couplings
            .iter()
            .filter_map(|((a, b), m)| Some((*index.get(a)?, *index.get(b)?, *m)))
            .collect();
        Ok(Self { blocks, couplings })
    }

    /// Number of grids.
    #[must_use]
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Whether there are no grids.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Mass of grid `index` for translation, mean of the three directions, kg; 0 for an index out of range.
    #[must_use]
    pub fn translational_mass(&self, index: usize) -> f64 {
        self.blocks
            .get(index)
            .map_or(0.0, |m| (m[(0, 0)] + m[(1, 1)] + m[(2, 2)]) / 3.0)
    }

    /// M phi: momentum and moment of momentum at each grid for a unit rate of the shape.
    #[must_use]
    pub fn apply(&self, shape: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let at = |i: usize| shape.get(i).map_or_else(Vector6::zeros, |s| Vector6::from(*s));
        let mut product: Vec<Vector6<f64>> = self.blocks.iter().enumerate().map(|(i, m)| m * at(i)).collect();
        for &(a, b, ref m) in &self.couplings {
            if let Some(p) = product.get_mut(a) {
                *p += m * at(b);
            }
            if let Some(p) = product.get_mut(b) {
                *p += m.tr_mul(&at(a));
            }
        }
        product.into_iter().map(Into::into).collect()
    }

    /// a^T M b.
    #[must_use]
    pub fn inner(&self, a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
        dot(a, &self.apply(b))
    }
}

/// Sum of products over all grids and components.
pub(crate) fn dot(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(x, y)| x * y)
        .sum()
}
