//! Four-stage instrumental variables: A(q) y = B(q) u + v with coloured v.
//!
//! Equations: THEORY (37).

use crate::arx::{PolynomialFit, Record, check_rows, fit, offsets, records, stack};
use crate::discrete::{Orders, Polynomials};
use crate::triangle::{Regression, Triangle, regress};
use crate::{DataSet, Result};

/// IV4 model of one output, by position, from all experiments together.
///
/// 1. Least squares. 2. Instruments from the simulated output of that model, in place of the measured one. 3. An
///    autoregressive model L(q) of order na + nb of the equation error. 4. Instruments again, from the model of stage
///    2, all signals filtered by L.
///
/// The estimate is consistent whatever the colour of the noise, as long as the input does not depend on it (no
/// feedback). Poles outside the unit circle are reflected before instruments are simulated. The records need not
/// start at rest, since samples whose filter reaches before a record are left out.
///
/// The covariance holds as far as L makes the equation error white. White noise on the output of a lightly damped
/// system makes an error that no short autoregression whitens; the stated variance is then several times too large.
///
/// Source: L. Ljung, System Identification: Theory for the User, 2nd ed., 1999, section 15.3.
///
/// # Errors
/// As [`crate::arx::arx`].
pub fn iv4(data: &DataSet, output: usize, orders: Orders) -> Result<PolynomialFit> {
    let mut records = records(data, output, orders)?;
    let order = orders.unknowns();
    check_rows(data, &records, orders, order)?;

    let first = solve(&records, orders, 0)?.0;
    simulate(&mut records, &first, orders, data.dt())?;
    let second = solve(&records, orders, 0)?.0;

    let whitener = whitening(&records, &second, orders, order)?;
    simulate(&mut records, &second, orders, data.dt())?;
    let filtered: Vec<Record<'_>> = records
        .iter()
        .map(|r| Record {
            u: filter(&whitener, &r.u).into(),
            y: filter(&whitener, &r.y).into(),
            x: filter(&whitener, &r.x),
            offset: r.offset,
        })
        .collect();
    let (mut last, rows) = solve(&filtered, orders, order)?;
    // A constant of the record became L(1) times itself.
    let gain: f64 = whitener.iter().sum();
    for constant in last.theta.iter_mut().skip(orders.unknowns()) {
        *constant /= gain;
    }
    fit(last, orders, data.dt(), rows)
}

