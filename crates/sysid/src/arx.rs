//! ARX models by least squares: A(q) y = B(q) u + e.
//!
//! Consistent only when the equation error e is white; with noise on the output the poles are biased towards more
//! damping, and [`crate::iv4`] is the remedy.
//!
//! Equations: THEORY (37).

use albatross_numerics::{Mat, MatRef};

use crate::discrete::{Orders, Polynomials};
use crate::triangle::{Regression, Triangle, regress};
use crate::{DataSet, Error, Experiment, Result};

/// A discrete-time model with what is needed to judge it.
#[derive(Debug, Clone)]
pub struct PolynomialFit {
    /// The model.
    pub model: Polynomials,
    /// Covariance of \[a1 .. a_na, b0 .. b_(nb-1)\], square; of the rank-deficient estimate where the rank is.
    pub covariance: Mat<f64>,
    /// Variance of the (for IV4: whitened) equation error \[output^2\].
    pub noise_variance: f64,
    /// Norm of the equation error over all rows \[output\].
    pub residual_norm: f64,
    /// Constants on the right-hand side, one for every experiment whose offset is estimated, in their order
    /// \[output\].
    pub offsets: Vec<f64>,
    /// Equations, one a sample except the first of every record.
    pub rows: usize,
    /// Unknowns: coefficients and offsets.
    pub unknowns: usize,
    /// Numerical rank of the regressors: less than `unknowns` when the order exceeds what the data carry.
    pub rank: usize,
    /// Singular values of the regressors, columns scaled to unit norm, descending.
    pub singular_values: Vec<f64>,
}

impl PolynomialFit {
    /// Whether the order exceeds what the data carry; the estimate is then the one of least norm.
    pub fn rank_deficient(&self) -> bool {
        self.rank < self.unknowns
    }
}

/// Least-squares ARX model of one output, by position, from all experiments together.
///
/// Rows phi(k) = \[-y(k-1) .. -y(k-na), u(k-nk) .. u(k-nk-nb+1)\] from k = max(na, nk+nb-1) in every record; no
/// row reaches from one record into the next. Columns are scaled to unit norm and singular values below
/// eps max(rows, unknowns) of the largest are dropped. Covariance s^2 (Phi' Phi)^-1.
///
/// Source: L. Ljung, System Identification: Theory for the User, 2nd ed., 1999, sections 4.2 and 10.1.
///
/// # Errors
/// Those of [`DataSet::check`]; [`Error::Mismatch`] for an output that is not there, [`Error::Domain`] without
/// coefficients of B and for more than 500 of A or B, [`Error::TooFewSamples`], [`Error::Constant`] when the input or
/// the output stands still in every experiment, [`Error::Numerics`].
pub fn arx(data: &DataSet, output: usize, orders: Orders) -> Result<PolynomialFit> {
    let records = records(data, output, orders)?;
    let triangle = stack(&records, orders, 0);
    let rows = triangle.rows();
    let unknowns = orders.unknowns() + offsets(&records);
    let regression = regress(triangle.finish().as_ref(), unknowns, rows)?;
    fit(regression, orders, data.dt(), rows)
}

/// Most coefficients of A and of B: matrices as large as the square of their number are kept.
const MOST_COEFFICIENTS: usize = 500;

/// Signals of one experiment for the regression.
pub(crate) struct Record<'a> {
    pub(crate) u: std::borrow::Cow<'a, [f64]>,
    pub(crate) y: std::borrow::Cow<'a, [f64]>,
    /// Output of a model, to take the place of y among the instruments; empty without instruments.
    pub(crate) x: Vec<f64>,
    /// Column of the constant, counted from the first of them.
    pub(crate) offset: Option<usize>,
}

