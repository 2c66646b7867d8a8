//! `identify`, `identify search`, `compare` and `residuals` on the reference histories of the F25-like aircraft and on
//! records of systems that are known.

use crate::support::{albatross, case, failure, fixtures, json};
use serde_json::Value;
use std::path::{Path, PathBuf};

const RECORDS: [&str; 3] = ["doublet_0p5Hz.csv", "doublet_3Hz.csv", "doublet_10Hz.csv"];

fn record(name: &str) -> String {
    fixtures()
        .join("f25-like/reference")
        .join(name)
        .display()
        .to_string()
}

fn records() -> [String; 3] {
    RECORDS.map(record)
}

/// The command with the options and all three records, every eighth sample of them.
fn on_records(command: &[&str], options: &[&str]) -> Vec<String> {
    command
        .iter()
        .chain(options)
        .map(|s| (*s).to_owned())
        .chain(records())
        .chain(["--decimate".to_owned(), "8".to_owned()])
        .collect()
}

fn json_of(arguments: &[String]) -> Value {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    json(&arguments)
}

const Q: [&str; 6] = ["--input", "elevator", "--output", "q", "--json", "--quiet"];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap_or_else(|| panic!("{value} is no list"))
}

/// A directory with tables of samples.
struct Tables(tempfile::TempDir);

impl Tables {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn arg(&self, name: &str) -> String {
        self.at(name).display().to_string()
    }

    fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.at(name), text).unwrap();
        self.arg(name)
    }
}

/// Square doublet held between samples, of `k/(s + a)` behind a delay of whole samples: exact, since the state follows
/// `x(k + 1) = e^{-a dt} x(k) + (1 - e^{-a dt})/a u(k)`.
fn first_order(k: f64, a: f64, dt: f64, delay: usize, period: usize) -> String {
    let input = |i: usize| match i.wrapping_sub(40) {
        j if j < period / 2 => 1.0,
        j if j < period => -1.0,
        _ => 0.0,
    };
    let (decay, mut x) = ((-a * dt).exp(), 0.0);
    let mut text = "t,u,y\n".to_owned();
    for i in 0..400 {
        text += &format!("{:.3},{},{:e}\n", i as f64 * dt, input(i), k * x);
        let u = if i >= delay { input(i - delay) } else { 0.0 };
        x = decay * x + (1.0 - decay) / a * u;
    }
    text
}

#[test]
fn val_known_system_is_found() {
    let tables = Tables::new();
    let slow = tables.write("slow.csv", &first_order(3.0, 2.0, 0.01, 0, 80));
    let fast = tables.write("fast.csv", &first_order(3.0, 2.0, 0.01, 0, 30));
    let found = json(&[
        "identify", "--np", "1", "--input", "u", "--output", "y", "--json", "-q", &slow, &fast,
    ]);
    let pole = &found["poles"][0];
    assert!((number(&pole["re"]) + 2.0).abs() < 1e-9, "{pole}");
    assert!((number(&found["gain"]) - 3.0).abs() < 1e-9);
    assert_eq!(found["nz"], 0);
    assert_eq!(found["intersample"], "zoh");
    assert!(list(&found["zeros"]).is_empty());
    for file in [&slow, &fast] {
        assert!(number(&found["fits"][file]) > 99.9999);
        assert_eq!(found["trim"][file]["basis"], "lead_in");
    }
}

/// A delay between two samples is not known to better than the search's tolerance, one of whole samples is.
#[test]
fn val_delay_is_found() {
    let tables = Tables::new();
    let file = tables.write("late.csv", &first_order(3.0, 2.0, 0.01, 7, 80));
    let common = ["--np", "1", "--input", "u", "--output", "y", "--json", "-q"];
    let with = |options: &[&str]| {
        let arguments = [&["identify"][..], &common, options, &[&file]].concat();
        json(&arguments)
    };
    let free = with(&["--max-delay", "0.2"]);
    assert!((number(&free["delay"]) - 0.07).abs() < 1e-4, "{}", free["delay"]);
    assert!((number(&free["poles"][0]["re"]) + 2.0).abs() < 1e-2);
    let fixed = with(&["--delay", "0.07"]);
    assert_eq!(number(&fixed["delay"]), 0.07);
    assert!((number(&fixed["poles"][0]["re"]) + 2.0).abs() < 1e-9);
}

