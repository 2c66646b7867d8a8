//! Options of `identify`, `compare` and `residuals`.

use albatross::sysid::estimate::{Delay, InitialCondition, Initialisation, Options, Weights};
use albatross::sysid::{Detrend, Intersample, SearchMethod};
use clap::{ArgMatches, Args, Command, FromArgMatches, ValueEnum};
use std::path::PathBuf;

/// `identify` with its own options, or followed by the name of a kind.
///
/// Written out, since a derived form cannot have required options that a subcommand does away with.
#[derive(Debug)]
pub(crate) enum IdentifyCommand {
    /// One order.
    Single(Box<IdentifyOptions>),
    /// `identify search`.
    Search(Box<SearchOptions>),
}

const SEARCH: &str = "search";

impl Args for IdentifyCommand {
    fn augment_args(command: Command) -> Command {
        // The description last: those of the groups of options replace it.
        let search = SearchOptions::augment_args(Command::new(SEARCH))
            .about("The number of poles and zeros: tries a range on several trainings, then identifies with the best");
        IdentifyOptions::augment_args(command)
            .args_conflicts_with_subcommands(true)
            .subcommand_negates_reqs(true)
            .disable_help_subcommand(true)
            .subcommand(search)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for IdentifyCommand {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(match matches.subcommand() {
            Some((SEARCH, matches)) => Self::Search(Box::new(SearchOptions::from_arg_matches(matches)?)),
            _ => Self::Single(Box::new(IdentifyOptions::from_arg_matches(matches)?)),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[derive(Debug, Args)]
pub(crate) struct IdentifyOptions {
    /// Number of poles.
    #[arg(long, value_name = "N")]
    pub(crate) np: usize,
    /// Number of zeros of every output, at most that of the poles; one less than poles by default.
    #[arg(long, value_name = "N")]
    pub(crate) nz: Option<usize>,
    #[command(flatten)]
    pub(crate) data: DataOptions,
    /// Record to fit on; may be repeated. All records are scored. Without it all are fitted.
    #[arg(long, value_name = "FILE")]
    pub(crate) train: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) estimation: EstimationOptions,
    #[command(flatten)]
    pub(crate) result: ResultOptions,
}

#[derive(Debug, Args)]
pub(crate) struct SearchOptions {
    /// Numbers of poles tried, both ends included.
    #[arg(long, value_name = "FROM..TO", value_parser = range)]
    pub(crate) np: [usize; 2],
    /// Poles less zeros: 1 is nz = np - 1. Several numbers are all tried.
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "1")]
    pub(crate) excess: Vec<usize>,
    #[command(flatten)]
    pub(crate) data: DataOptions,
    /// Judge every order by the records left out, one after the other.
    #[arg(long)]
    pub(crate) leave_one_out: bool,
    /// Train on all records together only, not on each alone as well.
    #[arg(long)]
    pub(crate) merged_only: bool,
    /// Loss of mean fit that a smaller order may have, in percent points.
    #[arg(long, value_name = "POINTS", default_value_t = 0.3)]
    pub(crate) parsimony: f64,
    /// Candidates estimated side by side; as many as there are processors by default.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    #[command(flatten)]
    pub(crate) estimation: EstimationOptions,
    #[command(flatten)]
    pub(crate) result: ResultOptions,
}

/// Which samples are used, and how.
#[derive(Debug, Args)]
pub(crate) struct DataOptions {
    /// Records: tables of samples (CSV) with uniform times.
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Column of the input.
    #[arg(long, value_name = "NAME")]
    pub(crate) input: String,
    /// Column of an output; repeat for several outputs with common poles.
    #[arg(long, value_name = "NAME", required = true)]
    pub(crate) output: Vec<String>,
    #[command(flatten)]
    pub(crate) sampling: SamplingOptions,
}

#[derive(Debug, Clone, Args)]
pub(crate) struct SamplingOptions {
    /// Column of times; found by its name (t, time, t_s, ...) by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) column_time: Option<String>,
    /// Sample time of tables without times, in s.
    #[arg(long, value_name = "S")]
    pub(crate) sample_time: Option<f64>,
    /// Input between samples: held (zoh), linear (foh), or judged from the samples.
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) intersample: IntersampleChoice,
    /// What is subtracted as trim: the mean before the input moves (trim; auto also estimates a constant where that is
    /// short), the first sample, the mean of the record (wrong for doublets), nothing.
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) detrend: DetrendChoice,
    /// Keep every N-th sample, after low-pass filters.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) decimate: usize,
}

