//! Whatever is done to a file, reading ends soon and does not panic.

use std::time::{Duration, Instant};

use albatross_nastran::frames::Frames;
use albatross_nastran::{bdf, f06, write};
use proptest::prelude::*;

use crate::f06_fixtures::fixture;

/// A small generator with a fixed seed (Marsaglia, G., "Xorshift RNGs", J. Stat. Software 8, 2003).
struct Xorshift(u64);

impl Xorshift {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % n as u64).unwrap()
    }
}

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

/// Cuts, flips, deletions, repeated and exchanged stretches.
fn damage(text: &[u8], random: &mut Xorshift) -> Vec<u8> {
    let mut text = text.to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(text.len().max(1));
        let to = (at + random.below(200)).min(text.len());
        match random.below(6) {
            0 => text.truncate(at.max(1)),
            1 => text
                .get_mut(at..(at + 1).min(to))
                .into_iter()
                .flatten()
                .for_each(|b| *b ^= 1 << (at % 8)),
            2 => drop(text.drain(at..to)),
            3 => {
                let stretch = text.get(at..to).unwrap_or_default().to_vec();
                let into = random.below(text.len().max(1));
                text.splice(into..into, stretch);
            }
            4 => text
                .get_mut(at..to)
                .into_iter()
                .flatten()
                .for_each(|b| *b = b" 9*+-.,=\n\t$E"[usize::from(*b) % 12]),
            _ => text.insert(at, b"\n\r\x1a\xff\x00,*+"[at % 8]),
        }
    }
    text
}

/// The first and last part of a file, so that one case is quick.
fn excerpt(name: &str, size: usize) -> Vec<u8> {
    let text = std::fs::read(fixture(name)).unwrap();
    text.get(..size).unwrap_or(&text).to_vec()
}

#[test]
fn damaged_files_do_not_panic_and_end_soon() {
    let mut random = Xorshift(0x9E37_79B9_7F4A_7C15);
    for name in [
        "f25-like/f25.bdf",
        "f25-like/f25_nastran95.inp",
        "nastran/cant.bdf",
    ] {
        let text = excerpt(name, 12_000);
        for _ in 0..400 {
            let damaged = damage(&text, &mut random);
            let start = Instant::now();
            read_deck(&damaged);
            assert!(start.elapsed() < Duration::from_secs(5), "{name}");
        }
    }
    for name in [
        "f25-like/f25.f06",
        "f25-like/f25_nastran95.f06",
        "nastran/cant.f06",
    ] {
        let text = excerpt(name, 60_000);
        for _ in 0..400 {
            let damaged = damage(&text, &mut random);
            let start = Instant::now();
            read_results(&damaged);
            assert!(start.elapsed() < Duration::from_secs(5), "{name}");
        }
    }
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
