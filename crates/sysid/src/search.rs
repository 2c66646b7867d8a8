//! The search for the order.
//!
//! Training fits alone mislead: a model of high order can reproduce its own record and fail on the next. So every number
//! of poles is tried on several trainings, each record alone, all together, or all but one, and a candidate is scored by its
//! mean fit on the records that it has not seen. The smallest order within a fraction of a point of the best is taken
//! (parsimony); between equals the Bayesian criterion decides.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::criteria::criteria;
use crate::estimate::MOST_POLES;
use crate::{DataSet, Error, Estimate, Model, Options, Result, estimate, simulate_records};

/// Which records a candidate is trained on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Training {
    /// All records together.
    Merged,
    /// One record, by position.
    Single(usize),
    /// All records but one, by position.
    AllBut(usize),
}

impl Training {
    /// Positions of the records used, of `count`.
    pub fn positions(self, count: usize) -> Vec<usize> {
        match self {
            Self::Merged => (0..count).collect(),
            Self::Single(one) => vec![one],
            Self::AllBut(one) => (0..count).filter(|p| *p != one).collect(),
        }
    }
}

/// Settings of a search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchOptions {
    /// Least and greatest number of poles.
    pub poles: [usize; 2],
    /// Poles less zeros, each tried: 1 is nz = np - 1, 0 as many zeros as poles.
    pub excess: Vec<usize>,
    /// Whether candidates are trained on each record alone as well.
    pub single: bool,
    /// Whether the order is judged by leaving out one record after the other.
    pub leave_one_out: bool,
    /// Loss of score, in percent points, that a smaller order may have.
    pub tolerance_points: f64,
    /// Settings of every estimation; numbers of poles and zeros are replaced.
    pub estimation: Options,
}

impl SearchOptions {
    /// The usual settings for a range of poles: one zero less, each record alone and all together.
    pub fn new(least: usize, greatest: usize) -> Self {
        Self {
            poles: [least, greatest],
            excess: vec![1],
            single: true,
            leave_one_out: false,
            tolerance_points: 0.3,
            estimation: Options::new(least, least.saturating_sub(1)),
        }
    }
}

/// One estimation of a search.
#[derive(Debug, Clone, Serialize)]
pub struct Candidate {
    /// Number of poles.
    pub poles: usize,
    /// Number of zeros.
    pub zeros: usize,
    /// Records used.
    pub training: Training,
    /// Fit \[%\] on every record, mean over its outputs; none for a record with a constant output.
    pub fits: Vec<Option<f64>>,
    /// Mean fit on the records not used; on all if all were used \[%\].
    pub score: Option<f64>,
    /// Mean fit on all records \[%\].
    pub average: Option<f64>,
    /// Bayesian information criterion of the training.
    pub bic: Option<f64>,
    /// The model; none if the estimation failed.
    pub model: Option<Model>,
    /// Why it failed.
    pub failure: Option<String>,
}

/// All candidates, and the order chosen.
#[derive(Debug, Clone, Serialize)]
pub struct OrderSearch {
    /// Candidates in the order of poles, zeros, trainings.
    pub candidates: Vec<Candidate>,
    /// Position of the model recommended: the chosen order trained on all records.
    pub chosen: usize,
    /// Score of every order: poles, zeros, score \[%\].
    pub scores: Vec<(usize, usize, f64)>,
    /// Why it was chosen.
    pub reason: String,
}

