use albatross_lti::{Error, FrequencySolver, Method, StateSpace, frequency_response};
use albatross_numerics::{C64, Mat};
use proptest::prelude::*;

use crate::models::{aeroelastic, double_integrator, mat, oscillator};

fn logspace(low: f64, high: f64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| low * (high / low).powf(i as f64 / (n - 1) as f64))
        .collect()
}

#[test]
fn val_oscillator_in_closed_form_by_every_method() {
    let (omega, zeta) = (6.0, 0.02);
    let system = oscillator(omega, zeta);
    for method in [Method::Auto, Method::Lu, Method::Eigen] {
        let solver = FrequencySolver::new(&system, method).unwrap();
        for w in logspace(0.1, 100.0, 40) {
            let s = C64::new(0.0, w);
            let exact = omega * omega / (s * s + 2.0 * zeta * omega * s + omega * omega);
            let found = solver.evaluate(s).unwrap()[(0, 0)];
            assert!((found / exact - 1.0).norm() < 1e-12, "{method:?} {w}");
        }
    }
}

#[test]
fn val_double_integrator_and_the_pole_at_zero() {
    let system = double_integrator();
    let response = frequency_response(&system, &[0.5, 2.0])
        .unwrap()
        .get("y1", "u1")
        .unwrap();
    assert!((response.values[0] + 4.0).norm() < 1e-14 && (response.values[1] + 0.25).norm() < 1e-15);
    assert_eq!(response.phase_deg(), [180.0, 180.0]);
    assert!((response.magnitude_db()[0] - 12.041_199_826_559_248).abs() < 1e-12);
    let error = frequency_response(&system, &[0.5, 0.0]).unwrap_err();
    assert!(
        matches!(error, Error::PoleAtFrequency { omega_rad_s: 0.0, .. }),
        "{error:?}"
    );
}

#[test]
fn val_undamped_resonance_is_named() {
    let system = oscillator(7.5, 0.0);
    for method in [Method::Lu, Method::Eigen] {
        let error = FrequencySolver::new(&system, method)
            .unwrap()
            .response(&[1.0, 7.5])
            .unwrap_err();
        assert!(
            matches!(error, Error::PoleAtFrequency { omega_rad_s: 7.5, .. }),
            "{method:?} {error:?}"
        );
        assert!(error.to_string().contains("7.5"));
    }
}

/// The elimination is algebra: it must agree with the dense solve to rounding.
#[test]
fn val_lag_reduction_equals_the_dense_solve() {
    let system = aeroelastic(8, 60, 1);
    let solvers = [Method::Lu, Method::LagReduced, Method::Eigen, Method::Auto]
        .map(|method| FrequencySolver::new(&system, method).unwrap());
    let grid: Vec<f64> = std::iter::once(0.0).chain(logspace(0.01, 300.0, 60)).collect();
    for &w in &grid {
        let [dense, others @ ..] = solvers
            .each_ref()
            .map(|solver| solver.evaluate(C64::new(0.0, w)).unwrap());
        let largest = (0..6).map(|k| dense[(k / 2, k % 2)].norm()).fold(0.0, f64::max);
        for other in others {
            for k in 0..6 {
                let difference = (other[(k / 2, k % 2)] - dense[(k / 2, k % 2)]).norm();
                assert!(difference < 1e-10 * largest, "{w}: {difference:e} of {largest}");
            }
        }
    }
}

