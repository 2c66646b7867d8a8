//! What the spectra, the length and the sample time of the records allow.

use std::f64::consts::{PI, TAU};

use super::{Advice, AdviceKind, short};
use crate::spectrum::{continued_spectrum, log_grid};
use crate::{DataSet, Experiment};

/// An input this far below its peak excites nothing that noise would not hide: 40 dB.
const WEAK: f64 = 0.01;
/// An input within 20 dB of its peak excites well.
const STRONG: f64 = 0.1;
/// Frequencies at which spectra are evaluated: 1.2 % apart over three decades, a third of a doublet's first null.
const GRID: usize = 600;
/// Bands named in a text.
const NAMED: usize = 4;

/// Spectrum of an input over its peak.
struct Relative<'a> {
    experiment: &'a Experiment,
    peak: f64,
    values: Vec<f64>,
}

impl<'a> Relative<'a> {
    fn new(experiment: &'a Experiment, omega: &[f64]) -> Self {
        let dt = experiment.dt;
        // The continuation of an input that ends elsewhere has no peak but grows towards zero frequency: the longest
        // period in the record limits it.
        let coarse = log_grid(PI / experiment.duration().max(dt), 0.9 * PI / dt, 200);
        let peak = continued_spectrum(&experiment.input, dt, &coarse)
            .into_iter()
            .fold(0.0, f64::max);
        let values = continued_spectrum(&experiment.input, dt, omega)
            .into_iter()
            .map(|v| v / peak.max(f64::MIN_POSITIVE))
            .collect();
        Self {
            experiment,
            peak,
            values,
        }
    }

    fn at(&self, omega: f64) -> f64 {
        let value = continued_spectrum(&self.experiment.input, self.experiment.dt, &[omega]);
        value
            .first()
            .map_or(0.0, |v| v / self.peak.max(f64::MIN_POSITIVE))
    }
}

/// Coverage of every record, and the bands that none of them covers.
pub(super) fn excitation(data: &DataSet, slowest: Option<f64>, fastest: Option<f64>) -> Vec<Advice> {
    let longest = longest(data);
    let nyquist = PI / data.dt().max(f64::MIN_POSITIVE);
    let low = slowest.unwrap_or(TAU / longest.max(data.dt()));
    let high = fastest.unwrap_or(nyquist).min(0.9 * nyquist).max(1.01 * low);
    if data.experiments.is_empty() || !(low.is_finite() && high.is_finite()) {
        return Vec::new();
    }
    let omega = log_grid(low, high, GRID);
    let records: Vec<Relative> = data
        .experiments
        .iter()
        .map(|e| Relative::new(e, &omega))
        .collect();

    let mut advice: Vec<Advice> = records
        .iter()
        .filter(|r| r.peak == 0.0)
        .map(|r| {
            let text = "the input stands still: the record tells the free response only; leave it away or check the \
                        column of the input";
            Advice::signal(
                AdviceKind::Excitation,
                &r.experiment.name,
                &data.input.name,
                text.to_owned(),
            )
        })
        .collect();
    advice.push(coverage(&records, &omega));
    if slowest.is_some() && fastest.is_some() {
        advice.extend(gaps(&records, &omega, longest));
    }
    advice
}

fn coverage(records: &[Relative], omega: &[f64]) -> Advice {
    let parts: Vec<String> = records
        .iter()
        .map(|r| {
            let bands = bands(omega, |i| r.values.get(i).is_some_and(|v| *v >= STRONG));
            format!("{} excites {}", r.experiment.name, list(&bands, "nothing"))
        })
        .collect();
    Advice::all(
        AdviceKind::Coverage,
        format!(
            "within 20 dB of the peak of its spectrum, {}: trust poles within these bands, add records for others",
            parts.join("; ")
        ),
    )
}

/// Bands of the range in which no record excites, wide enough to be resolved by the longest record.
fn gaps(records: &[Relative], omega: &[f64], longest: f64) -> Option<Advice> {
    let best = |i: usize| {
        let values = records.iter().filter_map(|r| r.values.get(i));
        values.copied().fold(0.0, f64::max)
    };
    let resolved = |band: &(f64, f64)| band.1 - band.0 >= 0.3 * TAU / longest.max(f64::MIN_POSITIVE);
    let gaps: Vec<(f64, f64)> = bands(omega, |i| best(i) < WEAK)
        .into_iter()
        .filter(resolved)
        .collect();
    let widest = gaps.iter().max_by(|p, q| (p.1 / p.0).total_cmp(&(q.1 / q.0)))?;
    let null = |&(low, high): &(f64, f64)| (high < 1.2 * low).then(|| smallest(records, low, high));
    let nulls: Vec<String> = gaps.iter().filter_map(null).take(NAMED).map(hertz).collect();
    let mut text = format!(
        "no input comes within 40 dB of the peak of its spectrum at {}",
        list(&gaps, "")
    );
    if !nulls.is_empty() {
        text += &format!(" (nulls at {} Hz)", nulls.join(", "));
    }
    // Most of a doublet lies at 0.74 of its frequency.
    let centre = (widest.0 * widest.1).sqrt();
    text += &format!(
        ": poles there are not identified; add a record with a doublet of about {} Hz, or a sweep over the band",
        hertz(centre / 0.742)
    );
    Some(Advice::all(AdviceKind::Excitation, text))
}