/// The records, after the checks that every discrete-time method needs.
pub(crate) fn records<'a>(data: &'a DataSet, output: usize, orders: Orders) -> Result<Vec<Record<'a>>> {
    data.check()?;
    let signal = data.outputs.get(output).ok_or_else(|| {
        crate::data::mismatch(
            "position of the output",
            output,
            format!("less than {}", data.outputs.len()),
        )
    })?;
    if orders.nb == 0 {
        return Err(Error::Domain {
            what: "the number of coefficients of B",
            value: 0.0,
            expected: "at least 1",
        });
    }
    let output_of = |e: &'a Experiment| e.outputs.get(output).map_or(&[][..], Vec::as_slice);
    let still = |name: &str| Error::Constant {
        experiment: data.names(),
        signal: name.to_owned(),
        samples: data.samples(),
    };
    if data.experiments.iter().all(|e| constant(&e.input)) {
        return Err(still(&data.input.name));
    }
    if data.experiments.iter().all(|e| constant(output_of(e))) {
        return Err(still(&signal.name));
    }

    let mut constants = 0..;
    let records: Vec<Record<'a>> = data
        .experiments
        .iter()
        .map(|e| Record {
            u: (&e.input).into(),
            y: output_of(e).into(),
            x: Vec::new(),
            offset: if e.estimate_offset { constants.next() } else { None },
        })
        .collect();
    check_rows(data, &records, orders, 0)?;
    for (what, count) in [
        ("the number of coefficients of A", orders.na),
        ("the number of coefficients of B", orders.nb),
    ] {
        if count > MOST_COEFFICIENTS {
            return Err(Error::Domain {
                what,
                value: count as f64,
                expected: "at most 500",
            });
        }
    }
    Ok(records)
}

