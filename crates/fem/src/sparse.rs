//! Symmetric sparse matrices: lower triangle by columns.

use albatross_numerics::Mat;

use crate::error::Error;

/// Number of contributions from which on repeated ones are summed before all are there: a mass at the reference grid of
/// an RBE3 gives many to each pair of the averaged grids.
const MANY: usize = 1 << 22;

/// Contributions to a symmetric matrix, the lower triangle only. Repeated entries add.
#[derive(Debug)]
pub(crate) struct Triplets {
    entries: Vec<(u32, u32, f64)>,
    /// Number at which repeated entries are summed: twice what the last sum left.
    limit: usize,
}

impl Default for Triplets {
    fn default() -> Self {
        Self {
            entries: Vec::new(),
            limit: MANY,
        }
    }
}

impl Triplets {
    /// Adds to entry (row, column) if it is in the lower triangle.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        if row >= column && value != 0.0 {
            if self.entries.len() >= self.limit {
                self.sum_repeated();
            }
            self.entries.push((row as u32, column as u32, value));
        }
    }

    /// One entry for each place. The sort is stable, so that a place sums in the order in which it was added to, and
    /// the matrix is the same to the bit whenever this happens.
    fn sum_repeated(&mut self) {
        self.entries.sort_by_key(|e| (e.1, e.0));
        self.entries.dedup_by(|next, sum| {
            let same = (next.0, next.1) == (sum.0, sum.1);
            if same {
                sum.2 += next.2;
            }
            same
        });
        self.entries.shrink_to_fit();
        self.limit = self.limit.max(2 * self.entries.len());
    }
}

/// A symmetric matrix of which the lower triangle with the diagonal is stored by columns, rows ascending. Every
/// diagonal entry is stored.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Symmetric {
    pub(crate) columns: Vec<usize>,
    pub(crate) rows: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Symmetric {
    /// Sums triplets to a matrix of order n. A counting sort by row, then by column, leaves columns in order.
    pub(crate) fn new(n: usize, mut triplets: Triplets) -> Self {
        if triplets.entries.len() >= MANY {
            triplets.sum_repeated();
        }
        let mut entries = triplets.entries;
        entries.reserve_exact(n);
        entries.extend((0..n as u32).map(|i| (i, i, 0.0)));
        let by_row = counting_sort(n, &entries, |e| e.0 as usize);
        drop(entries);
        let sorted = counting_sort(n, &by_row, |e| e.1 as usize);
        drop(by_row);
        let mut matrix = Self {
            columns: Vec::with_capacity(n + 1),
            rows: Vec::with_capacity(sorted.len()),
            values: Vec::with_capacity(sorted.len()),
        };
        matrix.columns.push(0);
        let mut last = None;
        for (row, column, value) in sorted {
            if last == Some((row, column)) {
                if let Some(v) = matrix.values.last_mut() {
                    *v += value;
                }
                continue;
            }
            while matrix.columns.len() <= column as usize {
                matrix.columns.push(matrix.rows.len());
            }
            matrix.rows.push(row as usize);
            matrix.values.push(value);
            last = Some((row, column));
        }
        while matrix.columns.len() <= n {
            matrix.columns.push(matrix.rows.len());
        }
        matrix
    }

    /// Order.
    #[must_use]
    pub fn order(&self) -> usize {
        self.columns.len().saturating_sub(1)
    }

    /// Number of stored entries of the lower triangle.
    #[must_use]
    pub fn stored(&self) -> usize {
        self.values.len()
    }

    /// The diagonal.
    #[must_use]
    pub fn diagonal(&self) -> Vec<f64> {
        let first = self.columns.iter().take(self.order());
        first
            .map(|&at| self.values.get(at).copied().unwrap_or(0.0))
            .collect()
    }

    /// Stored entries (row, column, value) of the lower triangle, column by column.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.columns.windows(2).enumerate().flat_map(move |(j, w)| {
            let range = w[0]..w[1];
            let rows = self.rows.get(range.clone()).unwrap_or_default();
            let values = self.values.get(range).unwrap_or_default();
            rows.iter().zip(values).map(move |(&i, &v)| (i, j, v))
        })
    }

    /// y = A x.
    ///
    /// # Errors
    /// [`Error::BadOption`] for a vector whose length is not the order.
    pub fn apply(&self, x: &[f64]) -> Result<Vec<f64>, Error> {
        Error::refuse_length(x.len(), self.order())?;
        Ok(self.product(x))
    }

    /// A x of a vector that is known to have the length of the order.
    pub(crate) fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.order()];
        self.add_product(x, &mut y);
        y
    }

    /// y += A x.
    pub(crate) fn add_product(&self, x: &[f64], y: &mut [f64]) {
        for (j, w) in self.columns.windows(2).enumerate() {
            let xj = x[j];
            let mut sum = 0.0;
            for (&i, &v) in self.rows[w[0]..w[1]].iter().zip(&self.values[w[0]..w[1]]) {
                if i == j {
                    sum += v * xj;
                } else {
                    y[i] += v * xj;
                    sum += v * x[i];
                }
            }
            y[j] += sum;
        }
    }

    /// A X, column by column.
    pub(crate) fn apply_columns(&self, x: &Mat<f64>) -> Mat<f64> {
        let mut y = Mat::zeros(self.order(), x.ncols());
        for k in 0..x.ncols() {
            let (from, to) = (x.col(k), y.col_mut(k));
            if let (Some(from), Some(to)) = (from.try_as_col_major(), to.try_as_col_major_mut()) {
                self.add_product(from.as_slice(), to.as_slice_mut());
            }
        }
        y
    }

    /// Rows and columns of an ascending list; `position[i]` is the place of i in it, or none.
    pub(crate) fn part(&self, size: usize, position: &[Option<usize>]) -> Self {
        let mut triplets = Triplets::default();
        for (i, j, v) in self.entries() {
            if let (Some(p), Some(q)) = (position[i], position[j]) {
                triplets.add(p, q, v);
            }
        }
        Self::new(size, triplets)
    }

    /// a A + b B on the union of both patterns.
    pub(crate) fn combined(&self, a: f64, other: &Self, b: f64) -> Self {
        let n = self.order();
        let mut sum = Self {
            columns: vec![0],
            rows: Vec::with_capacity(self.stored()),
            values: Vec::with_capacity(self.stored()),
        };
        for j in 0..n {
            let (mut p, p_end) = (self.columns[j], self.columns[j + 1]);
            let (mut q, q_end) = (other.columns[j], other.columns[j + 1]);
            while p < p_end || q < q_end {
                let row_p = if p < p_end { self.rows[p] } else { usize::MAX };
                let row_q = if q < q_end { other.rows[q] } else { usize::MAX };
                let row = row_p.min(row_q);
                let mut value = 0.0;
                if row_p == row {
                    value += a * self.values[p];
                    p += 1;
                }
                if row_q == row {
                    value += b * other.values[q];
                    q += 1;
                }
                sum.rows.push(row);
                sum.values.push(value);
            }
            sum.columns.push(sum.rows.len());
        }
        sum
    }
}

