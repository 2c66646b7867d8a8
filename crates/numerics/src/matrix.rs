//! Row-major matrices on slices, conversions and checks.

use serde::{Deserialize, Serialize};

pub use crate::kernel::{axpy, dot};
use crate::{C64, Error, Mat, MatRef, Result, kernel};

/// The rows of `a` as vectors: the layout of the JSON files.
pub fn to_rows(a: MatRef<'_, f64>) -> Vec<Vec<f64>> {
    (0..a.nrows())
        .map(|i| (0..a.ncols()).map(|j| a[(i, j)]).collect())
        .collect()
}

/// The matrix with the given rows; an empty list gives a 0 x 0 matrix.
///
/// # Errors
/// [`Error::Shape`] when the rows differ in length.
pub fn from_rows(rows: &[Vec<f64>]) -> Result<Mat<f64>> {
    let ncols = rows.first().map_or(0, Vec::len);
    if let Some(ragged) = rows.iter().find(|r| r.len() != ncols) {
        return Err(Error::Shape {
            what: "a row",
            expected: (1, ncols),
            found: (1, ragged.len()),
        });
    }
    Ok(Mat::from_fn(rows.len(), ncols, |i, j| rows[i][j]))
}

/// A column matrix with the entries of `x`.
pub fn column(x: &[f64]) -> Mat<f64> {
    Mat::from_fn(x.len(), 1, |i, _| x[i])
}

/// Refuses NaN and infinities, naming the first entry found.
///
/// # Errors
/// [`Error::NonFinite`].
pub fn check_finite(what: &'static str, a: MatRef<'_, f64>) -> Result<()> {
    for j in 0..a.ncols() {
        for i in 0..a.nrows() {
            if !a[(i, j)].is_finite() {
                return Err(Error::NonFinite { what, row: i, col: j });
            }
        }
    }
    Ok(())
}

/// Refuses a shape other than the one expected.
///
/// # Errors
/// [`Error::Shape`].
pub fn check_shape(what: &'static str, found: (usize, usize), expected: (usize, usize)) -> Result<()> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::Shape {
            what,
            expected,
            found,
        })
    }
}

/// Largest magnitude among the entries; 0 for an empty matrix.
pub fn max_abs(a: MatRef<'_, f64>) -> f64 {
    let mut largest = 0.0_f64;
    for j in 0..a.ncols() {
        for i in 0..a.nrows() {
            largest = largest.max(a[(i, j)].abs());
        }
    }
    largest
}

/// The real matrix as a complex one.
pub fn to_complex(a: MatRef<'_, f64>) -> Mat<C64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| C64::new(a[(i, j)], 0.0))
}

/// Dense row-major matrix for products with slices inside time loops.
///
/// Nothing here allocates after construction. A result depends on the shape of the matrix only, not on the
/// vector width of the processor. [`PreparedMatrix`] is faster where only y = A x is needed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Vec<Vec<f64>>", try_from = "Vec<Vec<f64>>")]
pub struct RowMatrix {
    rows: usize,
    cols: usize,
    data: Vec<f64>,
}

impl RowMatrix {
    /// Matrix of zeros.
    pub fn zeros(rows: usize, cols: usize) -> Self {
        Self {
            rows,
            cols,
            data: vec![0.0; rows * cols],
        }
    }

    /// Matrix with entry `f(row, column)`.
    pub fn from_fn(rows: usize, cols: usize, mut f: impl FnMut(usize, usize) -> f64) -> Self {
        let mut data = Vec::with_capacity(rows * cols);
        for i in 0..rows {
            data.extend((0..cols).map(|j| f(i, j)));
        }
        Self { rows, cols, data }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn cols(&self) -> usize {
        self.cols
    }

    /// Entries, row after row.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// Entries, row after row, for writing.
    pub fn data_mut(&mut self) -> &mut [f64] {
        &mut self.data
    }

    /// Row `i`; empty when there is no such row.
    pub fn row(&self, i: usize) -> &[f64] {
        let first = i.saturating_mul(self.cols);
        self.data
            .get(first..first.saturating_add(self.cols))
            .unwrap_or(&[])
    }

    /// Copy as a faer matrix.
    pub fn to_mat(&self) -> Mat<f64> {
        Mat::from_fn(self.rows, self.cols, |i, j| self.data[i * self.cols + j])
    }

    /// y = A x over the shorter of the lengths given.
    pub fn mul_into(&self, x: &[f64], y: &mut [f64]) {
        y.iter_mut().take(self.rows).for_each(|yi| *yi = 0.0);
        self.mul_scaled_add_into(1.0, x, y);
    }

    /// y += A x.
    pub fn mul_add_into(&self, x: &[f64], y: &mut [f64]) {
        self.mul_scaled_add_into(1.0, x, y);
    }

    /// y += s A x.
    pub fn mul_scaled_add_into(&self, scale: f64, x: &[f64], y: &mut [f64]) {
        kernel::add_product(scale, &self.data, self.cols, x, y);
    }

    /// y = A^T x.
    pub fn mul_transposed_into(&self, x: &[f64], y: &mut [f64]) {
        y.iter_mut().take(self.cols).for_each(|yi| *yi = 0.0);
        self.mul_transposed_add_into(x, y);
    }

    /// y += A^T x.
    pub fn mul_transposed_add_into(&self, x: &[f64], y: &mut [f64]) {
        kernel::add_transposed_product(&self.data, self.cols, x, y);
    }
}

/// A matrix prepared for y = A x with slices, at the speed its shape allows.
///
/// Stored by columns unless it is much wider than tall: then by rows. Measured on matrices of 20 to 400 rows
/// and columns, the right choice is two to three times as fast as the wrong one.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedMatrix {
    by_columns: bool,
    /// A, or its transpose when stored by columns.
    stored: RowMatrix,
}

