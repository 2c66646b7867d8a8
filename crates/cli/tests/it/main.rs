//! The command as a user runs it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod case_page;
mod check;
mod determinism;
mod export;
mod formats_page;
mod identify;
mod killed;
mod options;
mod report;
mod solvers;
mod start;
mod support;

// The messages hold texts of the operating system.
#[cfg(unix)]
mod errors;

use support::{CaseCopy, albatross, case, failure, fixtures, json};

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
        9,
        "{progress}"
    );
    for name in [
        "trim.json",
        "state_space.json",
        "modes_table.json",
        "bode.svg",
        "doublet_3Hz.csv",
        "doublet_3Hz.svg",
        "root_locus.json",
        "mode_shapes.svg",
        "report.html",
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

/// A run whose input cannot be used writes nothing; docs/ERRORS.md has more ways to be refused.
#[test]
fn val_bad_input_is_refused_with_place_and_cure() {
    let copy = CaseCopy::new();
    let (case, out) = (copy.arg("case.toml"), copy.arg("out"));
    let refused = |file: &str, from: &str, to: &str, words: &[&str]| {
        copy.replace(file, from, to);
        let message = failure(&["run", &case, "--out", &out]);
        for word in words {
            assert!(message.contains(word), "`{word}` is missing in: {message}");
        }
        assert!(!copy.at("out").exists(), "nothing is half written");
        copy.restore(file);
    };
    refused(
        "f25.bdf",
        "17.37104",
        "17.3x104",
        &["f25.bdf", "GRID", "17.3x104"],
    );
    refused("f25.f06", "-1.388187E-05", "-1.388x87E-05", &["f25.f06", "1003"]);
    refused(
        "avl_out/trim.st",
        "CLa =   7.296941",
        "CLa = ***********",
        &["trim.st", "CLa"],
    );
    refused("case.toml", "grid = 3003", "grid = 3999", &["3999"]);
    refused(
        "case.toml",
        "deck = \"f25.bdf\"",
        "deck = \"nothing.bdf\"",
        &["nothing.bdf"],
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
