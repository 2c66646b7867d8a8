//! Flutter and divergence speeds at a fixed density.
//!
//! Three descriptions of the same physics, which agree at a neutral point:
//! the state space with lags ([`lag_flutter`]), the exact Theodorsen function on the imaginary axis
//! ([`exact_flutter`]), and the static limit ([`divergence_speed`]). [`crate::sweep`] follows all modes over speed.

use crate::elastic::{AeroelasticModel, Flow, state_matrix};
use crate::kernels::{JONES, theodorsen, theodorsen_derivative};
use crate::{Error, ensure_finite};
use albatross_numerics::{C64, Mat, eigen, root, solve};

/// A neutral point of oscillatory motion.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Flutter {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Frequency of the neutral oscillation \[rad/s\].
    pub omega_rad_s: f64,
}

/// The lowest speed at which the static aeroelastic stiffness `K - rho V^2 Q_eta` is singular \[m/s\]; none if the air
/// stiffens every combination of modes.
///
/// # Errors
/// [`Error::BadFlow`] for a density that is negative or not finite; [`Error::Numerics`] if the stiffness is singular
/// (a free mode has no divergence speed: fix or leave out rigid modes).
pub fn divergence_speed(model: &AeroelasticModel, rho: f64) -> Result<Option<f64>, Error> {
    ensure_finite("density", rho)?;
    let flexibility_times_air = solve::solve(
        model.structure.stiffness.as_ref(),
        model.forces.eta_eta().as_ref(),
    )?;
    let values = eigen::eigenvalues(flexibility_times_air.as_ref())?;
    let steepest = values
        .iter()
        .filter(|v| v.im.abs() <= 1e-9 * v.norm() && v.re > 0.0)
        .map(|v| v.re)
        .fold(0.0, f64::max);
    Ok((steepest > 0.0 && rho > 0.0).then(|| (1.0 / (rho * steepest)).sqrt()))
}

/// The lowest flutter speed of the state space with the model's lags; none up to a reduced velocity
/// `V / (omega b)` of 60 on the highest mode.
///
/// The speed is swept upwards in steps of 2 % until an oscillatory eigenvalue has a positive real part, and the
/// crossing is then refined. A mode that is unstable only within a span of speeds narrower than one step can be
/// missed.
///
/// # Errors
/// [`Error::BadFlow`], or what the eigenvalue problem returns.
pub fn lag_flutter(model: &AeroelasticModel, rho: f64) -> Result<Option<Flutter>, Error> {
    const STEP: f64 = 1.02;
    const LARGEST_REDUCED_VELOCITY: f64 = 60.0;
    ensure_finite("density", rho)?;
    let frequencies = frequencies_in_still_air(model, rho)?;
    let lowest = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = frequencies.iter().copied().fold(0.0, f64::max);
    if highest <= 0.0 || rho == 0.0 {
        return Ok(None);
    }
    let chords = || model.strips.iter().map(|s| s.semi_chord());
    let (slowest_b, widest_b) = (
        chords().fold(f64::INFINITY, f64::min),
        chords().fold(0.0, f64::max),
    );

    let least_stable = |speed: f64| -> Result<C64, Error> {
        let a = state_matrix(model, Flow { rho, speed })?;
        let values = eigen::eigenvalues(a.as_ref())?;
        let floor = 1e-3 * lowest;
        Ok(values
            .into_iter()
            .filter(|v| v.im > floor)
            .fold(C64::new(f64::NEG_INFINITY, 0.0), |worst, v| {
                if v.re > worst.re { v } else { worst }
            }))
    };
    // Below this the air does no more than damp each mode by itself.
    let mut below = 0.01 * lowest * slowest_b;
    let end = LARGEST_REDUCED_VELOCITY * highest * widest_b;
    while below < end {
        let above = below * STEP;
        let worst = least_stable(above)?;
        // An undamped mode that the air does not touch stays on the axis: rounding is no flutter.
        if worst.re > 1e-9 * worst.norm() {
            let growth = |speed: f64| least_stable(speed).map_or(f64::NAN, |v| v.re);
            let speed = root::brent(growth, below, above, 1e-13 * above)?.x;
            let omega_rad_s = least_stable(speed)?.im;
            return Ok(Some(Flutter { speed, omega_rad_s }));
        }
        below = above;
    }
    Ok(None)
}

