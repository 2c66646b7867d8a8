//! Amplitude spectrum at chosen frequencies.

use albatross_numerics::C64;

/// Magnitude of dt sum u(k) exp(-i omega k dt), in the unit of the signal times s, at each frequency (rad/s).
///
/// The sum is the Fourier transform of the signal taken as zero outside the record, a rectangle rule for signals that
/// are continuous; that of the signal held from sample to sample is smaller by |sin(x)/x|, x = omega dt / 2. Direct
/// evaluation, samples times frequencies: any frequencies may be asked for, and there are few of them.
pub fn spectrum(signal: &[f64], dt: f64, omega_rad_s: &[f64]) -> Vec<f64> {
    omega_rad_s
        .iter()
        .map(|omega| dt * transform(signal, omega * dt).norm())
        .collect()
}

/// Magnitude of the spectrum of the signal continued by its first value before and its last value after the record.
///
/// From the steps, whose transform is that of the signal times 1 - exp(-i omega dt): neither an offset nor a final
/// value that differs from the first one adds the jumps that cutting the record off would add.
pub(crate) fn continued_spectrum(signal: &[f64], dt: f64, omega_rad_s: &[f64]) -> Vec<f64> {
    let steps: Vec<f64> = signal.windows(2).map(|w| w[1] - w[0]).collect();
    omega_rad_s
        .iter()
        .map(|omega| dt * transform(&steps, omega * dt).norm() / (2.0 * (0.5 * omega * dt).sin().abs()))
        .collect()
}

/// Sum of u(k) exp(-i k angle).
fn transform(signal: &[f64], angle: f64) -> C64 {
    // The turn of every block starts afresh, so that rounding does not build up.
    const BLOCK: usize = 256;
    let turn = C64::new(angle.cos(), -angle.sin());
    signal
        .chunks(BLOCK)
        .enumerate()
        .filter(|(_, block)| block.iter().any(|&u| u != 0.0))
        .map(|(i, block)| {
            let start = angle * (i * BLOCK) as f64;
            let sum = block
                .iter()
                .rev()
                .fold(C64::new(0.0, 0.0), |sum, &u| sum * turn + u);
            sum * C64::new(start.cos(), -start.sin())
        })
        .sum()
}

/// `count` frequencies from `low` to `high`, equally spaced in their logarithm.
pub(crate) fn log_grid(low: f64, high: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|i| low * (high / low).powf(i as f64 / last))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    /// Square doublet of period `period` samples, beginning at sample 100.
    fn doublet(period: usize) -> Vec<f64> {
        let mut u = vec![0.0; 5000];
        u[100..100 + period / 2].fill(1.0);
        u[100 + period / 2..100 + period].fill(-1.0);
        u
    }

    #[test]
    fn val_square_doublet_in_closed_form() {
        // Sum of the geometric series: (1 - z^-(N/2))^2 / (1 - z^-1), so that
        // |U| = 2 dt sin^2(omega T/4) / |sin(omega dt/2)|, T = N dt; for dt -> 0, 4 sin^2(omega T/4) / omega.
        let (dt, period) = (0.001, 334);
        let u = doublet(period);
        let omega = log_grid(0.1, PI / dt, 400);
        let t = period as f64 * dt;
        let (found, continued) = (spectrum(&u, dt, &omega), continued_spectrum(&u, dt, &omega));
        for (i, w) in omega.iter().enumerate() {
            let exact = 2.0 * dt * (w * t / 4.0).sin().powi(2) / (0.5 * w * dt).sin().abs();
            assert!((found[i] - exact).abs() < 1e-13, "{w}: {} {exact}", found[i]);
            assert!(
                (continued[i] - exact).abs() < 1e-12,
                "{w}: {} {exact}",
                continued[i]
            );
            if *w < 100.0 {
                let continuous = 4.0 * (w * t / 4.0).sin().powi(2) / w;
                assert!((found[i] - continuous).abs() < 5e-4 * t, "{w}");
            }
        }
    }

    #[test]
    fn val_nulls_of_a_doublet_at_even_multiples_of_its_frequency() {
        // 0.5 Hz at 1 kHz.
        let u = doublet(2000);
        let peak = spectrum(&u, 0.001, &[0.742 * TAU * 0.5])[0];
        let nulls = spectrum(&u, 0.001, &[TAU, 2.0 * TAU, 7.0 * TAU]);
        assert!(nulls.iter().all(|v| *v < 1e-12 * peak), "{nulls:?}");
        // Its peak: tan x = 2 x with x = omega T/4, f = 0.742 f0.
        let x = 1.165_561_185_207_211_3_f64;
        assert!((x.tan() - 2.0 * x).abs() < 1e-12);
        assert!((2.0 * x / PI - 0.742).abs() < 1e-3);
    }

    #[test]
    fn val_continued_step() {
        // A step of height 2 never ends: 2 / omega.
        let mut u = vec![3.0; 1000];
        u[400..].fill(5.0);
        let found = continued_spectrum(&u, 1e-3, &[1.0, 10.0]);
        assert!((found[0] - 2.0).abs() < 1e-6 && (found[1] - 0.2).abs() < 1e-5);
    }
}
