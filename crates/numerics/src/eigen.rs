//! Eigenproblems, balanced before they are solved.
//!
//! The QR algorithm is backward stable with respect to the norm of the whole matrix. In a state matrix whose
//! units differ by 10^8 the small entries that set the phugoid or a flutter margin are then lost in the
//! rounding of the large ones. Balancing by powers of two changes no digit of the input and restores them.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::evd::{self, ComputeEigenvectors};
use faer::linalg::gevd;
use faer::linalg::solvers::{Llt, SelfAdjointEigen};
use faer::{Par, Side};

use crate::matrix::{check_finite, check_shape, max_abs};
use crate::{C64, Error, Mat, MatRef, Result};

/// Balances a square matrix: D^-1 A D with D = diag(scaling), each entry of D a power of two.
///
/// Afterwards the off-diagonal parts of row i and column i have norms within a factor of two of each other
/// wherever both are non-zero. Parlett and Reinsch, Numer. Math. 13 (1969), with the 2-norm of James, Langou
/// and Lowery (2014), which does not over-balance Hessenberg-like matrices.
pub fn balance(a: MatRef<'_, f64>) -> (Mat<f64>, Vec<f64>) {
    const RADIX: f64 = 2.0;
    const WORTHWHILE: f64 = 0.95;
    const SWEEPS: usize = 100;
    let n = a.nrows().min(a.ncols());
    let mut b = a.to_owned();
    let mut scaling = vec![1.0; n];
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..n {
            let column = off_diagonal_norm((0..n).filter(|&k| k != i).map(|k| b[(k, i)]));
            let row = off_diagonal_norm((0..n).filter(|&k| k != i).map(|k| b[(i, k)]));
            if column == 0.0 || row == 0.0 || !(column + row).is_finite() {
                continue;
            }
            // Scaling state i by f multiplies its column by f and divides its row by f.
            let f = RADIX.powi((0.5 * (row / column).log2()).round() as i32);
            let limited = (scaling[i] * f).clamp(1e-290, 1e290) == scaling[i] * f;
            if limited && (column * f).hypot(row / f) < WORTHWHILE * column.hypot(row) {
                scaling[i] *= f;
                for k in 0..n {
                    b[(k, i)] *= f;
                    b[(i, k)] /= f;
                }
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    (b, scaling)
}

/// 2-norm, scaled against overflow.
fn off_diagonal_norm(entries: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = entries.clone().fold(0.0_f64, |m, v| m.max(v.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * entries.map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// Splits off the states that only feed (nothing acts on them in turn) or are only fed.
///
/// Returns an order of the states and the range within it that is left over: in that order the matrix is
/// upper triangular before and after the range, so the diagonal entries there are eigenvalues exactly. This
/// is what makes position, heading and other pure integrators come out as zero and not as rounding noise.
fn isolate(a: MatRef<'_, f64>) -> (Vec<usize>, std::ops::Range<usize>) {
    let n = a.nrows();
    let (mut head, mut core, mut tail) = (Vec::new(), (0..n).collect::<Vec<_>>(), Vec::new());
    loop {
        // A row without entries in the core: its unknown depends on itself alone and goes last.
        if let Some(at) = core
            .iter()
            .position(|&i| core.iter().all(|&j| i == j || a[(i, j)] == 0.0))
        {
            tail.push(core.remove(at));
        // A column without entries in the core: nothing there depends on it, and it goes first.
        } else if let Some(at) = core
            .iter()
            .position(|&j| core.iter().all(|&i| i == j || a[(i, j)] == 0.0))
        {
            head.push(core.remove(at));
        } else {
            break;
        }
    }
    let range = head.len()..head.len() + core.len();
    tail.reverse();
    (head.into_iter().chain(core).chain(tail).collect(), range)
}

/// A matrix whose squares would overflow, and the power of two that takes its eigenvalues back; none for any other.
fn shrunk(a: MatRef<'_, f64>) -> Option<(Mat<f64>, f64)> {
    const LARGEST: f64 = 1e150;
    const FACTOR: f64 = f64::from_bits((1023 + 512) << 52);
    let large = (0..a.ncols()).any(|j| (0..a.nrows()).any(|i| a[(i, j)].abs() > LARGEST));
    large.then(|| {
        (
            Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / FACTOR),
            FACTOR,
        )
    })
}

/// Eigenvalues of a shrunk matrix taken back.
fn regrown(values: &mut [C64], factor: f64, a: MatRef<'_, f64>) -> Result<()> {
    values.iter_mut().for_each(|v| *v *= factor);
    if values.iter().all(|v| v.is_finite()) {
        return Ok(());
    }
    Err(no_convergence(a))
}

/// All eigenvalues of a real square matrix, in the order of [`order_by_modulus`].
///
/// The matrix is permuted and balanced first, so the result does not depend on the units of the states.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NoConvergence`].
pub fn eigenvalues(a: MatRef<'_, f64>) -> Result<Vec<C64>> {
    check_square("the matrix", a)?;
    if let Some((smaller, factor)) = shrunk(a) {
        let mut values = eigenvalues(smaller.as_ref())?;
        regrown(&mut values, factor, a)?;
        return Ok(values);
    }
    let (order, core) = isolate(a);
    let core_states = &order[core.clone()];
    let mut values: Vec<C64> = order[..core.start]
        .iter()
        .chain(&order[core.end..])
        .map(|&i| C64::new(a[(i, i)], 0.0))
        .collect();
    let block = Mat::from_fn(core.len(), core.len(), |i, j| a[(core_states[i], core_states[j])]);
    let (balanced, _) = balance(block.as_ref());
    if !core.is_empty() {
        values.extend(balanced.eigenvalues().map_err(|_| no_convergence(a))?);
    }
    order_by_modulus(&mut values);
    Ok(values)
}

/// Eigenvalues with right eigenvectors.
#[derive(Debug, Clone)]
pub struct Eigen {
    /// Eigenvalues in the order of [`order_by_modulus`], rad/s for a state matrix.
    pub values: Vec<C64>,
    /// Eigenvectors as columns, one per value, of unit 2-norm in the scaling of the input matrix; the entry
    /// of largest magnitude (in the balanced scaling) is real and positive.
    pub vectors: Mat<C64>,
}

/// Eigenvalues with right and left eigenvectors.
#[derive(Debug, Clone)]
pub struct EigenBoth {
    /// Eigenvalues in the order of [`order_by_modulus`].
    pub values: Vec<C64>,
    /// Right eigenvectors as columns, unit 2-norm: A r = lambda r.
    pub right: Mat<C64>,
    /// Left eigenvectors as columns, unit 2-norm: l^H A = lambda l^H.
    pub left: Mat<C64>,
}

/// All eigenvalues and right eigenvectors of a real square matrix, balanced first.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NoConvergence`].
pub fn eigen(a: MatRef<'_, f64>) -> Result<Eigen> {
    let (values, right, _) = eigen_sides(a, false)?;
    Ok(Eigen {
        values,
        vectors: right,
    })
}

/// All eigenvalues, right and left eigenvectors of a real square matrix, balanced first.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NoConvergence`].
pub fn eigen_both(a: MatRef<'_, f64>) -> Result<EigenBoth> {
    let (values, right, left) = eigen_sides(a, true)?;
    Ok(EigenBoth { values, right, left })
}

fn eigen_sides(a: MatRef<'_, f64>, with_left: bool) -> Result<(Vec<C64>, Mat<C64>, Mat<C64>)> {
    check_square("the matrix", a)?;
    let n = a.nrows();
    if n == 0 {
        return Ok((Vec::new(), Mat::zeros(0, 0), Mat::zeros(0, 0)));
    }
    if let Some((smaller, factor)) = shrunk(a) {
        let (mut values, right, left) = eigen_sides(smaller.as_ref(), with_left)?;
        regrown(&mut values, factor, a)?;
        return Ok((values, right, left));
    }
    let (order, _) = isolate(a);
    let permuted = Mat::from_fn(n, n, |i, j| a[(order[i], order[j])]);
    let (balanced, scaling) = balance(permuted.as_ref());

    let (mut re, mut im) = (Diag::<f64>::zeros(n), Diag::<f64>::zeros(n));
    let (mut right, mut left) = (Mat::zeros(n, n), Mat::zeros(n, n));
    let side = if with_left {
        ComputeEigenvectors::Yes
    } else {
        ComputeEigenvectors::No
    };
    let scratch = evd::evd_scratch::<f64>(n, side, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    evd::evd_real(
        balanced.as_ref(),
        re.as_mut(),
        im.as_mut(),
        with_left.then(|| left.as_mut()),
        Some(right.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| no_convergence(a))?;

    let unordered: Vec<C64> = (0..n).map(|k| C64::new(re[k], im[k])).collect();
    let ranks = modulus_order(&unordered);
    let values = ranks.iter().map(|&k| unordered[k]).collect();
    let (mut vectors, mut covectors) = (Mat::zeros(n, n), Mat::zeros(n, if with_left { n } else { 0 }));
    for (to, &from) in ranks.iter().enumerate() {
        let mut vector = complex_column(right.as_ref(), &unordered, from);
        unscale(&mut vector, &scaling, |v, d| v * d);
        write_column(&mut vectors, to, &vector, &order);
        if with_left {
            let mut covector = complex_column(left.as_ref(), &unordered, from);
            unscale(&mut covector, &scaling, |v, d| v / d);
            write_column(&mut covectors, to, &covector, &order);
        }
    }
    Ok((values, vectors, covectors))
}

/// Column `k` of eigenvectors stored as real parts followed by imaginary parts for conjugate pairs.
fn complex_column(packed: MatRef<'_, f64>, values: &[C64], k: usize) -> Vec<C64> {
    let n = packed.nrows();
    // Members of a pair are adjacent; the first one, whatever its sign, owns the stored vector.
    let first_of_pair = {
        let mut at = 0;
        while at < k && at + if values[at].im == 0.0 { 1 } else { 2 } <= k {
            at += if values[at].im == 0.0 { 1 } else { 2 };
        }
        at
    };
    (0..n)
        .map(|i| match (values[k].im == 0.0, first_of_pair == k) {
            (true, _) => C64::new(packed[(i, k)], 0.0),
            (false, true) => C64::new(packed[(i, k)], packed[(i, k + 1)]),
            (false, false) => C64::new(packed[(i, k - 1)], -packed[(i, k)]),
        })
        .collect()
}

/// Makes the entry of largest magnitude real and positive, returns to the input's scaling, and normalises.
fn unscale(vector: &mut [C64], scaling: &[f64], apply: impl Fn(C64, f64) -> C64) {
    let pivot = vector
        .iter()
        .copied()
        .fold(C64::new(0.0, 0.0), |p, v| if v.norm() > p.norm() { v } else { p });
    let phase = if pivot.norm() > 0.0 {
        pivot.conj() / pivot.norm()
    } else {
        C64::new(1.0, 0.0)
    };
    for (v, &d) in vector.iter_mut().zip(scaling) {
        *v = apply(*v * phase, d);
    }
    let largest = vector.iter().fold(0.0_f64, |m, v| m.max(v.norm()));
    if largest > 0.0 {
        let norm = largest
            * vector
                .iter()
                .map(|v| (v / largest).norm_sqr())
                .sum::<f64>()
                .sqrt();
        vector.iter_mut().for_each(|v| *v /= norm);
    }
}

fn write_column(to: &mut Mat<C64>, column: usize, vector: &[C64], order: &[usize]) {
    for (v, &i) in vector.iter().zip(order) {
        to[(i, column)] = *v;
    }
}

/// Finite eigenvalues lambda = alpha/beta of A v = lambda B v, in the order of [`order_by_modulus`].
///
/// Rows and columns of the pencil are first scaled by powers of two (after Lemonnier and Van Dooren, SIAM J.
/// Matrix Anal. Appl. 28, 2006); values with beta below n times the rounding unit of B are infinite and
/// dropped.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NoConvergence`].
pub fn generalized_eigenvalues(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Result<Vec<C64>> {
    check_square("the first matrix", a)?;
    check_square("the second matrix", b)?;
    let n = a.nrows();
    check_shape("the second matrix", (b.nrows(), b.ncols()), (n, n))?;
    if n == 0 || max_abs(b) == 0.0 {
        return Ok(Vec::new());
    }
    let (mut a, mut b) = balance_pencil(a, b);
    let negligible = n as f64 * f64::EPSILON * max_abs(b.as_ref());
    let (mut re, mut im, mut beta) = (
        Diag::<f64>::zeros(n),
        Diag::<f64>::zeros(n),
        Diag::<f64>::zeros(n),
    );
    let no = ComputeEigenvectors::No;
    // The library's own estimate is too small at low orders; eight more columns are ample.
    let scratch = gevd::gevd_scratch::<f64>(n, no, no, Par::Seq, Default::default())
        .and(StackReq::new::<f64>(8 * (n + 64)));
    gevd::gevd_real(
        a.as_mut(),
        b.as_mut(),
        re.as_mut(),
        im.as_mut(),
        beta.as_mut(),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| no_convergence(a.as_ref()))?;
    let mut values = Vec::with_capacity(n);
    let mut k = 0;
    while k < n {
        let value = C64::new(re[k], im[k]) / beta[k];
        let finite = beta[k].abs() > negligible && value.is_finite();
        // The first member of a pair speaks for both: beta of the second is not scaled to its alpha.
        let members = if im[k] == 0.0 { 1 } else { 2 };
        values.extend(
            [value, value.conj()]
                .into_iter()
                .take(if finite { members } else { 0 }),
        );
        k += members;
    }
    order_by_modulus(&mut values);
    Ok(values)
}

/// Two-sided scaling of a pencil that evens out the norms of the rows and columns of (|A|, |B|).
fn balance_pencil(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> (Mat<f64>, Mat<f64>) {
    const SWEEPS: usize = 20;
    let n = a.nrows();
    let (mut a, mut b) = (a.to_owned(), b.to_owned());
    // A common factor of B only scales the eigenvalues; undo the mismatch while the rows are weighed.
    let ratio = power_of_two(max_abs(a.as_ref()) / max_abs(b.as_ref()));
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..n {
            let row = off_diagonal_norm((0..n).flat_map(|k| [a[(i, k)], ratio * b[(i, k)]]));
            let f = power_of_two(1.0 / row);
            if f != 1.0 {
                (0..n).for_each(|k| {
                    a[(i, k)] *= f;
                    b[(i, k)] *= f;
                });
                changed = true;
            }
        }
        for j in 0..n {
            let column = off_diagonal_norm((0..n).flat_map(|k| [a[(k, j)], ratio * b[(k, j)]]));
            let f = power_of_two(1.0 / column);
            if f != 1.0 {
                (0..n).for_each(|k| {
                    a[(k, j)] *= f;
                    b[(k, j)] *= f;
                });
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    (a, b)
}

/// The power of two nearest to a positive number on a logarithmic scale; 1 for zero or non-finite input.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() {
        2.0_f64.powi(x.log2().round().clamp(-500.0, 500.0) as i32)
    } else {
        1.0
    }
}

/// K phi = lambda M phi with K symmetric and M symmetric positive definite.
///
/// Returns the eigenvalues ascending and the vectors as columns with Phi^T M Phi = I; the largest entry of
/// each vector (in coordinates scaled by the square root of the diagonal of M) is positive.
///
/// # Errors
/// [`Error::Shape`], [`Error::NonFinite`], [`Error::NotSymmetric`] beyond 1e-8 of the largest entry,
/// [`Error::NotPositiveDefinite`] for M, [`Error::NoConvergence`].
pub fn symmetric_generalized(k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    check_symmetric("the stiffness matrix", k)?;
    check_symmetric("the mass matrix", m)?;
    let n = k.nrows();
    check_shape("the mass matrix", (m.nrows(), m.ncols()), (n, n))?;
    if n == 0 {
        return Ok((Vec::new(), Mat::zeros(0, 0)));
    }
    if (0..n).any(|i| m[(i, i)] <= 0.0) {
        return Err(Error::NotPositiveDefinite {
            what: "the mass matrix",
        });
    }
    // Unit diagonal of M removes the contrast between translations and rotations.
    let unit: Vec<f64> = (0..n).map(|i| 1.0 / m[(i, i)].sqrt()).collect();
    let scaled =
        |a: MatRef<'_, f64>| Mat::from_fn(n, n, |i, j| 0.5 * (a[(i, j)] + a[(j, i)]) * unit[i] * unit[j]);
    let (k, m) = (scaled(k), scaled(m));
    let llt = Llt::new(m.as_ref(), Side::Lower).map_err(|_| Error::NotPositiveDefinite {
        what: "the mass matrix",
    })?;

    // C = L^-1 K L^-T
    let mut c = k;
    llt.L().solve_lower_triangular_in_place(&mut c);
    let mut c = c.transpose().to_owned();
    llt.L().solve_lower_triangular_in_place(&mut c);
    let c = Mat::from_fn(n, n, |i, j| 0.5 * (c[(i, j)] + c[(j, i)]));
    let spectrum = SelfAdjointEigen::new(c.as_ref(), Side::Lower).map_err(|_| Error::NoConvergence {
        what: "the symmetric eigenproblem",
        size: n,
    })?;
    let mut vectors = spectrum.U().to_owned();
    llt.L().transpose().solve_upper_triangular_in_place(&mut vectors);

    let mut ascending: Vec<usize> = (0..n).collect();
    ascending.sort_by(|&p, &q| spectrum.S()[p].total_cmp(&spectrum.S()[q]));
    let values = ascending.iter().map(|&j| spectrum.S()[j]).collect();
    let sign = |j: usize| {
        let largest = (0..n).fold(0.0_f64, |p, i| {
            if vectors[(i, j)].abs() > p.abs() {
                vectors[(i, j)]
            } else {
                p
            }
        });
        if largest < 0.0 { -1.0 } else { 1.0 }
    };
    let signs: Vec<f64> = ascending.iter().map(|&j| sign(j)).collect();
    Ok((
        values,
        Mat::from_fn(n, n, |i, j| signs[j] * unit[i] * vectors[(i, ascending[j])]),
    ))
}

/// Orders by modulus ascending, the member of a conjugate pair with the negative imaginary part first.
///
/// Two values are taken as a pair when they are conjugate to 1e-9 of their modulus, so pairs stay together
/// even when rounding has separated their moduli.
pub fn order_by_modulus(values: &mut [C64]) {
    let ordered: Vec<C64> = modulus_order(values).into_iter().map(|k| values[k]).collect();
    values.copy_from_slice(&ordered);
}

fn modulus_order(values: &[C64]) -> Vec<usize> {
    const SAME: f64 = 1e-9;
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&p, &q| {
        let (p, q) = (values[p], values[q]);
        p.norm()
            .total_cmp(&q.norm())
            .then(p.im.abs().total_cmp(&q.im.abs()))
            .then(p.im.total_cmp(&q.im))
    });
    let mut i = 0;
    while i < order.len() {
        let first = values[order[i]];
        let near = first.norm() * (1.0 + SAME);
        let partner = (i + 1..order.len())
            .take_while(|&j| values[order[j]].norm() <= near)
            .find(|&j| (values[order[j]] - first.conj()).norm() <= SAME * first.norm());
        match partner {
            Some(j) if first.im != 0.0 => {
                order[i + 1..=j].rotate_right(1);
                if values[order[i]].im > values[order[i + 1]].im {
                    order.swap(i, i + 1);
                }
                i += 2;
            }
            _ => i += 1,
        }
    }
    order
}

fn check_square(what: &'static str, a: MatRef<'_, f64>) -> Result<()> {
    check_shape(what, (a.nrows(), a.ncols()), (a.nrows(), a.nrows()))?;
    check_finite(what, a)
}

fn check_symmetric(what: &'static str, a: MatRef<'_, f64>) -> Result<()> {
    const TOLERANCE: f64 = 1e-8;
    check_square(what, a)?;
    let largest = max_abs(a);
    for i in 0..a.nrows() {
        for j in 0..i {
            let difference = (a[(i, j)] - a[(j, i)]).abs();
            if difference > TOLERANCE * largest {
                return Err(Error::NotSymmetric {
                    what,
                    row: i,
                    col: j,
                    difference: difference / largest,
                });
            }
        }
    }
    Ok(())
}

fn no_convergence(a: MatRef<'_, f64>) -> Error {
    Error::NoConvergence {
        what: "the eigenvalues",
        size: a.nrows(),
    }
}

#[cfg(test)]
mod tests;
