//! What can go wrong, with the names and numbers needed to act on it.

use albatross_numerics::ShortNumber;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A table of samples cannot be read.
    #[error("{}: found {found}, expected {expected}", place(file, *line))]
    Table {
        /// File.
        file: String,
        /// Line from 1; 0 if the whole file is concerned.
        line: usize,
        /// What was found.
        found: String,
        /// What was expected, and the cure.
        expected: String,
    },
    /// A column is asked for that the table does not have.
    #[error("{file}: there is no column \"{column}\"; the columns are: {known}")]
    UnknownColumn {
        /// File.
        file: String,
        /// The name asked for.
        column: String,
        /// The names there are, separated by commas.
        known: String,
    },
    /// A sample is not a finite number.
    #[error(
        "{experiment}: {signal} is not finite at sample {sample} (counted from 0): remove or repair the sample"
    )]
    NonFinite {
        /// Name of the experiment.
        experiment: String,
        /// Input or output.
        signal: String,
        /// Index of the sample.
        sample: usize,
    },
    /// Experiments or signals do not fit together.
    #[error("{what}: found {found}, expected {expected}")]
    Mismatch {
        /// What was compared.
        what: String,
        /// What was found.
        found: String,
        /// What was expected, and the cure.
        expected: String,
    },
    /// A signal that must move stands still.
    #[error(
        "{experiment}: {signal} is constant over all {samples} samples: nothing can be identified from it"
    )]
    Constant {
        /// Name of the experiment.
        experiment: String,
        /// Input or output.
        signal: String,
        /// Number of samples.
        samples: usize,
    },
    /// A signal so large or small that squares of it are no numbers of double precision.
    #[error(
        "{experiment}: the largest value of {signal} is {largest:e}, expected 1e-60 to 1e60: give it in another unit"
    )]
    Size {
        /// Which experiment.
        experiment: String,
        /// Which signal.
        signal: String,
        /// Its largest size.
        largest: f64,
    },
    /// Fewer samples than unknowns.
    #[error(
        "{poles} poles and {zeros} zeros have {unknowns} unknowns, but {experiments} give {samples} samples, at least {needed} are needed: lower the order or add data"
    )]
    TooFewSamples {
        /// Poles asked for.
        poles: usize,
        /// Zeros asked for.
        zeros: usize,
        /// Unknowns of the model and of the initial conditions.
        unknowns: usize,
        /// Which experiments.
        experiments: String,
        /// Samples that there are.
        samples: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Numbers of poles and zeros that no causal model has.
    #[error("{poles} poles and {zeros} zeros: {expected}")]
    Order {
        /// Poles asked for.
        poles: usize,
        /// Zeros asked for.
        zeros: usize,
        /// What is accepted.
        expected: &'static str,
    },
    /// A number lies outside the range accepted.
    #[error("{what} is {value}, expected {expected}", value = ShortNumber(*value))]
    Domain {
        /// The number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The range accepted.
        expected: &'static str,
    },
    /// No start led to a model.
    #[error("no model with {poles} poles and {zeros} zeros was found in {starts} starts: {reason}")]
    NoModel {
        /// Poles asked for.
        poles: usize,
        /// Zeros asked for.
        zeros: usize,
        /// Starts tried.
        starts: usize,
        /// What went wrong with the last one, and the cure.
        reason: String,
    },
    /// A record is too short for the block rows of a subspace method.
    #[error(
        "{experiment}: {samples} samples{after} are too few for {poles} poles with a horizon of {horizon} samples, which needs {needed}: add data, lower the order or give a smaller horizon"
    )]
    ShortRecord {
        /// Name of the experiment, or all of them.
        experiment: String,
        /// Samples that there are.
        samples: usize,
        /// Empty, or by what factor they were thinned.
        after: String,
        /// Poles asked for.
        poles: usize,
        /// Block rows.
        horizon: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A discrete-time pole without a real logarithm.
    #[error(
        "the discrete pole at {pole} has no real logarithm: a pole at zero is a delay, a simple negative one can be doubled", pole = ShortNumber(*pole))]
    NoLogarithm {
        /// The pole in the z plane.
        pole: f64,
    },
    /// A logarithm of a matrix whose exponential is another matrix.
    #[error(
        "the continuous model does not reproduce the discrete one (difference {error:.1e}): poles near zero or nearly multiple on the negative real axis cannot be converted"
    )]
    Conversion {
        /// Largest difference of an entry.
        error: f64,
    },
    /// From linear systems.
    #[error(transparent)]
    Lti(#[from] albatross_lti::Error),
    /// From the dense algebra.
    #[error(transparent)]
    Numerics(#[from] albatross_numerics::Error),
}

fn place(file: &str, line: usize) -> String {
    if line == 0 {
        file.to_owned()
    } else {
        format!("{file}:{line}")
    }
}

/// Result with this crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;