fn solve(records: &[Record<'_>], orders: Orders, skip: usize) -> Result<(Regression, usize)> {
    let triangle = stack(records, orders, skip);
    let rows = triangle.rows();
    let unknowns = orders.unknowns() + offsets(records);
    Ok((regress(triangle.finish().as_ref(), unknowns, rows)?, rows))
}

/// Gives every record the output of the model as its instrument.
fn simulate(records: &mut [Record<'_>], from: &Regression, orders: Orders, dt: f64) -> Result<()> {
    let (a, b) = coefficients(&from.theta, orders);
    let model = Polynomials::try_new(a, b, orders.nk, dt)?.stabilised()?;
    for record in records {
        record.x = model.simulate(&record.u);
    }
    Ok(())
}

fn coefficients(theta: &[f64], orders: Orders) -> (Vec<f64>, Vec<f64>) {
    let (a, rest) = theta.split_at(orders.na);
    let a = std::iter::once(1.0).chain(a.iter().copied()).collect();
    (a, rest[..orders.nb].to_vec())
}

/// L(q), monic, that whitens w = A y - B u.
fn whitening(records: &[Record<'_>], from: &Regression, orders: Orders, order: usize) -> Result<Vec<f64>> {
    let (a, b) = coefficients(&from.theta, orders);
    let mut triangle = Triangle::new(order + 1);
    for record in records {
        let constant = record
            .offset
            .and_then(|c| from.theta.get(orders.unknowns() + c))
            .copied()
            .unwrap_or(0.0);
        let w: Vec<f64> = (orders.first()..record.y.len())
            .map(|k| {
                let outputs: f64 = a.iter().enumerate().map(|(i, a)| a * record.y[k - i]).sum();
                let inputs: f64 = (b.iter().enumerate())
                    .map(|(j, b)| b * record.u[k - orders.nk - j])
                    .sum();
                outputs - inputs - constant
            })
            .collect();
        for k in order..w.len() {
            let row: Vec<f64> = (1..=order).map(|i| -w[k - i]).chain([w[k]]).collect();
            triangle.push(&row);
        }
    }
    let rows = triangle.rows();
    let ar = regress(triangle.finish().as_ref(), order, rows)?;
    Ok(std::iter::once(1.0).chain(ar.theta).collect())
}

/// L(q) applied to a signal that is zero before its record.
fn filter(coefficients: &[f64], signal: &[f64]) -> Vec<f64> {
    (0..signal.len())
        .map(|k| {
            coefficients
                .iter()
                .zip(signal[..=k].iter().rev())
                .map(|(c, v)| c * v)
                .sum()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arx::arx;
    use crate::arx::tests::{data_of, gaussian, third_order, worst};

    const ORDERS: Orders = Orders { na: 3, nb: 3, nk: 1 };

    #[test]
    fn val_noise_free_data_give_the_model_back() {
        let mut random = fastrand::Rng::with_seed(11);
        let model = third_order();
        let records = [200, 150]
            .map(|n| gaussian(&mut random, n))
            .map(|u| (u.clone(), model.simulate(&u)));
        let fit = iv4(&data_of(records.to_vec(), 0.05), 0, ORDERS).unwrap();
        assert!(worst(&fit.model, &model) < 1e-10, "{}", worst(&fit.model, &model));
        assert!(!fit.rank_deficient());
    }

    /// Estimates of a1 .. a3 by both methods from two records of 1000 samples with noise from `noise`, over 100 seeds:
    /// bias of least squares, errors and mean stated variance of IV4.
    fn monte_carlo(noise: impl Fn(&[f64]) -> Vec<f64>) -> ([f64; 3], [Vec<f64>; 3], [f64; 3]) {
        let model = third_order();
        let (runs, n) = (100, 1000);
        let mut random = fastrand::Rng::with_seed(12);
        let inputs = [gaussian(&mut random, n), gaussian(&mut random, n)];
        let clean = inputs.clone().map(|u| model.simulate(&u));
        let (mut bias, mut stated) = ([0.0; 3], [0.0; 3]);
        let mut errors: [Vec<f64>; 3] = Default::default();
        for _ in 0..runs {
            let records = (inputs.iter().zip(&clean))
                .map(|(u, y)| {
                    let v = noise(&gaussian(&mut random, n));
                    (u.clone(), y.iter().zip(v).map(|(y, v)| y + v).collect())
                })
                .collect();
            let data = data_of(records, 0.05);
            let (plain, instrumental) = (arx(&data, 0, ORDERS).unwrap(), iv4(&data, 0, ORDERS).unwrap());
            for i in 0..3 {
                bias[i] += (plain.model.a[i + 1] - model.a[i + 1]) / runs as f64;
                errors[i].push(instrumental.model.a[i + 1] - model.a[i + 1]);
                stated[i] += instrumental.covariance[(i, i)] / runs as f64;
            }
        }
        (bias, errors, stated)
    }

    /// Mean and variance.
    fn moments(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (
            mean,
            values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0),
        )
    }

    /// White noise on the output: least squares is biased by many standard errors, IV4 is not.
    #[test]
    fn val_consistent_under_output_noise_where_least_squares_is_not() {
        let (bias, errors, _) = monte_carlo(|e| e.iter().map(|e| 0.15 * e).collect());
        let mut worst = 0.0_f64;
        for i in 0..3 {
            let (mean, variance) = moments(&errors[i]);
            let standard_error = (variance / errors[i].len() as f64).sqrt();
            assert!(mean.abs() < 3.5 * standard_error, "{i}: {mean} {standard_error}");
            worst = worst.max(bias[i].abs() / standard_error);
        }
        assert!(worst > 20.0, "{worst}");
    }

    /// Equation error e/(1 - 0.8 q^-1), which the filter of the last stage whitens: the spread is the stated one.
    #[test]
    fn val_covariance_is_the_spread_over_coloured_noise() {
        let model = third_order();
        let mut a = model.a.clone();
        a.push(0.0);
        for k in (1..a.len()).rev() {
            a[k] -= 0.8 * a[k - 1];
        }
        let path = Polynomials::try_new(a, vec![0.1], 0, 0.05).unwrap();
        let (bias, errors, stated) = monte_carlo(|e| path.simulate(e));
        for i in 0..3 {
            let (mean, variance) = moments(&errors[i]);
            let standard_error = (variance / errors[i].len() as f64).sqrt();
            assert!(mean.abs() < 3.5 * standard_error, "{i}: {mean} {standard_error}");
            assert!(bias[i].abs() > 10.0 * standard_error, "{i}: {}", bias[i]);
            // Standard deviation of a sample variance over 100 runs: 14 %.
            assert!(
                (variance / stated[i] - 1.0).abs() < 0.45,
                "{i}: {variance} {}",
                stated[i]
            );
        }
    }

    #[test]
    fn prop_offsets_are_estimated_with_coloured_noise() {
        let model = third_order();
        let mut random = fastrand::Rng::with_seed(13);
        let u = gaussian(&mut random, 3000);
        let y = (model.simulate(&u).iter().zip(gaussian(&mut random, 3000)))
            .map(|(y, v)| y + 0.7 + 0.02 * v)
            .collect();
        let mut data = data_of(vec![(u, y)], 0.05);
        data.experiments[0].estimate_offset = true;
        let fit = iv4(&data, 0, ORDERS).unwrap();
        assert!(worst(&fit.model, &model) < 0.02, "{}", worst(&fit.model, &model));
        let at_one: f64 = model.a.iter().sum();
        assert!((fit.offsets[0] / at_one - 0.7).abs() < 0.02);
    }
}