#[test]
fn val_pitch_rate_of_the_f25() {
    let arguments = on_records(&["identify", "--np", "10", "--nz", "9"], &Q);
    let found = json_of(&arguments);
    assert_eq!((&found["np"], &found["nz"]), (&10.into(), &9.into()));
    for file in records() {
        assert!(
            number(&found["fits"][&file]) > 98.0,
            "{file}: {}",
            found["fits"][&file]
        );
    }
    let poles = list(&found["poles"]);
    assert_eq!(poles.len(), 10, "both members of pairs");
    for pole in poles {
        for key in ["re", "im", "frequency_rad_s", "damping_ratio"] {
            number(&pole[key]);
        }
        assert!(pole.get("sd_frequency_rad_s").is_some());
    }
    assert!(poles.iter().map(|p| number(&p["im"])).sum::<f64>().abs() < 1e-9);
    // The short period, also without identification the slowest motion in the record.
    let short_period = poles.iter().find(|p| number(&p["im"]) > 0.0).unwrap();
    assert!((number(&short_period["frequency_rad_s"]) - 1.73).abs() < 0.03);
    assert!(number(&short_period["sd_frequency_rad_s"]) > 0.0);
    for key in [
        "zeros",
        "gain",
        "transfer_function",
        "initial_condition",
        "initial_states",
        "iterations",
        "iteration_log",
        "stop",
        "seconds",
        "seed",
        "starts",
        "chosen_start",
        "warnings",
        "advice",
        "residuals",
        "criteria",
        "model",
        "state_space",
        "modes",
        "intersample",
        "trim",
        "training",
        "options",
    ] {
        assert!(found.get(key).is_some(), "no key {key}");
    }
    assert_eq!(
        number(&found["iterations"]) as usize,
        list(&found["iteration_log"]).len()
    );
    assert_eq!(list(&found["residuals"]).len(), 3);
    for key in ["fpe", "aic", "aicc", "bic"] {
        number(&found["criteria"][key]);
    }
    // Once more: the same but for the time it took.
    let mut again = json_of(&arguments);
    again["seconds"] = found["seconds"].clone();
    assert_eq!(again, found, "the result does not depend on the run");
}

#[test]
fn val_training_on_some_and_scores_of_all() {
    let one = record(RECORDS[1]);
    let found = json_of(&on_records(&["identify", "--np", "6", "--train", &one], &Q));
    assert_eq!(found["training"], serde_json::json!([one]));
    let fit = |name: &str| number(&found["fits"][&record(name)]);
    assert!(fit(RECORDS[1]) > fit(RECORDS[2]) && fit(RECORDS[1]) > 98.0);
    assert_eq!(
        found["samples"], 626,
        "every eighth of 5001 samples of one record"
    );
    // Named only for training, a record is read as well.
    let named = json(&[
        "identify",
        "--np",
        "6",
        "--train",
        &one,
        "--decimate",
        "8",
        "--input",
        "elevator",
        "--output",
        "q",
        "--json",
        "-q",
        &record(RECORDS[2]),
    ]);
    assert_eq!(named["fits"].as_object().unwrap().len(), 2);
    assert_eq!(named["poles"], found["poles"]);
}

#[test]
fn val_several_outputs_have_common_poles() {
    let found = json_of(&on_records(
        &[
            "identify",
            "--np",
            "8",
            "--output",
            "az_cockpit",
            "--weights",
            "2,1,1;1,1,0.5",
        ],
        &Q,
    ));
    for key in ["zeros", "gain", "transfer_function", "criteria"] {
        for output in ["q", "az_cockpit"] {
            assert!(found[key].get(output).is_some(), "{key} of {output}");
        }
    }
    let fits = &found["fits"][&record(RECORDS[1])];
    number(&fits["q"]);
    number(&fits["az_cockpit"]);
    assert_eq!(list(&found["poles"]).len(), 8);
    assert_eq!(list(&found["zeros"]["q"]).len(), 7);
    assert_eq!(list(&found["state_space"]["outputs"]).len(), 2);
    assert_eq!(list(&found["modes"][0]["residues"]).len(), 2);
}

#[test]
fn val_text_tells_what_was_done() {
    let output = albatross(&[
        "identify",
        "--np",
        "4",
        "--decimate",
        "8",
        "--input",
        "elevator",
        "--output",
        "q",
        "--seed",
        "7",
        "--starts",
        "8",
        "--log",
        &record(RECORDS[1]),
    ]);
    let (text, notes) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert!(output.status.success(), "{notes}");
    for part in [
        "Fit",
        "Poles",
        "Zeros",
        "Criteria",
        "Residuals",
        "Search",
        "iterations in",
        "of 8",
        "seed 7",
        "sd",
    ] {
        assert!(text.contains(part), "`{part}` is missing in:\n{text}");
    }
    assert!(notes.contains("linear from sample to sample (foh)"), "{notes}");
    assert!(notes.contains("excites"), "{notes}");
}

