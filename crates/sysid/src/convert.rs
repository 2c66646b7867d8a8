//! Models from continuous to discrete time and back.

use std::f64::consts::PI;

use albatross_lti::exponential::exponential;
use albatross_lti::simulation::discretise;
use albatross_lti::{Hold, Signal, StateSpace};
use albatross_numerics::faer::linalg::solvers::Qr;
use albatross_numerics::{C64, Mat, MatRef, eigen, solve};

use crate::discrete::Polynomials;
use crate::logarithm::logarithm;
use crate::{Error, Intersample, Result};

/// A discrete-time system: x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k).
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Its matrices and names.
    pub system: StateSpace,
    /// Sample time \[s\].
    pub dt: f64,
}

/// What becomes of a discrete pole on the negative real axis, which no single continuous pole gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NegativePoles {
    /// It is set aside, or the conversion refused.
    #[default]
    Reject,
    /// It becomes a complex pair at the Nyquist frequency, (ln|z| +- i pi)/dt, which raises the order by one.
    Double,
}

/// Poles in the s plane.
#[derive(Debug, Clone, PartialEq)]
pub struct ContinuousPoles {
    /// ln(z)/dt of every discrete pole that has it \[rad/s\], in the order given.
    pub poles: Vec<C64>,
    /// Discrete poles left out: at zero always, on the negative real axis unless doubled.
    pub rejected: Vec<C64>,
}

/// Continuous poles ln(z)/dt of discrete ones.
///
/// The principal logarithm is taken: dynamics above the Nyquist frequency pi/dt appear folded below it.
///
/// # Errors
/// [`Error::Domain`] for a sample time that is not positive or a pole that is not finite.
pub fn continuous_poles(discrete: &[C64], dt: f64, negative: NegativePoles) -> Result<ContinuousPoles> {
    check_step(dt)?;
    if discrete.iter().any(|z| !z.is_finite()) {
        return Err(Error::Domain {
            what: "a discrete pole",
            value: f64::NAN,
            expected: "a finite number",
        });
    }
    let (mut poles, mut rejected) = (Vec::new(), Vec::new());
    for &z in discrete {
        if z.norm() == 0.0 || (is_negative(z) && negative == NegativePoles::Reject) {
            rejected.push(z);
        } else if is_negative(z) {
            let s = C64::new(z.norm().ln() / dt, PI / dt);
            poles.extend([s.conj(), s]);
        } else {
            poles.push(z.ln() / dt);
        }
    }
    Ok(ContinuousPoles { poles, rejected })
}

/// The model sampled every `dt` (s) for an input that follows `hold`.
///
/// For [`Intersample::Foh`] the step uses u(k+1) too: with x = w + G1 u the system takes the usual form in w,
/// whose feed-through is D + C G1 (the triangle-hold equivalent of G. F. Franklin, J. D. Powell, M. Workman,
/// Digital Control of Dynamic Systems, 3rd ed., 1998, sec. 6.3.2). The states are then those of w.
///
/// # Errors
/// [`Error::Lti`] for a step that is not positive or an exponential that overflows.
pub fn c2d(system: &StateSpace, dt: f64, hold: Intersample) -> Result<Sampled> {
    let step = discretise(system, dt, hold.into())?;
    let b = &step.gamma0 + &step.phi * &step.gamma1;
    let d = &system.d + &system.c * &step.gamma1;
    Ok(Sampled {
        system: StateSpace {
            a: step.phi,
            b,
            c: system.c.clone(),
            d,
            ..system.clone()
        },
        dt,
    })
}

