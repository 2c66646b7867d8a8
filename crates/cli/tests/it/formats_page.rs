//! `docs/FORMATS.md` against the program: keys of each command's JSON, files of a run, cards of a deck.

use crate::support::{CaseCopy, albatross, case, fixtures, json, page};
use serde_json::Value;
use std::collections::BTreeSet;

type Names = BTreeSet<String>;

fn text() -> String {
    std::fs::read_to_string(page("FORMATS.md")).unwrap()
}

/// Names in backticks.
fn quoted(text: &str) -> Names {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The row of a table that begins with a cell.
fn row<'a>(text: &'a str, cell: &str) -> &'a str {
    let begin = format!("| {cell} | ");
    let found = text.lines().find(|line| line.starts_with(&begin));
    &found.unwrap_or_else(|| panic!("no row {cell}"))[begin.len()..]
}

fn keys(value: &Value) -> Names {
    value.as_object().unwrap().keys().cloned().collect()
}

/// A section of the page.
fn section<'a>(text: &'a str, title: &str) -> &'a str {
    let heading = format!("\n## {title}\n");
    let begin = text
        .find(&heading)
        .unwrap_or_else(|| panic!("no section {title}"))
        + heading.len();
    let rest = &text[begin..];
    &rest[..rest.find("\n## ").unwrap_or(rest.len())]
}

/// Every key that identification prints, also within its lists, stands in its section, and every file in its own.
#[test]
fn val_keys_and_files_of_identification() {
    let text = text();
    let documented =
        quoted(&(section(&text, "Output of identification").to_owned() + section(&text, "Models (JSON)")));
    let files = quoted(section(&text, "Files of identification"));
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name).display().to_string();
    let record = fixtures().join("f25-like/reference/doublet_3Hz.csv");
    let record = record.to_str().unwrap();
    let data = [
        "--input",
        "elevator",
        "--output",
        "q",
        "--decimate",
        "8",
        "--json",
        "--quiet",
        record,
    ];
    let run = |arguments: &[&str]| json(&[arguments, &data].concat());
    let found = run(&["identify", "search", "--np", "2..3", "--out", &at("identify")]);
    let model = at("identify/model.json");
    let system = at("identify/state_space.json");
    let compared = run(&["compare", &model, "--reference", &system, "--out", &at("compare")]);
    let checked = run(&["residuals", &model, "--out", &at("residuals")]);
    for (command, value) in [
        ("identify", &found),
        ("compare", &compared),
        ("residuals", &checked),
    ] {
        let mut printed = keys(value);
        for place in [
            "/poles/0",
            "/modes/0",
            "/modes/0/residues/0",
            "/transfer_function",
            "/iteration_log/0",
            "/starts/0",
            "/residuals/0",
            "/residuals/0/auto",
            "/criteria",
            "/advice/0",
            "/model",
            "/search",
            "/search/candidates/0",
            "/search/scores/0",
            "/matched/0",
            "/matched/0/identified",
            "/left_out",
            "/left_out/model",
            "/bode",
        ] {
            printed.extend(
                value
                    .pointer(place)
                    .filter(|v| v.is_object())
                    .map(keys)
                    .unwrap_or_default(),
            );
        }
        let missing: Vec<_> = printed.difference(&documented).collect();
        assert!(missing.is_empty(), "{command}: {missing:?} are not on the page");
        for entry in std::fs::read_dir(at(command)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            assert!(files.contains(&name), "{command}: {name} is not on the page");
        }
    }
}

/// Every key that a command prints, at the top and in the first entry of its lists, stands in its row.
#[test]
fn val_keys_of_the_commands() {
    let text = text();
    let text = &text[text.find("\n## Output of").unwrap()..];
    let case = case();
    for command in [
        "check",
        "modes",
        "strips",
        "trim",
        "linearize",
        "bode",
        "simulate",
    ] {
        let mut arguments = vec![command, case.as_str(), "--json", "--quiet"];
        if command == "bode" {
            arguments.extend(["--omega", "1.0"]);
        }
        let result = json(&arguments);
        let documented: String = row(text, &format!("`{command}`")).replace(['{', '}', ','], "`");
        let documented: Names = documented.split('`').map(|name| name.trim().to_owned()).collect();
        let mut printed = keys(&result);
        for list in ["findings", "modes", "strips", "states", "channels"] {
            printed.extend(
                result
                    .get(list)
                    .and_then(|l| l.get(0))
                    .map(keys)
                    .unwrap_or_default(),
            );
        }
        printed.extend(result.pointer("/outputs/alpha").map(keys).unwrap_or_default());
        let missing: Vec<_> = printed.difference(&documented).collect();
        assert!(missing.is_empty(), "{command}: {missing:?} are not on the page");
    }
}