#[derive(Debug, Args)]
pub(crate) struct EstimationOptions {
    /// State at the first sample: at rest, unknown, or unknown where that lowers the cost by more than 5 %.
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) initial: InitialChoice,
    /// How starting poles are found.
    #[arg(long, value_enum, default_value = "srivc")]
    pub(crate) init: InitChoice,
    /// Search direction: subspace Gauss-Newton (gn), adaptive (gna), Levenberg-Marquardt (lm), steepest descent
    /// (gradient), or all in turn.
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) method: MethodChoice,
    /// Starts of the relocation of poles.
    #[arg(long, value_name = "N", default_value_t = 6)]
    pub(crate) starts: usize,
    /// Best starts that are refined by the search.
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(crate) refined: usize,
    /// Most weak poles that are tried elsewhere after the search.
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub(crate) moves: usize,
    /// Seed of the starts that are drawn at random (those beyond the sixth).
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Most iterations of a search.
    #[arg(long, value_name = "N", default_value_t = 60)]
    pub(crate) iterations: usize,
    /// Relative improvement of the cost at which a search ends.
    #[arg(long, value_name = "X", default_value_t = 1e-6)]
    pub(crate) tolerance: f64,
    /// Transport delay of the input, known, in s.
    #[arg(long, value_name = "S", conflicts_with = "max_delay")]
    pub(crate) delay: Option<f64>,
    /// Estimate the transport delay, up to this, in s.
    #[arg(long, value_name = "S")]
    pub(crate) max_delay: Option<f64>,
    /// Poles may lie in the right half plane.
    #[arg(long)]
    pub(crate) unstable: bool,
    /// Print the iterations of the search.
    #[arg(long)]
    pub(crate) log: bool,
    /// Weights of squared residuals: as the fit counts (fit), equal, or numbers by record, `1,2,1`, which several
    /// outputs separate by semicolons, `1,2,1;1,1,1`.
    #[arg(long, value_name = "WEIGHTS", default_value = "fit", value_parser = weights)]
    pub(crate) weights: WeightsChoice,
}

#[derive(Debug, Args)]
pub(crate) struct CompareOptions {
    /// The model: JSON of `identify` (model.json or its result) or of a state space (state_space.json or the result of
    /// `linearize`).
    pub(crate) model: PathBuf,
    /// Records to simulate: tables of samples (CSV).
    #[arg(value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Another model, of the same kinds: poles, frequency responses and their peaks are compared.
    #[arg(long, value_name = "FILE")]
    pub(crate) reference: Option<PathBuf>,
    /// Input of the model and column of the records; the only input by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) input: Option<String>,
    /// Output of the model and column of the records; may be repeated; all outputs of the model by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) output: Vec<String>,
    /// Input of the reference, where it has another name.
    #[arg(long, value_name = "NAME")]
    pub(crate) reference_input: Option<String>,
    /// Outputs of the reference in the order of the model's, where they have other names.
    #[arg(long, value_name = "NAME")]
    pub(crate) reference_output: Vec<String>,
    /// Band of the comparison in rad/s.
    #[arg(long, value_name = "LOW,HIGH", default_value = "0.1,95", value_parser = band)]
    pub(crate) band: [f64; 2],
    /// Largest difference of the frequencies of a pair in percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 15.0)]
    pub(crate) gate: f64,
    /// Least height of a peak of the magnitude above its valleys in dB.
    #[arg(long, value_name = "DB", default_value_t = 1.0)]
    pub(crate) prominence: f64,
    /// Also compare poles that are real, overdamped, out of the band, or not seen in the outputs.
    #[arg(long)]
    pub(crate) all_poles: bool,
    #[command(flatten)]
    pub(crate) sampling: SamplingOptions,
    /// State of the model at the first sample of a record; that of the identification if the file tells, else zero.
    #[arg(long, value_enum)]
    pub(crate) initial: Option<InitialChoice>,
    #[command(flatten)]
    pub(crate) result: ResultOptions,
}

#[derive(Debug, Args)]
pub(crate) struct ResidualArguments {
    /// The model: JSON of `identify` (model.json or its result) or of a state space.
    pub(crate) model: PathBuf,
    /// Records: tables of samples (CSV).
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Input of the model and column of the records; the only input by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) input: Option<String>,
    /// Output of the model and column of the records; may be repeated; all outputs of the model by default.
    #[arg(long, value_name = "NAME")]
    pub(crate) output: Vec<String>,
    /// Number of lags.
    #[arg(long, value_name = "N", default_value_t = 25)]
    pub(crate) lags: usize,
    /// Samples from one lag to the next; by default so many that the lags reach a period of the fastest oscillation.
    #[arg(long, value_name = "N")]
    pub(crate) step: Option<usize>,
    #[command(flatten)]
    pub(crate) sampling: SamplingOptions,
    /// State of the model at the first sample of a record; that of the identification if the file tells, else zero.
    #[arg(long, value_enum)]
    pub(crate) initial: Option<InitialChoice>,
    #[command(flatten)]
    pub(crate) result: ResultOptions,
}

