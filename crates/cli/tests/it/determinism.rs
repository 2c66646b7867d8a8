//! The same inputs give the same bytes: from run to run, and with one thread or two.

use crate::support::fixtures;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// Standard output and the files written by commands, each in a directory of its own, with so many threads.
///
/// No file is left out of the comparison. Of `identify` the key `seconds`, the time taken, is, in its JSON; nothing else
/// holds a date, a time or a path that changes. `run` without `--json` ends its text with the seconds that it took, which is
/// why `--json` is given; progress goes to standard error.
fn outcome(commands: &[(&str, Vec<String>)], threads: &str, place: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for (name, arguments) in commands {
        // The same relative names in every directory, since reports and JSON show them.
        let directory = place.join(name);
        std::fs::create_dir_all(&directory).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_albatross"))
            .args(arguments)
            .current_dir(&directory)
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {message}");
        let timed = ["identify", "search"].contains(name);
        let content = |bytes: Vec<u8>| if timed { without_seconds(bytes) } else { bytes };
        found.insert(format!("{name}: standard output"), content(output.stdout));
        for (file, bytes) in files(&directory) {
            found.insert(format!("{name}: {file}"), content(bytes));
        }
    }
    found
}

/// Text without the lines of the key `seconds`; other content as it is.
fn without_seconds(bytes: Vec<u8>) -> Vec<u8> {
    match String::from_utf8(bytes) {
        Ok(text) => text
            .lines()
            .filter(|line| !line.trim_start().starts_with("\"seconds\": "))
            .flat_map(|line| [line, "\n"])
            .collect::<String>()
            .into_bytes(),
        Err(other) => other.into_bytes(),
    }
}

/// Files of a directory and of those in it.
fn files(directory: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            let below = files(&path).into_iter();
            found.extend(below.map(|(n, content)| (format!("{name}/{n}"), content)));
        } else {
            found.push((name, std::fs::read(&path).unwrap()));
        }
    }
    found
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// Analyses with threads (root locus, order search) and without, solvers, and every format of export.
#[test]
fn val_same_bytes_with_any_number_of_threads() {
    let inputs = tempfile::tempdir().unwrap();
    let case = inputs.path().join("case.toml");
    let case = case.display();
    let status = Command::new(env!("CARGO_BIN_EXE_albatross"))
        .args(["new", "--quiet"])
        .arg(inputs.path())
        .status()
        .unwrap();
    assert!(status.success());
    let fixture = |name: &str| fixtures().join(name).display().to_string();
    let records: Vec<String> = ["doublet_0p5Hz.csv", "doublet_3Hz.csv"]
        .iter()
        .map(|name| fixture(&format!("f25-like/reference/{name}")))
        .collect();
    let records = records.join(" ");
    let identify =
        "--input elevator --output q --decimate 16 --starts 4 --refined 2 --moves 2 --json --quiet --out out";
    let linear = format!("export {case} --json --quiet --to a.mat a.npz a.json a.csv a.vtu");
    let history =
        format!("export {case} --json --quiet --manoeuvre aileron_3211 --to b.csv b.mat b.npz b.json");
    let history = history
        + if cfg!(feature = "parquet") {
            " b.parquet"
        } else {
            ""
        };
    let commands = [
        ("run", words(&format!("run {case} --out out --json --quiet"))),
        ("linear model", words(&linear)),
        ("time history", words(&history)),
        (
            "identify",
            words(&format!("identify --np 4 {identify} --seed 7 {records}")),
        ),
        (
            "search",
            words(&format!("identify search --np 2..4 {identify} {records}")),
        ),
        (
            "modes of the deck",
            words(&format!(
                "solve-modes {} --modes 26 --json --quiet --vectors --f06 own.f06",
                fixture("f25-like/f25.bdf")
            )),
        ),
        (
            "lattice",
            words(&format!(
                "vlm {} --cl 0.5644 --trim elevator=Cm --json --quiet --write own",
                fixture("f25-like/f25.avl")
            )),
        ),
        (
            "wing",
            words(&format!("wing {}", fixture("oracle/goland_wing.json"))),
        ),
        (
            "aircraft",
            words(&format!("aircraft {}", fixture("oracle/aircraft_small.json"))),
        ),
    ];
    let mut first: Option<BTreeMap<String, Vec<u8>>> = None;
    for (round, threads) in ["1", "1", "2", "2"].into_iter().enumerate() {
        let place = tempfile::tempdir().unwrap();
        let found = outcome(&commands, threads, place.path());
        let Some(first) = &first else {
            assert!(found.len() > 40, "{:?}", found.keys());
            first = Some(found);
            continue;
        };
        assert!(first.keys().eq(found.keys()));
        for (name, content) in first {
            assert!(
                found[name] == *content,
                "{name} differs between the first run with 1 thread and run {} with {threads}",
                round + 1
            );
        }
    }
}
