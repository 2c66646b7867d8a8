//! Roots: bracketed scalar equations, and damped Newton iteration for small systems.

use crate::solve::solve_vec;
use crate::{Error, Mat, Result};

/// A root with the effort it took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScalarRoot {
    /// The root.
    pub x: f64,
    /// Function value there.
    pub residual: f64,
    /// Evaluations of the function.
    pub evaluations: usize,
}

/// Root of a continuous function between `low` and `high` by Brent's method (Algorithms for Minimization
/// without Derivatives, 1973, ch. 4): never slower than bisection by more than a small factor.
///
/// The root is enclosed to `tolerance` (absolute) plus rounding.
///
/// # Errors
/// [`Error::NotBracketed`] without a sign change (or with a NaN at an end), [`Error::NotConverged`] when the
/// function turns into NaN inside.
pub fn brent(mut f: impl FnMut(f64) -> f64, low: f64, high: f64, tolerance: f64) -> Result<ScalarRoot> {
    const LIMIT: usize = 300;
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (f(a), f(b));
    let mut evaluations = 2;
    if fa.is_nan() || fb.is_nan() || fa * fb > 0.0 {
        return Err(Error::NotBracketed {
            low,
            high,
            at_low: fa,
            at_high: fb,
        });
    }
    // b is the best estimate, c the counterpoint with the other sign.
    let (mut c, mut fc) = (a, fa);
    let (mut step, mut previous_step) = (b - a, b - a);
    while evaluations < LIMIT {
        if fb.signum() == fc.signum() && fb != 0.0 {
            (c, fc) = (a, fa);
            (step, previous_step) = (b - a, b - a);
        }
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let least = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance;
        let middle = 0.5 * (c - b);
        if fb == 0.0 || middle.abs() <= least {
            return Ok(ScalarRoot {
                x: b,
                residual: fb,
                evaluations,
            });
        }
        let trial = interpolated_step((a, fa), (b, fb), (c, fc));
        let accept = previous_step.abs() >= least
            && fa.abs() > fb.abs()
            && trial * middle > 0.0
            && trial.abs() < (1.5 * middle.abs() - 0.5 * least).min(0.5 * previous_step.abs());
        (previous_step, step) = if accept { (step, trial) } else { (middle, middle) };
        (a, fa) = (b, fb);
        b += if step.abs() > least {
            step
        } else {
            least.copysign(middle)
        };
        fb = f(b);
        evaluations += 1;
        if fb.is_nan() {
            break;
        }
    }
    Err(Error::NotConverged {
        what: "Brent's method",
        iterations: evaluations,
        residual: fb.abs(),
        worst: 0,
    })
}

/// Step from b to the zero of the inverse parabola (or the secant when a = c).
fn interpolated_step((a, fa): (f64, f64), (b, fb): (f64, f64), (c, fc): (f64, f64)) -> f64 {
    if a == c {
        return -fb * (c - b) / (fc - fb);
    }
    let (q, r, s) = (fa / fc, fb / fc, fb / fa);
    let p = s * ((c - b) * q * (q - r) - (b - a) * (r - 1.0));
    -p / ((q - 1.0) * (r - 1.0) * (s - 1.0))
}

/// Root of a continuous function between `low` and `high` by bisection, enclosed to `tolerance` (absolute).
///
/// # Errors
/// [`Error::NotBracketed`] without a sign change.
pub fn bisect(mut f: impl FnMut(f64) -> f64, low: f64, high: f64, tolerance: f64) -> Result<ScalarRoot> {
    let (at_low, at_high) = (f(low), f(high));
    if at_low.is_nan() || at_high.is_nan() || at_low * at_high > 0.0 {
        return Err(Error::NotBracketed {
            low,
            high,
            at_low,
            at_high,
        });
    }
    for (x, residual) in [(low, at_low), (high, at_high)] {
        if residual == 0.0 {
            return Ok(ScalarRoot {
                x,
                residual,
                evaluations: 2,
            });
        }
    }
    let (mut a, mut b, mut evaluations) = (low, high, 2);
    loop {
        let x = 0.5 * (a + b);
        let residual = f(x);
        evaluations += 1;
        let exhausted = x == a || x == b;
        if residual == 0.0 || (b - a).abs() <= 2.0 * tolerance || exhausted {
            return Ok(ScalarRoot {
                x,
                residual,
                evaluations,
            });
        }
        if (residual > 0.0) == (at_low > 0.0) {
            a = x;
        } else {
            b = x;
        }
    }
}

