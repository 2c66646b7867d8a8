//! What cannot be flown is refused with an error that says what and why; nothing panics.

use crate::test_models::{Elasticity, cruise, flexible, transport, two_modes};
use albatross_flight::signal::{Edges, Signal};
use albatross_flight::{
    Aircraft, Engine, EquationsOfMotion, Error, FlightPoint, Manoeuvre, Method, ModelOptions, Quantity,
    Sensor, ShapeReference, linearize, simulate, trim,
};
use albatross_numerics::Mat;

fn trim_error(aircraft: &Aircraft, point: &FlightPoint) -> Error {
    trim(aircraft, ModelOptions::default(), point)
        .map(|(_, t)| t)
        .unwrap_err()
}

fn quantity(error: &Error) -> &'static str {
    match error {
        Error::BadQuantity { quantity, .. } | Error::BadSignal { quantity, .. } => quantity,
        other => panic!("{other}"),
    }
}

#[test]
fn val_bad_flight_points() {
    let aircraft = flexible(&two_modes());
    for speed in [0.0, -150.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            quantity(&trim_error(&aircraft, &FlightPoint { speed, ..cruise() })),
            "speed"
        );
    }
    for altitude in [32_001.0, -3_000.0, f64::NAN, f64::NEG_INFINITY, 1e9] {
        assert_eq!(
            quantity(&trim_error(&aircraft, &FlightPoint { altitude, ..cruise() })),
            "altitude"
        );
    }
    for path_angle_rad in [f64::NAN, 2.0, -1.6] {
        let point = FlightPoint {
            path_angle_rad,
            ..cruise()
        };
        assert_eq!(quantity(&trim_error(&aircraft, &point)), "flight-path angle");
    }
    let unknown = trim_error(
        &aircraft,
        &FlightPoint {
            control: "rudder".into(),
            ..cruise()
        },
    );
    assert_eq!(
        unknown,
        Error::UnknownControl {
            name: "rudder".into(),
            known: "elevator".into()
        },
        "{unknown}"
    );
}

#[test]
fn val_trims_that_do_not_exist() {
    let mut no_power = transport();
    no_power.rigid.pitch.controls = vec![0.0];
    match trim_error(&no_power, &cruise()) {
        Error::NoTrimAuthority {
            unknown, equation, ..
        } => {
            assert_eq!((unknown.as_str(), equation), ("elevator", "the pitching moment"));
        }
        other => panic!("{other}"),
    }
    let mut glider = transport();
    glider.engines.clear();
    let error = trim_error(&glider, &cruise());
    assert!(
        matches!(&error, Error::NoTrimAuthority { unknown, .. } if unknown == "the thrust"),
        "{error}"
    );
    // Too slow for the weight: the incidence runs against its bound.
    let slow = trim_error(
        &transport(),
        &FlightPoint {
            speed: 20.0,
            ..cruise()
        },
    );
    assert!(matches!(slow, Error::TrimNotConverged { .. }), "{slow}");
}

/// Divergence of the wing in torsion, in closed form: `q_D = K / (e S_w a)`.
#[test]
fn val_divergence() {
    let soft = Elasticity {
        omega_rad_s: vec![6.0, 18.0],
        ..two_modes()
    };
    let aircraft = flexible(&soft);
    let area: f64 = (0..4)
        .map(|i| 2.0 * 4.0 * (4.0 - 0.1 * (2.0 + 4.0 * f64::from(i))))
        .sum();
    let density = albatross_flight::atmosphere::standard(cruise().altitude).density;
    let expected = (2.0 * 5_000.0 * 36.0 / (0.6 * area * 5.0) / density).sqrt();
    assert!(expected < 150.0);
    for shape_reference in [ShapeReference::Jig, ShapeReference::Trimmed] {
        let options = ModelOptions {
            shape_reference,
            ..ModelOptions::default()
        };
        match trim(&aircraft, options, &cruise()).map(|(_, t)| t).unwrap_err() {
            Error::Divergence {
                speed,
                divergence_speed,
                ..
            } => {
                assert_eq!(speed, 150.0);
                assert!(
                    (divergence_speed / expected - 1.0).abs() < 1e-12,
                    "{divergence_speed} {expected}"
                );
            }
            other => panic!("{other}"),
        }
    }
}

