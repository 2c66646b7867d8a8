//! Indicial and harmonic kernels of a thin airfoil: Theodorsen, Wagner, Küssner, and R. T. Jones's two lags.
//!
//! The exact functions come from Bessel functions. Wagner's and Küssner's are written as the real integrals along
//! the branch cut of their Laplace transforms, which decay monotonically and are summed by the trapezoidal rule
//! after the double-exponential substitution of Takahasi & Mori (1974).
//!
//! Equations: THEORY (11), (11a), (11b), (11c).

use crate::Error;
use albatross_numerics::C64;
use albatross_numerics::special::{
    bessel_i0_scaled, bessel_i1_scaled, bessel_j0, bessel_j1, bessel_k0_scaled, bessel_k1_scaled, bessel_y0,
    bessel_y1,
};
use std::f64::consts::{FRAC_PI_2, PI};

/// One exponential lag of an indicial function, in the signs of the paper's Eq. 9.
///
/// `lambda' = (2 V rate / c) lambda + gain w'`, so a decaying lag has `rate < 0`, and `gain < 0` makes the effective
/// downwash `w + lambda_1 + lambda_2` start below its final value.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lag {
    /// Pole in semi-chords travelled, `a_i < 0` \[-\].
    pub rate: f64,
    /// Share of the downwash, `A_i < 0` \[-\].
    pub gain: f64,
}

impl Lag {
    /// Checks that the lag decays and that its gain is a number.
    ///
    /// # Errors
    /// [`Error::BadLag`].
    pub fn check(&self, index: usize) -> Result<(), Error> {
        let bad = |quantity, value, expected| {
            Err(Error::BadLag {
                index,
                quantity,
                value,
                expected,
            })
        };
        if !(self.rate.is_finite() && self.rate < 0.0) {
            return bad("rate", self.rate, "a negative number");
        }
        if !self.gain.is_finite() {
            return bad("gain", self.gain, "a finite number");
        }
        Ok(())
    }
}

/// R. T. Jones's approximation of Wagner's function (NACA Report 681, 1940):
/// `phi(s) = 1 - 0.165 exp(-0.0455 s) - 0.335 exp(-0.3 s)`.
pub const JONES: [Lag; 2] = [
    Lag {
        rate: -0.0455,
        gain: -0.165,
    },
    Lag {
        rate: -0.3,
        gain: -0.335,
    },
];

/// Sears's two-lag approximation of Küssner's function: `psi(s) = 1 - 0.5 exp(-0.13 s) - 0.5 exp(-s)`
/// (Bisplinghoff, Ashley & Halfman 1955, section 5-7).
pub const KUESSNER_SEARS: [Lag; 2] = [
    Lag {
        rate: -0.13,
        gain: -0.5,
    },
    Lag {
        rate: -1.0,
        gain: -0.5,
    },
];

/// Reduced frequencies below this are zero to Theodorsen's function: the square of `H1(k)`, about `2/(pi k)`, overflows.
const LEAST_K: f64 = 5e-155;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Theodorsen's function `C(k) = H1(k) / (H1(k) + i H0(k))`, Hankel functions of the second kind
/// (NACA Report 496, 1935).
///
/// `k = omega b / V` is the reduced frequency on the semi-chord; `C(0) = 1`. Negative `k` gives the conjugate.
pub fn theodorsen(k: f64) -> C64 {
    if k.abs() < LEAST_K {
        return C64::new(1.0, 0.0);
    }
    let x = k.abs();
    let h0 = C64::new(bessel_j0(x), -bessel_y0(x));
    let h1 = C64::new(bessel_j1(x), -bessel_y1(x));
    let c = h1 / (h1 + C64::i() * h0);
    if k < 0.0 { c.conj() } else { c }
}

/// `dC/dk`, from the recurrences `H0' = -H1`, `H1' = H0 - H1/k`: `i (H0^2 - H0 H1/k + H1^2) / (H1 + i H0)^2`.
///
/// Its imaginary part grows as `ln k` for small k; zero counts as the least normal number.
pub fn theodorsen_derivative(k: f64) -> C64 {
    let x = k.abs();
    if x < LEAST_K {
        // C = 1 + k (i (ln(k/2) + Euler's constant) - pi/2) to first order.
        let rate = (0.5 * x.max(f64::MIN_POSITIVE)).ln() + EULER + 1.0;
        return C64::new(if k < 0.0 { FRAC_PI_2 } else { -FRAC_PI_2 }, rate);
    }
    let h0 = C64::new(bessel_j0(x), -bessel_y0(x));
    let h1 = C64::new(bessel_j1(x), -bessel_y1(x));
    let denominator = h1 + C64::i() * h0;
    // Divided stepwise: H1 overflows when squared at small k.
    let (u, v) = (h0 / denominator, h1 / denominator);
    let slope = C64::i() * (u * u - u * v / x + v * v);
    if k < 0.0 { -slope.conj() } else { slope }
}