fn counting_sort(
    n: usize,
    entries: &[(u32, u32, f64)],
    key: impl Fn(&(u32, u32, f64)) -> usize,
) -> Vec<(u32, u32, f64)> {
    let mut next = vec![0_usize; n + 1];
    for e in entries {
        next[key(e) + 1] += 1;
    }
    for i in 0..n {
        next[i + 1] += next[i];
    }
    let mut sorted = vec![(0, 0, 0.0); entries.len()];
    for e in entries {
        let at = &mut next[key(e)];
        sorted[*at] = *e;
        *at += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_sums_and_products() {
        let mut t = Triplets::default();
        for (i, j, v) in [(2, 0, 1.0), (0, 0, 4.0), (2, 0, 2.0), (1, 2, 9.0), (2, 1, -1.0)] {
            t.add(i, j, v);
        }
        let a = Symmetric::new(3, t);
        let entries: Vec<_> = a.entries().collect();
        assert_eq!(
            entries,
            [(0, 0, 4.0), (2, 0, 3.0), (1, 1, 0.0), (2, 1, -1.0), (2, 2, 0.0)]
        );
        assert_eq!(a.product(&[1.0, 2.0, 3.0]), [13.0, -3.0, 1.0]);
        assert_eq!(a.diagonal(), [4.0, 0.0, 0.0]);
        let b = a.combined(2.0, &a, -1.0);
        assert_eq!(b.entries().collect::<Vec<_>>(), entries);
    }

    /// Many contributions to few places take the room of the places, and sum to the same bits.
    #[test]
    fn regress_repeated_entries_take_no_room() {
        let (mut all, mut few) = (Triplets::default(), Triplets::default());
        few.limit = 50;
        let mut longest = 0;
        for k in 0..5000_usize {
            let value = (k as f64 * 0.7).sin() * 10f64.powi((k % 9) as i32);
            for t in [&mut all, &mut few] {
                t.add(k * 7 % 5, k * 3 % 7, value);
            }
            longest = longest.max(few.entries.len());
        }
        assert_eq!(longest, 50);
        assert_eq!(Symmetric::new(7, few), Symmetric::new(7, all));
    }
}