#[test]
fn val_lags_can_be_named() {
    let system = aeroelastic(3, 12, 6);
    let names: Vec<String> = (7..=18).map(|i| format!("x{i}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let solver = FrequencySolver::with_lags(&system, &names).unwrap();
    let dense = FrequencySolver::new(&system, Method::Lu).unwrap();
    let s = C64::new(0.0, 3.3);
    assert!((solver.evaluate(s).unwrap()[(2, 1)] - dense.evaluate(s).unwrap()[(2, 1)]).norm() < 1e-12);
    let error = FrequencySolver::with_lags(&system, &["x4", "x5"]).unwrap_err();
    assert!(error.to_string().contains("acts on state"), "{error}");
    let error = FrequencySolver::with_lags(&system, &["x1"]).unwrap_err();
    assert!(error.to_string().contains("integrator"), "{error}");
    assert!(matches!(
        FrequencySolver::with_lags(&system, &["lag"]),
        Err(Error::UnknownSignal { .. })
    ));
}

#[test]
fn val_defective_eigenvectors_are_refused() {
    // A chain of three equal lags has a single eigenvector.
    let a = Mat::from_fn(3, 3, |i, j| {
        if i == j {
            -2.0
        } else {
            f64::from(u8::from(i == j + 1))
        }
    });
    let system = StateSpace::unnamed(
        a,
        mat(&[&[1.0], &[0.0], &[0.0]]),
        mat(&[&[0.0, 0.0, 1.0]]),
        mat(&[&[0.0]]),
    )
    .unwrap();
    assert!(matches!(
        FrequencySolver::new(&system, Method::Eigen),
        Err(Error::Method { .. })
    ));
    let s = C64::new(0.0, 1.0);
    let found = FrequencySolver::new(&system, Method::Auto)
        .unwrap()
        .evaluate(s)
        .unwrap()[(0, 0)];
    assert!((found - (s + 2.0).powi(-3)).norm() < 1e-15);
}

/// Six lightly damped modes in series turn the phase by 1080 deg; the first minus 90 per pole pair crossed.
fn cascade() -> StateSpace {
    let first = oscillator(2.0, 1e-3);
    [4.0, 4.3, 9.0, 15.0, 15.1]
        .into_iter()
        .fold(first, |chain, omega| {
            chain.series(&oscillator(omega, 1e-3)).unwrap()
        })
}

/// Sum of the arguments of the six factors: continuous by construction.
fn cascade_phase_deg(w: f64) -> f64 {
    [2.0, 4.0, 4.3, 9.0, 15.0, 15.1]
        .map(|omega: f64| -(2e-3 * omega * w).atan2(omega * omega - w * w).to_degrees())
        .iter()
        .sum()
}

#[test]
fn val_phase_is_continuous_on_a_fine_grid() {
    let grid: Vec<f64> = (0..40_000).map(|i| 0.5 + 5e-4 * f64::from(i)).collect();
    let channel = frequency_response(&cascade(), &grid)
        .unwrap()
        .get("y", "u")
        .unwrap();
    for (phase, w) in channel.phase_deg().iter().zip(&grid) {
        assert!((phase - cascade_phase_deg(*w)).abs() < 1e-6, "{w}: {phase}");
    }
}

#[test]
fn val_refined_phase_is_right_on_any_grid() {
    let solver = FrequencySolver::new(&cascade(), Method::Auto).unwrap();
    for grid in [
        vec![0.5, 20.0],
        vec![1.0, 5.0, 14.9, 15.04, 16.0, 30.0],
        vec![3.0],
    ] {
        let phase = solver.phase_deg("y", "u", &grid).unwrap();
        let start = phase[0] - cascade_phase_deg(grid[0]);
        assert!((start / 360.0 - (start / 360.0).round()).abs() < 1e-9);
        for (phase, w) in phase.iter().zip(&grid) {
            assert!(
                (phase - start - cascade_phase_deg(*w)).abs() < 1e-6,
                "{w}: {phase}"
            );
        }
    }
    assert!(matches!(
        solver.phase_deg("y", "u", &[2.0, 1.0]),
        Err(Error::Domain { .. })
    ));
}

#[test]
fn val_phase_starts_in_the_principal_interval() {
    // -1/(s + 1) starts at exactly 180 deg, not -180.
    let system =
        StateSpace::unnamed(mat(&[&[-1.0]]), mat(&[&[1.0]]), mat(&[&[-1.0]]), mat(&[&[0.0]])).unwrap();
    let response = frequency_response(&system, &[0.0, 1.0])
        .unwrap()
        .get("y1", "u1")
        .unwrap();
    assert_eq!(response.phase_deg()[0], 180.0);
    assert!((response.phase_deg()[1] - 135.0).abs() < 1e-12);
    assert!(matches!(
        frequency_response(&system, &[f64::NAN]),
        Err(Error::Domain { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn prop_methods_agree_on_random_systems(modes in 1_usize..5, lags in 0_usize..20, seed in 0_u64..1000, w in 0.01..200.0_f64) {
        let system = aeroelastic(modes, lags, seed);
        let s = C64::new(0.0, w);
        let [lu, auto, reduced] = [Method::Lu, Method::Auto, Method::LagReduced]
            .map(|method| FrequencySolver::new(&system, method).unwrap().evaluate(s).unwrap());
        let largest = (0..6).map(|k| lu[(k / 2, k % 2)].norm()).fold(0.0, f64::max);
        for k in 0..6 {
            prop_assert!((auto[(k / 2, k % 2)] - lu[(k / 2, k % 2)]).norm() < 1e-11 * largest);
            prop_assert!((reduced[(k / 2, k % 2)] - lu[(k / 2, k % 2)]).norm() < 1e-11 * largest);
        }
    }
}

/// Batches of frequencies against the dense factors at each, the amplitudes put in as integrals of their rates: grids
/// longer and shorter than a batch, frequency zero, where the integrals are not, and the pole of a lag.
#[test]
fn val_batches_of_frequencies_equal_the_dense_solve() {
    for seed in [3, 8] {
        let system = aeroelastic(6, 80, seed);
        let mut grid = vec![0.0];
        grid.extend(logspace(1e-3, 300.0, 69));
        for omega in [&grid[..], &grid[5..9]] {
            let reduced = FrequencySolver::new(&system, Method::LagReduced)
                .unwrap()
                .response(omega)
                .unwrap();
            let dense = FrequencySolver::new(&system, Method::Lu)
                .unwrap()
                .response(omega)
                .unwrap();
            assert_eq!(reduced.values.len(), omega.len());
            for (w, (r, d)) in omega.iter().zip(reduced.values.iter().zip(&dense.values)) {
                let difference = (r - d).norm_max();
                assert!(
                    difference < 1e-10 * d.norm_max(),
                    "seed {seed}, {w} rad/s: {difference:e}"
                );
            }
        }
        let solver = FrequencySolver::new(&system, Method::LagReduced).unwrap();
        let pole = C64::new(-2.0, 0.0);
        assert!(matches!(
            solver.evaluate(pole),
            Err(Error::PoleAtFrequency { .. })
        ));
        assert!(solver.response(&[1.0, f64::NAN]).is_err());
    }
}
