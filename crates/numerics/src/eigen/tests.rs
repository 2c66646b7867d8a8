use super::*;

fn matrix(rows: &[&[f64]]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// Deterministic numbers in (-1, 1) (linear congruential generator of Knuth, MMIX).
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Oscillators with lags, coupled: the shape of an aeroelastic state matrix.
pub(super) fn aeroelastic_like(n: usize, seed: u64) -> Mat<f64> {
    let mut random = noise(seed);
    let modes = n / 4;
    Mat::from_fn(n, n, |i, j| {
        let coupling = random();
        let frequency = |k: usize| 2.0 + 1.7 * k as f64;
        if i < modes {
            if j == i + modes { 1.0 } else { 0.0 }
        } else if i < 2 * modes {
            let k = i - modes;
            if j == k {
                -frequency(k).powi(2)
            } else if j == i {
                -0.04 * frequency(k) - 0.3
            } else {
                0.2 * coupling
            }
        } else if i == j {
            -1.0 - 0.13 * i as f64
        } else if j < 2 * modes {
            0.3 * coupling
        } else {
            0.0
        }
    })
}

/// Largest distance of a value of `found` to its counterpart, relative to the modulus.
fn mismatch(found: &[C64], expected: &[C64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let mut left: Vec<C64> = found.to_vec();
    expected.iter().fold(0.0_f64, |worst, e| {
        let nearest = (0..left.len())
            .min_by(|&p, &q| (left[p] - e).norm().total_cmp(&(left[q] - e).norm()))
            .unwrap();
        worst.max((left.swap_remove(nearest) - e).norm() / e.norm())
    })
}

#[test]
fn val_oscillator_in_closed_form() {
    let (omega, zeta): (f64, f64) = (7.0, 0.1);
    let a = matrix(&[&[0.0, 1.0], &[-omega * omega, -2.0 * zeta * omega]]);
    let eigen = eigen(a.as_ref()).unwrap();
    let exact = C64::new(-zeta * omega, -omega * (1.0 - zeta * zeta).sqrt());
    assert!((eigen.values[0] - exact).norm() < 1e-14 * omega);
    assert!((eigen.values[1] - exact.conj()).norm() < 1e-14 * omega);
    // The vector of a companion matrix is (1, lambda).
    let ratio = eigen.vectors[(1, 0)] / eigen.vectors[(0, 0)];
    assert!((ratio - exact).norm() < 1e-14 * omega);
}

/// Companion matrix of the Wilkinson-like polynomial (s+1)(s+2)...(s+8).
#[test]
fn val_known_polynomial_roots() {
    let c = [
        40320.0, 109_584.0, 118_124.0, 67284.0, 22449.0, 4536.0, 546.0, 36.0,
    ];
    let a = Mat::from_fn(8, 8, |i, j| {
        if i == 7 {
            -c[j]
        } else {
            f64::from(u8::from(j == i + 1))
        }
    });
    let values = eigenvalues(a.as_ref()).unwrap();
    for (k, value) in values.iter().enumerate() {
        // Condition of the roots of this polynomial: about 1e6 at the middle ones.
        assert!((value + (k + 1) as f64).norm() < 1e-8, "{value}");
    }
}

#[test]
fn prop_values_do_not_depend_on_the_units_of_the_states() {
    for seed in 1..=3 {
        let n = 60;
        let a = aeroelastic_like(n, seed);
        let mut random = noise(seed + 100);
        let d: Vec<f64> = (0..n).map(|_| 10_f64.powf(4.0 * random())).collect();
        let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * d[j] / d[i]);
        let expected = eigenvalues(a.as_ref()).unwrap();
        let found = eigenvalues(scaled.as_ref()).unwrap();
        assert!(
            mismatch(&found, &expected) < 1e-11,
            "{}",
            mismatch(&found, &expected)
        );
        let with_vectors = eigen(scaled.as_ref()).unwrap();
        assert!(mismatch(&with_vectors.values, &expected) < 1e-11);
    }
}

#[test]
fn val_vectors_satisfy_their_equations_on_both_sides() {
    let n = 40;
    let a = aeroelastic_like(n, 9);
    let d: Vec<f64> = (0..n).map(|i| 10_f64.powi((i * 5 % 9) as i32 - 4)).collect();
    let a = Mat::from_fn(n, n, |i, j| a[(i, j)] * d[j] / d[i]);
    let both = eigen_both(a.as_ref()).unwrap();
    for k in 0..n {
        let norm: f64 = (0..n).map(|i| both.right[(i, k)].norm_sqr()).sum();
        assert!((norm - 1.0).abs() < 1e-12);
        for i in 0..n {
            // Residual of row i against the sum of magnitudes in that row: meaningful in any units.
            let terms = (0..n).map(|j| both.right[(j, k)] * a[(i, j)]);
            let size: f64 =
                terms.clone().map(|t| t.norm()).sum::<f64>() + (both.values[k] * both.right[(i, k)]).norm();
            let residual = terms.sum::<C64>() - both.values[k] * both.right[(i, k)];
            assert!(
                residual.norm() < 1e-9 * size + 1e-300,
                "right {k} {i} {residual} {size}"
            );

            let terms = (0..n).map(|j| both.left[(j, k)].conj() * a[(j, i)]);
            let size: f64 =
                terms.clone().map(|t| t.norm()).sum::<f64>() + (both.values[k] * both.left[(i, k)]).norm();
            let residual = terms.sum::<C64>() - both.values[k] * both.left[(i, k)].conj();
            assert!(
                residual.norm() < 1e-9 * size + 1e-300,
                "left {k} {i} {residual} {size}"
            );
        }
    }
}

/// Position follows speed, heading follows rate: both are exact zeros, whatever the units.
#[test]
fn val_pure_integrators_are_exactly_zero() {
    let a = matrix(&[
        &[-0.02, 0.3, -9.81, 0.0, 0.0],
        &[-0.1, -0.8, 0.0, 230.0, 0.0],
        &[0.0, 0.0, 0.0, 1.0, 0.0],
        &[1e-4, -0.02, 0.0, -1.1, 0.0],
        &[1.0, 0.0, 0.0, 0.0, 0.0],
    ]);
    for values in [
        eigenvalues(a.as_ref()).unwrap(),
        eigen(a.as_ref()).unwrap().values,
    ] {
        assert_eq!(values[0], C64::new(0.0, 0.0));
        assert!(values[1].norm() > 1e-3);
    }
    let triangular = Mat::from_fn(30, 30, |i, j| if j >= i { 1.0 + (i * j) as f64 } else { 0.0 });
    for (k, value) in eigenvalues(triangular.as_ref()).unwrap().into_iter().enumerate() {
        assert_eq!(value, C64::new(1.0 + (k * k) as f64, 0.0));
    }
}

#[test]
fn val_balancing_evens_norms_without_rounding() {
    let a = aeroelastic_like(24, 3);
    let scaled = Mat::from_fn(24, 24, |i, j| a[(i, j)] * 4_f64.powi(j as i32 - i as i32));
    let (balanced, d) = balance(scaled.as_ref());
    for i in 0..24 {
        assert_eq!(d[i].log2().fract(), 0.0);
        for j in 0..24 {
            assert_eq!(balanced[(i, j)], scaled[(i, j)] * d[j] / d[i]);
        }
        let row = off_diagonal_norm((0..24).filter(|&k| k != i).map(|k| balanced[(i, k)]));
        let column = off_diagonal_norm((0..24).filter(|&k| k != i).map(|k| balanced[(k, i)]));
        assert!(row / column < 3.0 && column / row < 3.0, "{row} {column}");
    }
}

#[test]
fn val_pencil_with_singular_second_matrix_drops_infinite_values() {
    // Two masses, one massless: s^2 m + k with the second coordinate algebraic.
    let a = matrix(&[&[-3.0, 1.0, 0.0], &[0.0, -2.0, 5.0], &[1.0, 0.0, 4.0]]);
    let b = matrix(&[&[2.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 0.0, 0.0]]);
    // Eliminate x3 = -x1/4: [[-3, 1], [-5/4, -2]] x = lambda diag(2, 1) x.
    let reduced = matrix(&[&[-1.5, 0.5], &[-1.25, -2.0]]);
    let expected = eigenvalues(reduced.as_ref()).unwrap();
    let found = generalized_eigenvalues(a.as_ref(), b.as_ref()).unwrap();
    assert!(mismatch(&found, &expected) < 1e-14, "{found:?} {expected:?}");
    // The same pencil in absurd units.
    let d = [1e7, 1e-6, 1e3];
    let e = [1e-8, 1e5, 1e9];
    let scale = |m: &Mat<f64>| Mat::from_fn(3, 3, |i, j| e[i] * m[(i, j)] * d[j]);
    let found = generalized_eigenvalues(scale(&a).as_ref(), scale(&b).as_ref()).unwrap();
    assert!(mismatch(&found, &expected) < 1e-13, "{found:?} {expected:?}");
}

/// Fixed-free chain of n equal masses and springs: omega_j = 2 sin((2j-1) pi/(2 (2n+1))).
#[test]
fn val_spring_chain_in_closed_form() {
    let n = 12;
    let k = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => {
            if i == n - 1 {
                1.0
            } else {
                2.0
            }
        }
        1 => -1.0,
        _ => 0.0,
    });
    // Coordinates counted in different units leave the frequencies alone.
    let d: Vec<f64> = (0..n).map(|i| 10_f64.powi((i % 5) as i32 - 2)).collect();
    let k = Mat::from_fn(n, n, |i, j| d[i] * k[(i, j)] * d[j]);
    let m = Mat::from_fn(n, n, |i, j| if i == j { d[i] * d[i] } else { 0.0 });
    let (values, vectors) = symmetric_generalized(k.as_ref(), m.as_ref()).unwrap();
    for (j, value) in values.iter().enumerate() {
        let omega = 2.0 * ((2 * j + 1) as f64 * std::f64::consts::PI / (2.0 * (2 * n + 1) as f64)).sin();
        assert!((value.sqrt() / omega - 1.0).abs() < 1e-13);
    }
    let gram = vectors.transpose() * &m * &vectors;
    for i in 0..n {
        for j in 0..n {
            assert!((gram[(i, j)] - f64::from(u8::from(i == j))).abs() < 1e-13);
        }
    }
}

