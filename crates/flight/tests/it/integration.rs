//! Time histories: order of the methods, agreement with the linear system, exact lags, symmetry.

use crate::test_models::{cruise, flexible, state, transport, two_modes};
use albatross_flight::signal::{Edges, Signal};
use albatross_flight::{
    Attitude, ControlAerodynamics, EquationsOfMotion, Manoeuvre, Method, ModelOptions, TimeHistory, Trim,
    linearize, simulate, trim,
};
use albatross_lti::simulate_rk4;
use albatross_numerics::integrate::Stage;

fn doublet(amplitude_deg: f64, frequency_hz: f64, edges: Edges) -> Signal {
    Signal::Doublet {
        amplitude: amplitude_deg.to_radians(),
        start: 0.2,
        period: 1.0 / frequency_hz,
        edges,
    }
}

fn fly(
    equations: &EquationsOfMotion,
    trimmed: &Trim,
    signal: Signal,
    steps: usize,
    method: Method,
) -> TimeHistory {
    const END: f64 = 1.0;
    let manoeuvre = Manoeuvre {
        dt: END / steps as f64,
        end: END,
        output_every: steps / 100,
        method,
        inputs: vec![(0, signal)],
    };
    simulate(equations, trimmed, &manoeuvre).unwrap()
}

/// Largest difference of the outputs, each relative to its largest excursion.
fn difference(a: &TimeHistory, b: &TimeHistory) -> f64 {
    a.series
        .iter()
        .zip(&b.series)
        .skip(2)
        .fold(0.0_f64, |worst, (a, b)| {
            let size = b.iter().fold(1e-12_f64, |m, v| m.max((v - b[0]).abs()));
            a.iter()
                .zip(b)
                .fold(worst, |m, (a, b)| m.max((a - b).abs() / size))
        })
}

fn trimmed(options: ModelOptions) -> (EquationsOfMotion, Trim) {
    trim(&flexible(&two_modes()), options, &cruise()).unwrap()
}

/// Order four on a 10 Hz square doublet with its edges on the grid, by Richardson's ratio of three steps; both methods
/// converge to the same history, and Euler angles and the quaternion do.
#[test]
fn val_order_of_integration() {
    let mut finest = Vec::new();
    for attitude in [Attitude::Euler, Attitude::Quaternion] {
        let (equations, trimmed) = trimmed(ModelOptions {
            attitude,
            ..ModelOptions::default()
        });
        for method in [Method::Rk4, Method::ExactLags] {
            let [coarse, middle, fine] = [500, 1000, 2000]
                .map(|n| fly(&equations, &trimmed, doublet(1.0, 10.0, Edges::Square), n, method));
            let order = (difference(&coarse, &middle) / difference(&middle, &fine)).log2();
            assert!(
                order > 3.8 && order < 4.4,
                "{method:?}, {attitude:?}: order {order}"
            );
            finest.push(fine);
        }
    }
    for other in &finest[1..] {
        let d = difference(other, &finest[0]);
        assert!(d < 1e-8, "{d:e}");
    }
}

/// Small motion is the linear system's: the difference is of second order in the amplitude.
#[test]
fn val_small_doublet_is_linear() {
    for control_aerodynamics in [ControlAerodynamics::QuasiSteady, ControlAerodynamics::Lagged] {
        let (equations, trimmed) = trimmed(ModelOptions {
            control_aerodynamics,
            ..ModelOptions::default()
        });
        let system = linearize(&equations, &trimmed.state, &trimmed.input).unwrap();
        let at = |amplitude_deg: f64| {
            let signal = doublet(amplitude_deg, 2.0, Edges::Square);
            let flown = fly(&equations, &trimmed, signal.clone(), 1000, Method::Rk4);
            let linear = simulate_rk4(&system, 1e-3, 1000, None, |t, stage, u| {
                use albatross_flight::signal::Side;
                let side = if stage == Stage::End {
                    Side::Left
                } else {
                    Side::Right
                };
                u.copy_from_slice(&[signal.at(t, side), 0.0]);
            })
            .unwrap();
            let mut worst = 0.0_f64;
            for (channel, series) in system.outputs.iter().zip(&flown.series[2..]) {
                let linear = linear.output(&channel.name).unwrap();
                let peak = linear.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (sample, value) in series.iter().enumerate() {
                    worst = worst.max((value - series[0] - linear[10 * sample]).abs() / peak);
                }
            }
            worst
        };
        let (large, small) = (at(0.01), at(0.001));
        assert!(large < 2e-5, "{large:e}");
        assert!((large / small - 10.0).abs() < 0.2, "{large:e} {small:e}");
    }
}

