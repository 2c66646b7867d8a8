//! `docs/ERRORS.md` shows what the program prints for bad input. Here each of its blocks is made again: the input is
//! damaged in a copy of the F25-like case, the command is run, and what it prints must be the page's block. With
//! `UPDATE_EXPECT=1` in the environment the blocks are rewritten.

mod identification;

use crate::support::{CaseCopy, fixtures, page};
use identification::{FAILURES, WARNINGS};
use std::collections::BTreeSet;
use std::process::Command;

/// A block of the page, named by the comment above it: `<!-- example: name -->`.
struct Example {
    name: &'static str,
    /// Arguments of the command; `CASE/` stands for the copy's directory.
    command: &'static [&'static str],
    damage: fn(&CaseCopy),
}

const TRIM: &[&str] = &["trim", "CASE/case.toml"];
const CORRECTED: &[&str] = &["trim", "CASE/case.toml", "--variant", "corrected"];
const SIMULATE: &[&str] = &["simulate", "CASE/case.toml", "--manoeuvre", "doublet_3Hz"];
const WING: &[&str] = &["wing", "CASE/wing.json"];
const AIRCRAFT: &[&str] = &["aircraft", "CASE/aircraft.json"];

const GRID_1003: &str = "GRID        1003        17.37104     2.9-1.06907\n";
const SIGNAL_3HZ: &str =
    "{ kind = \"doublet\", amplitude_deg = 1.6, start = 0.5, frequency_hz = 3.0, edges = \"smooth\" }";
const CORRECTION_SLOPES: &str = "reference/strips_reference.csv";
const CORRECTION_DERIVATIVES: &str = "reference/derivatives_reference.json";

