//! Eigenvalues of rigid aircraft against closed forms.

use crate::test_models::{G, cruise, lateral, longitudinal, transport};
use albatross_flight::aerodynamics::Drag;
use albatross_flight::{Aircraft, FlightPoint, ModelOptions, atmosphere, linearize, trim};
use albatross_lti::StateSpace;
use albatross_numerics::{C64, Mat, eigen};
use num_dual::Dual64;

fn linear(aircraft: &Aircraft, point: &FlightPoint) -> StateSpace {
    let (equations, trimmed) = trim(aircraft, ModelOptions::default(), point).unwrap();
    linearize(&equations, &trimmed.state, &trimmed.input).unwrap()
}

/// Distance of the nearest eigenvalue, relative to its modulus.
fn distance(system: &StateSpace, expected: C64) -> f64 {
    let values = eigen::eigenvalues(system.a.as_ref()).unwrap();
    values
        .iter()
        .map(|v| (v - expected).norm())
        .fold(f64::INFINITY, f64::min)
        / expected.norm()
}

/// Lift equals weight at zero incidence, so that thrust is along the flight path.
fn level_at_zero_incidence(point: &FlightPoint) -> (Aircraft, f64) {
    let mut aircraft = transport();
    let q = 0.5 * atmosphere::standard(point.altitude).density * point.speed * point.speed;
    let lift = aircraft.mass * G / (q * aircraft.reference.area);
    aircraft.rigid.lift.zero = lift;
    aircraft.rigid.pitch.zero = 0.0;
    (aircraft, lift)
}

/// The phugoid of a point mass that keeps its incidence (Lanchester's, with drag and the density gradient; Etkin & Reid
/// 1996, section 6.3 gives `omega = sqrt(2) g/V` for neither): three states, speed, path angle and altitude.
///
/// The aircraft approaches it as its pitch stiffness grows: here the short period is 10000 times faster, and damping in
/// pitch turns the incidence by 1e-5 s times the pitch rate.
#[test]
fn val_phugoid_of_a_point_mass() {
    let point = cruise();
    let (mut aircraft, lift) = level_at_zero_incidence(&point);
    aircraft.rigid.pitch.alpha = -1e6;
    aircraft.rigid.pitch.q_hat = -1e3;
    aircraft.rigid.lift.q_hat = 0.0;
    let drag = 0.02 + 0.045 * lift * lift;
    let v = point.speed;
    let air = atmosphere::standard(Dual64::new(point.altitude, 1.0)).density;
    let gradient = air.eps / air.re;
    let ratio = drag / lift;
    let rows = [
        [-2.0 * G * ratio / v, -G, -G * ratio * gradient],
        [2.0 * G / (v * v), 0.0, G / v * gradient],
        [0.0, v, 0.0],
    ];
    let point_mass = Mat::from_fn(3, 3, |i, j| rows[i][j]);
    let system = linear(&aircraft, &point);
    // The third root is zero: with the thrust held, speed and altitude have a line of level flights.
    for value in eigen::eigenvalues(point_mass.as_ref())
        .unwrap()
        .into_iter()
        .filter(|v| v.im != 0.0)
    {
        let d = distance(&system, value);
        assert!(d < 1e-5, "{value}: {d:e}");
    }
    // The density gradient stiffens the phugoid: Lanchester's frequency is the lower bound.
    let oscillation = eigen::eigenvalues(point_mass.as_ref())
        .unwrap()
        .iter()
        .map(|v| v.im)
        .fold(0.0, f64::max);
    assert!(oscillation > 2.0_f64.sqrt() * G / v);
}

/// Without weight, drag and thrust the speed stays, and the short period is the root of
/// `s^2 - (Z_w + M_q) s + Z_w M_q - M_w (V + Z_q) = 0` (McRuer, Ashkenas & Graham 1973, section 5.3).
#[test]
fn val_short_period() {
    let point = cruise();
    let mut aircraft = transport();
    aircraft.gravity = 1e-9;
    aircraft.rigid.lift = longitudinal(0.0, 5.5, 8.0, 0.0);
    aircraft.rigid.pitch = longitudinal(0.0, -1.2, -22.0, -1.4);
    aircraft.rigid.drag = Drag::Polar { zero: 0.0, k: 0.045 };
    let rho = atmosphere::standard(point.altitude).density;
    let (s, c, v) = (120.0, 4.0, point.speed);
    let z_w = -rho * v * s * 5.5 / (2.0 * aircraft.mass);
    let z_q = -rho * v * s * c * 8.0 / (4.0 * aircraft.mass);
    let m_w = rho * v * s * c * -1.2 / (2.0 * 3.0e6);
    let m_q = rho * v * s * c * c * -22.0 / (4.0 * 3.0e6);
    let (sum, product) = (z_w + m_q, z_w * m_q - m_w * (v + z_q));
    let discriminant = product - 0.25 * sum * sum;
    assert!(discriminant > 0.0);
    let d = distance(
        &linear(&aircraft, &point),
        C64::new(0.5 * sum, discriminant.sqrt()),
    );
    assert!(d < 1e-9, "{d:e}");
}

