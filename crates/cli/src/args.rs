//! The command line.

use crate::identification::args::{CompareOptions, IdentifyCommand, ResidualArguments};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Flight dynamics of flexible high-aspect-ratio aircraft.
///
/// A case file names the inputs and the analyses: `albatross new DIR` writes one to start from.
#[derive(Debug, Parser)]
#[command(name = "albatross", version, about, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 an input or a computation was refused (`check`: an error was found); 2 the command line was not \
understood. Results go to standard output, notes, progress and errors to standard error. NO_COLOR switches colours off.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// A commented case with a small complete aircraft, to start from.
    New(NewOptions),
    /// What is missing, unusual or inconsistent in a case and its files; nothing is analysed.
    Check(CheckOptions),
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
    /// Linear model, transfer function, time history or mode shapes in the format of another program.
    Export(ExportOptions),
    /// Transfer functions from time histories, with common poles, standard deviations and fits.
    Identify(IdentifyCommand),
    /// A model against another one (poles, frequency responses, peaks) and against records (fits).
    Compare(Box<CompareOptions>),
    /// What a model leaves unexplained in records: whiteness, dependence on the input.
    Residuals(Box<ResidualArguments>),
    /// Normal modes of a Nastran deck: no Nastran needed.
    SolveModes(SolveModesOptions),
    /// Vortex lattice of an AVL geometry: no AVL needed.
    Vlm(Box<VlmOptions>),
    /// A neutral wing model (JSON): matrices, flutter, divergence, as JSON.
    Wing(NeutralOptions),
    /// A neutral aircraft model (JSON): matrices, trims, eigenvalues, responses, as JSON.
    Aircraft(NeutralOptions),
    /// Completions for a shell, on standard output.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Manual pages, one for each command.
    Man(ManOptions),
}

