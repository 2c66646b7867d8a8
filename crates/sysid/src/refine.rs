//! Output-error non-linear least squares with exact sensitivities.
//!
//! Numerators, initial states and constants are eliminated at every step (variable projection, Golub and Pereyra 1973, in
//! the form of Kaufman, BIT 15, 1975), so the search runs in the parameters of the denominator alone:
//! ```text
//! min over p of V(p) = sum_e,o w_eo |y_eo - yhat_eo(p)|^2,      step from  min |J dp - r|,   J = U S W'
//! ```
//! Directions, tried in turn or alone: Gauss-Newton on the subspace of the singular values that count, Gauss-Newton with
//! an adaptive bound for them, Levenberg-Marquardt (1944, 1963), steepest descent. Each is halved until V falls.
//! The order and the constants are those documented for MATLAB's `tfest` (Ljung, System Identification Toolbox).
//!
//! Equations: THEORY (29), (32).

use albatross_numerics::Mat;
use albatross_numerics::faer::linalg::solvers::Svd;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::blocks::{Block, repaired};
use crate::problem::{Fitted, Point, Problem};

/// Direction of search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SearchMethod {
    /// All of the following in turn; the first that lowers the cost is taken.
    Auto,
    /// Gauss-Newton on the subspace of singular values above rounding.
    SubspaceGaussNewton,
    /// Gauss-Newton on a subspace that grows with success.
    AdaptiveGaussNewton,
    /// Levenberg-Marquardt.
    LevenbergMarquardt,
    /// Steepest descent.
    SteepestDescent,
}

const IN_TURN: [SearchMethod; 4] = [
    SearchMethod::SubspaceGaussNewton,
    SearchMethod::AdaptiveGaussNewton,
    SearchMethod::LevenbergMarquardt,
    SearchMethod::SteepestDescent,
];

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// The improvement expected of the next step is below the tolerance.
    Converged,
    /// The residual is rounding.
    Exact,
    /// No direction lowers the cost.
    NoDescent,
    /// The greatest number of iterations.
    Iterations,
}

impl core::fmt::Display for Stop {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Converged => "the expected improvement is below the tolerance",
            Self::Exact => "the residual is rounding",
            Self::NoDescent => "no direction lowers the cost further",
            Self::Iterations => "the greatest number of iterations was reached",
        })
    }
}

/// One iteration of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Iteration {
    /// Weighted sum of squares after the iteration.
    pub cost: f64,
    /// Length of the step in units of the blocks' scales.
    pub step: f64,
    /// Reduction of the cost that the linearised problem promised, share of the cost.
    pub expected: f64,
    /// Direction taken.
    pub method: SearchMethod,
    /// Times the step was halved, or the damping raised.
    pub halvings: usize,
    /// Samples summed up in one row of the equations; 1 in the last part of every search.
    pub samples_a_row: usize,
}

/// Settings of the search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search {
    pub(crate) method: SearchMethod,
    pub(crate) most: usize,
    pub(crate) tolerance: f64,
    pub(crate) stable: bool,
    pub(crate) largest_delay: f64,
}

/// Result of a search.
#[derive(Debug, Clone)]
pub(crate) struct Refined {
    pub(crate) fitted: Fitted,
    pub(crate) log: Vec<Iteration>,
    pub(crate) stop: Stop,
}

/// State that directions carry from one iteration to the next.
#[derive(Debug, Clone, Copy)]
struct Memory {
    /// Bound of the adaptive subspace, share of the largest singular value.
    gamma: f64,
    /// Damping of Levenberg-Marquardt, share of the largest squared singular value.
    damping: f64,
}

/// Most halvings of a step.
const HALVINGS: usize = 8;
/// Share of the weighted sum of squares of the data that is rounding.
const ROUNDING: f64 = 1e-27;

/// Below this share of the tolerance even the last step is not worth its cost.
const LAST_STEP: f64 = 1e-3;
/// Poles slower than this share of a radian over the longest record are drift: no step leads further down.
const SLOWEST: f64 = 1e-3;
/// Poles faster than this, in radians a sample, are a direct path: no step leads further up.
const FASTEST: f64 = 10.0;

