//! Lowest eigenvalues of K x = lambda M x by block Lanczos iteration on the shifted inverse.
//!
//! ```text
//! (K - sigma M)^-1 M x = theta x,    theta = 1/(lambda - sigma)
//! ```
//!
//! with sigma below the spectrum, so that K - sigma M is positive definite and the lowest lambda are the largest
//! theta (Ericsson and Ruhe, Math. Comp. 35, 1980; Grimes, Lewis and Simon, SIAM J. Matrix Anal. 15, 1994). The basis
//! is kept M-orthonormal against all earlier blocks by two Gram-Schmidt passes. M may be singular: vectors without
//! mass are purged because every basis block, and every result, is a product of the operator.
//!
//! Equations: THEORY (44).

use albatross_numerics::Mat;
use albatross_numerics::faer::linalg::matmul::matmul;
use albatross_numerics::faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use albatross_numerics::faer::{Accum, ColRef, MatRef, Par, Side};

use crate::error::Error;
use crate::factor::Factor;
use crate::pencil::random_block;
use crate::sparse::Symmetric;

/// Relative residual of theta at which a pair has converged. The error of theta is its square over the gap, and the
/// last product of the operator takes more off the error of the vector.
const TOLERANCE: f64 = 1e-8;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Wanted {
    /// This many of the lowest modes.
    Count(usize),
    /// All below an eigenvalue, and no more than a count.
    Below(f64, usize),
}

/// Converged pairs in ascending lambda.
#[derive(Debug)]
pub(crate) struct Pairs {
    pub(crate) eigenvalues: Vec<f64>,
    /// M-orthonormal vectors, columns.
    pub(crate) vectors: Mat<f64>,
    /// The modes are all that the mass matrix admits.
    pub(crate) exhausted: bool,
}

/// A block iteration: the basis so far and the projected operator.
struct Krylov<'a> {
    factor: &'a Factor<'a>,
    stiffness: &'a Symmetric,
    sigma: f64,
    mass: &'a Symmetric,
    /// Columns in use: `size`.
    basis: Mat<f64>,
    size: usize,
    /// Upper triangle of V^T M A^-1 M V, `projected[j]` being column j.
    projected: Vec<Vec<f64>>,
}

/// `start`: vectors to begin with, a product of the operator. Their number is the block size.
pub(crate) fn lowest(
    factor: &Factor<'_>,
    (stiffness, mass): (&Symmetric, &Symmetric),
    sigma: f64,
    start: Mat<f64>,
    wanted: Wanted,
) -> Result<Pairs, Error> {
    let n = mass.order();
    let block_size = start.ncols();
    let count = match wanted {
        Wanted::Count(count) | Wanted::Below(_, count) => count.min(n),
    };
    let mut krylov = Krylov {
        factor,
        stiffness,
        sigma,
        mass,
        basis: Mat::zeros(n, (2 * count.min(200) + 6 * block_size).min(n + block_size)),
        size: 0,
        projected: Vec::new(),
    };
    let (mut block, _) = krylov.orthonormalise(start);
    let mut steps = 0;
    let mut next_check = count + count / 2;
    loop {
        let first = krylov.size;
        krylov.append(&block);
        let (mut next, mut coupling) = krylov.advance(first);
        steps += 1;
        if next.ncols() == 0 && krylov.size < n {
            // The basis is invariant; what it lacks is found from another start.
            next = krylov.fresh(block_size, steps);
            coupling = Mat::zeros(next.ncols(), krylov.size - first);
        }
        let exhausted = next.ncols() == 0 || krylov.size >= n;
        if exhausted || krylov.size >= next_check {
            next_check = krylov.size + (2 * block_size).max(krylov.size / 8);
            let (theta, vectors) = krylov.ritz()?;
            let converged = converged_count(&theta, &vectors, &coupling, first, exhausted);
            let lambda = |k: usize| sigma + 1.0 / theta[k];
            let enough = match wanted {
                Wanted::Count(count) => (converged >= count).then_some(count),
                Wanted::Below(limit, count) if converged >= count => {
                    Some((0..count).take_while(|&k| lambda(k) <= limit).count())
                }
                Wanted::Below(limit, _) => {
                    let below = (0..converged).take_while(|&k| lambda(k) <= limit).count();
                    (below < converged).then_some(below)
                }
            };
            let all = match wanted {
                Wanted::Count(count) => converged.min(count),
                Wanted::Below(limit, count) => (0..converged.min(count))
                    .take_while(|&k| lambda(k) <= limit)
                    .count(),
            };
            if let Some(found) = enough.or(exhausted.then_some(all)) {
                let vectors = krylov.purged(&theta, vectors.as_ref().subcols(0, found));
                return Ok(Pairs {
                    eigenvalues: (0..found).map(lambda).collect(),
                    vectors,
                    exhausted: exhausted && enough.is_none(),
                });
            }
            if krylov.size > 20 * count + 400 {
                return Err(Error::NotConverged {
                    wanted: count,
                    converged,
                    steps,
                });
            }
        }
        block = next;
    }
}

