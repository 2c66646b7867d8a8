//! Decimation: a preparation on request, for records sampled much faster than needed and for methods that suffer from it
//! (discrete-time models).
//!
//! [`crate::estimate()`] works at the rate of its data and needs none. Decimated data are approximate: the held or linear input of the long interval attenuates by sinc^2(f dt), 3 % at a tenth of the new rate, 12 % at a fifth.

use std::f64::consts::PI;

use albatross_numerics::special::bessel_i0;

use crate::data::mismatch;
use crate::{Error, Experiment, Intersample, Result};

/// Attenuation of the stop band that the filter is designed for, dB.
const ATTENUATION_DB: f64 = 85.0;
/// End of the pass band as part of the new Nyquist frequency, at which the stop band begins.
const PASS: f64 = 0.8;

/// Every `factor`-th sample of the low-passed record.
///
/// The outputs pass a symmetric low-pass filter (Kaiser window, 80 dB and more from the new Nyquist frequency on, ripple
/// below 1e-4 up to 0.8 of it), centred so that nothing is delayed, and continued beyond the ends of the record by
/// reflection about the end values. A held input becomes its mean over each new interval, which stays meaningful for
/// edges between the new samples; an input that is linear between samples passes the same filter as the outputs.
///
/// # Errors
/// [`Error::Domain`] for a factor of 0; [`Error::Mismatch`] for a record shorter than half the filter, about 26 times
/// `factor` samples.
pub fn decimate(experiment: &Experiment, factor: usize, intersample: Intersample) -> Result<Experiment> {
    if factor == 0 {
        return Err(Error::Domain {
            what: "the factor of decimation",
            value: 0.0,
            expected: "a whole number from 1",
        });
    }
    if factor == 1 {
        return Ok(experiment.clone());
    }
    let reach = half_length(factor);
    if experiment.len() <= reach {
        return Err(mismatch(
            format!("samples of {} for a decimation by {factor}", experiment.name),
            experiment.len(),
            format!("more than {reach}: lower the factor"),
        ));
    }
    let taps = low_pass(factor);
    let filtered = |signal: &[f64]| filter(signal, &taps, factor);
    Ok(Experiment {
        name: experiment.name.clone(),
        dt: experiment.dt * factor as f64,
        input: match intersample {
            Intersample::Zoh => experiment
                .input
                .chunks(factor)
                .map(|interval| interval.iter().sum::<f64>() / interval.len() as f64)
                .collect(),
            Intersample::Foh => filtered(&experiment.input),
        },
        outputs: experiment.outputs.iter().map(|y| filtered(y)).collect(),
        estimate_offset: experiment.estimate_offset,
    })
}

/// Taps on either side of the middle one (J. F. Kaiser, Proc. IEEE ISCAS 1974: order = (A - 7.95) / (2.285 width)).
fn half_length(factor: usize) -> usize {
    let width = (1.0 - PASS) * PI;
    let order = (ATTENUATION_DB - 7.95) / (2.285 * width) * factor as f64;
    (0.5 * order).ceil() as usize
}

/// Middle tap and those on one side: the ideal low-pass times Kaiser's window, gain 1 at rest.
fn low_pass(factor: usize) -> Vec<f64> {
    let beta = 0.1102 * (ATTENUATION_DB - 8.7);
    let reach = half_length(factor);
    // Half way between pass and stop band, radians a sample.
    let cut = 0.5 * (1.0 + PASS) * PI / factor as f64;
    let mut taps: Vec<f64> = (0..=reach)
        .map(|k| {
            let ideal = if k == 0 {
                cut / PI
            } else {
                (cut * k as f64).sin() / (PI * k as f64)
            };
            let x = k as f64 / (reach + 1) as f64;
            ideal * bessel_i0(beta * (1.0 - x * x).sqrt()) / bessel_i0(beta)
        })
        .collect();
    let gain: f64 = 2.0 * taps.iter().sum::<f64>() - taps.first().copied().unwrap_or(0.0);
    taps.iter_mut().for_each(|tap| *tap /= gain);
    taps
}

