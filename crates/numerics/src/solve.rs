//! Linear systems with a condition estimate, and least squares.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{PartialPivLu, Qr, Solve, Svd};
use faer::prelude::*;
use faer::traits::ComplexField;
use faer::{Accum, Par};

use crate::matrix::{axpy, check_finite, check_shape, column, dot};
use crate::{C64, Error, Mat, MatRef, Result};

/// Least reciprocal condition number of an equilibrated matrix that is still solved.
pub const LEAST_RCOND: f64 = 4.0 * f64::EPSILON;

/// The two element types: real and complex double precision.
trait Scalar: ComplexField + Copy {
    fn modulus(self) -> f64;
    fn scaled(self, factor: f64) -> Self;
    fn real(x: f64) -> Self;
}

impl Scalar for f64 {
    fn modulus(self) -> f64 {
        self.abs()
    }
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn real(x: f64) -> Self {
        x
    }
}

impl Scalar for C64 {
    fn modulus(self) -> f64 {
        self.norm()
    }
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
    fn real(x: f64) -> Self {
        Self::new(x, 0.0)
    }
}

/// LU factors of an equilibrated matrix, diag(row) A diag(column) = P^-1 L U.
#[derive(Debug, Clone)]
struct Factors<T> {
    lu: PartialPivLu<T>,
    row: Vec<f64>,
    column: Vec<f64>,
    rcond: f64,
}

impl<T: Scalar> Factors<T> {
    fn new(a: MatRef<'_, T>) -> Result<Self> {
        let n = a.nrows();
        check_shape("the matrix", (n, a.ncols()), (n, n))?;
        for j in 0..n {
            if let Some(i) = (0..n).find(|&i| !a[(i, j)].modulus().is_finite()) {
                return Err(Error::NonFinite {
                    what: "the matrix",
                    row: i,
                    col: j,
                });
            }
        }
        // Rows, then columns, to a largest magnitude of about one; powers of two round nothing.
        let row: Vec<f64> = (0..n)
            .map(|i| equilibrium((0..n).map(|j| a[(i, j)].modulus())))
            .collect();
        let column: Vec<f64> = (0..n)
            .map(|j| equilibrium((0..n).map(|i| a[(i, j)].modulus() * row[i])))
            .collect();
        let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)].scaled(row[i]).scaled(column[j]));
        let norm = one_norm(scaled.as_ref());
        let lu = PartialPivLu::new(scaled.as_ref());
        let singular_pivot = (0..n).any(|i| lu.U()[(i, i)].modulus() == 0.0);
        let rcond = match (n, singular_pivot) {
            (0, _) => 1.0,
            (_, true) => 0.0,
            _ => 1.0 / (norm * inverse_one_norm(&lu, n)),
        };
        if rcond.is_nan() || rcond <= LEAST_RCOND {
            let rcond = if rcond.is_nan() { 0.0 } else { rcond };
            return Err(Error::Singular {
                size: n,
                rcond,
                limit: LEAST_RCOND,
            });
        }
        Ok(Self {
            lu,
            row,
            column,
            rcond,
        })
    }

    fn solve(&self, b: MatRef<'_, T>) -> Result<Mat<T>> {
        let n = self.row.len();
        check_shape("the right-hand side", (b.nrows(), b.ncols()), (n, b.ncols()))?;
        for j in 0..b.ncols() {
            if let Some(i) = (0..n).find(|&i| !b[(i, j)].modulus().is_finite()) {
                return Err(Error::NonFinite {
                    what: "the right-hand side",
                    row: i,
                    col: j,
                });
            }
        }
        let mut x = Mat::from_fn(n, b.ncols(), |i, j| b[(i, j)].scaled(self.row[i]));
        self.lu.solve_in_place(&mut x);
        for j in 0..x.ncols() {
            for i in 0..n {
                x[(i, j)] = x[(i, j)].scaled(self.column[i]);
            }
        }
        Ok(x)
    }
}

/// The power of two that brings the largest of some magnitudes to between 1/2 and 2; 1 if all are zero.
fn equilibrium(magnitudes: impl Iterator<Item = f64>) -> f64 {
    let largest = magnitudes.fold(0.0_f64, f64::max);
    if largest > 0.0 {
        2.0_f64.powi(-(largest.log2().round().clamp(-500.0, 500.0) as i32))
    } else {
        1.0
    }
}

