//! Development tasks of the workspace: `cargo xtask validate | examples | first-hour | book | tidy | ci | bench`.
//!
//! | task | does |
//! |---|---|
//! | `validate` | runs the F25-like case and writes `docs/validation/`; `--check` compares with what is there |
//! | `examples` | runs the commands of `examples/*/README.md` and writes what they print; `--check` compares |
//! | `first-hour` | goes the way of `docs/FIRST_HOUR.md` from `git clone` to the report in a browser, timed; `--check` compares |
//! | `book` | gathers documents and examples as a book and has mdBook build `target/book` |
//! | `tidy` | checks what the compiler does not: the crate graph, purity of the physics crates, file sizes, text hygiene |
//! | `ci` | all checks that a change must pass, in order |
//! | `bench` | runs the benches and collects their results |

// A tool for the terminal: its answers go to standard output, its progress to standard error.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod bench;
mod book;
mod ci;
mod console;
mod error;
mod examples;
mod first_hour;
mod markdown;
mod tidy;
mod validate;
mod workspace;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Development tasks of the Albatross workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", version)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Run the F25-like case and write docs/validation/, or compare with it
    Validate(validate::Options),
    /// Run the commands of the examples and write what they print, or compare with it
    Examples(examples::Options),
    /// Go the way of docs/FIRST_HOUR.md from `git clone` to the report in a browser, and time it
    FirstHour(first_hour::Options),
    /// Gather the documents and build them as a book with mdBook
    Book,
    /// Check the invariants of the workspace that the compiler does not
    Tidy,
    /// Run every check that a change must pass
    Ci,
    /// Run the benches and collect their results
    Bench(bench::Options),
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().task {
        Task::Validate(options) => validate::run(&options),
        Task::Examples(options) => examples::run(&options),
        Task::FirstHour(options) => first_hour::run(&options),
        Task::Book => book::run(),
        Task::Tidy => tidy::run(),
        Task::Ci => ci::run(),
        Task::Bench(options) => bench::run(&options),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