/// At the divergence speed itself, where `K - q Q` is singular to the last bit or nearly so, on both sides of it: the
/// error names the speed; a neighbour below may trim, with finite numbers, or say that it did not converge.
#[test]
fn val_exactly_at_divergence() {
    let soft = Elasticity {
        omega_rad_s: vec![6.0, 18.0],
        ..two_modes()
    };
    let aircraft = flexible(&soft);
    let at = |speed: f64| {
        let point = FlightPoint { speed, ..cruise() };
        trim(&aircraft, ModelOptions::default(), &point).map(|(_, t)| t)
    };
    let Err(Error::Divergence { divergence_speed, .. }) = at(150.0) else {
        panic!("no divergence at 150 m/s");
    };
    let mut refused = 0;
    for units in -4..=4_i64 {
        // Neighbours in the last place.
        let speed = f64::from_bits(divergence_speed.to_bits().strict_add_signed(units));
        match at(speed) {
            Err(Error::Divergence { speed: s, .. }) => {
                assert_eq!(s, speed);
                refused += 1;
            }
            Err(Error::TrimNotConverged { .. }) => {}
            Err(other) => panic!("{units}: {other}"),
            Ok(t) => assert!(
                units < 0 && t.alpha_rad.is_finite() && t.eta.iter().all(|e| e.is_finite()),
                "{units}"
            ),
        }
    }
    assert!(refused >= 4, "{refused}");
    for factor in [1.0, 1.0 + 1e-12, 1.0 + 1e-6, 2.0, 10.0] {
        let found = at(divergence_speed * factor);
        assert!(matches!(found, Err(Error::Divergence { .. })), "{factor}");
    }
    let slower = at(divergence_speed * 0.9);
    assert!(!matches!(slower, Err(Error::Divergence { .. })), "{slower:?}");
}