fn one_norm<T: Scalar>(a: MatRef<'_, T>) -> f64 {
    (0..a.ncols())
        .map(|j| (0..a.nrows()).map(|i| a[(i, j)].modulus()).sum::<f64>())
        .fold(0.0, f64::max)
}

/// Estimate of the 1-norm of the inverse: Hager's method (SIAM J. Sci. Stat. Comput. 5, 1984) with the
/// alternating vector of Higham (ACM TOMS 14, 1988) as a second opinion.
fn inverse_one_norm<T: Scalar>(lu: &PartialPivLu<T>, n: usize) -> f64 {
    let norm = |x: &Mat<T>| (0..n).map(|i| x[(i, 0)].modulus()).sum::<f64>();
    let mut x = Mat::from_fn(n, 1, |_, _| T::real(1.0 / n as f64));
    let mut estimate = 0.0_f64;
    for _ in 0..5 {
        lu.solve_in_place(&mut x);
        let size = norm(&x);
        if size <= estimate {
            break;
        }
        estimate = size;
        // Subgradient: A^-H sign(x).
        let mut z = Mat::from_fn(n, 1, |i, _| {
            let modulus = x[(i, 0)].modulus();
            if modulus > 0.0 {
                x[(i, 0)].scaled(1.0 / modulus)
            } else {
                T::real(1.0)
            }
        });
        lu.solve_adjoint_in_place(&mut z);
        let steepest = (0..n)
            .max_by(|&p, &q| z[(p, 0)].modulus().total_cmp(&z[(q, 0)].modulus()))
            .unwrap_or(0);
        x = Mat::from_fn(
            n,
            1,
            |i, _| if i == steepest { T::real(1.0) } else { T::real(0.0) },
        );
    }
    let alternating = |i: usize| {
        let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * (1.0 + i as f64 / (n.max(2) - 1) as f64)
    };
    let mut x = Mat::from_fn(n, 1, |i, _| T::real(alternating(i)));
    lu.solve_in_place(&mut x);
    estimate.max(2.0 * norm(&x) / (3.0 * n as f64))
}

macro_rules! factorisation {
    ($name:ident, $scalar:ty, $word:literal) => {
        #[doc = concat!("LU factors of a ", $word, " square matrix, for several right-hand sides.")]
        ///
        /// Rows and columns are equilibrated by powers of two first, so that the condition estimate measures
        /// the problem and not its units.
        #[derive(Debug, Clone)]
        pub struct $name(Factors<$scalar>);

        impl $name {
            /// Factorises A.
            ///
            /// # Errors
            /// [`Error::Shape`], [`Error::NonFinite`], [`Error::Singular`].
            pub fn new(a: MatRef<'_, $scalar>) -> Result<Self> {
                Factors::new(a).map(Self)
            }

            /// Estimated reciprocal condition number of the equilibrated matrix, 1-norm.
            pub fn rcond(&self) -> f64 {
                self.0.rcond
            }

            /// X of A X = B.
            ///
            /// # Errors
            /// [`Error::Shape`], [`Error::NonFinite`].
            pub fn solve(&self, b: MatRef<'_, $scalar>) -> Result<Mat<$scalar>> {
                self.0.solve(b)
            }
        }
    };
}

factorisation!(Lu, f64, "real");
factorisation!(ComplexLu, C64, "complex");

