//! Least squares over several experiments and outputs, one kind of unknown after the other.
//!
//! A row of an experiment e and an output o reads
//! ```text
//! y = F f(e, o) + X c(o) + K k
//! ```
//! with unknowns of three ranks: `local` f (initial state, constant), `own` c (the numerator of an output), `shared` k
//! (the denominator). One QR a record drops f, one QR of what is left drops c, and a last one gives k: the cost is that
//! of the longest record times the sum of the columns, however many experiments there are. This is variable projection
//! (Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973) in the order of the structure; all by orthogonal transformations.

use albatross_numerics::solve::{least_squares_with_rank, triangle};
use albatross_numerics::{Mat, MatRef};

use crate::Result;

/// Singular values below this share of the largest, columns scaled to unit norm, count as zero.
const RANK_TOLERANCE: f64 = 1e-12;

/// Matrices of equal width above each other.
fn stack(parts: &[MatRef<'_, f64>]) -> Mat<f64> {
    let rows = parts.iter().map(|p| p.nrows()).sum();
    let mut all = Mat::zeros(rows, parts.first().map_or(0, |p| p.ncols()));
    let mut at = 0;
    for part in parts {
        all.submatrix_mut(at, 0, part.nrows(), part.ncols())
            .copy_from(part);
        at += part.nrows();
    }
    all
}

/// What is left below and right of the first `n` unknowns.
fn rest(a: &Mat<f64>, n: usize) -> MatRef<'_, f64> {
    let rows = n.min(a.nrows());
    a.submatrix(rows, n, a.nrows() - rows, a.ncols() - n)
}

/// The rows of one record: columns local, own, shared, and last the measured value.
#[derive(Debug, Clone)]
pub(crate) struct Record {
    /// Number of local unknowns.
    pub(crate) local: usize,
    pub(crate) matrix: Mat<f64>,
    /// Factor of all rows, the root of the weight.
    pub(crate) factor: f64,
}

/// The reduced problem.
#[derive(Debug, Clone)]
pub(crate) struct Elimination {
    own: usize,
    shared: usize,
    /// Triangles of the records, for each output.
    records: Vec<Vec<(usize, Mat<f64>)>>,
    /// Triangles of the outputs.
    outputs: Vec<Mat<f64>>,
    /// Triangle of the shared unknowns with the measured value.
    trailing: Mat<f64>,
}

/// All unknowns but the shared ones, and what is left of the sum of squares.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unknowns {
    /// By output and experiment.
    pub(crate) local: Vec<Vec<Vec<f64>>>,
    /// By output.
    pub(crate) own: Vec<Vec<f64>>,
    pub(crate) cost: f64,
}

impl Elimination {
    /// Reduces the records, given by output and experiment.
    pub(crate) fn new(own: usize, shared: usize, records: Vec<Vec<Record>>) -> Self {
        let records: Vec<Vec<(usize, Mat<f64>)>> = records
            .into_iter()
            .map(|of_output| {
                of_output
                    .into_iter()
                    .map(|record| {
                        let mut r = triangle(record.matrix);
                        r *= albatross_numerics::faer::Scale(record.factor);
                        (record.local, r)
                    })
                    .collect()
            })
            .collect();
        let outputs: Vec<Mat<f64>> = records
            .iter()
            .map(|of_output| {
                let parts: Vec<MatRef<'_, f64>> = of_output.iter().map(|(n, r)| rest(r, *n)).collect();
                triangle(stack(&parts))
            })
            .collect();
        let parts: Vec<MatRef<'_, f64>> = outputs.iter().map(|r| rest(r, own)).collect();
        let trailing = triangle(stack(&parts));
        Self {
            own,
            shared,
            records,
            outputs,
            trailing,
        }
    }

    /// Coefficients of the shared unknowns with all others at their best, and the measured values: (K, y) of
    /// `min over k of |K k - y|`, as many rows as shared unknowns or fewer.
    pub(crate) fn reduced(&self) -> (Mat<f64>, Vec<f64>) {
        let rows = self.trailing.nrows().min(self.shared);
        let k = self.trailing.submatrix(0, 0, rows, self.shared).to_owned();
        (k, (0..rows).map(|i| self.trailing[(i, self.shared)]).collect())
    }

    /// The other unknowns for given shared ones, and the sum of squares.
    pub(crate) fn solve(&self, shared: &[f64]) -> Result<Unknowns> {
        let mut cost = 0.0;
        for i in 0..self.trailing.nrows() {
            let left: f64 = (0..self.shared).map(|j| self.trailing[(i, j)] * shared[j]).sum();
            cost += (self.trailing[(i, self.shared)] - left).powi(2);
        }
        let mut unknowns = Unknowns {
            cost,
            ..Unknowns::default()
        };
        for (records, output) in self.records.iter().zip(&self.outputs) {
            let own = back_solve(output, self.own, shared)?;
            let known: Vec<f64> = own.iter().chain(shared).copied().collect();
            let local = records
                .iter()
                .map(|(n, r)| back_solve(r, *n, &known))
                .collect::<Result<_>>()?;
            unknowns.own.push(own);
            unknowns.local.push(local);
        }
        Ok(unknowns)
    }
}

