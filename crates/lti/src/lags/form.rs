//! A state matrix in which the lags do not act on each other, and what its elimination costs.

use albatross_numerics::faer::linalg::solvers::{PartialPivLu, Solve};
use albatross_numerics::matrix::{axpy, check_finite, check_shape, dot};
use albatross_numerics::{C64, Mat, MatRef};

use crate::{Error, Result};

/// A square matrix parted into a core and lags, whose block is diagonal:
/// ```text
/// s x = Axx x + Axz z          s z = Azx x + diag(l) z
/// ```
#[derive(Debug, Clone)]
pub struct LagForm {
    /// Axx.
    core: Mat<f64>,
    /// The diagonal l.
    rates: Vec<f64>,
    /// Axz transposed: lags x core.
    emit: Mat<f64>,
    /// Azx: lags x core.
    drive: Mat<f64>,
    /// Core states that lags act on.
    rows: Vec<usize>,
    /// Core states that drive lags.
    columns: Vec<usize>,
}

/// A complex vector with its parts apart: products with real matrices are those of real vectors.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

impl Parts {
    fn zeros(n: usize) -> Self {
        Self {
            re: vec![0.0; n],
            im: vec![0.0; n],
        }
    }

    pub(super) fn at(&self, k: usize) -> C64 {
        C64::new(self.re[k], self.im[k])
    }

    /// Each entry times the factor of its place.
    pub(super) fn times(&self, factor: impl Fn(usize) -> C64) -> Self {
        let n = self.re.len();
        let mut product = Self::zeros(n);
        for k in 0..n {
            let value = self.at(k) * factor(k);
            (product.re[k], product.im[k]) = (value.re, value.im);
        }
        product
    }
}

impl LagForm {
    /// Parts a square matrix; `lags` are the indices of its lag states, ascending.
    ///
    /// # Errors
    /// [`Error::Numerics`] for a matrix that is not square or not finite, [`Error::Method`] if the indices do not
    /// ascend within it or the lags act on each other.
    pub fn new(a: MatRef<'_, f64>, lags: &[usize]) -> Result<Self> {
        let n = a.nrows();
        check_shape("the state matrix", (n, a.ncols()), (n, n))?;
        check_finite("the state matrix", a)?;
        let refuse = |reason| Error::Method {
            method: "the elimination of lag states",
            reason,
        };
        let ascending = lags.windows(2).all(|w| w[0] < w[1]) && lags.last().is_none_or(|&last| last < n);
        if !ascending {
            return Err(refuse(format!(
                "indices of the lags must ascend and be below {n}"
            )));
        }
        for &j in lags {
            if let Some(&i) = lags.iter().find(|&&i| i != j && a[(i, j)] != 0.0) {
                return Err(refuse(format!("state {j} acts on state {i}")));
            }
        }
        let core: Vec<usize> = (0..n).filter(|i| lags.binary_search(i).is_err()).collect();
        let emit = Mat::from_fn(lags.len(), core.len(), |k, i| a[(core[i], lags[k])]);
        let drive = Mat::from_fn(lags.len(), core.len(), |k, j| a[(lags[k], core[j])]);
        let active = |m: &Mat<f64>| -> Vec<usize> {
            (0..m.ncols())
                .filter(|&j| m.col_as_slice(j).iter().any(|v| *v != 0.0))
                .collect()
        };
        Ok(Self {
            core: Mat::from_fn(core.len(), core.len(), |i, j| a[(core[i], core[j])]),
            rates: lags.iter().map(|&k| a[(k, k)]).collect(),
            rows: active(&emit),
            columns: active(&drive),
            emit,
            drive,
        })
    }

    /// Number of core states, the order of the systems that are factorised.
    pub fn core_count(&self) -> usize {
        self.core.nrows()
    }

    /// Number of lag states.
    pub fn lag_count(&self) -> usize {
        self.rates.len()
    }

