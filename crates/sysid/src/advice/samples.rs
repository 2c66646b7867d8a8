//! What the samples themselves show: limits, resolution, motion and offsets before the manoeuvre.

use albatross_lti::Signal;

use super::{Advice, AdviceKind, short};
use crate::stillness::{Run, drifts, mean, range, runs, tolerance};
use crate::trim::lead_in;
use crate::{DataSet, Experiment};

/// Part of its range by which a signal may differ from zero or drift unnoticed.
const NOTICED: f64 = 0.01;

/// Adds the advice on one record.
pub(super) fn check(data: &DataSet, experiment: &Experiment, advice: &mut Vec<Advice>) {
    // Fewer samples do not tell drift from scatter.
    const FEWEST: usize = 10;
    let lead_in = lead_in(experiment).len;
    if lead_in >= FEWEST && lead_in < experiment.len() {
        advice.extend(end(&data.input, experiment, lead_in));
        advice.extend(offset(experiment, &data.input, &experiment.input, lead_in));
    }
    for (signal, output) in data.outputs.iter().zip(&experiment.outputs) {
        if lead_in >= FEWEST {
            match moving(experiment, signal, output, lead_in) {
                Some(found) => advice.push(found),
                None => advice.extend(offset(experiment, signal, output, lead_in)),
            }
        }
        advice.extend(quantised(experiment, signal, output));
        advice.extend(stuck(experiment, signal, output));
    }
}

fn end(signal: &Signal, experiment: &Experiment, lead_in: usize) -> Option<Advice> {
    let input = &experiment.input;
    let begin = mean(input.get(..lead_in)?);
    let last = runs(input, tolerance(input)).last()?.mean;
    ((last - begin).abs() > 0.1 * range(input)).then(|| {
        let text = format!(
            "the input begins at {} and ends at {}: the response leaves the trim for good, so that gain at rest and slow \
             poles carry much weight, and non-linearity shows; check that the model is wanted there, or use an input that \
             returns",
            short(begin),
            short(last)
        );
        Advice::signal(AdviceKind::InputEnd, &experiment.name, &signal.name, text)
    })
}

fn moving(experiment: &Experiment, signal: &Signal, output: &[f64], lead_in: usize) -> Option<Advice> {
    let before = output.get(..lead_in)?;
    let share = range(before) / range(output);
    (share > NOTICED && drifts(before)).then(|| {
        let text = format!(
            "moves by {} % of its range before the input does: it is disturbed, or the record does not begin in trim; \
             let the motion die out before the manoeuvre, or estimate the initial state and a constant",
            short(100.0 * share)
        );
        Advice::signal(AdviceKind::MovingBefore, &experiment.name, &signal.name, text)
    })
}

fn offset(experiment: &Experiment, signal: &Signal, values: &[f64], lead_in: usize) -> Option<Advice> {
    let before = mean(values.get(..lead_in)?);
    let noticed = before.abs() > NOTICED * range(values);
    (noticed && !experiment.estimate_offset).then(|| {
        let text = format!(
            "has a mean of {} before the input moves: the model takes it for a response; remove the trim, or estimate a \
             constant",
            short(before)
        );
        Advice::signal(AdviceKind::Offset, &experiment.name, &signal.name, text)
    })
}

/// The smallest step between samples that is not zero.
fn quantum(values: &[f64]) -> Option<f64> {
    let steps = values.windows(2).map(|w| (w[1] - w[0]).abs());
    steps.filter(|s| *s > 0.0).min_by(f64::total_cmp)
}

/// Steps that are whole multiples of the smallest one, which is more than a 200th of the range.
fn quantised(experiment: &Experiment, signal: &Signal, output: &[f64]) -> Option<Advice> {
    const FEW: f64 = 200.0;
    const SAMPLES: usize = 50;
    let quantum = quantum(output)?;
    let levels = range(output) / quantum;
    let whole = |w: &[f64]| {
        let steps = (w[1] - w[0]) / quantum;
        (steps - steps.round()).abs() < 1e-3
    };
    (levels < FEW && output.len() >= SAMPLES && output.windows(2).all(whole)).then(|| {
        let text = format!(
            "has {} different values at most, {} apart: rounding acts as noise; record with finer resolution or larger \
             input",
            levels.round() + 1.0,
            short(quantum)
        );
        Advice::signal(AdviceKind::Quantised, &experiment.name, &signal.name, text)
    })
}

/// Equal samples within the record, entered or left by a jump: a smooth signal flattens before it stands still.
fn stuck(experiment: &Experiment, signal: &Signal, output: &[f64]) -> Option<Advice> {
    const AT_LIMIT: usize = 5;
    const ELSEWHERE: usize = 10;
    let quantum = quantum(output)?;
    let (low, high) = output
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let jump = |from: Option<usize>| {
        let (p, q) = (output.get(from?)?, output.get(from? + 1)?);
        Some((q - p).abs())
    };
    // Without quantisation the typical step is the measure, with it three quanta.
    let typical = 0.1 * mean(&output.windows(2).map(|w| (w[1] - w[0]).abs()).collect::<Vec<_>>());
    let cornered = |run: &Run| {
        let jumps = [jump(run.start.checked_sub(1)), jump(run.end().checked_sub(1))];
        jumps
            .into_iter()
            .flatten()
            .any(|j| j > (3.0 * quantum).max(typical))
    };
    let limit = |run: &Run| run.mean == low || run.mean == high;
    let found: Vec<Run> = runs(output, 0.0)
        .into_iter()
        .filter(|run| run.start > 0 && run.end() < output.len() && cornered(run))
        .filter(|run| run.len >= if limit(run) { AT_LIMIT } else { ELSEWHERE })
        .collect();
    let longest = found.iter().max_by_key(|run| run.len)?;
    let samples: usize = found.iter().map(|run| run.len).sum();
    let (kind, what, cure) = if limit(longest) {
        (
            AdviceKind::Saturated,
            "stays at its limit",
            "lower the input or widen the range of the sensor, or leave the record away",
        )
    } else {
        (
            AdviceKind::Stuck,
            "repeats a value",
            "look for lost samples, and cut the record there",
        )
    };
    let text = format!(
        "{what} of {} for {} samples from {} s on ({samples} such samples in all): {cure}",
        short(longest.mean),
        longest.len,
        short(longest.start as f64 * experiment.dt)
    );
    Some(Advice::signal(kind, &experiment.name, &signal.name, text))
}
