//! Generalised aerodynamic forces of elastic motion: the Q matrices of the paper's Eqs. 7, 8 and 10.
//!
//! Powers of density and speed are factored as the paper prints them:
//!
//! ```text
//! Q = rho Q_etadd etadd + rho V Q_etad etad + rho V^2 Q_eta eta + rho V Q_lambda (lambda_1 + lambda_2)
//! ```
//!
//! With `phi^p = phi - (x_p - x_lra) gamma` at point p of strip j, `m_j = pi b^2 dy`, `k_j = c cl_alpha dy / 2`:
//!
//! | matrix | sum over strips |
//! |---|---|
//! | `Q_etadd^NC` | `- m (phi^m phi^m + b^2/8 gamma gamma)` |
//! | `Q_etad^NC`  | `  m phi^34 gamma` |
//! | `Q_etad^C`   | `- k phi^ac phi^34` |
//! | `Q_eta^C`    | `  k phi^ac gamma` |
//! | `Q_lambda^C` | `  k phi^ac` |
//!
//! The first factor of each product belongs to the *test* shape (the one that collects the work), the second to the
//! *trial* shape (the one that moves). With elastic test shapes these are Eq. 10's matrices; with rigid-body test
//! shapes the very same sums are the force and moment rows of Eqs. 7 and 8.
//!
//! Equations: THEORY (12), (13).

use crate::Error;
use crate::check::{ensure_finite_entries, ensure_rows, ensure_shape};
use crate::shapes::StripShapes;
use crate::strip::{Strip, StripTheory};
use albatross_numerics::Mat;

/// Which part of the flow the terms of plunge rate and pitch are booked under. Sums are identical.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// Apparent mass alone is non-circulatory: `Q_eta^NC = 0`.
    #[default]
    ApparentMass,
    /// Theodorsen's flow split: the circulation-free flow carries the Munk couple, which the circulatory part takes
    /// back; this gives the paper's non-zero `Q_eta^NC`.
    Theodorsen,
}

/// Generalised force matrices; rows are test shapes, columns trial shapes (strips for `eta_lambda_c`).
#[derive(Debug, Clone)]
pub struct GeneralizedForces {
    /// `Q_eta_etadd^NC`, per density.
    pub eta_etadd_nc: Mat<f64>,
    /// `Q_eta_etad^NC`, per density and speed.
    pub eta_etad_nc: Mat<f64>,
    /// `Q_eta_etad^C`, per density and speed.
    pub eta_etad_c: Mat<f64>,
    /// `Q_eta_eta^NC`, per density and speed squared.
    pub eta_eta_nc: Mat<f64>,
    /// `Q_eta_eta^C`, per density and speed squared.
    pub eta_eta_c: Mat<f64>,
    /// `Q_eta_lambda^C`, per density and speed; test shapes x strips.
    pub eta_lambda_c: Mat<f64>,
}

impl GeneralizedForces {
    /// `Q_eta_etad^NC + Q_eta_etad^C`.
    pub fn eta_etad(&self) -> Mat<f64> {
        &self.eta_etad_nc + &self.eta_etad_c
    }

    /// `Q_eta_eta^NC + Q_eta_eta^C`.
    pub fn eta_eta(&self) -> Mat<f64> {
        &self.eta_eta_nc + &self.eta_eta_c
    }
}

/// The downwash of elastic motion, `w = V w_eta eta + w_etad etad`, positive for positive lift; strips x shapes.
#[derive(Debug, Clone)]
pub struct Downwash {
    /// Rows of `eta`, to be multiplied by V: the local incidence.
    pub w_eta: Mat<f64>,
    /// Rows of `etad`: minus the displacement at the downwash point.
    pub w_etad: Mat<f64>,
}

/// The downwash rows of shapes that move.
///
/// # Errors
/// [`Error::Shape`] if shapes and strips differ in number, [`Error::NotFinite`] for shapes with NaN or infinities.
pub fn downwash(strips: &[Strip], trial: &StripShapes, theory: &StripTheory) -> Result<Downwash, Error> {
    ensure_rows("trial shapes", &trial.phi, strips.len())?;
    trial.check()?;
    let w_etad = trial.at(strips, |s| s.x_downwash(theory.downwash_point));
    Ok(Downwash {
        w_eta: trial.gamma.clone(),
        w_etad: -w_etad,
    })
}

