//! Fixtures and small models that several tests use.

use albatross_modal::{
    BasisGrid, BasisMass, BasisOptions, MassMatrix, MassModel, ModalBasis, ModeInput, OnViolation,
};
use albatross_nastran::{Deck, ModalResults, bdf, f06};
use std::path::PathBuf;

pub(crate) fn fixture(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures")).join(name)
}

pub(crate) fn deck(name: &str) -> Deck {
    bdf::read_strict(fixture(name)).expect("a readable deck").0
}

pub(crate) fn results(name: &str) -> ModalResults {
    f06::read(fixture(name)).expect("readable results")
}

pub(crate) fn f25_mystran() -> (Deck, ModalResults) {
    (deck("f25-like/f25.bdf"), results("f25-like/f25.f06"))
}

pub(crate) fn f25_nastran95() -> (Deck, ModalResults) {
    (deck("f25-like/f25.bdf"), results("f25-like/f25_nastran95.f06"))
}

/// Positions of grids 1, 2, ... as basis grids.
pub(crate) fn numbered(positions: &[[f64; 3]]) -> Vec<BasisGrid> {
    positions
        .iter()
        .zip(1..)
        .map(|(&position, id)| BasisGrid { id, position })
        .collect()
}

/// A basis of given shapes without mass; frequencies 1, 2, ... rad/s.
pub(crate) fn basis_of(positions: &[[f64; 3]], shapes: Vec<Vec<[f64; 6]>>) -> ModalBasis {
    ModalBasis::try_new(
        numbered(positions),
        inputs(shapes),
        BasisMass::unknown(),
        &BasisOptions::default(),
    )
    .expect("a valid basis")
}

pub(crate) fn inputs(shapes: Vec<Vec<[f64; 6]>>) -> Vec<ModeInput> {
    let mode = |(shape, number): (Vec<[f64; 6]>, usize)| ModeInput {
        number,
        omega_rad_s: number as f64,
        generalized_mass: 1.0,
        shape,
    };
    shapes.into_iter().zip(1..).map(mode).collect()
}

/// The mass of a model for grids numbered from 1.
pub(crate) fn mass_of(model: &MassModel, grids: &[BasisGrid]) -> BasisMass {
    let ids: Vec<u32> = grids.iter().map(|g| g.id).collect();
    BasisMass {
        properties: model.properties(),
        matrix: Ok(MassMatrix::on_grids(model, &ids).expect("all grids")),
        free_directions: [true; 6],
    }
}

pub(crate) fn options(on_violation: OnViolation) -> BasisOptions {
    BasisOptions {
        on_violation,
        ..BasisOptions::default()
    }
}

/// Largest magnitude over all entries.
pub(crate) fn largest(shape: &[[f64; 6]]) -> f64 {
    shape.iter().flatten().fold(0.0, |a, v| a.max(v.abs()))
}

pub(crate) fn largest_difference(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}
