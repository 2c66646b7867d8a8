//! `identify`: one model from records.

use super::args::{EstimationOptions, IdentifyCommand, IdentifyOptions, ResultOptions, WeightsChoice};
use super::records::{self, Records};
use super::system::poles_of;
use super::{figures, files, json, residuals, search, tables};
use crate::output::{Failure, print, print_json, remark};
use albatross::sysid::{
    Advice, Criteria, Estimate, Options, ResidualCheck, ResidualOptions, Simulated, Weights, advise,
    criteria, estimate, simulate_records,
};
use std::path::PathBuf;
use std::time::Instant;

/// A model with all that is said about it.
pub(crate) struct Identified {
    pub(crate) records: Records,
    /// Positions of the records fitted.
    pub(crate) training: Vec<usize>,
    pub(crate) options: Options,
    pub(crate) estimate: Estimate,
    /// All records, simulated.
    pub(crate) simulated: Vec<Simulated>,
    pub(crate) residuals: Vec<ResidualCheck>,
    /// Of the training, by output.
    pub(crate) criteria: Vec<Criteria>,
    pub(crate) advice: Vec<Advice>,
    pub(crate) warnings: Vec<String>,
    /// What the estimation took.
    pub(crate) seconds: f64,
}

pub(crate) fn identify(command: &IdentifyCommand) -> Result<(), Failure> {
    match command {
        IdentifyCommand::Single(options) => single(options),
        IdentifyCommand::Search(options) => search::search(options),
    }
}

fn single(options: &IdentifyOptions) -> Result<(), Failure> {
    let (records, training) = read(options)?;
    let zeros = options.nz.unwrap_or(options.np.saturating_sub(1));
    let settings = settings(&options.estimation, options.np, zeros, &records, &training)?;
    let found = Identified::new(records, training, settings)?;
    present(&found, &options.result, options.estimation.log, None)
}

/// All records, and the positions of those to fit on. A record that only `--train` names is read as well.
fn read(options: &IdentifyOptions) -> Result<(Records, Vec<usize>), Failure> {
    let mut files: Vec<PathBuf> = options.data.files.clone();
    let mut training = Vec::new();
    for file in &options.train {
        let position = files.iter().position(|known| known == file).unwrap_or_else(|| {
            files.push(file.clone());
            files.len() - 1
        });
        if !training.contains(&position) {
            training.push(position);
        }
    }
    if training.is_empty() {
        training = (0..files.len()).collect();
    }
    let data = &options.data;
    let records = records::read_files(
        &files,
        &data.input,
        &data.output,
        &data.sampling,
        options.result.quiet,
    )?;
    Ok((records, training))
}

/// Settings with the weights of the records fitted.
pub(crate) fn settings(
    options: &EstimationOptions,
    poles: usize,
    zeros: usize,
    records: &Records,
    training: &[usize],
) -> Result<Options, Failure> {
    let mut settings = options.settings(poles, zeros);
    let WeightsChoice::Given(lists) = &options.weights else {
        return Ok(settings);
    };
    let (outputs, all) = (records.data.outputs.len(), records.data.experiments.len());
    if lists.len() != 1 && lists.len() != outputs {
        return Err(Failure::Other(format!(
            "--weights: found lists for {} outputs, expected one for all or one for each of {outputs}, separated by semicolons",
            lists.len()
        )));
    }
    let weights = (0..outputs)
        .map(|o| {
            let list = lists.get(o).or(lists.first()).map_or(&[][..], Vec::as_slice);
            if list.len() == training.len() {
                Ok(list.to_vec())
            } else if list.len() == all {
                Ok(training.iter().filter_map(|&e| list.get(e).copied()).collect())
            } else {
                Err(Failure::Other(format!(
                    "--weights: found {} numbers, expected {} as there are records to fit",
                    list.len(),
                    training.len()
                )))
            }
        })
        .collect::<Result<Vec<Vec<f64>>, _>>()?;
    settings.weights = Weights::Given(weights);
    Ok(settings)
}