/// The continuous model whose samples a discrete one gives, for an input that follows `hold`.
///
/// A = ln(Ad)/dt is the principal logarithm. With P1 = integral of exp(A s) over a step, the input matrix is
/// P1^-1 Bd behind a zero-order hold and dt P1^-2 Bd behind a first-order hold, where also the feed-through
/// C P2 B of the hold is taken off. Integrators and multiple poles are allowed; discrete poles at zero (delays)
/// are not, and simple ones on the negative real axis only with [`NegativePoles::Double`], which appends a state
/// "doubled k" for each.
///
/// # Errors
/// [`Error::NoLogarithm`] for poles at zero, negative ones that are not to be doubled or are multiple;
/// [`Error::Conversion`] when exp(A dt) does not give Ad back to 1e-8; [`Error::Domain`] for the sample time;
/// [`Error::Numerics`], [`Error::Lti`].
pub fn d2c(sampled: &Sampled, hold: Intersample, negative: NegativePoles) -> Result<StateSpace> {
    let Sampled { system, dt } = sampled;
    check_step(*dt)?;
    system.check()?;
    let (log, negative_poles) = match negative {
        NegativePoles::Reject => (logarithm(system.a.as_ref())?, Vec::new()),
        NegativePoles::Double => doubled_logarithm(system.a.as_ref())?,
    };
    let (n, extra) = (system.a.nrows(), negative_poles.len());
    let order = n + extra;
    let target = Mat::from_fn(order, order, |i, j| match (i < n, j < n) {
        (true, true) => system.a[(i, j)],
        (false, false) if i == j => negative_poles[i - n],
        _ => 0.0,
    });
    let error = (exponential(log.as_ref())? - &target).norm_max();
    if error > 1e-8 * target.norm_max() {
        return Err(Error::Conversion { error });
    }

    let a = Mat::from_fn(order, order, |i, j| log[(i, j)] / dt);
    let bd = Mat::from_fn(order, system.b.ncols(), |i, j| {
        if i < n { system.b[(i, j)] } else { 0.0 }
    });
    let c = Mat::from_fn(system.c.nrows(), order, |i, j| {
        if j < n { system.c[(i, j)] } else { 0.0 }
    });
    // The holds of the states themselves: P1 and P2.
    let probe = StateSpace::unnamed(
        a.clone(),
        Mat::identity(order, order),
        c.clone(),
        Mat::zeros(c.nrows(), order),
    )?;
    let step = discretise(&probe, *dt, Hold::First)?;
    let lu = solve::Lu::new((&step.gamma0 + &step.gamma1).as_ref())?;
    let mut b = lu.solve(bd.as_ref())?;
    let mut d = system.d.clone();
    if hold == Intersample::Foh {
        let once = lu.solve(b.as_ref())?;
        b = Mat::from_fn(order, once.ncols(), |i, j| dt * once[(i, j)]);
        d -= &c * &step.gamma1 * &b;
    }
    let doubled = (1..=extra).map(|k| Signal::new(format!("doubled {k}"), "1"));
    let states = system.states.iter().cloned().chain(doubled).collect();
    Ok(StateSpace::try_new(
        (a, b, c, d),
        states,
        system.inputs.clone(),
        system.outputs.clone(),
    )?)
}

/// State space of a discrete-time model, in observer form. Delays beyond the order become poles at zero.
///
/// # Errors
/// [`Error::Domain`] for a delay of more than 5000 samples, [`Error::Lti`] for coefficients that are not finite.
pub fn realise(model: &Polynomials) -> Result<Sampled> {
    // Every sample of the delay is a state, and the state matrix is full.
    const LONGEST: usize = 5000;
    if model.nk > LONGEST {
        return Err(Error::Domain {
            what: "the delay [samples]",
            value: model.nk as f64,
            expected: "at most 5000",
        });
    }
    let n = model.orders().first();
    let a = |k: usize| model.a.get(k).copied().unwrap_or(0.0);
    let b = |k: usize| {
        let index = k.checked_sub(model.nk);
        index.and_then(|i| model.b.get(i)).copied().unwrap_or(0.0)
    };
    let system = StateSpace::unnamed(
        Mat::from_fn(n, n, |i, j| {
            let shift = f64::from(u8::from(j == i + 1));
            if j == 0 { shift - a(i + 1) } else { shift }
        }),
        Mat::from_fn(n, 1, |i, _| b(i + 1) - a(i + 1) * b(0)),
        Mat::from_fn(1, n, |_, j| f64::from(u8::from(j == 0))),
        Mat::from_fn(1, 1, |_, _| b(0)),
    )?;
    Ok(Sampled { system, dt: model.dt })
}