#[derive(Debug, Args)]
pub(crate) struct NewOptions {
    /// Directory for the files; made if it is not there.
    pub(crate) dir: PathBuf,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// Nothing on standard output.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckOptions {
    /// Case file (TOML).
    pub(crate) case: PathBuf,
    /// Warnings count as errors.
    #[arg(long)]
    pub(crate) strict: bool,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// Errors and warnings only.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct NeutralOptions {
    /// Model file; `-` reads standard input.
    pub(crate) file: PathBuf,
    /// JSON on standard output: always so, accepted as everywhere.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes on standard error: there are none, accepted as everywhere.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ManOptions {
    /// Directory for the pages; made if it is not there.
    pub(crate) dir: PathBuf,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// Nothing on standard output.
    #[arg(long, short)]
    pub(crate) quiet: bool,
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
    /// Draw the shapes.
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
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

#[derive(Debug, Args)]
pub(crate) struct ExportOptions {
    #[command(flatten)]
    pub(crate) case: CaseOptions,
    /// Files to write; the ending chooses: .mat, .npz, .json or .csv for the linear model, .vtu for the mode shapes.
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    pub(crate) to: Vec<PathBuf>,
    /// The transfer function of this channel instead of the linear model: .json, .mat or .npz.
    #[arg(long, num_args = 2, value_names = ["INPUT", "OUTPUT"], conflicts_with = "manoeuvre")]
    pub(crate) transfer: Vec<String>,
    /// Leave out pairs of zeros and poles of --transfer within this part of their modulus.
    #[arg(long, value_name = "PART", default_value_t = 0.0, requires = "transfer")]
    pub(crate) cancel: f64,
    /// The time history of this manoeuvre instead of the linear model: .csv, .parquet, .mat, .npz or .json.
    #[arg(long, value_name = "NAME")]
    pub(crate) manoeuvre: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct SolveModesOptions {
    /// Nastran deck.
    pub(crate) deck: PathBuf,
    /// Number of modes, rigid-body modes included; that of the deck's EIGRL or EIGR by default, else 20.
    #[arg(long, value_name = "N")]
    pub(crate) modes: Option<usize>,
    /// Lower end of the frequency range \[Hz\].
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Upper end of the frequency range \[Hz\].
    #[arg(long, value_name = "HZ")]
    pub(crate) to: Option<f64>,
    /// How the mass of elements is spread; as PARAM,COUPMASS of the deck says by default.
    #[arg(long, value_enum)]
    pub(crate) mass: Option<MassChoice>,
    /// Subcase whose SPC, MPC and METHOD count.
    #[arg(long, value_name = "N")]
    pub(crate) subcase: Option<u32>,
    /// Leave out elements that are not modelled, instead of stopping.
    #[arg(long)]
    pub(crate) leave_out_unknown: bool,
    /// Eigenvectors into the JSON.
    #[arg(long)]
    pub(crate) vectors: bool,
    /// Write eigenvalues, eigenvectors and grid point weight in the layout of an f06.
    #[arg(long, value_name = "FILE")]
    pub(crate) f06: Option<PathBuf>,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MassChoice {
    /// Half of it at each end.
    Lumped,
    /// Consistent with the displacements within the element.
    Coupled,
}

#[derive(Debug, Args)]
pub(crate) struct VlmOptions {
    /// AVL geometry.
    pub(crate) geometry: PathBuf,
    /// Mach number; that of the geometry file by default.
    #[arg(long, value_name = "M")]
    pub(crate) mach: Option<f64>,
    /// Angle of attack \[deg\]; 0 by default.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) alpha: Option<f64>,
    /// Sideslip \[deg\].
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    pub(crate) beta: Option<f64>,
    /// Roll rate p b/2V.
    #[arg(long, value_name = "RATE", allow_negative_numbers = true)]
    pub(crate) pb2v: Option<f64>,
    /// Pitch rate q c/2V.
    #[arg(long, value_name = "RATE", allow_negative_numbers = true)]
    pub(crate) qc2v: Option<f64>,
    /// Yaw rate r b/2V.
    #[arg(long, value_name = "RATE", allow_negative_numbers = true)]
    pub(crate) rb2v: Option<f64>,
    /// Deflection of a control, in degrees times its gain.
    #[arg(long = "set", value_name = "CONTROL=DEG")]
    pub(crate) set: Vec<String>,
    /// Lift coefficient that the angle of attack is to reach.
    #[arg(
        long,
        value_name = "CL",
        allow_negative_numbers = true,
        conflicts_with = "alpha"
    )]
    pub(crate) cl: Option<f64>,
    /// Variable that brings a coefficient to zero, or to a value: `elevator=Cm`, `aileron=Cl=0.01`, `beta=CY`.
    /// Variables are alpha, beta, pb2v, qc2v, rb2v and the controls; coefficients CL, CY, Cl, Cm, Cn.
    #[arg(long, value_name = "VARIABLE=COEFFICIENT[=VALUE]")]
    pub(crate) trim: Vec<String>,
    /// Run cases of AVL (.run); their constraints, Mach number, profile drag and moment point hold where no option says
    /// otherwise.
    #[arg(long, value_name = "FILE")]
    pub(crate) run: Option<PathBuf>,
    /// Number of the run case.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "run")]
    pub(crate) case: usize,
    /// Moment reference point; that of the geometry file by default.
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        num_args = 3,
        allow_negative_numbers = true
    )]
    pub(crate) reference_point: Option<Vec<f64>>,
    /// Version of AVL whose method is followed.
    #[arg(long, value_enum, default_value = "avl352")]
    pub(crate) core: CoreChoice,
    /// Forces on the trailing legs that lie on the surface; as in that version by default.
    #[arg(long, value_name = "BOOL", num_args = 0..=1, default_missing_value = "true")]
    pub(crate) leg_forces: Option<bool>,
    /// Threads.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) threads: usize,
    /// Write PREFIX.st, PREFIX.ft and PREFIX.fs as AVL 3.52 does.
    #[arg(long, value_name = "PREFIX")]
    pub(crate) write: Option<PathBuf>,
    /// JSON on standard output, with AVL's names as keys.
    #[arg(long)]
    pub(crate) json: bool,
    /// No notes on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CoreChoice {
    /// AVL 3.32, and up to 3.40.
    Avl332,
    /// AVL 3.52.
    Avl352,
}