#[test]
fn val_search_of_the_order() {
    let arguments = on_records(&["identify", "search", "--np", "3..5", "--threads", "1"], &Q);
    let found = json_of(&arguments);
    let search = &found["search"];
    let candidates = list(&search["candidates"]);
    assert_eq!(candidates.len(), 3 * 4, "each record alone and all together");
    let chosen = &candidates[number(&search["chosen"]) as usize];
    assert_eq!(list(&chosen["training"]).len(), 3);
    assert_eq!((&chosen["np"], &chosen["nz"]), (&found["np"], &found["nz"]));
    assert_eq!(list(&search["scores"]).len(), 3);
    // Five poles: short period, the mode of 24 rad/s and a real one.
    assert_eq!(found["np"], 5, "{}", search["reason"]);

    let arguments = on_records(
        &[
            "identify",
            "search",
            "--np",
            "3",
            "--excess",
            "0,1",
            "--leave-one-out",
            "--merged-only",
        ],
        &Q,
    );
    let found = json_of(&arguments);
    assert_eq!(list(&found["search"]["candidates"]).len(), 2 * 4);
    let all_but_one = &found["search"]["candidates"][0];
    assert_eq!(list(&all_but_one["training"]).len(), 2);
}

/// What the directory of results holds, given back to `compare` and `residuals`.
#[test]
fn val_files_are_read_back() {
    let tables = Tables::new();
    let out = tables.arg("out");
    let found = json_of(&on_records(&["identify", "--np", "5", "--out", &out], &Q));
    let names: Vec<String> = std::fs::read_dir(&out)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(names.len(), 10, "{names:?}");
    for name in names
        .iter()
        .filter(|n| Path::new(n).extension().is_some_and(|e| e == "svg"))
    {
        let svg = std::fs::read_to_string(Path::new(&out).join(name)).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{name}"
        );
    }
    let [model, full, system] =
        ["model.json", "identify.json", "state_space.json"].map(|name| format!("{out}/{name}"));
    // The model against itself in another form.
    let same = json(&["compare", &full, "--reference", &system, "--json", "-q"]);
    assert!(number(&same["bode"]["rms_magnitude_db"]) < 1e-9);
    assert!(number(&same["mean_relative_percent"]) < 1e-9);
    assert!(list(&same["unmatched_model"]).is_empty() && list(&same["unmatched_reference"]).is_empty());
    assert_eq!(
        list(&same["matched"]).len(),
        2,
        "two pairs; the real pole is left out"
    );
    assert_eq!(same["left_out"]["reference"]["real"], 1);
    // Simulated on the same records: the same fits, also by the state space.
    for file in [&full, &model, &system] {
        let again = json_of(&on_records(&["compare", file], &["--json", "-q"]));
        for record in records() {
            let (a, b) = (number(&again["fits"][&record]), number(&found["fits"][&record]));
            assert!((a - b).abs() < 1e-6, "{file}, {record}: {a} {b}");
        }
    }
    let checked = json_of(&on_records(&["residuals", &full], &["--json", "-q"]));
    assert_eq!(list(&checked["residuals"]).len(), 3);
    assert_eq!(checked["residuals"], found["residuals"]);
    assert!(
        list(&checked["verdicts"])[0]
            .as_str()
            .unwrap()
            .contains("not white")
    );
}

/// Modes of the linear model that elevator and pitch rate cannot see (antisymmetric ones), lags and slow motions are left
/// out; those of a model identified from the independent simulation lie near.
#[test]
fn val_comparison_with_the_linear_model() {
    let tables = Tables::new();
    let system = tables.write(
        "system.json",
        &json(&["linearize", &case(), "--json", "-q"]).to_string(),
    );
    let model = tables.write(
        "model.json",
        &json_of(&on_records(&["identify", "--np", "8"], &Q)).to_string(),
    );
    let out = tables.arg("out");
    let compared = json(&[
        "compare",
        &model,
        "--reference",
        &system,
        "--json",
        "-q",
        "--out",
        &out,
    ]);
    let pairs = list(&compared["matched"]);
    let near = |omega: f64| {
        pairs
            .iter()
            .find(|p| (number(&p["reference"]["omega_rad_s"]) - omega).abs() < 0.1)
            .map(|p| number(&p["relative_percent"]))
    };
    // First symmetric wing bending, of 23.95 rad/s in the linear model.
    assert!(near(23.95).is_some_and(|percent| percent < 2.0), "{pairs:?}");
    assert!(number(&compared["left_out"]["reference"]["unseen"]) >= 10.0);
    assert!(number(&compared["left_out"]["reference"]["real"]) > 300.0);
    // In rad/s per rad both, though the records are in deg/s per deg.
    assert!(
        number(&compared["bode"]["rms_magnitude_db"]) < 5.0,
        "{}",
        compared["bode"]
    );
    assert!(!list(&compared["peaks"]["pairs"]).is_empty());
    for name in ["compare.json", "poles.csv", "peaks.csv", "bode.svg", "poles.svg"] {
        assert!(Path::new(&out).join(name).exists(), "{name}");
    }
}

