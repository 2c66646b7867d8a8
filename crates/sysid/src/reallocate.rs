//! Poles that explain next to nothing are tried elsewhere.
//!
//! A weak mode beside strong ones is easily missed: its pair of poles has settled on noise, or doubles a strong mode, and
//! the output-error cost has a local minimum there. So after the search the weakest blocks are taken out one at a time, and
//! a pair is put where it would lower the cost most: for a grid of frequencies and damping ratios, the part of the residual
//! that the pair's two columns explain once the numerators and the first-order motion of all other poles are projected out
//! (a matching pursuit: Mallat and Zhang, IEEE Trans. Signal Processing 41, 1993; orthogonalised as by Chen, Billings and
//! Luo, Int. J. Control 50, 1989). The search goes on from there, and the move is kept if the cost has fallen.

use std::f64::consts::PI;

use albatross_numerics::Mat;
use albatross_numerics::matrix::dot;
use albatross_numerics::solve::eliminate;

use crate::Result;
use crate::blocks::{Block, order};
use crate::filters::Bank;
use crate::numerator::Freedom;
use crate::problem::{Fitted, Point, Problem, matrix};
use crate::refine::{Iteration, Refined, Search, SearchMethod, refine};
use crate::spectrum::log_grid;
use crate::start::bandwidth;

/// Frequencies of the grid.
const FREQUENCIES: usize = 90;
/// Damping ratios of the grid.
const DAMPINGS: [f64; 2] = [0.025, 0.1];
/// Weakest blocks tried in a round.
const WEAKEST: usize = 4;
/// Places tried for each of them.
const PLACES: usize = 3;
/// Searches allowed for every move allowed.
const SEARCHES_A_MOVE: usize = 3;
/// Iterations of the search after a move.
const ITERATIONS: usize = 15;
/// A move is kept if it lowers the cost by this share.
const WORTH_KEEPING: f64 = 1e-5;
/// A place is tried if the cost expected there exceeds the present one by no more than this factor of it. What is expected
/// is linearised about poles that the removal has left behind, and tenfold too high where a neighbour had leant on the pair
/// removed; the number of searches bounds the work.
const WORTH_TRYING: f64 = 1.0;
/// Places nearer than this, in the logarithm of the frequency, are one.
const APART: f64 = 0.04;

/// Responses of the candidates, which do not depend on the model.
pub(crate) struct Scan {
    blocks: Vec<Block>,
    /// Two columns a candidate, by experiment.
    columns: Vec<Mat<f64>>,
}

impl Scan {
    pub(crate) fn new(problem: &Problem<'_>) -> Result<Self> {
        let data = problem.data;
        let longest = data.longest();
        let nyquist = PI / data.dt();
        let low = (2.0 * PI / longest).min(0.1 * nyquist);
        let high = (3.0 * bandwidth(data)).clamp(4.0 * low, 0.9 * nyquist);
        let blocks: Vec<Block> = log_grid(low, high, FREQUENCIES)
            .into_iter()
            .flat_map(|w| {
                DAMPINGS.map(|zeta| Block::Second {
                    a1: 2.0 * zeta * w,
                    a0: w * w,
                })
            })
            .collect();
        let bank = Bank::new(&blocks, problem.timing(0.0))?;
        let columns = data
            .experiments
            .iter()
            .map(|experiment| {
                let x = bank.respond(&experiment.input, false, problem.block).x;
                matrix(&x.iter().collect::<Vec<_>>())
            })
            .collect();
        Ok(Self { blocks, columns })
    }
}

/// Moves poles as long as that lowers the cost, at most `most` of them.
pub(crate) fn reallocate(
    problem: &Problem<'_>,
    start: Refined,
    search: Search,
    most: usize,
    scan: &Scan,
) -> Result<Refined> {
    let mut best = start;
    let search = Search {
        most: ITERATIONS.min(search.most),
        method: SearchMethod::Auto,
        ..search
    };
    let mut searches = SEARCHES_A_MOVE.saturating_mul(most);
    for _ in 0..most {
        let Some(better) = one_move(problem, &best, search, scan, &mut searches)? else {
            break;
        };
        let mut log: Vec<Iteration> = std::mem::take(&mut best.log);
        log.extend(better.log);
        best = Refined { log, ..better };
    }
    Ok(best)
}

/// The first move that lowers the cost.
///
/// `searches` counts down those that are left.
fn one_move(
    problem: &Problem<'_>,
    from: &Refined,
    search: Search,
    scan: &Scan,
    searches: &mut usize,
) -> Result<Option<Refined>> {
    let point = &from.fitted.point;
    let cost = from.fitted.cost();
    let mut weak: Vec<(usize, f64)> = Vec::new();
    let reduced = Problem {
        zeros: problem.zeros.saturating_sub(2),
        ..problem.clone()
    };
    for (i, block) in point.blocks.iter().enumerate() {
        if block.order() == 2 && point.blocks.len() > 1 {
            let without = reduced.fit(without(point, i))?;
            weak.push((i, without.cost()));
        }
    }
    weak.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (i, _) in weak.into_iter().take(WEAKEST) {
        let rest = reduced.fit(without(point, i))?;
        for (block, expected) in places(&reduced, &rest, point.blocks[i], scan)? {
            if expected > cost * (1.0 + WORTH_TRYING) || *searches == 0 {
                break;
            }
            *searches -= 1;
            let mut blocks = rest.point.blocks.clone();
            blocks.push(block);
            let moved = Point {
                blocks,
                delay: point.delay,
            };
            let Ok(refined) = problem
                .fit(moved)
                .and_then(|fitted| refine(problem, fitted, search))
            else {
                continue;
            };
            if refined.fitted.cost() < cost * (1.0 - WORTH_KEEPING) {
                return Ok(Some(refined));
            }
        }
    }
    Ok(None)
}