/// Logarithm of A enlarged by a copy of every negative pole, so that a real one exists, and these poles.
///
/// The poles are split off first: with left vectors W and right vectors V, the columns [V, null space of W']
/// make A block diagonal. The pole z and its copy are exp of the block (ln|z|, pi; -pi, ln|z|).
fn doubled_logarithm(a: MatRef<'_, f64>) -> Result<(Mat<f64>, Vec<f64>)> {
    let vectors = eigen::eigen_both(a)?;
    let at: Vec<usize> = (0..a.nrows())
        .filter(|&k| is_negative(vectors.values[k]) && vectors.values[k].re < 0.0)
        .collect();
    let poles: Vec<f64> = at.iter().map(|&k| vectors.values[k].re).collect();
    let (n, q) = (a.nrows(), poles.len());
    if q == 0 {
        return Ok((logarithm(a)?, poles));
    }
    if let Some(pair) = poles
        .windows(2)
        .find(|p| (p[0] - p[1]).abs() <= 1e-6 * p[1].abs())
    {
        return Err(Error::NoLogarithm { pole: pair[1] });
    }
    let left = Mat::from_fn(n, q, |i, k| vectors.left[(i, at[k])].re);
    let complement = Qr::new(left.as_ref()).compute_Q();
    let basis = Mat::from_fn(n, n, |i, j| match at.get(j) {
        Some(&k) => vectors.right[(i, k)].re,
        None => complement[(i, j)],
    });
    let blocks = solve::solve(basis.as_ref(), (a * &basis).as_ref())?;
    let rest = logarithm(blocks.submatrix(q, q, n - q, n - q))?;
    // Positions: the poles, the rest, the copies of the poles.
    let pole = |k: usize| if k < q { Some(k) } else { k.checked_sub(n) };
    let log = Mat::from_fn(n + q, n + q, |i, j| match (pole(i), pole(j)) {
        (Some(p), Some(_)) if i == j => poles[p].abs().ln(),
        (Some(p), Some(r)) if p == r && i < j => PI,
        (Some(p), Some(r)) if p == r => -PI,
        (None, None) => rest[(i - q, j - q)],
        _ => 0.0,
    });
    let enlarged = Mat::from_fn(n + q, n + q, |i, j| {
        if i < n && j < n {
            basis[(i, j)]
        } else {
            f64::from(u8::from(i == j))
        }
    });
    // enlarged log enlarged^-1, from the transposed system.
    let product = &enlarged * &log;
    let transposed = solve::solve(enlarged.transpose(), product.transpose())?;
    Ok((transposed.transpose().to_owned(), poles))
}

fn is_negative(z: C64) -> bool {
    z.re < 0.0 && z.im.abs() <= f64::EPSILON * z.norm()
}

fn check_step(dt: f64) -> Result<()> {
    if dt > 0.0 && dt.is_finite() {
        return Ok(());
    }
    Err(Error::Domain {
        what: "the sample time [s]",
        value: dt,
        expected: "a positive number",
    })
}

#[cfg(test)]
mod tests {
    use albatross_lti::{TransferFunction, Zpk, simulate};

    use super::*;
    use crate::discrete::Orders;

    const BOTH: [Intersample; 2] = [Intersample::Zoh, Intersample::Foh];

    fn mat(rows: &[&[f64]]) -> Mat<f64> {
        Mat::from_fn(rows.len(), rows.first().map_or(0, |r| r.len()), |i, j| rows[i][j])
    }

    /// 3rd order: pair at 3 rad/s, pole at -0.5, feed-through.
    fn third_order() -> StateSpace {
        StateSpace::unnamed(
            mat(&[&[0.0, 1.0, 0.0], &[-9.0, -0.6, 1.0], &[0.0, 0.0, -0.5]]),
            mat(&[&[0.0, 0.3], &[1.0, 0.0], &[2.0, -1.0]]),
            mat(&[&[1.0, 0.0, 0.5]]),
            mat(&[&[0.2, 0.0]]),
        )
        .unwrap()
    }

    fn worst(p: &StateSpace, q: &StateSpace) -> f64 {
        [(&p.a, &q.a), (&p.b, &q.b), (&p.c, &q.c), (&p.d, &q.d)]
            .map(|(p, q)| (p - q).norm_max())
            .into_iter()
            .fold(0.0, f64::max)
    }

    #[test]
    fn prop_there_and_back_gives_the_same_matrices() {
        // Double integrator, double pole, both with a chain of order two; a pair near the Nyquist frequency.
        let chain = |p: f64| {
            StateSpace::unnamed(
                mat(&[&[p, 1.0, 0.0], &[0.0, p, 0.0], &[0.4, 0.0, -3.0]]),
                mat(&[&[0.0], &[1.0], &[0.5]]),
                mat(&[&[1.0, 0.0, 1.0], &[0.0, 0.2, 0.0]]),
                mat(&[&[0.0], &[1.0]]),
            )
            .unwrap()
        };
        for (system, dt) in [
            (third_order(), 0.1),
            (third_order(), 0.001),
            (third_order(), 1.0),
            (chain(0.0), 0.1),
            (chain(-2.0), 0.1),
        ] {
            for hold in BOTH {
                let sampled = c2d(&system, dt, hold).unwrap();
                for negative in [NegativePoles::Reject, NegativePoles::Double] {
                    let back = d2c(&sampled, hold, negative).unwrap();
                    let error = worst(&back, &system);
                    assert!(error < 1e-10, "{dt} {hold:?} {error}");
                }
            }
        }
    }

