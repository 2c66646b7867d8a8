//! Results as JSON.

use super::identify::Identified;
use crate::output::Failure;
use albatross::lti::Signal;
use albatross::numerics::C64;
use albatross::sysid::{Estimate, PoleEstimate, Simulated};
use serde_json::{Map, Value, json};

/// A value for the only output, or an object by output.
pub(crate) fn by_output<T>(
    outputs: &[Signal],
    mut value: impl FnMut(usize) -> Result<T, Failure>,
) -> Result<Value, Failure>
where
    Value: From<T>,
{
    if outputs.len() == 1 {
        return Ok(value(0)?.into());
    }
    let mut map = Map::new();
    for (o, output) in outputs.iter().enumerate() {
        map.insert(output.name.clone(), value(o)?.into());
    }
    Ok(Value::Object(map))
}

fn complex(value: C64) -> Value {
    json!({ "re": value.re, "im": value.im })
}

/// Fits by file: a number, by output if there are several.
pub(crate) fn fits(outputs: &[Signal], simulated: &[Simulated]) -> Result<Value, Failure> {
    let mut map = Map::new();
    for record in simulated {
        let of_record = by_output(outputs, |o| Ok(json!(record.fits.get(o).copied().flatten())))?;
        map.insert(record.experiment.clone(), of_record);
    }
    Ok(Value::Object(map))
}

/// The estimate of a pole: the mode nearest to it or to its conjugate.
fn mode_of(estimate: &Estimate, pole: C64) -> Option<&PoleEstimate> {
    let upper = C64::new(pole.re, pole.im.abs());
    let away = |m: &PoleEstimate| (C64::new(m.re, m.im) - upper).norm();
    estimate
        .uncertainty
        .as_ref()?
        .modes
        .iter()
        .min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// All poles, both members of pairs.
fn poles(estimate: &Estimate) -> Vec<Value> {
    estimate
        .model
        .poles()
        .into_iter()
        .map(|pole| {
            let mode = mode_of(estimate, pole);
            let modulus = pole.norm();
            json!({
                "re": pole.re,
                "im": pole.im,
                "frequency_rad_s": modulus,
                "damping_ratio": if modulus > 0.0 { -pole.re / modulus } else { 0.0 },
                "sd_frequency_rad_s": mode.map(|m| m.sd_frequency_rad_s),
                "sd_damping_ratio": mode.map(|m| m.sd_damping_ratio),
            })
        })
        .collect()
}

pub(crate) fn identified(found: &Identified) -> Result<Value, Failure> {
    let estimate = &found.estimate;
    let model = &estimate.model;
    let outputs = &model.outputs;
    let data = &found.records.data;
    let trim: Map<String, Value> = data
        .experiments
        .iter()
        .zip(&found.records.trim)
        .map(|(e, trim)| (e.name.clone(), json!(trim)))
        .collect();
    let initial_states: Map<String, Value> = found
        .simulated
        .iter()
        .map(|record| {
            let by_name: Map<String, Value> = outputs
                .iter()
                .zip(&record.initial)
                .map(|(output, initial)| (output.name.clone(), json!(initial)))
                .collect();
            (record.experiment.clone(), Value::Object(by_name))
        })
        .collect();
    let zpk: Vec<_> = (0..outputs.len())
        .map(|o| model.zpk(o))
        .collect::<Result<_, _>>()?;
    let training: Vec<&str> = found.training.iter().map(|&e| found.name(e)).collect();
    let uncertainty = estimate.uncertainty.as_ref();
    Ok(json!({
        "input": model.input,
        "outputs": outputs,
        "np": model.order(),
        "nz": model.zeros,
        "records": data.experiments.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(),
        "training": training,
        "sample_time": data.dt(),
        "intersample": data.intersample,
        "intersample_reason": found.records.decision,
        "trim": trim,
        "fits": fits(outputs, &found.simulated)?,
        "poles": poles(estimate),
        "zeros": by_output(outputs, |o| {
            Ok(zpk.get(o).map(|z| z.zeros.iter().map(|z| complex(*z)).collect::<Vec<_>>()))
        })?,
        "gain": by_output(outputs, |o| Ok(zpk.get(o).map(|z| z.gain)))?,
        "transfer_function": by_output(outputs, |o| Ok(json!(model.transfer_function(o)?)))?,
        "delay": model.delay,
        "stable": model.is_stable(),
        "initial_condition": if estimate.initial_estimated { "estimate" } else { "zero" },
        "initial_states": initial_states,
        "cost": estimate.cost,
        "iterations": estimate.iterations.len(),
        "iteration_log": estimate.iterations,
        "stop": estimate.stop,
        "seconds": found.seconds,
        "seed": estimate.seed,
        "starts": estimate.starts,
        "chosen_start": estimate.chosen,
        "modes": uncertainty.map(|u| &u.modes),
        "unknowns": uncertainty.map(|u| u.unknowns),
        "samples": data.select(&found.training)?.samples(),
        "residual_sd": uncertainty.map(|u| &u.residual_sd),
        "residuals": found.residuals,
        "criteria": by_output(outputs, |o| Ok(json!(found.criteria.get(o))))?,
        "warnings": found.warnings,
        "advice": found.advice,
        "options": found.options,
        "model": model,
        "state_space": model.state_space()?,
    }))
}