/// Searches from a fitted point.
pub(crate) fn refine(problem: &Problem<'_>, start: Fitted, search: Search) -> Result<Refined> {
    let total = total(problem);
    let mut fitted = start;
    let mut log = Vec::new();
    let mut memory = Memory {
        gamma: 1e-4,
        damping: 1e-3,
    };
    let stop = loop {
        if fitted.cost() <= ROUNDING * total {
            break Stop::Exact;
        }
        if log.len() >= search.most {
            break Stop::Iterations;
        }
        let blocks = repaired(&fitted.point.blocks);
        if blocks != fitted.point.blocks {
            let point = Point {
                blocks,
                delay: fitted.point.delay,
            };
            fitted = problem.fit(point)?;
        }
        let decomposed = Decomposed::new(problem, &fitted)?;
        let expected = decomposed.explained() / fitted.cost();
        if expected.is_nan() || expected < LAST_STEP * search.tolerance {
            break Stop::Converged;
        }
        let Some(step) = descend(problem, &fitted, &decomposed, search, &mut memory) else {
            break Stop::NoDescent;
        };
        let gain = 1.0 - step.fitted.cost() / fitted.cost();
        log.push(Iteration {
            cost: step.fitted.cost(),
            step: step.length,
            expected,
            method: step.method,
            halvings: step.halvings,
            samples_a_row: problem.block,
        });
        fitted = step.fitted;
        // The step that promised next to nothing has been taken: it is free.
        if gain < search.tolerance {
            break Stop::Converged;
        }
    };
    Ok(Refined { fitted, log, stop })
}

/// Weighted sum of squares of the measured outputs.
pub(crate) fn total(problem: &Problem<'_>) -> f64 {
    let mut total = 0.0;
    for (e, experiment) in problem.data.experiments.iter().enumerate() {
        for (o, y) in experiment.outputs.iter().enumerate() {
            total += problem.factors[o][e].powi(2) * y.iter().map(|v| v * v).sum::<f64>();
        }
    }
    total
}

/// Singular value decomposition of the projected sensitivities, columns scaled to unit norm.
struct Decomposed {
    v: Mat<f64>,
    s: Vec<f64>,
    /// Residual in the left singular vectors.
    g: Vec<f64>,
    /// Factors from scaled to plain parameters.
    scale: Vec<f64>,
}

impl Decomposed {
    fn new(problem: &Problem<'_>, fitted: &Fitted) -> Result<Self> {
        let (j, r) = problem.linearise(fitted)?.reduced();
        let (m, n) = (j.nrows(), j.ncols());
        let scale: Vec<f64> = (0..n)
            .map(|c| {
                let norm = j.col(c).norm_l2();
                if norm > 0.0 && norm.is_finite() {
                    1.0 / norm
                } else {
                    1.0
                }
            })
            .collect();
        let scaled = Mat::from_fn(m, n, |i, c| j[(i, c)] * scale[c]);
        albatross_numerics::matrix::check_finite("the sensitivities", scaled.as_ref())?;
        let svd = Svd::new_thin(scaled.as_ref()).map_err(|_| albatross_numerics::Error::NoConvergence {
            what: "the singular values of the sensitivities",
            size: n,
        })?;
        let s: Vec<f64> = (0..m.min(n)).map(|k| svd.S()[k]).collect();
        let g = (0..s.len())
            .map(|k| (0..m).map(|i| svd.U()[(i, k)] * r[i]).sum())
            .collect();
        Ok(Self {
            v: svd.V().to_owned(),
            s,
            g,
            scale,
        })
    }

    fn largest(&self) -> f64 {
        self.s.first().copied().unwrap_or(0.0)
    }

    /// Bound below which a singular value is rounding.
    fn floor(&self) -> f64 {
        1e4 * f64::EPSILON * self.scale.len() as f64 * self.largest()
    }

    /// Sum of squares that the linearised problem can remove.
    fn explained(&self) -> f64 {
        let floor = self.floor();
        self.s
            .iter()
            .zip(&self.g)
            .filter(|(s, _)| **s > floor)
            .map(|(_, g)| g * g)
            .sum()
    }

    /// The step with the factor `filter(s)` on each singular direction.
    fn step(&self, filter: impl Fn(f64) -> f64) -> Vec<f64> {
        let weights: Vec<f64> = self.s.iter().zip(&self.g).map(|(s, g)| filter(*s) * g).collect();
        (0..self.scale.len())
            .map(|i| {
                self.scale[i]
                    * weights
                        .iter()
                        .enumerate()
                        .map(|(k, w)| self.v[(i, k)] * w)
                        .sum::<f64>()
            })
            .collect()
    }

    /// The minimiser along the gradient.
    fn steepest(&self) -> Vec<f64> {
        let (mut top, mut bottom) = (0.0, 0.0);
        for (s, g) in self.s.iter().zip(&self.g) {
            top += (s * g).powi(2);
            bottom += (s * s * g).powi(2);
        }
        let length = if bottom > 0.0 { top / bottom } else { 0.0 };
        self.step(|s| s * length)
    }
}

/// A step that lowers the cost.
struct Step {
    fitted: Fitted,
    method: SearchMethod,
    length: f64,
    halvings: usize,
}

