//! Cases with one wrong number somewhere in their files, each of which still reads as a number.
//!
//! A case with a wrong number is checked without a panic, and what is found names its place. Where `check` finds no
//! error it says that the case runs: then every variant is built, trimmed and linearised.

use albatross::check::{Severity, check};
use albatross::{Inputs, Model};
use rayon::prelude::*;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// How often each file is damaged.
const DAMAGES: usize = 25;

/// What a slip makes of a number; read as numbers by every format.
const NUMBERS: [&str; 12] = [
    "0", "-1", "1", "7", "1e3", "-1e3", "1e-9", "1e12", "9999", "0.5", "1e30", "-0.",
];

const FILES: [&str; 9] = [
    "case.toml",
    "f25.bdf",
    "f25.f06",
    "f25.avl",
    "avl_out/trim.st",
    "avl_out/alpha1.fs",
    "avl_out/alpha2.fs",
    "reference/strips_reference.csv",
    "reference/derivatives_reference.json",
];

fn f25() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like"))
}

/// The text with one of its numbers replaced, in its columns where the new number fits.
fn wrong_number(text: &str, random: &mut fastrand::Rng) -> String {
    let of_number = |c: char| c.is_ascii_digit() || c == '.';
    let starts: Vec<usize> = text
        .char_indices()
        .filter(|&(i, c)| {
            of_number(c) && !text[..i].ends_with(|b: char| of_number(b) || b.is_ascii_alphabetic())
        })
        .map(|(i, _)| i)
        .collect();
    let start = starts[random.usize(..starts.len())];
    let length = text[start..]
        .find(|c| !of_number(c))
        .unwrap_or(text.len() - start);
    let number = NUMBERS[random.usize(..NUMBERS.len())];
    format!("{}{number:<length$}{}", &text[..start], &text[start + length..])
}

/// What is wrong with how a damaged case is handled.
fn mishandled(case: &Path) -> Option<String> {
    let Ok(report) = catch_unwind(|| check(case)) else {
        return Some("check panics".into());
    };
    if let Some(finding) = report
        .findings
        .iter()
        .find(|f| f.place.is_empty() || f.what.is_empty())
    {
        return Some(format!("no place or no text: {finding:?}"));
    }
    let refused = report.worst() == Some(Severity::Error);
    let run = catch_unwind(AssertUnwindSafe(|| -> Result<(), albatross::Error> {
        let inputs = Inputs::read(case)?;
        for variant in &inputs.case.variants {
            albatross::analysis::trimmed(&Model::build(&inputs, variant)?)?;
        }
        Ok(())
    }));
    match run {
        Err(_) => Some("the model panics".into()),
        Ok(Err(error)) if !refused => Some(format!("check finds no error, but: {error}")),
        Ok(_) => None,
    }
}

/// A copy of the files of the case.
fn copy() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    for name in ["avl_out", "reference", "airfoils"] {
        fs::create_dir(at(name)).unwrap();
    }
    for entry in fs::read_dir(f25().join("airfoils")).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, at("airfoils").join(path.file_name().unwrap())).unwrap();
    }
    for name in FILES {
        fs::copy(f25().join(name), at(name)).unwrap();
    }
    directory
}

#[test]
fn prop_a_case_that_passes_its_check_runs() {
    assert_eq!(mishandled(&copy().path().join("case.toml")), None);
    let wrong: Vec<String> = FILES
        .par_iter()
        .flat_map_iter(|name| {
            let directory = copy();
            let text = fs::read_to_string(f25().join(name)).unwrap();
            let mut random = fastrand::Rng::with_seed(0xA1BA);
            (0..DAMAGES).filter_map(move |_| {
                let damaged = wrong_number(&text, &mut random);
                fs::write(directory.path().join(name), &damaged).unwrap();
                mishandled(&directory.path().join("case.toml")).map(|what| {
                    let line = damaged.lines().zip(text.lines()).find(|(a, b)| a != b);
                    format!("{name}: {what}\n    {line:?}")
                })
            })
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