type Spoil = (&'static str, fn(&mut Aircraft));

/// One NaN or unusable number anywhere in the data is named.
#[test]
fn val_bad_numbers_are_named() {
    let spoils: [Spoil; 19] = [
        ("mass", |a| a.mass = 0.0),
        ("mass", |a| a.mass = f64::NAN),
        ("gravity", |a| a.gravity = -9.8),
        ("reference chord", |a| a.reference.chord = 0.0),
        ("inertia", |a| a.inertia[1][2] = f64::NAN),
        ("difference of opposite products of inertia", |a| {
            a.inertia[0][2] = 1e5
        }),
        ("least principal moment of inertia", |a| a.inertia[1][1] = -1.0),
        ("least principal moment of inertia", |a| a.inertia = [[0.0; 3]; 3]),
        ("lift coefficient", |a| a.rigid.lift.alpha = f64::NAN),
        ("pitching-moment coefficient", |a| {
            a.rigid.pitch.controls = vec![f64::INFINITY]
        }),
        ("induced-drag factor", |a| {
            a.rigid.drag = albatross_flight::aerodynamics::Drag::Polar {
                zero: 0.0,
                k: f64::NAN,
            };
        }),
        ("engine's share", |a| a.engines[0].share = f64::NAN),
        ("length of the engine's direction", |a| {
            a.engines[0].direction = [0.0; 3]
        }),
        ("sensor's position", |a| {
            a.sensors[4].point.as_mut().unwrap().position[1] = f64::NAN
        }),
        ("sensor's mode shape", |a| {
            a.sensors[4].point.as_mut().unwrap().translation_up[1] = f64::NAN;
        }),
        ("q_0", |a| a.elastic.as_mut().unwrap().q_0[0] = f64::NAN),
        ("q_x (modes x 5 variables)", |a| {
            a.elastic.as_mut().unwrap().q_x[(1, 2)] = f64::NAN
        }),
        ("structural stiffness (modes x modes)", |a| {
            a.elastic.as_mut().unwrap().model.structure.stiffness[(0, 0)] = f64::NAN;
        }),
        ("rate or gain of a lag", |a| {
            a.elastic.as_mut().unwrap().model.lags[0].gain = f64::NAN
        }),
    ];
    for (expected, spoil) in spoils {
        let mut aircraft = flexible(&two_modes());
        spoil(&mut aircraft);
        assert_eq!(quantity(&trim_error(&aircraft, &cruise())), expected);
    }
    let mut bad_strip = flexible(&two_modes());
    bad_strip.elastic.as_mut().unwrap().model.strips[3].chord = 0.0;
    let error = trim_error(&bad_strip, &cruise());
    assert!(matches!(error, Error::Strip(_)), "{error}");
}

/// Arrays of any other size than the modes, strips and controls ask for.
#[test]
fn val_bad_sizes_are_named() {
    let spoils: [Spoil; 11] = [
        ("lift coefficient", |a| a.rigid.lift.controls = vec![]),
        ("yawing-moment coefficient", |a| {
            a.rigid.yaw.controls = vec![0.0; 2]
        }),
        ("engine's modal work (modes)", |a| {
            a.engines[0].modal_work = vec![0.0]
        }),
        ("sensor's mode shape (modes)", |a| {
            a.sensors[4].point.as_mut().unwrap().rotation_nose_up = vec![];
        }),
        ("q_x (modes x 5 variables)", |a| {
            a.elastic.as_mut().unwrap().q_x = Mat::zeros(2, 4)
        }),
        ("q_u (modes x controls)", |a| {
            a.elastic.as_mut().unwrap().q_u = Mat::zeros(2, 2)
        }),
        ("q_0 (modes)", |a| a.elastic.as_mut().unwrap().q_0 = vec![]),
        ("control_incidence (strips x controls)", |a| {
            a.elastic.as_mut().unwrap().control_incidence = Mat::zeros(3, 1);
        }),
        ("rigid_rows (6 x modes)", |a| {
            a.elastic.as_mut().unwrap().rigid_rows.eta_etadd_nc = Mat::zeros(5, 2);
        }),
        ("generalised forces on the modes", |a| {
            a.elastic.as_mut().unwrap().model.forces.eta_lambda_c = Mat::zeros(2, 3);
        }),
        ("structural mass (modes x modes)", |a| {
            a.elastic.as_mut().unwrap().model.structure.mass = Mat::zeros(2, 3);
        }),
    ];
    for (expected, spoil) in spoils {
        let mut aircraft = flexible(&two_modes());
        spoil(&mut aircraft);
        match trim_error(&aircraft, &cruise()) {
            Error::Sizes { what, .. } => assert_eq!(what, expected),
            other => panic!("{expected}: {other}"),
        }
    }
}

#[test]
fn val_names_must_differ() {
    for name in ["alpha", "elevator", "thrust"] {
        let mut aircraft = transport();
        aircraft.sensors.push(Sensor::at_cg(name, Quantity::Beta));
        assert_eq!(aircraft.check(), Err(Error::DuplicateName { name: name.into() }));
    }
}

/// Slices and workspaces of the wrong size, given to the equations themselves.
#[test]
fn val_evaluation_checks_its_arrays() {
    let (equations, t) = trim(&flexible(&two_modes()), ModelOptions::default(), &cruise()).unwrap();
    let n = t.state.len();
    let mut xdot = vec![0.0; n];
    let mut work = equations.workspace();
    for (x, u, rows) in [(n - 1, 2, n), (0, 2, n), (n, 1, n), (n, 3, n), (n, 2, n + 1)] {
        let mut xdot = vec![0.0; rows];
        let result = equations.derivative(&vec![1.0; x], &vec![0.0; u], &mut work, &mut xdot);
        assert!(matches!(result, Err(Error::Sizes { .. })));
    }
    let rigid = EquationsOfMotion::new(&transport(), ModelOptions::default()).unwrap();
    let foreign = equations.derivative(&t.state, &t.input, &mut rigid.workspace(), &mut xdot);
    assert!(matches!(foreign, Err(Error::Sizes { .. })), "{foreign:?}");
    assert!(matches!(
        equations.outputs(&t.state, &xdot, &mut [0.0]),
        Err(Error::Sizes { .. })
    ));
    assert!(matches!(
        linearize(&equations, &t.state[1..], &t.input),
        Err(Error::Sizes { .. })
    ));
    assert!(matches!(
        linearize(&equations, &t.state, &[]),
        Err(Error::Sizes { .. })
    ));
    // A state of rest has no incidence: its Jacobian is not finite.
    assert!(matches!(
        linearize(&equations, &vec![0.0; n], &t.input),
        Err(Error::Lti(_))
    ));
    let manoeuvre = Manoeuvre {
        dt: 0.01,
        end: 0.1,
        output_every: 1,
        method: Method::Rk4,
        inputs: vec![],
    };
    assert!(matches!(
        simulate(&rigid, &t, &manoeuvre),
        Err(Error::Sizes { .. })
    ));
}

#[test]
fn val_bad_manoeuvres() {
    let (equations, t) = trim(&transport(), ModelOptions::default(), &cruise()).unwrap();
    let good = Manoeuvre {
        dt: 0.01,
        end: 1.0,
        output_every: 1,
        method: Method::Rk4,
        inputs: vec![],
    };
    let fly = |m: Manoeuvre| simulate(&equations, &t, &m).unwrap_err();
    for dt in [0.0, -0.01, f64::NAN] {
        assert_eq!(quantity(&fly(Manoeuvre { dt, ..good.clone() })), "dt");
    }
    for end in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(quantity(&fly(Manoeuvre { end, ..good.clone() })), "end");
    }
    for (dt, end) in [(0.03, 1.0), (2.0, 1.0), (1e-12, 1.0)] {
        assert_eq!(
            quantity(&fly(Manoeuvre {
                dt,
                end,
                ..good.clone()
            })),
            "end/dt"
        );
    }
    assert_eq!(
        quantity(&fly(Manoeuvre {
            output_every: 0,
            ..good.clone()
        })),
        "output_every"
    );
    // A thousand million samples would not fit the memory: refused, not attempted.
    let long = Manoeuvre {
        dt: 1e-3,
        end: 5e5,
        ..good.clone()
    };
    assert_eq!(quantity(&fly(long)), "number of output samples");
    let step = |amplitude, start| Signal::Step { amplitude, start };
    let inputs = vec![(2, step(1.0, 0.0))];
    assert!(matches!(
        fly(Manoeuvre {
            inputs,
            ..good.clone()
        }),
        Error::Sizes {
            what: "input index",
            ..
        }
    ));
    let doublet = Signal::Doublet {
        amplitude: 1.0,
        start: 0.0,
        period: 0.0,
        edges: Edges::Smooth,
    };
    let chirp = Signal::Chirp {
        amplitude: 1.0,
        start: 0.0,
        duration: 1.0,
        from_hz: f64::NAN,
        to_hz: 1.0,
    };
    for (signal, expected) in [
        (step(f64::NAN, 0.0), "amplitude"),
        (step(1.0, f64::INFINITY), "start"),
        (doublet, "period"),
        (
            Signal::ThreeTwoOneOne {
                amplitude: 1.0,
                start: 0.0,
                unit: -1.0,
            },
            "unit",
        ),
        (chirp, "from_hz"),
        (
            Signal::Table {
                time: vec![],
                value: vec![],
            },
            "number of values in the table",
        ),
        (
            Signal::Table {
                time: vec![0.0, f64::NAN],
                value: vec![0.0, 1.0],
            },
            "time in the table",
        ),
        (
            Signal::Table {
                time: vec![1.0, 0.0],
                value: vec![0.0, 1.0],
            },
            "time in the table",
        ),
    ] {
        assert_eq!(
            quantity(&fly(Manoeuvre {
                inputs: vec![(0, signal)],
                ..good.clone()
            })),
            expected
        );
    }
}