/// The number of leading pairs whose residual is small: |R s| for the last rows s of a Ritz vector. Pairs of theta
/// near rounding of the largest are motions without mass.
fn converged_count(
    theta: &[f64],
    vectors: &Mat<f64>,
    coupling: &Mat<f64>,
    first: usize,
    exhausted: bool,
) -> usize {
    let largest = theta.first().copied().unwrap_or(0.0);
    let residual = |k: usize| {
        let mut sum = 0.0;
        for i in 0..coupling.nrows() {
            let row: f64 = (0..coupling.ncols())
                .map(|j| coupling[(i, j)] * vectors[(first + j, k)])
                .sum();
            sum += row * row;
        }
        sum.sqrt()
    };
    (0..theta.len())
        .take_while(|&k| theta[k] > 1e-13 * largest && (exhausted || residual(k) <= TOLERANCE * theta[k]))
        .count()
}

impl Krylov<'_> {
    /// A^-1 M X.
    fn operator(&self, x: &Mat<f64>) -> Mat<f64> {
        let mut y = self.mass.apply_columns(x);
        self.factor.solve_in_place(&mut y);
        y
    }

    fn vectors(&self) -> MatRef<'_, f64> {
        self.basis.as_ref().subcols(0, self.size)
    }

    /// A block outside the basis; empty if the basis holds every motion with mass.
    fn fresh(&self, columns: usize, seed: usize) -> Mat<f64> {
        let mut w = self.operator(&random_block(self.mass.order(), columns, seed as u64));
        let mw = self.mass.apply_columns(&w);
        for k in 0..w.ncols() {
            let norm: f64 = w.col(k).iter().zip(mw.col(k).iter()).map(|(a, b)| a * b).sum();
            if norm > 0.0 {
                let scale = self.largest_theta() / norm.sqrt();
                w.col_mut(k).iter_mut().for_each(|v| *v *= scale);
            }
        }
        for _ in 0..2 {
            self.remove_basis(&mut w);
        }
        self.orthonormalise(w).0
    }

    fn append(&mut self, block: &Mat<f64>) {
        let needed = self.size + block.ncols();
        if needed > self.basis.ncols() {
            let grown = (needed + self.basis.ncols() / 2).max(needed);
            self.basis.resize_with(self.basis.nrows(), grown, |_, _| 0.0);
        }
        self.basis
            .as_mut()
            .subcols_mut(self.size, block.ncols())
            .copy_from(block);
        self.size = needed;
    }

    /// Applies the operator to the block that begins at `first`; returns the next block and its coupling R with it.
    fn advance(&mut self, first: usize) -> (Mat<f64>, Mat<f64>) {
        let block = self.basis.as_ref().subcols(first, self.size - first).to_owned();
        let mut w = self.operator(&block);
        let mut h = Mat::zeros(self.size, w.ncols());
        for _ in 0..2 {
            h += self.remove_basis(&mut w);
        }
        for j in 0..w.ncols() {
            self.projected.push((0..=first + j).map(|i| h[(i, j)]).collect());
        }
        self.orthonormalise(w)
    }

    /// w -= V (V^T M w); returns the coefficients.
    fn remove_basis(&self, w: &mut Mat<f64>) -> Mat<f64> {
        let mw = self.mass.apply_columns(w);
        let mut h = Mat::zeros(self.size, w.ncols());
        let v = self.vectors();
        matmul(
            h.as_mut(),
            Accum::Replace,
            v.transpose(),
            mw.as_ref(),
            1.0,
            Par::Seq,
        );
        matmul(w.as_mut(), Accum::Add, v, h.as_ref(), -1.0, Par::Seq);
        h
    }

    /// W = Q R with Q^T M Q = 1; directions that are rounding noise of W are dropped. Q is made orthogonal to the
    /// basis and to itself a second time, because the first pass amplifies noise: a column that then loses most of its
    /// length was noise.
    fn orthonormalise(&self, w: Mat<f64>) -> (Mat<f64>, Mat<f64>) {
        let floor = 1e-12 * self.largest_theta();
        let (mut q, r) = self.gram_schmidt(w, floor);
        if q.ncols() == 0 {
            return (q, r);
        }
        if self.size > 0 {
            self.remove_basis(&mut q);
        }
        let (q, again) = self.gram_schmidt(q, 0.3);
        let product = &again * &r;
        (q, product)
    }

    /// What the operator makes of a unit vector, about; 0 before the first block.
    fn largest_theta(&self) -> f64 {
        self.projected
            .first()
            .and_then(|c| c.first())
            .copied()
            .unwrap_or(0.0)
    }

    /// Gram-Schmidt by columns in the inner product of M, each column twice. Columns that are left with less than
    /// `floor` (with 0: than 1e-13 of the longest) are dropped, and those whose little mass is rounding.
    fn gram_schmidt(&self, mut w: Mat<f64>, floor: f64) -> (Mat<f64>, Mat<f64>) {
        let (n, b) = (w.nrows(), w.ncols());
        let mut r = Mat::zeros(b, b);
        let mut kept = 0;
        let mut longest = 0.0_f64;
        let mut product = vec![0.0; n];
        let dot = |a: ColRef<'_, f64>, b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for j in 0..b {
            let mut column: Vec<f64> = w.col(j).iter().copied().collect();
            let mut before = None;
            for _ in 0..2 {
                product.fill(0.0);
                self.mass.add_product(&column, &mut product);
                before.get_or_insert(length(&column, &product));
                for i in 0..kept {
                    let c = dot(w.col(i), &product);
                    r[(i, j)] += c;
                    column
                        .iter_mut()
                        .zip(w.col(i).iter())
                        .for_each(|(x, q)| *x -= c * q);
                }
            }
            product.fill(0.0);
            self.mass.add_product(&column, &mut product);
            longest = longest.max(before.unwrap_or(0.0));
            let norm = length(&column, &product);
            let limit = if floor > 0.0 { floor } else { 1e-13 * longest };
            if norm <= limit || !norm.is_normal() || !self.is_massive(&column, norm) {
                continue;
            }
            r[(kept, j)] = norm;
            w.col_mut(kept)
                .iter_mut()
                .zip(&column)
                .for_each(|(q, x)| *q = x / norm);
            kept += 1;
        }
        (w.subcols(0, kept).to_owned(), r.subrows(0, kept).to_owned())
    }

    /// Whether the M-norm of a short vector is more than rounding: its Rayleigh quotient tells.
    fn is_massive(&self, x: &[f64], norm: f64) -> bool {
        let theta = self.largest_theta();
        if norm >= 1e-6 * theta {
            return true;
        }
        let kx = self.stiffness.product(x);
        let strain: f64 = x.iter().zip(&kx).map(|(x, k)| x * k).sum();
        let mass = norm * norm;
        mass > 1e-12 * theta * (strain - self.sigma * mass)
    }

    /// Eigenvalues of the projected operator, largest first, and its eigenvectors.
    fn ritz(&self) -> Result<(Vec<f64>, Mat<f64>), Error> {
        let m = self.size;
        if m == 0 {
            // Nothing of the start was left: the library takes no empty matrix.
            return Err(Error::EmptyModel {
                problem: "no motion of the model has positive mass and stiffness; correct negative masses and inertias"
                    .into(),
            });
        }
        let t = Mat::from_fn(m, m, |i, j| self.projected[i.max(j)][i.min(j)]);
        let eigen = t
            .self_adjoint_eigen(Side::Lower)
            .map_err(|e| Error::Factorisation {
                what: "projected matrix",
                reason: format!("{e:?}"),
            })?;
        let theta = (0..m).rev().map(|k| eigen.S()[k]).collect();
        let u = eigen.U();
        Ok((theta, Mat::from_fn(m, m, |i, k| u[(i, m - 1 - k)])))
    }

    /// Vectors of the leading pairs after one more product of the operator, normalised to x^T M x = 1.
    fn purged(&self, theta: &[f64], ritz: MatRef<'_, f64>) -> Mat<f64> {
        let x = self.vectors() * ritz;
        let mut x = self.operator(&x);
        let mx = self.mass.apply_columns(&x);
        for (k, theta) in theta.iter().enumerate().take(x.ncols()) {
            let mass: f64 = x.col(k).iter().zip(mx.col(k).iter()).map(|(a, b)| a * b).sum();
            let scale = if mass > 0.0 {
                1.0 / mass.sqrt()
            } else {
                1.0 / theta
            };
            x.col_mut(k).iter_mut().for_each(|v| *v *= scale);
        }
        // The product magnifies what rounding left of lower modes in higher ones; with X^T M X = L L^T, X L^-T takes
        // it out and leaves the lower ones as they are.
        let gram = x.transpose() * self.mass.apply_columns(&x);
        if let Ok(l) = gram.llt(Side::Lower) {
            let mut rows = x.transpose().to_owned();
            solve_lower_triangular_in_place(l.L(), rows.as_mut(), Par::Seq);
            return rows.transpose().to_owned();
        }
        x
    }
}