fn descend(
    problem: &Problem<'_>,
    from: &Fitted,
    decomposed: &Decomposed,
    search: Search,
    memory: &mut Memory,
) -> Option<Step> {
    let methods: &[SearchMethod] = match search.method {
        SearchMethod::Auto => &IN_TURN,
        ref one => std::slice::from_ref(one),
    };
    methods.iter().find_map(|method| match method {
        SearchMethod::LevenbergMarquardt => damped(problem, from, decomposed, search, memory),
        SearchMethod::AdaptiveGaussNewton => {
            let bound = memory.gamma * decomposed.largest();
            let step = decomposed.step(|s| if s > bound { 1.0 / s } else { 0.0 });
            let found = halved(problem, from, &step, search, *method);
            match &found {
                Some(step) if step.halvings == 0 => memory.gamma = (memory.gamma / 4.0).max(1e-12),
                Some(_) => {}
                None => memory.gamma = (memory.gamma * 2.0).min(0.1),
            }
            found
        }
        SearchMethod::SteepestDescent => halved(problem, from, &decomposed.steepest(), search, *method),
        SearchMethod::SubspaceGaussNewton | SearchMethod::Auto => {
            let floor = decomposed.floor();
            let step = decomposed.step(|s| if s > floor { 1.0 / s } else { 0.0 });
            halved(problem, from, &step, search, *method)
        }
    })
}

/// Halves a step until the cost falls.
fn halved(
    problem: &Problem<'_>,
    from: &Fitted,
    step: &[f64],
    search: Search,
    method: SearchMethod,
) -> Option<Step> {
    let mut factor = 1.0;
    for halvings in 0..=HALVINGS {
        let scaled: Vec<f64> = step.iter().map(|v| v * factor).collect();
        if let Some(fitted) = try_step(problem, from, &scaled, search) {
            return Some(Step {
                fitted,
                method,
                length: length(&scaled),
                halvings,
            });
        }
        factor *= 0.5;
    }
    None
}

/// Raises the damping until the cost falls.
fn damped(
    problem: &Problem<'_>,
    from: &Fitted,
    decomposed: &Decomposed,
    search: Search,
    memory: &mut Memory,
) -> Option<Step> {
    for halvings in 0..=2 * HALVINGS {
        let damping = memory.damping * decomposed.largest().powi(2);
        let step = decomposed.step(|s| s / (s * s + damping));
        if let Some(fitted) = try_step(problem, from, &step, search) {
            if halvings == 0 {
                memory.damping = (memory.damping / 4.0).max(1e-14);
            }
            return Some(Step {
                fitted,
                method: SearchMethod::LevenbergMarquardt,
                length: length(&step),
                halvings,
            });
        }
        memory.damping = (memory.damping * 4.0).min(1e6);
    }
    None
}

fn length(step: &[f64]) -> f64 {
    step.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The point after a step if its cost is lower.
fn try_step(problem: &Problem<'_>, from: &Fitted, step: &[f64], search: Search) -> Option<Fitted> {
    let point = moved(problem, &from.point, step, search);
    if point == from.point || !point.is_usable() || (search.stable && !point.is_stable()) {
        return None;
    }
    let fitted = problem.fit(point).ok()?;
    (fitted.cost() < from.cost()).then_some(fitted)
}

/// The point moved by a step in units of the blocks' scales.
///
/// Where stability is asked for, no coefficient goes below a tenth of its value in one step: it can approach the
/// boundary but not cross it.
fn moved(problem: &Problem<'_>, from: &Point, step: &[f64], search: Search) -> Point {
    let slowest = SLOWEST / problem.data.longest();
    let fastest = FASTEST / problem.data.dt();
    let keep = |old: f64, change: f64, [floor, ceiling]: [f64; 2]| {
        let limit = ceiling.max(old.abs());
        let new = (old + change).clamp(-limit, limit);
        if search.stable {
            new.max(0.1 * old).max(floor.min(old))
        } else {
            new
        }
    };
    let mut values = step.iter().copied();
    let mut next = || values.next().unwrap_or(0.0);
    let blocks = from
        .blocks
        .iter()
        .map(|block| {
            let w = block.scale();
            match *block {
                Block::First { a } => Block::First {
                    a: keep(a, w * next(), [slowest, fastest]),
                },
                Block::Second { a1, a0 } => Block::Second {
                    a1: keep(a1, w * next(), [0.0, 2.0 * fastest]),
                    a0: keep(a0, w * w * next(), [slowest.powi(2), fastest.powi(2)]),
                },
            }
        })
        .collect();
    let delay = if problem.free_delay {
        (from.delay + problem.data.dt() * next()).clamp(0.0, search.largest_delay)
    } else {
        from.delay
    };
    Point { blocks, delay }
}
