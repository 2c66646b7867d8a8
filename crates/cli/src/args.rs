//! The command line.

use crate::identification::args::{CompareOptions, IdentifyCommand, ResidualArguments};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Flight dynamics of flexible high-aspect-ratio aircraft.
#[derive(Debug, Parser)]
#[command(name = "albatross", version, about, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// All stages of a case: tables, plots and time histories into a directory.
    Run(RunOptions),
    /// Structural modes: frequencies, modal masses, symmetry, where the energy is.
    Modes(ModesOptions),
    /// Aerodynamic strips: geometry, lift slopes, load reference axis.
    Strips(CaseOptions),
    /// Trimmed flight.
    Trim(CaseOptions),
    /// State space of small deviations from trim: A, B, C, D with names.
    Linearize(CaseOptions),
    /// Aeroelastic and rigid-body modes, without lag roots.
    ModesTable(CaseOptions),
    /// Frequency response to one input.
    Bode(BodeOptions),
    /// Non-linear simulation of a manoeuvre.
    Simulate(SimulateOptions),
    /// Transfer functions from time histories, with common poles, standard deviations and fits.
    Identify(IdentifyCommand),
    /// A model against another one (poles, frequency responses, peaks) and against records (fits).
    Compare(Box<CompareOptions>),
    /// What a model leaves unexplained in records: whiteness, dependence on the input.
    Residuals(Box<ResidualArguments>),
    /// A neutral wing model (JSON): matrices, flutter, divergence, as JSON.
    Wing {
        /// Model file; `-` reads standard input.
        file: PathBuf,
    },
    /// A neutral aircraft model (JSON): matrices, trims, eigenvalues, responses, as JSON.
    Aircraft {
        /// Model file; `-` reads standard input.
        file: PathBuf,
    },
}

#[derive(Debug, Clone, Args)]
pub(crate) struct CaseOptions {
    /// Case file (TOML).
    pub(crate) case: PathBuf,
    /// Variant of the case; the first one by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ModesOptions {
    /// Case file (TOML); or give a deck and its results.
    pub(crate) case: Option<PathBuf>,
    /// Nastran deck.
    #[arg(long, value_name = "FILE")]
    pub(crate) deck: Option<PathBuf>,
    /// Results of SOL 103.
    #[arg(long, value_name = "FILE")]
    pub(crate) results: Option<PathBuf>,
    /// Elastic modes wanted of --results; all by default.
    #[arg(long, value_name = "N")]
    pub(crate) modes: Option<usize>,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub(crate) case: CaseOptions,
    /// Directory for the results; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct BodeOptions {
    #[command(flatten)]
    pub(crate) case: CaseOptions,
    /// Input; the trim control by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) input: Option<String>,
    /// Angular frequencies instead of those of the case \[rad/s\].
    #[arg(long, value_name = "RAD_S", value_delimiter = ',', num_args = 1..)]
    pub(crate) omega: Option<Vec<f64>>,
}

#[derive(Debug, Args)]
pub(crate) struct SimulateOptions {
    #[command(flatten)]
    pub(crate) case: CaseOptions,
    /// Manoeuvre of the case; the first one by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) manoeuvre: Option<String>,
    /// Write all samples as CSV to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
}
