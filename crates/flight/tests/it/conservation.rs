//! Conservation laws of mechanics, where the air does nothing.

use crate::test_models::{Elasticity, G, flexible, start, state, transport, two_modes, without_air};
use albatross_flight::{Attitude, EquationsOfMotion, Fidelity, Manoeuvre, Method, ModelOptions, simulate};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

const END: f64 = 4.0;
const ANGLES: [f64; 3] = [0.4, 0.3, -1.1];

fn fly(equations: &EquationsOfMotion, state: Vec<f64>, method: Method) -> Vec<f64> {
    let trim = start(equations, state, vec![0.0; equations.n_inputs()]);
    let manoeuvre = Manoeuvre {
        dt: 2e-3,
        end: END,
        output_every: 100,
        method,
        inputs: vec![],
    };
    simulate(equations, &trim, &manoeuvre).unwrap().final_state
}

fn rotation(attitude: Attitude, x: &[f64]) -> Rotation3<f64> {
    match attitude {
        Attitude::Euler => Rotation3::from_euler_angles(x[6], x[7], x[8]),
        Attitude::Quaternion => {
            UnitQuaternion::from_quaternion(Quaternion::new(x[6], x[7], x[8], x[9])).to_rotation_matrix()
        }
    }
}

fn tumbling(attitude: Attitude) -> Vec<f64> {
    let mut x = vec![120.0, 5.0, -3.0, 0.3, 0.2, -0.25];
    match attitude {
        Attitude::Euler => x.extend(ANGLES),
        Attitude::Quaternion => {
            let q = UnitQuaternion::from_euler_angles(ANGLES[0], ANGLES[1], ANGLES[2]);
            x.extend([q.w, q.i, q.j, q.k]);
        }
    }
    x.extend([5_000.0, 100.0, -50.0]);
    x
}

/// A tumbling body in a vacuum: its centre of gravity flies Galilei's parabola, its energy and its angular momentum in
/// earth axes stay. RK4 at 0.3 rad/s and 2 ms errs by (0.6e-3)^4, so only rounding of 8000 evaluations is left.
#[test]
fn val_vacuum_flight_conserves() {
    for attitude in [Attitude::Euler, Attitude::Quaternion] {
        let options = ModelOptions {
            attitude,
            position: true,
            ..ModelOptions::default()
        };
        let aircraft = without_air();
        let equations = EquationsOfMotion::new(&aircraft, options).unwrap();
        let inertia = Matrix3::from_fn(|i, j| aircraft.inertia[i][j]);
        let before = tumbling(attitude);
        let after = fly(&equations, before.clone(), Method::Rk4);
        let vector = |x: &[f64], at: usize| Vector3::new(x[at], x[at + 1], x[at + 2]);
        let (turn0, turn1) = (rotation(attitude, &before), rotation(attitude, &after));

        let (v0, v1) = (turn0 * vector(&before, 0), turn1 * vector(&after, 0));
        assert!(
            (v1 - v0 - Vector3::new(0.0, 0.0, G * END)).norm() < 1e-10,
            "velocity {v1}"
        );
        let h = equations.layout().altitude();
        let position = |x: &[f64]| Vector3::new(x[h + 1], x[h + 2], -x[h]);
        let parabola = position(&before) + v0 * END + Vector3::new(0.0, 0.0, 0.5 * G * END * END);
        assert!(
            (position(&after) - parabola).norm() < 1e-9,
            "position {}",
            position(&after) - parabola
        );

        let (spin0, spin1) = (inertia * vector(&before, 3), inertia * vector(&after, 3));
        let (momentum0, momentum1) = (turn0 * spin0, turn1 * spin1);
        assert!(
            (momentum1 - momentum0).norm() < 1e-11 * momentum0.norm(),
            "angular momentum"
        );
        let rotation_energy = |x: &[f64], spin: Vector3<f64>| 0.5 * vector(x, 3).dot(&spin);
        let energy = |x: &[f64], spin| {
            0.5 * aircraft.mass * vector(x, 0).norm_squared()
                + aircraft.mass * G * x[h]
                + rotation_energy(x, spin)
        };
        assert!(
            (energy(&after, spin1) / energy(&before, spin0) - 1.0).abs() < 1e-13,
            "energy"
        );
        assert!(
            (rotation_energy(&after, spin1) / rotation_energy(&before, spin0) - 1.0).abs() < 1e-12,
            "energy of rotation"
        );
    }
}

