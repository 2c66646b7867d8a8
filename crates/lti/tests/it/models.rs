//! Systems with known answers, shared by the tests.

use albatross_lti::{Signal, StateSpace};
use albatross_numerics::{Mat, matrix};

pub(crate) fn mat(rows: &[&[f64]]) -> Mat<f64> {
    matrix::from_rows(&rows.iter().map(|r| r.to_vec()).collect::<Vec<_>>()).unwrap()
}

pub(crate) fn named(prefix: &str, n: usize) -> Vec<Signal> {
    (1..=n)
        .map(|i| Signal::new(format!("{prefix}{i}"), "1"))
        .collect()
}

/// x'' + 2 zeta omega x' + omega^2 x = omega^2 u, y = x: unit static gain.
pub(crate) fn oscillator(omega: f64, zeta: f64) -> StateSpace {
    StateSpace::try_new(
        (
            mat(&[&[0.0, 1.0], &[-omega * omega, -2.0 * zeta * omega]]),
            mat(&[&[0.0], &[omega * omega]]),
            mat(&[&[1.0, 0.0]]),
            mat(&[&[0.0]]),
        ),
        vec![Signal::new("x", "m"), Signal::new("v", "m/s")],
        vec![Signal::new("u", "m")],
        vec![Signal::new("y", "m")],
    )
    .unwrap()
}

pub(crate) fn double_integrator() -> StateSpace {
    StateSpace::unnamed(
        mat(&[&[0.0, 1.0], &[0.0, 0.0]]),
        mat(&[&[0.0], &[1.0]]),
        mat(&[&[1.0, 0.0]]),
        mat(&[&[0.0]]),
    )
    .unwrap()
}

/// Deterministic numbers in (-1, 1) (linear congruential generator of Knuth, MMIX).
pub(crate) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed
        .wrapping_mul(2_862_933_555_777_941_757)
        .wrapping_add(3_037_000_493);
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The shape of a linearised flexible aircraft: `modes` oscillators coupled by aerodynamics, `lags` states
/// with a diagonal block driven by the modal rates and acting on the modal accelerations, and a position
/// integrator that no output sees. Stable; in mixed units.
pub(crate) fn aeroelastic(modes: usize, lags: usize, seed: u64) -> StateSpace {
    let mut random = noise(seed);
    let n = 2 * modes + lags + 1;
    let mut a = Mat::<f64>::zeros(n, n);
    for i in 0..modes {
        let omega = 3.0 + 4.0 * i as f64;
        a[(i, modes + i)] = 1.0;
        a[(modes + i, i)] = -omega * omega;
        a[(modes + i, modes + i)] = -0.06 * omega - 0.5;
        for j in 0..2 * modes {
            a[(modes + i, j)] += 0.15 * random();
        }
        for j in 0..lags {
            a[(modes + i, 2 * modes + j)] = 0.3 * random();
            a[(2 * modes + j, modes + i)] = 0.3 * random();
        }
    }
    for j in 0..lags {
        // Two rates per strip, strips in pairs left and right.
        let strip = j / 4;
        a[(2 * modes + j, 2 * modes + j)] = -(2.0 + 0.3 * strip as f64) * if j % 2 == 0 { 1.0 } else { 6.6 };
    }
    a[(n - 1, modes)] = 1.0;
    let mut b = Mat::<f64>::zeros(n, 2);
    for i in modes..2 * modes + lags {
        b[(i, 0)] = random();
        b[(i, 1)] = if i < 2 * modes { random() } else { 0.0 };
    }
    let mut c = Mat::<f64>::zeros(3, n);
    for j in 0..n - 1 {
        for i in 0..3 {
            c[(i, j)] = random();
        }
    }
    let d = Mat::from_fn(3, 2, |i, j| if i == j { 0.3 } else { 0.0 });
    let unit: Vec<f64> = (0..n).map(|i| 10_f64.powi((i * 7 % 5) as i32 - 2)).collect();
    let a = Mat::from_fn(n, n, |i, j| a[(i, j)] * unit[j] / unit[i]);
    let b = Mat::from_fn(n, 2, |i, j| b[(i, j)] / unit[i]);
    let c = Mat::from_fn(3, n, |i, j| c[(i, j)] * unit[j]);
    StateSpace::unnamed(a, b, c, d).unwrap()
}
