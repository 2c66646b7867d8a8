//! Discrete-time transfer functions B(q)/A(q).

use albatross_lti::polynomial::{from_roots, roots};
use albatross_numerics::C64;
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Numbers of coefficients and delay of a discrete-time model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Orders {
    /// Coefficients of A besides the leading one, which is the number of poles.
    pub na: usize,
    /// Coefficients of B, at least one.
    pub nb: usize,
    /// Delay from input to output \[samples\]; 1 for a continuous system without feed-through behind a zero-order
    /// hold.
    pub nk: usize,
}

impl Orders {
    /// Coefficients to estimate.
    pub fn unknowns(self) -> usize {
        self.na.saturating_add(self.nb)
    }

    /// First sample whose regressors all lie in the record.
    pub(crate) fn first(self) -> usize {
        self.na.max(self.nk.saturating_add(self.nb).saturating_sub(1))
    }
}

/// y(k) = - a1 y(k-1) - ... - a_na y(k-na) + b0 u(k-nk) + ... + b_(nb-1) u(k-nk-nb+1).
///
/// Poles of a system sampled fast lie close together near z = 1, and coefficients lose digits with every one of
/// them: beyond about six poles at a hundred samples a cycle, estimate in continuous time instead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Polynomials {
    /// Coefficients of A by ascending powers of the delay q^-1; the first is 1.
    pub a: Vec<f64>,
    /// Coefficients of B by ascending powers of the delay, without the leading `nk` zeros \[output/input\].
    pub b: Vec<f64>,
    /// Delay \[samples\].
    pub nk: usize,
    /// Sample time \[s\].
    pub dt: f64,
}

impl Polynomials {
    /// Joins coefficients after checking them.
    ///
    /// # Errors
    /// [`Error::Domain`] when `a` does not begin with 1, `b` is empty, a coefficient is not finite, or the sample
    /// time is not positive.
    pub fn try_new(a: Vec<f64>, b: Vec<f64>, nk: usize, dt: f64) -> Result<Self> {
        let domain = |what, value, expected| {
            Err(Error::Domain {
                what,
                value,
                expected,
            })
        };
        if a.first() != Some(&1.0) {
            let found = a.first().copied().unwrap_or(f64::NAN);
            return domain("the leading coefficient of A", found, "1");
        }
        if b.is_empty() {
            return domain("the number of coefficients of B", 0.0, "at least 1");
        }
        if let Some(&bad) = a.iter().chain(&b).find(|c| !c.is_finite()) {
            return domain("a coefficient", bad, "a finite number");
        }
        if !(dt.is_finite() && dt > 0.0) {
            return domain("the sample time [s]", dt, "a positive number");
        }
        Ok(Self { a, b, nk, dt })
    }

    /// Numbers of coefficients and delay.
    pub fn orders(&self) -> Orders {
        Orders {
            na: self.a.len().saturating_sub(1),
            nb: self.b.len(),
            nk: self.nk,
        }
    }

    /// Poles in the z plane, modulus ascending: the roots of z^na A.
    ///
    /// # Errors
    /// [`Error::Lti`] for coefficients that are not finite.
    pub fn poles(&self) -> Result<Vec<C64>> {
        Ok(roots(&self.a)?)
    }

    /// Zeros in the z plane, modulus ascending, without those at the origin that a delay or na > nb make.
    ///
    /// # Errors
    /// [`Error::Lti`] for coefficients that are not finite.
    pub fn zeros(&self) -> Result<Vec<C64>> {
        Ok(roots(&self.b)?)
    }

    /// Output for an input, from rest: one value a sample.
    pub fn simulate(&self, input: &[f64]) -> Vec<f64> {
        let mut output: Vec<f64> = Vec::with_capacity(input.len());
        for k in 0..input.len() {
            let forced: f64 = (self.b.iter().enumerate())
                .filter_map(|(j, b)| Some(b * input.get(k.checked_sub(self.nk)?.checked_sub(j)?)?))
                .sum();
            let free: f64 = (self.a.iter().enumerate().skip(1))
                .filter_map(|(j, a)| Some(a * output.get(k.checked_sub(j)?)?))
                .sum();
            output.push(forced - free);
        }
        output
    }

