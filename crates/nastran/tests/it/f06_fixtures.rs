//! Results of the fixtures: the same decks solved by MYSTRAN and by NASTRAN-95.

use albatross_nastran::{Dialect, Eigenvector, ModalResults, Severity, f06};
use approx::assert_relative_eq;

pub(crate) fn fixture(name: &str) -> String {
    format!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/{}"), name)
}

fn read(name: &str) -> ModalResults {
    f06::read(fixture(name)).unwrap()
}

#[test]
fn val_f25_like_is_the_same_from_both_solvers() {
    let mystran = read("f25-like/f25.f06");
    let n95 = read("f25-like/f25_nastran95.f06");
    assert_eq!(
        (mystran.dialect, n95.dialect),
        (Dialect::Mystran, Dialect::Nastran95)
    );
    for r in [&mystran, &n95] {
        assert!(
            r.diagnostics.iter().all(|d| d.severity < Severity::Error),
            "{:?}",
            r.diagnostics
        );
        assert_eq!(r.eigenvalues.len(), 1);
        assert_eq!(r.weights.len(), 1);
    }
    assert_eq!(mystran.eigenvalues[0].modes.len(), 30);
    assert_eq!(n95.eigenvalues[0].modes.len(), 70);
    assert_eq!(mystran.eigenvectors.len(), 30);
    assert_eq!(n95.eigenvectors.len(), 70);
    assert!(
        mystran
            .eigenvectors
            .iter()
            .chain(&n95.eigenvectors)
            .all(|v| v.rows.len() == 114)
    );
    for (a, b) in mystran.eigenvalues[0]
        .modes
        .iter()
        .zip(&n95.eigenvalues[0].modes)
        .skip(6)
    {
        assert_relative_eq!(a.eigenvalue, b.eigenvalue, max_relative = 1e-6);
        assert_relative_eq!(a.frequency_hz, b.frequency_hz, max_relative = 1e-6);
    }
    // The mass matrix has 7 printed digits from MYSTRAN, 9 from NASTRAN-95.
    for (weight, digits) in [(&mystran.weights[0], 2e-6), (&n95.weights[0], 2e-8)] {
        assert_relative_eq!(weight.mass().unwrap(), 81018.49, max_relative = 2e-7);
        let cg = weight.center_of_gravity();
        assert_relative_eq!(cg.x, 20.343_544_92, max_relative = digits);
        assert_relative_eq!(cg.z, -0.427_677_146_2, max_relative = digits);
        assert_relative_eq!(cg.y, 0.0, epsilon = 1e-12);
        // As NASTRAN-95 prints them under I(S), products with the tensor's sign.
        let inertia = weight.inertia_about_cg();
        assert_relative_eq!(inertia[(0, 0)], 1.674_497_693e6, max_relative = digits);
        assert_relative_eq!(inertia[(1, 1)], 6.015_296_252e6, max_relative = digits);
        assert_relative_eq!(inertia[(2, 2)], 7.435_796_744e6, max_relative = digits);
        assert_relative_eq!(inertia[(0, 2)], -2.491_143_830e5, max_relative = 5.0 * digits);
    }
    assert_relative_eq!(mystran.weights[0].inertia_s.unwrap()[0][2], -2.491144e5);
    assert_relative_eq!(n95.weights[0].inertia_s.unwrap()[0][2], 2.491_143_830e5);
}

/// Modal assurance criterion of two vectors over the same grids: the squared cosine of the angle between them.
fn mac(a: &Eigenvector, b: &Eigenvector) -> f64 {
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for row in &a.rows {
        let other = b.grid(row.id).unwrap();
        for (x, y) in row.values.iter().zip(other.values) {
            ab += x * y;
            aa += x * x;
            bb += y * y;
        }
    }
    ab * ab / (aa * bb)
}

