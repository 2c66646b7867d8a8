//! Pole relocation: the refined instrumental-variable method in the basis of the present poles.
//!
//! With sigma(s) = 1 + sum k_i x_i(s), x_i being the states of the present blocks, the equation error of
//! ```text
//! sigma y = (numerator) u          y = sum c_i X_i[u] (+ d u) + free motion - sum k_i X_i[y]
//! ```
//! is linear, and the zeros of sigma, the eigenvalues of A - b k', are the new poles. At the fixed point sigma = 1 and
//! the equation error is the output error filtered by nothing. In polynomial form this is SRIVC (Young and Jakeman,
//! Int. J. Control 29, 1979; Young, Automatica 17, 1981); in the basis of the poles it is vector fitting in the time
//! domain (Gustavsen and Semlyen, IEEE Trans. Power Delivery 14, 1999) and keeps its digits at any order. Noise in X\[y\]
//! biases plain least squares; the instruments X\[yhat\] of the fitted model's output are free of it.
//!
//! One sweep with fixed blocks and plain least squares is the method of state-variable filters.
//!
//! Equations: THEORY (31).

use albatross_numerics::eigen::eigenvalues;
use albatross_numerics::solve::solve_vec;
use albatross_numerics::{C64, Mat};

use crate::blocks::{Block, from_poles, order, state_matrices};
use crate::elimination::{Elimination, Record, solve_triangle};
use crate::filters::{Bank, Timing};
use crate::numerator::Freedom;
use crate::problem::{Columns, Fitted, Point, Problem};
use crate::{Intersample, Result};

/// Relative change of the poles at which the sweeps have converged.
const SETTLED: f64 = 1e-7;
/// A reflected pole keeps at least this damping.
const LEAST_DAMPING: f64 = 1e-3;

/// How the sweeps go.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sweeps {
    /// Most sweeps.
    pub(crate) most: usize,
    /// Sweeps by plain least squares before instruments are used; as many as `most` for none.
    pub(crate) plain: usize,
    /// Whether unstable poles are reflected.
    pub(crate) stable: bool,
}

/// Sweeps from a start; the best point met, by output error.
pub(crate) fn relocate(problem: &Problem<'_>, start: Point, sweeps: Sweeps) -> Result<Fitted> {
    let mut fitted = problem.fit(start)?;
    let mut best = fitted.clone();
    for sweep in 0..sweeps.most {
        let instruments = sweep >= sweeps.plain;
        let Ok(blocks) = new_blocks(problem, &fitted, instruments, sweeps) else {
            break;
        };
        let point = Point {
            blocks,
            delay: fitted.point.delay,
        };
        let change = change(&fitted.point.blocks, &point.blocks);
        if !point.is_usable() {
            break;
        }
        fitted = problem.fit(point)?;
        if !fitted.cost().is_finite() {
            break;
        }
        if fitted.cost() < best.cost() {
            best = fitted.clone();
        }
        if change < SETTLED {
            break;
        }
    }
    Ok(best)
}

/// The denominator after one sweep.
fn new_blocks(
    problem: &Problem<'_>,
    fitted: &Fitted,
    instruments: bool,
    sweeps: Sweeps,
) -> Result<Vec<Block>> {
    let blocks = &fitted.point.blocks;
    let n = order(blocks);
    let timing = problem.timing(fitted.point.delay);
    let bank = Bank::new(blocks, timing)?;
    // Outputs have no delay, and between samples they are nearer to lines than to steps.
    let output_timing = Timing::new(problem.data.dt(), Intersample::Foh, 0.0);
    let output_bank = if output_timing == timing {
        bank.clone()
    } else {
        Bank::new(blocks, output_timing)?
    };
    let freedom = Freedom::new(blocks, problem.zeros);
    let offsets = problem.data.experiments.iter().any(|e| e.estimate_offset);
    let mut records = vec![Vec::new(); problem.outputs()];
    let mut n_own = 0;
    for (e, experiment) in problem.data.experiments.iter().enumerate() {
        // A constant in y passes the filters as a constant and free motions.
        let ring = problem.ring(&bank, e, problem.free_initial || offsets, false);
        let x = bank.respond(&experiment.input, false, problem.block).x;
        let mut columns = Columns {
            local: problem.local(e, &ring),
            own: problem.own(e, x, &freedom, timing),
            shared: Vec::new(),
        };
        n_own = columns.own.len();
        let predicted = if instruments {
            problem.predict(fitted, e)?
        } else {
            Vec::new()
        };
        for (o, of_output) in records.iter_mut().enumerate() {
            columns.shared = match predicted.get(o) {
                Some(y) => output_bank.respond(y, false, problem.block).x,
                None => Vec::new(),
            };
            columns.shared.extend(
                output_bank
                    .respond(&experiment.outputs[o], false, problem.block)
                    .x,
            );
            of_output.push(Record {
                local: columns.local.len(),
                matrix: columns.matrix(&[&problem.measured(e, o)]),
                factor: problem.factors[o][e],
            });
        }
    }
    let shared = if instruments { 2 * n } else { n };
    let (r, y) = Elimination::new(n_own, shared, records).reduced();
    if y.len() < n {
        // Fewer equations than unknowns: nothing to move by.
        return Ok(blocks.clone());
    }
    let k = if instruments {
        // Rows of the instruments: Z'(Y - K k) = 0.
        let square = Mat::from_fn(n, n, |i, j| r[(i, n + j)]);
        solve_vec(square.as_ref(), &y[..n])?
    } else {
        solve_triangle(r.as_ref(), &y)?
    };
    // y = .. - X[y] k: sigma = 1 + k' x has k with the opposite sign.
    let (a, b) = state_matrices(blocks);
    let moved = Mat::from_fn(n, n, |i, j| a[(i, j)] + b[i] * k[j]);
    let mut poles = eigenvalues(moved.as_ref())?;
    if sweeps.stable {
        poles.iter_mut().for_each(|p| *p = reflected(*p));
    }
    Ok(from_poles(&poles))
}

/// The pole in the open left half plane.
pub(crate) fn reflected(p: C64) -> C64 {
    if p.re < 0.0 {
        p
    } else {
        C64::new(-p.re.max(LEAST_DAMPING * p.norm()).max(1e-9), p.im)
    }
}

/// Largest relative change from block to block.
fn change(old: &[Block], new: &[Block]) -> f64 {
    if old.len() != new.len() {
        return f64::INFINITY;
    }
    let relative = |p: f64, q: f64, scale: f64| (p - q).abs() / scale.abs().max(f64::MIN_POSITIVE);
    old.iter()
        .zip(new)
        .map(|(p, q)| match (*p, *q) {
            (Block::First { a: p }, Block::First { a: q }) => relative(p, q, p),
            (Block::Second { a1: p1, a0: p0 }, Block::Second { a1: q1, a0: q0 }) => {
                relative(p0, q0, p0).max(relative(p1, q1, p0.abs().sqrt()))
            }
            _ => f64::INFINITY,
        })
        .fold(0.0, f64::max)
}