/// The doublet of the elevator leaves every lateral and antisymmetric state of a symmetric aircraft at rounding.
#[test]
fn val_symmetric_input_leaves_lateral_states_at_rest() {
    let (equations, trimmed) = trimmed(ModelOptions {
        position: true,
        ..ModelOptions::default()
    });
    let history = fly(
        &equations,
        &trimmed,
        doublet(2.0, 2.0, Edges::Smooth),
        1000,
        Method::Rk4,
    );
    for name in ["v", "p", "r", "phi", "psi", "east", "eta_2", "etad_2"] {
        let value = history.final_state[state(&equations, name)];
        assert!(value.abs() < 1e-12, "{name}: {value:e}");
    }
    let lags = equations.layout().lags();
    let (right, left) = history.final_state[lags].split_at(5);
    // Right strips, then left ones, in each of the two lags.
    for (a, b) in right.iter().zip(left) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

/// A short chord makes a lag that RK4 cannot follow at this step (`|2 V a/c| dt > 2.785`); integrated exactly it does
/// no harm.
#[test]
fn val_exact_lags_are_stable_for_any_chord() {
    let mut aircraft = flexible(&two_modes());
    if let Some(part) = &mut aircraft.elastic {
        part.model.strips[1].chord = 0.02;
    }
    let (equations, trimmed) = trim(&aircraft, ModelOptions::default(), &cruise()).unwrap();
    assert!(
        equations
            .lag_diagonal(150.0)
            .iter()
            .any(|rate| rate * 1e-3 < -2.785)
    );
    let manoeuvre = |method| Manoeuvre {
        dt: 1e-3,
        end: 1.0,
        output_every: 10,
        method,
        inputs: vec![(0, doublet(1.0, 2.0, Edges::Smooth))],
    };
    assert!(simulate(&equations, &trimmed, &manoeuvre(Method::Rk4)).is_err());
    let exact = simulate(&equations, &trimmed, &manoeuvre(Method::ExactLags)).unwrap();
    let fine = Manoeuvre {
        dt: 1e-4,
        output_every: 100,
        ..manoeuvre(Method::Rk4)
    };
    let reference = simulate(&equations, &trimmed, &fine).unwrap();
    let d = difference(&exact, &reference);
    assert!(d < 1e-6, "{d:e}");
}

/// In trim nothing moves, whatever the attitude and the method.
#[test]
fn val_trim_stays() {
    for options in crate::test_models::all_options() {
        let (equations, trimmed) = trimmed(options);
        let manoeuvre = Manoeuvre {
            dt: 2e-3,
            end: 1.0,
            output_every: 500,
            method: Method::Rk4,
            inputs: vec![],
        };
        let end = simulate(&equations, &trimmed, &manoeuvre).unwrap().final_state;
        for (signal, (a, b)) in equations
            .layout()
            .signals()
            .iter()
            .zip(end.iter().zip(&trimmed.state))
        {
            if signal.name != "north" {
                assert!(
                    (a - b).abs() < 1e-11 * b.abs().max(1.0),
                    "{}: {a} {b}, {options:?}",
                    signal.name
                );
            }
        }
    }
}

/// Samples: channels and their units, times, the input's right limit at its jump, the interval of the output.
#[test]
fn val_samples() {
    let (equations, trimmed) = trim(&transport(), ModelOptions::default(), &cruise()).unwrap();
    let manoeuvre = Manoeuvre {
        dt: 0.01,
        end: 1.0,
        output_every: 20,
        method: Method::Rk4,
        inputs: vec![
            (
                0,
                Signal::Step {
                    amplitude: 0.01,
                    start: 0.4,
                },
            ),
            (
                1,
                Signal::Step {
                    amplitude: 500.0,
                    start: 0.0,
                },
            ),
        ],
    };
    let history = simulate(&equations, &trimmed, &manoeuvre).unwrap();
    let names: Vec<&str> = history.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["elevator", "thrust", "alpha", "q", "theta", "nz"]);
    assert_eq!(history.time.len(), 6);
    assert!(
        history
            .time
            .iter()
            .enumerate()
            .all(|(k, t)| (t - 0.2 * k as f64).abs() < 1e-12)
    );
    let elevator: Vec<f64> = history
        .get("elevator")
        .unwrap()
        .iter()
        .map(|e| e - trimmed.input[0])
        .collect();
    for (found, expected) in elevator.iter().zip([0.0, 0.0, 0.01, 0.01, 0.01, 0.01]) {
        assert!((found - expected).abs() < 1e-15);
    }
    assert!(
        history
            .get("thrust")
            .unwrap()
            .iter()
            .all(|t| (t - trimmed.thrust - 500.0).abs() < 1e-9)
    );
    assert!(history.get("rudder").is_none());

    // An interval that does not divide the steps: the last sample is the last whole interval, the state the end's.
    let odd = simulate(
        &equations,
        &trimmed,
        &Manoeuvre {
            output_every: 30,
            ..manoeuvre.clone()
        },
    )
    .unwrap();
    assert_eq!(odd.time.len(), 4);
    assert_eq!(odd.final_state, history.final_state);
}
