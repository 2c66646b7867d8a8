//! Transmission zeros of a system with one input and one output.
//!
//! Zeros are the s at which [A - sI, b; c, d] is singular. With d = 0 this pencil has infinite eigenvalues in
//! chains as long as the relative degree, which rounding scatters over large finite values. They are removed one by
//! one: with coordinates in which y = g x_n, the output stays zero when x_n does, and the equation of x_n becomes
//! the new output. The product of the g and of the final d is the gain.

use albatross_numerics::matrix::max_abs;
use albatross_numerics::{C64, Mat, eigen};

use crate::{Result, StateSpace};

/// Zeros (modulus ascending) and leading coefficient of the transfer function.
pub(crate) fn zeros_and_gain(system: &StateSpace) -> Result<(Vec<C64>, f64)> {
    let n = system.states.len();
    // Balance the states together with the channel, which counts as one more state.
    let whole = Mat::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => system.a[(i, j)],
        (true, false) => system.b[(i, 0)],
        (false, true) => system.c[(0, j)],
        (false, false) => system.d[(0, 0)],
    });
    let (whole, _) = eigen::balance(whole.as_ref());
    let mut a = whole.submatrix(0, 0, n, n).to_owned();
    let mut b: Vec<f64> = (0..n).map(|i| whole[(i, n)]).collect();
    let mut c: Vec<f64> = (0..n).map(|j| whole[(n, j)]).collect();
    let mut d = whole[(n, n)];

    let rounding = 10.0 * (n + 1) as f64 * f64::EPSILON;
    let size = max_abs(a.as_ref());
    // A smaller d would put a zero beyond the reach of double precision; after the first transformation it
    // would also be rounding of the entries it was made of.
    let mut rounding_of_d = if size > 0.0 {
        rounding * norm(&b) * norm(&c) / size
    } else {
        0.0
    };
    let (mut transformed, mut uncertainty) = (false, 0.0);
    let mut gain = 1.0;
    while d.abs() <= rounding_of_d {
        let g = norm(&c);
        if a.nrows() == 0 || g == 0.0 || (transformed && g <= rounding * size) {
            return Ok((Vec::new(), 0.0));
        }
        // The direction of c is known to the rounding of A over its own size.
        uncertainty += if transformed {
            rounding * size / g
        } else {
            rounding
        };
        (transformed, rounding_of_d) = (true, uncertainty * norm(&b));
        gain *= turn_output_to_last(&mut a, &mut b, &c);
        let m = a.nrows() - 1;
        c = (0..m).map(|j| a[(m, j)]).collect();
        d = b[m];
        b.truncate(m);
        a = a.submatrix(0, 0, m, m).to_owned();
    }
    Ok((finite_zeros(&a, &b, &c, d)?, gain * d))
}

/// Transforms the states so that c becomes (0, ..., 0, g) and returns g.
fn turn_output_to_last(a: &mut Mat<f64>, b: &mut [f64], c: &[f64]) -> f64 {
    let n = c.len();
    let last = n - 1;
    // A single entry needs a swap only, which keeps the zeros of A and b exact.
    if let [(at, &g)] = c
        .iter()
        .enumerate()
        .filter(|(_, c)| **c != 0.0)
        .collect::<Vec<_>>()[..]
    {
        let other = |i: usize| {
            if i == at {
                last
            } else if i == last {
                at
            } else {
                i
            }
        };
        *a = Mat::from_fn(n, n, |i, j| a[(other(i), other(j))]);
        b.swap(at, last);
        return g;
    }
    // Householder reflection I - 2 v v^T.
    let g = -norm(c).copysign(c[last]);
    let mut v = c.to_vec();
    v[last] -= g;
    let length = norm(&v);
    v.iter_mut().for_each(|v| *v /= length);
    let along: f64 = b.iter().zip(&v).map(|(b, v)| b * v).sum();
    b.iter_mut().zip(&v).for_each(|(b, v)| *b -= 2.0 * along * v);
    let reflection = Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j]);
    *a = &reflection * &*a * &reflection;
    g
}

/// Zeros of a system with d not 0: as many as states.
fn finite_zeros(a: &Mat<f64>, b: &[f64], c: &[f64], d: f64) -> Result<Vec<C64>> {
    let n = b.len();
    let pencil = Mat::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)],
        (true, false) => b[i],
        (false, true) => c[j],
        (false, false) => d,
    });
    let identity = Mat::from_fn(n + 1, n + 1, |i, j| f64::from(u8::from(i == j && i < n)));
    let mut zeros = eigen::generalized_eigenvalues(pencil.as_ref(), identity.as_ref())?;
    // The pencil has one infinite eigenvalue; as the largest it may pass for a finite one.
    zeros.truncate(n);
    let split_pair = zeros.last().is_some_and(|z| z.im < 0.0);
    if zeros.len() < n || split_pair {
        zeros = eigen::eigenvalues(Mat::from_fn(n, n, |i, j| a[(i, j)] - b[i] * c[j] / d).as_ref())?;
    }
    Ok(zeros)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
