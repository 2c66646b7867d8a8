//! What sensors show against the kinematics of a rigid body and of a mode.

use crate::test_models::{cruise, flexible, state, transport, two_modes};
use albatross_flight::{
    Aircraft, Attitude, EquationsOfMotion, ModelOptions, Quantity, Sensor, SensorPoint, trim,
};

fn with_sensor(mut aircraft: Aircraft, quantity: Quantity, point: Option<SensorPoint>) -> Aircraft {
    aircraft.sensors = vec![Sensor {
        name: "sensor".into(),
        quantity,
        point,
    }];
    aircraft
}

fn reading(aircraft: &Aircraft, options: ModelOptions, set: &[(&str, f64)], rates: &[(&str, f64)]) -> f64 {
    let equations = EquationsOfMotion::new(aircraft, options).unwrap();
    let n = equations.layout().n_states();
    let (mut x, mut xdot, mut y) = (vec![0.0; n], vec![0.0; n], [0.0]);
    for (name, value) in [("u", 100.0), ("h", 1_000.0)].iter().chain(set) {
        x[state(&equations, name)] = *value;
    }
    for (name, value) in rates {
        xdot[state(&equations, name)] = *value;
    }
    equations.outputs(&x, &xdot, &mut y).unwrap();
    y[0]
}

fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-13 * expected.abs().max(1.0),
        "{found} against {expected}"
    );
}

/// Rotation about the centre of gravity, body axes, z down (Etkin & Reid 1996, section 4.2): a pitch acceleration lifts
/// the nose, a roll acceleration lowers the right wing, and the centripetal part points to the axis.
#[test]
fn val_acceleration_of_a_turning_rigid_body() {
    let at = |position: [f64; 3]| {
        let point = SensorPoint {
            position,
            ..SensorPoint::default()
        };
        with_sensor(transport(), Quantity::VerticalAcceleration, Some(point))
    };
    let plain = ModelOptions::default();
    close(reading(&at([10.0, 0.0, 0.0]), plain, &[], &[("q", 0.3)]), -3.0);
    close(reading(&at([0.0, 5.0, 0.0]), plain, &[], &[("p", 0.3)]), 1.5);
    close(
        reading(&at([0.0, 0.0, 2.0]), plain, &[("p", 0.4), ("q", 0.3)], &[]),
        -2.0 * 0.25 - 0.3 * 100.0,
    );
    close(
        reading(&at([10.0, 0.0, 0.0]), plain, &[("p", 0.4), ("r", 0.3)], &[]),
        10.0 * 0.4 * 0.3,
    );
    close(
        reading(&at([0.0, 5.0, 0.0]), plain, &[("v", 7.0), ("p", 0.4)], &[]),
        0.4 * 7.0,
    );
    close(reading(&at([0.0; 3]), plain, &[], &[("w", 1.7)]), 1.7);
}

/// An elastic acceleration upwards is negative in an axis that points down; its rotation and rate add to incidence and
/// pitch rate.
#[test]
fn val_elastic_motion_at_a_point() {
    let point = SensorPoint {
        position: [8.0, 0.0, 0.0],
        translation_up: vec![0.5, 0.0],
        rotation_nose_up: vec![0.1, 0.0],
    };
    let at = |quantity| with_sensor(flexible(&two_modes()), quantity, Some(point.clone()));
    let plain = ModelOptions::default();
    close(
        reading(
            &at(Quantity::VerticalAcceleration),
            plain,
            &[],
            &[("etad_1", 4.0)],
        ),
        -2.0,
    );
    close(
        reading(
            &at(Quantity::PitchRate),
            plain,
            &[("q", 0.2), ("etad_1", 3.0)],
            &[],
        ),
        0.5,
    );
    // The nose rises with q and with the mode: the air comes from above.
    let alpha = reading(
        &at(Quantity::Alpha),
        plain,
        &[("w", 3.0), ("q", 0.2), ("etad_1", 2.0), ("eta_1", 0.3)],
        &[],
    );
    close(alpha, ((3.0 - 0.2 * 8.0 - 1.0) / 100.0_f64).atan() + 0.03);
    // A rigid model of the same aircraft has the point without its motion.
    let rigid = ModelOptions {
        fidelity: albatross_flight::Fidelity::Rigid,
        ..plain
    };
    close(
        reading(&at(Quantity::Alpha), rigid, &[("w", 3.0), ("q", 0.2)], &[]),
        (1.4_f64 / 100.0).atan(),
    );
}

