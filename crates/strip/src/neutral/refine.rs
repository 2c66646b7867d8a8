//! From a bracket to the neutral point itself.

use super::{Bracket, NeutralPoint};
use crate::Error;
use crate::kernels::Kernel;
use crate::operator::ModalOperator;
use albatross_numerics::{C64, Mat, solve};

/// The neutral point inside a bracket; none if the change of side was an artefact of mistaken identity.
///
/// Newton's method from the interpolated crossing; where it leaves the bracket the bracket is halved.
pub(super) fn refine_within(
    modal: &ModalOperator,
    kernel: Kernel<'_>,
    bracket: Bracket,
) -> Result<Option<NeutralPoint>, Error> {
    const MOST_SECTIONS: usize = 12;
    let [mut a, mut b] = [0, 1].map(|i| (bracket.kappa[i].ln(), bracket.p[i]));
    let wide = a.0 - b.0;
    for _ in 0..MOST_SECTIONS {
        let drop = a.1.re - b.1.re;
        let share = if drop == 0.0 {
            0.5
        } else {
            (a.1.re / drop).clamp(0.0, 1.0)
        };
        let omega = a.1.im + share * (b.1.im - a.1.im);
        let kappa = (a.0 + share * (b.0 - a.0)).exp();
        if let Some((speed, omega)) = newton(modal, kernel, omega / kappa, omega)? {
            let found = (omega / speed).ln();
            if found <= a.0 + 0.5 * wide && found >= b.0 - 0.5 * wide {
                return direction(modal, kernel, speed, omega);
            }
        }
        if a.1.re * b.1.re >= 0.0 {
            break;
        }
        let middle = 0.5 * (a.0 + b.0);
        let expected = 0.5 * (a.1 + b.1);
        let roots = super::scan::roots(modal, kernel, middle.exp())?;
        let Some(p) = roots
            .into_iter()
            .min_by(|x, y| (x - expected).norm().total_cmp(&(y - expected).norm()))
        else {
            break;
        };
        if p.re * a.1.re > 0.0 {
            a = (middle, p);
        } else {
            b = (middle, p);
        }
    }
    Ok(None)
}

/// Newton's method on `F(i omega, V) u = 0`, `l.u = 1` in the unknowns u, ln V, ln omega; none if it does not
/// converge.
fn newton(
    modal: &ModalOperator,
    kernel: Kernel<'_>,
    mut speed: f64,
    mut omega: f64,
) -> Result<Option<(f64, f64)>, Error> {
    const MOST_STEPS: usize = 40;
    let weights = weights(modal, omega);
    let evaluate = |speed: f64, omega: f64| {
        let p = C64::new(0.0, omega);
        modal.operator.evaluate(p, speed, kernel).scaled(&weights)
    };
    let Some(NullVectors { right: mut shape, .. }) = null_vectors(&evaluate(speed, omega).value)? else {
        return Ok(None);
    };
    let normal: Vec<C64> = shape.iter().map(|u| u.conj()).collect();
    let mut last_step = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let f = evaluate(speed, omega);
        let (along_omega, i) = (&f.by_p, C64::i());
        let by_ln_omega = Mat::from_fn(f.value.nrows(), f.value.ncols(), |r, c| {
            i * omega * along_omega[(r, c)] + f.by_ln_s[(r, c)]
        });
        let Ok((change, [by_speed, by_omega])) =
            bordered_step(&f.value, [&f.by_ln_speed, &by_ln_omega], &shape, &normal)
        else {
            return Ok(None);
        };
        // A step that would halve or double the speed has left the neighbourhood: shorten it.
        let step = by_speed.abs().max(by_omega.abs());
        let damping = (0.2 / step).min(1.0);
        shape
            .iter_mut()
            .zip(&change)
            .for_each(|(u, du)| *u += damping * du);
        speed *= 1.0 + damping * by_speed;
        omega *= 1.0 + damping * by_omega;
        // At rounding level steps no longer fall.
        if step < 1e-14 || (step < 1e-11 && step >= 0.5 * last_step) {
            return Ok(Some((speed, omega)));
        }
        last_step = step;
        if !(speed.is_finite() && omega.is_finite()) {
            return Ok(None);
        }
    }
    Ok((last_step < 1e-10).then_some((speed, omega)))
}

/// Scales by which rows and columns of F near `p = i omega` become of one size.
pub(crate) fn weights(modal: &ModalOperator, omega: f64) -> Vec<f64> {
    modal.omega.iter().map(|w| 1.0 / w.hypot(omega)).collect()
}

