//! Goland's wing: assumed modes, convergence in strips and modes, published flutter.

use crate::models::{UniformWing, gauss};
use albatross_strip::flutter::{divergence_speed, exact_flutter, lag_flutter};
use albatross_strip::kernels::JONES;
use serde_json::Value;

fn oracle() -> Value {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/oracle/goland_wing.json"
    );
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn off(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Natural frequencies of 7 + 7 polynomials against the independent implementation.
#[test]
fn val_natural_frequencies() {
    let expected: Vec<f64> = serde_json::from_value(oracle()["natural_omega"].clone()).unwrap();
    for (found, expected) in UniformWing::goland().frequencies(7).iter().zip(expected) {
        assert!(off(*found, expected) < 1e-9, "{found} {expected}");
    }
}

/// Flutter by Jones's lags for every number of strips and modes of the oracle's table.
#[test]
fn val_convergence_in_strips_and_modes() {
    let oracle = oracle();
    let wing = UniformWing::goland();
    for (strips, row) in oracle["convergence_jones_V_omega"].as_object().unwrap() {
        for (modes, point) in row.as_object().unwrap() {
            let (strips, modes): (usize, usize) = (strips.parse().unwrap(), modes.parse().unwrap());
            let model = wing.model(&wing.equal_strips(strips), 7, modes, &JONES);
            let found = lag_flutter(&model, 1.225).unwrap().unwrap();
            let errors = [
                off(found.speed, point[0].as_f64().unwrap()),
                off(found.omega_rad_s, point[1].as_f64().unwrap()),
            ];
            println!("{strips} strips, {modes} modes: {errors:?}");
            assert!(errors.iter().all(|e| *e < 1e-9), "{strips} {modes}: {errors:?}");
        }
    }
}

/// The continuous wing (strips at Gauss points) by exact and approximate aerodynamics, and divergence.
#[test]
fn val_continuous_wing() {
    let oracle = oracle();
    let continuous = &oracle["continuous"];
    let wing = UniformWing::goland();
    let model = wing.model(&gauss(24, wing.semi_span), 7, 10, &JONES);
    let exact = exact_flutter(&model, 1.225).unwrap().unwrap();
    let jones = lag_flutter(&model, 1.225).unwrap().unwrap();
    for (found, key) in [(exact, "exact"), (jones, "jones")] {
        let at = |part: &str| continuous[key][part].as_f64().unwrap();
        println!(
            "{key}: {:e} {:e}",
            off(found.speed, at("V")),
            off(found.omega_rad_s, at("omega"))
        );
        assert!(off(found.speed, at("V")) < 1e-9 && off(found.omega_rad_s, at("omega")) < 1e-9);
    }
    let divergence = divergence_speed(&model, 1.225).unwrap().unwrap();
    assert!(off(divergence, continuous["divergence_V"].as_f64().unwrap()) < 1e-8);
    // Closed form of the clamped-free uniform wing: q e c cl_alpha (2 L / pi)^2 = GJ. All twist modes are needed.
    let all = wing.model(&gauss(24, wing.semi_span), 7, 14, &JONES);
    let eccentricity = (wing.axis - 0.25) * wing.chord;
    let q = wing.torsion * (std::f64::consts::FRAC_PI_2 / wing.semi_span).powi(2)
        / (eccentricity * wing.chord * std::f64::consts::TAU);
    let closed_form = (2.0 * q / 1.225).sqrt();
    let divergence = divergence_speed(&all, 1.225).unwrap().unwrap();
    assert!(off(divergence, closed_form) < 1e-9, "{divergence} {closed_form}");
}

/// Goland & Luke, J. Applied Mechanics 15 (1948): 137.2 m/s, 70.7 rad/s, to the digits that a hand calculation of
/// that time carries; and the exact solution for the figures mu 35.717, I 8.642, EI 9.773e6, GJ 9.876e5 with 6 + 6
/// polynomials, published with twelve digits by the authors of ContourRoots.
#[test]
fn val_published_flutter() {
    let wing = UniformWing::goland();
    let model = wing.model(&gauss(24, wing.semi_span), 7, 10, &JONES);
    let found = exact_flutter(&model, 1.225).unwrap().unwrap();
    assert!(off(found.speed, 137.2) < 2e-3 && off(found.omega_rad_s, 70.7) < 1e-2);

    let wing = UniformWing {
        mass: 35.717,
        inertia: 8.642,
        static_moment: 35.717 * 0.183,
        bending: 9.773e6,
        torsion: 9.876e5,
        ..wing
    };
    let model = wing.model(&gauss(24, wing.semi_span), 6, 12, &JONES);
    let found = exact_flutter(&model, 1.225).unwrap().unwrap();
    println!("{found:?}");
    assert!(off(found.speed, 136.983977449) < 1e-8 && off(found.omega_rad_s, 70.033012953) < 1e-8);
}