/// The neutral point of the exact Theodorsen aerodynamics next to the flutter point of Jones's lags.
///
/// Newton's method on `F(i omega, V) u = 0`, `l.u = 1` with the derivatives of `F` exact; quadratic convergence.
///
/// # Errors
/// [`Error::NotConverged`] if Newton's method fails, else as [`lag_flutter`].
pub fn exact_flutter(model: &AeroelasticModel, rho: f64) -> Result<Option<Flutter>, Error> {
    let with_lags = AeroelasticModel {
        lags: JONES.to_vec(),
        ..model.clone()
    };
    let Some(start) = lag_flutter(&with_lags, rho)? else {
        return Ok(None);
    };
    refine_exact(model, rho, start).map(Some)
}

/// The aeroelastic operator of exact harmonic aerodynamics, `F(p, V)` with `F u = 0` for free motion `u exp(p t)`;
/// Theodorsen's function is taken at `k_j = Im(p) b_j / V`.
pub fn harmonic_operator(model: &AeroelasticModel, rho: f64, p: C64, speed: f64) -> Mat<C64> {
    let parts = OperatorParts::of(model);
    parts.assemble(model, rho, p, speed, &|k| theodorsen(k)).value
}

/// Natural frequencies with the apparent mass of still air \[rad/s\].
fn frequencies_in_still_air(model: &AeroelasticModel, rho: f64) -> Result<Vec<f64>, Error> {
    let (squares, _) =
        eigen::symmetric_generalized(model.structure.stiffness.as_ref(), model.mass(rho).as_ref())?;
    Ok(squares
        .into_iter()
        .filter(|w2| *w2 > 0.0)
        .map(f64::sqrt)
        .collect())
}

/// Non-circulatory matrices of the split in which the whole circulatory lift is proportional to the downwash.
struct OperatorParts {
    rate: Mat<f64>,
    displacement: Mat<f64>,
}

/// `F` and its derivatives with speed and frequency on `p = i omega`.
struct Operator {
    value: Mat<C64>,
    by_speed: Mat<C64>,
    by_omega: Mat<C64>,
}

impl OperatorParts {
    fn of(model: &AeroelasticModel) -> Self {
        let forces = &model.forces;
        Self {
            rate: forces.eta_etad() - &forces.eta_lambda_c * &model.downwash.w_etad,
            displacement: forces.eta_eta() - &forces.eta_lambda_c * &model.downwash.w_eta,
        }
    }

    fn assemble(
        &self,
        model: &AeroelasticModel,
        rho: f64,
        p: C64,
        speed: f64,
        kernel: &dyn Fn(f64) -> C64,
    ) -> Operator {
        let n = model.n_modes();
        let (omega, i) = (p.im, C64::i());
        let per_strip: Vec<(C64, C64, f64)> = model
            .strips
            .iter()
            .map(|s| {
                let k = omega * s.semi_chord() / speed;
                (kernel(k), theodorsen_derivative(k), k)
            })
            .collect();
        let (w_eta, w_etad) = (&model.downwash.w_eta, &model.downwash.w_etad);
        let circulation = |factor: &dyn Fn(usize, usize) -> C64| {
            let downwash = Mat::from_fn(model.strips.len(), n, |j, l| factor(j, l));
            let lift: Mat<C64> = Mat::from_fn(n, model.strips.len(), |r, j| {
                C64::from(model.forces.eta_lambda_c[(r, j)])
            });
            lift * downwash
        };
        let w = |j: usize, l: usize| speed * w_eta[(j, l)] + p * w_etad[(j, l)];
        let lift = circulation(&|j, l| per_strip[j].0 * w(j, l));
        let lift_by_speed = circulation(&|j, l| {
            per_strip[j].0 * w_eta[(j, l)] - per_strip[j].1 * (per_strip[j].2 / speed) * w(j, l)
        });
        let lift_by_omega = circulation(&|j, l| {
            let slope = if omega == 0.0 {
                C64::from(0.0)
            } else {
                per_strip[j].1 * (per_strip[j].2 / omega)
            };
            per_strip[j].0 * i * w_etad[(j, l)] + slope * w(j, l)
        });
        let mass = model.mass(rho);
        let structure = &model.structure;
        let at = |r: usize, c: usize| {
            let rate = structure.damping[(r, c)] - rho * speed * self.rate[(r, c)];
            let stiffness = structure.stiffness[(r, c)] - rho * speed * speed * self.displacement[(r, c)];
            let value = p * p * mass[(r, c)] + p * rate + stiffness - rho * speed * lift[(r, c)];
            let by_speed = -p * rho * self.rate[(r, c)]
                - 2.0 * rho * speed * self.displacement[(r, c)]
                - rho * (lift[(r, c)] + speed * lift_by_speed[(r, c)]);
            let by_omega = 2.0 * p * i * mass[(r, c)] + i * rate - rho * speed * lift_by_omega[(r, c)];
            (value, by_speed, by_omega)
        };
        Operator {
            value: Mat::from_fn(n, n, |r, c| at(r, c).0),
            by_speed: Mat::from_fn(n, n, |r, c| at(r, c).1),
            by_omega: Mat::from_fn(n, n, |r, c| at(r, c).2),
        }
    }
}