/// X of A X = B for a square real A.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::Singular`] with the condition estimate.
pub fn solve(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Result<Mat<f64>> {
    Lu::new(a)?.solve(b)
}

/// x of A x = b for a square real A.
///
/// # Errors
/// As [`solve`].
pub fn solve_vec(a: MatRef<'_, f64>, b: &[f64]) -> Result<Vec<f64>> {
    let x = solve(a, column(b).as_ref())?;
    Ok((0..x.nrows()).map(|i| x[(i, 0)]).collect())
}

/// X of A X = B for a square complex A.
///
/// # Errors
/// As [`solve`].
pub fn solve_complex(a: MatRef<'_, C64>, b: MatRef<'_, C64>) -> Result<Mat<C64>> {
    ComplexLu::new(a)?.solve(b)
}

/// Inverse of a square real matrix.
///
/// # Errors
/// As [`solve`].
pub fn inverse(a: MatRef<'_, f64>) -> Result<Mat<f64>> {
    solve(a, Mat::identity(a.nrows(), a.nrows()).as_ref())
}

/// Solution of a least-squares problem with what is needed to judge it.
#[derive(Debug, Clone)]
pub struct LeastSquares {
    /// The minimiser, columns of A x columns of B; of least norm (in scaled unknowns) when not unique.
    pub x: Mat<f64>,
    /// Numerical rank of A with its columns scaled to unit norm.
    pub rank: usize,
    /// Singular values of A with its columns scaled to unit norm, descending.
    pub singular_values: Vec<f64>,
    /// 2-norm of the residual A x - b, one per column of B.
    pub residual_norms: Vec<f64>,
}

/// min over X of the Frobenius norm of A X - B.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NoConvergence`].
pub fn least_squares(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let tolerance = f64::EPSILON * a.nrows().max(a.ncols()) as f64;
    least_squares_with_rank(a, b, tolerance).map(|fit| fit.x)
}

/// [`least_squares`] with singular values below `tolerance` times the largest taken as zero.
///
/// Columns are scaled to unit norm, A is reduced by QR (Householder) when it is tall, and the triangle is
/// solved through its singular values.
///
/// # Errors
/// As [`least_squares`].
pub fn least_squares_with_rank(
    a: MatRef<'_, f64>,
    b: MatRef<'_, f64>,
    tolerance: f64,
) -> Result<LeastSquares> {
    check_finite("the matrix", a)?;
    check_finite("the right-hand side", b)?;
    let (m, n) = (a.nrows(), a.ncols());
    check_shape("the right-hand side", (b.nrows(), b.ncols()), (m, b.ncols()))?;
    if m == 0 || n == 0 {
        let residual_norms = (0..b.ncols()).map(|j| b.col(j).norm_l2()).collect();
        return Ok(LeastSquares {
            x: Mat::zeros(n, b.ncols()),
            rank: 0,
            singular_values: vec![],
            residual_norms,
        });
    }
    let unit: Vec<f64> = (0..n)
        .map(|j| a.col(j).norm_l2())
        .map(|norm| {
            if norm > 0.0 && (1.0 / norm).is_finite() {
                1.0 / norm
            } else {
                1.0
            }
        })
        .collect();
    let scaled = Mat::from_fn(m, n, |i, j| a[(i, j)] * unit[j]);

    let (core, rhs) = if m > n {
        let qr = Qr::new(scaled.as_ref());
        (qr.thin_R().to_owned(), qr.compute_thin_Q().transpose() * b)
    } else {
        (scaled, b.to_owned())
    };
    let svd = Svd::new_thin(core.as_ref()).map_err(|_| Error::NoConvergence {
        what: "the singular values",
        size: n,
    })?;
    let count = core.nrows().min(n);
    let singular_values: Vec<f64> = (0..count).map(|k| svd.S()[k]).collect();
    let largest = singular_values.iter().copied().fold(0.0, f64::max);
    let rank = singular_values
        .iter()
        .filter(|&&s| s > tolerance * largest)
        .count();

    let mut coordinates = svd.U().transpose() * &rhs;
    for (k, s) in singular_values.iter().enumerate() {
        for j in 0..coordinates.ncols() {
            coordinates[(k, j)] = if *s > tolerance * largest {
                coordinates[(k, j)] / s
            } else {
                0.0
            };
        }
    }
    let scaled_x = svd.V() * &coordinates;
    let x = Mat::from_fn(n, b.ncols(), |i, j| unit[i] * scaled_x[(i, j)]);
    let residual = a * &x - b;
    let residual_norms = (0..b.ncols()).map(|j| residual.col(j).norm_l2()).collect();
    Ok(LeastSquares {
        x,
        rank,
        singular_values,
        residual_norms,
    })
}

/// Column `j` from row `i` on; columns of an owned matrix are contiguous.
fn column_from(a: MatMut<'_, f64>, j: usize, i: usize) -> &mut [f64] {
    a.col_mut(j)
        .try_as_col_major_mut()
        .and_then(|column| column.as_slice_mut().get_mut(i..))
        .unwrap_or_default()
}

/// Upper triangle R of the QR factorisation of A: min(rows, columns) x columns, without Q.
///
/// Column j of R always ends in row j, so the rows from j on belong to the columns from j on: what is left of a
/// least-squares problem when the first j unknowns have been eliminated. [`faer`]'s factorisation steps over columns that
/// depend on those before them and gives an echelon form there. R' R = A' A; signs of the rows are arbitrary.
pub fn triangle(mut a: Mat<f64>) -> Mat<f64> {
    let (m, n) = (a.nrows(), a.ncols());
    eliminate(&mut a, n);
    Mat::from_fn(m.min(n), n, |i, j| if i <= j { a[(i, j)] } else { 0.0 })
}

/// Columns reflected one after the other before the rest of the matrix is.
const PANEL: usize = 16;

/// Reflects the rows of A so that the first `n` columns become upper triangular; A is overwritten by the triangle and,
/// from row and column `n` on, by what is left of the other columns. Entries below the triangle are not cleared.
///
/// Householder's method, column by column within panels; the reflections of a panel, I - V T V', are applied to all other
/// columns by two matrix products, which pass over the memory once for sixteen columns (Schreiber and Van Loan, SIAM J.
/// Sci. Stat. Comput. 10, 1989).
pub fn eliminate(a: &mut Mat<f64>, n: usize) {
    let (m, columns) = (a.nrows(), a.ncols());
    let last = n.min(m).min(columns);
    let mut from = 0;
    while from < last {
        let width = PANEL.min(last - from);
        let (mut left, right) = a.as_mut().split_at_col_mut(from + width);
        let panel = left.rb_mut().subcols_mut(from, width).subrows_mut(from, m - from);
        let (v, t) = reflect_panel(panel);
        let mut rest = right.subrows_mut(from, m - from);
        if rest.ncols() > 0 {
            let onto = t.transpose() * (v.transpose() * rest.rb());
            matmul(
                rest.rb_mut(),
                Accum::Add,
                v.as_ref(),
                onto.as_ref(),
                -1.0,
                Par::Seq,
            );
        }
        from += width;
    }
}

/// Triangularises a panel; the vectors V of its reflections, and T of their product I - V T' V'.
fn reflect_panel(mut panel: MatMut<'_, f64>) -> (Mat<f64>, Mat<f64>) {
    let (m, width) = (panel.nrows(), panel.ncols());
    let (mut vectors, mut t) = (Mat::<f64>::zeros(m, width), Mat::<f64>::zeros(width, width));
    for j in 0..width {
        let (mut left, mut right) = panel.rb_mut().split_at_col_mut(j + 1);
        let v = column_from(left.rb_mut(), j, j);
        let norm = dot(v, v).sqrt();
        // A column of zeros needs no reflection: its vector and its part of T stay zero.
        let Some(head) = v.first().copied().filter(|_| norm > 0.0) else {
            continue;
        };
        let diagonal = -norm.copysign(head);
        let tau = 1.0 / (norm * (norm + head.abs()));
        v[0] = head - diagonal;
        for k in 0..right.ncols() {
            let column = column_from(right.rb_mut(), k, j);
            axpy(-tau * dot(v, column), v, column);
        }
        vectors.col_as_slice_mut(j)[j..].copy_from_slice(v);
        v[0] = diagonal;
        let inner: Vec<f64> = (0..j)
            .map(|k| dot(&vectors.col_as_slice(k)[j..], &vectors.col_as_slice(j)[j..]))
            .collect();
        for i in 0..j {
            t[(i, j)] = -tau * (i..j).map(|k| t[(i, k)] * inner[k]).sum::<f64>();
        }
        t[(j, j)] = tau;
    }
    (vectors, t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hilbert(n: usize) -> Mat<f64> {
        Mat::from_fn(n, n, |i, j| 1.0 / (i + j + 1) as f64)
    }

    #[test]
    fn val_hilbert_inverse_is_integer() {
        // The inverse of the 3 x 3 Hilbert matrix (Choi, Amer. Math. Monthly 90, 1983).
        let exact = [[9.0, -36.0, 30.0], [-36.0, 192.0, -180.0], [30.0, -180.0, 180.0]];
        let found = inverse(hilbert(3).as_ref()).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                assert!((found[(i, j)] - exact[i][j]).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn val_condition_estimate_is_close_and_unit_free() {
        // 1-norm condition of the 6 x 6 Hilbert matrix: 2.907e7 (Higham, Accuracy and Stability, sec. 28.1).
        let lu = Lu::new(hilbert(6).as_ref()).unwrap();
        assert!(
            1.0 / lu.rcond() > 2.9e6 && 1.0 / lu.rcond() < 6e7,
            "{}",
            1.0 / lu.rcond()
        );
        let scaled = Mat::from_fn(6, 6, |i, j| {
            hilbert(6)[(i, j)] * 10_f64.powi(8 * (i as i32 - j as i32))
        });
        let ratio = Lu::new(scaled.as_ref()).unwrap().rcond() / lu.rcond();
        assert!(ratio > 0.02 && ratio < 50.0, "{ratio}");
    }

    #[test]
    fn val_singular_matrices_are_refused() {
        let rank_one = Mat::from_fn(3, 3, |i, j| ((i + 1) * (j + 2)) as f64);
        assert!(matches!(
            solve_vec(rank_one.as_ref(), &[1.0, 2.0, 3.0]),
            Err(Error::Singular { size: 3, .. })
        ));
        assert!(matches!(
            inverse(Mat::zeros(2, 2).as_ref()),
            Err(Error::Singular { rcond: 0.0, .. })
        ));
        assert!(matches!(
            inverse(hilbert(14).as_ref()),
            Err(Error::Singular { .. })
        ));
        let nan = Mat::from_fn(2, 2, |i, j| if i + j == 1 { f64::INFINITY } else { 1.0 });
        assert!(matches!(
            inverse(nan.as_ref()),
            Err(Error::NonFinite { row: 1, col: 0, .. })
        ));
        assert!(matches!(
            solve_vec(Mat::identity(2, 2).as_ref(), &[1.0]),
            Err(Error::Shape {
                found: (1, 1),
                expected: (2, 1),
                ..
            })
        ));
    }

    /// R'R = A'A, for tall, square and wide matrices, with dependent columns and a column of zeros among them.
    #[test]
    fn val_triangle_has_the_same_products() {
        for (m, n) in [
            (30, 7),
            (7, 7),
            (4, 7),
            (1, 3),
            (5, 1),
            (0, 2),
            (90, 41),
            (33, 50),
        ] {
            let a = Mat::from_fn(m, n, |i, j| match j {
                2 => 0.0,
                3 => 2.0,
                4 => 1.0,
                _ => ((3 * i + 5 * j) as f64).sin(),
            });
            let r = triangle(a.clone());
            assert_eq!((r.nrows(), r.ncols()), (m.min(n), n));
            let difference = r.transpose() * &r - a.transpose() * &a;
            assert!(difference.norm_max() < 1e-13, "{m} x {n}");
            assert!((0..r.nrows()).all(|i| (0..i.min(n)).all(|j| r[(i, j)] == 0.0)));
        }
    }

    #[test]
    fn val_complex_solve() {
        let a = Mat::from_fn(5, 5, |i, j| {
            C64::new(1.0 / (1 + i + j) as f64, (i as f64 - 2.0 * j as f64).sin())
        });
        let exact = Mat::from_fn(5, 1, |i, _| C64::new(i as f64, 1.0 - i as f64));
        let found = solve_complex(a.as_ref(), (&a * &exact).as_ref()).unwrap();
        assert!((0..5).all(|i| (found[(i, 0)] - exact[(i, 0)]).norm() < 1e-11));
    }

    /// Longley's form of a check: noise orthogonal to the columns leaves the solution alone.
    #[test]
    fn val_polynomial_fit_recovers_coefficients_and_residual() {
        let x: Vec<f64> = (0..21).map(|i| f64::from(i) / 10.0 - 1.0).collect();
        let a = Mat::from_fn(21, 4, |i, j| x[i].powi(j as i32) * 10_f64.powi(3 * j as i32));
        let c = [1.0, -2.0, 0.5, 3.0];
        let b = column(
            &x.iter()
                .map(|x| (0..4).map(|j| c[j] * x.powi(j as i32)).sum())
                .collect::<Vec<f64>>(),
        );
        let fit = least_squares_with_rank(a.as_ref(), b.as_ref(), 1e-12).unwrap();
        assert_eq!(fit.rank, 4);
        for (j, c) in c.iter().enumerate() {
            assert!((fit.x[(j, 0)] * 10_f64.powi(3 * j as i32) - c).abs() < 1e-13);
        }
        assert!(fit.residual_norms[0] < 1e-13);
    }

    #[test]
    fn val_rank_deficient_and_wide_problems_give_the_least_norm() {
        let twice = Mat::from_fn(6, 2, |i, _| 1.0 + i as f64);
        let b = column(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let fit = least_squares_with_rank(twice.as_ref(), b.as_ref(), 1e-12).unwrap();
        assert_eq!(fit.rank, 1);
        assert!((fit.x[(0, 0)] - 0.5).abs() < 1e-14 && (fit.x[(1, 0)] - 0.5).abs() < 1e-14);
        let wide = Mat::from_fn(1, 3, |_, _| 1.0);
        let x = least_squares(wide.as_ref(), column(&[3.0]).as_ref()).unwrap();
        assert!((0..3).all(|j| (x[(j, 0)] - 1.0).abs() < 1e-14));
    }
}
