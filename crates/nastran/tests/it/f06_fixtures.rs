//! Results of the fixtures: the same decks solved by MYSTRAN and by NASTRAN-95.

use albatross_nastran::{Dialect, ModalResults, Severity, f06};
use approx::assert_relative_eq;

pub(crate) fn fixture(name: &str) -> String {
    format!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/{}"), name)
}

fn read(name: &str) -> ModalResults {
    f06::read(fixture(name)).unwrap()
}

/// Number of rows and the sum over all absolute values, to notice any lost or shifted column.
fn vector_sum(r: &ModalResults) -> f64 {
    r.eigenvectors
        .iter()
        .flat_map(|v| &v.rows)
        .flat_map(|row| row.values)
        .map(f64::abs)
        .sum()
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
        println!("{:?}", r.diagnostics);
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
    assert!(vector_sum(&mystran) > 0.0);
}
