//! What can go wrong, with the names and numbers needed to act on it.

use albatross_numerics::ShortNumber;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A matrix does not fit the numbers of states, inputs and outputs.
    #[error("matrix {matrix} is {} x {}, but {states} states, {inputs} inputs and {outputs} outputs need {} x {}", found.0, found.1, expected.0, expected.1)]
    Shape {
        /// A, B, C or D.
        matrix: &'static str,
        /// Rows and columns needed.
        expected: (usize, usize),
        /// Rows and columns given.
        found: (usize, usize),
        /// Number of state names.
        states: usize,
        /// Number of input names.
        inputs: usize,
        /// Number of output names.
        outputs: usize,
    },
    /// Two signals of one kind carry the same name.
    #[error("two {kind}s are called \"{name}\": give each its own name")]
    DuplicateName {
        /// State, input or output.
        kind: SignalKind,
        /// The repeated name.
        name: String,
    },
    /// A signal is asked for that the system does not have.
    #[error("there is no {kind} \"{name}\"; the {kind}s are: {known}")]
    UnknownSignal {
        /// State, input or output.
        kind: SignalKind,
        /// The name asked for.
        name: String,
        /// The names there are, separated by commas.
        known: String,
    },
    /// Two systems cannot be joined.
    #[error("{joint}: {left} signals cannot be joined to {right}")]
    Mismatch {
        /// Which connection.
        joint: &'static str,
        /// Number of signals on one side.
        left: usize,
        /// Number of signals on the other side.
        right: usize,
    },
    /// An operation for one input and one output was asked of a larger system.
    #[error("{what} needs one input and one output, found {inputs} and {outputs}: use `select` first")]
    NotSiso {
        /// The operation.
        what: &'static str,
        /// Number of inputs.
        inputs: usize,
        /// Number of outputs.
        outputs: usize,
    },
    /// The response was asked for at a pole.
    #[error(
        "the system has a pole at {re:.6e} {im:+.6e}i rad/s, where its response was asked for (frequency {omega_rad_s:.6e} rad/s): leave that frequency out, or remove the undamped state"
    )]
    PoleAtFrequency {
        /// Frequency asked for, rad/s.
        omega_rad_s: f64,
        /// Real part of the argument of the transfer function.
        re: f64,
        /// Imaginary part of the argument of the transfer function.
        im: f64,
    },
    /// A chosen solution method does not suit the system.
    #[error("{method} is not possible for this system: {reason}")]
    Method {
        /// The method.
        method: &'static str,
        /// Why.
        reason: String,
    },
    /// A mode could not be followed.
    #[error(
        "mode {mode} ({re:.4e} {im:+.4e}i rad/s) cannot be followed beyond {progress:.6} of the way: best overlap {best:.3}, next {next:.3}, at the least step {least_step:.1e}. Modes coalesce there: start from another reference, or allow smaller steps"
    )]
    Unresolved {
        /// Index of the mode among those followed.
        mode: usize,
        /// Real part of its last certain eigenvalue, rad/s.
        re: f64,
        /// Imaginary part of its last certain eigenvalue, rad/s.
        im: f64,
        /// Fraction of the path covered, 0 to 1.
        progress: f64,
        /// Overlap with the best candidate (1 is certain).
        best: f64,
        /// Overlap with the next candidate.
        next: f64,
        /// The least step allowed.
        least_step: f64,
    },
    /// A mode to be followed is not an eigenvalue of the first matrix, or is a defective one.
    #[error("{re:.6e} {im:+.6e}i rad/s cannot start a track: {reason}")]
    BadStart {
        /// Real part of the value asked for, rad/s.
        re: f64,
        /// Imaginary part of the value asked for, rad/s.
        im: f64,
        /// Why.
        reason: &'static str,
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
    /// A sample of an input has the wrong number of entries.
    #[error("input sample {sample} has {found} values, the system has {expected} inputs")]
    InputWidth {
        /// Index of the sample.
        sample: usize,
        /// Number of inputs.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// The transfer function has more zeros than poles.
    #[error("{zeros} zeros but only {poles} poles: an improper transfer function has no state space")]
    Improper {
        /// Number of zeros.
        zeros: usize,
        /// Number of poles.
        poles: usize,
    },
    /// Complex poles or zeros without their conjugates.
    #[error("{re:.6e} {im:+.6e}i has no conjugate partner among the {what}")]
    Unpaired {
        /// Poles or zeros.
        what: &'static str,
        /// Real part.
        re: f64,
        /// Imaginary part.
        im: f64,
    },
    /// A polynomial without a leading coefficient.
    #[error("the {what} is empty or zero")]
    ZeroPolynomial {
        /// Numerator or denominator.
        what: &'static str,
    },
    /// From the dense algebra.
    #[error(transparent)]
    Numerics(#[from] albatross_numerics::Error),
}

/// What a named signal is to its system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SignalKind {
    /// A state.
    State,
    /// An input.
    Input,
    /// An output.
    Output,
}

impl core::fmt::Display for SignalKind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::State => "state",
            Self::Input => "input",
            Self::Output => "output",
        })
    }
}

/// Result with this crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;