#[test]
fn val_bad_input_is_refused_with_its_place() {
    let mut a = Mat::<f64>::identity(3, 3);
    a[(1, 2)] = f64::NAN;
    assert_eq!(
        eigenvalues(a.as_ref()),
        Err(Error::NonFinite {
            what: "the matrix",
            row: 1,
            col: 2
        })
    );
    assert!(matches!(
        eigenvalues(Mat::zeros(2, 3).as_ref()),
        Err(Error::Shape { found: (2, 3), .. })
    ));
    let lopsided = matrix(&[&[1.0, 0.5], &[0.0, 1.0]]);
    let one = Mat::<f64>::identity(2, 2);
    assert!(matches!(
        symmetric_generalized(lopsided.as_ref(), one.as_ref()),
        Err(Error::NotSymmetric { row: 1, col: 0, .. })
    ));
    let indefinite = matrix(&[&[1.0, 2.0], &[2.0, 1.0]]);
    assert_eq!(
        symmetric_generalized(one.as_ref(), indefinite.as_ref()).unwrap_err(),
        Error::NotPositiveDefinite {
            what: "the mass matrix"
        }
    );
    assert_eq!(eigenvalues(Mat::zeros(0, 0).as_ref()), Ok(vec![]));
    assert_eq!(eigen(Mat::zeros(0, 0).as_ref()).unwrap().values, vec![]);
}

#[test]
fn val_order_keeps_pairs_together() {
    let (p, q) = (C64::new(-1.0, 2.0), C64::new(-1.0, 2.0 + 1e-13));
    let mut values = [C64::new(-9.0, 0.0), p, q.conj(), p.conj(), C64::new(0.0, 0.0), q];
    order_by_modulus(&mut values);
    assert_eq!(
        values,
        [C64::new(0.0, 0.0), p.conj(), p, q.conj(), q, C64::new(-9.0, 0.0)]
    );
}
