//! Participation factors and effective masses of modes.
//!
//! Equations: THEORY (46).

use nalgebra::Vector3;

use crate::model::FemModel;
use crate::modes::Modes;

/// How much of a rigid motion a mode takes part in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectiveMass {
    /// Participation factors `phi^T M R / mu` for translations x, y, z and rotations x, y, z.
    pub participation: [f64; 6],
    /// Effective masses `(phi^T M R)^2 / mu`: kg, and kg m^2 about the reference point. Over all modes of a clamped
    /// structure they sum to the mass and inertia that is not on the supports.
    pub effective: [f64; 6],
}

impl FemModel {
    /// Effective masses of modes for rigid motion about `reference` (m, basic axes).
    #[must_use]
    pub fn effective_masses(&self, modes: &Modes, reference: [f64; 3]) -> Vec<EffectiveMass> {
        let rigid = self.rigid_motions(Vector3::from(reference));
        let products: [Vec<f64>; 6] = std::array::from_fn(|j| {
            let column: Vec<f64> = rigid.iter().map(|r| r[j]).collect();
            self.full_mass.product(&column)
        });
        let of = |k: usize| {
            let mu = modes.generalized_masses[k];
            let shape = modes.shapes.col(k);
            let l: [f64; 6] =
                std::array::from_fn(|j| shape.iter().zip(&products[j]).map(|(p, m)| p * m).sum());
            EffectiveMass {
                participation: l.map(|l| l / mu),
                effective: l.map(|l| l * l / mu),
            }
        };
        (0..modes.complete()).map(of).collect()
    }
}