/// The filtered signal at every `factor`-th sample.
fn filter(signal: &[f64], taps: &[f64], factor: usize) -> Vec<f64> {
    let at = |k: usize| signal.get(k).copied().unwrap_or(0.0);
    let last = signal.len().saturating_sub(1);
    // Reflected about the end values: x(-k) = 2 x(0) - x(k).
    let after = |k: usize| {
        if k <= last {
            at(k)
        } else {
            2.0 * at(last) - at((2 * last).saturating_sub(k))
        }
    };
    let before = |k: usize, back: usize| match k.checked_sub(back) {
        Some(i) => at(i),
        None => 2.0 * at(0) - after(back - k),
    };
    (0..signal.len())
        .step_by(factor)
        .map(|k| {
            taps.iter()
                .enumerate()
                .map(|(i, tap)| match i {
                    0 => tap * at(k),
                    _ => tap * (before(k, i) + after(k + i)),
                })
                .sum()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn gain(taps: &[f64], omega: f64) -> f64 {
        taps.iter()
            .enumerate()
            .map(|(k, tap)| {
                if k == 0 {
                    *tap
                } else {
                    2.0 * tap * (omega * k as f64).cos()
                }
            })
            .sum()
    }

    fn record(samples: usize, signal: impl Fn(f64) -> f64) -> Experiment {
        let values: Vec<f64> = (0..samples).map(|k| signal(0.001 * k as f64)).collect();
        Experiment::new("r", 0.001, values.clone(), vec![values])
    }

    #[test]
    fn val_ripple_and_attenuation_of_the_filter() {
        for factor in [2, 5, 10, 25] {
            let taps = low_pass(factor);
            let nyquist = PI / factor as f64;
            let (mut ripple, mut leak) = (0.0_f64, 0.0_f64);
            for i in 0..=4000 {
                let x = f64::from(i) / 4000.0;
                ripple = ripple.max((gain(&taps, x * PASS * nyquist) - 1.0).abs());
                leak = leak.max(gain(&taps, nyquist + x * (PI - nyquist)).abs());
            }
            assert!(ripple < 1e-4, "{factor}: ripple {ripple:e}");
            assert!(
                20.0 * leak.log10() < -80.0,
                "{factor}: {} dB",
                20.0 * leak.log10()
            );
        }
    }

    #[test]
    fn val_sines_pass_without_delay_or_vanish() {
        // New Nyquist frequency 50 Hz.
        let pass = decimate(
            &record(5000, |t| (TAU * 7.3 * t + 0.4).sin()),
            10,
            Intersample::Zoh,
        )
        .unwrap();
        assert_eq!((pass.len(), pass.dt), (500, 0.01));
        for k in 30..470 {
            let exact = (TAU * 7.3 * 0.01 * k as f64 + 0.4).sin();
            assert!((pass.outputs[0][k] - exact).abs() < 1e-4, "{k}");
        }
        let stop = decimate(&record(5000, |t| (TAU * 61.0 * t).sin()), 10, Intersample::Zoh).unwrap();
        assert!(stop.outputs[0][30..470].iter().all(|y| y.abs() < 1e-4));
    }

    #[test]
    fn val_an_impulse_stays_where_it_is() {
        let mut impulse = record(2001, |_| 0.0);
        impulse.outputs[0][1000] = 1.0;
        let y = &decimate(&impulse, 10, Intersample::Foh).unwrap().outputs[0];
        let largest = (0..y.len()).max_by(|&i, &j| y[i].total_cmp(&y[j])).unwrap();
        assert_eq!(largest, 100);
        for i in 1..90 {
            assert_eq!(y[100 + i], y[100 - i], "{i}");
        }
    }

    #[test]
    fn val_straight_lines_keep_also_at_the_ends() {
        let line = decimate(&record(1003, |t| 2.0 - 3.0 * t), 7, Intersample::Foh).unwrap();
        assert_eq!(line.len(), 144);
        for (k, y) in line.outputs[0].iter().enumerate() {
            assert!((y - (2.0 - 0.021 * k as f64)).abs() < 1e-12, "{k}");
        }
        assert_eq!(line.input, line.outputs[0]);
    }

    #[test]
    fn val_held_input_becomes_the_mean_of_each_interval() {
        let mut doublet = record(600, |_| 0.0);
        doublet.input[103..107].fill(1.0);
        let u = decimate(&doublet, 10, Intersample::Zoh).unwrap().input;
        assert_eq!((u[9], u[10], u[11]), (0.0, 0.4, 0.0));
    }

    #[test]
    fn regress_refusals() {
        let short = record(200, |t| t);
        assert!(matches!(
            decimate(&short, 0, Intersample::Zoh),
            Err(Error::Domain { .. })
        ));
        let error = decimate(&short, 10, Intersample::Zoh).unwrap_err().to_string();
        assert!(
            error.contains("found 200") && error.contains("lower the factor"),
            "{error}"
        );
        assert_eq!(decimate(&short, 1, Intersample::Zoh).unwrap(), short);
    }
}