/// The first `n` unknowns of a triangle whose other unknowns are known; the least ones where they are not unique.
fn back_solve(r: &Mat<f64>, n: usize, known: &[f64]) -> Result<Vec<f64>> {
    let rows = n.min(r.nrows());
    if rows == 0 {
        return Ok(vec![0.0; n]);
    }
    let last = r.ncols() - 1;
    let right: Vec<f64> = (0..rows)
        .map(|i| {
            r[(i, last)]
                - known
                    .iter()
                    .enumerate()
                    .map(|(j, k)| r[(i, n + j)] * k)
                    .sum::<f64>()
        })
        .collect();
    solve_triangle(r.submatrix(0, 0, rows, n), &right)
}

/// x of min |R x - b| for a triangle that may be singular.
pub(crate) fn solve_triangle(r: MatRef<'_, f64>, b: &[f64]) -> Result<Vec<f64>> {
    let n = r.ncols();
    let norm = |j: usize| {
        (0..=j.min(r.nrows() - 1))
            .map(|i| r[(i, j)].powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let safe = r.nrows() == n && (0..n).all(|j| r[(j, j)].abs() > 1e-6 * norm(j) && r[(j, j)] != 0.0);
    if safe {
        let mut x = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|j| r[(i, j)] * x[j]).sum();
            x[i] = (b[i] - known) / r[(i, i)];
        }
        return Ok(x);
    }
    let right = Mat::from_fn(r.nrows(), 1, |i, _| b[i]);
    let solution = least_squares_with_rank(r, right.as_ref(), RANK_TOLERANCE)?;
    Ok((0..n).map(|i| solution.x[(i, 0)]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use albatross_numerics::solve::least_squares;

    /// Two outputs, three records of different length: the same as one dense least-squares problem.
    #[test]
    fn val_elimination_is_the_dense_solution() {
        let mut random = fastrand::Rng::with_seed(4);
        let (own, shared, lengths, locals) = (3, 2, [9, 14, 6], [2, 0, 3]);
        let mut records = Vec::new();
        for _ in 0..2 {
            let of_output: Vec<Record> = lengths
                .iter()
                .zip(locals)
                .map(|(n, local)| Record {
                    local,
                    matrix: Mat::from_fn(*n, local + own + shared + 1, |_, _| random.f64() - 0.5),
                    factor: 0.3 + random.f64(),
                })
                .collect();
            records.push(of_output);
        }
        let rows: usize = 2 * lengths.iter().sum::<usize>();
        let n_local: usize = locals.iter().sum();
        let columns = 2 * n_local + 2 * own + shared;
        let (mut a, mut b) = (Mat::zeros(rows, columns), Mat::zeros(rows, 1));
        let (mut row, mut at_local) = (0, 0);
        for (o, of_output) in records.iter().enumerate() {
            for record in of_output {
                for i in 0..record.matrix.nrows() {
                    let value = |j: usize| record.factor * record.matrix[(i, j)];
                    for j in 0..record.local {
                        a[(row, at_local + j)] = value(j);
                    }
                    for j in 0..own {
                        a[(row, 2 * n_local + o * own + j)] = value(record.local + j);
                    }
                    for j in 0..shared {
                        a[(row, 2 * n_local + 2 * own + j)] = value(record.local + own + j);
                    }
                    b[(row, 0)] = value(record.local + own + shared);
                    row += 1;
                }
                at_local += record.local;
            }
        }
        let dense = least_squares(a.as_ref(), b.as_ref()).unwrap();
        let residual = &a * &dense - &b;
        let elimination = Elimination::new(own, shared, records);
        let (k, y) = elimination.reduced();
        let k = solve_triangle(k.as_ref(), &y).unwrap();
        let found = elimination.solve(&k).unwrap();
        let x: Vec<f64> = (0..columns).map(|j| dense[(j, 0)]).collect();
        let flat: Vec<f64> = found
            .local
            .concat()
            .concat()
            .into_iter()
            .chain(found.own.concat())
            .chain(k)
            .collect();
        for (found, dense) in flat.iter().zip(&x) {
            assert!((found - dense).abs() < 1e-12);
        }
        assert!((found.cost - residual.squared_norm_l2()).abs() < 1e-13);
    }

    /// Local columns that repeat each other, and one of zeros, must not swallow the residual.
    #[test]
    fn regress_dependent_columns_leave_the_residual() {
        let mut random = fastrand::Rng::with_seed(4);
        let matrix = Mat::from_fn(200, 5, |i, j| match j {
            0 | 1 => 1.0,
            2 => 0.0,
            3 => (0.1 * i as f64).sin(),
            _ => random.f64() - 0.5,
        });
        let reduced = matrix.submatrix(0, 0, 200, 1).to_owned();
        let alone = Mat::from_fn(200, 3, |i, j| match j {
            0 => reduced[(i, 0)],
            _ => matrix[(i, j + 2)],
        });
        let cost = |local: usize, matrix: Mat<f64>| {
            let record = Record {
                local,
                matrix,
                factor: 1.0,
            };
            Elimination::new(1, 0, vec![vec![record]])
                .solve(&[])
                .unwrap()
                .cost
        };
        let (dependent, independent) = (cost(3, matrix), cost(1, alone));
        // A direction of rounding errors is one of two hundred.
        assert!(
            (dependent / independent - 1.0).abs() < 0.1,
            "{dependent} {independent}"
        );
    }

    #[test]
    fn val_singular_triangles_give_the_least_solution() {
        let r = Mat::from_fn(2, 2, |i, _| [1.0, 0.0][i]);
        let x = solve_triangle(r.as_ref(), &[2.0, 0.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 1.0).abs() < 1e-14);
    }
}