const EXAMPLES: &[Example] = &[
    // The deck.
    Example {
        name: "deck-wrong-number",
        command: TRIM,
        damage: |c| c.replace("f25.bdf", "17.37104", "17.3x104"),
    },
    Example {
        name: "deck-missing-grid",
        command: TRIM,
        damage: |c| c.replace("f25.bdf", GRID_1003, ""),
    },
    Example {
        name: "deck-truncated",
        command: TRIM,
        damage: |c| c.cut_before("f25.bdf", ".37104     2.9-1.06907"),
    },
    Example {
        name: "deck-mass-changed",
        command: TRIM,
        damage: |c| {
            c.replace(
                "f25.bdf",
                "900002    1001       0876.5767",
                "900002    1001       0776.5767",
            )
        },
    },
    Example {
        name: "deck-is-results",
        command: TRIM,
        damage: |c| c.write("f25.bdf", &c.read("f25.f06")),
    },
    // The results.
    Example {
        name: "f06-without-eigenvectors",
        command: TRIM,
        damage: |c| c.cut_before("f25.f06", "E I G E N V E C T O R"),
    },
    Example {
        name: "f06-truncated",
        command: TRIM,
        damage: |c| {
            let text = c.read("f25.f06");
            let vector = text.find("OUTPUT FOR EIGENVECTOR        9").unwrap();
            c.write("f25.f06", &text[..vector + 3000]);
        },
    },
    Example {
        name: "f06-wrong-number",
        command: TRIM,
        damage: |c| c.replace("f25.f06", "-1.388187E-05", "-1.388x87E-05"),
    },
    Example {
        name: "f06-is-deck",
        command: TRIM,
        damage: |c| c.write("f25.f06", &c.read("f25.bdf")),
    },
    Example {
        name: "f06-too-few-modes",
        command: TRIM,
        damage: |c| c.replace("case.toml", "modes = 20 ", "modes = 40 "),
    },
    // AVL.
    Example {
        name: "avl-overflow",
        command: TRIM,
        damage: |c| c.replace("avl_out/trim.st", "CLa =   7.296941", "CLa = ***********"),
    },
    Example {
        name: "avl-wrong-number",
        command: TRIM,
        damage: |c| c.replace("avl_out/trim.st", "CLa =   7.296941", "CLa =   7.29x941"),
    },
    Example {
        name: "avl-truncated-derivatives",
        command: TRIM,
        damage: |c| c.cut_before("avl_out/trim.st", "Clp ="),
    },
    Example {
        name: "avl-wrong-kind",
        command: TRIM,
        damage: |c| c.write("avl_out/trim.st", &c.read("avl_out/trim.ft")),
    },
    Example {
        name: "avl-unknown-kind",
        command: TRIM,
        damage: |c| c.write("avl_out/trim.st", &c.read("f25.bdf")),
    },
    Example {
        name: "avl-truncated-strips",
        command: TRIM,
        damage: |c| {
            let text = c.read("avl_out/alpha1.fs");
            c.write("avl_out/alpha1.fs", &text[..text.len() / 2]);
        },
    },
    Example {
        name: "avl-strips-of-two-geometries",
        command: TRIM,
        damage: |c| c.replace("avl_out/alpha1.fs", "   4.9416", "   4.8416"),
    },
    Example {
        name: "avl-strips-of-one-incidence",
        command: TRIM,
        damage: |c| c.replace("case.toml", "alpha_deg = 2.0", "alpha_deg = 1.0"),
    },
    Example {
        name: "avl-wrong-number-in-geometry",
        command: TRIM,
        damage: |c| c.replace("f25.avl", "130.1", "13x.1"),
    },
    Example {
        name: "avl-truncated-geometry",
        command: TRIM,
        damage: |c| {
            let text = c.read("f25.avl");
            let last_section = text.rfind("SECTION").unwrap();
            c.write("f25.avl", &text[..last_section + "SECTION\n".len()]);
        },
    },
    // The case file.
    Example {
        name: "case-not-there",
        command: &["trim", "CASE/nothing.toml"],
        damage: |_| (),
    },
    Example {
        name: "case-missing-file",
        command: TRIM,
        damage: |c| c.replace("case.toml", "deck = \"f25.bdf\"", "deck = \"nothing.bdf\""),
    },
    Example {
        name: "case-syntax",
        command: TRIM,
        damage: |c| c.replace("case.toml", "mach = 0.78", "mach = 0.78 0.8"),
    },
    Example {
        name: "case-unknown-key",
        command: TRIM,
        damage: |c| c.replace("case.toml", "modes = 20", "mode = 20"),
    },
    Example {
        name: "case-missing-damping",
        command: TRIM,
        damage: |c| c.replace("case.toml", "damping_ratio = 0.01 ", "# damping_ratio = 0.01 "),
    },
    Example {
        name: "case-damping-is-text",
        command: TRIM,
        damage: |c| c.replace("case.toml", "damping_ratio = 0.01 ", "damping_ratio = \"1 %\" "),
    },
    Example {
        name: "case-damping-of-other-modes",
        command: TRIM,
        damage: |c| {
            c.replace(
                "case.toml",
                "damping_ratio = 0.01 ",
                "damping_ratio = [0.01, 0.02] ",
            )
        },
    },
    Example {
        name: "case-wrong-choice",
        command: TRIM,
        damage: |c| c.replace("case.toml", "\"cubic\"", "\"spline\""),
    },
    Example {
        name: "case-mach-and-speed",
        command: TRIM,
        damage: |c| c.replace("case.toml", "mach = 0.78", "mach = 0.78\nspeed = 232.7"),
    },
    Example {
        name: "case-unknown-grid-sensor",
        command: TRIM,
        damage: |c| c.replace("case.toml", "grid = 3003", "grid = 3999"),
    },
    Example {
        name: "case-unknown-grid-axis",
        command: TRIM,
        damage: |c| c.replace("case.toml", "1000 THRU 1025", "1000 THRU 1026"),
    },
    Example {
        name: "case-unknown-axis",
        command: TRIM,
        damage: |c| c.replace("case.toml", "lra = \"wing_right\"", "lra = \"wing\""),
    },
    Example {
        name: "case-image-without-axis",
        command: TRIM,
        damage: |c| c.replace("case.toml", "image_lra = \"wing_left\"\n", ""),
    },
    Example {
        name: "case-unknown-surface",
        command: TRIM,
        damage: |c| c.replace("case.toml", "\"HTP\"", "\"Tail\""),
    },
    Example {
        name: "case-unknown-variant",
        command: &["trim", "CASE/case.toml", "--variant", "cfd"],
        damage: |_| (),
    },
    Example {
        name: "case-unknown-manoeuvre",
        command: &["simulate", "CASE/case.toml", "--manoeuvre", "pull_up"],
        damage: |_| (),
    },
    Example {
        name: "case-unknown-input",
        command: &["simulate", "CASE/case.toml"],
        damage: |c| c.replace("case.toml", "input = \"elevator\"", "input = \"elevatr\""),
    },
    Example {
        name: "case-unknown-trim-control",
        command: TRIM,
        damage: |c| {
            c.replace(
                "case.toml",
                "trim_control = \"elevator\"",
                "trim_control = \"stabiliser\"",
            )
        },
    },
    // Data of higher fidelity.
    Example {
        name: "slopes-of-no-surface",
        command: CORRECTED,
        damage: |c| {
            c.write(
                CORRECTION_SLOPES,
                "surface,y,cl_alpha\nCanard,1.0,5.0\nCanard,2.0,5.1\n",
            )
        },
    },
    Example {
        name: "slopes-wrong-number",
        command: CORRECTED,
        damage: |c| {
            c.write(
                CORRECTION_SLOPES,
                "surface,y,cl_alpha\nWing,1.0,5.0\nWing,2.0,5..1\n",
            )
        },
    },
    Example {
        name: "slopes-missing-column",
        command: CORRECTED,
        damage: |c| c.write(CORRECTION_SLOPES, "surface,y,slope\nWing,1.0,5.0\n"),
    },
    Example {
        name: "derivatives-bad-json",
        command: CORRECTED,
        damage: |c| c.write(CORRECTION_DERIVATIVES, "{ \"CLa\": 7.2,\n"),
    },
    Example {
        name: "derivatives-none",
        command: CORRECTED,
        damage: |c| c.write(CORRECTION_DERIVATIVES, "{ \"CL_alpha\": 7.2 }\n"),
    },
    // Flight.
    Example {
        name: "flight-trim-not-found",
        command: TRIM,
        damage: |c| c.replace("case.toml", "mach = 0.78", "mach = 0.1"),
    },
    Example {
        name: "flight-no-authority",
        command: TRIM,
        damage: |c| {
            c.replace(
                "case.toml",
                "trim_control = \"elevator\"",
                "trim_control = \"rudder\"",
            )
        },
    },
    Example {
        name: "flight-altitude",
        command: TRIM,
        damage: |c| c.replace("case.toml", "altitude = 10258.0", "altitude = 33656.0"),
    },
    Example {
        name: "flight-divergence",
        command: AIRCRAFT,
        damage: write_divergent_aircraft,
    },
    Example {
        name: "simulation-diverges",
        command: SIMULATE,
        damage: |c| c.replace("case.toml", "end = 5.0\ndt = 0.001", "end = 5.0\ndt = 0.05"),
    },
    Example {
        name: "simulation-steps",
        command: SIMULATE,
        damage: |c| c.replace("case.toml", "end = 5.0\ndt = 0.001", "end = 5.0\ndt = 0.0015"),
    },
    Example {
        name: "signal-file-not-there",
        command: SIMULATE,
        damage: |c| {
            let signal =
                "{ kind = \"csv\", file = \"elevator.csv\", time_column = \"t\", value_column = \"deg\" }";
            c.replace("case.toml", SIGNAL_3HZ, signal);
        },
    },
    Example {
        name: "signal-times-repeat",
        command: SIMULATE,
        damage: |c| {
            let signal =
                "{ kind = \"csv\", file = \"elevator.csv\", time_column = \"t\", value_column = \"deg\" }";
            c.replace("case.toml", SIGNAL_3HZ, signal);
            c.write("elevator.csv", "t,deg\n0.0,0.0\n1.0,0.5\n1.0,0.7\n");
        },
    },
    // Exports.
    Example {
        name: "export-ending",
        command: &["export", "CASE/case.toml", "--to", "CASE/model.xlsx"],
        damage: |_| (),
    },
    Example {
        name: "export-transfer-csv",
        command: &[
            "export",
            "CASE/case.toml",
            "--transfer",
            "elevator",
            "q",
            "--to",
            "CASE/q.csv",
        ],
        damage: |_| (),
    },
    Example {
        name: "export-unknown-output",
        command: &[
            "export",
            "CASE/case.toml",
            "--transfer",
            "elevator",
            "n_z",
            "--to",
            "CASE/q.json",
        ],
        damage: |_| (),
    },
    // Neutral models.
    Example {
        name: "neutral-truncated",
        command: WING,
        damage: |c| c.write("wing.json", "{\n  \"y\": [1.0, 2.0],\n  \"dy\": [1.0,"),
    },
    Example {
        name: "neutral-missing-key",
        command: WING,
        damage: |c| c.write("wing.json", &wing("\"mu\": [1.0],", "")),
    },
    Example {
        name: "neutral-lengths",
        command: WING,
        damage: |c| c.write("wing.json", &wing("\"dy\": [1.0, 1.0]", "\"dy\": [1.0]")),
    },
    Example {
        name: "neutral-strip",
        command: WING,
        damage: |c| c.write("wing.json", &wing("\"c\": [2.0, 1.5]", "\"c\": [2.0, 0.0]")),
    },
    Example {
        name: "neutral-density",
        command: WING,
        damage: |c| c.write("wing.json", &wing("1.225", "-1.225")),
    },
    Example {
        name: "neutral-exponent",
        command: WING,
        damage: |c| c.write("wing.json", &wing("[1.0]], \"gamma\"", "[1e300]], \"gamma\"")),
    },
];

