//! What a new user meets: `new`, completions, manual pages, exit codes, errors on a terminal.

use crate::support::{CaseCopy, albatross, json};
use serde_json::Value;
use std::process::Command;

/// The case that `new` writes is without remark, runs, and trims as a light aircraft does.
#[test]
fn val_new_case_runs() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join("first").join(name).display().to_string();
    let written = json(&["new", &at(""), "--json"]);
    assert_eq!(written["files"].as_array().unwrap().len(), 3);
    let case = at("case.toml");
    let report = json(&["check", &case, "--strict", "--json"]);
    assert_eq!(report["findings"], Value::Array(Vec::new()));
    let run = json(&["run", &case, "--out", &at("out"), "--json", "--quiet"]);
    let trim = &run["trim"];
    let number = |v: &Value| v.as_f64().unwrap();
    assert!((number(&trim["mass"]) - 750.0).abs() < 1e-9);
    // 2 m g / (rho V^2 S) = 0.317 at a lift slope of 5.5 and a wing of 2 % camber set at 1.5 deg.
    assert!(number(&trim["alpha_deg"]).abs() < 2.0, "{trim}");
    assert!(number(&trim["controls_deg"]["elevator"]).abs() < 3.0, "{trim}");
    assert!((300.0..800.0).contains(&number(&trim["thrust"])), "{trim}");
    let modes = run["modes"]["rigid_body"].as_array().unwrap();
    let period = modes.iter().find(|m| m["name"] == "short period").unwrap();
    let omega = number(&period["flexible"]["omega_rad_s"]);
    assert!((4.0..10.0).contains(&omega), "{omega}");
    for name in ["elevator_doublet.csv", "aileron_3211.svg", "notes.txt"] {
        assert!(
            std::fs::metadata(format!("{}/{name}", at("out"))).unwrap().len() > 100,
            "{name}"
        );
    }
}

/// Files that are there are not overwritten.
#[test]
fn val_new_refuses_to_overwrite() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("aircraft.bdf");
    std::fs::write(&file, "mine").unwrap();
    let output = albatross(&["new", directory.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("there is already aircraft.bdf"));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
    assert!(!directory.path().join("case.toml").exists());
}

#[test]
fn val_completions_and_pages() {
    for shell in ["bash", "zsh", "fish"] {
        let output = albatross(&["completions", shell]);
        assert!(output.status.success());
        let script = String::from_utf8(output.stdout).unwrap();
        assert!(script.contains("modes-table"), "{shell}");
    }
    let directory = tempfile::tempdir().unwrap();
    let pages = json(&["man", directory.path().to_str().unwrap(), "--json"]);
    let pages = pages["files"].as_array().unwrap();
    assert!(pages.len() > 15);
    let run = pages
        .iter()
        .find(|p| p.as_str().unwrap().ends_with("albatross-run.1"))
        .unwrap();
    let text = std::fs::read_to_string(run.as_str().unwrap()).unwrap();
    assert!(text.contains(".TH albatross-run"), "{text}");
}

/// 0 done, 1 refused, 2 not understood.
#[test]
fn val_exit_codes() {
    for (arguments, code) in [
        (&["--version"][..], 0),
        (&["trim", "nothing.toml"], 1),
        (&["check", "nothing.toml"], 1),
        (&["trim"], 2),
        (&["modes"], 2),
        (&["fly"], 2),
    ] {
        assert_eq!(albatross(arguments).status.code(), Some(code), "{arguments:?}");
    }
}

/// Every subcommand but the shell's takes --json and --quiet.
#[test]
fn val_json_and_quiet_everywhere() {
    let help = String::from_utf8(albatross(&["--help"]).stdout).unwrap();
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|l| *l != "Commands:")
        .skip(1)
        .take_while(|l| !l.is_empty())
        .filter(|l| l.starts_with("  ") && !l.starts_with("   "))
        .filter_map(|l| l.split_whitespace().next())
        .filter(|c| !["help", "completions"].contains(c))
        .collect();
    assert!(commands.len() > 15, "{commands:?}");
    for command in commands {
        let help = String::from_utf8(albatross(&[command, "--help"]).stdout).unwrap();
        assert!(help.contains("--json") && help.contains("--quiet"), "{command}");
    }
}

/// On a terminal the line of the file stands under the message, which is the same line as elsewhere.
#[test]
fn val_excerpt_on_a_terminal() {
    let copy = CaseCopy::new();
    copy.replace("f25.bdf", "17.37104", "17.3x104");
    let run = |names: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_albatross"));
        command.args(["trim", &copy.arg("case.toml")]);
        for name in names {
            command.env(name, "1");
        }
        String::from_utf8(command.output().unwrap().stderr).unwrap()
    };
    let plain = run(&[]);
    let shown = run(&["CLICOLOR_FORCE", "NO_COLOR"]);
    assert_eq!(plain.lines().next(), shown.lines().next());
    assert!(!plain.contains("^^^"), "{plain}");
    let excerpt: Vec<&str> = shown.lines().skip(1).take(2).collect();
    assert!(excerpt[0].starts_with("22 | GRID        1003"), "{shown}");
    let mark = excerpt[1].find("^^^^^^^^").unwrap();
    assert_eq!(excerpt[0].find("17.3x104"), Some(mark), "{shown}");
    assert!(!shown.contains('\u{1b}') && run(&["CLICOLOR_FORCE"]).contains('\u{1b}'));
}
