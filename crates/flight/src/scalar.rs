//! The number type of the equations of motion: `f64` to simulate, dual numbers to differentiate exactly.

use albatross_numerics::matrix::RowMatrix;
use num_dual::{Dual64, DualNum};

/// A number on which the equations of motion are evaluated.
pub trait Scalar: DualNum<Primitive = f64> + Copy {
    /// `y = A x`.
    fn multiply(matrix: &RowMatrix, x: &[Self], y: &mut [Self]);

    /// `y = y + s A x`.
    fn multiply_add(scale: Self, matrix: &RowMatrix, x: &[Self], y: &mut [Self]);

    /// `y = A^T x`.
    fn multiply_transposed(matrix: &RowMatrix, x: &[Self], y: &mut [Self]);
}

impl Scalar for f64 {
    fn multiply(matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        matrix.mul_into(x, y);
    }

    fn multiply_add(scale: Self, matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        matrix.mul_scaled_add_into(scale, x, y);
    }

    fn multiply_transposed(matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        matrix.mul_transposed_into(x, y);
    }
}

impl Scalar for Dual64 {
    fn multiply(matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        y.iter_mut()
            .take(matrix.rows())
            .for_each(|y| *y = Self::from(0.0));
        Self::multiply_add(Self::from(1.0), matrix, x, y);
    }

    fn multiply_add(scale: Self, matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        for (i, y) in y.iter_mut().enumerate().take(matrix.rows()) {
            let sum = matrix
                .row(i)
                .iter()
                .zip(x)
                .fold(Self::from(0.0), |sum, (&a, &x)| sum + x * a);
            *y += scale * sum;
        }
    }

    fn multiply_transposed(matrix: &RowMatrix, x: &[Self], y: &mut [Self]) {
        y.iter_mut().for_each(|y| *y = Self::from(0.0));
        for (i, &x) in x.iter().enumerate().take(matrix.rows()) {
            for (y, &a) in y.iter_mut().zip(matrix.row(i)) {
                *y += x * a;
            }
        }
    }
}
