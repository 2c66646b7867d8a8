//! Mean axes: elastic modes must carry neither momentum nor moment of momentum, Phi^T M R = 0.
//!
//! Rigid motion R and elastic motion then separate in the kinetic energy (Waszak and Schmidt, J. Aircraft 25,
//! 1988), and the equations of a rigid aircraft hold for the mean axes. Exact free-free modes fulfil this by
//! orthogonality; modes of a clamped model, of another mass state, or from another deck do not.
//!
//! Equations: THEORY (3), (4).

use nalgebra::{Matrix6, Vector6};
use serde::Serialize;

use crate::error::Error;
use crate::mass_matrix::{MassMatrix, dot};
use albatross_fem::{RIGID_DIRECTIONS, rigid_shape};

/// What to do when a mode exceeds the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub enum OnViolation {
    /// Return [`Error::NotMeanAxes`].
    #[default]
    Refuse,
    /// Remove the rigid part of the modes beyond the tolerance.
    Orthogonalise,
    /// Keep the modes and report the figures: for clamped wings and other models that do not fly.
    Accept,
}

/// Result of the mean-axes check of a basis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum MeanAxes {
    /// The check was made; its figures.
    Checked(MeanAxesCheck),
    /// The check was refused, because the mass matrix would be wrong.
    Refused {
        /// Why.
        reason: String,
    },
}

/// Figures of the mean-axes check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeanAxesCheck {
    /// Largest coupling allowed.
    pub tolerance: f64,
    /// Rigid directions in which the model is free; the others are not judged.
    pub free_directions: [bool; 6],
    /// For each mode of the basis, `|phi^T M R_i| / sqrt(mu M_ii)` with the six rigid motions about the centre of
    /// gravity. After orthogonalisation, of the modes that remain.
    pub coupling: Vec<[f64; 6]>,
    /// Largest coupling over all modes and free directions, before any orthogonalisation.
    pub worst: f64,
    /// Numbers of the modes whose rigid part was removed.
    pub orthogonalised: Vec<usize>,
    /// phi^T M phi of each mode in the basis' normalisation, from the shapes.
    pub shape_generalized_mass: Vec<f64>,
    /// Largest |phi_k^T M phi_l| / sqrt(mu_k mu_l) of two different modes.
    pub orthogonality: f64,
}

/// The six rigid motions of a set of grids with their momenta.
pub(crate) struct RigidBody {
    shapes: [Vec<[f64; 6]>; 6],
    momenta: [Vec<[f64; 6]>; 6],
    /// 1 / sqrt(M_ii); 0 where the direction has no inertia or is not free.
    scale: Vector6<f64>,
    /// Inverse of the rigid mass matrix scaled to a unit diagonal, identity in directions that are left out.
    inverse: Matrix6<f64>,
}

impl RigidBody {
    pub(crate) fn new(
        mass: &MassMatrix,
        positions: &[[f64; 3]],
        cg: [f64; 3],
        free: [bool; 6],
    ) -> Result<Self, Error> {
        let shapes: [Vec<[f64; 6]>; 6] = std::array::from_fn(|i| rigid_shape(i, cg, positions));
        let momenta: [Vec<[f64; 6]>; 6] = std::array::from_fn(|i| mass.apply(&shapes[i]));
        let rigid_mass = Matrix6::from_fn(|i, j| dot(&shapes[i], &momenta[j]));
        if let Some(i) = (0..6).find(|&i| !(rigid_mass[(i, i)] >= 0.0 && rigid_mass[(i, i)].is_finite())) {
            return Err(Error::BadMassMatrix {
                problem: format!(
                    "gives {} for rigid {}; check the mass cards for wrong or negative numbers",
                    rigid_mass[(i, i)],
                    RIGID_DIRECTIONS[i]
                ),
            });
        }
        let translation = rigid_mass[(0, 0)].max(rigid_mass[(1, 1)]).max(rigid_mass[(2, 2)]);
        let rotation = rigid_mass[(3, 3)].max(rigid_mass[(4, 4)]).max(rigid_mass[(5, 5)]);
        let scale = Vector6::from_fn(|i, _| {
            let largest = if i < 3 { translation } else { rotation };
            let m = rigid_mass[(i, i)];
            // A straight beam has no inertia about itself: nothing moves, nothing couples.
            if free[i] && m > 1e-12 * largest {
                1.0 / m.sqrt()
            } else {
                0.0
            }
        });
        let scaled = Matrix6::from_fn(|i, j| {
            let s = rigid_mass[(i, j)] * scale[i] * scale[j];
            if i == j && s == 0.0 { 1.0 } else { s }
        });
        let inverse = scaled.try_inverse().ok_or_else(|| Error::BadMassMatrix {
            problem: "gives a singular rigid-body mass matrix; check for negative masses".into(),
        })?;
        Ok(Self {
            shapes,
            momenta,
            scale,
            inverse,
        })
    }

    /// Normalised couplings phi^T M R_i / sqrt(mu M_ii).
    pub(crate) fn coupling(&self, shape: &[[f64; 6]], mu: f64) -> [f64; 6] {
        std::array::from_fn(|i| dot(shape, &self.momenta[i]) * self.scale[i] / mu.sqrt())
    }

