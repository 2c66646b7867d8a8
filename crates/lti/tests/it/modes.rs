use std::f64::consts::{LN_2, PI, TAU};

use albatross_lti::{Mode, StateSpace, mode_table, mode_table_of};
use albatross_numerics::{C64, Mat};

use crate::models::{aeroelastic, double_integrator, mat, oscillator};

#[test]
fn val_oscillator_figures_in_closed_form() {
    let (omega, zeta) = (4.0 * PI, 0.3_f64);
    let table = mode_table(&oscillator(omega, zeta)).unwrap();
    let [mode] = table.as_slice() else {
        panic!("{table:?}")
    };
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    assert!((mode.omega_rad_s - omega).abs() < 1e-13);
    assert!((mode.frequency_hz - 2.0).abs() < 1e-14);
    assert!((mode.damping_ratio - zeta).abs() < 1e-14);
    assert!(mode.oscillatory);
    assert!((mode.period_s.unwrap() - TAU / damped).abs() < 1e-13);
    assert!((mode.time_to_half_or_double_s.unwrap() - LN_2 / (zeta * omega)).abs() < 1e-13);
    // Displacement and velocity carry half each, whatever the units.
    assert!((mode.participation[0].share - 0.5).abs() < 1e-13);
    assert_eq!(mode.participation[0].state, "x");
}

#[test]
fn val_real_modes_and_integrators() {
    let a = mat(&[&[-4.0, 0.0, 0.0], &[0.0, 0.5, 0.0], &[1.0, 0.0, 0.0]]);
    let system = StateSpace::unnamed(a, Mat::zeros(3, 1), Mat::zeros(1, 3), Mat::zeros(1, 1)).unwrap();
    let table = mode_table(&system).unwrap();
    let figures: Vec<_> = table
        .iter()
        .map(|m| (m.re, m.damping_ratio, m.time_constant_s, m.period_s))
        .collect();
    assert_eq!(
        figures,
        [
            (0.0, 0.0, None, None),
            (0.5, -1.0, Some(2.0), None),
            (-4.0, 1.0, Some(0.25), None)
        ]
    );
    assert_eq!(table[1].participation[0].state, "x2");
    assert_eq!(mode_table(&double_integrator()).unwrap().len(), 2);
}

#[test]
fn prop_participation_ignores_units_and_sums_to_one() {
    let system = aeroelastic(3, 8, 2);
    let n = system.states.len();
    let mut scaled = system.clone();
    let d: Vec<f64> = (0..n).map(|i| 10_f64.powi((i * 3 % 7) as i32 - 3)).collect();
    scaled.a = Mat::from_fn(n, n, |i, j| system.a[(i, j)] * d[j] / d[i]);
    let (p, q) = (mode_table(&system).unwrap(), mode_table(&scaled).unwrap());
    assert_eq!(p.len(), q.len());
    for (p, q) in p.iter().zip(&q) {
        assert!((p.eigenvalue() - q.eigenvalue()).norm() < 1e-10 * (1.0 + p.omega_rad_s));
        let sum: f64 = p.participation.iter().map(|s| s.share).sum();
        assert!(sum <= 1.0 + 1e-12 && sum > 0.5);
        assert!(
            (p.participation[0].share - q.participation[0].share).abs() < 1e-7,
            "{p:?} {q:?}"
        );
    }
}

#[test]
fn val_table_of_chosen_values_keeps_their_order() {
    let system = aeroelastic(3, 8, 2);
    let all = mode_table(&system).unwrap();
    let chosen: Vec<C64> = [5, 2].map(|k: usize| all[k].eigenvalue().conj()).to_vec();
    let table = mode_table_of(&system, &chosen).unwrap();
    assert_eq!(table, [all[5].clone(), all[2].clone()]);
    let text = serde_json::to_string(&table[0]).unwrap();
    assert_eq!(serde_json::from_str::<Mode>(&text).unwrap(), table[0]);
}
