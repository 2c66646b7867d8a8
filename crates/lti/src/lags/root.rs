//! One eigenvalue with its vectors.

use albatross_numerics::C64;
use albatross_numerics::faer::linalg::solvers::PartialPivLu;

use super::form::{LagForm, Parts, solve};
use crate::{Error, Result};

/// Relative change of the eigenvalue at which an iteration has converged.
const CONVERGED: f64 = 1e-12;
/// Most iterations for one root.
const MOST_ITERATIONS: usize = 30;
/// An iteration that reduces the change of the value by less than this is worth a new factorisation.
const SLOW: f64 = 0.05;
/// Distance from a root, relative, at which its own resolvent is factorised: far enough for its digits.
const ASIDE: f64 = 1e-6;

/// An eigenvalue of a [`LagForm`] with its right and left vector, lags included.
#[derive(Debug, Clone)]
pub struct Root {
    /// The eigenvalue \[rad/s\].
    pub value: C64,
    pub(super) right: Vec<C64>,
    pub(super) left: Vec<C64>,
    right_lags: Parts,
    left_lags: Parts,
    /// `l^H r` over all states.
    product: C64,
}

impl Root {
    /// Share of this root in the mode of `old` and its conjugate: 1 for the same mode.
    ///
    /// The overlap of spectral projectors that [`crate::track`](mod@crate::track) uses.
    pub(super) fn share_in(&self, old: &Self) -> f64 {
        let members = if old.value.im == 0.0 { 1 } else { 2 };
        (0..members)
            .map(|member| {
                let conjugate = member == 1;
                let onto = inner(self.left_side(), old.right_side(), conjugate);
                // With l and r of the old mode conjugated, its inner product with the new one is that of l^T.
                let from = if conjugate {
                    bilinear(old.left_side(), self.right_side())
                } else {
                    inner(old.left_side(), self.right_side(), false)
                };
                let old_product = if conjugate {
                    old.product.conj()
                } else {
                    old.product
                };
                (onto * from / (self.product * old_product)).re
            })
            .sum()
    }

    /// Core states and lags, as of the form it belongs to.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.right.len(), self.right_lags.re.len())
    }

    fn right_side(&self) -> (&[C64], &Parts) {
        (&self.right, &self.right_lags)
    }

    fn left_side(&self) -> (&[C64], &Parts) {
        (&self.left, &self.left_lags)
    }
}

/// `l^H r`, or `l^H conj(r)`.
fn inner(l: (&[C64], &Parts), r: (&[C64], &Parts), conjugate: bool) -> C64 {
    let of = |v: C64| if conjugate { v.conj() } else { v };
    let core: C64 = l.0.iter().zip(r.0).map(|(l, r)| l.conj() * of(*r)).sum();
    let lags: C64 = (0..l.1.re.len()).map(|k| l.1.at(k).conj() * of(r.1.at(k))).sum();
    core + lags
}

/// `l^T r`.
fn bilinear(l: (&[C64], &Parts), r: (&[C64], &Parts)) -> C64 {
    let core: C64 = l.0.iter().zip(r.0).map(|(l, r)| l * r).sum();
    let lags: C64 = (0..l.1.re.len()).map(|k| l.1.at(k) * r.1.at(k)).sum();
    core + lags
}

/// Work done, counted and not timed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct Effort {
    /// Factorisations of a matrix of the order of the core.
    pub factorisations: usize,
    /// Iterations: a solve with the factors and one with their adjoint in each.
    pub iterations: usize,
}

impl LagForm {
    /// The eigenvalue next to `value`, of a pair the one with positive imaginary part, by inverse iteration from vectors without preference.
    ///
    /// # Errors
    /// [`Error::BadStart`] if there is none within a millionth of it, or if its left and right vectors are orthogonal.
    pub fn root(&self, value: C64) -> Result<Root> {
        let value = C64::new(value.re, value.im.abs());
        let bad = |reason| Error::BadStart {
            re: value.re,
            im: value.im,
            reason,
        };
        let n = self.core_count();
        // Any vector with a part in every direction will do.
        let mixed = |salt: usize| -> Vec<C64> {
            (0..n)
                .map(|i| C64::new(1.0 + 0.5 * (((7 * i + salt) % 11) as f64 / 11.0), 0.0))
                .collect()
        };
        let aside = value * (1.0 + ASIDE) + C64::new(f64::MIN_POSITIVE, 0.0);
        let lu = self.factors(aside);
        let (mut x, mut y) = (mixed(0), mixed(5));
        for _ in 0..3 {
            self.inverse_iteration(&lu, (aside, value), &mut x, &mut y);
        }
        let root = self
            .improved(value, x, y, &mut Effort::default())
            .filter(|root| (root.value - value).norm() <= 1e-6 * value.norm())
            .ok_or_else(|| bad("it is not an eigenvalue of the first matrix"))?;
        let size: f64 = {
            let core = root.left.iter().zip(&root.right).map(|(l, r)| (l * r).norm());
            let lags = (0..self.lag_count()).map(|k| (root.left_lags.at(k) * root.right_lags.at(k)).norm());
            core.chain(lags).sum()
        };
        if root.product.norm() > 1e-10 * size {
            Ok(root)
        } else {
            Err(bad(
                "its left and right eigenvectors are orthogonal (a multiple root)",
            ))
        }
    }

