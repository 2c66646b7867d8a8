//! Fixed-step integration of x' = f(t, x) without allocation in the loop.
//!
//! Equations: THEORY (26b).

use crate::{Error, Result};

/// Which evaluation of a four-stage step is asked for.
///
/// The input of a simulation may jump at the ends of a step. The first stage then wants the limit of the
/// input from the right, the last one the limit from the left; the time alone cannot tell them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// At t.
    Start,
    /// At t + dt/2, first estimate.
    FirstMiddle,
    /// At t + dt/2, second estimate.
    SecondMiddle,
    /// At t + dt.
    End,
}

impl Stage {
    /// Position of the stage within the step: 0 to 3.
    pub fn index(self) -> usize {
        match self {
            Self::Start => 0,
            Self::FirstMiddle => 1,
            Self::SecondMiddle => 2,
            Self::End => 3,
        }
    }
}

/// The classical fourth-order Runge-Kutta method (Kutta, 1901) with its work space.
#[derive(Debug, Clone)]
pub struct Rk4 {
    k: [Vec<f64>; 4],
    x: Vec<f64>,
}

impl Rk4 {
    /// Work space for `n` states.
    pub fn new(n: usize) -> Self {
        Self {
            k: std::array::from_fn(|_| vec![0.0; n]),
            x: vec![0.0; n],
        }
    }

    /// Advances `x` from `t` to `t + dt`; `f(t, stage, x, xdot)` writes every entry of `xdot`.
    pub fn step<F>(&mut self, t: f64, dt: f64, x: &mut [f64], mut f: F)
    where
        F: FnMut(f64, Stage, &[f64], &mut [f64]),
    {
        let [k1, k2, k3, k4] = &mut self.k;
        let half = 0.5 * dt;
        f(t, Stage::Start, x, k1);
        offset(&mut self.x, x, half, k1);
        f(t + half, Stage::FirstMiddle, &self.x, k2);
        offset(&mut self.x, x, half, k2);
        f(t + half, Stage::SecondMiddle, &self.x, k3);
        offset(&mut self.x, x, dt, k3);
        f(t + dt, Stage::End, &self.x, k4);
        let sixth = dt / 6.0;
        for ((((x, k1), k2), k3), k4) in x.iter_mut().zip(k1).zip(k2).zip(k3).zip(k4) {
            *x += sixth * (*k1 + 2.0 * (*k2 + *k3) + *k4);
        }
    }
}

/// out = x + h k
fn offset(out: &mut [f64], x: &[f64], h: f64, k: &[f64]) {
    for ((out, x), k) in out.iter_mut().zip(x).zip(k) {
        *out = x + h * k;
    }
}

/// Weights of one diagonal entry l in a step of ETDRK4.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Weights {
    exp: f64,
    exp_half: f64,
    /// (dt/2) phi_1(l dt/2)
    half: f64,
    /// dt times the weights of the first, the two middle and the last stage.
    first: f64,
    middle: f64,
    last: f64,
}

impl Weights {
    fn new(l: f64, dt: f64) -> Self {
        let z = l * dt;
        let [phi1, phi2, phi3] = phi(z);
        Self {
            exp: z.exp(),
            exp_half: (0.5 * z).exp(),
            half: 0.5 * dt * phi(0.5 * z)[0],
            first: dt * (phi1 - 3.0 * phi2 + 4.0 * phi3),
            middle: dt * (2.0 * phi2 - 4.0 * phi3),
            last: dt * (4.0 * phi3 - phi2),
        }
    }
}

/// Exponential time differencing, fourth order, for x' = diag(l) x + N(t, x).
///
/// Cox and Matthews, J. Comput. Phys. 176 (2002), Eqs. 26 to 29. The diagonal part (the lag states of
/// unsteady aerodynamics) is solved exactly, so its rates do not limit the step; where l = 0 the method is
/// the classical Runge-Kutta step to the last weight. The weights are evaluated without the cancellation for
/// small l dt that Kassam and Trefethen (SIAM J. Sci. Comput. 26, 2005) describe.
#[derive(Debug, Clone)]
pub struct EtdRk4 {
    dt: f64,
    l: Vec<f64>,
    weights: Vec<Weights>,
    n: [Vec<f64>; 4],
    first: Vec<f64>,
    x: Vec<f64>,
}

