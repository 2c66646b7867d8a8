//! Transfer functions as ratios of polynomials.
//!
//! Coefficients are the form in which transfer functions are published and identified. Beyond about ten roots
//! they lose digits by themselves; [`crate::Zpk`] and [`crate::StateSpace`] do not.

use albatross_numerics::{C64, Mat, eigen};
use serde::{Deserialize, Serialize};

use crate::zpk::Zpk;
use crate::{Error, Result};

/// Numerator over denominator, coefficients by descending powers of s (rad/s).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TransferFunction {
    /// Numerator coefficients, highest power first.
    pub numerator: Vec<f64>,
    /// Denominator coefficients, highest power first.
    pub denominator: Vec<f64>,
}

impl TransferFunction {
    /// Value at `s`; not finite at a pole.
    pub fn evaluate(&self, s: C64) -> C64 {
        horner(&self.numerator, s) / horner(&self.denominator, s)
    }

    /// Zeros, poles and gain.
    ///
    /// # Errors
    /// [`Error::ZeroPolynomial`] for a denominator without a non-zero coefficient, [`Error::Numerics`].
    pub fn to_zpk(&self) -> Result<Zpk> {
        let leading = |what, polynomial: &[f64]| {
            polynomial
                .iter()
                .copied()
                .find(|&c| c != 0.0)
                .ok_or(Error::ZeroPolynomial { what })
        };
        let bottom = leading("denominator", &self.denominator)?;
        let poles = roots(&self.denominator)?;
        // A zero numerator is a channel without response.
        let Ok(top) = leading("numerator", &self.numerator) else {
            return Zpk::try_new(Vec::new(), poles, 0.0);
        };
        Zpk::try_new(roots(&self.numerator)?, poles, top / bottom)
    }
}

/// Value of a polynomial, coefficients by descending powers.
fn horner(coefficients: &[f64], s: C64) -> C64 {
    coefficients
        .iter()
        .fold(C64::new(0.0, 0.0), |sum, &c| sum * s + c)
}

/// Roots of a polynomial with coefficients by descending powers, modulus ascending.
///
/// Eigenvalues of the balanced companion matrix; zero coefficients at the ends are zero roots and missing
/// powers exactly.
///
/// # Errors
/// [`Error::Numerics`] for coefficients that are not finite. A constant has no roots; neither has zero.
pub fn roots(coefficients: &[f64]) -> Result<Vec<C64>> {
    let Some(first) = coefficients.iter().position(|&c| c != 0.0) else {
        return Ok(Vec::new());
    };
    let last = coefficients.iter().rposition(|&c| c != 0.0).unwrap_or(first);
    let (core, at_zero) = (&coefficients[first..=last], coefficients.len() - 1 - last);
    let n = core.len() - 1;
    let companion = Mat::from_fn(n, n, |i, j| match i {
        0 => -core[j + 1] / core[0],
        _ => f64::from(u8::from(i == j + 1)),
    });
    let mut values = vec![C64::new(0.0, 0.0); at_zero];
    values.extend(eigen::eigenvalues(companion.as_ref())?);
    Ok(values)
}

/// The monic polynomial with these roots, coefficients by descending powers.
///
/// # Errors
/// [`Error::Unpaired`] for a complex root without its conjugate.
pub fn from_roots(roots: &[C64]) -> Result<Vec<f64>> {
    let (pairs, real) = conjugate_pairs("roots", roots)?;
    let mut coefficients = vec![1.0];
    for p in pairs {
        coefficients = product(&coefficients, &[1.0, -2.0 * p.re, p.norm_sqr()]);
    }
    for r in real {
        coefficients = product(&coefficients, &[1.0, -r]);
    }
    Ok(coefficients)
}

fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut r = vec![0.0; p.len() + q.len() - 1];
    for (i, p) in p.iter().enumerate() {
        for (j, q) in q.iter().enumerate() {
            r[i + j] += p * q;
        }
    }
    r
}

/// Complex values as members with positive imaginary part, one per pair, and the real values.
///
/// Conjugates must agree to 1e-8 of their modulus; the mean of the two is taken.
pub(crate) fn conjugate_pairs(what: &'static str, values: &[C64]) -> Result<(Vec<C64>, Vec<f64>)> {
    const SAME: f64 = 1e-8;
    let real = values.iter().filter(|v| v.im == 0.0).map(|v| v.re).collect();
    let mut lower: Vec<C64> = values.iter().filter(|v| v.im < 0.0).copied().collect();
    let mut pairs = Vec::new();
    for &upper in values.iter().filter(|v| v.im > 0.0) {
        let distance = |v: &C64| (v.conj() - upper).norm();
        let nearest = (0..lower.len()).min_by(|&p, &q| distance(&lower[p]).total_cmp(&distance(&lower[q])));
        match nearest.filter(|&k| distance(&lower[k]) <= SAME * upper.norm()) {
            Some(k) => pairs.push(0.5 * (upper + lower.swap_remove(k).conj())),
            None => {
                return Err(Error::Unpaired {
                    what,
                    re: upper.re,
                    im: upper.im,
                });
            }
        }
    }
    match lower.first() {
        Some(v) => Err(Error::Unpaired {
            what,
            re: v.re,
            im: v.im,
        }),
        // NaN belongs to neither half plane.
        None if values.iter().any(|v| !v.is_finite()) => Err(Error::Domain {
            what: "a pole or zero",
            value: f64::NAN,
            expected: "a finite number",
        }),
        None => Ok((pairs, real)),
    }
}
