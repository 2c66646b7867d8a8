//! The command as a user runs it.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn fixtures() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures"))
}

fn albatross(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_albatross"))
        .args(arguments)
        .output()
        .unwrap()
}

fn case() -> String {
    fixtures().join("f25-like/case.toml").display().to_string()
}

fn json(arguments: &[&str]) -> Value {
    let output = albatross(arguments);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A copy of the F25-like case that a test may damage.
fn copy_of_case() -> tempfile::TempDir {
    let copy = tempfile::tempdir().unwrap();
    let from = fixtures().join("f25-like");
    for folder in ["", "avl_out", "airfoils", "reference"] {
        std::fs::create_dir_all(copy.path().join(folder)).unwrap();
        for entry in std::fs::read_dir(from.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                std::fs::copy(&path, copy.path().join(folder).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    copy
}

fn replace(path: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{} has no {from}", path.display());
    std::fs::write(path, text.replacen(from, to, 1)).unwrap();
}

/// Standard error of a command that must fail.
fn failure(arguments: &[&str]) -> String {
    let output = albatross(arguments);
    assert_eq!(
        output.status.code(),
        Some(1),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
    assert!(output.stdout.is_empty(), "a failing command prints no result");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn val_every_stage_prints_json_and_a_table() {
    let case = case();
    let trim = json(&["trim", &case, "--json"]);
    assert!((trim["alpha_deg"].as_f64().unwrap() - 1.33).abs() < 0.005);
    assert!((trim["mass"].as_f64().unwrap() - 81018.49).abs() < 1e-3);
    let modes = json(&["modes", &case, "--json"]);
    assert_eq!(modes["modes"].as_array().unwrap().len(), 20);
    assert_eq!(
        json(&["strips", &case, "--json"])["strips"]
            .as_array()
            .unwrap()
            .len(),
        196
    );
    let system = json(&["linearize", &case, "--json", "--variant", "corrected"]);
    assert_eq!(system["a"].as_array().unwrap().len(), 444);
    let bode = json(&["bode", &case, "--json", "--omega", "1.0,20.0"]);
    assert_eq!(bode["outputs"]["az_cockpit"]["re"].as_array().unwrap().len(), 2);
    for stage in ["trim", "modes", "strips", "linearize"] {
        let output = albatross(&[stage, &case, "--quiet"]);
        assert!(output.status.success() && !output.stdout.is_empty(), "{stage}");
        assert!(output.stderr.is_empty(), "--quiet is quiet");
    }
}

/// A deck and its results need no case: frequencies of the stick aircraft agree between the two solvers' files, and a
/// clamped beam keeps its first mode (no mode is taken for rigid by its number).
#[test]
fn val_modes_of_files() {
    let file = |name: &str| fixtures().join("nastran").join(name).display().to_string();
    let modes = |deck: &str, results: &str| {
        json(&[
            "modes",
            "--deck",
            &file(deck),
            "--results",
            &file(results),
            "--modes",
            "4",
            "--json",
        ])
    };
    let frequency = |v: &Value, i: usize| v["modes"][i]["frequency_hz"].as_f64().unwrap();
    let (a, b) = (modes("stick.bdf", "stick.f06"), modes("stick.bdf", "stick95.out"));
    for i in 0..4 {
        assert!((frequency(&a, i) / frequency(&b, i) - 1.0).abs() < 1e-5);
    }
    assert_eq!(modes("cant.bdf", "cant.f06")["modes"][0]["number_in_file"], 1);
    assert!(failure(&["modes", "--deck", &file("cant.bdf")]).contains("--results"));
}

#[test]
fn val_run_writes_every_result() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("results");
    let case = case();
    let output = albatross(&[
        "run",
        &case,
        "--out",
        out.to_str().unwrap(),
        "--variant",
        "corrected",
    ]);
    let progress = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{progress}");
    assert_eq!(
        progress.lines().filter(|l| l.starts_with('[')).count(),
        7,
        "{progress}"
    );
    for name in [
        "trim.json",
        "state_space.json",
        "modes_table.json",
        "bode.svg",
        "doublet_3Hz.csv",
        "doublet_3Hz.svg",
    ] {
        assert!(std::fs::metadata(out.join(name)).unwrap().len() > 100, "{name}");
    }
    let leftovers = std::fs::read_dir(&out)
        .unwrap()
        .filter(|e| e.as_ref().unwrap().file_name().to_string_lossy().starts_with('.'));
    assert_eq!(leftovers.count(), 0, "no temporary file is left");
    // A time history read back: the sample count of 5 s at 1 kHz.
    let csv = std::fs::read_to_string(out.join("doublet_3Hz.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5002);
}

#[test]
fn val_neutral_models() {
    let aircraft = json(&[
        "aircraft",
        fixtures().join("oracle/aircraft_small.json").to_str().unwrap(),
    ]);
    assert_eq!(aircraft["n_states"]["unsteady"], 64);
    let wing = json(&[
        "wing",
        fixtures().join("oracle/goland_wing.json").to_str().unwrap(),
    ]);
    assert!((wing["exact"]["V"].as_f64().unwrap() - 136.95382144326476).abs() < 1e-4);
}

/// Each way in which an input can be bad: the message names the place and the cure, and nothing is written.
#[test]
fn val_bad_input_is_refused_with_place_and_cure() {
    let copy = copy_of_case();
    let at = |name: &str| copy.path().join(name);
    let case = at("case.toml").display().to_string();
    let out = copy.path().join("out");
    let run = || failure(&["run", &case, "--out", out.to_str().unwrap()]);
    let original = |name: &str| std::fs::copy(fixtures().join("f25-like").join(name), at(name)).unwrap();
    let expect = |message: &str, words: &[&str]| {
        for word in words {
            assert!(message.contains(word), "`{word}` is missing in: {message}");
        }
        assert!(!out.exists(), "nothing is half written");
    };

    // A wrong number in the deck.
    replace(
        &at("f25.bdf"),
        "GRID        1003        17.37104     2.9",
        "GRID        1003        17.3x104     2.9",
    );
    expect(&run(), &["f25.bdf", "GRID", "17.3x104"]);
    original("f25.bdf");

    // A grid that elements need is missing.
    replace(
        &at("f25.bdf"),
        "GRID        1003        17.37104     2.9-1.06907\n",
        "",
    );
    expect(&run(), &["1003"]);
    original("f25.bdf");

    // Results without eigenvectors.
    let text = std::fs::read_to_string(at("f25.f06")).unwrap();
    std::fs::write(
        at("f25.f06"),
        &text[..text.find("E I G E N V E C T O R").unwrap()],
    )
    .unwrap();
    expect(&run(), &["f25.f06", "DISPLACEMENT"]);

    // Truncated within a vector.
    std::fs::write(at("f25.f06"), &text[..text.len() * 3 / 4]).unwrap();
    let cut = run();
    expect(&cut, &["f06"]);
    original("f25.f06");

    // AVL overflow.
    replace(&at("avl_out/trim.st"), "CLa =   7.296941", "CLa = ***********");
    expect(&run(), &["trim.st", "CLa"]);
    original("avl_out/trim.st");

    // The wrong kind of AVL file.
    std::fs::copy(at("avl_out/trim.ft"), at("avl_out/trim.st")).unwrap();
    expect(&run(), &["trim.st", "ST"]);
    original("avl_out/trim.st");

    // An unknown grid in the case file.
    replace(&at("case.toml"), "grid = 3003", "grid = 3999");
    expect(&run(), &["3999"]);
    original("case.toml");

    // A file that is not there.
    replace(&at("case.toml"), "deck = \"f25.bdf\"", "deck = \"nothing.bdf\"");
    expect(&run(), &["nothing.bdf"]);
    original("case.toml");

    // An unknown variant.
    let message = failure(&["trim", &case, "--variant", "cfd"]);
    assert!(
        message.contains("`cfd`") && message.contains("corrected_lagged"),
        "{message}"
    );
}

#[test]
fn val_bad_neutral_models_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("wing.json");
    std::fs::write(&file, "{ \"y\": [1.0], ").unwrap();
    assert!(failure(&["wing", file.to_str().unwrap()]).contains("wing.json:1:"));
    std::fs::write(
        &file,
        "{\"y\":[1.0],\"dy\":[1.0],\"c\":[-1.0],\"x_ac\":[0.0],\"x_lra\":[0.0],\"cl_alpha\":[6.0],\
        \"phi\":[[1.0]],\"gamma\":[[0.0]],\"mu\":[1.0],\"omega\":[1.0],\"xi\":[0.0],\"rho\":1.0}",
    )
    .unwrap();
    assert!(failure(&["wing", file.to_str().unwrap()]).contains("chord is -1"));
    std::fs::write(
        &file,
        "{\"y\":[1.0],\"dy\":[1.0,2.0],\"c\":[1.0],\"x_ac\":[0.0],\"x_lra\":[0.0],\"cl_alpha\":[6.0],\
        \"phi\":[[1.0]],\"gamma\":[[0.0]],\"mu\":[1.0],\"omega\":[1.0],\"xi\":[0.0],\"rho\":1.0}",
    )
    .unwrap();
    assert!(failure(&["wing", file.to_str().unwrap()]).contains("`dy`"));
}