/// Theodorsen's function of two lags at `k`: `1 + sum A_i ik / (ik - a_i)`.
pub fn theodorsen_lags(lags: &[Lag], k: f64) -> C64 {
    lag_transfer(lags, C64::new(0.0, k))
}

/// The transfer function from downwash to effective downwash, `1 + sum A_i p / (p - a_i)`, at the reduced Laplace
/// variable `p = s b / V`.
pub fn lag_transfer(lags: &[Lag], p: C64) -> C64 {
    lags.iter()
        .fold(C64::new(1.0, 0.0), |sum, lag| sum + lag.gain * p / (p - lag.rate))
}

/// `s dC/ds` of [`lag_transfer`]: `-sum A_i a_i s / (s - a_i)^2`.
fn lag_transfer_by_logarithm(lags: &[Lag], s: C64) -> C64 {
    lags.iter()
        .map(|lag| -lag.gain * lag.rate * s / ((s - lag.rate) * (s - lag.rate)))
        .sum()
}

/// How the circulatory lift follows the downwash: the function `C(s)` of the reduced Laplace variable `s = p b/V`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kernel<'a> {
    /// Theodorsen's function at `k = Im s`: exact on the imaginary axis, and the p-k method's approximation off it.
    Theodorsen,
    /// Exponential lags, exact at any `s`; no lag at all is `C = 1`.
    Lags(&'a [Lag]),
}

impl Kernel<'_> {
    /// `C(s)`.
    pub fn at(self, s: C64) -> C64 {
        match self {
            Self::Theodorsen => theodorsen(s.im),
            Self::Lags(lags) => lag_transfer(lags, s),
        }
    }

    /// `dC/d ln s`, along the imaginary axis for Theodorsen's function: `k dC/dk`.
    pub fn by_logarithm(self, s: C64) -> C64 {
        match self {
            Self::Theodorsen if s.im == 0.0 => C64::new(0.0, 0.0),
            Self::Theodorsen => s.im * theodorsen_derivative(s.im),
            Self::Lags(lags) => lag_transfer_by_logarithm(lags, s),
        }
    }
}

/// The indicial response of lags after `s` semi-chords: `1 + sum A_i exp(a_i s)`.
pub fn indicial_lags(lags: &[Lag], s: f64) -> f64 {
    lags.iter()
        .fold(1.0, |sum, lag| sum + lag.gain * (lag.rate * s).exp())
}

/// Wagner's function `phi(s)`, `s` semi-chords after a step of downwash (Wagner 1925); `phi(0) = 1/2`, zero before.
///
/// `phi(s) = 1 - int_0^inf exp(-x s) / (x^2 D(x)) dx`, `D = (K0 - K1)^2 + pi^2 (I0 + I1)^2` (Garrick 1938, NACA
/// Report 629).
pub fn wagner(s: f64) -> f64 {
    if s.is_nan() {
        return s;
    }
    if s < 0.0 {
        return 0.0;
    }
    1.0 - branch_cut_integral(|x| {
        let (d_scaled, _) = denominator(x);
        // D carries exp(2 x) by its I terms.
        (-x * (s + 2.0)).exp() / (x * x * d_scaled)
    })
}

/// Küssner's function `psi(s)`, `s` semi-chords after the leading edge meets a sharp-edged gust; `psi(0) = 0`, zero before.
///
/// `psi(s) = 1 - int_0^inf exp(x (1 - s)) (I0 + I1) / (x^2 D(x)) dx`: the inverse transform of
/// `exp(-p) / (p^2 (K0(p) + K1(p)))` (von Kármán & Sears 1938).
pub fn kuessner(s: f64) -> f64 {
    if s.is_nan() {
        return s;
    }
    if s < 0.0 {
        return 0.0;
    }
    1.0 - branch_cut_integral(|x| {
        let (d_scaled, i_sum_scaled) = denominator(x);
        (-x * s).exp() * i_sum_scaled / (x * x * d_scaled)
    })
}

/// `D(x) exp(-2 x)` and `(I0 + I1) exp(-x)`.
fn denominator(x: f64) -> (f64, f64) {
    let i_sum = bessel_i0_scaled(x) + bessel_i1_scaled(x);
    let k_difference = (bessel_k0_scaled(x) - bessel_k1_scaled(x)) * (-2.0 * x).exp();
    (k_difference * k_difference + (PI * i_sum).powi(2), i_sum)
}