/// Roll subsidence without coupling: `rho V S b^2 Clp / (4 Ixx)`.
#[test]
fn val_roll_subsidence() {
    let point = cruise();
    let mut aircraft = transport();
    aircraft.inertia[0][2] = 0.0;
    aircraft.inertia[2][0] = 0.0;
    aircraft.rigid.side = lateral(-0.8, 0.0, 0.0);
    aircraft.rigid.roll = lateral(0.0, -0.45, 0.0);
    aircraft.rigid.yaw = lateral(0.12, 0.0, -0.25);
    let rho = atmosphere::standard(point.altitude).density;
    let root = rho * point.speed * 120.0 * 34.0 * 34.0 * -0.45 / (4.0 * 1.2e6);
    let d = distance(&linear(&aircraft, &point), C64::new(root, 0.0));
    assert!(d < 1e-12, "{d:e}");
}

/// All longitudinal derivatives of the rigid aircraft at zero incidence as textbooks give them (Etkin & Reid 1996,
/// tables 4.4 and 4.5, body axes along the flight path).
#[test]
fn val_textbook_stability_derivatives() {
    let point = cruise();
    let (aircraft, lift) = level_at_zero_incidence(&point);
    let system = linear(&aircraft, &point);
    let (equations, trimmed) = trim(&aircraft, ModelOptions::default(), &point).unwrap();
    assert!(trimmed.alpha_rad.abs() < 1e-15 && equations.n_modes() == 0);
    let rho = atmosphere::standard(point.altitude).density;
    let (s, c, v, m, iyy) = (120.0, 4.0, point.speed, aircraft.mass, 3.0e6);
    let drag = 0.02 + 0.045 * lift * lift;
    let (drag_alpha, drag_q) = (2.0 * 0.045 * lift * 5.5, 2.0 * 0.045 * lift * 8.0);
    let drag_elevator = 2.0 * 0.045 * lift * 0.4;
    let per_speed = rho * v * s;
    let entries = [
        ("u", "u", -per_speed * drag / m),
        ("u", "w", per_speed * (lift - drag_alpha) / (2.0 * m)),
        ("u", "q", -per_speed * c * drag_q / (4.0 * m)),
        ("u", "theta", -G),
        ("w", "u", -per_speed * lift / m),
        ("w", "w", -per_speed * (5.5 + drag) / (2.0 * m)),
        ("w", "q", v - per_speed * c * 8.0 / (4.0 * m)),
        ("w", "theta", 0.0),
        ("q", "u", 0.0),
        ("q", "w", per_speed * c * -1.2 / (2.0 * iyy)),
        ("q", "q", per_speed * c * c * -22.0 / (4.0 * iyy)),
        ("theta", "q", 1.0),
        ("h", "w", -1.0),
        ("h", "theta", v),
        ("v", "v", per_speed * -0.8 / (2.0 * m)),
        ("v", "p", per_speed * 34.0 * 0.05 / (4.0 * m)),
        ("v", "r", per_speed * 34.0 * 0.3 / (4.0 * m) - v),
        ("v", "phi", G),
        ("phi", "p", 1.0),
        ("psi", "r", 1.0),
    ];
    let index = |name: &str| system.state_index(name).unwrap();
    for (row, column, expected) in entries {
        let found = system.a[(index(row), index(column))];
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs().max(1.0),
            "{row},{column}: {found} {expected}"
        );
    }
    let q_s = trimmed.dynamic_pressure * s;
    for (row, column, expected) in [
        ("u", 0, -q_s * drag_elevator / m),
        ("w", 0, -q_s * 0.4 / m),
        ("q", 0, q_s * c * -1.4 / iyy),
        ("u", 1, 1.0 / m),
        ("w", 1, 0.0),
    ] {
        let found = system.b[(index(row), column)];
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs().max(1e-3),
            "{row},{column}: {found} {expected}"
        );
    }
}
