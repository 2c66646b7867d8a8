//! The principal logarithm of a matrix.

use albatross_numerics::{Mat, MatRef, eigen, solve};

use crate::{Error, Result};

/// Nodes (half of them, the others mirrored) and weights of Gauss-Legendre quadrature with eight points.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// 1-norm of A - I up to which eight points give log(A) to the rounding unit (N. J. Higham, Functions of Matrices,
/// 2008, Table 11.1: 0.34; a little less is taken).
const REACH: f64 = 0.3;

/// log(A) for a real matrix without eigenvalues on the closed negative real axis.
///
/// Inverse scaling and squaring (Higham, sec. 11.5): square roots until A is near the identity, then the diagonal
/// Pade approximant, which is the Gauss-Legendre rule for log(I + X) = integral over t of X (I + t X)^-1. A is
/// balanced first. Defective matrices are as good as others.
///
/// # Errors
/// [`Error::NoLogarithm`] for an eigenvalue on the negative real axis or at zero; [`Error::Numerics`].
pub(crate) fn logarithm(a: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let n = a.nrows();
    let forbidden = |z: &&albatross_numerics::C64| z.re <= 0.0 && z.im.abs() <= f64::EPSILON * z.norm();
    if let Some(z) = eigen::eigenvalues(a)?.iter().find(forbidden) {
        return Err(Error::NoLogarithm { pole: z.re });
    }
    let (mut root, scaling) = eigen::balance(a);
    let identity = Mat::<f64>::identity(n, n);
    let mut scale = 1.0;
    while one_norm((&root - &identity).as_ref()) > REACH {
        root = square_root(root.as_ref())?;
        scale *= 2.0;
    }
    let x = &root - &identity;
    let mut sum = Mat::<f64>::zeros(n, n);
    for (node, weight) in GAUSS {
        for t in [0.5 * (1.0 - node), 0.5 * (1.0 + node)] {
            let shifted = Mat::from_fn(n, n, |i, j| identity[(i, j)] + t * x[(i, j)]);
            let term = solve::solve(shifted.as_ref(), x.as_ref())?;
            sum = Mat::from_fn(n, n, |i, j| sum[(i, j)] + 0.5 * weight * term[(i, j)]);
        }
    }
    Ok(Mat::from_fn(n, n, |i, j| {
        scale * sum[(i, j)] * (scaling[i] / scaling[j])
    }))
}

/// Principal square root by the product form of the Denman-Beavers iteration (S. H. Cheng, N. J. Higham,
/// C. S. Kenney, A. J. Laub, SIAM J. Matrix Anal. Appl. 22, 2001).
fn square_root(a: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let n = a.nrows();
    let (mut m, mut x) = (a.to_owned(), a.to_owned());
    let unit = |i: usize, j: usize| f64::from(u8::from(i == j));
    let mut last = f64::INFINITY;
    for _ in 0..100 {
        let inverse = solve::inverse(m.as_ref())?;
        let factor = Mat::from_fn(n, n, |i, j| 0.5 * (unit(i, j) + inverse[(i, j)]));
        x = &x * &factor;
        m = Mat::from_fn(n, n, |i, j| {
            0.5 * unit(i, j) + 0.25 * (m[(i, j)] + inverse[(i, j)])
        });
        let distance = one_norm(Mat::from_fn(n, n, |i, j| m[(i, j)] - unit(i, j)).as_ref());
        // Quadratic convergence: once close, a step that gains nothing more is at rounding.
        if distance <= f64::EPSILON * n as f64 || (distance < 1e-8 && distance >= 0.5 * last) {
            return Ok(x);
        }
        last = distance;
    }
    Err(Error::Numerics(albatross_numerics::Error::NoConvergence {
        what: "the square root",
        size: n,
    }))
}

fn one_norm(a: MatRef<'_, f64>) -> f64 {
    (0..a.ncols())
        .map(|j| (0..a.nrows()).map(|i| a[(i, j)].abs()).sum::<f64>())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use albatross_lti::exponential::exponential;

    use super::*;

    fn mat(rows: &[&[f64]]) -> Mat<f64> {
        Mat::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
    }

    #[test]
    fn val_closed_forms() {
        // A Jordan block of eigenvalue e^-2: -2 on the diagonal, e^2 beside it.
        let z = (-2.0_f64).exp();
        let jordan = logarithm(mat(&[&[z, 1.0], &[0.0, z]]).as_ref()).unwrap();
        let rotation =
            logarithm(mat(&[&[2.5_f64.cos(), 2.5_f64.sin()], &[-2.5_f64.sin(), 2.5_f64.cos()]]).as_ref())
                .unwrap();
        for (found, expected) in [
            (jordan, mat(&[&[-2.0, 2.0_f64.exp()], &[0.0, -2.0]])),
            (rotation, mat(&[&[0.0, 2.5], &[-2.5, 0.0]])),
            (logarithm(Mat::identity(3, 3).as_ref()).unwrap(), Mat::zeros(3, 3)),
            (logarithm(Mat::zeros(0, 0).as_ref()).unwrap(), Mat::zeros(0, 0)),
        ] {
            assert!((&found - &expected).norm_max() < 1e-13, "{found:?}");
        }
    }

    #[test]
    fn prop_inverse_of_the_exponential() {
        for seed in 0..20 {
            let mut random = fastrand::Rng::with_seed(seed);
            let n = 1 + seed as usize % 8;
            let a = Mat::from_fn(n, n, |_, _| 1.2 * (random.f64() - 0.5));
            let back = logarithm(exponential(a.as_ref()).unwrap().as_ref()).unwrap();
            assert!((&back - &a).norm_max() < 1e-12, "{seed}");
        }
    }

    #[test]
    fn val_eigenvalues_on_the_negative_axis_are_refused() {
        let negative = mat(&[&[0.5, 0.0], &[0.0, -0.25]]);
        assert_eq!(
            logarithm(negative.as_ref()).err(),
            Some(Error::NoLogarithm { pole: -0.25 })
        );
        assert!(matches!(
            logarithm(Mat::zeros(2, 2).as_ref()),
            Err(Error::NoLogarithm { pole: 0.0 })
        ));
    }
}
