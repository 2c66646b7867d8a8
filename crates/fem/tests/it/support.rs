//! Decks from text, and comparisons.

use albatross_fem::{FemModel, ModelOptions, Modes, ModesOptions};
use albatross_nastran::{Deck, Eigenvector, bdf, refuse_errors};
use std::path::PathBuf;

pub(crate) fn fixture(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures")
        .join(name)
}

pub(crate) fn read(name: &str) -> Deck {
    bdf::read_strict(fixture(name)).expect("a valid deck").0
}

pub(crate) fn parse(bulk: &str) -> Deck {
    with_case("", bulk)
}

pub(crate) fn with_case(case: &str, bulk: &str) -> Deck {
    let text = format!("SOL 103\nCEND\n{case}\nBEGIN BULK\n{bulk}\nENDDATA\n");
    refuse_errors(bdf::parse(text.as_bytes(), "test.bdf"))
        .expect("a valid deck")
        .0
}

pub(crate) fn model(deck: &Deck) -> FemModel {
    FemModel::assemble(deck, &ModelOptions::default()).expect("a model")
}

pub(crate) fn modes(model: &FemModel, count: usize) -> Modes {
    let options = ModesOptions {
        count: Some(count),
        ..ModesOptions::default()
    };
    model.modes(&options).expect("modes")
}

/// Modal assurance criterion of two vectors on the grids of the second, in CD systems.
pub(crate) fn mac(modes: &Modes, mode: usize, other: &Eigenvector) -> f64 {
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for row in &other.rows {
        let own = modes.at(mode, row.id).expect("the grid");
        for (a, b) in own.iter().zip(row.values) {
            ab += a * b;
            aa += a * a;
            bb += b * b;
        }
    }
    ab * ab / (aa * bb)
}

pub(crate) fn close(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance * expected.abs(),
        "{got} differs from {expected} by {:.2e}",
        (got / expected - 1.0).abs()
    );
}