/// A wing of two strips and one mode, one text of it replaced.
fn wing(from: &str, to: &str) -> String {
    let text = r#"{
  "y": [0.5, 1.5], "dy": [1.0, 1.0], "c": [2.0, 1.5], "x_ac": [0.5, 0.6], "x_lra": [0.9, 0.9],
  "cl_alpha": [6.0, 5.5], "phi": [[0.2], [1.0]], "gamma": [[0.0], [0.0]],
  "mu": [1.0], "omega": [30.0], "xi": [0.01], "rho": 1.225
}"#;
    assert!(text.contains(from));
    text.replacen(from, to, 1)
}

/// The small aircraft with soft modes that twist nose up where they bend up, as a forward-swept wing's do.
fn write_divergent_aircraft(copy: &CaseCopy) {
    let text = std::fs::read_to_string(fixtures().join("oracle/aircraft_small.json")).unwrap();
    let mut aircraft: serde_json::Value = serde_json::from_str(&text).unwrap();
    let modes = &mut aircraft["inputs"]["modes"];
    let scale =
        |value: &mut serde_json::Value, factor: f64| *value = (value.as_f64().unwrap() * factor).into();
    modes["omega"]
        .as_array_mut()
        .unwrap()
        .iter_mut()
        .for_each(|v| scale(v, 0.3));
    for row in modes["gamma"].as_array_mut().unwrap() {
        row.as_array_mut()
            .unwrap()
            .iter_mut()
            .for_each(|v| scale(v, -1.0));
    }
    copy.write("aircraft.json", &aircraft.to_string());
}

