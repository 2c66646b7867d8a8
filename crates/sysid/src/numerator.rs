//! Numerators with fewer zeros than poles less one.
//!
//! A sum of fractions with np poles has np - 1 zeros. For nz of them the first np - nz - 1 Markov parameters vanish,
//! ```text
//! c' A^m b = 0,     m = 0 .. np - nz - 2
//! ```
//! Powers of A lose all digits, so the constraints are taken on an orthonormal basis Q of the same Krylov space
//! (Arnoldi 1951, orthogonalised twice): c is any vector of the complement of Q. With the coefficients of the recursion
//! held fixed, Q(theta) defines the same constraints for every denominator, which gives the derivative of c.
//!
//! Equations: THEORY (30a).

use albatross_numerics::faer::linalg::solvers::Qr;
use albatross_numerics::matrix::dot;
use albatross_numerics::{C64, Mat, eigen};

use crate::Result;
use crate::blocks::{Block, order, state_matrices};

/// Below this share of the vector's length a Krylov direction is nothing new.
const DEPENDENT: f64 = 1e-13;

/// Orthonormal Krylov vectors of (A, b) and the coefficients of their recursion.
struct Krylov {
    vectors: Vec<Vec<f64>>,
    /// h\[m\]: coefficients of A q_m on q_0 .. q_m, then the length of what is left.
    h: Vec<Vec<f64>>,
}

fn krylov(a: &Mat<f64>, b: &[f64], count: usize) -> Krylov {
    let mut found = Krylov {
        vectors: Vec::new(),
        h: Vec::new(),
    };
    let length = dot(b, b).sqrt();
    if count == 0 || length == 0.0 {
        return found;
    }
    found.vectors.push(b.iter().map(|v| v / length).collect());
    while found.vectors.len() < count {
        let Some(last) = found.vectors.last() else { break };
        let mut next = product(a, last);
        let scale = dot(&next, &next).sqrt();
        let mut h = vec![0.0; found.vectors.len()];
        for _ in 0..2 {
            for (q, h) in found.vectors.iter().zip(&mut h) {
                let share = dot(q, &next);
                *h += share;
                next.iter_mut().zip(q).for_each(|(v, q)| *v -= share * q);
            }
        }
        let left = dot(&next, &next).sqrt();
        if left <= DEPENDENT * scale {
            break;
        }
        h.push(left);
        found.h.push(h);
        found.vectors.push(next.iter().map(|v| v / left).collect());
    }
    found
}

fn product(a: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    (0..a.nrows())
        .map(|i| x.iter().enumerate().map(|(j, x)| a[(i, j)] * x).sum())
        .collect()
}

/// Orthonormal basis of the complement of some orthonormal vectors.
fn complement(vectors: &[Vec<f64>], n: usize) -> Mat<f64> {
    let q = Mat::from_fn(n, vectors.len(), |i, j| vectors[j][i]);
    if vectors.is_empty() {
        return Mat::identity(n, n);
    }
    let full = Qr::new(q.as_ref()).compute_Q();
    full.submatrix(0, vectors.len(), n, n - vectors.len()).to_owned()
}

/// The numerator coefficients that a number of zeros leaves free.
#[derive(Debug, Clone)]
pub(crate) struct Freedom {
    /// Basis of the coefficients, poles x free ones; none if all are free.
    basis: Option<Mat<f64>>,
    /// Number of poles.
    n: usize,
}

impl Freedom {
    /// For a denominator and a number of zeros, at most as many as poles.
    pub(crate) fn new(blocks: &[Block], zeros: usize) -> Self {
        let n = order(blocks);
        let excess = (n - 1).saturating_sub(zeros);
        let basis = (excess > 0).then(|| {
            let (a, b) = state_matrices(blocks);
            complement(&krylov(&a, &b, excess).vectors, n)
        });
        Self { basis, n }
    }

    /// Number of free coefficients.
    pub(crate) fn count(&self) -> usize {
        self.basis.as_ref().map_or(self.n, |b| b.ncols())
    }

    /// Combinations of the states that may be added up.
    pub(crate) fn columns(&self, x: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let Some(basis) = &self.basis else { return x };
        (0..basis.ncols())
            .map(|j| combine(&x, |i| basis[(i, j)]))
            .collect()
    }