/// Frequency within the band at which the best record is weakest, by golden section.
fn smallest(records: &[Relative], mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let best = |w: f64| records.iter().map(|r| r.at(w)).fold(0.0, f64::max);
    for _ in 0..30 {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if best(left) < best(right) {
            high = right;
        } else {
            low = left;
        }
    }
    0.5 * (low + high)
}

/// Stretches of the grid on which `inside` holds; ends half way to the neighbours outside.
fn bands(omega: &[f64], inside: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
    let mut bands: Vec<(f64, f64)> = Vec::new();
    let mut open = false;
    for (i, &w) in omega.iter().enumerate() {
        let now = inside(i);
        match (now, bands.last_mut().filter(|_| open)) {
            (true, Some(band)) => band.1 = w,
            (true, None) => bands.push((before(omega, i, w), w)),
            (false, Some(band)) => band.1 = (band.1 * w).sqrt(),
            (false, None) => {}
        }
        open = now;
    }
    bands
}

fn before(omega: &[f64], i: usize, w: f64) -> f64 {
    let previous = i.checked_sub(1).and_then(|k| omega.get(k));
    previous.map_or(w, |p| (p * w).sqrt())
}

fn list(bands: &[(f64, f64)], none: &str) -> String {
    let named: Vec<String> = bands
        .iter()
        .take(NAMED)
        .map(|(low, high)| format!("{} to {} Hz", hertz(*low), hertz(*high)))
        .collect();
    match bands.len().saturating_sub(NAMED) {
        0 if named.is_empty() => none.to_owned(),
        0 => named.join(", "),
        more => format!("{} and {more} more bands", named.join(", ")),
    }
}

fn hertz(omega: f64) -> String {
    short(omega / TAU)
}

fn longest(data: &DataSet) -> f64 {
    data.experiments
        .iter()
        .map(Experiment::duration)
        .fold(0.0, f64::max)
}

/// The longest record against the period of the slowest pole.
pub(super) fn record_length(data: &DataSet, slowest: f64) -> Option<Advice> {
    let (length, period) = (longest(data), TAU / slowest);
    let (length_s, period_s, modulus) = (short(length), short(period), short(slowest));
    let head = format!(
        "the longest record lasts {length_s} s, the slowest pole ({modulus} rad/s) has a period of {period_s} s"
    );
    let text = if length < 0.25 * period {
        format!(
            "{head}: it cannot be told from a trend and is not identifiable; record {period_s} s or more, or lower the \
             order and do not interpret that pole"
        )
    } else if length < period {
        format!("{head}: its frequency and damping are uncertain; record {period_s} s or more")
    } else {
        return None;
    };
    Some(Advice::all(AdviceKind::RecordLength, text))
}

/// The sample time against the fastest pole.
pub(super) fn sampling(data: &DataSet, fastest: f64) -> Option<Advice> {
    const MOST: f64 = 200.0;
    const ENOUGH: f64 = 50.0;
    let dt = data.dt();
    let nyquist = PI / dt;
    let per_period = TAU / (fastest * dt);
    let pole = format!("the fastest pole ({} rad/s)", short(fastest));
    if fastest > 0.5 * nyquist {
        return Some(Advice::all(
            AdviceKind::Nyquist,
            format!(
                "{pole} lies above half the Nyquist frequency ({} rad/s): what the input does between samples decides it; \
                 sample with {} s or less, or lower the order",
                short(nyquist),
                short(PI / (5.0 * fastest))
            ),
        ));
    }
    (per_period > MOST).then(|| {
        Advice::all(
            AdviceKind::Oversampled,
            format!(
                "{pole} is sampled {} times a period: more samples cost time and tell little; decimate by {}",
                per_period.round(),
                (per_period / ENOUGH).floor()
            ),
        )
    })
}

/// Energy of the outputs in the last fifth below the Nyquist frequency, within 30 dB of the peak of the spectrum.
pub(super) fn aliasing(data: &DataSet) -> Vec<Advice> {
    const NEAR: f64 = 0.0316;
    let mut advice = Vec::new();
    for experiment in &data.experiments {
        let dt = experiment.dt;
        let near: Vec<f64> = (0..20).map(|i| PI / dt * (0.8 + 0.01 * f64::from(i))).collect();
        let all = log_grid(PI / experiment.duration().max(dt), 0.99 * PI / dt, 200);
        for (signal, output) in data.outputs.iter().zip(&experiment.outputs) {
            let peak = continued_spectrum(output, dt, &all)
                .into_iter()
                .fold(0.0, f64::max);
            let tail = continued_spectrum(output, dt, &near);
            let level = (tail.iter().map(|v| v * v).sum::<f64>() / tail.len() as f64).sqrt();
            if level > NEAR * peak {
                let text = format!(
                    "the spectrum near the Nyquist frequency ({} Hz) is only {} dB below its peak: faster motion or noise \
                     is folded into the record; sample faster or filter before sampling",
                    short(0.5 / dt),
                    (20.0 * (peak / level).log10()).round()
                );
                advice.push(Advice::signal(
                    AdviceKind::Nyquist,
                    &experiment.name,
                    &signal.name,
                    text,
                ));
            }
        }
    }
    advice
}
