//! Sampled time histories of one or several experiments.

use albatross_lti::{Hold, Signal};
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Behaviour of the input between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Intersample {
    /// Constant at the value of the earlier sample: what a digital controller puts out, square doublets.
    Zoh,
    /// Linear from sample to sample: ramps, smooth inputs, measured deflections.
    Foh,
}

impl From<Intersample> for Hold {
    fn from(value: Intersample) -> Self {
        match value {
            Intersample::Zoh => Self::Zero,
            Intersample::Foh => Self::First,
        }
    }
}

/// One record: an input and the outputs that it caused, at the same uniform times.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Name, usually that of the file.
    pub name: String,
    /// Sample time \[s\].
    pub dt: f64,
    /// Input samples.
    pub input: Vec<f64>,
    /// Output samples, one list an output, each as long as the input.
    pub outputs: Vec<Vec<f64>>,
    /// Whether a constant is estimated with every output, for records whose trim is not known well enough.
    pub estimate_offset: bool,
}

impl Experiment {
    /// A record whose values are deviations from trim.
    pub fn new(name: impl Into<String>, dt: f64, input: Vec<f64>, outputs: Vec<Vec<f64>>) -> Self {
        Self {
            name: name.into(),
            dt,
            input,
            outputs,
            estimate_offset: false,
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.input.len()
    }

    /// Without samples.
    pub fn is_empty(&self) -> bool {
        self.input.is_empty()
    }

    /// Time from the first to the last sample \[s\].
    pub fn duration(&self) -> f64 {
        self.len().saturating_sub(1) as f64 * self.dt
    }
}

/// Experiments with the same signals and the same sample time.
#[derive(Debug, Clone, PartialEq)]
pub struct DataSet {
    /// Name and unit of the input.
    pub input: Signal,
    /// Names and units of the outputs.
    pub outputs: Vec<Signal>,
    /// The records.
    pub experiments: Vec<Experiment>,
    /// Behaviour of the input between samples.
    pub intersample: Intersample,
}

impl DataSet {
    /// Joins experiments after checking that they belong together.
    ///
    /// # Errors
    /// [`Error::Mismatch`] without experiments or outputs, for lists of unequal length, and for sample times that
    /// differ by more than a millionth; [`Error::Domain`] for a sample time that is not positive;
    /// [`Error::NonFinite`].
    pub fn try_new(
        input: Signal,
        outputs: Vec<Signal>,
        experiments: Vec<Experiment>,
        intersample: Intersample,
    ) -> Result<Self> {
        let joined = Self {
            input,
            outputs,
            experiments,
            intersample,
        };
        joined.check()?;
        Ok(joined)
    }

    /// Whether the experiments still belong together: the fields are open to change, so whatever uses the data asks.
    ///
    /// # Errors
    /// As [`DataSet::try_new`].
    pub fn check(&self) -> Result<()> {
        let Some(first) = self.experiments.first() else {
            return Err(mismatch("experiments", "none", "at least one record"));
        };
        if self.outputs.is_empty() {
            return Err(mismatch("outputs", "none", "at least one output"));
        }
        for experiment in &self.experiments {
            check(experiment, &self.input, &self.outputs, first.dt)?;
        }
        Ok(())
    }

    /// Names of the experiments, for messages.
    pub(crate) fn names(&self) -> String {
        let names: Vec<&str> = self.experiments.iter().map(|e| e.name.as_str()).collect();
        names.join(", ")
    }

    /// Duration of the longest experiment, s.
    pub(crate) fn longest(&self) -> f64 {
        self.experiments
            .iter()
            .map(Experiment::duration)
            .fold(0.0, f64::max)
    }

    /// Sample time \[s\].
    pub fn dt(&self) -> f64 {
        self.experiments.first().map_or(0.0, |e| e.dt)
    }

    /// Samples of all experiments together.
    pub fn samples(&self) -> usize {
        self.experiments.iter().map(Experiment::len).sum()
    }

    /// The data of some experiments, by position.
    ///
    /// # Errors
    /// [`Error::Mismatch`] for a position that is not there, or without any.
    pub fn select(&self, positions: &[usize]) -> Result<Self> {
        let experiments = positions
            .iter()
            .map(|&p| {
                self.experiments.get(p).cloned().ok_or_else(|| {
                    mismatch(
                        "position of an experiment",
                        p,
                        format!("less than {}", self.experiments.len()),
                    )
                })
            })
            .collect::<Result<Vec<_>>>()?;
        Self::try_new(
            self.input.clone(),
            self.outputs.clone(),
            experiments,
            self.intersample,
        )
    }
}

fn check(experiment: &Experiment, input: &Signal, outputs: &[Signal], dt: f64) -> Result<()> {
    let name = &experiment.name;
    let positive = experiment.dt.is_finite() && experiment.dt > 0.0;
    if !positive {
        return Err(Error::Domain {
            what: "the sample time [s]",
            value: experiment.dt,
            expected: "a positive number",
        });
    }
    if (experiment.dt - dt).abs() > 1e-6 * dt {
        return Err(mismatch(
            format!("sample time of {name}"),
            format!("{} s", experiment.dt),
            format!("{dt} s as in the first record: resample one of them"),
        ));
    }
    if experiment.outputs.len() != outputs.len() {
        return Err(mismatch(
            format!("outputs of {name}"),
            experiment.outputs.len(),
            outputs.len(),
        ));
    }
    let signals = std::iter::once((input, &experiment.input)).chain(outputs.iter().zip(&experiment.outputs));
    for (signal, values) in signals {
        if values.len() != experiment.len() {
            return Err(mismatch(
                format!("samples of {} in {name}", signal.name),
                values.len(),
                format!("{} as the input has", experiment.len()),
            ));
        }
        if let Some(sample) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::NonFinite {
                experiment: name.clone(),
                signal: signal.name.clone(),
                sample,
            });
        }
    }
    Ok(())
}

pub(crate) fn mismatch(what: impl Into<String>, found: impl ToString, expected: impl ToString) -> Error {
    Error::Mismatch {
        what: what.into(),
        found: found.to_string(),
        expected: expected.to_string(),
    }
}