/// Quantities of the mean axes, and attitude angles of both kinds of attitude.
#[test]
fn val_mean_axes_quantities() {
    let at = |quantity| with_sensor(transport(), quantity, None);
    let plain = ModelOptions::default();
    let motion = [
        ("v", 5.0),
        ("w", -4.0),
        ("p", 0.1),
        ("q", 0.2),
        ("r", 0.3),
        ("phi", 0.4),
        ("theta", 0.5),
    ];
    let speed = (1e4_f64 + 25.0 + 16.0).sqrt();
    for (quantity, expected) in [
        (Quantity::Alpha, (-0.04_f64).atan()),
        (Quantity::Beta, (5.0 / speed).asin()),
        (Quantity::Airspeed, speed),
        (Quantity::Altitude, 1_000.0),
        (Quantity::RollRate, 0.1),
        (Quantity::PitchRate, 0.2),
        (Quantity::YawRate, 0.3),
        (Quantity::BankAngle, 0.4),
        (Quantity::PitchAngle, 0.5),
    ] {
        close(reading(&at(quantity), plain, &motion, &[]), expected);
    }
    let quaternion = ModelOptions {
        attitude: Attitude::Quaternion,
        ..plain
    };
    let q = nalgebra::UnitQuaternion::from_euler_angles(0.4, 0.5, -2.0);
    let set = [("q0", q.w), ("q1", q.i), ("q2", q.j), ("q3", q.k)];
    close(reading(&at(Quantity::BankAngle), quaternion, &set, &[]), 0.4);
    close(reading(&at(Quantity::PitchAngle), quaternion, &set, &[]), 0.5);
    // Straight up, beyond one by rounding.
    let half = std::f64::consts::FRAC_1_SQRT_2 * (1.0 + 1e-15);
    let up = reading(
        &at(Quantity::PitchAngle),
        quaternion,
        &[("q0", half), ("q2", half)],
        &[],
    );
    assert!((up - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
}

/// The load factor is that of the body axis: `cos theta` in unaccelerated level flight, 1 with the wings carrying the
/// weight along body z, `cos phi` of it in a bank that the aircraft does not yet turn in.
#[test]
fn val_load_factor() {
    let (equations, trimmed) = trim(&transport(), ModelOptions::default(), &cruise()).unwrap();
    let mut xdot = vec![0.0; equations.layout().n_states()];
    let mut y = vec![0.0; 4];
    equations
        .derivative(
            &trimmed.state,
            &trimmed.input,
            &mut equations.workspace(),
            &mut xdot,
        )
        .unwrap();
    equations.outputs(&trimmed.state, &xdot, &mut y).unwrap();
    assert!((y[3] - trimmed.alpha_rad.cos()).abs() < 1e-13, "{}", y[3]);
    let nz = with_sensor(transport(), Quantity::LoadFactor, None);
    close(reading(&nz, ModelOptions::default(), &[], &[]), 1.0);
    close(
        reading(&nz, ModelOptions::default(), &[("phi", 1.0)], &[]),
        1.0_f64.cos(),
    );
    close(
        reading(&nz, ModelOptions::default(), &[("q", 0.05)], &[]),
        1.0 + 0.05 * 100.0 / 9.80665,
    );
}

/// Two sensors at one point show the same.
#[test]
fn val_coincident_sensors() {
    let mut aircraft = flexible(&two_modes());
    let mut twin = aircraft.sensors[4].clone();
    twin.name = "twin".into();
    aircraft.sensors.push(twin);
    let (equations, trimmed) = trim(&aircraft, ModelOptions::default(), &cruise()).unwrap();
    let system = albatross_flight::linearize(&equations, &trimmed.state, &trimmed.input).unwrap();
    for j in 0..system.a.ncols() {
        assert_eq!(system.c[(4, j)], system.c[(5, j)]);
    }
}
