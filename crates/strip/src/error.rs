//! What can go wrong.

use albatross_numerics::ShortNumber;

/// Errors of strip aerodynamics.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A strip has a number that the theory cannot use.
    #[error("strip {}: {quantity} is {value}, expected {expected}; correct the strip table", index + 1, value = ShortNumber(*value))]
    BadStrip {
        /// Index of the strip, from 0.
        index: usize,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// A mode has a number that the theory cannot use.
    #[error("mode {}: {quantity} is {value}, expected {expected}; correct the modal data", index + 1, value = ShortNumber(*value))]
    BadMode {
        /// Index of the mode, from 0.
        index: usize,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// A lag has a number that the theory cannot use.
    #[error("lag {}: {quantity} is {value}, expected {expected}; lags decay and take downwash away (the paper's signs)", index + 1, value = ShortNumber(*value))]
    BadLag {
        /// Index of the lag, from 0.
        index: usize,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// An option or reference dimension is unusable.
    #[error("{option} is {value}, expected {expected}", value = ShortNumber(*value))]
    BadOption {
        /// The option or dimension.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What it must be, and the cure.
        expected: &'static str,
    },
    /// Density or speed is unusable.
    #[error("{quantity} is {value}, expected zero or a positive number; correct the flight point", value = ShortNumber(*value))]
    BadFlow {
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// Two arrays do not fit together.
    #[error("{what} is {} x {}, expected {} x {}", found.0, found.1, expected.0, expected.1)]
    Shape {
        /// Which array.
        what: &'static str,
        /// Rows and columns wanted.
        expected: (usize, usize),
        /// Rows and columns found.
        found: (usize, usize),
    },
    /// An entry is NaN or infinite.
    #[error("{what}: entry in row {}, column {} is not a finite number", row + 1, column + 1)]
    NotFinite {
        /// Which array.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// Nothing to work on.
    #[error("there are no {what}; at least one is needed")]
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// Two strip tables that should describe the same strips do not.
    #[error("{what}: {found}; expected {expected}")]
    StripTables {
        /// Which tables or surface.
        what: String,
        /// What was found.
        found: String,
        /// What was expected, and the cure.
        expected: String,
    },
    /// Speeds of a sweep do not increase.
    #[error("speed {} of the sweep is {found}, which does not exceed the one before, {previous}; sort the speeds and merge repeated ones", index + 1, found = ShortNumber(*found), previous = ShortNumber(*previous))]
    NotIncreasing {
        /// Index of the speed, from 0.
        index: usize,
        /// The speed before it.
        previous: f64,
        /// The speed found.
        found: f64,
    },
    /// Modes could not be followed.
    #[error(transparent)]
    Tracking(#[from] albatross_lti::Error),
    /// A linear algebra step failed.
    #[error(transparent)]
    Numerics(#[from] albatross_numerics::Error),
}