    /// Coefficients of the states from the free ones.
    pub(crate) fn expand(&self, free: &[f64]) -> Vec<f64> {
        match &self.basis {
            None => free.iter().copied().take(self.n).collect(),
            Some(basis) => (0..self.n)
                .map(|i| (0..basis.ncols()).map(|j| basis[(i, j)] * free[j]).sum())
                .collect(),
        }
    }

    /// Derivative of the coefficients with respect to the free ones, poles x free ones; none if they are the same.
    pub(crate) fn basis(&self) -> Option<&Mat<f64>> {
        self.basis.as_ref()
    }
}

/// Sum of columns with the given factors.
pub(crate) fn combine(columns: &[Vec<f64>], factor: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (i, column) in columns.iter().enumerate() {
        albatross_numerics::matrix::axpy(factor(i), column, &mut sum);
    }
    sum
}

/// How coefficients `c` must change with each parameter of the denominator to keep their number of zeros.
///
/// One vector a parameter, in the order and scaling of [`crate::refine`]; empty if all coefficients are free.
pub(crate) fn tangents(blocks: &[Block], zeros: usize, c: &[f64]) -> Vec<Vec<f64>> {
    let n = order(blocks);
    let excess = (n - 1).saturating_sub(zeros);
    if excess == 0 {
        return Vec::new();
    }
    let (a, b) = state_matrices(blocks);
    let Krylov { vectors, h } = krylov(&a, &b, excess);
    let mut all = Vec::with_capacity(n);
    let mut at = 0;
    for block in blocks {
        let w = block.scale();
        // Each parameter changes one entry of A by -w.
        let entries: &[(usize, usize)] = match block {
            Block::First { .. } => &[(0, 0)],
            Block::Second { .. } => &[(1, 1), (1, 0)],
        };
        for (i, j) in entries {
            let mut dq: Vec<Vec<f64>> = vec![vec![0.0; n]];
            for (m, coefficients) in h.iter().enumerate() {
                let mut next = product(&a, &dq[m]);
                next[at + i] -= w * vectors[m][at + j];
                for (l, dq) in dq.iter().enumerate() {
                    next.iter_mut()
                        .zip(dq)
                        .for_each(|(v, d)| *v -= coefficients[l] * d);
                }
                let length = coefficients[m + 1];
                next.iter_mut().for_each(|v| *v /= length);
                dq.push(next);
            }
            let mut dc = vec![0.0; n];
            for (q, dq) in vectors.iter().zip(&dq) {
                let share = dot(dq, c);
                dc.iter_mut().zip(q).for_each(|(v, q)| *v -= share * q);
            }
            all.push(dc);
        }
        at += block.order();
    }
    all
}

