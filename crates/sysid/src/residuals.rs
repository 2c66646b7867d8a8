//! What a model has left unexplained: whether its residuals are white, and whether the input still shows in them.
//!
//! With residuals `e` and input `u` of `N` samples, means not removed,
//! ```text
//! r_e(k)  = 1/N sum_t e(t) e(t - k)             rho_e(k)  = r_e(k)/r_e(0)
//! r_eu(k) = 1/N sum_t e(t) u(t - k)             rho_eu(k) = r_eu(k)/sqrt(r_e(0) r_u(0))
//! ```
//! White residuals have `rho_e(k)` of variance 1/N. Residuals independent of the input, white or not, have `rho_eu(k)`
//! of variance (L. Ljung, System Identification, 1999, section 16.6)
//! ```text
//! P = sum_k r_e(k) r_u(k)/(N r_e(0) r_u(0)),    k over all lags, of both signs
//! ```
//! MATLAB's `resid` truncates that sum at the last lag shown; with a slow input sampled fast, the part left out is the
//! greater one. The bounds are the normal quantile of the level, 2.576 for 1 % (two-sided), times the standard deviation.
//!
//! *White* is judged by the sum over lags `Q = N (N + 2) sum_k rho_e(k)^2/(N - k)` (G. M. Ljung, G. E. P. Box, Biometrika
//! 65, 1978) against the quantile of chi-square. *Independent* is judged by the largest `|rho_eu|`: its bound is that of the
//! level divided by the number of lags (Bonferroni), since estimates at neighbouring lags of a slow input are nearly
//! equal, and their violations come together. Each verdict is wrong for about a share `level` of sound models.
//!
//! **Limits.** A record with a single doublet has few independent frequencies in its input: `P` contains the residuals'
//! own correlation with it, so that only a coarse dependence is found. Residuals of deterministic simulations are never
//! white.
//!
//! Equations: THEORY (34).

use serde::Serialize;

use crate::data::mismatch;
use crate::fourier::autocovariance;
use crate::{DataSet, Error, Result};

/// Lags and level of the checks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResidualOptions {
    /// Greatest lag, in steps; 25 unless told.
    pub lags: usize,
    /// Samples from one lag to the next; 1 unless told. Records sampled much faster than the modes need more, so that
    /// the lags reach as far as a period.
    pub step: usize,
    /// Share of sound residuals that a bound rejects; 0.01 unless told: bounds of 99 %.
    pub level: f64,
}

impl Default for ResidualOptions {
    fn default() -> Self {
        Self {
            lags: 25,
            step: 1,
            level: 0.01,
        }
    }
}

/// A correlation over lags with the bounds of its estimates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Correlation {
    /// Lags in samples.
    pub lags: Vec<i64>,
    /// Correlation at each lag, -1 to 1.
    pub values: Vec<f64>,
    /// Bound of the absolute value at each single lag (lag 0 of an autocorrelation apart).
    pub bound: f64,
    /// Values outside the bound.
    pub violations: usize,
    /// Violations expected from sound residuals: the level times the number of lags.
    pub expected_violations: f64,
}

/// The check of one output of one experiment.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualCheck {
    /// Name of the experiment.
    pub experiment: String,
    /// Name of the output.
    pub output: String,
    /// Number of samples.
    pub samples: usize,
    /// Root mean square of the residuals, in the unit of the output.
    pub rms: f64,
    /// Autocorrelation of the residuals, lags from 0.
    pub auto: Correlation,
    /// Correlation of residuals and input, lags of both signs: at a positive one the residual comes after the input, the
    /// mark of dynamics that the model lacks; at a negative one before it, the mark of feedback.
    pub cross: Correlation,
    /// Ljung-Box statistic of the autocorrelation.
    pub ljung_box: f64,
    /// Bound of that statistic.
    pub ljung_box_bound: f64,
    /// Largest absolute cross-correlation that is still accepted over all lags together.
    pub cross_bound_of_all: f64,
    /// Whether the residuals pass for white; none if they are all zero.
    pub white: Option<bool>,
    /// Whether the residuals pass for independent of the input; none if either is all zero.
    pub independent: Option<bool>,
}