    /// `self + t (other - self)`.
    pub(super) fn between(&self, other: &Self, t: f64) -> Self {
        let mix = |a: &Mat<f64>, b: &Mat<f64>| {
            let mut mixed = a.clone();
            for j in 0..a.ncols() {
                let (from, to) = (mixed.col_as_slice_mut(j), b.col_as_slice(j));
                from.iter_mut().zip(to).for_each(|(f, b)| *f += t * (b - *f));
            }
            mixed
        };
        let union = |a: &[usize], b: &[usize]| {
            let mut all: Vec<usize> = a.iter().chain(b).copied().collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        Self {
            core: mix(&self.core, &other.core),
            rates: self
                .rates
                .iter()
                .zip(&other.rates)
                .map(|(a, b)| a + t * (b - a))
                .collect(),
            emit: mix(&self.emit, &other.emit),
            drive: mix(&self.drive, &other.drive),
            rows: union(&self.rows, &other.rows),
            columns: union(&self.columns, &other.columns),
        }
    }

    /// `1/(s - l)` of lag `k`.
    pub(super) fn weight(&self, s: C64, k: usize) -> C64 {
        (s - self.rates[k]).inv()
    }

    /// Axx x, or Axx' x.
    pub(super) fn core_product(&self, x: &[C64], transposed: bool) -> Vec<C64> {
        let n = self.core.nrows();
        let (re, im): (Vec<f64>, Vec<f64>) = x.iter().map(|v| (v.re, v.im)).unzip();
        if transposed {
            let entry = |j: usize| {
                let column = self.core.col_as_slice(j);
                C64::new(dot(column, &re), dot(column, &im))
            };
            return (0..n).map(entry).collect();
        }
        let mut sum = Parts::zeros(n);
        for j in 0..n {
            axpy(re[j], self.core.col_as_slice(j), &mut sum.re);
            axpy(im[j], self.core.col_as_slice(j), &mut sum.im);
        }
        (0..n).map(|i| sum.at(i)).collect()
    }

    /// Azx x: how a motion of the core drives the lags.
    pub(super) fn driven(&self, x: &[C64]) -> Parts {
        self.onto_lags(&self.drive, &self.columns, x)
    }

    /// Axz' y: how the lags act on a left vector of the core.
    pub(super) fn seen(&self, y: &[C64]) -> Parts {
        self.onto_lags(&self.emit, &self.rows, y)
    }

    fn onto_lags(&self, matrix: &Mat<f64>, columns: &[usize], x: &[C64]) -> Parts {
        let mut sum = Parts::zeros(self.rates.len());
        for &j in columns {
            axpy(x[j].re, matrix.col_as_slice(j), &mut sum.re);
            axpy(x[j].im, matrix.col_as_slice(j), &mut sum.im);
        }
        sum
    }

    /// Adds Axz z to a vector of the core.
    pub(super) fn add_emitted(&self, z: &Parts, to: &mut [C64]) {
        Self::add_from_lags(&self.emit, &self.rows, z, to);
    }

    /// Adds Azx' z to a vector of the core.
    pub(super) fn add_driving(&self, z: &Parts, to: &mut [C64]) {
        Self::add_from_lags(&self.drive, &self.columns, z, to);
    }

    fn add_from_lags(matrix: &Mat<f64>, columns: &[usize], z: &Parts, to: &mut [C64]) {
        for &i in columns {
            let column = matrix.col_as_slice(i);
            to[i] += C64::new(dot(column, &z.re), dot(column, &z.im));
        }
    }

    /// LU factors of `T(s) = s - Axx - Axz (s - l)^-1 Azx`.
    pub(super) fn factors(&self, s: C64) -> PartialPivLu<C64> {
        let (n, lags, wide) = (self.core.nrows(), self.rates.len(), self.columns.len());
        // Real parts, then imaginary parts, of the weighted rows of Azx: one real product gives both.
        let mut weighted = Mat::<f64>::zeros(lags, 2 * wide);
        let weights: Vec<C64> = (0..lags).map(|k| self.weight(s, k)).collect();
        for (at, &j) in self.columns.iter().enumerate() {
            let column = self.drive.col_as_slice(j);
            for (to, (v, w)) in weighted
                .col_as_slice_mut(at)
                .iter_mut()
                .zip(column.iter().zip(&weights))
            {
                *to = v * w.re;
            }
            for (to, (v, w)) in weighted
                .col_as_slice_mut(wide + at)
                .iter_mut()
                .zip(column.iter().zip(&weights))
            {
                *to = v * w.im;
            }
        }
        let mut emit = Mat::<f64>::zeros(lags, self.rows.len());
        for (at, &i) in self.rows.iter().enumerate() {
            emit.col_as_slice_mut(at)
                .copy_from_slice(self.emit.col_as_slice(i));
        }
        let through = emit.transpose() * &weighted;
        let mut t = Mat::from_fn(n, n, |i, j| {
            C64::new(-self.core[(i, j)], 0.0) + if i == j { s } else { C64::new(0.0, 0.0) }
        });
        for (r, &i) in self.rows.iter().enumerate() {
            for (c, &j) in self.columns.iter().enumerate() {
                t[(i, j)] -= C64::new(through[(r, c)], through[(r, wide + c)]);
            }
        }
        PartialPivLu::new(t.as_ref())
    }
}

/// Solves with the factors of a matrix, or with those of its adjoint, in place.
pub(super) fn solve(lu: &PartialPivLu<C64>, x: &mut [C64], adjoint: bool) {
    let mut right = Mat::from_fn(x.len(), 1, |i, _| x[i]);
    if adjoint {
        lu.solve_adjoint_in_place(right.as_mut());
    } else {
        lu.solve_in_place(right.as_mut());
    }
    for (i, v) in x.iter_mut().enumerate() {
        *v = right[(i, 0)];
    }
}
