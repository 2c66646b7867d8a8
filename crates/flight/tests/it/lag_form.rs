//! The diagonal form of the lag states is the same system.

use crate::test_models::{cruise, flexible, transport, two_modes};
use albatross_flight::lag_form::diagonal_lag_form;
use albatross_flight::{ControlAerodynamics, Error, ModelOptions, linearize, trim};
use albatross_lti::frequency_response;
use albatross_numerics::eigen;

/// Eigenvalues and frequency response stay, and the block of lags is diagonal with the decay of each lag.
#[test]
fn val_diagonal_lags_keep_the_system() {
    let aircraft = flexible(&two_modes());
    for control_aerodynamics in [ControlAerodynamics::QuasiSteady, ControlAerodynamics::Lagged] {
        let options = ModelOptions {
            control_aerodynamics,
            ..ModelOptions::default()
        };
        let (equations, trimmed) = trim(&aircraft, options, &cruise()).unwrap();
        let system = linearize(&equations, &trimmed.state, &trimmed.input).unwrap();
        let diagonal = diagonal_lag_form(&system, &equations, trimmed.speed()).unwrap();
        let lags = equations.layout().lags();
        let decay = equations.lag_diagonal(trimmed.speed());
        for i in lags.clone() {
            for j in lags.clone() {
                let expected = if i == j { decay[i] } else { 0.0 };
                assert!(
                    (diagonal.a[(i, j)] - expected).abs() < 1e-9 * decay[i].abs(),
                    "{i},{j}"
                );
            }
        }
        let sorted = |a: &albatross_numerics::Mat<f64>| {
            let mut values = eigen::eigenvalues(a.as_ref()).unwrap();
            values.sort_by(|a, b| a.norm().total_cmp(&b.norm()).then(a.im.total_cmp(&b.im)));
            values
        };
        for (a, b) in sorted(&system.a).iter().zip(sorted(&diagonal.a)) {
            assert!((a - b).norm() < 1e-7 * a.norm().max(1.0), "{a} {b}");
        }
        let omega = [0.1, 1.0, 10.0, 100.0];
        let [a, b] = [&system, &diagonal].map(|s| frequency_response(s, &omega).unwrap());
        for (a, b) in a.values.iter().zip(&b.values) {
            for output in 0..system.outputs.len() {
                let (a, b) = (a[(output, 0)], b[(output, 0)]);
                assert!((a - b).norm() < 1e-10 * a.norm().max(1e-3), "{a} {b}");
            }
        }
    }
}

/// The system of one model with the equations of another is refused; a model without lags is left as it is.
#[test]
fn val_other_systems() {
    let (equations, t) = trim(&flexible(&two_modes()), ModelOptions::default(), &cruise()).unwrap();
    let (rigid, rigid_trim) = trim(&transport(), ModelOptions::default(), &cruise()).unwrap();
    let system = linearize(&rigid, &rigid_trim.state, &rigid_trim.input).unwrap();
    let refused = diagonal_lag_form(&system, &equations, t.speed());
    assert!(matches!(refused, Err(Error::Sizes { .. })));
    assert_eq!(diagonal_lag_form(&system, &rigid, t.speed()).unwrap(), system);
    let flexible = linearize(&equations, &t.state, &t.input).unwrap();
    assert!(diagonal_lag_form(&flexible, &equations, f64::NAN).is_err());
}
