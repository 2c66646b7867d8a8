//! Decks of the fixtures.

use albatross_nastran::deck::{Components, Conm2Frame, Orientation};
use albatross_nastran::frames::Frames;
use albatross_nastran::{Severity, bdf, f06};
use approx::assert_relative_eq;

use crate::f06_fixtures::fixture;

#[test]
fn f25_like_deck_is_read_whole() {
    let (deck, remarks) = bdf::read_strict(fixture("f25-like/f25.bdf")).unwrap();
    assert!(remarks.is_empty(), "{remarks:?}");
    assert!(deck.raw.is_empty(), "{:?}", deck.raw_card_counts());
    assert_eq!(deck.executive, ["SOL 103"]);
    assert_eq!(deck.case_control.len(), 6);
    assert_eq!(
        (
            deck.grids.len(),
            deck.bars.len(),
            deck.bar_properties.len(),
            deck.conm2.len(),
            deck.rbe2.len()
        ),
        (114, 108, 108, 112, 5)
    );
    assert_eq!(deck.grids[&1021].position, [24.997, 18.95, 0.33512]);
    assert_eq!(deck.materials[&1].e, Some(7.0e10));
    let bar = &deck.bars[&31001];
    assert_eq!((bar.pid, bar.grids), (31001, [3001, 3002]));
    assert_eq!(bar.orientation, Some(Orientation::Vector([0.0, 0.0, 1.0])));
    let engine = &deck.conm2[&900112];
    assert_eq!((engine.frame, engine.mass), (Conm2Frame::System(0), 2300.0));
    assert_eq!(engine.offset, [0.0, 0.0, -1.5]);
    assert_eq!(engine.inertia, [15548.0, 0.0, 300.0, 0.0, 0.0, 15548.0]);
    assert_eq!(deck.params["GRDPNT"].as_integer(), Some(0));
    assert_eq!(deck.eigrl[&10].desired, Some(30));
    assert_eq!(deck.origins.of("CBAR", 31001).unwrap().line, 142);
}

/// The same model written for two programs, in two field styles.
#[test]
fn val_both_f25_like_decks_have_the_mass_that_the_solvers_print() {
    for name in ["f25-like/f25.bdf", "f25-like/f25_nastran95.inp"] {
        let (deck, _) = bdf::read_strict(fixture(name)).unwrap();
        let frames = Frames::resolve(&deck).unwrap();
        let mass: f64 = deck.conm2.values().map(|m| m.mass).sum();
        let moment = deck
            .conm2
            .values()
            .map(|m| m.mass * (frames.grid(m.grid).unwrap().position.x + m.offset[0]));
        // Grid point weight generator of NASTRAN-95, 9 digits printed.
        assert_relative_eq!(mass, 8.101_848_99e4, max_relative = 1e-8);
        // NASTRAN-95 holds coordinates in single precision.
        assert_relative_eq!(moment.sum::<f64>() / mass, 20.343_544_92, max_relative = 2e-8);
    }
    let (a, _) = bdf::read_strict(fixture("f25-like/f25.bdf")).unwrap();
    let (b, _) = bdf::read_strict(fixture("f25-like/f25_nastran95.inp")).unwrap();
    assert_eq!(a.grids, b.grids);
    assert_eq!(a.conm2, b.conm2);
    assert_eq!(
        a.bar_properties.keys().collect::<Vec<_>>(),
        b.bar_properties.keys().collect::<Vec<_>>()
    );
}

#[test]
fn small_decks_in_free_and_fixed_field() {
    for (name, grids, spc1s) in [
        ("nastran/cant.bdf", 41, 1),
        ("nastran/free.bdf", 41, 0),
        ("nastran/stick.bdf", 210, 0),
    ] {
        let (deck, remarks) = bdf::read_strict(fixture(name)).unwrap();
        assert!(remarks.is_empty(), "{name}: {remarks:?}");
        assert_eq!((deck.grids.len(), deck.spc1s.len()), (grids, spc1s), "{name}");
    }
    let (deck, _) = bdf::read_strict(fixture("nastran/cant.bdf")).unwrap();
    assert_eq!(deck.spc1s[0].components, Components::ALL);
    assert_eq!(deck.spc1s[0].points, [1]);
    assert_eq!(deck.eigrl[&1].normalization, "MASS");
}

#[test]
fn eigenvectors_in_basic_are_the_printed_ones_when_all_grids_are_in_basic() {
    let (deck, _) = bdf::read_strict(fixture("f25-like/f25.bdf")).unwrap();
    let results = f06::read(fixture("f25-like/f25.f06")).unwrap();
    let frames = Frames::resolve(&deck).unwrap();
    assert_eq!(
        results.eigenvectors_in_basic(&frames).unwrap(),
        results.eigenvectors
    );
    let (other, _) = bdf::read_strict(fixture("nastran/cant.bdf")).unwrap();
    let error = results
        .eigenvectors_in_basic(&Frames::resolve(&other).unwrap())
        .unwrap_err()
        .to_string();
    assert!(error.contains("grid 1000, which the deck lacks"), "{error}");
}

#[test]
fn an_input_deck_is_no_result_and_a_result_is_no_deck() {
    let error = f06::read(fixture("f25-like/f25.bdf")).unwrap_err().to_string();
    assert!(error.contains("input deck") && error.contains(".f06"), "{error}");
    let (_, remarks) = bdf::read(fixture("f25-like/f25.f06")).unwrap();
    assert!(remarks.iter().any(|r| r.severity == Severity::Error));
}
