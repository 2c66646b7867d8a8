//! Manoeuvres of the case file.

use albatross_flight::Method;
use albatross_flight::signal::{Edges, Signal};
use serde::Deserialize;

/// A simulation.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManoeuvreCase {
    /// Name, also of its files.
    pub name: String,
    /// Control that moves, or `thrust`.
    pub input: String,
    /// End \[s\].
    pub end: f64,
    /// Step \[s\].
    pub dt: f64,
    /// Steps from one sample to the next.
    #[serde(default = "every_step")]
    pub output_every: usize,
    /// Method of integration.
    #[serde(default = "super::default_method")]
    pub method: Method,
    /// The deviation from trim.
    pub signal: SignalCase,
}

fn every_step() -> usize {
    1
}

/// A signal; amplitudes of controls in deg, of the thrust in N.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[allow(missing_docs)]
pub enum SignalCase {
    /// Plus, then minus the amplitude, half a period each.
    Doublet {
        #[serde(alias = "amplitude_n")]
        amplitude_deg: f64,
        start: f64,
        frequency_hz: f64,
        #[serde(default)]
        edges: Edges,
    },
    /// A jump that stays.
    Step {
        #[serde(alias = "amplitude_n")]
        amplitude_deg: f64,
        start: f64,
    },
    /// Alternating pulses of 3, 2, 1 and 1 units.
    #[serde(rename = "3211")]
    ThreeTwoOneOne {
        #[serde(alias = "amplitude_n")]
        amplitude_deg: f64,
        start: f64,
        unit: f64,
    },
    /// A sine of rising frequency.
    Chirp {
        #[serde(alias = "amplitude_n")]
        amplitude_deg: f64,
        start: f64,
        duration: f64,
        from_hz: f64,
        to_hz: f64,
    },
    /// Samples of a CSV file; `offset = "first"` counts them from the first sample.
    Csv {
        file: String,
        time_column: String,
        value_column: String,
        #[serde(default)]
        offset: Offset,
    },
}

/// What the samples of a file count from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Offset {
    /// From the first sample: a total deflection that starts in trim.
    #[default]
    First,
    /// From zero: deviations from trim.
    Zero,
}

impl SignalCase {
    /// The signal with amplitudes times `unit`; none for a file, which must be read first.
    pub fn signal(&self, unit: f64) -> Option<Signal> {
        Some(match *self {
            Self::Doublet {
                amplitude_deg,
                start,
                frequency_hz,
                edges,
            } => Signal::Doublet {
                amplitude: unit * amplitude_deg,
                start,
                period: 1.0 / frequency_hz,
                edges,
            },
            Self::Step { amplitude_deg, start } => Signal::Step {
                amplitude: unit * amplitude_deg,
                start,
            },
            Self::ThreeTwoOneOne {
                amplitude_deg,
                start,
                unit: length,
            } => Signal::ThreeTwoOneOne {
                amplitude: unit * amplitude_deg,
                start,
                unit: length,
            },
            Self::Chirp {
                amplitude_deg,
                start,
                duration,
                from_hz,
                to_hz,
            } => Signal::Chirp {
                amplitude: unit * amplitude_deg,
                start,
                duration,
                from_hz,
                to_hz,
            },
            Self::Csv { .. } => return None,
        })
    }
}
