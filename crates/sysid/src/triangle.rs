//! Least squares over more rows than memory should hold: the triangle of their QR decomposition.

use albatross_numerics::{Mat, MatRef, solve};

use crate::Result;

/// Triangle R of the QR decomposition of rows that arrive one after the other.
///
/// Whatever depends on the rows through inner products of their columns only (least squares, projections,
/// instrumental variables) is obtained from R, at the conditioning of the rows and not of their squares.
pub(crate) struct Triangle {
    /// Rows on top: the triangle so far; below it: rows not yet reduced.
    block: Mat<f64>,
    filled: usize,
    rows: usize,
}

impl Triangle {
    /// Without rows yet.
    pub(crate) fn new(columns: usize) -> Self {
        Self {
            block: Mat::zeros((5 * columns).max(64), columns),
            filled: 0,
            rows: 0,
        }
    }

    /// Appends a row.
    pub(crate) fn push(&mut self, row: &[f64]) {
        if self.filled == self.block.nrows() {
            self.reduce();
        }
        for (j, value) in row.iter().enumerate().take(self.block.ncols()) {
            self.block[(self.filled, j)] = *value;
        }
        self.filled += 1;
        self.rows += 1;
    }

    /// Number of rows appended.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// The triangle, columns x columns, padded with zeros when there were fewer rows.
    pub(crate) fn finish(mut self) -> Mat<f64> {
        self.reduce();
        let n = self.block.ncols();
        Mat::from_fn(n, n, |i, j| {
            if i < self.filled && i <= j {
                self.block[(i, j)]
            } else {
                0.0
            }
        })
    }

    fn reduce(&mut self) {
        // Not faer's factorisation: with dependent columns its rows no longer belong to the columns of their number.
        let r = solve::triangle(self.block.subrows(0, self.filled).to_owned());
        self.filled = r.nrows();
        self.block.subrows_mut(0, self.filled).copy_from(&r);
    }
}

/// Estimate of a linear regression.
pub(crate) struct Regression {
    /// The unknowns.
    pub(crate) theta: Vec<f64>,
    /// Covariance of the unknowns for errors of unit variance.
    pub(crate) covariance: Mat<f64>,
    /// Numerical rank of the regressors, columns scaled to unit norm.
    pub(crate) rank: usize,
    /// Singular values behind the rank.
    pub(crate) singular_values: Vec<f64>,
    /// Norm of the residual.
    pub(crate) residual_norm: f64,
}

/// Solves a regression from the triangle `r` of the columns [instruments, regressors, right-hand side]; without
/// instruments it is least squares.
///
/// With Z = Q R the instrumental-variable estimate (Z' Phi)^-1 Z' y is (Q' Phi)^-1 Q' y, and the first rows of
/// the triangle are just these: no product of two data matrices is formed. Its covariance for white errors is
/// (Z' Phi)^-1 Z' Z (Phi' Z)^-1 = (Q' Phi)^-1 (Q' Phi)^-T.
///
/// Singular values below eps max(rows, unknowns) of the largest are dropped.
pub(crate) fn regress(r: MatRef<'_, f64>, unknowns: usize, rows: usize) -> Result<Regression> {
    let n = unknowns;
    let rhs = r.ncols() - 1;
    let first = rhs - n;
    let core = Mat::from_fn(n, n, |i, j| r[(i, first + j)]);
    let sides = Mat::from_fn(n, n + 1, |i, j| match j {
        0 => r[(i, rhs)],
        _ => f64::from(u8::from(i + 1 == j)),
    });
    let tolerance = f64::EPSILON * rows.max(n) as f64;
    let fit = solve::least_squares_with_rank(core.as_ref(), sides.as_ref(), tolerance)?;
    let theta: Vec<f64> = (0..n).map(|i| fit.x[(i, 0)]).collect();
    let inverse = fit.x.subcols(1, n);
    let residual_norm = (0..r.nrows())
        .map(|i| r[(i, rhs)] - (0..n).map(|j| r[(i, first + j)] * theta[j]).sum::<f64>())
        .map(|e| e * e)
        .sum::<f64>()
        .sqrt();
    Ok(Regression {
        theta,
        covariance: inverse * inverse.transpose(),
        rank: fit.rank,
        singular_values: fit.singular_values,
        residual_norm,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_running_triangle_has_the_gram_matrix_of_all_rows() {
        let (m, n) = (1000, 5);
        let a = Mat::from_fn(m, n, |i, j| ((i * (j + 3)) as f64 * 0.37).sin());
        let mut triangle = Triangle::new(n);
        for i in 0..m {
            triangle.push(&(0..n).map(|j| a[(i, j)]).collect::<Vec<_>>());
        }
        assert_eq!(triangle.rows(), m);
        let r = triangle.finish();
        let difference = a.transpose() * &a - r.transpose() * &r;
        assert!(difference.norm_max() < 1e-11, "{}", difference.norm_max());
    }

    #[test]
    fn val_fewer_rows_than_columns_are_padded() {
        let mut triangle = Triangle::new(3);
        triangle.push(&[3.0, 1.0, 2.0]);
        let r = triangle.finish();
        assert_eq!((r.nrows(), r[(1, 1)], r[(0, 0)].abs()), (3, 0.0, 3.0));
    }
}