#[test]
fn val_keys_of_neutral_models() {
    let text = text();
    let wing_section =
        &text[text.find("\n## Neutral wing").unwrap()..text.find("\n## Neutral aircraft").unwrap()];
    let aircraft_section =
        &text[text.find("\n## Neutral aircraft").unwrap()..text.find("\n## Output of").unwrap()];
    for (command, file, wrapped, section) in [
        ("wing", "oracle/goland_wing.json", "neutral_case", wing_section),
        (
            "aircraft",
            "oracle/aircraft_small.json",
            "inputs",
            aircraft_section,
        ),
    ] {
        let path = fixtures().join(file);
        let input: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let documented = quoted(section);
        let printed = json(&[command, path.to_str().unwrap()]);
        let missing: Vec<_> = keys(&printed).difference(&documented).cloned().collect();
        assert!(missing.is_empty(), "{command}: {missing:?} are not on the page");
        // Keys of the first table are taken away one by one: the program misses each, unless it may be left out.
        let table = section.split("|---|---|---|---|\n").nth(1).unwrap();
        for line in table.lines().take_while(|l| l.starts_with('|')) {
            let key = line.split('`').nth(1).unwrap();
            let copy = CaseCopy::new();
            let mut model = input[wrapped].clone();
            model["rho"] = 1.0.into();
            model.as_object_mut().unwrap().remove(key);
            copy.write("model.json", &model.to_string());
            let output = albatross(&[command, &copy.arg("model.json")]);
            assert_eq!(
                output.status.success(),
                line.contains("Optional"),
                "{command} without {key}"
            );
        }
    }
}

/// Every name in an exported file stands in the section on exports.
#[test]
fn val_names_of_exports() {
    use albatross::export::{self, OperatingPoint, Record, Transfer, Value as Exported};
    use albatross::lti::{Signal, Zpk};
    fn names(record: &Record) -> Names {
        let mut all = Names::new();
        for (name, value) in &record.fields {
            all.insert(name.clone());
            if let Exported::Group(group) = value {
                all.extend(names(group));
            }
        }
        all
    }
    let text = text();
    let documented = quoted(section(&text, "Exports"));
    let zpk = Zpk::try_new(Vec::new(), Vec::new(), 1.0).unwrap();
    let system = zpk
        .to_state_space(Signal::new("u", "1"), Signal::new("y", "1"))
        .unwrap();
    let about = OperatingPoint {
        states: vec![],
        inputs: vec![0.0],
        outputs: vec![0.0],
    };
    let transfer = Transfer::new(Signal::new("u", "1"), Signal::new("y", "1"), zpk).unwrap();
    let history = albatross::flight::TimeHistory {
        time: vec![],
        channels: vec![],
        series: vec![],
        final_state: vec![],
        evaluations: 0,
    };
    let mut written = names(&export::state_space(&system, Some(&about)).unwrap());
    written.extend(names(&transfer.record()));
    written.extend(names(&export::history(&history).unwrap()));
    let value = serde_json::to_value(&transfer).unwrap();
    written.extend(keys(&value));
    written.extend(keys(&value["transfer_function"]));
    let missing: Vec<_> = written.difference(&documented).collect();
    assert!(missing.is_empty(), "{missing:?} are not on the page");
}

#[test]
fn val_files_of_a_run() {
    let text = text();
    let section = section(&text, "Files of `albatross run`");
    let mut documented = Names::new();
    for line in section.lines().filter(|l| l.starts_with("| `")) {
        for name in quoted(line.split(" | ").next().unwrap()) {
            documented.insert(name.replace("MANOEUVRE", "short"));
        }
    }
    let copy = CaseCopy::new();
    let toml = copy.read("case.toml");
    let first = toml.find("[[manoeuvre]]").unwrap();
    let bode = toml.find("[bode]").unwrap();
    let manoeuvre = "[[manoeuvre]]\nname = \"short\"\ninput = \"thrust\"\nend = 0.1\ndt = 0.001\n\
                     signal = { kind = \"step\", amplitude_n = 1000.0, start = 0.0 }\n\n\
                     [bode]\nfrom_rad_s = 1.0\nto_rad_s = 10.0\npoints = 2\n";
    assert!(bode > first);
    // Two modes: following twenty takes a while in a build for tests.
    copy.write(
        "case.toml",
        &(toml[..first].replace("modes = 20 ", "modes = 2 ") + manoeuvre),
    );
    let output = albatross(&[
        "run",
        &copy.arg("case.toml"),
        "--out",
        &copy.arg("out"),
        "--quiet",
    ]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let written: Names = std::fs::read_dir(copy.at("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(written, documented);
}