/// When to stop [`newton`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonOptions {
    /// Largest magnitude allowed among the residuals (the caller scales them to order one).
    pub tolerance: f64,
    /// Most Jacobians evaluated.
    pub iterations: usize,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            iterations: 50,
        }
    }
}

/// A solution of a system with the effort it took.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemRoot {
    /// The solution.
    pub x: Vec<f64>,
    /// Largest magnitude among the residuals there.
    pub residual: f64,
    /// Jacobians evaluated.
    pub iterations: usize,
}

/// Damped Newton iteration for f(x) = 0 with as many equations as unknowns.
///
/// `f(x, r)` writes the residuals; `jacobian(x)` returns the matrix of dr_i/dx_j. Steps are halved until the
/// 2-norm of the residuals falls (Armijo's condition); one last undamped step is tried after convergence, to
/// end at rounding level where the residuals allow it.
///
/// # Errors
/// [`Error::NotConverged`] with the iterations, residual and worst equation; [`Error::Singular`] and
/// [`Error::NonFinite`] from the Jacobian.
pub fn newton(
    mut f: impl FnMut(&[f64], &mut [f64]),
    mut jacobian: impl FnMut(&[f64]) -> Mat<f64>,
    start: &[f64],
    options: NewtonOptions,
) -> Result<SystemRoot> {
    const LEAST_DAMPING: f64 = 1e-10;
    let (mut x, mut r) = (start.to_vec(), vec![0.0; start.len()]);
    f(&x, &mut r);
    for iteration in 0..=options.iterations {
        let (_, residual) = largest(&r);
        let finite = r.iter().all(|v| v.is_finite());
        let converged = finite && residual <= options.tolerance;
        if !finite || (!converged && iteration == options.iterations) {
            return Err(stopped(&r, iteration));
        }
        let newton_step = solve_vec(jacobian(&x).as_ref(), &r);
        if converged {
            if let Some((x, r)) = newton_step
                .ok()
                .and_then(|step| descend(&mut f, &x, &step, &r, 1.0))
            {
                return Ok(SystemRoot {
                    residual: largest(&r).1,
                    x,
                    iterations: iteration + 1,
                });
            }
            return Ok(SystemRoot {
                residual,
                x,
                iterations: iteration + 1,
            });
        }
        let lower = descend(&mut f, &x, &newton_step?, &r, LEAST_DAMPING);
        (x, r) = lower.ok_or_else(|| stopped(&r, iteration + 1))?;
    }
    Err(stopped(&r, options.iterations))
}

/// x - s step and its residuals for the first s = 1, 1/2, ... down to `least` that lowers their norm enough.
fn descend(
    f: &mut impl FnMut(&[f64], &mut [f64]),
    x: &[f64],
    step: &[f64],
    r: &[f64],
    least: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    const SUFFICIENT: f64 = 1e-4;
    let (mut trial, mut trial_r) = (vec![0.0; x.len()], vec![0.0; r.len()]);
    let mut damping = 1.0;
    while damping >= least {
        for ((t, x), s) in trial.iter_mut().zip(x).zip(step) {
            *t = x - damping * s;
        }
        f(&trial, &mut trial_r);
        if norm(&trial_r) <= (1.0 - SUFFICIENT * damping) * norm(r) {
            return Some((trial, trial_r));
        }
        damping *= 0.5;
    }
    None
}

/// Jacobian of `f` (`n` residuals) at `x` by central differences with steps `h_j` per unknown.
pub fn central_jacobian(mut f: impl FnMut(&[f64], &mut [f64]), x: &[f64], h: &[f64], n: usize) -> Mat<f64> {
    let mut jacobian = Mat::zeros(n, x.len());
    let (mut point, mut up, mut down) = (x.to_vec(), vec![0.0; n], vec![0.0; n]);
    for (j, (&xj, &hj)) in x.iter().zip(h).enumerate() {
        let (above, below) = (xj + hj, xj - hj);
        point[j] = above;
        f(&point, &mut up);
        point[j] = below;
        f(&point, &mut down);
        point[j] = xj;
        for i in 0..n {
            jacobian[(i, j)] = (up[i] - down[i]) / (above - below);
        }
    }
    jacobian
}

