//! Thinning of records sampled much faster than their dynamics.

use albatross_numerics::C64;

use crate::fourier::transform;
use crate::{DataSet, Experiment, Result};

/// Samples wanted for a period of the highest frequency that matters.
const SAMPLES_A_PERIOD: f64 = 8.0;

/// Part of the energy of an output that may lie above that frequency: a mode that has this much less energy than all
/// together changes the fit by 1 %.
const CAREFUL: f64 = 1e-4;

/// The same for records that are still long then.
const BOLD: f64 = 1e-2;

/// Fewest samples that thinning leaves in the shortest record, and number that makes a record long.
const FEWEST: usize = 400;
const MANY: usize = 500;

/// The records with every `factor` samples replaced by their mean.
///
/// Input and output pass the same filter, so that the means obey the same differential equation exactly; only the
/// shape of the input between the means is lost. A mean of the input beside single samples of the output would
/// displace an edge inside an interval by up to half of it.
pub(crate) fn thin(data: &DataSet, factor: usize) -> Result<DataSet> {
    if factor < 2 {
        return Ok(data.clone());
    }
    let means = |values: &Vec<f64>| -> Vec<f64> {
        let mean = |block: &[f64]| block.iter().sum::<f64>() / factor as f64;
        values.chunks_exact(factor).map(mean).collect()
    };
    let experiments = data
        .experiments
        .iter()
        .map(|e| Experiment {
            name: e.name.clone(),
            dt: e.dt * factor as f64,
            input: means(&e.input),
            outputs: e.outputs.iter().map(means).collect(),
            estimate_offset: e.estimate_offset,
        })
        .collect();
    DataSet::try_new(
        data.input.clone(),
        data.outputs.clone(),
        experiments,
        data.intersample,
    )
}

/// Factor that keeps the dynamics seen in the outputs, and 400 samples in the shortest record; 1 for data that are
/// sampled slowly already.
///
/// All but 1e-4 of the energy keeps eight samples in a period. The edges of square inputs leave a tail in the spectrum
/// that would hold the factor down for nothing, so records of more than 500 samples are thinned on as long as all but
/// 1 % of the energy keeps them.
pub(crate) fn automatic_factor(data: &DataSet) -> usize {
    let shortest = data.experiments.iter().map(Experiment::len).min().unwrap_or(0);
    let largest = shortest / FEWEST;
    if largest < 2 {
        return 1;
    }
    let spectra: Vec<Vec<f64>> = data
        .experiments
        .iter()
        .flat_map(|e| {
            e.outputs
                .iter()
                .map(|y| periodogram(&without_feedthrough(&e.input, y)))
        })
        .collect();
    let allowed = |negligible: f64| {
        let band = spectra.iter().map(|p| band_of(p, negligible)).fold(0.0, f64::max);
        // Saturates for a band of zero.
        (1.0 / (SAMPLES_A_PERIOD * band)) as usize
    };
    let long = (shortest / MANY).min(allowed(BOLD));
    allowed(CAREFUL).max(long).clamp(1, largest)
}

/// The output less its regression on the input in differences, and less the line through its ends.
///
/// These are the part that follows the input at once (if it makes up most of the differences), whose edges would fill
/// the spectrum, and the jump from the end to the beginning.
fn without_feedthrough(input: &[f64], output: &[f64]) -> Vec<f64> {
    let slopes = |values: &[f64]| -> Vec<f64> { values.windows(2).map(|w| w[1] - w[0]).collect() };
    let (du, dy) = (slopes(input), slopes(output));
    let energy: f64 = du.iter().map(|u| u * u).sum();
    let common: f64 = du.iter().zip(&dy).map(|(u, y)| u * y).sum();
    let total: f64 = dy.iter().map(|y| y * y).sum();
    // Without a real feed-through the regression would add edges rather than remove them.
    let gain = if common * common > 0.5 * energy * total {
        common / energy
    } else {
        0.0
    };
    let rest: Vec<f64> = output.iter().zip(input).map(|(y, u)| y - gain * u).collect();
    // Ends are means of a few samples, or the line of a noisy record would be one more disturbance.
    let few = (rest.len() / 100).max(1).min(rest.len());
    let mean = |values: &[f64]| values.iter().sum::<f64>() / few.max(1) as f64;
    let (first, last) = (mean(&rest[..few]), mean(&rest[rest.len() - few..]));
    let span = rest.len().saturating_sub(1).max(1) as f64;
    rest.iter()
        .enumerate()
        .map(|(k, y)| y - first - (last - first) * k as f64 / span)
        .collect()
}