/// The generalised forces on `test` shapes due to motion in `trial` shapes, each strip's lift by its own downwash.
///
/// # Errors
/// [`Error::Shape`] if shapes and strips differ in number, [`Error::NotFinite`] for shapes with NaN or infinities,
/// [`Error::BadStrip`] for an unusable strip, [`Error::BadOption`] for an unusable factor on the apparent mass.
pub fn generalized_forces(
    strips: &[Strip],
    test: &StripShapes,
    trial: &StripShapes,
    theory: &StripTheory,
    split: Split,
) -> Result<GeneralizedForces, Error> {
    assemble(strips, None, test, trial, theory, split)
}

/// The same with lift induced between strips: `influence[(j, i)]` is the lift of strip j per `rho V w_i` \[m²\], in the
/// place of the diagonal of [`Strip::lift_factor`]. A vortex lattice gives it (see [`influence_of`]); the lags stay those
/// of each strip's own downwash, so that the induced lift builds up with the wake of the strip that causes it.
///
/// # Errors
/// As [`generalized_forces`], [`Error::Shape`] and [`Error::NotFinite`] for the influence as well.
pub fn generalized_forces_between(
    strips: &[Strip],
    influence: &Mat<f64>,
    test: &StripShapes,
    trial: &StripShapes,
    theory: &StripTheory,
    split: Split,
) -> Result<GeneralizedForces, Error> {
    ensure_shape("lift between strips", influence, (strips.len(), strips.len()))?;
    ensure_finite_entries("lift between strips", influence)?;
    assemble(strips, Some(influence), test, trial, theory, split)
}

/// Influence of strips on each other from lift slopes between them, `slopes[(j, i)] = d(c c_l)_j / d(incidence)_i` \[m\]:
/// half of them times the width of the strip that carries the lift.
pub fn influence_of(strips: &[Strip], slopes: &Mat<f64>) -> Mat<f64> {
    Mat::from_fn(slopes.nrows(), slopes.ncols(), |j, i| {
        0.5 * strips.get(j).map_or(0.0, |s| s.width) * slopes[(j, i)]
    })
}

fn assemble(
    strips: &[Strip],
    influence: Option<&Mat<f64>>,
    test: &StripShapes,
    trial: &StripShapes,
    theory: &StripTheory,
    split: Split,
) -> Result<GeneralizedForces, Error> {
    ensure_rows("test shapes", &test.phi, strips.len())?;
    ensure_rows("trial shapes", &trial.phi, strips.len())?;
    test.check()?;
    trial.check()?;
    theory.check()?;
    for (index, strip) in strips.iter().enumerate() {
        strip.check(index)?;
    }
    let apparent_mass: Vec<f64> = strips
        .iter()
        .map(|s| theory.apparent_mass_factor * s.apparent_mass_per_density())
        .collect();
    let couple_inertia: Vec<f64> = strips
        .iter()
        .zip(&apparent_mass)
        .map(|(s, m)| m * s.semi_chord().powi(2) / 8.0)
        .collect();
    let test_ac = test.at(strips, |s| s.x_ac);
    let test_mid = test.at(strips, Strip::x_mid);
    let test_34 = test.at(strips, Strip::x_three_quarter);
    let trial_mid = trial.at(strips, Strip::x_mid);
    let trial_34 = trial.at(strips, |s| s.x_downwash(theory.downwash_point));

    let eta_etadd_nc = -(weighted_product(&apparent_mass, &test_mid, &trial_mid)
        + weighted_product(&couple_inertia, &test.gamma, &trial.gamma));
    let mut eta_etad_nc = weighted_product(&apparent_mass, &test_34, &trial.gamma);
    // What a unit of `rho V w` on each strip does to the test shapes.
    let eta_lambda_c = match influence {
        None => Mat::from_fn(test.n_shapes(), strips.len(), |k, j| {
            strips[j].lift_factor() * test_ac[(j, k)]
        }),
        Some(influence) => test_ac.transpose() * influence,
    };
    let mut eta_etad_c = -(&eta_lambda_c * &trial_34);
    let mut eta_eta_nc = Mat::zeros(test.n_shapes(), trial.n_shapes());
    let mut eta_eta_c = &eta_lambda_c * &trial.gamma;
    if split == Split::Theodorsen {
        let munk_pitch = weighted_product(&apparent_mass, &test.gamma, &trial.gamma);
        let munk_rate = weighted_product(
            &apparent_mass,
            &test.gamma,
            &trial.at(strips, Strip::x_three_quarter),
        );
        eta_eta_nc = munk_pitch.clone();
        eta_eta_c -= munk_pitch;
        eta_etad_nc -= &munk_rate;
        eta_etad_c += munk_rate;
    }
    Ok(GeneralizedForces {
        eta_etadd_nc,
        eta_etad_nc,
        eta_etad_c,
        eta_eta_nc,
        eta_eta_c,
        eta_lambda_c,
    })
}

