//! Decks of the repository against two programs: MYSTRAN 17 and NASTRAN-95.

use albatross_fem::{BarMass, FemModel, ModelOptions, ModesOptions};
use albatross_nastran::f06;

use crate::support::{close, fixture, mac, model, read};

fn lumped() -> ModelOptions {
    ModelOptions {
        bar_mass: Some(BarMass::Lumped),
        ..ModelOptions::default()
    }
}

/// Elastic modes of a deck against printed ones: relative difference of frequencies, and 1 - MAC.
fn compare(deck: &str, printed: &str, options: &ModelOptions, rigid: usize, count: usize) -> (f64, f64) {
    let deck = read(deck);
    let model = FemModel::assemble(&deck, options).expect("a model");
    let modes = model.modes(&ModesOptions::of_deck(&deck, None)).expect("modes");
    println!("{:?} {:?}", model.remarks, modes.remarks);
    let results = f06::read(fixture(printed)).expect("results");
    let table = &results.eigenvalues[0];
    let (mut worst, mut worst_mac) = (0.0_f64, 0.0_f64);
    for k in rigid..rigid + count {
        let row = table.mode(k as u32 + 1).expect("the mode");
        worst = worst.max((modes.frequencies_hz[k] / row.frequency_hz - 1.0).abs());
        if let Some(vector) = results.eigenvectors.iter().find(|v| v.mode == row.mode) {
            worst_mac = worst_mac.max(1.0 - mac(&modes, k, vector));
        }
    }
    let residual = modes.residuals.iter().fold(0.0_f64, |m, &r| m.max(r));
    println!("{printed}: frequency {worst:.1e}, 1 - MAC {worst_mac:.1e}, residual {residual:.1e}");
    (worst, worst_mac)
}

/// Seven printed digits: 5e-7 of frequency.
#[test]
fn val_f25_against_two_programs() {
    for printed in ["f25-like/f25.f06", "f25-like/f25_nastran95.f06"] {
        let (frequency, mac) = compare("f25-like/f25.bdf", printed, &ModelOptions::default(), 6, 20);
        assert!(frequency < 1e-6, "{frequency:e}");
        assert!(mac < 1e-10, "{mac:e}");
    }
}

#[test]
fn val_f25_mass_properties() {
    let deck = read("f25-like/f25.bdf");
    let model = model(&deck);
    let printed = f06::read(fixture("f25-like/f25.f06")).expect("results");
    let expected = printed.require_weight().expect("weight");
    let own = model.weight();
    close(own.mass().expect("mass"), 81018.49, 1e-7);
    for i in 0..6 {
        for j in 0..6 {
            let size = (expected.mo[i][i] * expected.mo[j][j]).sqrt();
            assert!((own.mo[i][j] - expected.mo[i][j]).abs() < 1e-6 * size, "{i} {j}");
        }
    }
    close(model.properties().expect("mass").inertia[1][1], 6.015296e6, 1e-7);
}

#[test]
fn val_stick_aircraft() {
    for printed in ["nastran/stick.f06", "nastran/stick95.out"] {
        let (frequency, mac) = compare("nastran/stick.bdf", printed, &lumped(), 6, 20);
        assert!(frequency < 1e-6, "{frequency:e}");
        assert!(mac < 1e-9, "{mac:e}");
    }
}

/// The free beam carries no inertia about its axis: MYSTRAN prints five rigid modes.
#[test]
fn val_beams_with_lumped_mass() {
    let (frequency, mac) = compare("nastran/cant.bdf", "nastran/cant.f06", &lumped(), 0, 10);
    assert!(frequency < 1e-6, "{frequency:e}");
    assert!(mac < 1e-9, "{mac:e}");
    let (frequency, mac) = compare("nastran/free.bdf", "nastran/free.f06", &lumped(), 5, 11);
    assert!(frequency < 1e-6, "{frequency:e}");
    assert!(mac < 1e-9, "{mac:e}");
}

/// The motion without stiffness and mass is named.
#[test]
fn massless_spin_is_held_with_a_remark() {
    let deck = read("nastran/free.bdf");
    let model = FemModel::assemble(&deck, &lumped()).expect("a model");
    let modes = model.modes(&ModesOptions::of_deck(&deck, None)).expect("modes");
    assert_eq!(modes.remarks.len(), 1, "{:?}", modes.remarks);
    assert!(modes.remarks[0].contains("R1"), "{}", modes.remarks[0]);
}

/// No mode is missed: Sturm's count between neighbours.
#[test]
fn val_count_of_modes() {
    for name in [
        "f25-like/f25.bdf",
        "nastran/free.bdf",
        "nastran/stick.bdf",
        "nastran/cant.bdf",
    ] {
        let model = FemModel::assemble(&read(name), &lumped()).expect("a model");
        let modes = crate::support::modes(&model, 26);
        let mut checked = 0;
        for k in 6..25 {
            let [below, above] = [modes.frequencies_hz[k], modes.frequencies_hz[k + 1]];
            if above > 1.001 * below {
                let count = model.count_below(0.5 * (below + above)).expect("a count");
                assert_eq!(count, k + 1, "{name}");
                checked += 1;
            }
        }
        assert!(checked > 10);
    }
}