/// Checks the residuals of every experiment and output: `residuals[experiment][output]` has the samples.
///
/// # Errors
/// [`Error::Mismatch`] if the lists do not fit the data; those of [`check_residual`].
pub fn check_residuals(
    data: &DataSet,
    residuals: &[Vec<Vec<f64>>],
    options: &ResidualOptions,
) -> Result<Vec<ResidualCheck>> {
    if residuals.len() != data.experiments.len() {
        return Err(mismatch(
            "experiments with residuals",
            residuals.len(),
            data.experiments.len(),
        ));
    }
    let mut checks = Vec::new();
    for (experiment, lists) in data.experiments.iter().zip(residuals) {
        if lists.len() != data.outputs.len() {
            return Err(mismatch(
                format!("residuals of {}", experiment.name),
                format!("{} outputs", lists.len()),
                data.outputs.len(),
            ));
        }
        for (output, residual) in data.outputs.iter().zip(lists) {
            let names = (experiment.name.as_str(), output.name.as_str());
            checks.push(check_residual(names, residual, &experiment.input, options)?);
        }
    }
    Ok(checks)
}

/// Checks the residual of one output against the input; the names of experiment and output go into the result.
///
/// # Errors
/// [`Error::Mismatch`] for lists of unequal length, for no lags or a step of 0, and for records that are not longer
/// than the lags; [`Error::NonFinite`]; [`Error::Domain`] for a level outside 0 to 0.5.
pub fn check_residual(
    (experiment, output): (&str, &str),
    residual: &[f64],
    input: &[f64],
    options: &ResidualOptions,
) -> Result<ResidualCheck> {
    check_arguments((experiment, output), residual, input, options)?;
    let n = residual.len() as f64;
    let (covariance_e, covariance_u) = (autocovariance(residual), autocovariance(input));
    let (variance_e, variance_u) = (first(&covariance_e), first(&covariance_u));

    let shifts: Vec<usize> = (0..=options.lags).map(|k| k * options.step).collect();
    let z = normal_quantile(0.5 * options.level);
    let auto_values: Vec<f64> = shifts
        .iter()
        .map(|&k| ratio(covariance_e[k], variance_e))
        .collect();
    let ljung_box: f64 = n
        * (n + 2.0)
        * shifts
            .iter()
            .zip(&auto_values)
            .skip(1)
            .map(|(&k, rho)| rho * rho / (n - k as f64))
            .sum::<f64>();
    let ljung_box_bound = chi_square_quantile(options.lags, options.level);
    let auto = correlation(
        shifts.iter().map(|&k| k as i64).collect(),
        auto_values,
        z / n.sqrt(),
        options.level,
    );

    // Lag 0 once, all others for both signs.
    let common: f64 = covariance_e.iter().zip(&covariance_u).map(|(e, u)| e * u).sum();
    let both = 2.0 * common - variance_e * variance_u;
    // The sum is that of two periodograms multiplied: only rounding makes it negative.
    let deviation = (ratio(both, variance_e * variance_u).max(0.0) / n).sqrt();
    let scale = (variance_e * variance_u).sqrt();
    let lags: Vec<i64> = shifts
        .iter()
        .skip(1)
        .rev()
        .map(|&k| -(k as i64))
        .chain(shifts.iter().map(|&k| k as i64))
        .collect();
    let cross_values: Vec<f64> = lags
        .iter()
        .map(|&k| ratio(cross_covariance(residual, input, k), scale))
        .collect();
    let largest = cross_values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let cross_bound_of_all = deviation * normal_quantile(0.5 * options.level / lags.len() as f64);
    let cross = correlation(lags, cross_values, z * deviation, options.level);

    Ok(ResidualCheck {
        experiment: experiment.to_owned(),
        output: output.to_owned(),
        samples: residual.len(),
        rms: variance_e.sqrt(),
        white: (variance_e > 0.0).then_some(ljung_box <= ljung_box_bound),
        independent: (scale > 0.0).then_some(largest <= cross_bound_of_all),
        auto,
        cross,
        ljung_box,
        ljung_box_bound,
        cross_bound_of_all,
    })
}

