//! The estimation of transfer functions: starts, relocation of poles, output-error search.

use albatross_numerics::C64;
use serde::{Deserialize, Serialize};

use crate::blocks::{Block, from_poles, order};
use crate::data::mismatch;
use crate::problem::{Fitted, Point, Problem};
use crate::reallocate::{Scan, reallocate};
use crate::refine::{Iteration, Refined, Search, SearchMethod, Stop, refine, total};
use crate::relocate::{Sweeps, reflected, relocate};
use crate::score::{self, InitialState};
use crate::start::{self, Start};
use crate::subspace::{self, SubspaceOptions};
use crate::uncertainty::Uncertainty;
use crate::{DataSet, Error, Experiment, Model, Result};

/// What is assumed of the state at the first sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InitialCondition {
    /// At rest.
    Zero,
    /// Unknown, estimated for every record.
    Estimate,
    /// At rest unless an unknown state lowers the cost by more than 5 %.
    Auto,
}

/// How starting poles are found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Initialisation {
    /// Refined instrumental variables in the basis of the poles.
    Srivc,
    /// State-variable filters: one least-squares step.
    Svf,
    /// Subspace identification of decimated data.
    Subspace,
    /// All of them; the best goes on.
    All,
    /// These factors of the denominator, of a model at hand; as many poles as asked for.
    Given(Vec<Block>),
}

/// Transport delay of the input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Delay {
    /// Known \[s\].
    Fixed(f64),
    /// Estimated between zero and this \[s\].
    UpTo(f64),
}

/// Weights of the squared residuals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weights {
    /// `1/|y - mean y|^2`: every record and output counts by its share that is not explained, as the fit does.
    Fit,
    /// 1: the maximum-likelihood estimate when all records carry the same white noise.
    Equal,
    /// By output and experiment, not negative.
    Given(Vec<Vec<f64>>),
}

/// Settings of an estimation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Number of poles, at least 1.
    pub poles: usize,
    /// Number of zeros, at most that of the poles.
    pub zeros: usize,
    /// Transport delay.
    pub delay: Delay,
    /// State at the first sample.
    pub initial: InitialCondition,
    /// Starting poles.
    pub initialisation: Initialisation,
    /// Search of the output-error minimum.
    pub search: SearchMethod,
    /// Whether the model must be stable.
    pub stable: bool,
    /// Weights of the residuals.
    pub weights: Weights,
    /// Number of starts of the relocation.
    pub starts: usize,
    /// Seed of the starts beyond the sixth.
    pub seed: u64,
    /// Starts that go on to the search.
    pub refined: usize,
    /// Most iterations of a search.
    pub iterations: usize,
    /// Most poles that are moved to another place after the search.
    pub reallocations: usize,
    /// Relative improvement of the cost at which the search ends.
    pub tolerance: f64,
    /// Whether standard deviations are computed.
    pub uncertainty: bool,
}

impl Options {
    /// The usual settings for a number of poles and zeros.
    pub fn new(poles: usize, zeros: usize) -> Self {
        Self {
            poles,
            zeros,
            delay: Delay::Fixed(0.0),
            initial: InitialCondition::Auto,
            initialisation: Initialisation::Srivc,
            search: SearchMethod::Auto,
            stable: true,
            weights: Weights::Fit,
            starts: 6,
            seed: 0,
            refined: 3,
            iterations: 60,
            reallocations: 8,
            tolerance: 1e-6,
            uncertainty: true,
        }
    }
}

/// What became of one start.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StartReport {
    /// How it began.
    pub description: String,
    /// Cost after relocation, share of the weighted sum of squares of the data; none if it failed.
    pub relocated: Option<f64>,
    /// Cost after the search; none if it was not refined.
    pub refined: Option<f64>,
}

