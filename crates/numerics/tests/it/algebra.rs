use albatross_numerics::matrix::{RowMatrix, max_abs};
use albatross_numerics::{C64, Error, Mat, eigen, solve};
use proptest::collection::vec;
use proptest::prelude::*;

fn square(n: usize) -> impl Strategy<Value = Mat<f64>> {
    vec(-1.0..1.0_f64, n * n).prop_map(move |v| Mat::from_fn(n, n, |i, j| v[i * n + j]))
}

/// Order 1 to 12 with exponents of ten for scaling.
fn scaled_problem() -> impl Strategy<Value = (Mat<f64>, Vec<f64>)> {
    (1_usize..12).prop_flat_map(|n| (square(n), vec(-4.0..4.0_f64, n)))
}

/// Greatest distance of a value to its nearest counterpart, relative to the largest modulus.
fn mismatch(found: &[C64], expected: &[C64]) -> f64 {
    let scale = expected
        .iter()
        .map(|v| v.norm())
        .fold(f64::MIN_POSITIVE, f64::max);
    let nearest = |v: &C64| {
        expected
            .iter()
            .map(|e| (e - v).norm())
            .fold(f64::INFINITY, f64::min)
    };
    if found.len() == expected.len() {
        found.iter().map(nearest).fold(0.0, f64::max) / scale
    } else {
        f64::INFINITY
    }
}