/// The zeros \[rad/s\] of `c' (s I - A)^-1 b + d` with a known number of them.
///
/// With d they are the eigenvalues of A - b c'/d. Without, the output is kept at zero in the complement V of
/// c, A'c, ..: zeros are the eigenvalues of `V' (A - b q' A / (q' b)) V`, q being the last of those vectors.
///
/// # Errors
/// [`crate::Error::Numerics`] when the eigenvalues cannot be found.
pub(crate) fn zeros_of(blocks: &[Block], c: &[f64], d: f64, zeros: usize) -> Result<Vec<C64>> {
    let (a, b) = state_matrices(blocks);
    let n = b.len();
    if zeros == 0 || c.iter().chain([&d]).all(|v| *v == 0.0) {
        return Ok(Vec::new());
    }
    if zeros == n {
        if d == 0.0 {
            return zeros_of(blocks, c, d, n - 1);
        }
        let closed = Mat::from_fn(n, n, |i, j| a[(i, j)] - b[i] * c[j] / d);
        return Ok(eigen::eigenvalues(closed.as_ref())?);
    }
    let found = krylov(&a.transpose().to_owned(), c, n - zeros).vectors;
    let Some(q) = found.last() else {
        return Ok(Vec::new());
    };
    let gain = dot(q, &b);
    let row: Vec<f64> = (0..n)
        .map(|j| (0..n).map(|i| q[i] * a[(i, j)]).sum::<f64>() / gain)
        .collect();
    let closed = Mat::from_fn(n, n, |i, j| a[(i, j)] - b[i] * row[j]);
    let v = complement(&found, n);
    Ok(eigen::eigenvalues((v.transpose() * closed * &v).as_ref())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocks::from_poles;

    fn value(blocks: &[Block], c: &[f64], s: C64) -> C64 {
        let mut at = 0;
        let mut sum = C64::new(0.0, 0.0);
        for block in blocks {
            let x = block.states(s);
            for i in 0..block.order() {
                sum += c[at + i] * x[i];
            }
            at += block.order();
        }
        sum
    }

    fn some_blocks() -> Vec<Block> {
        from_poles(&[
            C64::new(-0.5, 2.0),
            C64::new(-2.0, 20.0),
            C64::new(-1.0, 47.0),
            C64::new(-3.0, 0.0),
        ])
    }

    /// Any free coefficients give the zeros promised: the denominator times G is the numerator with those roots.
    #[test]
    fn val_zeros_are_zeros_and_their_number_holds() {
        let blocks = some_blocks();
        let n = order(&blocks);
        for zeros in 0..n {
            let freedom = Freedom::new(&blocks, zeros);
            assert_eq!(freedom.count(), zeros + 1);
            let free: Vec<f64> = (0..=zeros).map(|i| 1.0 / (1.0 + i as f64)).collect();
            let c = freedom.expand(&free);
            let roots = zeros_of(&blocks, &c, 0.0, zeros).unwrap();
            assert_eq!(roots.len(), zeros);
            let ratio = |s: C64| {
                let denominator: C64 = blocks.iter().map(|b| b.denominator(s)).product();
                let numerator: C64 = roots.iter().map(|z| s - z).product();
                value(&blocks, &c, s) * denominator / numerator
            };
            let (one, two) = (ratio(C64::new(1.0, 9.0)), ratio(C64::new(-7.0, 31.0)));
            assert!((one / two - 1.0).norm() < 1e-8, "{zeros}: {one} {two}");
        }
    }

    #[test]
    fn val_zeros_with_direct_path() {
        let blocks = some_blocks();
        let c: Vec<f64> = (0..7).map(|i| 0.3 * i as f64 - 0.8).collect();
        let roots = zeros_of(&blocks, &c, 0.4, 7).unwrap();
        assert_eq!(roots.len(), 7);
        for z in roots {
            let slope = (value(&blocks, &c, z + 1e-4) - value(&blocks, &c, z - 1e-4)) / 2e-4;
            assert!(((value(&blocks, &c, z) + 0.4) / slope).norm() < 1e-9 * z.norm());
        }
    }

    /// Coefficients moved along the tangent keep the Markov parameters at zero to second order.
    #[test]
    fn val_tangents_keep_the_number_of_zeros() {
        let blocks = some_blocks();
        for zeros in 1..5 {
            let free: Vec<f64> = (0..=zeros).map(|i| 1.0 - 0.4 * i as f64).collect();
            let c = Freedom::new(&blocks, zeros).expand(&free);
            let tangents = tangents(&blocks, zeros, &c);
            let mut parameter = 0;
            for (at, block) in blocks.iter().enumerate() {
                let w = block.scale();
                for which in 0..block.order() {
                    let violation = |step: f64| {
                        let mut moved = blocks.clone();
                        moved[at] = match *block {
                            Block::First { a } => Block::First { a: a + step * w },
                            Block::Second { a1, a0 } if which == 0 => Block::Second {
                                a1: a1 + step * w,
                                a0,
                            },
                            Block::Second { a1, a0 } => Block::Second {
                                a1,
                                a0: a0 + step * w * w,
                            },
                        };
                        // The states keep the scale of the unmoved block: same b, entries of A moved by -w step.
                        let (mut a, b) = state_matrices(&blocks);
                        let start: usize = blocks[..at].iter().map(|b| b.order()).sum();
                        match (block, which) {
                            (Block::First { .. }, _) => a[(start, start)] -= w * step,
                            (_, 0) => a[(start + 1, start + 1)] -= w * step,
                            _ => a[(start + 1, start)] -= w * step,
                        }
                        let c: Vec<f64> = c
                            .iter()
                            .zip(&tangents[parameter])
                            .map(|(c, d)| c + step * d)
                            .collect();
                        let mut x = b;
                        (0..6 - zeros)
                            .map(|_| {
                                let markov = dot(&c, &x) / dot(&x, &x).sqrt();
                                x = product(&a, &x);
                                markov.abs()
                            })
                            .fold(0.0, f64::max)
                    };
                    let (coarse, fine) = (violation(1e-3), violation(1e-4));
                    assert!(
                        coarse < 1e-4 && fine < 0.02 * coarse + 1e-12,
                        "{zeros} {parameter}: {coarse} {fine}"
                    );
                    parameter += 1;
                }
            }
        }
    }
}