/// `int_0^inf f(x) dx` by `x = exp(t - exp(-t))`, which suits integrands that decay exponentially.
///
/// The sum ends where the terms no longer count; a slow decay (small s) is followed to x of about 1e19.
fn branch_cut_integral(f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 64.0;
    const FROM: i32 = -64 * 7;
    const TO: i32 = 64 * 44;
    let mut sum = 0.0;
    for i in FROM..=TO {
        let t = f64::from(i) * STEP;
        let x = (t - (-t).exp()).exp();
        if x < 1e-150 {
            continue;
        }
        let term = f(x) * x * (1.0 + (-t).exp());
        if term.is_finite() {
            sum += term;
        }
        if t > 2.0 && term <= 1e-18 * sum {
            break;
        }
    }
    sum * STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Limits known in closed form: `C(0) = 1`, `C(inf) = 1/2`, `phi(0) = 1/2`, `psi(0) = 0`.
    #[test]
    fn val_limits() {
        assert_eq!(theodorsen(0.0), C64::new(1.0, 0.0));
        assert!((theodorsen(1e4) - C64::new(0.5, 0.0)).norm() < 1e-4);
        assert!((wagner(0.0) - 0.5).abs() < 1e-10, "{}", wagner(0.0));
        // Early growth of Küssner's function: sqrt(2 s)/pi.
        let early = kuessner(1e-6) / ((2e-6_f64).sqrt() / PI);
        assert!((early - 1.0).abs() < 1e-2, "{early}");
        assert!((wagner(1e3) - (1.0 - 1.0 / 1e3)).abs() < 2e-5);
    }

    /// Complex division overflows at small k, and a sum without what is not finite is a number.
    #[test]
    fn regress_arguments_at_the_ends_of_the_numbers() {
        let limit = C64::new(1.0, 0.0);
        for k in [5e-155, 4e-155, 1e-200, 1e-300, f64::MIN_POSITIVE, 5e-324] {
            for k in [k, -k] {
                assert!((theodorsen(k) - limit).norm() < 1e-150, "{k}: {}", theodorsen(k));
                let slope = theodorsen_derivative(k);
                assert!((slope.re + k.signum() * FRAC_PI_2).abs() < 1e-12, "{k}: {slope}");
                assert!(Kernel::Theodorsen.by_logarithm(C64::new(0.0, k)).norm() < 1e-150);
            }
        }
        assert!(theodorsen_derivative(0.0).is_finite());
        // Both sides of the limit are on one logarithm.
        let [below, above] = [4.99e-155, 5.01e-155].map(theodorsen_derivative);
        let step = C64::new(0.0, (5.01_f64 / 4.99).ln());
        assert!((above - below - step).norm() < 1e-9, "{below} {above}");
        for f in [wagner, kuessner] {
            assert!(f(f64::NAN).is_nan());
        }
        assert!(theodorsen(f64::NAN).is_nan() && theodorsen_derivative(f64::NAN).is_nan());
    }

    /// The branch-cut integrals by mpmath 1.3 (30 digits, Gauss-Legendre on split intervals).
    #[test]
    fn val_wagner_and_kuessner() {
        let table = [
            (0.5, 0.5556638688959744, 0.30581425531837825),
            (1.0, 0.6006055983988055, 0.4166949600957205),
            (2.0, 0.6692895643156859, 0.5508139671140336),
            (5.0, 0.7882031664695167, 0.7388295094114217),
            (10.0, 0.8750447121397658, 0.8561371876564842),
            (20.0, 0.9366492700152336, 0.9311897123884706),
            (50.0, 0.976763902437608, 0.9759678980830556),
        ];
        for (s, wagner_exact, kuessner_exact) in table {
            assert!(
                (wagner(s) - wagner_exact).abs() < 1e-12,
                "{s}: {}",
                wagner(s) - wagner_exact
            );
            assert!(
                (kuessner(s) - kuessner_exact).abs() < 1e-12,
                "{s}: {}",
                kuessner(s) - kuessner_exact
            );
        }
    }

    /// `C(k)` is the Fourier transform of Wagner's function: `C(k) = ik int phi exp(-iks) ds`, here for Jones's lags
    /// in closed form at a complex frequency.
    #[test]
    fn val_lag_transfer_is_transform_of_indicial() {
        let p = C64::new(0.3, 0.7);
        let by_hand = C64::new(1.0, 0.0) - 0.165 * p / (p + 0.0455) - 0.335 * p / (p + 0.3);
        assert!((lag_transfer(&JONES, p) - by_hand).norm() < 1e-15);
        assert_eq!(theodorsen(-0.2), theodorsen(0.2).conj());
    }

    /// Both kernels' logarithmic derivatives against central differences.
    #[test]
    fn val_derivatives_of_kernels() {
        for kernel in [Kernel::Theodorsen, Kernel::Lags(&JONES)] {
            for k in [1e-3, 0.04, 0.3, 2.0, 30.0] {
                let (s, h) = (C64::new(0.0, k), 1e-5);
                let difference = (kernel.at(s * (1.0 + h)) - kernel.at(s * (1.0 - h))) / (2.0 * h);
                let exact = kernel.by_logarithm(s);
                assert!(
                    (difference - exact).norm() < 1e-9,
                    "{kernel:?} at {k}: {difference} {exact}"
                );
            }
        }
    }
}