    /// The root whose vectors are nearest to those of a root of another, similar form; none if the iteration does not
    /// converge.
    pub(super) fn root_like(&self, old: &Root, effort: &mut Effort) -> Option<Root> {
        self.improved(old.value, old.right.clone(), old.left.clone(), effort)
    }

    /// Two-sided iteration for `T(s) x = 0`, `y^H T(s) = 0` from estimates of all three.
    ///
    /// The value is the zero of `y^H T(s) x` (the two-sided Rayleigh functional: Schwetlick and Schreiber, Linear Algebra
    /// Appl. 436, 2012), whose error is the product of those of the vectors; the vectors come from residual inverse
    /// iteration with kept factors (Neumaier, SIAM J. Numer. Anal. 22, 1985), renewed when convergence is slow.
    fn improved(&self, value: C64, mut x: Vec<C64>, mut y: Vec<C64>, effort: &mut Effort) -> Option<Root> {
        let mut s = self.functional(value, &x, &y)?;
        let mut at = self.factorised_near(s, effort);
        let mut last_change = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            effort.iterations += 1;
            self.inverse_iteration(&at.1, (at.0, s), &mut x, &mut y);
            let next = self.functional(s, &x, &y)?;
            let change = (next - s).norm() / next.norm().max(f64::MIN_POSITIVE);
            s = next;
            if change <= CONVERGED {
                return self.complete(s, x, y);
            }
            if change > SLOW * last_change {
                at = self.factorised_near(s, effort);
            }
            last_change = change;
        }
        None
    }

    /// Factors beside a value: on it they would be singular.
    fn factorised_near(&self, s: C64, effort: &mut Effort) -> (C64, PartialPivLu<C64>) {
        effort.factorisations += 1;
        let aside = s * (1.0 + ASIDE);
        (aside, self.factors(aside))
    }

    /// `x <- T(sigma)^-1 T[s, sigma] x` with the divided difference `T[s, sigma] = 1 + Axz (s - l)^-1 (sigma - l)^-1 Azx`,
    /// the same for y, both of unit length: Neumaier's step without its cancellation.
    fn inverse_iteration(
        &self,
        lu: &PartialPivLu<C64>,
        (sigma, s): (C64, C64),
        x: &mut [C64],
        y: &mut [C64],
    ) {
        let weight = |k: usize| self.weight(s, k) * self.weight(sigma, k);
        let driven = self.driven(x).times(weight);
        self.add_emitted(&driven, x);
        solve(lu, x, false);
        normalise(x);
        let seen = self.seen(y).times(|k| weight(k).conj());
        self.add_driving(&seen, y);
        solve(lu, y, true);
        normalise(y);
    }

    /// The zero of `y^H T(s) x` next to s, by Newton's method on a sum of simple fractions.
    fn functional(&self, mut s: C64, x: &[C64], y: &[C64]) -> Option<C64> {
        const MOST: usize = 20;
        let inner = |a: &[C64], b: &[C64]| -> C64 { a.iter().zip(b).map(|(a, b)| a.conj() * b).sum() };
        let (slope, constant) = (inner(y, x), inner(y, &self.core_product(x, false)));
        let (driven, seen) = (self.driven(x), self.seen(y));
        let shares: Vec<C64> = (0..self.lag_count())
            .map(|k| seen.at(k).conj() * driven.at(k))
            .collect();
        for _ in 0..MOST {
            let (mut f, mut df) = (s * slope - constant, slope);
            for (k, share) in shares.iter().enumerate() {
                let weight = self.weight(s, k);
                f -= share * weight;
                df += share * weight * weight;
            }
            let change = f / df;
            if !change.is_finite() {
                return None;
            }
            s -= change;
            if change.norm() <= 1e-14 * s.norm() {
                return Some(s);
            }
        }
        // Rounding may leave the last digits moving; the iteration around this one decides.
        s.is_finite().then_some(s)
    }

    /// The vectors with their lags.
    fn complete(&self, value: C64, right: Vec<C64>, left: Vec<C64>) -> Option<Root> {
        let right_lags = self.driven(&right).times(|k| self.weight(value, k));
        let left_lags = self.seen(&left).times(|k| self.weight(value, k).conj());
        let product = inner((&left, &left_lags), (&right, &right_lags), false);
        (value.is_finite() && product.is_finite() && product.norm() > 0.0).then_some(Root {
            value,
            right,
            left,
            right_lags,
            left_lags,
            product,
        })
    }
}

fn normalise(x: &mut [C64]) {
    let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.re.abs()).max(v.im.abs()));
    if largest > 0.0 && largest.is_finite() {
        x.iter_mut().for_each(|v| *v /= largest);
    }
}