/// `sum_j weight_j a[j, k] b[j, l]`.
fn weighted_product(weight: &[f64], a: &Mat<f64>, b: &Mat<f64>) -> Mat<f64> {
    let weighted = Mat::from_fn(b.nrows(), b.ncols(), |j, l| weight[j] * b[(j, l)]);
    a.transpose() * weighted
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn strip() -> Strip {
        Strip {
            y: 3.0,
            z: 0.2,
            width: 0.7,
            chord: 1.6,
            x_ac: 4.0,
            x_lra: 4.3,
            cl_alpha: 2.0 * PI,
            dihedral_rad: 0.0,
        }
    }

    fn shapes(phi: &[f64], gamma: &[f64]) -> StripShapes {
        StripShapes {
            phi: Mat::from_fn(1, phi.len(), |_, k| phi[k]),
            gamma: Mat::from_fn(1, gamma.len(), |_, k| gamma[k]),
        }
    }

    /// Theodorsen's lift and moment (NACA 496, Eqs. XVIII, XX; h positive down, moment about the axis at `a`), for
    /// harmonic motion with C(k) replaced by an arbitrary complex number, against the assembled matrices.
    #[test]
    fn val_theodorsen_lift_and_moment() {
        let s = strip();
        let (rho, v, omega) = (1.1, 40.0, 13.0);
        let b = s.semi_chord();
        let a = (s.x_lra - s.x_mid()) / b;
        use albatross_numerics::C64;
        let c = C64::new(0.7, -0.15);
        let p = C64::new(0.0, omega);
        let basis = shapes(&[1.0, 0.0], &[0.0, 1.0]);
        let q =
            generalized_forces(&[s], &basis, &basis, &StripTheory::default(), Split::ApparentMass).unwrap();
        let w = downwash(&[s], &basis, &StripTheory::default()).unwrap();
        for (up, pitch) in [
            (C64::new(1.0, 0.0), C64::new(0.0, 0.0)),
            (C64::new(0.3, -0.8), C64::new(0.2, 0.5)),
        ] {
            let h = -up;
            let (hd, hdd, ad, add) = (p * h, p * p * h, p * pitch, p * p * pitch);
            let circulation = v * pitch + hd + b * (0.5 - a) * ad;
            let lift_down_positive_h =
                PI * rho * b * b * (hdd + v * ad - b * a * add) + 2.0 * PI * rho * v * b * c * circulation;
            let moment =
                -PI * rho * b * b * (-b * a * hdd + (0.5 - a) * v * b * ad + b * b * (0.125 + a * a) * add)
                    + 2.0 * PI * rho * v * b * b * (a + 0.5) * c * circulation;
            let eta = [up, pitch];
            let w34: C64 = (0..2)
                .map(|k| v * w.w_eta[(0, k)] * eta[k] + w.w_etad[(0, k)] * p * eta[k])
                .sum();
            let lag = (c - 1.0) * w34;
            for (row, expected) in [(0, lift_down_positive_h), (1, moment)] {
                let mut force = rho * v * q.eta_lambda_c[(row, 0)] * lag;
                for (k, &eta) in eta.iter().enumerate() {
                    force += rho * q.eta_etadd_nc[(row, k)] * p * p * eta
                        + rho * v * q.eta_etad()[(row, k)] * p * eta
                        + rho * v * v * q.eta_eta()[(row, k)] * eta;
                }
                let expected = expected * s.width;
                assert!(
                    (force - expected).norm() < 1e-12 * expected.norm().max(1.0),
                    "{row}: {force} {expected}"
                );
            }
        }
    }

    /// A diagonal influence is the strips' own; one that couples two strips lifts the second by the first's incidence.
    #[test]
    fn prop_influence_between_strips() {
        let strips = [strip(), Strip { y: -3.0, ..strip() }];
        let basis = StripShapes {
            phi: Mat::from_fn(2, 2, |j, k| 0.4 + j as f64 - 0.7 * k as f64),
            gamma: Mat::from_fn(2, 2, |j, k| f64::from(j == k)),
        };
        let theory = StripTheory::default();
        let own = generalized_forces(&strips, &basis, &basis, &theory, Split::Theodorsen).unwrap();
        let between = |influence: &Mat<f64>| {
            generalized_forces_between(&strips, influence, &basis, &basis, &theory, Split::Theodorsen)
                .unwrap()
        };
        let slopes = Mat::from_fn(2, 2, |j, k| {
            f64::from(j == k) * strips[j].cl_alpha * strips[j].chord
        });
        let mut influence = influence_of(&strips, &slopes);
        let same = between(&influence);
        for (a, b) in [
            (&own.eta_eta_c, &same.eta_eta_c),
            (&own.eta_etad_c, &same.eta_etad_c),
            (&own.eta_lambda_c, &same.eta_lambda_c),
        ] {
            assert!((a - b).norm_max() < 1e-14 * a.norm_max());
        }
        influence[(1, 0)] = 0.25;
        let coupled = between(&influence);
        let arm = strips[1].x_ac - strips[1].x_lra;
        for k in 0..2 {
            let collected = basis.phi[(1, k)] - arm * basis.gamma[(1, k)];
            let change = coupled.eta_eta_c[(k, 0)] - own.eta_eta_c[(k, 0)];
            assert!((change - 0.25 * collected).abs() < 1e-13);
        }
        let square = Mat::zeros(2, 3);
        let refused = generalized_forces_between(&strips, &square, &basis, &basis, &theory, Split::default());
        assert!(matches!(refused, Err(Error::Shape { .. })));
    }

    #[test]
    fn prop_both_splits_sum_alike() {
        let strips = [
            strip(),
            Strip {
                y: -2.0,
                x_lra: 3.9,
                chord: 1.1,
                cl_alpha: 5.0,
                ..strip()
            },
        ];
        let basis = StripShapes {
            phi: Mat::from_fn(2, 3, |j, k| (1 + j + 2 * k) as f64 * 0.3 - 0.5),
            gamma: Mat::from_fn(2, 3, |j, k| (2 * j + k) as f64 * 0.1 - 0.2),
        };
        let theory = StripTheory::default();
        let a = generalized_forces(&strips, &basis, &basis, &theory, Split::ApparentMass).unwrap();
        let b = generalized_forces(&strips, &basis, &basis, &theory, Split::Theodorsen).unwrap();
        assert!((a.eta_etad() - b.eta_etad()).norm_max() < 1e-14);
        assert!((a.eta_eta() - b.eta_eta()).norm_max() < 1e-14);
        assert!(b.eta_eta_nc.norm_max() > 1e-3, "the split must move something");
    }

    /// Rigid test shapes give the rows of Eqs. 7 and 8: `F_z,eta^C = - sum k gamma`,
    /// `M_y,etad^C = - sum k (x_cg - x_ac) phi34`, `M_x,lambda = -y k`.
    #[test]
    fn val_rigid_rows() {
        let s = strip();
        let elastic = shapes(&[0.4], &[0.15]);
        let rigid = StripShapes::rigid_body(&[s], crate::shapes::DihedralForm::Paper, 5.5, 0.0);
        let q = generalized_forces(
            &[s],
            &rigid,
            &elastic,
            &StripTheory::default(),
            Split::ApparentMass,
        )
        .unwrap();
        let (k, m) = (s.lift_factor(), s.apparent_mass_per_density());
        let phi_34 = 0.4 - (s.x_three_quarter() - s.x_lra) * 0.15;
        let phi_m = 0.4 - (s.x_mid() - s.x_lra) * 0.15;
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        close(q.eta_eta_c[(2, 0)], -k * 0.15);
        close(q.eta_etad_c[(2, 0)], k * phi_34);
        close(q.eta_etad_nc[(2, 0)], -m * 0.15);
        close(q.eta_etadd_nc[(2, 0)], m * phi_m);
        close(q.eta_lambda_c[(2, 0)], -k);
        close(q.eta_eta_c[(4, 0)], (5.5 - s.x_ac) * k * 0.15);
        close(q.eta_etad_c[(4, 0)], -(5.5 - s.x_ac) * k * phi_34);
        close(q.eta_etad_nc[(4, 0)], (5.5 - s.x_three_quarter()) * m * 0.15);
        close(
            q.eta_etadd_nc[(4, 0)],
            -(5.5 - s.x_mid()) * m * phi_m - m * s.semi_chord().powi(2) / 8.0 * 0.15,
        );
        close(q.eta_lambda_c[(3, 0)], -s.y * k);
        close(q.eta_lambda_c[(4, 0)], (5.5 - s.x_ac) * k);
    }
}
