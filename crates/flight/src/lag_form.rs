//! A state space whose lag states do not act on each other.
//!
//! The lag rates of Eq. 9 contain `etadd`, which contains all lags: the block of lag states in `A` is full. With
//! `nu_i = lambda_i - A_i w`, `w = V w_eta eta + w_etad etad`, they obey `nu_i' = (2 V a_i/c) (nu_i + A_i w)`, and the block
//! is diagonal. The transformation changes neither eigenvalues nor transfer functions, and a frequency response can
//! eliminate the lags one by one.
//!
//! Equations: THEORY (26).

use crate::Error;
use crate::aircraft::Fidelity;
use crate::equations::{EquationsOfMotion, ensure_size};
use albatross_lti::StateSpace;
use albatross_numerics::Mat;

/// The linearised `system` of `equations` about a flight at `speed` \[m/s\] in the states `nu` instead of `lambda`; unchanged
/// for models without lags.
///
/// # Errors
/// [`Error::Sizes`] for the system of other equations; [`Error::Lti`] for a speed that is not finite and for a system that
/// fails its check.
pub fn diagonal_lag_form(
    system: &StateSpace,
    equations: &EquationsOfMotion,
    speed: f64,
) -> Result<StateSpace, Error> {
    let layout = equations.layout();
    system.check()?;
    ensure_size("states of the linear system", system.a.nrows(), layout.n_states())?;
    let part = match (&equations.aircraft().elastic, equations.options().fidelity) {
        (Some(part), Fidelity::Unsteady) if layout.n_lags > 0 => part,
        _ => return Ok(system.clone()),
    };
    let (first_lag, n_strips) = (layout.lags().start, layout.n_strips);
    let (eta, n) = (layout.eta().start, layout.n_modes);
    let downwash = &part.model.downwash;
    // lambda = nu + shift [eta; etad]
    let shift = Mat::from_fn(layout.n_lags, 2 * n, |row, k| {
        let (lag, strip) = (row / n_strips, row % n_strips);
        let gain = part.model.lags.get(lag).map_or(0.0, |l| l.gain);
        gain * if k < n {
            speed * downwash.w_eta[(strip, k)]
        } else {
            downwash.w_etad[(strip, k - n)]
        }
    });
    let to_new_columns = |m: &Mat<f64>| {
        let mut out = m.clone();
        let add = m.submatrix(0, first_lag, m.nrows(), layout.n_lags) * &shift;
        for j in 0..2 * n {
            for i in 0..m.nrows() {
                out[(i, eta + j)] += add[(i, j)];
            }
        }
        out
    };
    let to_new_rows = |m: &Mat<f64>| {
        let mut out = m.clone();
        let remove = &shift * m.submatrix(eta, 0, 2 * n, m.ncols());
        for j in 0..m.ncols() {
            for i in 0..layout.n_lags {
                out[(first_lag + i, j)] -= remove[(i, j)];
            }
        }
        out
    };
    let mut a = to_new_rows(&to_new_columns(&system.a));
    clear_rounding(&mut a, first_lag, layout.n_lags);
    let mut states = system.states.clone();
    for state in states.iter_mut().skip(first_lag) {
        state.name = state.name.replacen("lambda", "nu", 1);
    }
    Ok(StateSpace::try_new(
        (
            a,
            to_new_rows(&system.b),
            to_new_columns(&system.c),
            system.d.clone(),
        ),
        states,
        system.inputs.clone(),
        system.outputs.clone(),
    )?)
}

/// Off the diagonal of the lag block only rounding is left, of differences of numbers as large as the matrix's: it is
/// removed. Anything larger stays, for the solver to refuse.
fn clear_rounding(a: &mut Mat<f64>, first: usize, n: usize) {
    let rounding = 1e-12 * a.norm_max();
    for j in first..first + n {
        for i in first..first + n {
            if i != j && a[(i, j)].abs() <= rounding {
                a[(i, j)] = 0.0;
            }
        }
    }
}