/// Tries all orders, side by side; `progress` is told how many of how many candidates are done.
///
/// # Errors
/// Those of [`DataSet::check`]; [`Error::Order`] for an empty range and for one beyond the number of samples or 500
/// poles; [`Error::NoModel`] when no candidate trained on all records succeeds.
pub fn search(
    data: &DataSet,
    options: &SearchOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<OrderSearch> {
    data.check()?;
    let wanted = candidates(data, options)?;
    let total = wanted.len();
    let done = std::sync::atomic::AtomicUsize::new(0);
    // Large orders first: the last to finish should be small.
    let mut found: Vec<(usize, Candidate)> = wanted
        .into_par_iter()
        .enumerate()
        .rev()
        .map(|(place, (poles, zeros, training))| {
            let candidate = candidate(data, options, poles, zeros, training);
            let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress(count, total);
            (place, candidate)
        })
        .collect();
    found.sort_by_key(|(place, _)| *place);
    let candidates: Vec<Candidate> = found.into_iter().map(|(_, c)| c).collect();
    choose(candidates, options)
}

fn candidates(data: &DataSet, options: &SearchOptions) -> Result<Vec<(usize, usize, Training)>> {
    let [least, greatest] = options.poles;
    // All candidates are listed before any of them is tried.
    if greatest > data.samples().min(MOST_POLES) {
        return Err(Error::Order {
            poles: greatest,
            zeros: 0,
            expected: "the range of poles may reach to the number of samples, and to 500 at most",
        });
    }
    let count = data.experiments.len();
    let mut trainings = Vec::new();
    if options.single && count > 1 {
        trainings.extend((0..count).map(Training::Single));
    }
    if options.leave_one_out && count > 1 {
        trainings.extend((0..count).map(Training::AllBut));
    }
    trainings.push(Training::Merged);
    let mut wanted = Vec::new();
    for poles in least.max(1)..=greatest {
        for excess in &options.excess {
            let Some(zeros) = poles.checked_sub(*excess) else {
                continue;
            };
            wanted.extend(trainings.iter().map(|t| (poles, zeros, *t)));
        }
    }
    if wanted.is_empty() {
        return Err(Error::Order {
            poles: greatest,
            zeros: 0,
            expected: "the range of poles is empty: the first number must not exceed the second",
        });
    }
    Ok(wanted)
}

fn candidate(
    data: &DataSet,
    options: &SearchOptions,
    poles: usize,
    zeros: usize,
    training: Training,
) -> Candidate {
    let settings = Options {
        poles,
        zeros,
        uncertainty: false,
        ..options.estimation.clone()
    };
    let mut candidate = Candidate {
        poles,
        zeros,
        training,
        fits: vec![None; data.experiments.len()],
        score: None,
        average: None,
        bic: None,
        model: None,
        failure: None,
    };
    let used = training.positions(data.experiments.len());
    let found = data.select(&used).and_then(|training| {
        Ok((
            estimate(&training, &settings)?,
            training.samples() * training.outputs.len(),
        ))
    });
    match found.and_then(|(found, samples)| Ok((scored(data, &found)?, found, samples))) {
        Ok((fits, found, samples)) => {
            let unseen: Vec<Option<f64>> = (0..fits.len())
                .filter(|p| !used.contains(p))
                .map(|p| fits[p])
                .collect();
            candidate.average = mean(&fits);
            candidate.score = if unseen.is_empty() {
                candidate.average
            } else {
                mean(&unseen)
            };
            candidate.fits = fits;
            let local: usize = found
                .initial
                .iter()
                .flatten()
                .map(|i| i.free.len() + usize::from(i.offset != 0.0))
                .sum();
            let unknowns = poles + data.outputs.len() * (zeros + 1) + local;
            candidate.bic = criteria(found.cost, samples, unknowns).bic;
            candidate.model = Some(found.model);
        }
        Err(error) => candidate.failure = Some(error.to_string()),
    }
    candidate
}

/// Fits on all records, mean over the outputs.
fn scored(data: &DataSet, found: &Estimate) -> Result<Vec<Option<f64>>> {
    let simulated = simulate_records(&found.model, data, found.initial_estimated)?;
    Ok(simulated.iter().map(|record| mean(&record.fits)).collect())
}

/// Mean of those that are there; none without any.
fn mean(values: &[Option<f64>]) -> Option<f64> {
    let there: Vec<f64> = values.iter().flatten().copied().collect();
    (!there.is_empty()).then(|| there.iter().sum::<f64>() / there.len() as f64)
}

fn choose(candidates: Vec<Candidate>, options: &SearchOptions) -> Result<OrderSearch> {
    let merged: Vec<usize> = (0..candidates.len())
        .filter(|&i| candidates[i].training == Training::Merged && candidates[i].model.is_some())
        .collect();
    // With records left out, an order is scored by them; else by its model of all records.
    let score = |i: usize| -> Option<f64> {
        let of = &candidates[i];
        let folds: Vec<Option<f64>> = candidates
            .iter()
            .filter(|c| {
                matches!(c.training, Training::AllBut(_)) && (c.poles, c.zeros) == (of.poles, of.zeros)
            })
            .map(|c| c.score)
            .collect();
        if folds.is_empty() {
            of.average
        } else if folds.iter().all(Option::is_some) {
            mean(&folds)
        } else {
            None
        }
    };
    let scored: Vec<(usize, f64)> = merged.iter().filter_map(|&i| Some((i, score(i)?))).collect();
    let best = scored.iter().map(|(_, s)| *s).fold(f64::NEG_INFINITY, f64::max);
    let within = scored
        .iter()
        .filter(|(_, s)| *s >= best - options.tolerance_points);
    let chosen = within.min_by(|(a, _), (b, _)| {
        let (a, b) = (&candidates[*a], &candidates[*b]);
        a.poles.cmp(&b.poles).then(
            a.bic
                .unwrap_or(f64::INFINITY)
                .total_cmp(&b.bic.unwrap_or(f64::INFINITY)),
        )
    });
    let Some(&(chosen, points)) = chosen else {
        return Err(Error::NoModel {
            poles: options.poles[1],
            zeros: options.poles[1].saturating_sub(1),
            starts: candidates.len(),
            reason: candidates
                .iter()
                .rev()
                .find_map(|c| c.failure.clone())
                .unwrap_or_else(|| "no record has an output that moves".to_owned()),
        });
    };
    let of = if options.leave_one_out {
        "records left out"
    } else {
        "all records"
    };
    let reason = format!(
        "{} poles and {} zeros: {points:.2} % on {of}, the smallest order within {} points of the best ({best:.2} %)",
        candidates[chosen].poles, candidates[chosen].zeros, options.tolerance_points
    );
    let scores = scored
        .iter()
        .map(|&(i, s)| (candidates[i].poles, candidates[i].zeros, s))
        .collect();
    Ok(OrderSearch {
        candidates,
        chosen,
        scores,
        reason,
    })
}
