//! `cargo xtask ci`: every check that a change must pass, in order, with a summary. The same list stands in `.ci/run`, which
//! stops at the first failure.

use crate::error::Error;
use crate::{examples, first_hour, tidy, validate, workspace};
use std::process::Command;

/// The tests, as the README names them.
pub(crate) const TEST: [&str; 2] = ["test", "--workspace"];

/// One check by cargo: name, arguments, environment.
type Step = (
    &'static str,
    &'static [&'static str],
    &'static [(&'static str, &'static str)],
);

const STEPS: [Step; 4] = [
    ("format", &["fmt", "--all", "--check"], &[]),
    ("tests", &TEST, &[]),
    (
        "lints",
        &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"],
        &[],
    ),
    (
        "documentation",
        &["doc", "--workspace", "--no-deps"],
        &[("RUSTDOCFLAGS", "-D warnings")],
    ),
];

/// Licences, sources and duplicates of third-party crates, by `deny.toml`.
const DENY: [&str; 5] = ["deny", "check", "licenses", "bans", "sources"];

/// Runs all checks, also after one has failed.
pub(crate) fn run() -> Result<(), Error> {
    let mut outcomes: Vec<(&str, Result<(), Error>)> = Vec::new();
    outcomes.push(("tidy", tidy::run()));
    for (name, arguments, environment) in STEPS {
        outcomes.push((name, cargo(arguments, environment)));
    }
    if deny_is_installed() {
        outcomes.push(("dependencies", cargo(&DENY, &[])));
    } else {
        eprintln!("SKIPPED dependencies: cargo deny is not installed (cargo install cargo-deny --locked)");
    }
    outcomes.push((
        "first-hour --check",
        first_hour::run(&first_hour::Options::check()),
    ));
    outcomes.push(("examples --check", examples::run(&examples::Options::check())));
    outcomes.push(("validate --check", validate::run(&validate::Options::check())));
    println!();
    for (name, outcome) in &outcomes {
        match outcome {
            Ok(()) => println!("passed  {name}"),
            Err(error) => println!("FAILED  {name}: {error}"),
        }
    }
    match outcomes.iter().filter(|(_, outcome)| outcome.is_err()).count() {
        0 => Ok(()),
        n => Err(Error::Failed(format!("{n} of {} checks failed", outcomes.len()))),
    }
}

/// `cargo deny` is a program of its own: the check is left out, aloud, where it is missing.
fn deny_is_installed() -> bool {
    Command::new("cargo")
        .args(["deny", "--version"])
        .output()
        .is_ok_and(|output| output.status.success())
}

/// Runs cargo in the workspace and waits for it.
pub(crate) fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Result<(), Error> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let command = format!("cargo {}", arguments.join(" "));
    eprintln!("> {command}");
    let failed = |outcome: String| Error::Command {
        command: command.clone(),
        outcome,
    };
    let status = Command::new(program)
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(workspace::root())
        .status()
        .map_err(|e| failed(format!("cannot be started: {e}")))?;
    if status.success() {
        Ok(())
    } else {
        Err(failed(format!("ended with {status}")))
    }
}