proptest! {
    #[test]
    fn prop_eigenvalues_ignore_units((a, exponents) in scaled_problem()) {
        let n = a.nrows();
        let d: Vec<f64> = exponents.iter().map(|e| 10_f64.powf(*e)).collect();
        let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * d[j] / d[i]);
        let (p, q) = (eigen::eigenvalues(a.as_ref()).unwrap(), eigen::eigenvalues(scaled.as_ref()).unwrap());
        // Random eigenvalues may be ill-conditioned in themselves; well-conditioned ones agree to 1e-14.
        prop_assert!(mismatch(&q, &p) < 1e-9, "{:?} {:?}", p, q);
        let trace: f64 = (0..n).map(|i| a[(i, i)]).sum();
        prop_assert!((p.iter().sum::<C64>() - trace).norm() < 1e-12);
    }

    #[test]
    fn prop_pencil_with_unit_second_matrix_is_the_ordinary_problem((a, exponents) in scaled_problem()) {
        let n = a.nrows();
        let rows = Mat::from_fn(n, n, |i, j| a[(i, j)] * 10_f64.powf(exponents[i]));
        let second = Mat::from_fn(n, n, |i, j| if i == j { 10_f64.powf(exponents[i]) } else { 0.0 });
        let found = eigen::generalized_eigenvalues(rows.as_ref(), second.as_ref()).unwrap();
        prop_assert!(mismatch(&found, &eigen::eigenvalues(a.as_ref()).unwrap()) < 1e-9);
    }

    #[test]
    fn prop_symmetric_problem_is_diagonalised((a, exponents) in scaled_problem()) {
        let n = a.nrows();
        let d: Vec<f64> = exponents.iter().map(|e| 10_f64.powf(0.5 * e)).collect();
        let k = Mat::from_fn(n, n, |i, j| d[i] * (a[(i, j)] + a[(j, i)]) * d[j]);
        // M = D (I + A A^T) D is positive definite.
        let gram = &a * a.transpose();
        let m = Mat::from_fn(n, n, |i, j| d[i] * (f64::from(u8::from(i == j)) + gram[(i, j)]) * d[j]);
        let (values, phi) = eigen::symmetric_generalized(k.as_ref(), m.as_ref()).unwrap();
        prop_assert!(values.windows(2).all(|w| w[0] <= w[1]));
        let modal_mass = phi.transpose() * &m * &phi;
        let modal_stiffness = phi.transpose() * &k * &phi;
        for i in 0..n {
            for j in 0..n {
                prop_assert!((modal_mass[(i, j)] - f64::from(u8::from(i == j))).abs() < 1e-11);
                let expected = if i == j { values[i] } else { 0.0 };
                prop_assert!((modal_stiffness[(i, j)] - expected).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn prop_solve_has_a_small_residual_in_every_row((a, exponents) in scaled_problem()) {
        let n = a.nrows();
        let a = Mat::from_fn(n, n, |i, j| a[(i, j)] * 10_f64.powf(exponents[i]));
        let b: Vec<f64> = exponents.iter().map(|e| e.sin()).collect();
        match solve::solve_vec(a.as_ref(), &b) {
            Ok(x) => for i in 0..n {
                let terms: Vec<f64> = (0..n).map(|j| a[(i, j)] * x[j]).collect();
                let size = terms.iter().map(|t| t.abs()).sum::<f64>() + b[i].abs();
                prop_assert!((terms.iter().sum::<f64>() - b[i]).abs() < 1e-12 * size);
            },
            Err(Error::Singular { rcond, .. }) => prop_assert!(rcond < 1e-14),
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn prop_least_squares_residual_is_orthogonal(values in vec(-1.0..1.0_f64, 30 * 4), b in vec(-1.0..1.0_f64, 30)) {
        let a = Mat::from_fn(30, 4, |i, j| values[4 * i + j] * 10_f64.powi(3 * j as i32));
        let b = Mat::from_fn(30, 1, |i, _| b[i]);
        let x = solve::least_squares(a.as_ref(), b.as_ref()).unwrap();
        let gradient = a.transpose() * (&a * &x - &b);
        for j in 0..4 {
            prop_assert!(gradient[(j, 0)].abs() < 1e-12 * 10_f64.powi(3 * j as i32));
        }
    }

    #[test]
    fn prop_products_are_linear(rows in 0_usize..40, cols in 0_usize..40, s in -2.0..2.0_f64) {
        let a = RowMatrix::from_fn(rows, cols, |i, j| ((i * 31 + j * 17) % 13) as f64 - 6.0);
        let x: Vec<f64> = (0..cols).map(|j| (j as f64).cos()).collect();
        let sx: Vec<f64> = x.iter().map(|x| s * x).collect();
        let (mut y, mut z) = (vec![0.5; rows], vec![0.5; rows]);
        a.mul_scaled_add_into(s, &x, &mut y);
        a.mul_add_into(&sx, &mut z);
        prop_assert!(y.iter().zip(&z).all(|(y, z)| (y - z).abs() < 1e-11));
        prop_assert!(max_abs(a.to_mat().as_ref()) <= 6.0);
    }
}

/// Work space of the underlying decompositions depends on the order in steps; each order must be served.
#[test]
fn regress_every_order_is_solved() {
    for n in (1..=36).chain([63, 64, 65, 97, 128, 161]) {
        let a = Mat::from_fn(n, n, |i, j| {
            ((i * i * 31 + j * 17 + i * j) % 101) as f64 / 50.0 - 1.0
        });
        // A singular second matrix: the last third of the unknowns is algebraic.
        let b = Mat::from_fn(n, n, |i, j| {
            if i == j && 3 * i < 2 * n {
                1.0 + i as f64
            } else {
                0.0
            }
        });
        let both = eigen::eigen_both(a.as_ref()).unwrap();
        assert_eq!(both.values.len(), n);
        assert!(
            mismatch(&eigen::eigenvalues(a.as_ref()).unwrap(), &both.values) < 1e-8,
            "{n}"
        );
        assert_eq!(eigen::eigen(a.as_ref()).unwrap().vectors.ncols(), n);
        assert!(
            eigen::generalized_eigenvalues(a.as_ref(), b.as_ref())
                .unwrap()
                .len()
                <= n
        );
        let gram = &a * a.transpose();
        let mass = Mat::from_fn(
            n,
            n,
            |i, j| if i == j { 1.0 + gram[(i, j)] } else { gram[(i, j)] },
        );
        let (values, _) = eigen::symmetric_generalized(gram.as_ref(), mass.as_ref()).unwrap();
        assert!(values.iter().all(|v| (-1e-10..1.0).contains(v)), "{n}");
        let fit = solve::least_squares_with_rank(a.as_ref(), b.as_ref(), 1e-13).unwrap();
        assert_eq!(fit.singular_values.len(), n);
        assert!(solve::Lu::new(mass.as_ref()).unwrap().rcond() > 0.0);
    }
}

/// Beside the largest number the squares of a decomposition overflow: it is made of a smaller matrix.
#[test]
fn regress_matrices_of_huge_numbers_have_eigenvalues() {
    for n in [2, 5, 80] {
        let entry = |i: usize, j: usize| (1 + (i * 7 + j * 3) % 5) as f64 / 5.0;
        let of = |size: f64| {
            let a = Mat::from_fn(n, n, |i, j| size * entry(i, j));
            (
                eigen::eigenvalues(a.as_ref()).unwrap(),
                eigen::eigen_both(a.as_ref()).unwrap().values,
            )
        };
        let size = 2.0_f64.powi(1000);
        let (plain, huge) = (of(1.0), of(size));
        // The matrix has a rank of five at most: its other values are rounding, and differ.
        let largest = plain.0.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let same = |p: &C64, h: &C64| (p - h / size).norm() <= 1e-14 * largest || p.norm() < 1e-6 * largest;
        assert!(plain.0.iter().zip(&huge.0).all(|(p, h)| same(p, h)), "{n}");
        assert!(plain.1.iter().zip(&huge.1).all(|(p, h)| same(p, h)), "{n}");
    }
}