/// Part of the sampling frequency below which all but the negligible part of the energy lies.
///
/// White noise is estimated by the mean of the upper half of the spectrum and taken off everywhere; a spectrum in
/// which that is more than half is occupied throughout.
fn band_of(power: &[f64], negligible: f64) -> f64 {
    let count = power.len();
    let half = &power[count / 2..];
    let floor = half.iter().sum::<f64>() / half.len().max(1) as f64;
    let energy: Vec<f64> = power.iter().map(|p| p - floor).collect();
    let total: f64 = energy.iter().sum();
    let raw: f64 = power.iter().sum();
    if raw.is_nan() || raw <= 0.0 {
        return 0.0;
    }
    if total <= 0.5 * raw {
        return 0.5;
    }
    let mut above = 0.0;
    for (k, e) in energy.iter().enumerate().rev() {
        above += e;
        // The noise left after its mean is gone scatters by the root of the number of its lines.
        let scatter = floor * (2.0 * (count - k) as f64).sqrt();
        if above > negligible * total + 3.0 * scatter {
            return 0.5 * (k + 1) as f64 / count as f64;
        }
    }
    0.5
}

/// Squared magnitudes of the Fourier transform from zero to half the sampling frequency, padded with zeros.
fn periodogram(values: &[f64]) -> Vec<f64> {
    let n = values.len().next_power_of_two();
    let mut x: Vec<C64> = values.iter().map(|v| C64::new(*v, 0.0)).collect();
    x.resize(n, C64::new(0.0, 0.0));
    transform(&mut x);
    x.iter().take((n / 2).max(1)).map(|v| v.norm_sqr()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arx::tests::{data_of, gaussian};

    fn burst(frequency: f64, dt: f64, n: usize, noise: f64) -> DataSet {
        let mut random = fastrand::Rng::with_seed(21);
        let e = gaussian(&mut random, n);
        let decay = |k: usize| (-0.8 * k as f64 * dt).exp();
        let y = (0..n)
            .map(|k| decay(k) * (std::f64::consts::TAU * frequency * k as f64 * dt).sin() + noise * e[k]);
        data_of(
            vec![((0..n).map(|k| f64::from(u8::from(k > 9))).collect(), y.collect())],
            dt,
        )
    }

    /// Dynamics to 10 Hz sampled at 1 kHz, with and without noise of 1 %: about 100 Hz remain.
    #[test]
    fn prop_fast_data_are_thinned_and_slow_data_are_not() {
        for noise in [0.0, 0.003] {
            let factor = automatic_factor(&burst(10.0, 0.001, 5000, noise));
            assert!((5..=12).contains(&factor), "{factor}");
        }
        assert_eq!(automatic_factor(&burst(10.0, 0.02, 5000, 0.0)), 1);
        assert_eq!(automatic_factor(&burst(10.0, 0.001, 700, 0.0)), 1);
        let mut random = fastrand::Rng::with_seed(22);
        let white = data_of(
            vec![(gaussian(&mut random, 1500), gaussian(&mut random, 1500))],
            0.1,
        );
        assert_eq!(automatic_factor(&white), 1);
    }

    #[test]
    fn val_means_of_blocks() {
        let data = data_of(vec![((0..11).map(f64::from).collect(), vec![1.0; 11])], 0.1);
        let thinned = thin(&data, 4).unwrap();
        assert_eq!(thinned.experiments[0].input, [1.5, 5.5]);
        assert_eq!(thinned.experiments[0].outputs[0], [1.0, 1.0]);
        assert!((thinned.dt() - 0.4).abs() < 1e-15);
    }
}