/// Torque-free precession of a body of revolution (Goldstein 1980, section 5-6): `p + i q` turns at
/// `(A - C)/A r` about the axis of inertia C.
#[test]
fn val_torque_free_precession() {
    let (a, c, r) = (2.0e6, 3.2e6, 0.7);
    let mut aircraft = without_air();
    aircraft.inertia = [[a, 0.0, 0.0], [0.0, a, 0.0], [0.0, 0.0, c]];
    let options = ModelOptions {
        attitude: Attitude::Quaternion,
        ..ModelOptions::default()
    };
    let equations = EquationsOfMotion::new(&aircraft, options).unwrap();
    let mut x = vec![120.0, 0.0, 0.0, 0.1, 0.0, r, 1.0, 0.0, 0.0, 0.0, 5_000.0];
    x = fly(&equations, x, Method::Rk4);
    let angle = (c - a) / a * r * END;
    for (found, expected) in x[3..6].iter().zip([0.1 * angle.cos(), 0.1 * angle.sin(), r]) {
        assert!((found - expected).abs() < 1e-12, "{found} against {expected}");
    }
}

/// Modes without air ring at their damped frequency, `eta = exp(-xi omega t) cos(omega_d t) + ...`, and leave the
/// rigid body alone.
#[test]
fn val_modes_ring_freely_without_air() {
    let mut elasticity = two_modes();
    elasticity.apparent_mass_factor = 0.0;
    let (omega, xi) = (elasticity.omega_rad_s[1], elasticity.damping[1]);
    let mut aircraft = flexible(&elasticity);
    aircraft.rigid = without_air().rigid;
    remove_lift(&mut aircraft, &elasticity);
    for method in [Method::Rk4, Method::ExactLags] {
        let equations = EquationsOfMotion::new(&aircraft, ModelOptions::default()).unwrap();
        let mut x = vec![0.0; equations.layout().n_states()];
        x[0] = 120.0;
        x[equations.layout().altitude()] = 5_000.0;
        let eta = state(&equations, "eta_2");
        x[eta] = 0.3;
        let end = fly(&equations, x, method);
        let damped = omega * (1.0 - xi * xi).sqrt();
        let (sin, cos) = (damped * END).sin_cos();
        let exact = 0.3 * (-xi * omega * END).exp() * (cos + xi * omega / damped * sin);
        // RK4 loses (omega dt)^5/120 of phase a step: 5e-10 x 2000 steps of amplitude 0.3.
        assert!((end[eta] - exact).abs() < 3e-7, "{} against {exact}", end[eta]);
        assert!(end[1].abs() + end[3].abs() + end[4].abs() + end[5].abs() < 1e-15);
    }
}

/// Takes the lift from the strips and the loads.
fn remove_lift(aircraft: &mut albatross_flight::Aircraft, elasticity: &Elasticity) {
    use albatross_strip::forces::generalized_forces;
    use albatross_strip::{AeroelasticModel, Split, StripTheory, Structure};
    let Some(part) = &mut aircraft.elastic else { return };
    let mut strips = part.model.strips.clone();
    strips.iter_mut().for_each(|s| s.cl_alpha = 0.0);
    let theory = StripTheory {
        apparent_mass_factor: 0.0,
        ..StripTheory::default()
    };
    let structure = Structure::modal(
        &elasticity.modal_mass,
        &elasticity.omega_rad_s,
        &elasticity.damping,
    )
    .unwrap();
    let rigid = albatross_strip::StripShapes::rigid_body(
        &strips,
        albatross_strip::DihedralForm::Paper,
        crate::test_models::X_CG,
        0.0,
    );
    part.rigid_rows =
        generalized_forces(&strips, &rigid, &elasticity.shapes, &theory, Split::ApparentMass).unwrap();
    part.model = AeroelasticModel::try_new(
        structure,
        strips,
        elasticity.shapes.clone(),
        &theory,
        Split::ApparentMass,
        &elasticity.lags,
    )
    .unwrap();
    part.q_x = 0.0 * &part.q_x;
    part.q_u = 0.0 * &part.q_u;
    part.q_0.fill(0.0);
}

/// Without rotation and with thrust balancing nothing, a rigid model and a flexible one at rest have the same motion.
#[test]
fn val_rigid_option_drops_the_modes() {
    let aircraft = flexible(&two_modes());
    let rigid = EquationsOfMotion::new(
        &aircraft,
        ModelOptions {
            fidelity: Fidelity::Rigid,
            ..ModelOptions::default()
        },
    )
    .unwrap();
    let plain = EquationsOfMotion::new(&transport(), ModelOptions::default()).unwrap();
    let x = [140.0, 3.0, 6.0, 0.02, 0.01, -0.03, 0.1, 0.05, 0.4, 4_000.0];
    let (u, mut a, mut b) = ([0.02, 4e4], [0.0; 10], [0.0; 10]);
    rigid.derivative(&x, &u, &mut rigid.workspace(), &mut a).unwrap();
    plain.derivative(&x, &u, &mut plain.workspace(), &mut b).unwrap();
    assert_eq!(a, b);
}