/// A step far beyond the limit of stability: the error names time, state and step, whatever the output interval.
#[test]
fn val_divergence_of_the_simulation() {
    let (equations, t) = trim(&flexible(&two_modes()), ModelOptions::default(), &cruise()).unwrap();
    for output_every in [1, 7, 1_000_000] {
        let inputs = vec![(
            0,
            Signal::Step {
                amplitude: 0.01,
                start: 0.0,
            },
        )];
        let wild = Manoeuvre {
            dt: 0.25,
            end: 500.0,
            output_every,
            method: Method::Rk4,
            inputs,
        };
        match simulate(&equations, &t, &wild).unwrap_err() {
            Error::Diverged { time, state, dt } => {
                assert!(time > 0.0 && time <= 500.0 && dt == 0.25 && !state.is_empty());
            }
            other => panic!("{other}"),
        }
    }
    let mut lost = t.clone();
    lost.state[4] = f64::NAN;
    let calm = Manoeuvre {
        dt: 0.01,
        end: 1.0,
        output_every: 1,
        method: Method::Rk4,
        inputs: vec![],
    };
    match simulate(&equations, &lost, &calm).unwrap_err() {
        Error::Diverged { time, state, .. } => assert_eq!((time, state.as_str()), (0.0, "q")),
        other => panic!("{other}"),
    }
}

/// Engines that push sideways only leave the aircraft without thrust.
#[test]
fn val_sideways_engine() {
    let mut aircraft = transport();
    aircraft.engines = vec![Engine {
        direction: [0.0, 1.0, 0.0],
        ..Engine::through_cg()
    }];
    assert!(matches!(
        trim_error(&aircraft, &cruise()),
        Error::NoTrimAuthority { .. }
    ));
}

/// Errors say what was found, what was expected, and the cure.
#[test]
fn val_messages() {
    let text = trim_error(
        &transport(),
        &FlightPoint {
            altitude: 40_000.0,
            ..cruise()
        },
    )
    .to_string();
    assert_eq!(
        text,
        "altitude is 40000, expected from -2000 to 32000 m, where the model of the atmosphere holds"
    );
    let mut glider = transport();
    glider.engines.clear();
    assert_eq!(
        trim_error(&glider, &cruise()).to_string(),
        "the trim cannot be solved: the thrust does not change the force along body x; give the aircraft an engine \
         whose share is not zero and that points forward"
    );
}
