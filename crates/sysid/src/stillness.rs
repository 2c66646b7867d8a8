//! Where a signal stands still, also with measurement noise.

/// A stretch over which a signal stands still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Run {
    /// First sample.
    pub start: usize,
    /// Number of samples.
    pub len: usize,
    /// Mean over the stretch.
    pub mean: f64,
}

impl Run {
    /// First sample after the stretch.
    pub(crate) fn end(&self) -> usize {
        self.start + self.len
    }
}

/// Largest less smallest value, 0 without values.
pub(crate) fn range(signal: &[f64]) -> f64 {
    let (low, high) = signal
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), &v| (low.min(v), high.max(v)));
    if low <= high { high - low } else { 0.0 }
}

/// Mean value, 0 without values.
pub(crate) fn mean(signal: &[f64]) -> f64 {
    signal.iter().sum::<f64>() / signal.len().max(1) as f64
}

/// Movements up to this size count as standing still: a millionth of the range, and five standard deviations of the
/// measurement noise if there is any.
pub(crate) fn tolerance(signal: &[f64]) -> f64 {
    (5.0 * noise(signal)).max(1e-6 * range(signal))
}

/// Standard deviation of measurement noise, judged from the steps between samples; 0 for signals without.
///
/// Steps of noise are small against the range, and four of six are followed by one in the opposite direction; those of
/// smooth signals seldom are, and those of square signals are large. Steps of zero do not count, since quantised
/// signals have many of them. The median of the magnitude of white noise's steps is 0.954 standard deviations.
pub(crate) fn noise(signal: &[f64]) -> f64 {
    const SMALL: f64 = 0.02;
    const TURNING: f64 = 0.4;
    const FEWEST: usize = 10;
    let steps: Vec<f64> = signal
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|step| *step != 0.0)
        .collect();
    if steps.len() < FEWEST {
        return 0.0;
    }
    let turns = steps.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
    let mut magnitudes: Vec<f64> = steps.iter().map(|step| step.abs()).collect();
    let (_, &mut median, _) = magnitudes.select_nth_unstable_by(steps.len() / 2, f64::total_cmp);
    let small = median <= SMALL * range(signal);
    if small && turns as f64 >= TURNING * (steps.len() - 1) as f64 {
        median / 0.954
    } else {
        0.0
    }
}

/// The signal cut into stretches within which no sample differs from the mean so far by more than `tolerance`.
pub(crate) fn runs(signal: &[f64], tolerance: f64) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (k, &value) in signal.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if (value - run.mean).abs() <= tolerance => {
                run.len += 1;
                run.mean += (value - run.mean) / run.len as f64;
            }
            _ => runs.push(Run {
                start: k,
                len: 1,
                mean: value,
            }),
        }
    }
    runs
}

/// Whether the values follow one another smoothly instead of scattering like noise.
///
/// Half the mean square of the steps over the variance: 1 for white noise, small for a signal that drifts or swings
/// (von Neumann, Annals of Mathematical Statistics 12, 1941).
pub(crate) fn drifts(signal: &[f64]) -> bool {
    let middle = mean(signal);
    let variance: f64 = signal.iter().map(|v| (v - middle).powi(2)).sum();
    let steps: f64 = signal.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    0.5 * steps < 0.3 * variance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_noise_level_of_white_noise_on_a_doublet() {
        let mut rng = fastrand::Rng::with_seed(1);
        let sigma = 0.004;
        let signal: Vec<f64> = (0..2000)
            .map(|k| {
                let square = match k {
                    500..700 => 1.0,
                    700..900 => -1.0,
                    _ => 0.0,
                };
                // Sum of twelve uniform numbers: variance 1.
                square + sigma * ((0..12).map(|_| rng.f64()).sum::<f64>() - 6.0)
            })
            .collect();
        assert!((noise(&signal) / sigma - 1.0).abs() < 0.1, "{}", noise(&signal));
        let runs = runs(&signal, tolerance(&signal));
        let long: Vec<(usize, usize)> = runs
            .iter()
            .filter(|r| r.len > 10)
            .map(|r| (r.start, r.len))
            .collect();
        assert_eq!(long, [(0, 500), (500, 200), (700, 200), (900, 1100)]);
        assert!(!drifts(&signal[..500]));
    }

    #[test]
    fn val_smooth_and_square_signals_have_no_noise() {
        let sine: Vec<f64> = (0..1000).map(|k| (0.02 * f64::from(k)).sin()).collect();
        let square: Vec<f64> = (0..1000).map(|k| f64::from((k / 40) % 2)).collect();
        assert_eq!((noise(&sine), noise(&square)), (0.0, 0.0));
        assert!(drifts(&sine[..50]));
    }
}