/// The step of Newton's method for `F u = 0`, `l.u = 1` with two real parameters on which F depends.
///
/// A multiple root, as of two wings alike, leaves the shape undetermined within its space: then the smallest step.
///
/// # Errors
/// Those of the linear solvers, for entries that are not finite.
pub(crate) fn bordered_step(
    value: &Mat<C64>,
    by_parameter: [&Mat<C64>; 2],
    shape: &[C64],
    normal: &[C64],
) -> Result<(Vec<C64>, [f64; 2]), albatross_numerics::Error> {
    let n = shape.len();
    let times = |m: &Mat<C64>, r: usize| -> C64 { (0..n).map(|c| m[(r, c)] * shape[c]).sum() };
    // Real unknowns: Re u, Im u, the parameters.
    let size = 2 * n + 2;
    let mut jacobian = Mat::<f64>::zeros(size, size);
    let mut right = vec![0.0; size];
    let mut write = |row: usize, column: usize, z: C64| {
        jacobian[(row, column)] = z.re;
        jacobian[(row, n + column)] = -z.im;
        jacobian[(n + row, column)] = z.im;
        jacobian[(n + row, n + column)] = z.re;
    };
    (0..n).for_each(|r| (0..n).for_each(|c| write(r, c, value[(r, c)])));
    // Rows of the operator are stiffness-sized; the normalisation is scaled to match.
    let scale = value.norm_max().max(f64::MIN_POSITIVE);
    let mut deficit = C64::new(1.0, 0.0);
    for c in 0..n {
        deficit -= normal[c] * shape[c];
        jacobian[(2 * n, c)] = scale * normal[c].re;
        jacobian[(2 * n, n + c)] = -scale * normal[c].im;
        jacobian[(2 * n + 1, c)] = scale * normal[c].im;
        jacobian[(2 * n + 1, n + c)] = scale * normal[c].re;
    }
    for r in 0..n {
        for (column, matrix) in by_parameter.into_iter().enumerate() {
            let z = times(matrix, r);
            jacobian[(r, 2 * n + column)] = z.re;
            jacobian[(n + r, 2 * n + column)] = z.im;
        }
        let residual = times(value, r);
        right[r] = -residual.re;
        right[n + r] = -residual.im;
    }
    right[2 * n] = scale * deficit.re;
    right[2 * n + 1] = scale * deficit.im;
    let step = match solve::solve_vec(jacobian.as_ref(), &right) {
        Err(albatross_numerics::Error::Singular { .. }) => {
            const RANK: f64 = 1e-11;
            let right = Mat::from_fn(size, 1, |r, _| right[r]);
            let fit = solve::least_squares_with_rank(jacobian.as_ref(), right.as_ref(), RANK)?;
            (0..size).map(|r| fit.x[(r, 0)]).collect()
        }
        step => step?,
    };
    Ok((
        (0..n).map(|c| C64::new(step[c], step[n + c])).collect(),
        [step[2 * n], step[2 * n + 1]],
    ))
}

/// Right and left vectors of a singular matrix.
pub(crate) struct NullVectors {
    pub(crate) right: Vec<C64>,
    pub(crate) left: Vec<C64>,
}

/// The vectors that F shrinks most, of unit norm: `F u = 0`, `l^H F = 0`. None if F is not finite.
pub(crate) fn null_vectors(value: &Mat<C64>) -> Result<Option<NullVectors>, Error> {
    let n = value.nrows();
    if !value.norm_max().is_finite() {
        return Ok(None);
    }
    let svd = value
        .svd()
        .map_err(|_| albatross_numerics::Error::NoConvergence {
            what: "the singular value decomposition",
            size: n,
        })?;
    let last = n.saturating_sub(1);
    Ok(Some(NullVectors {
        right: (0..n).map(|k| svd.V()[(k, last)]).collect(),
        left: (0..n).map(|k| svd.U()[(k, last)]).collect(),
    }))
}

/// `l^H A r`.
pub(crate) fn form(left: &[C64], right: &[C64], entry: impl Fn(usize, usize) -> C64) -> C64 {
    (0..left.len())
        .map(|r| left[r].conj() * (0..right.len()).map(|c| entry(r, c) * right[c]).sum::<C64>())
        .sum()
}

/// The point with the rate at which its mode passes the axis; none if the speed does not move it.
fn direction(
    modal: &ModalOperator,
    kernel: Kernel<'_>,
    speed: f64,
    omega: f64,
) -> Result<Option<NeutralPoint>, Error> {
    let p = C64::new(0.0, omega);
    let f = modal
        .operator
        .evaluate(p, speed, kernel)
        .scaled(&weights(modal, omega));
    let Some(NullVectors { right, left }) = null_vectors(&f.value)? else {
        return Ok(None);
    };
    let by_p = form(&left, &right, |r, c| f.by_p[(r, c)] + f.by_ln_s[(r, c)] / p);
    let by_ln_speed = form(&left, &right, |r, c| f.by_ln_speed[(r, c)]);
    let growth = (-by_ln_speed / by_p).re / omega;
    Ok((growth.abs() > 1e-9).then_some(NeutralPoint {
        speed,
        omega_rad_s: omega,
        growth,
    }))
}