fn refine_exact(model: &AeroelasticModel, rho: f64, start: Flutter) -> Result<Flutter, Error> {
    const MOST_STEPS: usize = 60;
    let n = model.n_modes();
    let parts = OperatorParts::of(model);
    let (mut speed, mut omega) = (start.speed, start.omega_rad_s);
    let operator =
        |speed: f64, omega: f64| parts.assemble(model, rho, C64::new(0.0, omega), speed, &theodorsen);
    let mut shape = null_vector(&operator(speed, omega).value)?;
    let normal: Vec<C64> = shape.iter().map(|u| u.conj()).collect();
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let f = operator(speed, omega);
        let times = |m: &Mat<C64>| -> Vec<C64> {
            (0..n)
                .map(|r| (0..n).map(|c| m[(r, c)] * shape[c]).sum::<C64>())
                .collect()
        };
        let (residual, along_speed, along_omega) = (times(&f.value), times(&f.by_speed), times(&f.by_omega));
        // Real unknowns: Re u, Im u, V, omega.
        let size = 2 * n + 2;
        let mut jacobian = Mat::<f64>::zeros(size, size);
        let mut right = vec![0.0; size];
        for r in 0..n {
            for c in 0..n {
                let z = f.value[(r, c)];
                jacobian[(r, c)] = z.re;
                jacobian[(r, n + c)] = -z.im;
                jacobian[(n + r, c)] = z.im;
                jacobian[(n + r, n + c)] = z.re;
            }
            jacobian[(r, 2 * n)] = along_speed[r].re * speed;
            jacobian[(n + r, 2 * n)] = along_speed[r].im * speed;
            jacobian[(r, 2 * n + 1)] = along_omega[r].re * omega;
            jacobian[(n + r, 2 * n + 1)] = along_omega[r].im * omega;
            right[r] = -residual[r].re;
            right[n + r] = -residual[r].im;
        }
        // Rows of the operator are stiffness-sized; the normalisation rows are scaled to match.
        let scale = f.value.norm_max().max(f64::MIN_POSITIVE);
        let mut deficit = C64::new(1.0, 0.0);
        for c in 0..n {
            deficit -= normal[c] * shape[c];
            jacobian[(2 * n, c)] = scale * normal[c].re;
            jacobian[(2 * n, n + c)] = -scale * normal[c].im;
            jacobian[(2 * n + 1, c)] = scale * normal[c].im;
            jacobian[(2 * n + 1, n + c)] = scale * normal[c].re;
        }
        right[2 * n] = scale * deficit.re;
        right[2 * n + 1] = scale * deficit.im;
        let step = solve::solve_vec(jacobian.as_ref(), &right)?;
        // A full step that halves or doubles the speed has left the neighbourhood: shorten it.
        last_step = step[2 * n].abs().max(step[2 * n + 1].abs());
        let damping = (0.3 / last_step).min(1.0);
        for c in 0..n {
            shape[c] += damping * C64::new(step[c], step[n + c]);
        }
        speed *= 1.0 + damping * step[2 * n];
        omega *= 1.0 + damping * step[2 * n + 1];
        if last_step < 1e-13 {
            return Ok(Flutter {
                speed,
                omega_rad_s: omega,
            });
        }
    }
    if last_step < 1e-10 {
        return Ok(Flutter {
            speed,
            omega_rad_s: omega,
        });
    }
    Err(Error::NotConverged {
        what: "exact flutter point",
        iterations: MOST_STEPS,
        last_step,
    })
}