#[test]
fn val_elastic_shapes_are_the_same_from_both_solvers() {
    for (mystran, n95, modes) in [
        ("f25-like/f25.f06", "f25-like/f25_nastran95.f06", 7..=30),
        ("nastran/stick.f06", "nastran/stick95.out", 7..=26),
    ] {
        let (a, b) = (read(mystran), read(n95));
        for mode in modes {
            let find = |r: &ModalResults| r.eigenvectors.iter().find(|v| v.mode == mode).unwrap().clone();
            let (va, vb) = (find(&a), find(&b));
            let (fa, fb) = (
                a.eigenvalues[0].mode(mode).unwrap(),
                b.eigenvalues[0].mode(mode).unwrap(),
            );
            assert_relative_eq!(fa.eigenvalue, fb.eigenvalue, max_relative = 1e-5);
            // Seven printed digits.
            let difference = 1.0 - mac(&va, &vb);
            assert!(
                difference < 1e-10,
                "{mystran} mode {mode}: 1 - MAC = {difference:e}"
            );
        }
    }
}

#[test]
fn val_stick_weight_is_the_same_from_both_solvers() {
    let (a, b) = (read("nastran/stick.f06"), read("nastran/stick95.out"));
    let (a, b) = (a.require_weight().unwrap(), b.require_weight().unwrap());
    assert_relative_eq!(a.mass().unwrap(), b.mass().unwrap(), max_relative = 1e-7);
    assert_relative_eq!(
        a.center_of_gravity(),
        b.center_of_gravity(),
        max_relative = 1e-6,
        epsilon = 1e-12
    );
    // The tensor that MYSTRAN prints about the centre of gravity.
    let printed = a.inertia_s.unwrap();
    for (i, row) in printed.iter().enumerate() {
        for (j, &value) in row.iter().enumerate() {
            // A difference of moments of 3e7 that are printed to seven digits: half a unit of the mass moment
            // times twice the arm of 18 m.
            assert_relative_eq!(a.inertia_about_cg()[(i, j)], value, epsilon = 25.0);
            assert_relative_eq!(b.inertia_about_cg()[(i, j)], value, epsilon = 1.0);
        }
    }
}

/// Euler and Bernoulli's cantilever: omega = (beta L)^2 sqrt(E I / (rho A L^4)), beta L = 1.875104, 4.694091.
#[test]
fn val_cantilever_frequencies_are_those_of_beam_theory() {
    let r = read("nastran/cant.f06");
    assert!(
        r.diagnostics.iter().all(|d| d.severity < Severity::Error),
        "{:?}",
        r.diagnostics
    );
    assert_eq!((r.eigenvectors.len(), r.eigenvectors[0].rows.len()), (10, 41));
    let omega =
        |beta_l: f64, i: f64| beta_l.powi(2) * (7.0e10 * i / (2700.0 * 0.005 * 2.0_f64.powi(4))).sqrt();
    let found: Vec<f64> = r.eigenvalues[0]
        .modes
        .iter()
        .take(3)
        .map(|m| m.omega_rad_s)
        .collect();
    let expected = [
        omega(1.875_104_07, 1.041_666_667e-6),
        omega(1.875_104_07, 4.166_666_667e-6),
        omega(4.694_091_13, 1.041_666_667e-6),
    ];
    for (found, expected) in found.iter().zip(expected) {
        // 40 elements with consistent mass.
        assert_relative_eq!(*found, expected, max_relative = 2e-3);
    }
    // Clamped at grid 1.
    assert!(
        r.eigenvectors
            .iter()
            .all(|v| v.grid(1).unwrap().values == [0.0; 6])
    );
}

/// A free bar without torsional inertia has five rigid modes: counting six would lose the first bending mode.
#[test]
fn val_free_beam_has_five_rigid_modes() {
    let r = read("nastran/free.f06");
    assert_eq!(r.eigenvectors.len(), 16);
    let omegas: Vec<f64> = r.eigenvalues[0].modes.iter().map(|m| m.omega_rad_s).collect();
    assert_eq!(
        omegas.iter().position(|&omega| omega > 1.0),
        Some(5),
        "{omegas:?}"
    );
    // Free-free beam: beta L = 4.730041 (Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1).
    let expected =
        4.730_041_f64.powi(2) * (7.0e10 * 1.041_666_667e-6 / (2700.0 * 0.005 * 2.0_f64.powi(4))).sqrt();
    assert_relative_eq!(omegas[5], expected, max_relative = 5e-3);
}