fn norm(r: &[f64]) -> f64 {
    r.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn largest(r: &[f64]) -> (usize, f64) {
    r.iter().enumerate().fold(
        (0, 0.0),
        |best, (i, v)| if v.abs() > best.1 { (i, v.abs()) } else { best },
    )
}

fn stopped(r: &[f64], iterations: usize) -> Error {
    let (worst, residual) = match r.iter().position(|v| !v.is_finite()) {
        Some(i) => (i, f64::NAN),
        None => largest(r),
    };
    Error::NotConverged {
        what: "Newton's method",
        iterations,
        residual,
        worst,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_scalar_roots_in_closed_form() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 5] = [
            (|x| x * x - 2.0, 0.0, 2.0, std::f64::consts::SQRT_2),
            (|x| x.cos(), 1.0, 2.0, std::f64::consts::FRAC_PI_2),
            (|x| x.powi(9), -1.0, 1.4, 0.0),
            (|x| if x < 0.3 { -1.0 } else { 1.0 }, 0.0, 1.0, 0.3),
            (|x| x - 1.0, 1.0, 3.0, 1.0),
        ];
        for (k, (f, low, high, exact)) in cases.into_iter().enumerate() {
            let tolerance = if k == 2 { 1e-4 } else { 1e-14 };
            for root in [
                brent(f, low, high, tolerance).unwrap(),
                bisect(f, low, high, tolerance).unwrap(),
            ] {
                assert!((root.x - exact).abs() <= 2.0 * tolerance, "case {k}: {root:?}");
            }
        }
        assert!(brent(|x| x * x - 2.0, 0.0, 2.0, 1e-14).unwrap().evaluations < 15);
    }

    #[test]
    fn val_missing_sign_change_is_an_error() {
        let f = |x: f64| x * x + 1.0;
        let expected = Error::NotBracketed {
            low: -1.0,
            high: 2.0,
            at_low: 2.0,
            at_high: 5.0,
        };
        assert_eq!(brent(f, -1.0, 2.0, 1e-9), Err(expected.clone()));
        assert_eq!(bisect(f, -1.0, 2.0, 1e-9), Err(expected));
        assert!(matches!(
            brent(|x| if x > 0.9 { x } else { f64::NAN }, -1.0, 1.0, 1e-9),
            Err(Error::NotBracketed { .. })
        ));
    }

    /// Freudenstein and Roth (1963): solution (5, 4); needs damping from (15, -2)... or stops in the local
    /// minimum, which must be reported and not returned.
    fn freudenstein_roth(x: &[f64], r: &mut [f64]) {
        r[0] = x[0] - 13.0 + ((5.0 - x[1]) * x[1] - 2.0) * x[1];
        r[1] = x[0] - 29.0 + ((x[1] + 1.0) * x[1] - 14.0) * x[1];
    }

    #[test]
    fn val_newton_on_a_system() {
        let jacobian = |x: &[f64]| {
            let rows = [
                [1.0, (10.0 - 3.0 * x[1]) * x[1] - 2.0],
                [1.0, (3.0 * x[1] + 2.0) * x[1] - 14.0],
            ];
            Mat::from_fn(2, 2, |i, j| rows[i][j])
        };
        let root = newton(freudenstein_roth, jacobian, &[6.0, 5.0], NewtonOptions::default()).unwrap();
        assert!(
            (root.x[0] - 5.0).abs() < 1e-13 && (root.x[1] - 4.0).abs() < 1e-13,
            "{root:?}"
        );
        let differences = |x: &[f64]| central_jacobian(freudenstein_roth, x, &[1e-5, 1e-5], 2);
        let again = newton(
            freudenstein_roth,
            differences,
            &[6.0, 5.0],
            NewtonOptions::default(),
        )
        .unwrap();
        assert!((again.x[0] - 5.0).abs() < 1e-12);
        // From (0.5, -2) the iteration ends in the local minimum at (11.41, -0.8968), residual norm 6.999.
        let stuck = newton(
            freudenstein_roth,
            jacobian,
            &[0.5, -2.0],
            NewtonOptions::default(),
        );
        assert!(
            matches!(stuck, Err(Error::NotConverged { residual, .. }) if residual > 1.0),
            "{stuck:?}"
        );
    }

    #[test]
    fn val_newton_names_the_worst_equation() {
        let f = |x: &[f64], r: &mut [f64]| {
            r[0] = x[0] - 1.0;
            r[1] = x[1] * x[1] + 1.0;
        };
        let jacobian = |x: &[f64]| {
            Mat::from_fn(2, 2, |i, j| {
                if i != j {
                    0.0
                } else if i == 0 {
                    1.0
                } else {
                    2.0 * x[1]
                }
            })
        };
        let result = newton(
            f,
            jacobian,
            &[0.0, 1.3],
            NewtonOptions {
                tolerance: 1e-10,
                iterations: 20,
            },
        );
        assert!(
            matches!(
                result,
                Err(Error::NotConverged { worst: 1, .. } | Error::Singular { .. })
            ),
            "{result:?}"
        );
    }
}
