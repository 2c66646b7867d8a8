//! How the input behaves between samples, judged from its samples.

use crate::Intersample;
use crate::stillness::{range, tolerance};

/// Tells staircases (square doublets, random bits, noise held for a sample) from ramps and smooth inputs.
///
/// A move of a staircase stands alone or differs much from the moves next to it; a move of a ramp or of a smooth signal
/// is like at least one of its neighbours. Moves are weighted by their size, so that few large ones decide. Measurement
/// noise is left out; if the moves above the noise do not add up to half the range, the input moved in steps that the
/// noise hides, hence gradually.
///
/// A ramp from one sample to the next cannot be told from a step and counts as one, as does an input that never moves. A
/// smooth signal of fewer than about eight samples a period counts as a staircase.
pub fn detect_intersample(input: &[f64]) -> Intersample {
    let tolerance = std::f64::consts::SQRT_2 * tolerance(input);
    let steps: Vec<f64> = input.windows(2).map(|w| w[1] - w[0]).collect();
    let alike = |p: f64, q: f64| (p - q).abs() <= 0.5 * p.abs().max(q.abs());
    let (mut moved, mut gradual) = (0.0, 0.0);
    for (k, &step) in steps.iter().enumerate() {
        if step.abs() <= tolerance {
            continue;
        }
        moved += step.abs();
        let before = k.checked_sub(1).and_then(|i| steps.get(i));
        let after = steps.get(k + 1);
        if before.into_iter().chain(after).any(|&other| alike(step, other)) {
            gradual += step.abs();
        }
    }
    let hidden = moved < 0.5 * range(input);
    if hidden || gradual > 0.5 * moved {
        Intersample::Foh
    } else {
        Intersample::Zoh
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    /// A square doublet with edges that take `ramp` samples.
    fn doublet(ramp: usize) -> Vec<f64> {
        let level = |k: usize| match k {
            100..150 => 1.0,
            150..200 => -1.0,
            _ => 0.0,
        };
        (0..600)
            .map(|k: usize| (0..ramp).map(|i| level(k.saturating_sub(i))).sum::<f64>() / ramp as f64)
            .collect()
    }

    /// sin^4 doublet of `samples` samples: three times continuously differentiable at its ends.
    fn smooth(samples: usize) -> Vec<f64> {
        (0..1000)
            .map(|k| {
                let x = (f64::from(k) - 100.0) / samples as f64;
                if (0.0..1.0).contains(&x) {
                    (TAU * x).sin() * (PI * x).sin().powi(4)
                } else {
                    0.0
                }
            })
            .collect()
    }

    fn sweep() -> Vec<f64> {
        // 0.1 to 10 Hz in 20 s at 100 Hz: down to ten samples a period.
        (0..2000)
            .map(|k| {
                let t = 0.01 * f64::from(k);
                (TAU * (0.1 * t + 0.5 * 9.9 / 20.0 * t * t)).sin()
            })
            .collect()
    }

    fn bits(clock: usize) -> Vec<f64> {
        let mut rng = fastrand::Rng::with_seed(7);
        let mut bit = 1.0;
        (0..1000)
            .map(|k| {
                if k % clock == 0 {
                    bit = if rng.bool() { 1.0 } else { -1.0 };
                }
                bit
            })
            .collect()
    }

    fn gauss(rng: &mut fastrand::Rng) -> f64 {
        (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
    }

    fn noisy(mut signal: Vec<f64>, sigma: f64) -> Vec<f64> {
        let mut rng = fastrand::Rng::with_seed(3);
        signal.iter_mut().for_each(|v| *v += sigma * gauss(&mut rng));
        signal
    }

    #[test]
    fn val_staircases_are_held() {
        let mut rng = fastrand::Rng::with_seed(5);
        let white: Vec<f64> = (0..1000).map(|_| gauss(&mut rng)).collect();
        let slow_controller: Vec<f64> = (0..1000).map(|k| (0.01 * f64::from(k / 4 * 4)).sin()).collect();
        let step = [vec![0.0; 10], vec![1.0; 90]].concat();
        for (name, signal) in [
            ("square doublet", doublet(1)),
            ("bits", bits(1)),
            ("slow bits", bits(10)),
            ("white noise", white),
            ("smooth signal held for four samples", slow_controller),
            ("step", step),
            ("constant", vec![2.0; 50]),
            ("empty", vec![]),
            ("noisy doublet", noisy(doublet(1), 0.005)),
            ("noisy slow bits", noisy(bits(10), 0.005)),
        ] {
            assert_eq!(detect_intersample(&signal), Intersample::Zoh, "{name}");
        }
    }

    #[test]
    fn val_ramps_and_smooth_inputs_are_linear() {
        for (name, signal) in [
            ("edge of two samples", doublet(2)),
            ("edge of ten samples", doublet(10)),
            ("smooth doublet", smooth(330)),
            ("fast smooth doublet", smooth(33)),
            ("sweep", sweep()),
            ("noisy ramps", noisy(doublet(10), 0.005)),
            ("noisy smooth doublet", noisy(smooth(330), 0.002)),
            ("noisier smooth doublet", noisy(smooth(330), 0.01)),
            ("noisy sweep", noisy(sweep(), 0.005)),
        ] {
            assert_eq!(detect_intersample(&signal), Intersample::Foh, "{name}");
        }
    }
}