impl EtdRk4 {
    /// Method for the diagonal `l` (1/s) and the step `dt` (s).
    ///
    /// # Errors
    /// [`Error::Domain`] when `dt` is not positive and finite, [`Error::NonFinite`] for a rate that is not.
    pub fn new(l: &[f64], dt: f64) -> Result<Self> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(Error::Domain {
                what: "dt",
                value: dt,
                expected: "a positive step in seconds",
            });
        }
        let n = l.len();
        let mut method = Self {
            dt,
            l: vec![f64::NAN; n],
            weights: vec![Weights::new(0.0, dt); n],
            n: std::array::from_fn(|_| vec![0.0; n]),
            first: vec![0.0; n],
            x: vec![0.0; n],
        };
        method.set_rates(l)?;
        Ok(method)
    }

    /// Replaces the diagonal; weights are recomputed only for the entries that changed.
    ///
    /// # Errors
    /// [`Error::Shape`] when the length differs, [`Error::NonFinite`] for a rate that is not finite.
    pub fn set_rates(&mut self, l: &[f64]) -> Result<()> {
        crate::matrix::check_shape("the diagonal", (l.len(), 1), (self.l.len(), 1))?;
        if let Some(row) = l.iter().position(|l| !l.is_finite()) {
            return Err(Error::NonFinite {
                what: "the diagonal",
                row,
                col: 0,
            });
        }
        let mut previous: Option<(f64, Weights)> = None;
        for ((old, weights), &new) in self.l.iter_mut().zip(&mut self.weights).zip(l) {
            if *old != new {
                // Strips of one chord share a rate: reuse the neighbour's weights.
                *weights = match previous {
                    Some((rate, weights)) if rate == new => weights,
                    _ => Weights::new(new, self.dt),
                };
                *old = new;
            }
            previous = Some((new, *weights));
        }
        Ok(())
    }

    /// The step the weights were computed for, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Advances `x` from `t` by one step; `f(t, stage, x, n)` writes N(t, x), without the diagonal part.
    pub fn step<F>(&mut self, t: f64, x: &mut [f64], mut f: F)
    where
        F: FnMut(f64, Stage, &[f64], &mut [f64]),
    {
        let [n1, n2, n3, n4] = &mut self.n;
        let half = 0.5 * self.dt;

        f(t, Stage::Start, x, n1);
        for (((a, x), n1), w) in self.first.iter_mut().zip(&*x).zip(&*n1).zip(&self.weights) {
            *a = w.exp_half * x + w.half * n1;
        }
        f(t + half, Stage::FirstMiddle, &self.first, n2);
        for (((b, x), n2), w) in self.x.iter_mut().zip(&*x).zip(&*n2).zip(&self.weights) {
            *b = w.exp_half * x + w.half * n2;
        }
        f(t + half, Stage::SecondMiddle, &self.x, n3);
        let weights = &self.weights;
        for ((((c, a), n1), n3), w) in self
            .x
            .iter_mut()
            .zip(&self.first)
            .zip(&*n1)
            .zip(&*n3)
            .zip(weights)
        {
            *c = w.exp_half * a + w.half * (2.0 * n3 - n1);
        }
        f(t + self.dt, Stage::End, &self.x, n4);
        for (((((x, n1), n2), n3), n4), w) in x.iter_mut().zip(n1).zip(n2).zip(n3).zip(n4).zip(weights) {
            *x = w.exp * *x + w.first * *n1 + w.middle * (*n2 + *n3) + w.last * *n4;
        }
    }
}