    /// The sampled system has the same output at the samples as the continuous one.
    #[test]
    fn val_samples_agree_with_the_exact_simulation() {
        let system = third_order();
        let input: Vec<Vec<f64>> = (0..60)
            .map(|k| vec![(0.3 * k as f64).sin(), f64::from(k % 7)])
            .collect();
        for hold in BOTH {
            let exact = simulate(&system, 0.1, &input, None, hold.into()).unwrap().outputs;
            let sampled = c2d(&system, 0.1, hold).unwrap().system;
            // x = w + G1 u at rest: w(0) = - G1 u(0).
            let g1 = discretise(&system, 0.1, hold.into()).unwrap().gamma1;
            let column = |u: &[f64]| Mat::from_fn(2, 1, |i, _| u[i]);
            let mut w = -(&g1 * column(&input[0]));
            for (k, u) in input.iter().enumerate() {
                let y = &sampled.c * &w + &sampled.d * column(u);
                assert!((y[(0, 0)] - exact.row(k)[0]).abs() < 1e-12, "{k}");
                w = &sampled.a * &w + &sampled.b * column(u);
            }
        }
    }

    /// Lag 1/(s+1): zoh (1-z)/(q-z); foh gain from Franklin, Powell and Workman.
    #[test]
    fn val_first_order_lag_in_closed_form() {
        let lag =
            StateSpace::unnamed(mat(&[&[-1.0]]), mat(&[&[1.0]]), mat(&[&[1.0]]), mat(&[&[0.0]])).unwrap();
        let (h, z) = (0.5, (-0.5_f64).exp());
        let zoh = c2d(&lag, h, Intersample::Zoh).unwrap().system;
        assert!((zoh.a[(0, 0)] - z).abs() < 1e-15 && (zoh.b[(0, 0)] - (1.0 - z)).abs() < 1e-15);
        let foh = c2d(&lag, h, Intersample::Foh).unwrap().system;
        // ((h - 1 + z) q + 1 - z - h z)/(h (q - z)): its feed-through and its gain at q = 1.
        assert!((foh.d[(0, 0)] - (h - 1.0 + z) / h).abs() < 1e-14);
        let gain = foh.c[(0, 0)] * foh.b[(0, 0)] / (1.0 - z) + foh.d[(0, 0)];
        assert!((gain - 1.0).abs() < 1e-14);
    }

    #[test]
    fn val_poles_of_a_polynomial_model_are_those_of_the_continuous_system() {
        let poles = vec![C64::new(-0.3, 2.0), C64::new(-0.3, -2.0), C64::new(-1.0, 0.0)];
        let exact = Zpk::try_new(vec![C64::new(-0.7, 0.0)], poles.clone(), 4.0).unwrap();
        let system = exact
            .to_state_space(Signal::new("u", "1"), Signal::new("y", "1"))
            .unwrap();
        let sampled = c2d(&system, 0.1, Intersample::Zoh).unwrap();
        let discrete = Zpk::from_state_space(&sampled.system).unwrap();
        let TransferFunction {
            numerator,
            denominator,
        } = discrete.to_transfer_function().unwrap();
        let model = Polynomials::try_new(denominator, numerator, 1, 0.1).unwrap();
        assert_eq!(model.orders(), Orders { na: 3, nb: 3, nk: 1 });
        let found = continuous_poles(&model.poles().unwrap(), 0.1, NegativePoles::Reject).unwrap();
        assert!(found.rejected.is_empty());
        for p in &poles {
            assert!(found.poles.iter().any(|f| (f - p).norm() < 1e-9), "{p} {found:?}");
        }
        let back = d2c(&realise(&model).unwrap(), Intersample::Zoh, NegativePoles::Reject).unwrap();
        let again = Zpk::from_state_space(&back).unwrap();
        for omega in [0.0, 1.0, 10.0] {
            let (f, e) = (
                again.evaluate(C64::new(0.0, omega)),
                exact.evaluate(C64::new(0.0, omega)),
            );
            assert!((f - e).norm() < 1e-8 * e.norm(), "{omega}: {f} {e}");
        }
    }