/// sqrt(x^T M x) from x and M x.
fn length(x: &[f64], mx: &[f64]) -> f64 {
    x.iter().zip(mx).map(|(a, b)| a * b).sum::<f64>().max(0.0).sqrt()
}

/// A few products of the operator on a block, with Rayleigh-Ritz: a start for [`lowest`], and estimates of the
/// lowest eigenvalues, ascending (upper bounds).
pub(crate) fn subspace(
    factor: &Factor<'_>,
    (stiffness, mass): (&Symmetric, &Symmetric),
    sigma: f64,
    start: Mat<f64>,
    steps: usize,
) -> Result<(Mat<f64>, Vec<f64>), Error> {
    let mut krylov = Krylov {
        factor,
        stiffness,
        sigma,
        mass,
        basis: Mat::zeros(mass.order(), 0),
        size: 0,
        projected: Vec::new(),
    };
    // The first product takes the start out of the null space of M.
    let purged = krylov.operator(&start);
    let (mut block, _) = krylov.orthonormalise(purged);
    let mut estimates = Vec::new();
    for _ in 0..steps {
        krylov.size = 0;
        krylov.projected.clear();
        krylov.append(&block);
        let (theta, w) = {
            let w = krylov.operator(&block);
            let mw = mass.apply_columns(&w);
            let b = block.ncols();
            let t = block.transpose() * &mw;
            krylov.projected = (0..b)
                .map(|j| (0..=j).map(|i| 0.5 * (t[(i, j)] + t[(j, i)])).collect())
                .collect();
            let (theta, u) = krylov.ritz()?;
            (theta, &w * &u)
        };
        estimates = theta
            .iter()
            .filter(|&&t| t > 0.0)
            .map(|t| sigma + 1.0 / t)
            .collect();
        krylov.size = 0;
        krylov.projected.clear();
        (block, _) = krylov.orthonormalise(w);
    }
    Ok((block, estimates))
}