fn check_arguments(
    (experiment, output): (&str, &str),
    residual: &[f64],
    input: &[f64],
    options: &ResidualOptions,
) -> Result<()> {
    let n = residual.len();
    if input.len() != n {
        return Err(mismatch(
            format!("residuals of {output} in {experiment}"),
            n,
            format!("{} as the input has", input.len()),
        ));
    }
    if options.lags == 0 || options.step == 0 {
        return Err(mismatch(
            "lags of the check of residuals",
            format!("{} in steps of {}", options.lags, options.step),
            "at least one, in steps of at least one",
        ));
    }
    if options.lags.saturating_mul(options.step) >= n {
        return Err(mismatch(
            format!("samples of {experiment}"),
            n,
            format!(
                "more than {} steps of {} samples: check fewer lags",
                options.lags, options.step
            ),
        ));
    }
    if !(options.level > 0.0 && options.level < 0.5) {
        return Err(Error::Domain {
            what: "the level of the check of residuals",
            value: options.level,
            expected: "a share between 0 and 0.5",
        });
    }
    for (signal, values) in [
        (format!("residual of {output}"), residual),
        ("input".to_owned(), input),
    ] {
        if let Some(sample) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::NonFinite {
                experiment: experiment.to_owned(),
                signal,
                sample,
            });
        }
    }
    Ok(())
}

fn correlation(lags: Vec<i64>, values: Vec<f64>, bound: f64, level: f64) -> Correlation {
    let autocorrelation = lags.first() == Some(&0);
    // At lag 0 an autocorrelation is 1.
    let counted = values.iter().skip(usize::from(autocorrelation));
    Correlation {
        violations: counted.clone().filter(|v| v.abs() > bound).count(),
        expected_violations: level * counted.len() as f64,
        lags,
        values,
        bound,
    }
}

fn first(covariance: &[f64]) -> f64 {
    covariance.first().copied().unwrap_or(0.0)
}

/// Zero over zero is zero: nothing is correlated with a signal that is not there.
fn ratio(value: f64, scale: f64) -> f64 {
    if scale > 0.0 { value / scale } else { 0.0 }
}

/// `1/N sum_t e(t) u(t - k)`.
fn cross_covariance(e: &[f64], u: &[f64], k: i64) -> f64 {
    let shift = usize::try_from(k.unsigned_abs())
        .unwrap_or(usize::MAX)
        .min(e.len());
    let (e_from, u_from) = if k >= 0 { (shift, 0) } else { (0, shift) };
    let sum: f64 = e[e_from..].iter().zip(&u[u_from..]).map(|(e, u)| e * u).sum();
    sum / e.len() as f64
}

/// The number that a standard normal variable exceeds with probability `tail` (below 0.5): Abramowitz & Stegun 26.2.23,
/// to 4.5e-4.
fn normal_quantile(tail: f64) -> f64 {
    let t = (-2.0 * tail.ln()).sqrt();
    t - (2.515_517 + t * (0.802_853 + t * 0.010_328))
        / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)))
}