/// The result of an estimation.
#[derive(Debug, Clone, Serialize)]
pub struct Estimate {
    /// The model.
    pub model: Model,
    /// Weighted sum of squares, share of that of the data.
    pub cost: f64,
    /// Whether initial states were estimated.
    pub initial_estimated: bool,
    /// Initial state and constant, by output and training record.
    pub initial: Vec<Vec<InitialState>>,
    /// The iterations of the search that won.
    pub iterations: Vec<Iteration>,
    /// Why it ended.
    pub stop: Stop,
    /// All starts.
    pub starts: Vec<StartReport>,
    /// Position of the winner among them.
    pub chosen: usize,
    /// Seed used.
    pub seed: u64,
    /// Covariances and what follows from them.
    pub uncertainty: Option<Uncertainty>,
    /// Outputs of the model on the training data, by experiment and output, initial state and constant included.
    #[serde(skip)]
    pub predicted: Vec<Vec<Vec<f64>>>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Estimates a model with common poles from all experiments and outputs together.
///
/// # Errors
/// [`Error::Order`], [`Error::TooFewSamples`], [`Error::Constant`], [`Error::Domain`] for unusable settings or data,
/// those of [`DataSet::check`]; [`Error::NoModel`] when no start leads anywhere.
pub fn estimate(data: &DataSet, options: &Options) -> Result<Estimate> {
    check(data, options)?;
    let factors = factors(data, options)?;
    let free_initial = options.initial == InitialCondition::Estimate;
    let problem = Problem {
        data,
        zeros: options.zeros,
        free_initial,
        free_delay: false,
        block: 1,
        factors,
    };
    let mut won = run(&problem, options)?;
    let mut initial_estimated = free_initial;
    if options.initial == InitialCondition::Auto {
        let free = Problem {
            free_initial: true,
            ..problem.clone()
        };
        let cost = won.refined.fitted.cost();
        let at_same_poles = free.fit(won.refined.fitted.point.clone())?;
        // Poles found under a wrong assumption may hide that it is wrong: records that begin in motion get both.
        let in_doubt = !data.experiments.iter().all(begins_at_rest);
        if in_doubt || improves(cost, at_same_poles.cost(), &problem) {
            let again = run(&free, options)?;
            if improves(cost, again.refined.fitted.cost(), &problem) {
                won = again;
                initial_estimated = true;
            }
        }
    }
    let problem = Problem {
        free_initial: initial_estimated,
        free_delay: matches!(options.delay, Delay::UpTo(_)),
        ..problem
    };
    finish(&problem, options, won)
}

/// Threshold of MATLAB's AutoInitThreshold: an initial state is worth its unknowns beyond it.
const WORTH_AN_INITIAL_STATE: f64 = 1.05;

/// Samples looked at for rest.
const REST: usize = 10;
/// Largest rms at rest as a share of that of the record.
const STILL: f64 = 0.1;

/// Whether input and outputs stand still at zero at the beginning of a record.
fn begins_at_rest(experiment: &Experiment) -> bool {
    let rms = |v: &[f64]| (v.iter().map(|v| v * v).sum::<f64>() / v.len().max(1) as f64).sqrt();
    let still = |v: &Vec<f64>| v.len() > REST && rms(&v[..REST]) <= STILL * rms(v);
    still(&experiment.input) && experiment.outputs.iter().all(still)
}

fn improves(zero: f64, free: f64, problem: &Problem<'_>) -> bool {
    // Differences of exact fits are rounding.
    zero > WORTH_AN_INITIAL_STATE * free && zero > 1e-20 * total(problem)
}

/// The winner of all starts.
struct Won {
    refined: Refined,
    starts: Vec<StartReport>,
    chosen: usize,
}

fn run(full: &Problem<'_>, options: &Options) -> Result<Won> {
    let total = total(full);
    let coarse = Problem {
        block: block(full.data, options),
        ..full.clone()
    };
    // Instruments want more rows than the search.
    let finer = Problem {
        block: (coarse.block / 3).max(1),
        ..full.clone()
    };
    let mut reports = Vec::new();
    let mut candidates: Vec<(usize, Fitted)> = Vec::new();
    let mut last_failure = String::from("the relocation of poles diverged");
    for start in start::all(full.data, options) {
        let found = begin(&finer, options, &start).and_then(|fitted| coarse.fit(fitted.point));
        reports.push(StartReport {
            description: start.description(),
            relocated: found.as_ref().ok().map(|f| f.cost() / total),
            refined: None,
        });
        match found {
            Ok(fitted) if fitted.cost().is_finite() => candidates.push((reports.len() - 1, fitted)),
            Ok(_) => {}
            Err(error) => last_failure = error.to_string(),
        }
    }
    candidates.sort_by(|a, b| a.1.cost().total_cmp(&b.1.cost()));
    candidates.dedup_by(|b, a| same(&a.1, &b.1));
    let search = Search {
        method: options.search,
        most: options.iterations,
        tolerance: options.tolerance,
        stable: options.stable,
        largest_delay: match options.delay {
            Delay::UpTo(most) => most,
            Delay::Fixed(_) => 0.0,
        },
    };
    let free_delay = matches!(options.delay, Delay::UpTo(_));
    let coarse = Problem { free_delay, ..coarse };
    let mut won: Option<(usize, Refined)> = None;
    for (start, fitted) in candidates.into_iter().take(options.refined.max(1)) {
        let refined = match refine(&coarse, fitted, search) {
            Ok(refined) => refined,
            Err(error) => {
                last_failure = error.to_string();
                continue;
            }
        };
        if let Some(report) = reports.get_mut(start) {
            report.refined = Some(refined.fitted.cost() / total);
        }
        let better = won
            .as_ref()
            .is_none_or(|(_, best)| refined.fitted.cost() < best.fitted.cost());
        if better && refined.fitted.cost().is_finite() {
            won = Some((start, refined));
        }
    }
    let (chosen, mut refined) = won.ok_or_else(|| Error::NoModel {
        poles: options.poles,
        zeros: options.zeros,
        starts: reports.len(),
        reason: format!("{last_failure}; lower the order, or check the data for drift and saturation"),
    })?;
    if options.reallocations > 0 && options.iterations > 0 && refined.stop != Stop::Exact {
        let scan = Scan::new(&coarse)?;
        refined = reallocate(&coarse, refined, search, options.reallocations, &scan)?;
    }
    // All samples have the last word.
    let full = Problem {
        free_delay,
        ..full.clone()
    };
    let search = Search {
        most: if coarse.block > 1 {
            search.most.min(LAST_ITERATIONS)
        } else {
            search.most
        },
        ..search
    };
    let last = refine(&full, full.fit(refined.fitted.point)?, search)?;
    let mut log = refined.log;
    log.extend(last.log);
    Ok(Won {
        refined: Refined { log, ..last },
        starts: reports,
        chosen,
    })
}

/// Whether two starts led to the same neighbourhood: every coefficient of the denominators within a hundredth.
fn same(a: &Fitted, b: &Fitted) -> bool {
    let near = |p: f64, q: f64, scale: f64| (p - q).abs() <= 0.01 * scale.abs();
    let (a, b) = (&a.point, &b.point);
    a.delay == b.delay
        && a.blocks.len() == b.blocks.len()
        && a.blocks.iter().zip(&b.blocks).all(|(p, q)| match (*p, *q) {
            (Block::First { a: p }, Block::First { a: q }) => near(p, q, p),
            (Block::Second { a1: p1, a0: p0 }, Block::Second { a1: q1, a0: q0 }) => {
                near(p0, q0, p0) && near(p1, q1, p0.abs().sqrt())
            }
            _ => false,
        })
}

/// Most iterations on all samples, from the minimum on sums of them.
const LAST_ITERATIONS: usize = 20;
/// Most sweeps of a relocation.
const SWEEPS: usize = 16;
/// Sweeps before instruments are used.
const PLAIN: usize = 3;
/// Rows that starts, first searches and moves need for every unknown.
const ROWS_AN_UNKNOWN: usize = 10;
/// Angle that the fastest motion of interest may turn within a row \[rad\]: its amplitude falls by a sixth.
const TURN_A_ROW: f64 = 2.0;

/// Relocated poles of one start.
fn begin(problem: &Problem<'_>, options: &Options, start: &Start) -> Result<Fitted> {
    let relocated = |point: Point, most: usize, plain: usize| {
        let sweeps = Sweeps {
            most,
            plain,
            stable: options.stable,
        };
        relocate(problem, point, sweeps)
    };
    match start {
        Start::Given { blocks, delay } => problem.fit(Point {
            blocks: blocks.clone(),
            delay: *delay,
        }),
        Start::Subspace { .. } => {
            let settings = SubspaceOptions {
                stable: options.stable,
                ..SubspaceOptions::default()
            };
            let found = subspace::poles(problem.data, options.poles, &settings)?;
            let poles: Vec<C64> = found
                .poles
                .iter()
                .map(|p| if options.stable { reflected(*p) } else { *p })
                .collect();
            problem.fit(Point {
                blocks: from_poles(&poles),
                delay: start.delay(),
            })
        }
        Start::Spread { blocks, .. } | Start::Filters { blocks, .. } => {
            let point = Point {
                blocks: blocks.clone(),
                delay: start.delay(),
            };
            match start {
                Start::Filters { .. } => relocated(point, 1, 1),
                Start::Spread {
                    instruments: true, ..
                } => relocated(point, SWEEPS, PLAIN),
                _ => relocated(point, SWEEPS, SWEEPS),
            }
        }
    }
}

/// Samples in one row of the equations while a model is sought: filters run over all samples, and neighbouring ones of
/// densely sampled data say the same.
fn block(data: &DataSet, options: &Options) -> usize {
    let unknowns = 3 * options.poles + 2;
    let shortest = data.experiments.iter().map(|e| e.len()).min().unwrap_or(0);
    let turn = TURN_A_ROW / (data.dt() * 1.5 * start::bandwidth(data)).max(f64::MIN_POSITIVE);
    (shortest / (ROWS_AN_UNKNOWN * unknowns))
        .min(turn as usize)
        .clamp(1, 16)
}

/// Refuses what cannot be estimated.
fn check(data: &DataSet, options: &Options) -> Result<()> {
    data.check()?;
    let (poles, zeros) = (options.poles, options.zeros);
    if poles == 0 || zeros > poles {
        return Err(Error::Order {
            poles,
            zeros,
            expected: "at least one pole, and no more zeros than poles, are needed",
        });
    }
    if let Initialisation::Given(blocks) = &options.initialisation
        && order(blocks) != poles
    {
        return Err(mismatch(
            "poles of the starting denominator",
            order(blocks),
            poles,
        ));
    }
    let limit = match options.delay {
        Delay::Fixed(delay) | Delay::UpTo(delay) => delay,
    };
    check_numbers(options, limit, data)?;
    for experiment in &data.experiments {
        let signals = std::iter::once((&data.input, &experiment.input))
            .chain(data.outputs.iter().zip(&experiment.outputs));
        for (signal, values) in signals {
            let largest = values.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            if largest != 0.0 && !SIZES.contains(&largest) {
                return Err(Error::Size {
                    experiment: experiment.name.clone(),
                    signal: signal.name.clone(),
                    largest,
                });
            }
            let first = values.first().copied().unwrap_or(0.0);
            if values.iter().all(|v| *v == first) {
                return Err(Error::Constant {
                    experiment: experiment.name.clone(),
                    signal: signal.name.clone(),
                    samples: values.len(),
                });
            }
        }
    }
    let n_outputs = data.outputs.len();
    let offsets = data.experiments.iter().filter(|e| e.estimate_offset).count();
    let initial = match options.initial {
        InitialCondition::Estimate => poles.saturating_mul(data.experiments.len() * n_outputs),
        InitialCondition::Zero | InitialCondition::Auto => 0,
    };
    let unknowns = zeros
        .saturating_add(1)
        .saturating_mul(n_outputs)
        .saturating_add(poles)
        .saturating_add(initial)
        .saturating_add(offsets * n_outputs);
    let samples = data.samples();
    // Twice as many equations as unknowns is the least that can tell a fit from an interpolation.
    let needed = unknowns.div_ceil(n_outputs).saturating_mul(2);
    if samples < needed {
        return Err(Error::TooFewSamples {
            poles,
            zeros,
            unknowns,
            experiments: data.names(),
            samples,
            needed,
        });
    }
    if poles > MOST_POLES {
        return Err(Error::Order {
            poles,
            zeros,
            expected: "at most 500 poles can be estimated",
        });
    }
    Ok(())
}

/// Most poles of an estimation: matrices as large as the square of their number are kept. In messages as well.
pub(crate) const MOST_POLES: usize = 500;
/// Sizes of signals whose squares and products are numbers of double precision.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;
/// Most starts: each is a relocation of poles, and all are kept for the report.
const MOST_STARTS: usize = 10_000;

/// Refuses settings that are out of range.
fn check_numbers(options: &Options, delay: f64, data: &DataSet) -> Result<()> {
    let longest = data.longest();
    let domain = |what, value, expected| {
        Err(Error::Domain {
            what,
            value,
            expected,
        })
    };
    if !(1e-12..=1e12).contains(&data.dt()) {
        return domain("the sample time [s]", data.dt(), "a number from 1e-12 to 1e12");
    }
    if !(delay.is_finite() && delay >= 0.0) {
        return domain("the transport delay [s]", delay, "zero or a positive number");
    }
    if delay > 0.0 && delay >= longest {
        return domain(
            "the transport delay [s]",
            delay,
            "less than the longest record lasts",
        );
    }
    if !(0.0..1.0).contains(&options.tolerance) {
        return domain(
            "the tolerance of the search",
            options.tolerance,
            "a number from 0 to below 1",
        );
    }
    if options.starts > MOST_STARTS {
        return domain("the number of starts", options.starts as f64, "at most 10000");
    }
    match &options.weights {
        Weights::Given(weights)
            if weights
                .iter()
                .any(|w| !w.is_empty() && w.iter().all(|v| *v == 0.0)) =>
        {
            domain(
                "the largest weight of an output",
                0.0,
                "a positive weight for one record at least",
            )
        }
        _ => Ok(()),
    }
}

/// Roots of the weights, by output and experiment.
fn factors(data: &DataSet, options: &Options) -> Result<Vec<Vec<f64>>> {
    (0..data.outputs.len())
        .map(|o| {
            data.experiments
                .iter()
                .enumerate()
                .map(|(e, experiment)| match &options.weights {
                    Weights::Equal => Ok(1.0),
                    Weights::Fit => {
                        let y = &experiment.outputs[o];
                        let mean = y.iter().sum::<f64>() / y.len() as f64;
                        Ok(1.0 / y.iter().map(|v| (v - mean).powi(2)).sum::<f64>().sqrt())
                    }
                    Weights::Given(weights) => {
                        let weight = weights.get(o).and_then(|w| w.get(e)).copied().unwrap_or(f64::NAN);
                        if weight.is_finite() && weight >= 0.0 {
                            Ok(weight.sqrt())
                        } else {
                            Err(Error::Domain {
                                what: "a weight",
                                value: weight,
                                expected: "a number not below zero for every output and experiment",
                            })
                        }
                    }
                })
                .collect()
        })
        .collect()
}

/// Gathers the result.
fn finish(problem: &Problem<'_>, options: &Options, won: Won) -> Result<Estimate> {
    let fitted = &won.refined.fitted;
    let data = problem.data;
    let model = Model {
        input: data.input.clone(),
        outputs: data.outputs.clone(),
        blocks: fitted.point.blocks.clone(),
        coefficients: (0..problem.outputs()).map(|o| fitted.coefficients(o)).collect(),
        direct: (0..problem.outputs()).map(|o| fitted.direct(o)).collect(),
        zeros: options.zeros,
        delay: fitted.point.delay,
    };
    let predicted = (0..data.experiments.len())
        .map(|e| problem.predict(fitted, e))
        .collect::<Result<Vec<_>>>()?;
    let initial = fitted
        .unknowns
        .local
        .iter()
        .map(|of_output| {
            of_output
                .iter()
                .map(|local| score::initial_state(local, problem.free_initial, order(&model.blocks)))
                .collect()
        })
        .collect();
    let uncertainty = if options.uncertainty {
        match Uncertainty::of(problem, fitted, &predicted)? {
            Some(found) => Some(found.with_modes(&model)?),
            None => None,
        }
    } else {
        None
    };
    let warnings = warnings(problem, options, &won, &model, uncertainty.as_ref());
    Ok(Estimate {
        cost: fitted.cost() / total(problem),
        initial_estimated: problem.free_initial,
        initial,
        iterations: won.refined.log,
        stop: won.refined.stop,
        starts: won.starts,
        chosen: won.chosen,
        seed: options.seed,
        uncertainty,
        predicted,
        warnings,
        model,
    })
}

/// What the user should know of the result.
fn warnings(
    problem: &Problem<'_>,
    options: &Options,
    won: &Won,
    model: &Model,
    uncertainty: Option<&Uncertainty>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if won.refined.stop == Stop::Iterations {
        warnings.push(
            "the search ended at the greatest number of iterations: raise it, or lower the order".to_owned(),
        );
    }
    let nyquist = std::f64::consts::PI / problem.data.dt();
    let beyond = model.poles().iter().filter(|p| p.norm() > nyquist).count();
    if beyond > 0 {
        warnings.push(format!(
            "{beyond} poles lie above the Nyquist frequency ({nyquist:.3} rad/s) and stand for a direct path: lower the order, or ask for as many zeros as poles"
        ));
    }
    match uncertainty {
        None if !options.uncertainty => {}
        None => warnings.push(
            "the data do not determine all parameters (the information matrix is singular): the order is larger than they can carry; lower it, or add records".to_owned(),
        ),
        Some(u) => {
            let doubtful = u.modes.iter().filter(|m| !m.identified).count();
            if doubtful > 0 {
                warnings.push(format!(
                    "{doubtful} of {} modes are not identified (frequency uncertain by more than 10 %, or residue below two standard deviations): the order may be larger than the data can carry",
                    u.modes.len()
                ));
            }
        }
    }
    let blocks: &[Block] = &model.blocks;
    let longest = problem.data.longest();
    let slow = blocks
        .iter()
        .flat_map(|b| b.poles())
        .filter(|p| p.norm() * longest < 0.5 * std::f64::consts::PI)
        .count();
    if slow > 0 {
        warnings.push(format!(
            "{slow} poles are so slow that the longest record ({longest:.3} s) holds less than a quarter of their period: they stand for drift"
        ));
    }
    warnings
}