/// Refuses fewer rows than unknowns and one, after leaving out `skip` samples of every record.
pub(crate) fn check_rows(data: &DataSet, records: &[Record<'_>], orders: Orders, skip: usize) -> Result<()> {
    let unknowns = orders.unknowns().saturating_add(offsets(records));
    let lost = orders.first().saturating_add(skip);
    let rows: usize = records.iter().map(|r| r.y.len().saturating_sub(lost)).sum();
    if rows > unknowns {
        return Ok(());
    }
    Err(Error::TooFewSamples {
        poles: orders.na,
        zeros: orders.nb.saturating_sub(1),
        unknowns,
        experiments: data.names(),
        samples: data.samples(),
        needed: (data.samples() - rows).saturating_add(unknowns).saturating_add(1),
    })
}

fn constant(values: &[f64]) -> bool {
    values.iter().all(|v| Some(v) == values.first())
}

/// Number of constants to estimate.
pub(crate) fn offsets(records: &[Record<'_>]) -> usize {
    records.iter().filter(|r| r.offset.is_some()).count()
}

/// Triangle of the columns [instruments, regressors, output]; the instruments only where the records have them.
/// The first `skip` samples of every record are left out.
pub(crate) fn stack(records: &[Record<'_>], orders: Orders, skip: usize) -> Triangle {
    let n = orders.unknowns() + offsets(records);
    let with_instruments = records.iter().any(|r| !r.x.is_empty());
    let width = if with_instruments { 2 * n } else { n };
    let mut triangle = Triangle::new(width + 1);
    let mut row = vec![0.0; width + 1];
    for record in records {
        for k in orders.first() + skip..record.y.len() {
            if with_instruments {
                regressors(&record.x, record, orders, k, &mut row[..n]);
            }
            regressors(&record.y, record, orders, k, &mut row[width - n..width]);
            row[width] = record.y[k];
            triangle.push(&row);
        }
    }
    triangle
}

/// [-y(k-1) .., u(k-nk) .., constants] with y the output or what takes its place.
fn regressors(y: &[f64], record: &Record<'_>, orders: Orders, k: usize, row: &mut [f64]) {
    let (outputs, rest) = row.split_at_mut(orders.na);
    let (inputs, constants) = rest.split_at_mut(orders.nb);
    for (i, value) in outputs.iter_mut().enumerate() {
        *value = -y[k - 1 - i];
    }
    for (j, value) in inputs.iter_mut().enumerate() {
        *value = record.u[k - orders.nk - j];
    }
    for (c, value) in constants.iter_mut().enumerate() {
        *value = f64::from(u8::from(record.offset == Some(c)));
    }
}

/// The model of a solved regression.
pub(crate) fn fit(regression: Regression, orders: Orders, dt: f64, rows: usize) -> Result<PolynomialFit> {
    let Regression {
        theta,
        covariance,
        rank,
        singular_values,
        residual_norm,
    } = regression;
    let n = orders.unknowns();
    let a = std::iter::once(1.0).chain(theta[..orders.na].iter().copied());
    let model = Polynomials::try_new(a.collect(), theta[orders.na..n].to_vec(), orders.nk, dt)?;
    let noise_variance = residual_norm * residual_norm / rows.saturating_sub(rank).max(1) as f64;
    let unit: MatRef<'_, f64> = covariance.as_ref();
    Ok(PolynomialFit {
        model,
        covariance: Mat::from_fn(n, n, |i, j| noise_variance * unit[(i, j)]),
        noise_variance,
        residual_norm,
        offsets: theta[n..].to_vec(),
        rows,
        unknowns: theta.len(),
        rank,
        singular_values,
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use albatross_lti::Signal;
    use albatross_numerics::solve::least_squares;

    use super::*;
    use crate::Intersample;

    /// Normal deviates by Box and Muller.
    pub(crate) fn gaussian(random: &mut fastrand::Rng, n: usize) -> Vec<f64> {
        (0..n)
            .map(|_| {
                let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
                radius * (std::f64::consts::TAU * random.f64()).cos()
            })
            .collect()
    }

    pub(crate) fn data_of(records: Vec<(Vec<f64>, Vec<f64>)>, dt: f64) -> DataSet {
        let experiments = records
            .into_iter()
            .enumerate()
            .map(|(i, (u, y))| Experiment::new(format!("record {i}"), dt, u, vec![y]))
            .collect();
        let signal = |name| Signal::new(name, "1");
        DataSet::try_new(signal("u"), vec![signal("y")], experiments, Intersample::Zoh).unwrap()
    }

    /// Poles 0.85 +- 0.42i and 0.6.
    pub(crate) fn third_order() -> Polynomials {
        let a = from_poles();
        Polynomials::try_new(a, vec![0.4, -0.1, 0.05], 1, 0.05).unwrap()
    }

    fn from_poles() -> Vec<f64> {
        use albatross_numerics::C64;
        let poles = [C64::new(0.85, 0.42), C64::new(0.85, -0.42), C64::new(0.6, 0.0)];
        albatross_lti::polynomial::from_roots(&poles).unwrap()
    }

    const ORDERS: Orders = Orders { na: 3, nb: 3, nk: 1 };

    pub(crate) fn worst(found: &Polynomials, exact: &Polynomials) -> f64 {
        let differences = |p: &[f64], q: &[f64]| {
            assert_eq!(p.len(), q.len());
            p.iter().zip(q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
        };
        differences(&found.a, &exact.a).max(differences(&found.b, &exact.b))
    }

    #[test]
    fn val_noise_free_data_give_the_model_back() {
        let mut random = fastrand::Rng::with_seed(1);
        let model = third_order();
        let records = [200, 150]
            .map(|n| gaussian(&mut random, n))
            .map(|u| (u.clone(), model.simulate(&u)));
        let fit = arx(&data_of(records.to_vec(), 0.05), 0, ORDERS).unwrap();
        assert!(worst(&fit.model, &model) < 1e-12, "{}", worst(&fit.model, &model));
        assert!((fit.rank, fit.rows) == (6, 344) && !fit.rank_deficient());
        assert!(fit.residual_norm < 1e-12);
    }

    /// The same least squares with rows stacked by hand.
    #[test]
    fn val_several_records_equal_the_stacked_least_squares() {
        let mut random = fastrand::Rng::with_seed(2);
        let records: Vec<_> = [40, 25, 31]
            .iter()
            .map(|&n| (gaussian(&mut random, n), gaussian(&mut random, n)))
            .collect();
        let orders = Orders { na: 2, nb: 2, nk: 3 };
        let mut rows = Vec::new();
        for (u, y) in &records {
            for k in 4..y.len() {
                rows.push([-y[k - 1], -y[k - 2], u[k - 3], u[k - 4], y[k]]);
            }
        }
        let phi = Mat::from_fn(rows.len(), 4, |i, j| rows[i][j]);
        let y = Mat::from_fn(rows.len(), 1, |i, _| rows[i][4]);
        let exact = least_squares(phi.as_ref(), y.as_ref()).unwrap();
        let found = arx(&data_of(records, 1.0), 0, orders).unwrap();
        let theta: Vec<f64> = found.model.a[1..].iter().chain(&found.model.b).copied().collect();
        for (i, value) in theta.iter().enumerate() {
            assert!((value - exact[(i, 0)]).abs() < 1e-13);
        }
        let residual = (phi * &exact - y).norm_l2();
        assert!((found.residual_norm - residual).abs() < 1e-12 * residual);
        assert_eq!((found.rows, found.unknowns), (96 - 12, 4));
    }

    #[test]
    fn val_offsets_of_records_are_estimated() {
        let mut random = fastrand::Rng::with_seed(3);
        let model = third_order();
        let shift = [2.0, -0.5];
        let records = shift.map(|c| {
            let u = gaussian(&mut random, 120);
            let y = model.simulate(&u).iter().map(|y| y + c).collect();
            (u, y)
        });
        let mut data = data_of(records.to_vec(), 0.05);
        assert!(worst(&arx(&data, 0, ORDERS).unwrap().model, &model) > 1e-2);
        data.experiments.iter_mut().for_each(|e| e.estimate_offset = true);
        let fit = arx(&data, 0, ORDERS).unwrap();
        assert!(worst(&fit.model, &model) < 1e-11);
        // A(1) c stands on the right-hand side.
        let at_one: f64 = model.a.iter().sum();
        for (found, c) in fit.offsets.iter().zip(shift) {
            assert!((found - at_one * c).abs() < 1e-11);
        }
        assert_eq!(fit.covariance.nrows(), 6);
    }

    #[test]
    fn prop_order_beyond_the_data_is_flagged_and_still_reproduces_them() {
        let mut random = fastrand::Rng::with_seed(4);
        let model = third_order();
        let u = gaussian(&mut random, 300);
        let y = model.simulate(&u);
        let data = data_of(vec![(u.clone(), y)], 0.05);
        let fit = arx(&data, 0, Orders { na: 6, nb: 6, nk: 1 }).unwrap();
        // Three common factors of A and B are free.
        assert!(fit.rank_deficient() && fit.rank == 9, "{:?}", fit.singular_values);
        assert!(fit.residual_norm < 1e-10);
        let omega = [0.5, 5.0, 20.0];
        let (found, exact) = (
            fit.model.frequency_response(&omega),
            model.frequency_response(&omega),
        );
        assert!(
            found
                .iter()
                .zip(&exact)
                .all(|(f, e)| (f - e).norm() < 1e-8 * e.norm())
        );
    }

    /// White equation error: unbiased, and spread as the covariance says.
    #[test]
    fn val_covariance_is_the_spread_over_noise() {
        let model = third_order();
        let (runs, n, sigma) = (400, 400, 0.1);
        let mut random = fastrand::Rng::with_seed(5);
        let u = gaussian(&mut random, n);
        let noise_path = Polynomials::try_new(model.a.clone(), vec![1.0], 0, 0.05).unwrap();
        let clean = model.simulate(&u);
        let (mut sum, mut squares, mut predicted, mut variance) = ([0.0; 6], [0.0; 6], [0.0; 6], 0.0);
        for _ in 0..runs {
            let e: Vec<f64> = gaussian(&mut random, n).iter().map(|e| sigma * e).collect();
            let y = clean
                .iter()
                .zip(noise_path.simulate(&e))
                .map(|(y, v)| y + v)
                .collect();
            let fit = arx(&data_of(vec![(u.clone(), y)], 0.05), 0, ORDERS).unwrap();
            let theta = fit.model.a[1..].iter().chain(&fit.model.b);
            for (i, (found, exact)) in theta.zip(model.a[1..].iter().chain(&model.b)).enumerate() {
                sum[i] += (found - exact) / runs as f64;
                squares[i] += (found - exact).powi(2) / runs as f64;
                predicted[i] += fit.covariance[(i, i)] / runs as f64;
            }
            variance += fit.noise_variance / runs as f64;
        }
        assert!((variance / (sigma * sigma) - 1.0).abs() < 0.02, "{variance}");
        for i in 0..6 {
            // Standard deviation of a sample variance: sqrt(2/runs) = 7 %.
            assert!((squares[i] / predicted[i] - 1.0).abs() < 0.28, "{i}");
            // Bias of order 1/n beside the standard error of the mean.
            assert!(sum[i].abs() < 0.3 * predicted[i].sqrt(), "{i}");
        }
    }

    #[test]
    fn val_unusable_data_are_refused() {
        let flat = data_of(vec![(vec![1.0; 50], (0..50).map(f64::from).collect())], 1.0);
        assert!(matches!(arx(&flat, 0, ORDERS), Err(Error::Constant { signal, .. }) if signal == "u"));
        let dead = data_of(vec![((0..50).map(f64::from).collect(), vec![0.0; 50])], 1.0);
        assert!(matches!(arx(&dead, 0, ORDERS), Err(Error::Constant { signal, .. }) if signal == "y"));
        let ramp: Vec<f64> = (0..9).map(f64::from).collect();
        let short = data_of(vec![(ramp.clone(), ramp)], 1.0);
        assert!(matches!(
            arx(&short, 0, ORDERS),
            Err(Error::TooFewSamples {
                samples: 9,
                needed: 10,
                unknowns: 6,
                ..
            })
        ));
        assert!(matches!(arx(&short, 1, ORDERS), Err(Error::Mismatch { .. })));
        assert!(matches!(
            arx(&short, 0, Orders { nb: 0, ..ORDERS }),
            Err(Error::Domain { .. })
        ));
    }
}
