//! Modes of a grillage of 20,000 grids against the factorisation of the same matrices, and of the F25-like surrogate.
//!
//! The limit set for the first is 20 s on one core for 40 modes.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    missing_docs,
    unreachable_pub,
    dead_code
)]

#[path = "../tests/it/grillage_deck.rs"]
mod grillage_deck;

use albatross_fem::{FemModel, ModelOptions, ModesOptions};
use criterion::{Criterion, criterion_group, criterion_main};
use std::time::Instant;

fn large(_: &mut Criterion) {
    for (name, torsion, skew) in [("flat", 0.0, false), ("skew", 1e-6, true)] {
        let deck = grillage_deck::grillage(100, 200, torsion, skew);
        let start = Instant::now();
        let model = FemModel::assemble(&deck, &ModelOptions::default()).unwrap();
        let assembled = start.elapsed().as_secs_f64();
        let one = ModesOptions {
            count: Some(1),
            ..ModesOptions::default()
        };
        let start = Instant::now();
        model.modes(&one).unwrap();
        let first = start.elapsed().as_secs_f64();
        let forty = ModesOptions {
            count: Some(40),
            ..ModesOptions::default()
        };
        let start = Instant::now();
        let modes = model.modes(&forty).unwrap();
        let all = start.elapsed().as_secs_f64();
        println!(
            "grillage {name}: assembled in {assembled:.2} s; 40 modes in {all:.1} s, {:.1} times one mode, {:.0} % of the \
             limit of 20 s; {:.1e} entries in the factor",
            all / first,
            5.0 * (all + assembled),
            modes.factor_entries as f64
        );
    }
}

fn surrogate(c: &mut Criterion) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/f25.bdf");
    let (deck, _) = albatross_nastran::bdf::read_strict(file).unwrap();
    let model = FemModel::assemble(&deck, &ModelOptions::default()).unwrap();
    let options = ModesOptions::of_deck(&deck, None);
    c.bench_function("f25: assembly", |b| {
        b.iter(|| FemModel::assemble(&deck, &ModelOptions::default()).unwrap());
    });
    c.bench_function("f25: 30 modes", |b| b.iter(|| model.modes(&options).unwrap()));
}

criterion_group!(benches, large, surrogate);
criterion_main!(benches);