impl PreparedMatrix {
    /// Prepares a copy of `a`.
    pub fn new(a: MatRef<'_, f64>) -> Self {
        let by_columns = a.ncols() < 4 * a.nrows();
        Self {
            by_columns,
            stored: if by_columns {
                a.transpose().into()
            } else {
                a.into()
            },
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        if self.by_columns {
            self.stored.cols
        } else {
            self.stored.rows
        }
    }

    /// Number of columns.
    pub fn cols(&self) -> usize {
        if self.by_columns {
            self.stored.rows
        } else {
            self.stored.cols
        }
    }

    /// y = A x.
    pub fn mul_into(&self, x: &[f64], y: &mut [f64]) {
        if self.by_columns {
            self.stored.mul_transposed_into(x, y)
        } else {
            self.stored.mul_into(x, y)
        }
    }

    /// y += A x.
    pub fn mul_add_into(&self, x: &[f64], y: &mut [f64]) {
        if self.by_columns {
            self.stored.mul_transposed_add_into(x, y)
        } else {
            self.stored.mul_add_into(x, y)
        }
    }
}

impl From<MatRef<'_, f64>> for RowMatrix {
    fn from(a: MatRef<'_, f64>) -> Self {
        Self::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
    }
}

impl From<RowMatrix> for Vec<Vec<f64>> {
    fn from(a: RowMatrix) -> Self {
        (0..a.rows).map(|i| a.row(i).to_vec()).collect()
    }
}

impl TryFrom<Vec<Vec<f64>>> for RowMatrix {
    type Error = Error;

    fn try_from(rows: Vec<Vec<f64>>) -> Result<Self> {
        let cols = rows.first().map_or(0, Vec::len);
        if let Some(ragged) = rows.iter().find(|r| r.len() != cols) {
            return Err(Error::Shape {
                what: "a row",
                expected: (1, cols),
                found: (1, ragged.len()),
            });
        }
        Ok(Self {
            rows: rows.len(),
            cols,
            data: rows.concat(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_products_match_the_definition() {
        for (rows, cols) in [
            (1, 1),
            (3, 7),
            (8, 8),
            (20, 200),
            (200, 20),
            (13, 31),
            (45, 3),
            (0, 4),
            (4, 0),
        ] {
            let a = RowMatrix::from_fn(rows, cols, |i, j| ((i * 7 + j * 3) % 11) as f64 - 5.0);
            let x: Vec<f64> = (0..cols).map(|j| (j as f64 * 0.37).sin()).collect();
            let z: Vec<f64> = (0..rows).map(|i| (i as f64 * 0.91).cos()).collect();
            let (mut y, mut w) = (vec![1.0; rows], vec![2.0; cols]);
            a.mul_into(&x, &mut y);
            a.mul_transposed_into(&z, &mut w);
            for (i, y) in y.iter().enumerate() {
                let exact: f64 = (0..cols).map(|j| a.row(i)[j] * x[j]).sum();
                assert!((y - exact).abs() < 1e-12);
            }
            for (j, w) in w.iter().enumerate() {
                let exact: f64 = (0..rows).map(|i| a.row(i)[j] * z[i]).sum();
                assert!((w - exact).abs() < 1e-12);
            }
            let prepared = PreparedMatrix::new(a.to_mat().as_ref());
            let mut z = vec![f64::NAN; rows];
            prepared.mul_into(&x, &mut z);
            prepared.mul_add_into(&x, &mut z);
            assert!(y.iter().zip(&z).all(|(y, z)| (2.0 * y - z).abs() < 1e-12));
            assert_eq!((prepared.rows(), prepared.cols()), (rows, cols));

            a.mul_add_into(&x, &mut y);
            a.mul_scaled_add_into(-2.0, &x, &mut y);
            assert!(y.iter().all(|v| v.abs() < 1e-12), "{y:?}");
        }
    }

    #[test]
    fn val_ragged_rows_are_refused_and_rows_round_trip() {
        let ragged = vec![vec![1.0, 2.0], vec![3.0]];
        assert_eq!(
            from_rows(&ragged).err(),
            Some(Error::Shape {
                what: "a row",
                expected: (1, 2),
                found: (1, 1)
            })
        );
        let rows = vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.0]];
        assert_eq!(to_rows(from_rows(&rows).unwrap().as_ref()), rows);
        assert_eq!(
            Vec::<Vec<f64>>::from(RowMatrix::try_from(rows.clone()).unwrap()),
            rows
        );
    }
}
