//! Trims of the rigid aircraft, climbing and descending.

use crate::test_models::{G, cruise, transport};
use albatross_flight::{Attitude, FlightPoint, ModelOptions, trim};
use proptest::prelude::*;

proptest! {
    /// Forces along and normal to the flight path and the pitching moment balance at any point of the envelope, and the
    /// altitude changes at `V sin gamma`.
    #[test]
    fn prop_trim_balances(
        speed in 90.0..240.0_f64,
        altitude in -500.0..14_000.0_f64,
        path_angle_rad in -0.2..0.2_f64,
        quaternion: bool,
    ) {
        let aircraft = transport();
        let attitude = if quaternion { Attitude::Quaternion } else { Attitude::Euler };
        let options = ModelOptions { attitude, ..ModelOptions::default() };
        let point = FlightPoint { speed, altitude, path_angle_rad, ..cruise() };
        let (equations, t) = trim(&aircraft, options, &point).unwrap();
        let lift = 0.25 + 5.5 * t.alpha_rad + 0.4 * t.controls_rad[0];
        let drag = 0.02 + 0.045 * lift * lift;
        let (q_s, weight) = (t.dynamic_pressure * 120.0, aircraft.mass * G);
        let (sin, cos) = t.alpha_rad.sin_cos();
        let scale = weight + q_s;
        prop_assert!((t.thrust * cos - q_s * drag - weight * path_angle_rad.sin()).abs() < 1e-11 * scale);
        prop_assert!((t.thrust * sin + q_s * lift - weight * path_angle_rad.cos()).abs() < 1e-11 * scale);
        prop_assert!((0.05 - 1.2 * t.alpha_rad - 1.4 * t.controls_rad[0]).abs() < 1e-11);
        prop_assert!(t.residual < 1e-10);
        let mut xdot = vec![0.0; t.state.len()];
        equations.derivative(&t.state, &t.input, &mut equations.workspace(), &mut xdot).unwrap();
        prop_assert!((xdot[equations.layout().altitude()] - speed * path_angle_rad.sin()).abs() < 1e-10);
        prop_assert!((t.speed() / speed - 1.0).abs() < 1e-14);
    }
}

/// Newton's method takes few iterations: a slow-down shows here.
#[test]
fn regress_iterations() {
    let (_, t) = trim(&transport(), ModelOptions::default(), &cruise()).unwrap();
    assert!(t.iterations <= 7, "{}", t.iterations);
}

/// A small drone trims as well as a transport: residuals are judged beside what the air can do.
#[test]
fn val_small_aircraft_trims() {
    let mut aircraft = transport();
    aircraft.mass = 1.5;
    aircraft.inertia = [[0.02, 0.0, 0.0], [0.0, 4e-6, 0.0], [0.0, 0.0, 0.03]];
    aircraft.reference = albatross_strip::quasi_steady::ReferenceDimensions {
        area: 0.4,
        chord: 0.2,
        span: 2.0,
    };
    let point = FlightPoint {
        speed: 40.0,
        altitude: 50.0,
        ..cruise()
    };
    let (_, t) = trim(&aircraft, ModelOptions::default(), &point).unwrap();
    assert!((0.05 - 1.2 * t.alpha_rad - 1.4 * t.controls_rad[0]).abs() < 1e-12);
}
