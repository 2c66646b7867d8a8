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

/// Whether a damaged case passes its check; or what is wrong with how it is handled.
fn passes(case: &Path) -> Result<bool, String> {
    let Ok(report) = catch_unwind(|| check(case)) else {
        return Err("check panics".into());
    };
    if let Some(finding) = report
        .findings
        .iter()
        .find(|f| f.place.is_empty() || f.what.is_empty())
    {
        return Err(format!("no place or no text: {finding:?}"));
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
        Err(_) => Err("the model panics".into()),
        Ok(Err(error)) if !refused => Err(format!("check finds no error, but: {error}")),
        Ok(_) => Ok(!refused),
    }
}

/// The files that the case reads, of which each is damaged.
fn files() -> Vec<String> {
    let case = f25().join("case.toml");
    let sources = Inputs::read(&case).unwrap().sources(&case).unwrap();
    sources.into_iter().map(|source| source.path).collect()
}

/// A copy of them.
fn copy(files: &[String]) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    for name in files {
        let to = directory.path().join(name);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(f25().join(name), to).unwrap();
    }
    directory
}

#[test]
fn prop_a_case_that_passes_its_check_runs() {
    let files = files();
    assert_eq!(passes(&copy(&files).path().join("case.toml")), Ok(true));
    let outcomes: Vec<Result<bool, String>> = files
        .par_iter()
        .flat_map_iter(|name| {
            let directory = copy(&files);
            let text = fs::read_to_string(f25().join(name)).unwrap();
            let mut random = fastrand::Rng::with_seed(0xA1BA);
            (0..DAMAGES).map(move |_| {
                let damaged = wrong_number(&text, &mut random);
                fs::write(directory.path().join(name), &damaged).unwrap();
                passes(&directory.path().join("case.toml")).map_err(|what| {
                    let line = damaged.lines().zip(text.lines()).find(|(a, b)| a != b);
                    format!("{name}: {what}\n    {line:?}")
                })
            })
        })
        .collect();
    let wrong: Vec<&String> = outcomes.iter().filter_map(|o| o.as_ref().err()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // Neither side of the property is empty.
    let passed = outcomes.iter().filter(|o| **o == Ok(true)).count();
    let refused = outcomes.len() - passed;
    assert!(
        outcomes.len() == 9 * DAMAGES && passed > 50 && refused > 20,
        "{passed} passed, {refused} refused"
    );
}