    /// Share of the kinetic energy of a shape that is rigid motion in the free directions, 0 to 1.
    pub(crate) fn rigid_content(&self, shape: &[[f64; 6]], mu: f64) -> f64 {
        let c = Vector6::from(self.coupling(shape, mu));
        c.dot(&(self.inverse * c))
    }

    /// phi - R (R^T M R)^-1 R^T M phi over the free directions.
    pub(crate) fn without_rigid_part(&self, shape: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let amount = (self.inverse * Vector6::from(self.coupling(shape, 1.0))).component_mul(&self.scale);
        let mut elastic = shape.to_vec();
        for (a, rigid) in amount.iter().zip(&self.shapes) {
            for (e, r) in elastic.iter_mut().flatten().zip(rigid.iter().flatten()) {
                *e -= a * r;
            }
        }
        elastic
    }
}

/// A mode as the check sees it.
pub(crate) struct Checked {
    pub(crate) number: usize,
    pub(crate) omega_rad_s: f64,
    pub(crate) generalized_mass: f64,
    pub(crate) shape: Vec<[f64; 6]>,
}

/// Checks every mode and, if asked, removes rigid parts.
///
/// The generalised stiffness is strain energy and does not change with the rigid part; the generalised mass is
/// reduced in the ratio of phi^T M phi, and the frequency follows.
pub(crate) fn check(
    modes: &mut [Checked],
    mass: &MassMatrix,
    body: &RigidBody,
    free_directions: [bool; 6],
    tolerance: f64,
    on_violation: OnViolation,
) -> Result<MeanAxesCheck, Error> {
    let mut coupling = Vec::with_capacity(modes.len());
    let mut shape_mass = Vec::with_capacity(modes.len());
    for mode in modes.iter() {
        let mu = mass.inner(&mode.shape, &mode.shape);
        if mu.is_nan() || mu <= 0.0 {
            return Err(Error::BadMode {
                mode: mode.number,
                what: "phi^T M phi".into(),
                value: mu,
                expected: "a mode that moves mass; check that the deck holds the mass of the analysis",
            });
        }
        coupling.push(body.coupling(&mode.shape, mu).map(f64::abs));
        shape_mass.push(mu);
    }
    let largest = |c: &[f64; 6]| c.iter().fold(0.0_f64, |a, &b| a.max(b));
    let worst = coupling.iter().map(largest).fold(0.0, f64::max);
    let mut orthogonalised = Vec::new();
    if worst > tolerance {
        match on_violation {
            OnViolation::Refuse => return Err(refusal(modes, &coupling, tolerance)),
            OnViolation::Accept => {}
            OnViolation::Orthogonalise => {
                for ((mode, c), mu) in modes.iter_mut().zip(&mut coupling).zip(&mut shape_mass) {
                    if largest(c) <= tolerance {
                        continue;
                    }
                    let elastic = body.without_rigid_part(&mode.shape);
                    let mu_elastic = mass.inner(&elastic, &elastic);
                    let remaining = mu_elastic / *mu;
                    // Below this share the elastic part is the rounding of seven printed digits.
                    if remaining.is_nan() || remaining < 1e-9 {
                        return Err(Error::NothingElastic {
                            mode: mode.number,
                            remaining,
                        });
                    }
                    mode.generalized_mass *= remaining;
                    mode.omega_rad_s /= remaining.sqrt();
                    *c = body.coupling(&elastic, mu_elastic).map(f64::abs);
                    *mu = mu_elastic;
                    mode.shape = elastic;
                    orthogonalised.push(mode.number);
                }
            }
        }
    }
    let orthogonality = worst_off_diagonal(modes, &shape_mass, mass);
    Ok(MeanAxesCheck {
        tolerance,
        free_directions,
        coupling,
        worst,
        orthogonalised,
        shape_generalized_mass: shape_mass,
        orthogonality,
    })
}

fn refusal(modes: &[Checked], coupling: &[[f64; 6]], tolerance: f64) -> Error {
    let mut worst = (0, 0.0, "");
    let mut count = 0;
    for (mode, c) in modes.iter().zip(coupling) {
        count += usize::from(c.iter().any(|&v| v > tolerance));
        for (&value, direction) in c.iter().zip(RIGID_DIRECTIONS) {
            if value > worst.1 {
                worst = (mode.number, value, direction);
            }
        }
    }
    let (mode, value, direction) = worst;
    Error::NotMeanAxes {
        mode,
        value,
        direction,
        tolerance,
        count,
        modes: modes.len(),
    }
}

fn worst_off_diagonal(modes: &[Checked], mu: &[f64], mass: &MassMatrix) -> f64 {
    let mut worst = 0.0_f64;
    for (k, (mode, mu_k)) in modes.iter().zip(mu).enumerate() {
        let momentum = mass.apply(&mode.shape);
        for (other, mu_l) in modes.iter().zip(mu).skip(k + 1) {
            worst = worst.max(dot(&other.shape, &momentum).abs() / (mu_k * mu_l).sqrt());
        }
    }
    worst
}