impl Identified {
    /// Fits on the records at the positions given, scores on all.
    pub(crate) fn new(records: Records, training: Vec<usize>, options: Options) -> Result<Self, Failure> {
        let selected = records.data.select(&training)?;
        let start = Instant::now();
        let estimate = estimate(&selected, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let data = &records.data;
        let simulated = simulate_records(&estimate.model, data, estimate.initial_estimated)?;
        let left = figures::residual_histories(data, &simulated);
        let (slowest, fastest) = range_of_modes(&estimate);
        let step = residuals::step_of(&poles_of(&estimate.model), data, ResidualOptions::default().lags);
        let checks = residuals::check(data, &simulated, None, step)?;
        let mut warnings = estimate.warnings.clone();
        if !estimate.model.is_stable() {
            warnings.push(
                "the model is unstable: its fits hold over the length of the records only; identify without --unstable if the plant is stable"
                    .to_owned(),
            );
        }
        Ok(Self {
            advice: advise(data, slowest, fastest),
            criteria: criteria_of(&estimate, &training, &left, &options),
            residuals: checks,
            training,
            options,
            estimate,
            simulated,
            warnings,
            seconds,
            records,
        })
    }

    /// Name of a record as it was given.
    pub(crate) fn name(&self, record: usize) -> &str {
        self.records
            .data
            .experiments
            .get(record)
            .map_or("", |e| e.name.as_str())
    }
}

/// Measured less simulated, by output.
pub(crate) fn differences(measured: &[Vec<f64>], simulated: &[Vec<f64>]) -> Vec<Vec<f64>> {
    measured
        .iter()
        .zip(simulated)
        .map(|(m, s)| m.iter().zip(s).map(|(m, s)| m - s).collect())
        .collect()
}

/// Frequencies of the slowest and the fastest oscillation identified.
fn range_of_modes(estimate: &Estimate) -> (Option<f64>, Option<f64>) {
    let certain: Vec<f64> = estimate
        .uncertainty
        .iter()
        .flat_map(|u| &u.modes)
        .filter(|m| m.identified && m.im > 0.0)
        .map(|m| m.frequency_rad_s)
        .collect();
    let frequencies = if certain.is_empty() {
        let poles = estimate.model.poles();
        poles.iter().filter(|p| p.im > 0.0).map(|p| p.norm()).collect()
    } else {
        certain
    };
    (
        frequencies.iter().copied().reduce(f64::min),
        frequencies.iter().copied().reduce(f64::max),
    )
}

/// Criteria of every output on the records fitted.
fn criteria_of(
    estimate: &Estimate,
    training: &[usize],
    left: &[Vec<Vec<f64>>],
    options: &Options,
) -> Vec<Criteria> {
    let delay = usize::from(matches!(options.delay, albatross::sysid::Delay::UpTo(_)));
    (0..estimate.model.outputs.len())
        .map(|o| {
            let of_training: Vec<&[f64]> = training
                .iter()
                .filter_map(|&e| left.get(e)?.get(o).map(Vec::as_slice))
                .collect();
            let samples: usize = of_training.iter().map(|r| r.len()).sum();
            let sum: f64 = of_training.iter().flat_map(|r| r.iter()).map(|v| v * v).sum();
            let local: usize = estimate
                .initial
                .get(o)
                .into_iter()
                .flatten()
                .map(|i| i.free.len() + usize::from(i.offset != 0.0))
                .sum();
            let unknowns = options.poles + options.zeros + 1 + local + delay;
            criteria(sum / samples.max(1) as f64, samples, unknowns)
        })
        .collect()
}

/// Prints a result, or writes it into a directory as well.
pub(crate) fn present(
    found: &Identified,
    options: &ResultOptions,
    log: bool,
    search: Option<&search::Searched>,
) -> Result<(), Failure> {
    if !options.quiet {
        for advice in &found.advice {
            let place = match (&advice.experiment, &advice.signal) {
                (Some(experiment), Some(signal)) => format!("{experiment}: {signal}: "),
                (Some(experiment), None) => format!("{experiment}: "),
                (None, Some(signal)) => format!("{signal}: "),
                (None, None) => String::new(),
            };
            remark(&format!("note: {place}{}", advice.text));
        }
    }
    let mut value = json::identified(found)?;
    if let (Some(map), Some(searched)) = (value.as_object_mut(), search) {
        map.insert("search".into(), searched.json());
    }
    if let Some(out) = &options.out {
        files::write(out, found, &value, search)?;
    }
    if options.json {
        return print_json(&value);
    }
    if let Some(searched) = search {
        print(&searched.text()?)?;
        print("")?;
    }
    print(&tables::summary(found, log)?)?;
    match &options.out {
        Some(out) => print(&format!("results are in {}", out.display())),
        None => Ok(()),
    }
}
