//! What can go wrong, with the numbers needed to act on it.

use crate::ShortNumber;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An iteration of the dense algebra did not converge.
    #[error("{what} of a matrix of order {size} did not converge")]
    NoConvergence {
        /// The decomposition attempted.
        what: &'static str,
        /// Order of the matrix.
        size: usize,
    },
    /// A square system is singular to working precision.
    #[error(
        "the {size} x {size} system is singular: reciprocal condition {rcond:.1e} after equilibration (needs more than {limit:.1e})"
    )]
    Singular {
        /// Order of the matrix.
        size: usize,
        /// Estimated reciprocal condition number of the equilibrated matrix, 1-norm.
        rcond: f64,
        /// The least reciprocal condition accepted.
        limit: f64,
    },
    /// An input holds NaN or an infinity.
    #[error("{what} has a non-finite entry at row {row}, column {col} (counted from 0)")]
    NonFinite {
        /// The offending input.
        what: &'static str,
        /// Row of the first such entry.
        row: usize,
        /// Column of the first such entry.
        col: usize,
    },
    /// An input has the wrong shape.
    #[error("{what} is {} x {}, expected {} x {}", found.0, found.1, expected.0, expected.1)]
    Shape {
        /// The offending input.
        what: &'static str,
        /// Rows and columns needed.
        expected: (usize, usize),
        /// Rows and columns given.
        found: (usize, usize),
    },
    /// The abscissae of a table do not increase strictly.
    #[error(
        "abscissa {index} is {found}, which does not exceed its predecessor {previous}: sort the table and merge repeated points", found = ShortNumber(*found), previous = ShortNumber(*previous))]
    NotIncreasing {
        /// Index of the offending abscissa.
        index: usize,
        /// The abscissa before it.
        previous: f64,
        /// The abscissa found.
        found: f64,
    },
    /// A table has too few points.
    #[error("{what} needs at least {needed} points, found {found}")]
    TooFewPoints {
        /// What the points were for.
        what: &'static str,
        /// The least number of points.
        needed: usize,
        /// The number given.
        found: usize,
    },
    /// A matrix that must be symmetric is not.
    #[error(
        "{what} is not symmetric: entries ({row}, {col}) and ({col}, {row}) differ by {difference:.1e} of the largest entry"
    )]
    NotSymmetric {
        /// The offending input.
        what: &'static str,
        /// Row of the worst pair.
        row: usize,
        /// Column of the worst pair.
        col: usize,
        /// Difference of the pair over the largest magnitude.
        difference: f64,
    },
    /// A matrix that must be positive definite is not.
    #[error("{what} is not positive definite")]
    NotPositiveDefinite {
        /// The offending input.
        what: &'static str,
    },
    /// An argument lies outside the range where a function is defined.
    #[error("{what} is {value}, expected {expected}", value = ShortNumber(*value))]
    Domain {
        /// The argument.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The range accepted.
        expected: &'static str,
    },
}

/// Result with this crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;
