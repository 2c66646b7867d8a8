//! Sizes and numbers that the public functions refuse.

use crate::Error;
use albatross_numerics::Mat;

/// Refuses a matrix with another number of rows than there are strips.
pub(crate) fn ensure_rows(what: &'static str, matrix: &Mat<f64>, rows: usize) -> Result<(), Error> {
    if matrix.nrows() == rows {
        return Ok(());
    }
    Err(Error::Shape {
        what,
        expected: (rows, matrix.ncols()),
        found: (matrix.nrows(), matrix.ncols()),
    })
}

/// Refuses a matrix of another size.
pub(crate) fn ensure_shape(
    what: &'static str,
    matrix: &Mat<f64>,
    expected: (usize, usize),
) -> Result<(), Error> {
    let found = (matrix.nrows(), matrix.ncols());
    if found == expected {
        return Ok(());
    }
    Err(Error::Shape {
        what,
        expected,
        found,
    })
}

/// Refuses NaN and infinities.
pub(crate) fn ensure_finite_entries(what: &'static str, matrix: &Mat<f64>) -> Result<(), Error> {
    for column in 0..matrix.ncols() {
        if let Some(row) = (0..matrix.nrows()).find(|&row| !matrix[(row, column)].is_finite()) {
            return Err(Error::NotFinite { what, row, column });
        }
    }
    Ok(())
}

/// Refuses a flow quantity that is negative or not finite.
pub(crate) fn ensure_not_negative(quantity: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(Error::BadFlow { quantity, value })
}
