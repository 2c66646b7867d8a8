//! Thrust at the engines: force, moment, work on the modes.

use crate::test_models::{cruise, flexible, two_modes};
use albatross_flight::{Engine, EquationsOfMotion, ModelOptions, atmosphere, trim};
use albatross_numerics::solve;

/// Two engines of unequal share under the wing, toed in and tilted.
fn engines() -> Vec<Engine> {
    let (tilt, toe) = (2.0_f64.to_radians(), 1.5_f64.to_radians());
    [(0.6, 1.0), (0.4, -1.0)]
        .map(|(share, side): (f64, f64)| Engine {
            share,
            position: [1.5, 6.0 * side, 1.2],
            direction: [tilt.cos() * toe.cos(), -side * toe.sin(), -tilt.sin() * toe.cos()],
            modal_work: vec![0.11, -0.07 * side],
        })
        .to_vec()
}

/// A change of thrust changes force by `T d`, moment by `r x T d`, modal forces by `T phi_T`.
#[test]
fn val_thrust_at_the_engines() {
    let mut aircraft = flexible(&two_modes());
    aircraft.engines = engines();
    let equations = EquationsOfMotion::new(&aircraft, ModelOptions::default()).unwrap();
    let layout = equations.layout();
    let mut x = vec![0.0; layout.n_states()];
    x[..6].copy_from_slice(&[140.0, 2.0, 5.0, 0.02, 0.03, -0.01]);
    x[layout.altitude()] = 4_000.0;
    let mut work = equations.workspace();
    let mut at = |thrust: f64| {
        let mut xdot = vec![0.0; layout.n_states()];
        equations
            .derivative(&x, &[0.01, thrust], &mut work, &mut xdot)
            .unwrap();
        xdot
    };
    let thrust = 80_000.0;
    let change: Vec<f64> = at(thrust).iter().zip(at(0.0)).map(|(a, b)| a - b).collect();

    let (mut force, mut moment, mut modal) = ([0.0; 3], [0.0; 3], [0.0; 2]);
    for engine in engines() {
        let t = engine.direction.map(|d| thrust * engine.share * d);
        let [x, y, z] = engine.position;
        for (sum, part) in force.iter_mut().zip(t) {
            *sum += part;
        }
        for (sum, part) in
            moment
                .iter_mut()
                .zip([y * t[2] - z * t[1], z * t[0] - x * t[2], x * t[1] - y * t[0]])
        {
            *sum += part;
        }
        for (sum, work) in modal.iter_mut().zip(&engine.modal_work) {
            *sum += thrust * engine.share * work;
        }
    }
    let part = aircraft.elastic.as_ref().unwrap();
    let rho = atmosphere::standard(4_000.0).density;
    let etadd = solve::solve_vec(part.model.mass(rho).unwrap().as_ref(), &modal).unwrap();
    for (found, expected) in change[layout.eta_rate()].iter().zip(&etadd) {
        assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
    }
    // Accelerating modes move air, which pushes the body.
    let apparent: Vec<f64> = (0..6)
        .map(|i| {
            (0..2)
                .map(|k| rho * part.rigid_rows.eta_etadd_nc[(i, k)] * etadd[k])
                .sum()
        })
        .collect();
    for i in 0..3 {
        let expected = (force[i] + apparent[i]) / aircraft.mass;
        assert!((change[i] - expected).abs() < 1e-12, "force {i}");
        let found: f64 = (0..3).map(|j| aircraft.inertia[i][j] * change[3 + j]).sum();
        assert!(
            (found - moment[i] - apparent[3 + i]).abs() < 1e-7 * thrust,
            "moment {i}"
        );
    }
}

/// Thrust below the centre of gravity pitches the nose up: the trimmed elevator balances `T z_T` exactly.
#[test]
fn val_thrust_line_in_trim() {
    let mut aircraft = crate::test_models::transport();
    aircraft.engines = vec![Engine {
        position: [2.0, 0.0, 1.2],
        ..Engine::through_cg()
    }];
    let (_, trimmed) = trim(&aircraft, ModelOptions::default(), &cruise()).unwrap();
    let q_s_c = trimmed.dynamic_pressure * 120.0 * 4.0;
    let moment = q_s_c * (0.05 - 1.2 * trimmed.alpha_rad - 1.4 * trimmed.controls_rad[0]);
    assert!((moment + 1.2 * trimmed.thrust).abs() < 1e-10 * q_s_c, "{moment}");
    assert!(trimmed.thrust > 0.0);
}