/// phi_1, phi_2, phi_3 of z: phi_k = (phi_{k-1} - 1/(k-1)!)/z with phi_0 = exp(z).
///
/// Near zero the recurrence upwards cancels, so phi_3 is summed as a series there and the recurrence is run
/// downwards, which is stable.
pub fn phi(z: f64) -> [f64; 3] {
    if z.abs() < 1.0 {
        // sum of z^j/(j+3)!; twenty terms reach 1/23! = 4e-23 at |z| = 1.
        let phi3 = (0..20)
            .rev()
            .fold(0.0, |sum, j| (1.0 + z * sum) / f64::from(j + 3));
        let phi3 = 0.5 * phi3;
        let phi2 = 0.5 + z * phi3;
        [1.0 + z * phi2, phi2, phi3]
    } else {
        let phi1 = z.exp_m1() / z;
        let phi2 = (phi1 - 1.0) / z;
        [phi1, phi2, (phi2 - 0.5) / z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y'' + 0.4 y' + y = cos(1.7 t) as two states.
    fn driven_oscillator(t: f64, x: &[f64], dx: &mut [f64]) {
        dx[0] = x[1];
        dx[1] = -x[0] - 0.4 * x[1] + (1.7 * t).cos();
    }

    fn rk4_end(steps: usize) -> [f64; 2] {
        let (mut x, dt) = ([1.0, -0.5], 4.0 / steps as f64);
        let mut method = Rk4::new(2);
        for i in 0..steps {
            method.step(i as f64 * dt, dt, &mut x, |t, _, x, dx| {
                driven_oscillator(t, x, dx)
            });
        }
        x
    }

    #[test]
    fn val_rk4_has_order_four() {
        let fine = rk4_end(4096);
        let error = |n| (rk4_end(n)[0] - fine[0]).hypot(rk4_end(n)[1] - fine[1]);
        let order = (error(32) / error(64)).log2();
        assert!((order - 4.0).abs() < 0.15, "{order}");
    }

    #[test]
    fn val_rk4_stages_are_in_order_and_at_their_times() {
        let mut seen = Vec::new();
        Rk4::new(1).step(2.0, 0.5, &mut [0.0], |t, stage, _, dx| {
            dx[0] = 1.0;
            seen.push((t, stage.index()));
        });
        assert_eq!(seen, [(2.0, 0), (2.25, 1), (2.25, 2), (2.5, 3)]);
    }

    #[test]
    fn val_etdrk4_with_zero_rates_is_rk4() {
        let (dt, mut x, mut y) = (0.05, [1.0, -0.5], [1.0, -0.5]);
        let mut etd = EtdRk4::new(&[0.0, 0.0], dt).unwrap();
        let mut rk4 = Rk4::new(2);
        for i in 0..100 {
            let t = f64::from(i) * dt;
            etd.step(t, &mut x, |t, _, x, n| driven_oscillator(t, x, n));
            rk4.step(t, dt, &mut y, |t, _, x, n| driven_oscillator(t, x, n));
        }
        assert!((x[0] - y[0]).abs() < 1e-14 && (x[1] - y[1]).abs() < 1e-14);
    }

    /// x' = l x + exp(-t) has x = exp(l t)(x0 + 1/(l + 1)) - exp(-t)/(l + 1): stiff and soft rates.
    #[test]
    fn val_etdrk4_solves_stiff_lags_with_order_four() {
        let error = |l: f64, steps: u32| {
            let dt = 2.0 / f64::from(steps);
            let mut method = EtdRk4::new(&[l], dt).unwrap();
            let mut x = [1.0];
            for i in 0..steps {
                method.step(f64::from(i) * dt, &mut x, |t, _, _, n| n[0] = (-t).exp());
            }
            let exact = (2.0 * l).exp() * (1.0 + 1.0 / (l + 1.0)) - (-2.0_f64).exp() / (l + 1.0);
            (x[0] - exact).abs()
        };
        // Far beyond the limit of RK4, which is l dt > -2.785.
        assert!(error(-500.0, 20) < 1e-5);
        assert!(error(-1e-9, 40) < 1e-8);
        let order = (error(-3.0, 20) / error(-3.0, 40)).log2();
        assert!((order - 4.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn val_etdrk4_is_exact_for_the_homogeneous_lag() {
        let mut method = EtdRk4::new(&[-40.0, -0.3], 0.25).unwrap();
        let mut x = [2.0, 3.0];
        for i in 0..8 {
            method.step(0.25 * f64::from(i), &mut x, |_, _, _, n| n.fill(0.0));
        }
        assert!((x[0] / (2.0 * (-80.0_f64).exp()) - 1.0).abs() < 1e-13);
        assert!((x[1] / (3.0 * (-0.6_f64).exp()) - 1.0).abs() < 1e-14);
    }

    /// Reference: 40-digit evaluation with mpmath 1.3.
    #[test]
    fn val_phi_functions() {
        let reference = [
            (
                -1.0,
                [
                    0.632_120_558_828_557_7,
                    0.367_879_441_171_442_33,
                    0.132_120_558_828_557_7,
                ],
            ),
            (-1e-8, [0.999_999_995, 0.499_999_998_333_333_35, 0.166_666_666_25]),
            (
                -0.5,
                [
                    0.786_938_680_574_733_2,
                    0.426_122_638_850_533_6,
                    0.147_754_722_298_932_84,
                ],
            ),
            (
                -30.0,
                [
                    0.033_333_333_333_330_21,
                    0.032_222_222_222_222_33,
                    0.015_592_592_592_592_589,
                ],
            ),
            (
                0.7,
                [
                    1.448_218_153_529_252_2,
                    0.640_311_647_898_931_7,
                    0.200_445_211_284_188_1,
                ],
            ),
        ];
        for (z, expected) in reference {
            for (found, expected) in phi(z).into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 4e-15, "{z}: {found} {expected}");
            }
        }
    }

    #[test]
    fn val_bad_steps_and_rates_are_refused() {
        assert!(matches!(EtdRk4::new(&[1.0], 0.0), Err(Error::Domain { .. })));
        assert!(matches!(
            EtdRk4::new(&[f64::NAN], 0.1),
            Err(Error::NonFinite { row: 0, .. })
        ));
        let mut method = EtdRk4::new(&[1.0], 0.1).unwrap();
        assert!(matches!(method.set_rates(&[1.0, 2.0]), Err(Error::Shape { .. })));
    }
}
