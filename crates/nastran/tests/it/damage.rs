//! Whatever is done to a file, reading ends soon and does not panic. Mutations of files of all readers are tested in
//! the facade, `crates/albatross/tests/it/damage.rs`.

use std::time::{Duration, Instant};

use albatross_nastran::frames::Frames;
use albatross_nastran::{bdf, f06, write};
use proptest::prelude::*;

use crate::f06_fixtures::fixture;

fn read_deck(text: &[u8]) {
    let (deck, _) = bdf::parse(text, "damaged");
    let _ = Frames::resolve(&deck);
    let _ = write::to_text(&deck);
}

fn read_results(text: &[u8]) {
    if let Ok(r) = f06::parse(text, "damaged") {
        for w in &r.weights {
            let _ = w.inertia_about_cg();
        }
    }
}

/// The first and last part of a file, so that one case is quick.
fn excerpt(name: &str, size: usize) -> Vec<u8> {
    let text = std::fs::read(fixture(name)).unwrap();
    text.get(..size).unwrap_or(&text).to_vec()
}

#[test]
fn files_cut_anywhere_do_not_panic() {
    let deck = excerpt("nastran/cant.bdf", 4_000);
    (0..deck.len()).for_each(|end| read_deck(&deck[..end]));
    let results = excerpt("f25-like/f25_nastran95.f06", 60_000);
    (0..results.len())
        .step_by(97)
        .for_each(|end| read_results(&results[..end]));
    let results = excerpt("f25-like/f25.f06", 60_000);
    (0..results.len())
        .step_by(97)
        .for_each(|end| read_results(&results[..end]));
}

#[test]
fn hostile_decks_are_bounded() {
    let start = Instant::now();
    for text in [
        "SPOINT,1,THRU,99999999\n",
        "SPC1,1,123,1,THRU,99999999\n",
        "SET1,1,1,THRU,99999999,BY,3,EXCEPT,5,THRU,99999990\n",
        "GRID,1\n=,*1\n=(999999)\n",
        "GRID,1\n=(99999999999)\n",
        "=\n=(3)\n==\n",
        "SET1,1,1,THRU,10,EXCEPT,1,THRU,99999999\n",
        "RBE3,1\nPBEAM,1\nPBEAML,1,1,,ROD\nMPC\nPBUSH\nCORD1R\nSPC\nSET1\nEIGRL\nPARAM\n",
    ] {
        read_deck(text.as_bytes());
    }
    // A long chain of systems must not exhaust the stack.
    let mut chain = String::new();
    for id in (1..=100_000).rev() {
        chain += &format!("CORD2R,{id},{},0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", id - 1);
    }
    let (deck, _) = bdf::parse(chain.as_bytes(), "chain");
    assert!(Frames::resolve(&deck).is_ok());
    assert!(start.elapsed() < Duration::from_secs(60));
}

proptest! {
    #[test]
    fn prop_any_text_is_read(text in "(GRID|CBAR|PBEAML?|RBE3|SET1|=|MPC|\\*|\\+|,| |[0-9.E+-]{1,9}|THRU|EXCEPT|\n|INCLUDE|'|BEGIN BULK|CEND|\\$|\t){0,80}") {
        read_deck(text.as_bytes());
    }

    #[test]
    fn prop_any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        read_deck(&bytes);
        read_results(&bytes);
    }
}