/// The direction that a nearly singular matrix shrinks most, of unit norm, by inverse iteration.
fn null_vector(a: &Mat<C64>) -> Result<Vec<C64>, Error> {
    let n = a.nrows();
    let mut x = Mat::from_fn(n, 1, |i, _| C64::new(1.0, 0.1 * (i as f64 + 1.0).sqrt()));
    let adjoint = a.adjoint().to_owned();
    for _ in 0..4 {
        let y = solve::solve_complex(adjoint.as_ref(), x.as_ref())?;
        x = solve::solve_complex(a.as_ref(), y.as_ref())?;
        let norm = x.norm_l2();
        for i in 0..n {
            x[(i, 0)] /= norm;
        }
    }
    Ok((0..n).map(|i| x[(i, 0)]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::section::TypicalSection;

    fn perry() -> TypicalSection {
        TypicalSection {
            mass: 31.41592653589793,
            static_moment: 6.283185307179586,
            inertia: 7.853981633974483,
            plunge_stiffness: 78539.81633974482,
            pitch_stiffness: 78539.81633974482,
            semi_chord: 1.0,
            axis: -0.4,
            cl_alpha: std::f64::consts::TAU,
        }
    }

    /// Perry, NASA/TP-2015-218765 app. C: 173.26 ft/s; ContourRoots' test gives 173.262350488 and 75.4620174044.
    #[test]
    fn val_nasa_tp_2015_218765() {
        let model = perry().model(&JONES).unwrap();
        let exact = exact_flutter(&model, 1.0).unwrap().unwrap();
        assert!((exact.speed / 173.262350488 - 1.0).abs() < 3e-12, "{exact:?}");
        assert!(
            (exact.omega_rad_s / 75.4620174044 - 1.0).abs() < 1e-11,
            "{exact:?}"
        );
        let jones = lag_flutter(&model, 1.0).unwrap().unwrap();
        assert!((jones.speed / 172.857309432729 - 1.0).abs() < 1e-9, "{jones:?}");
        let instant = lag_flutter(&perry().model(&[]).unwrap(), 1.0).unwrap().unwrap();
        assert!((instant.speed / 100.01064226 - 1.0).abs() < 1e-9, "{instant:?}");
        // K_alpha = 2 pi rho V^2 b^2 (a + 1/2) at divergence.
        let closed_form = (78539.81633974482 / (2.0 * std::f64::consts::PI * 0.1)).sqrt();
        let divergence = divergence_speed(&model, 1.0).unwrap().unwrap();
        assert!((divergence / closed_form - 1.0).abs() < 1e-13);
    }

    /// The operator's derivatives against central differences.
    #[test]
    fn val_operator_derivatives() {
        let model = perry().model(&JONES).unwrap();
        let parts = OperatorParts::of(&model);
        let at = |v: f64, w: f64| parts.assemble(&model, 1.0, C64::new(0.0, w), v, &theodorsen);
        let (v, w, h) = (150.0, 70.0, 1e-4);
        let f = at(v, w);
        let by_speed = (at(v + h, w).value - at(v - h, w).value) * faer_scale(0.5 / h);
        let by_omega = (at(v, w + h).value - at(v, w - h).value) * faer_scale(0.5 / h);
        assert!((by_speed - &f.by_speed).norm_max() < 1e-6 * f.by_speed.norm_max());
        assert!((by_omega - &f.by_omega).norm_max() < 1e-6 * f.by_omega.norm_max());
    }

    fn faer_scale(x: f64) -> albatross_numerics::faer::Scale<C64> {
        albatross_numerics::faer::Scale(C64::from(x))
    }

    #[test]
    fn prop_still_air_has_no_flutter() {
        let model = perry().model(&JONES).unwrap();
        assert_eq!(lag_flutter(&model, 0.0).unwrap(), None);
        assert!(matches!(
            lag_flutter(&model, f64::NAN),
            Err(Error::BadFlow { .. })
        ));
    }
}
