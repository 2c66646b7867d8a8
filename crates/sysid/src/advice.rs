//! Advice on records: what they cannot tell about the poles asked for, and what to do about it.
//!
//! Trim is expected to have been removed. Nothing here is an error: identification runs on such data, and its results
//! mislead.

mod excitation;
mod samples;

use serde::Serialize;

use crate::DataSet;

/// Subject of an [`Advice`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum AdviceKind {
    /// The frequencies that the records excite: information, given always.
    Coverage,
    /// Frequencies within the range of the poles that no record excites, or an input that stands still.
    Excitation,
    /// The record is short against the period of the slowest pole.
    RecordLength,
    /// The fastest pole, or energy of an output, lies near the Nyquist frequency.
    Nyquist,
    /// The sample time is far shorter than the fastest pole needs.
    Oversampled,
    /// An output stays at its largest or smallest value.
    Saturated,
    /// An output repeats a value while it should move.
    Stuck,
    /// An output has few different values.
    Quantised,
    /// An output moves before the input does.
    MovingBefore,
    /// An output differs from zero before the input moves.
    Offset,
    /// The input ends at another value than it began.
    InputEnd,
}

/// One observation about the data, and its cure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Advice {
    /// Subject.
    pub kind: AdviceKind,
    /// The record concerned; `None` for all together.
    pub experiment: Option<String>,
    /// The signal concerned, if it is one.
    pub signal: Option<String>,
    /// What was observed, with numbers; ends with the cure.
    pub text: String,
}

impl Advice {
    fn all(kind: AdviceKind, text: String) -> Self {
        Self {
            kind,
            experiment: None,
            signal: None,
            text,
        }
    }

    fn signal(kind: AdviceKind, experiment: &str, signal: &str, text: String) -> Self {
        Self {
            kind,
            experiment: Some(experiment.to_owned()),
            signal: Some(signal.to_owned()),
            text,
        }
    }
}

/// What the data cannot tell, or tell badly.
///
/// `slowest_rad_s` and `fastest_rad_s` are the moduli of the slowest and fastest pole identified or expected; checks that
/// need one that is not given, or that is no positive number, are left out.
///
/// - Excitation: bands between the poles in which the input of every record is more than 40 dB below the peak of its
///   spectrum. A square doublet of frequency f0 has nulls at 2 f0, 4 f0, ...
/// - Length: less than a period of the slowest pole leaves it uncertain, less than a quarter cannot tell it from a trend.
/// - Sampling: a pole above half the Nyquist frequency, output energy near it, more than 200 samples a period.
/// - Samples: saturated, stuck and quantised outputs, outputs that move or differ from zero before the input moves,
///   inputs that end elsewhere than they began.
pub fn advise(data: &DataSet, slowest_rad_s: Option<f64>, fastest_rad_s: Option<f64>) -> Vec<Advice> {
    let positive = |w: Option<f64>| w.filter(|w| w.is_finite() && *w > 0.0);
    let (slowest, fastest) = (positive(slowest_rad_s), positive(fastest_rad_s));
    let mut advice = excitation::excitation(data, slowest, fastest);
    advice.extend(slowest.and_then(|w| excitation::record_length(data, w)));
    advice.extend(fastest.and_then(|w| excitation::sampling(data, w)));
    advice.extend(excitation::aliasing(data));
    for experiment in &data.experiments {
        samples::check(data, experiment, &mut advice);
    }
    advice
}

/// Three significant digits.
fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    if value.abs() < 1e-9 {
        return format!("{value:.2e}");
    }
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests;