/// Runs an example in a copy of its own, which no failing command may leave with another file.
fn run(example: &Example) -> (CaseCopy, std::process::Output) {
    let copy = CaseCopy::new();
    (example.damage)(&copy);
    let files = |directory: &std::path::Path| -> BTreeSet<_> {
        let entries = std::fs::read_dir(directory).unwrap();
        entries.map(|e| e.unwrap().file_name()).collect()
    };
    let before = files(copy.directory());
    let output = Command::new(env!("CARGO_BIN_EXE_albatross"))
        .args(example.command.iter().map(|a| match a.strip_prefix("CASE/") {
            Some(file) => copy.arg(file),
            None => (*a).to_owned(),
        }))
        // Notes are not errors; `wing` and `aircraft` have none.
        .args(if example.command.contains(&"CASE/case.toml") {
            &["--quiet"][..]
        } else {
            &[]
        })
        .output()
        .unwrap();
    assert_eq!(
        files(copy.directory()),
        before,
        "{}: the command leaves no file",
        example.name
    );
    (copy, output)
}

fn shown(example: &Example, message: &str) -> String {
    format!(
        "$ albatross {}\n{}\n",
        example.command.join(" "),
        message.trim_end()
    )
}

/// What the page shows of an example: the command and what it prints.
fn printed(example: &Example) -> String {
    let (copy, output) = run(example);
    let name = example.name;
    assert_eq!(
        output.status.code(),
        Some(1),
        "{name}: the exit code of a failure is 1"
    );
    assert!(
        output.stdout.is_empty(),
        "{name}: a failing command prints no result"
    );
    let message = copy.normalise(&String::from_utf8(output.stderr).unwrap());
    assert!(message.starts_with("error: "), "{name}: {message}");
    shown(example, &message)
}