#[derive(Debug, Args)]
pub(crate) struct ResultOptions {
    /// Directory for plots, tables and the model; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// JSON on standard output.
    #[arg(long)]
    pub(crate) json: bool,
    /// Neither notes nor progress on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntersampleChoice {
    Auto,
    Zoh,
    Foh,
}

impl IntersampleChoice {
    pub(crate) fn fixed(self) -> Option<Intersample> {
        match self {
            Self::Auto => None,
            Self::Zoh => Some(Intersample::Zoh),
            Self::Foh => Some(Intersample::Foh),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DetrendChoice {
    Auto,
    Trim,
    First,
    Mean,
    None,
}

impl From<DetrendChoice> for Detrend {
    fn from(choice: DetrendChoice) -> Self {
        match choice {
            DetrendChoice::Auto => Self::Auto,
            DetrendChoice::Trim => Self::Trim,
            DetrendChoice::First => Self::First,
            DetrendChoice::Mean => Self::Mean,
            DetrendChoice::None => Self::None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum InitialChoice {
    Zero,
    Estimate,
    Auto,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum InitChoice {
    Srivc,
    Svf,
    Subspace,
    All,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodChoice {
    Auto,
    Gn,
    Gna,
    Lm,
    Gradient,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum WeightsChoice {
    Fit,
    Equal,
    /// By output and record.
    Given(Vec<Vec<f64>>),
}

fn weights(text: &str) -> Result<WeightsChoice, String> {
    match text {
        "fit" => Ok(WeightsChoice::Fit),
        "equal" => Ok(WeightsChoice::Equal),
        list => list
            .split(';')
            .map(|output| {
                output
                    .split(',')
                    .map(|weight| {
                        weight
                            .trim()
                            .parse()
                            .ok()
                            .filter(|w: &f64| w.is_finite() && *w >= 0.0)
                            .ok_or_else(|| {
                                format!(
                                    "`{weight}` is no weight; expected fit, equal, or numbers not below zero"
                                )
                            })
                    })
                    .collect()
            })
            .collect::<Result<_, _>>()
            .map(WeightsChoice::Given),
    }
}

/// `0.1,95`.
fn band(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse::<f64>().ok();
    let ends = text
        .split_once(',')
        .map(|(low, high)| (number(low), number(high)));
    match ends {
        Some((Some(low), Some(high))) if low > 0.0 && high > low && high.is_finite() => Ok([low, high]),
        _ => Err("expected two frequencies in rad/s such as 0.1,95, the lower one above zero".to_owned()),
    }
}

/// `4..26`, or one number.
fn range(text: &str) -> Result<[usize; 2], String> {
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let number = |part: &str| part.trim_start_matches('=').trim().parse::<usize>().ok();
    match (number(from), number(to)) {
        (Some(from), Some(to)) if (1..=to).contains(&from) => Ok([from, to]),
        _ => Err("expected a range of whole numbers such as 4..26".to_owned()),
    }
}

impl EstimationOptions {
    /// Settings for a number of poles and zeros; outputs times records decide how given weights are read.
    pub(crate) fn settings(&self, poles: usize, zeros: usize) -> Options {
        Options {
            delay: match (self.delay, self.max_delay) {
                (_, Some(most)) => Delay::UpTo(most),
                (fixed, None) => Delay::Fixed(fixed.unwrap_or(0.0)),
            },
            initial: match self.initial {
                InitialChoice::Zero => InitialCondition::Zero,
                InitialChoice::Estimate => InitialCondition::Estimate,
                InitialChoice::Auto => InitialCondition::Auto,
            },
            initialisation: match self.init {
                InitChoice::Srivc => Initialisation::Srivc,
                InitChoice::Svf => Initialisation::Svf,
                InitChoice::Subspace => Initialisation::Subspace,
                InitChoice::All => Initialisation::All,
            },
            search: match self.method {
                MethodChoice::Auto => SearchMethod::Auto,
                MethodChoice::Gn => SearchMethod::SubspaceGaussNewton,
                MethodChoice::Gna => SearchMethod::AdaptiveGaussNewton,
                MethodChoice::Lm => SearchMethod::LevenbergMarquardt,
                MethodChoice::Gradient => SearchMethod::SteepestDescent,
            },
            stable: !self.unstable,
            weights: match &self.weights {
                WeightsChoice::Fit => Weights::Fit,
                WeightsChoice::Equal => Weights::Equal,
                WeightsChoice::Given(list) => Weights::Given(list.clone()),
            },
            starts: self.starts,
            seed: self.seed,
            refined: self.refined,
            iterations: self.iterations,
            reallocations: self.moves,
            tolerance: self.tolerance,
            ..Options::new(poles, zeros)
        }
    }
}
