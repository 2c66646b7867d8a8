//! The command `albatross`.

#![warn(clippy::indexing_slicing, clippy::string_slice)]

mod args;
mod case;
mod check;
mod excerpt;
mod export;
mod figures;
mod gathered;
mod identification;
mod lattice;
mod neutral;
mod new;
mod output;
mod progress;
mod report;
mod run;
mod shell;
mod solve_modes;
mod tables;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Command::New(options) => new::new(options),
        Command::Check(options) => check::check(options),
        Command::Run(options) => run::run(options),
        Command::Modes(options) => case::modes(options),
        Command::Strips(options) => case::strips(options),
        Command::Trim(options) => case::trim(options),
        Command::Linearize(options) => case::linearize(options),
        Command::ModesTable(options) => case::modes_table(options),
        Command::Bode(options) => case::bode(options),
        Command::Simulate(options) => case::simulate(options),
        Command::Export(options) => export::export(options),
        Command::Identify(options) => identification::identify(options),
        Command::Compare(options) => identification::compare(options),
        Command::Residuals(options) => identification::residuals(options),
        Command::SolveModes(options) => solve_modes::solve_modes(options),
        Command::Vlm(options) => lattice::vlm(options),
        Command::Wing(options) => neutral::wing(&options.file),
        Command::Aircraft(options) => neutral::aircraft(&options.file),
        Command::Completions { shell } => shell::completions(*shell),
        Command::Man(options) => shell::man(options),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(output::Failure::Closed) => ExitCode::SUCCESS,
        // What was found is printed already.
        Err(output::Failure::Found) => ExitCode::FAILURE,
        Err(error @ output::Failure::Usage(_)) => {
            output::error(&error);
            ExitCode::from(2)
        }
        Err(error) => {
            output::error(&error);
            if let Some(case) = case_of(&arguments.command) {
                output::hint(&format!(
                    "`albatross check {}` looks at everything at once",
                    case.display()
                ));
            }
            ExitCode::FAILURE
        }
    }
}

/// The case file that a command reads.
fn case_of(command: &Command) -> Option<&std::path::Path> {
    let case = match command {
        Command::Run(options) => &options.case.case,
        Command::Modes(options) => options.case.as_ref()?,
        Command::Strips(options)
        | Command::Trim(options)
        | Command::Linearize(options)
        | Command::ModesTable(options) => &options.case,
        Command::Bode(options) => &options.case.case,
        Command::Simulate(options) => &options.case.case,
        _ => return None,
    };
    Some(case)
}