fn without(point: &Point, i: usize) -> Point {
    let mut blocks = point.blocks.clone();
    blocks.remove(i);
    Point {
        blocks,
        delay: point.delay,
    }
}

/// The best places for a pair beside the blocks of `rest`, away from the block that was there, with the cost expected.
fn places(problem: &Problem<'_>, rest: &Fitted, removed: Block, scan: &Scan) -> Result<Vec<(Block, f64)>> {
    let gains = gains(problem, rest, scan)?;
    let mut ranked: Vec<usize> = (0..scan.blocks.len()).collect();
    ranked.sort_by(|p, q| gains[*q].total_cmp(&gains[*p]));
    let mut taken = vec![removed];
    let mut found = Vec::new();
    for k in ranked {
        let block = scan.blocks[k];
        let near = |other: &Block| (block.scale() / other.scale()).ln().abs() < APART;
        if taken.iter().any(near) {
            continue;
        }
        taken.push(block);
        found.push((block, rest.cost() - gains[k]));
        if found.len() == PLACES {
            break;
        }
    }
    Ok(found)
}

/// Reduction of the cost by each candidate, the other unknowns free to first order.
fn gains(problem: &Problem<'_>, rest: &Fitted, scan: &Scan) -> Result<Vec<f64>> {
    let timing = problem.timing(rest.point.delay);
    let bank = Bank::new(&rest.point.blocks, timing)?;
    // All coefficients of the numerator: candidates are compared, not adopted.
    let free = Freedom::new(&rest.point.blocks, order(&rest.point.blocks));
    let mut gains = vec![0.0; scan.blocks.len()];
    for o in 0..problem.outputs() {
        let mut parts = Vec::new();
        let mut n_own = 0;
        for (e, experiment) in problem.data.experiments.iter().enumerate() {
            let ring = problem.ring(&bank, e, problem.free_initial, true);
            let forced = bank.respond(&experiment.input, true, problem.block);
            let local = problem.local(e, &ring);
            let shared = problem.shared(rest, e, o, &forced, &ring);
            let own = problem.own(e, forced.x, &free, timing);
            n_own = own.len() + shared.len();
            let model: Vec<&Vec<f64>> = local.iter().chain(&own).chain(&shared).collect();
            let model = matrix(&model);
            let measured = matrix(&[&problem.measured(e, o)]);
            let candidates = &scan.columns[e];
            let (rows, known) = (model.nrows(), model.ncols());
            let mut part = Mat::zeros(rows, known + candidates.ncols() + 1);
            part.submatrix_mut(0, 0, rows, known).copy_from(&model);
            part.submatrix_mut(0, known, rows, candidates.ncols())
                .copy_from(candidates);
            part.submatrix_mut(0, known + candidates.ncols(), rows, 1)
                .copy_from(&measured);
            part *= albatross_numerics::faer::Scale(problem.factors[o][e]);
            let n = local.len();
            eliminate(&mut part, n);
            let rows = n.min(part.nrows());
            parts.push(
                part.submatrix(rows, n, part.nrows() - rows, part.ncols() - n)
                    .to_owned(),
            );
        }
        let rows = parts.iter().map(Mat::nrows).sum();
        let mut all = Mat::zeros(rows, parts.first().map_or(0, Mat::ncols));
        let mut at = 0;
        for part in &parts {
            all.submatrix_mut(at, 0, part.nrows(), part.ncols())
                .copy_from(part);
            at += part.nrows();
        }
        eliminate(&mut all, n_own);
        let below = n_own.min(rows);
        let column = |j: usize| &all.col_as_slice(n_own + j)[below..];
        let y = column(2 * scan.blocks.len());
        for (k, gain) in gains.iter_mut().enumerate() {
            let (a, b) = (column(2 * k), column(2 * k + 1));
            let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
            let (ya, yb) = (dot(a, y), dot(b, y));
            // [ya yb] G^-1 [ya yb]'; columns that are nearly one count as one.
            let determinant = aa * bb - ab * ab;
            let explained = if determinant > 1e-10 * aa * bb {
                (ya * ya * bb - 2.0 * ya * yb * ab + yb * yb * aa) / determinant
            } else if aa > 0.0 {
                ya * ya / aa
            } else {
                0.0
            };
            *gain += explained;
        }
    }
    Ok(gains)
}
