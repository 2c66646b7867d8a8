//! The constant matrices of the equations, stored by columns for products with vectors of any [`Scalar`].
//!
//! Eight columns are added to the result at a time: every operation is on whole columns, which the compiler turns into
//! packed arithmetic, and no row needs a sum across its entries. The order of the additions is fixed.

use crate::scalar::Scalar;

/// A matrix of numbers for products in the time loop; nothing is allocated after construction.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnMatrix {
    rows: usize,
    data: Vec<f64>,
}

impl ColumnMatrix {
    /// Matrix with entry `f(row, column)`.
    pub(crate) fn from_fn(rows: usize, columns: usize, f: impl Fn(usize, usize) -> f64) -> Self {
        let data = (0..columns)
            .flat_map(|j| (0..rows).map(move |i| (i, j)))
            .map(|(i, j)| f(i, j))
            .collect();
        Self { rows, data }
    }

    /// `y = A x`, with `x` as long as there are columns and `y` as there are rows.
    pub(crate) fn multiply<T: Scalar>(&self, x: &[T], y: &mut [T]) {
        y.iter_mut().for_each(|y| *y = T::from(0.0));
        self.multiply_add(x, y);
    }

    /// `y = y + A x`.
    pub(crate) fn multiply_add<T: Scalar>(&self, x: &[T], y: &mut [T]) {
        debug_assert_eq!((x.len() * self.rows, y.len()), (self.data.len(), self.rows));
        let (eights, rest) = x.as_chunks::<8>();
        let (fours, ones) = rest.as_chunks::<4>();
        let (of_eights, data) = self.data.split_at(eights.len() * 8 * self.rows);
        let (of_fours, of_ones) = data.split_at(fours.len() * 4 * self.rows);
        let rows = self.rows.max(1);
        for (x, columns) in eights.iter().zip(of_eights.chunks_exact(8 * rows)) {
            add_columns(columns, x, y);
        }
        for (x, columns) in fours.iter().zip(of_fours.chunks_exact(4 * rows)) {
            add_columns(columns, x, y);
        }
        for (x, column) in ones.iter().zip(of_ones.chunks_exact(rows)) {
            add_columns(column, &[*x], y);
        }
    }
}

/// `y = y + sum_k x_k column_k`, the sum by halves.
#[inline(always)]
fn add_columns<T: Scalar, const K: usize>(columns: &[f64], x: &[T; K], y: &mut [T]) {
    let rows = columns.len() / K;
    let y = &mut y[..rows];
    let columns: [&[f64]; K] = std::array::from_fn(|k| &columns[k * rows..][..rows]);
    for (i, y) in y.iter_mut().enumerate() {
        let mut terms: [T; K] = std::array::from_fn(|k| x[k] * columns[k][i]);
        let mut half = K / 2;
        while half > 0 {
            for k in 0..half {
                let other = terms[k + half];
                terms[k] += other;
            }
            half /= 2;
        }
        *y += terms[0];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;

    /// The definition, for all remainders of eight columns; a dual number carries the product with its derivative.
    #[test]
    fn val_products_match_the_definition() {
        for (rows, columns) in [(0, 3), (1, 1), (3, 0), (5, 7), (26, 40), (6, 21), (196, 15)] {
            let entry = |i: usize, j: usize| ((i * 7 + j * 3) % 11) as f64 - 5.0;
            let a = ColumnMatrix::from_fn(rows, columns, entry);
            let x: Vec<f64> = (0..columns).map(|j| (j as f64 * 0.37).sin()).collect();
            let slope: Vec<f64> = (0..columns).map(|j| (j as f64 * 0.91).cos()).collect();
            let dual: Vec<Dual64> = x.iter().zip(&slope).map(|(&x, &d)| Dual64::new(x, d)).collect();
            let (mut y, mut z) = (vec![1.0; rows], vec![Dual64::from(2.0); rows]);
            a.multiply_add(&x, &mut y);
            a.multiply(&dual, &mut z);
            for i in 0..rows {
                let product = |v: &[f64]| (0..columns).map(|j| entry(i, j) * v[j]).sum::<f64>();
                assert!((y[i] - 1.0 - product(&x)).abs() < 1e-12);
                assert!((z[i].re - product(&x)).abs() < 1e-12);
                assert!((z[i].eps - product(&slope)).abs() < 1e-12);
            }
        }
    }
}