/// What the page shows of a warning: the command and the end of the summary.
fn warned(example: &Example) -> String {
    let (copy, output) = run(example);
    let name = example.name;
    assert!(output.status.success(), "{name}: a warning is no failure");
    let text = copy.normalise(&String::from_utf8(output.stdout).unwrap());
    let warnings: Vec<&str> = text.lines().filter(|l| l.starts_with("warning: ")).collect();
    assert!(!warnings.is_empty(), "{name}: no warning in\n{text}");
    shown(example, &format!("...\n{}", warnings.join("\n")))
}

/// The text between the fences that follow an example's comment: its place in the page.
fn block(text: &str, name: &str) -> Option<std::ops::Range<usize>> {
    let (comment, fence) = (format!("<!-- example: {name} -->\n"), "```text\n");
    let after = text.find(&comment)? + comment.len();
    let start = text
        .get(after..)?
        .starts_with(fence)
        .then_some(after + fence.len())?;
    Some(start..start + text.get(start..)?.find("```\n")?)
}

#[test]
fn val_errors_are_printed_as_documented() {
    let path = page("ERRORS.md");
    let mut text = std::fs::read_to_string(&path).unwrap();
    let named = text.matches("<!-- example: ").count();
    let failures: Vec<&Example> = EXAMPLES.iter().chain(FAILURES).collect();
    assert_eq!(
        named,
        failures.len() + WARNINGS.len(),
        "each example stands on the page once, and no other"
    );

    let half = failures.len().div_ceil(2);
    let mut found: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = failures
            .chunks(half)
            .map(|part| scope.spawn(move || part.iter().map(|e| printed(e)).collect::<Vec<_>>()))
            .collect();
        workers.into_iter().flat_map(|w| w.join().unwrap()).collect()
    });
    found.extend(WARNINGS.iter().map(warned));

    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let mut different = Vec::new();
    for (example, found) in failures.into_iter().chain(WARNINGS).zip(found) {
        let place = block(&text, example.name).unwrap_or_else(|| panic!("no block for {}", example.name));
        if text[place.clone()] != found {
            different.push(format!("{}\n{found}", example.name));
            text.replace_range(place, &found);
        }
    }
    if update {
        std::fs::write(path, text).unwrap();
    } else {
        assert!(
            different.is_empty(),
            "docs/ERRORS.md shows other text than is printed; UPDATE_EXPECT=1 rewrites it:\n{}",
            different.join("\n")
        );
    }
}