/// Input and output in degrees and in radians: the comparison is the same.
#[test]
fn val_angles_are_converted() {
    let tables = Tables::new();
    let system = |input: &str, output: &str, gain: f64| {
        serde_json::json!({
            "a": [[0.0, 1.0], [-25.0, -1.0]], "b": [[0.0], [gain]], "c": [[1.0, 0.0]], "d": [[0.0]],
            "states": [{"name": "x", "unit": "1"}, {"name": "v", "unit": "1"}],
            "inputs": [{"name": "u", "unit": input}], "outputs": [{"name": "y", "unit": output}],
        })
        .to_string()
    };
    let radians = tables.write("rad.json", &system("rad", "m/s2", 180.0));
    let degrees = tables.write("deg.json", &system("deg", "m/s2", std::f64::consts::PI));
    let compared = json(&["compare", &degrees, "--reference", &radians, "--json", "-q"]);
    assert!(number(&compared["bode"]["rms_magnitude_db"]) < 1e-12);
    let feet = tables.write("feet.json", &system("rad", "ft/s2", 180.0));
    let compared = json(&["compare", &feet, "--reference", &radians, "--json", "-q"]);
    assert!(
        compared["notes"][0]
            .as_str()
            .unwrap()
            .contains("compared as they are")
    );
}

#[test]
fn val_names_of_columns() {
    let tables = Tables::new();
    let text = first_order(3.0, 2.0, 0.01, 0, 80);
    let renamed = tables.write("renamed.csv", &text.replace("t,u,y", "clock,stick [deg],q_deg_s"));
    let with = |options: &[&str]| {
        let common = [
            "identify", "--np", "1", "--input", "stick", "--output", "q_deg_s", "--json", "-q", &renamed,
        ];
        json(&[&common[..], options].concat())
    };
    let found = with(&["--column-time", "clock"]);
    assert_eq!(
        found["input"],
        serde_json::json!({ "name": "stick", "unit": "deg" })
    );
    assert_eq!(found["outputs"][0]["unit"], "deg/s");
    assert_eq!(
        with(&["--sample-time", "0.01"])["sample_time"],
        found["sample_time"]
    );
    let held = with(&[
        "--column-time",
        "clock",
        "--intersample",
        "foh",
        "--detrend",
        "none",
        "--initial",
        "zero",
    ]);
    assert_eq!(held["intersample"], "foh");
    assert_eq!(held["trim"][&renamed]["basis"], "nothing");
    assert_eq!(held["initial_condition"], "zero");
}

#[test]
fn val_a_failure_leaves_nothing_behind() {
    let tables = Tables::new();
    let text = first_order(3.0, 2.0, 0.01, 0, 80);
    let out = tables.arg("out");
    let refused = |text: &str, options: &[&str], words: &[&str]| {
        let file = tables.write("record.csv", text);
        let common = ["identify", "--input", "u", "--np", "1", "--out", &out, &file];
        let message = failure(&[&common[..], options].concat());
        for word in words {
            assert!(message.contains(word), "`{word}` is missing in: {message}");
        }
        assert!(!tables.at("out").exists());
    };
    refused(&text, &["--output", "z"], &["record.csv", "\"z\"", "t, u, y"]);
    refused(
        &text.replace("0.500,1,", "0.500,1,x"),
        &["--output", "y"],
        &["record.csv:52", "x"],
    );
    refused(
        &text.replace("0.500,", "0.503,"),
        &["--output", "y"],
        &["record.csv:", "uniform"],
    );
    refused(
        &text,
        &["--output", "y", "--nz", "2"],
        &["no more zeros than poles"],
    );
    refused(&text, &["--output", "y", "--output", "y"], &["given twice"]);
    refused(
        &text,
        &["--output", "y", "--train", "nothing.csv"],
        &["nothing.csv", "check the path"],
    );
    refused(
        &text,
        &["--output", "y", "--weights", "1,2"],
        &["--weights", "expected 1"],
    );
    // What clap refuses has the exit code 2.
    let usage = albatross(&["identify", "--np", "1"]);
    assert_eq!(usage.status.code(), Some(2));
    let usage = albatross(&[
        "identify", "search", "--np", "9..4", "--input", "u", "--output", "y", "a.csv",
    ]);
    assert_eq!(usage.status.code(), Some(2));
}