    /// B/A on the unit circle at frequencies in rad/s, below pi/dt to be of use.
    pub fn frequency_response(&self, omega_rad_s: &[f64]) -> Vec<C64> {
        let at = |coefficients: &[f64], delay: C64| {
            coefficients
                .iter()
                .rev()
                .fold(C64::new(0.0, 0.0), |sum, &c| sum * delay + c)
        };
        omega_rad_s
            .iter()
            .map(|omega| {
                let delay = C64::from_polar(1.0, -omega * self.dt);
                let dead_time = C64::from_polar(1.0, -omega * self.dt * self.nk as f64);
                dead_time * at(&self.b, delay) / at(&self.a, delay)
            })
            .collect()
    }

    /// The model with every pole outside the unit circle reflected into it, z to 1/conj(z); unchanged if there is
    /// none.
    ///
    /// # Errors
    /// [`Error::Lti`] for coefficients that are not finite.
    pub fn stabilised(&self) -> Result<Self> {
        let poles = self.poles()?;
        if poles.iter().all(|z| z.norm() <= 1.0) {
            return Ok(self.clone());
        }
        let inside: Vec<C64> = poles
            .into_iter()
            .map(|z| if z.norm() > 1.0 { 1.0 / z.conj() } else { z })
            .collect();
        let mut a = from_roots(&inside)?;
        a.resize(self.a.len(), 0.0);
        Ok(Self { a, ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_impulse_response_of_a_first_order_model_is_geometric() {
        let model = Polynomials::try_new(vec![1.0, -0.5], vec![2.0], 3, 0.1).unwrap();
        let mut impulse = vec![0.0; 8];
        impulse[0] = 1.0;
        assert_eq!(
            model.simulate(&impulse),
            [0.0, 0.0, 0.0, 2.0, 1.0, 0.5, 0.25, 0.125]
        );
        assert_eq!(model.poles().unwrap(), [C64::new(0.5, 0.0)]);
        assert_eq!(model.orders(), Orders { na: 1, nb: 1, nk: 3 });
    }

    /// The steady response to a sinusoid is the value on the unit circle.
    #[test]
    fn val_frequency_response_is_the_steady_response_to_a_sinusoid() {
        let model = Polynomials::try_new(vec![1.0, -1.2, 0.5], vec![1.0, -0.3], 2, 0.02).unwrap();
        let omega = 11.0;
        let phase = |k: usize| omega * 0.02 * k as f64;
        let input: Vec<f64> = (0..600).map(|k| phase(k).sin()).collect();
        let output = model.simulate(&input);
        let g = model.frequency_response(&[omega])[0];
        for (k, y) in output.iter().enumerate().skip(400) {
            assert!((y - g.norm() * (phase(k) + g.arg()).sin()).abs() < 1e-12);
        }
    }

    #[test]
    fn val_unstable_poles_are_reflected_and_stable_ones_kept() {
        // (1 - 2 q^-1)(1 - 0.25 q^-1): the pole at 2 goes to 0.5.
        let model = Polynomials::try_new(vec![1.0, -2.25, 0.5], vec![1.0], 1, 1.0).unwrap();
        let stable = model.stabilised().unwrap();
        for (found, expected) in stable.a.iter().zip([1.0, -0.75, 0.125]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert_eq!(stable.stabilised().unwrap(), stable);
    }

    #[test]
    fn val_bad_coefficients_are_refused() {
        assert!(Polynomials::try_new(vec![2.0], vec![1.0], 0, 1.0).is_err());
        assert!(Polynomials::try_new(vec![1.0], vec![], 0, 1.0).is_err());
        assert!(Polynomials::try_new(vec![1.0, f64::NAN], vec![1.0], 0, 1.0).is_err());
        assert!(Polynomials::try_new(vec![1.0], vec![1.0], 0, 0.0).is_err());
    }
}
