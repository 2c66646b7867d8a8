//! The command `albatross`.

mod args;
mod case;
mod figures;
mod identification;
mod lattice;
mod neutral;
mod output;
mod report;
mod run;
mod solve_modes;
mod tables;

use args::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Command::Run(options) => run::run(options),
        Command::Modes(options) => case::modes(options),
        Command::Strips(options) => case::strips(options),
        Command::Trim(options) => case::trim(options),
        Command::Linearize(options) => case::linearize(options),
        Command::ModesTable(options) => case::modes_table(options),
        Command::Bode(options) => case::bode(options),
        Command::Simulate(options) => case::simulate(options),
        Command::Identify(options) => identification::identify(options),
        Command::Compare(options) => identification::compare(options),
        Command::Residuals(options) => identification::residuals(options),
        Command::SolveModes(options) => solve_modes::solve_modes(options),
        Command::Vlm(options) => lattice::vlm(options),
        Command::Wing { file } => neutral::wing(file),
        Command::Aircraft { file } => neutral::aircraft(file),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(output::Failure::Closed) => ExitCode::SUCCESS,
        Err(error) => {
            output::error(&error);
            ExitCode::FAILURE
        }
    }
}