    #[test]
    fn val_realisation_has_the_impulse_response_of_the_polynomials() {
        let model = Polynomials::try_new(vec![1.0, -1.1, 0.3], vec![0.5, 0.2, -0.1, 0.4], 0, 1.0).unwrap();
        let mut impulse = vec![0.0; 12];
        impulse[0] = 1.0;
        let system = realise(&model).unwrap().system;
        let mut x = Mat::zeros(system.a.nrows(), 1);
        for (y, u) in model.simulate(&impulse).into_iter().zip(impulse) {
            assert!(((&system.c * &x)[(0, 0)] + system.d[(0, 0)] * u - y).abs() < 1e-15);
            x = &system.a * &x + &system.b * u;
        }
    }

    #[test]
    fn val_negative_poles_are_set_aside_or_doubled() {
        let z = [C64::new(-0.5, 0.0), C64::new(0.5, 0.0), C64::new(0.0, 0.0)];
        let rejecting = continuous_poles(&z, 0.2, NegativePoles::Reject).unwrap();
        assert_eq!(rejecting.rejected, [z[0], z[2]]);
        assert!((rejecting.poles[0].re - 0.5_f64.ln() / 0.2).abs() < 1e-14);
        let doubling = continuous_poles(&z, 0.2, NegativePoles::Double).unwrap();
        assert_eq!((doubling.poles.len(), doubling.rejected.len()), (3, 1));
        assert!(((doubling.poles[1] * 0.2).exp() - z[0]).norm() < 1e-15);
        assert!(continuous_poles(&z, -1.0, NegativePoles::Double).is_err());
    }

    /// Two negative poles and a pair: the doubled model sampled again has the response of the original.
    #[test]
    fn val_doubled_model_has_the_samples_of_the_discrete_one() {
        let a = mat(&[
            &[-0.4, 0.3, 0.0, 0.1],
            &[0.0, 0.7, 0.5, 0.0],
            &[0.0, -0.5, 0.7, 0.2],
            &[0.0, 0.0, 0.0, -0.8],
        ]);
        let system = StateSpace::unnamed(
            a,
            mat(&[&[1.0], &[0.5], &[0.0], &[2.0]]),
            mat(&[&[1.0, 1.0, 0.0, 0.3]]),
            mat(&[&[0.1]]),
        )
        .unwrap();
        let sampled = Sampled { system, dt: 0.25 };
        for hold in BOTH {
            assert!(matches!(
                d2c(&sampled, hold, NegativePoles::Reject),
                Err(Error::NoLogarithm { .. })
            ));
            let continuous = d2c(&sampled, hold, NegativePoles::Double).unwrap();
            assert_eq!(continuous.states.len(), 6);
            assert_eq!(continuous.states[5].name, "doubled 2");
            let again = c2d(&continuous, 0.25, hold).unwrap().system;
            let (mut p, mut q) = (sampled.system.b.clone(), again.b.clone());
            assert!((again.d[(0, 0)] - 0.1).abs() < 1e-12);
            for _ in 0..10 {
                assert!(((&sampled.system.c * &p) - (&again.c * &q)).norm_max() < 1e-12);
                p = &sampled.system.a * &p;
                q = &again.a * &q;
            }
        }
    }

    #[test]
    fn val_delays_and_multiple_negative_poles_are_refused() {
        let delay = Polynomials::try_new(vec![1.0, -0.5], vec![1.0], 3, 0.1).unwrap();
        let negative = NegativePoles::Double;
        assert!(matches!(
            d2c(&realise(&delay).unwrap(), Intersample::Zoh, negative),
            Err(Error::NoLogarithm { pole: 0.0 })
        ));
        let double = StateSpace::unnamed(
            mat(&[&[-0.5, 0.0], &[0.0, -0.5]]),
            mat(&[&[1.0], &[1.0]]),
            mat(&[&[1.0, 0.0]]),
            mat(&[&[0.0]]),
        )
        .unwrap();
        let sampled = Sampled {
            system: double,
            dt: 0.1,
        };
        assert!(matches!(
            d2c(&sampled, Intersample::Zoh, negative),
            Err(Error::NoLogarithm { pole: -0.5 })
        ));
    }
}
