//! `residuals`: what a model leaves unexplained in records.

use super::args::{InitialChoice, ResidualArguments};
use super::compare::in_units_of;
use super::system::{SeenPole, System};
use super::{figures, json, records, tables};
use crate::gathered::Gathered;
use crate::output::{Failure, print, print_json};
use albatross::sysid::estimate::InitialCondition;
use albatross::sysid::{DataSet, ResidualCheck, ResidualOptions, Simulated, check_residuals};
use serde_json::json;

pub(crate) fn residuals(options: &ResidualArguments) -> Result<(), Failure> {
    let model = System::read(&options.model)?;
    let input = model.input_name(options.input.as_deref())?;
    let outputs: Vec<String> = if options.output.is_empty() {
        model.outputs().iter().map(|s| s.name.clone()).collect()
    } else {
        options.output.clone()
    };
    let model = model.select(&input, &outputs)?;
    let quiet = options.result.quiet;
    let records = records::read_files(&options.files, &input, &outputs, &options.sampling, quiet)?;
    let data = in_units_of(records.data, &model)?;
    let estimated = match options.initial {
        Some(InitialChoice::Estimate) => true,
        Some(_) => false,
        None => model.initial == Some(InitialCondition::Estimate),
    };
    let simulated = model.simulate(&data, estimated)?;
    let step = match options.step {
        Some(step) => step,
        None => step_of(&model.poles()?, &data, options.lags),
    };
    let checks = check(&data, &simulated, Some(options.lags), step)?;
    let value = json!({
        "model": model.name,
        "input": data.input,
        "outputs": data.outputs,
        "intersample": data.intersample,
        "lag_step": step,
        "fits": json::fits(&data.outputs, &simulated)?,
        "residuals": checks,
        "verdicts": checks.iter().map(verdict).collect::<Vec<_>>(),
    });
    if let Some(out) = &options.result.out {
        let files = Gathered::beside(out)?;
        files.add_json("residuals.json", &value)?;
        files.add("residuals.csv", &tables::residuals(&checks)?.to_csv())?;
        let title = format!("Correlation of the residuals of {}", model.name);
        files.add("residuals.svg", &figures::residuals(&title, data.dt(), &checks)?)?;
        files.move_to(out)?;
    }
    if options.result.json {
        return print_json(&value);
    }
    let verdicts: String = checks.iter().map(|c| verdict(c) + "\n").collect();
    print(&format!(
        "{}\n{}\n{verdicts}",
        tables::scores(&data.outputs, &simulated)?.to_text(),
        tables::residuals(&checks)?.to_text()
    ))
}

/// Samples from one lag to the next, so that the lags reach a period of the fastest oscillation below the Nyquist
/// frequency, but no further than a quarter of the shortest record.
pub(crate) fn step_of(poles: &[SeenPole], data: &DataSet, lags: usize) -> usize {
    let fastest = poles
        .iter()
        .filter(|p| p.value.im > 0.0 && p.value.norm() * data.dt() < std::f64::consts::PI)
        .map(|p| p.value.norm())
        .reduce(f64::max);
    let shortest = data.experiments.iter().map(|e| e.len()).min().unwrap_or(0);
    let period = fastest.map_or(0.0, |w| std::f64::consts::TAU / w / data.dt());
    let most = (shortest / 4 / lags.max(1)).max(1);
    ((period / lags.max(1) as f64).ceil() as usize).clamp(1, most)
}

/// Checks of all records and outputs.
pub(crate) fn check(
    data: &DataSet,
    simulated: &[Simulated],
    lags: Option<usize>,
    step: usize,
) -> Result<Vec<ResidualCheck>, Failure> {
    let shortest = data.experiments.iter().map(|e| e.len()).min().unwrap_or(0);
    let usual = ResidualOptions::default();
    // Lags asked for are refused where the records are too short for them, the usual ones are fewer there.
    let lags = lags.unwrap_or(usual.lags.min(shortest.saturating_sub(1) / step));
    let options = ResidualOptions { lags, step, ..usual };
    Ok(check_residuals(
        data,
        &figures::residual_histories(data, simulated),
        &options,
    )?)
}

/// The outcome of a check in a sentence.
pub(crate) fn verdict(check: &ResidualCheck) -> String {
    let place = format!("{}, {}: ", check.experiment, check.output);
    let white = match check.white {
        None => return place + "the residual is zero",
        Some(true) => "the residual passes for white noise",
        Some(false) => {
            "the residual is not white: it holds motion that the model does not have, or coloured noise"
        }
    };
    let independent = match check.independent {
        None => "the input stands still",
        Some(true) => "no dependence on the input is found",
        Some(false) => {
            "it depends on the input: the model lacks dynamics from it; raise the order, or check delay and hold"
        }
    };
    format!("{place}{white}; {independent}")
}