/// The number that chi-square exceeds with probability `tail`: E. B. Wilson, M. M. Hilferty, Proc. Natl. Acad. Sci. 17, 1931.
fn chi_square_quantile(degrees: usize, tail: f64) -> f64 {
    let k = degrees as f64;
    let share = 2.0 / (9.0 * k);
    k * (1.0 - share + normal_quantile(tail) * share.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Experiment, Intersample};
    use albatross_lti::Signal;

    fn noise(random: &mut fastrand::Rng, n: usize) -> Vec<f64> {
        // Sum of twelve uniform numbers: mean 0, variance 1, nearly normal.
        (0..n)
            .map(|_| (0..12).map(|_| random.f64()).sum::<f64>() - 6.0)
            .collect()
    }

    /// x(t) = a x(t-1) + e(t), after a start of 200 samples.
    fn coloured(random: &mut fastrand::Rng, n: usize, a: f64) -> Vec<f64> {
        let mut x = 0.0;
        let mut series: Vec<f64> = noise(random, n + 200)
            .iter()
            .map(|e| {
                x = a * x + e;
                x
            })
            .collect();
        series.split_off(200)
    }

    fn check(e: &[f64], u: &[f64]) -> ResidualCheck {
        check_residual(("run", "y"), e, u, &ResidualOptions::default()).unwrap()
    }

    /// Tables of the normal and the chi-square distribution (Abramowitz & Stegun, tables 26.1 and 26.8).
    #[test]
    fn val_quantiles() {
        for (tail, z) in [
            (0.005, 2.575_83),
            (0.01, 2.326_35),
            (0.025, 1.959_96),
            (1e-4, 3.719_02),
        ] {
            assert!((normal_quantile(tail) - z).abs() < 4.5e-4);
        }
        for (degrees, tail, value) in [
            (25, 0.01, 44.3141),
            (25, 0.05, 37.6525),
            (10, 0.01, 23.2093),
            (100, 0.01, 135.807),
        ] {
            assert!((chi_square_quantile(degrees, tail) / value - 1.0).abs() < 2e-3);
        }
    }

    /// By hand: e = 1 -1 1 -1, u = 1 0 0 0.
    #[test]
    fn val_small_series() {
        let options = ResidualOptions {
            lags: 2,
            ..ResidualOptions::default()
        };
        let (e, u) = ([1.0, -1.0, 1.0, -1.0], [1.0, 0.0, 0.0, 0.0]);
        let c = check_residual(("run", "y"), &e, &u, &options).unwrap();
        let close =
            |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
        assert!(close(&c.auto.values, &[1.0, -0.75, 0.5]), "{c:?}");
        // r_e(0) = 1, r_u(0) = 1/4, r_eu(k) = e(k)/4 for k >= 0.
        assert_eq!(c.cross.lags, [-2, -1, 0, 1, 2]);
        assert!(close(&c.cross.values, &[0.0, 0.0, 0.5, -0.5, 0.5]), "{c:?}");
        // Q = 4 * 6 * (0.5625/3 + 0.25/2) = 7.5.
        assert!((c.ljung_box - 7.5).abs() < 1e-12);
        assert!((c.rms - 1.0).abs() < 1e-14);
    }

    /// White residuals, white input: bounds of 2.576/sqrt(N), left by 1 % of the lags (0.94 and 0.92 % here); the verdicts
    /// reject about 1 % and, by Bonferroni, less (1.3 and 0.5 %).
    #[test]
    fn val_white_noise_violates_one_percent() {
        let mut random = fastrand::Rng::with_seed(1);
        let (runs, n) = (1000, 1000);
        let (mut auto, mut cross, mut not_white, mut dependent) = (0, 0, 0, 0);
        for _ in 0..runs {
            let c = check(&noise(&mut random, n), &noise(&mut random, n));
            assert!((c.auto.bound * (n as f64).sqrt() - 2.576).abs() < 1e-3);
            assert!((c.cross.bound / c.auto.bound - 1.0).abs() < 0.2);
            auto += c.auto.violations;
            cross += c.cross.violations;
            not_white += usize::from(c.white == Some(false));
            dependent += usize::from(c.independent == Some(false));
        }
        let share = |count: usize, of: usize| count as f64 / (of * runs) as f64;
        assert!((0.007..0.013).contains(&share(auto, 25)));
        assert!((0.007..0.013).contains(&share(cross, 51)));
        assert!((0.002..0.025).contains(&share(not_white, 1)));
        assert!(share(dependent, 1) < 0.02);
    }

    /// Coloured residuals independent of a coloured input: never white; the bound with P is left by 0.5 %, 2.576/sqrt(N)
    /// would be by 47 %.
    #[test]
    fn val_coloured_noise_is_not_white_but_independent() {
        let mut random = fastrand::Rng::with_seed(2);
        let (runs, n) = (500, 2000);
        let (mut cross, mut naive, mut dependent) = (0, 0, 0);
        for _ in 0..runs {
            let c = check(&coloured(&mut random, n, 0.9), &coloured(&mut random, n, 0.95));
            assert_eq!(c.white, Some(false));
            assert!(c.auto.violations > 10);
            cross += c.cross.violations;
            naive += c.cross.values.iter().filter(|v| v.abs() > c.auto.bound).count();
            dependent += usize::from(c.independent == Some(false));
        }
        let all = (51 * runs) as f64;
        assert!((0.004..0.025).contains(&(cross as f64 / all)));
        assert!(naive as f64 / all > 0.2);
        assert!(dependent <= runs / 50);
    }

    /// White noise under a doublet, the input of flight tests: few independent frequencies, 0.93 % of violations.
    #[test]
    fn val_doublet_and_noise() {
        let mut random = fastrand::Rng::with_seed(3);
        let (runs, n) = (300, 1500);
        let u: Vec<f64> = (0..n).map(doublet).collect();
        let (mut cross, mut dependent) = (0, 0);
        for _ in 0..runs {
            let c = check(&noise(&mut random, n), &u);
            cross += c.cross.violations;
            dependent += usize::from(c.independent == Some(false));
        }
        let share = cross as f64 / (51 * runs) as f64;
        assert!(share < 0.03 && dependent <= runs / 50);
    }

    fn doublet(i: usize) -> f64 {
        match i {
            100..200 => 1.0,
            200..300 => -1.0,
            _ => 0.0,
        }
    }

    /// A residual that holds a first-order response to the input, with a binary input at a tenth of the power of the noise:
    /// found in every record, at positive lags.
    #[test]
    fn val_unmodelled_dynamics_are_found() {
        let mut random = fastrand::Rng::with_seed(4);
        let n = 1500;
        let response = |u: &[f64]| {
            let mut x = 0.0;
            u.iter()
                .map(|u| {
                    x = 0.8 * x + 0.2 * u;
                    x
                })
                .collect::<Vec<f64>>()
        };
        let (mut found, mut after, mut before) = (0, 0, 0);
        for _ in 0..100 {
            let u: Vec<f64> = (0..n).map(|_| if random.bool() { 1.0 } else { -1.0 }).collect();
            let e: Vec<f64> = response(&u)
                .iter()
                .zip(noise(&mut random, n))
                .map(|(y, v)| y + v)
                .collect();
            let c = check(&e, &u);
            let outside = |positive: bool| {
                let both = c.cross.lags.iter().zip(&c.cross.values);
                both.filter(|(k, v)| (**k > 0) == positive && v.abs() > c.cross.bound)
                    .count()
            };
            after += outside(true);
            before += outside(false);
            found += usize::from(c.independent == Some(false));
        }
        let mut by_doublet = 0;
        let u: Vec<f64> = (0..n).map(doublet).collect();
        for _ in 0..100 {
            let e: Vec<f64> = response(&u)
                .iter()
                .zip(noise(&mut random, n))
                .map(|(y, v)| y + v)
                .collect();
            by_doublet += usize::from(check(&e, &u).independent == Some(false));
        }
        assert_eq!(found, 100);
        // Four positive lags a record stand out by their expected values; lag 0 does in each.
        assert!(after > 350 && before < 150, "{after} {before}");
        assert!(by_doublet > 90);
    }

    #[test]
    fn val_silence_and_refusals() {
        let u = vec![1.0; 100];
        let c = check(&[0.0; 100], &u);
        assert_eq!((c.white, c.independent, c.rms), (None, None, 0.0));
        assert_eq!(check(&u, &[0.0; 100]).independent, None);
        let refused = |e: &[f64], lags, step, level| {
            check_residual(("run", "y"), e, &u, &ResidualOptions { lags, step, level }).unwrap_err()
        };
        assert!(matches!(refused(&u[..50], 5, 1, 0.01), Error::Mismatch { .. }));
        assert!(matches!(refused(&u, 25, 4, 0.01), Error::Mismatch { .. }));
        assert!(matches!(refused(&u, 0, 1, 0.01), Error::Mismatch { .. }));
        assert!(matches!(refused(&u, 5, 1, 0.7), Error::Domain { .. }));
        let mut broken = u.clone();
        broken[7] = f64::NAN;
        let error = refused(&broken, 5, 1, 0.01);
        assert!(matches!(error, Error::NonFinite { sample: 7, .. }), "{error}");
    }

    #[test]
    fn val_every_experiment_and_output_is_checked() {
        let mut random = fastrand::Rng::with_seed(5);
        let mut series = || noise(&mut random, 200);
        let experiments = vec![
            Experiment::new("a", 0.01, series(), vec![series(), series()]),
            Experiment::new("b", 0.01, series(), vec![series(), series()]),
        ];
        let residuals: Vec<Vec<Vec<f64>>> = experiments.iter().map(|e| e.outputs.clone()).collect();
        let data = DataSet::try_new(
            Signal::new("u", "deg"),
            vec![Signal::new("q", "deg/s"), Signal::new("az", "m/s2")],
            experiments,
            Intersample::Zoh,
        )
        .unwrap();
        let checks = check_residuals(&data, &residuals, &ResidualOptions::default()).unwrap();
        let names: Vec<(&str, &str)> = checks
            .iter()
            .map(|c| (c.experiment.as_str(), c.output.as_str()))
            .collect();
        assert_eq!(names, [("a", "q"), ("a", "az"), ("b", "q"), ("b", "az")]);
        assert!(check_residuals(&data, &residuals[..1], &ResidualOptions::default()).is_err());
        assert!(serde_json::to_string(&checks).unwrap().contains("\"white\":true"));
    }
}
