//! Removal of trim: identification needs the deviations from the steady state before the manoeuvre.
//!
//! The trim is the mean over the *lead-in*, the samples before the input starts to move. The mean of the whole record is
//! no trim of a doublet's response: it contains the response itself, and subtracting it adds a step that the input does
//! not explain.
//!
//! A value of the input that is subtracted wrongly adds a constant to the output that began long before the record.
//! A constant and an initial state estimated with the model absorb it exactly, unless the model integrates; the choice
//! of the trim of a record without lead-in is thus one of conditioning, provided that a constant is estimated.

use serde::{Deserialize, Serialize};

use crate::Experiment;
use crate::stillness::{Run, drifts, mean, range, runs, tolerance};

/// How the trim of a record is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Detrend {
    /// As [`Detrend::Trim`], and a constant is estimated with the model if the lead-in is missing, shorter than 200
    /// samples or shorter than 2 % of the record.
    #[default]
    Auto,
    /// From the lead-in; without one, from the value at which the input rests.
    Trim,
    /// The first sample.
    First,
    /// The mean of the record. Wrong for doublets.
    Mean,
    /// Nothing is subtracted.
    None,
}

/// Where the trim that was subtracted came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrimBasis {
    /// Means over the lead-in.
    LeadIn,
    /// No lead-in: the value at which the input rests for at least a fifth of the record, and the first samples of the
    /// outputs. A deterministic record that begins with its doublet starts from trim.
    Rest,
    /// Means of the record, either asked for, or because the input moves throughout (a sequence of random bits, a
    /// sweep): any value would do then, and that one keeps the estimated constant small.
    Mean,
    /// First samples.
    First,
    /// Nothing was subtracted.
    Nothing,
}

/// What [`remove_trim`] subtracted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrimRemoved {
    /// Subtracted from the input.
    pub input: f64,
    /// Subtracted from each output.
    pub outputs: Vec<f64>,
    /// Samples at the beginning over which the input stands still at trim; 0 if there are none.
    pub lead_in: usize,
    /// Source of the values.
    pub basis: TrimBasis,
    /// Whether a constant is to be estimated with every output.
    pub estimate_offset: bool,
}

/// Fewer samples of lead-in leave the means uncertain.
const LEAD_IN_SAMPLES: usize = 200;
/// A shorter lead-in, as part of the record, leaves the means uncertain.
const LEAD_IN_PART: f64 = 0.02;
/// Part of the record that the input must stand still for its value to be one of rest.
const REST_PART: f64 = 0.2;
/// Part of its range by which an output may drift during a lead-in.
const STANDING: f64 = 1e-3;

/// Subtracts the trim from the input and the outputs.
///
/// The input stands still as long as it moves by no more than a millionth of its range or, if it is measured with noise,
/// by five standard deviations of the noise. Such a beginning is a lead-in if the input comes back to that value at the
/// end and rests there, or if the outputs stand still as well; otherwise it is the first stretch of the excitation.
///
/// [`Detrend::Auto`] sets `estimate_offset` of the experiment where a constant is needed; the other choices leave it.
pub fn remove_trim(experiment: &mut Experiment, how: Detrend) -> TrimRemoved {
    let lead_in = lead_in(experiment);
    let basis = match how {
        Detrend::Auto | Detrend::Trim if lead_in.len >= 2 => TrimBasis::LeadIn,
        Detrend::Auto | Detrend::Trim if lead_in.rest.is_some() => TrimBasis::Rest,
        Detrend::Auto | Detrend::Trim | Detrend::Mean => TrimBasis::Mean,
        Detrend::First => TrimBasis::First,
        Detrend::None => TrimBasis::Nothing,
    };
    let value = |signal: &[f64]| match basis {
        TrimBasis::LeadIn => mean(signal.get(..lead_in.len).unwrap_or(signal)),
        TrimBasis::Mean => mean(signal),
        TrimBasis::First | TrimBasis::Rest => signal.first().copied().unwrap_or(0.0),
        TrimBasis::Nothing => 0.0,
    };
    let input = match (basis, lead_in.rest) {
        (TrimBasis::Rest, Some(rest)) => rest,
        _ => value(&experiment.input),
    };
    let outputs: Vec<f64> = experiment.outputs.iter().map(|y| value(y)).collect();

    experiment.input.iter_mut().for_each(|u| *u -= input);
    for (samples, trim) in experiment.outputs.iter_mut().zip(&outputs) {
        samples.iter_mut().for_each(|y| *y -= trim);
    }
    let short =
        lead_in.len < LEAD_IN_SAMPLES || (lead_in.len as f64) < LEAD_IN_PART * experiment.len() as f64;
    experiment.estimate_offset |= how == Detrend::Auto && short;
    TrimRemoved {
        input,
        outputs,
        lead_in: lead_in.len,
        basis,
        estimate_offset: experiment.estimate_offset,
    }
}

/// Beginning of a record.
pub(crate) struct LeadIn {
    /// Samples before the input starts to move; 0 if it moves from the start.
    pub len: usize,
    /// Value at which the input rests for a fifth of the record or longer.
    pub rest: Option<f64>,
}

/// Finds the lead-in, by the rules of [`remove_trim`].
pub(crate) fn lead_in(experiment: &Experiment) -> LeadIn {
    let input = &experiment.input;
    let tolerance = tolerance(input);
    let runs = runs(input, tolerance);
    let longest = runs.iter().max_by_key(|run| run.len);
    let rest = longest
        .filter(|run| run.len as f64 >= REST_PART * input.len() as f64)
        .map(|run| run.mean);
    let (Some(first), Some(last)) = (runs.first(), runs.last()) else {
        return LeadIn { len: 0, rest };
    };
    let same = |p: f64, q: f64| (p - q).abs() <= tolerance;
    // A single sample is as good as none: it may be the first of a moving input.
    let accepted = first.len >= 2
        && match rest {
            _ if runs.len() == 1 => true,
            Some(rest) if same(first.mean, rest) && same(last.mean, rest) => true,
            Some(_) => outputs_stand(experiment, first),
            // The first bit of a sequence of bits is not much longer than the others.
            None => runs.iter().skip(1).all(|run| 2 * run.len <= first.len),
        };
    LeadIn {
        len: if accepted { first.len } else { 0 },
        rest,
    }
}

/// Whether no output drifts while the input stands still.
fn outputs_stand(experiment: &Experiment, run: &Run) -> bool {
    // Scatter of fewer samples cannot be told from drift.
    const FEWEST: usize = 10;
    experiment.outputs.iter().all(|output| {
        let during = output.get(run.start..run.end()).unwrap_or_default();
        let still = range(during) <= STANDING * range(output);
        still || (run.len >= FEWEST && !drifts(during))
    })
}

#[cfg(test)]
mod tests;
