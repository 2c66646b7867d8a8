//! What can go wrong between a result and its bytes.

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A name that the format cannot hold.
    #[error("`{name}` cannot name a variable of a {format}: expected {expected}")]
    Name {
        /// The name.
        name: String,
        /// The format.
        format: &'static str,
        /// What names look like there.
        expected: &'static str,
    },
    /// More data than the format can count.
    #[error("{what} has {found} bytes, more than the {most} of a {format}: export fewer samples or signals")]
    TooLarge {
        /// What is too large.
        what: String,
        /// The format.
        format: &'static str,
        /// Its size.
        found: usize,
        /// Largest size.
        most: usize,
    },
    /// Parts of a result do not fit together.
    #[error("{what}: found {found}, expected {expected}")]
    Mismatch {
        /// What was compared.
        what: String,
        /// What was found.
        found: usize,
        /// What was expected.
        expected: usize,
    },
    /// From linear systems.
    #[error(transparent)]
    Lti(#[from] albatross_lti::Error),
    /// From the flight mechanics.
    #[error(transparent)]
    Flight(#[from] albatross_flight::Error),
    /// From the writer of comma-separated values.
    #[error("CSV: {0}")]
    Csv(#[from] csv::Error),
    /// From the writer of Parquet.
    #[cfg(feature = "parquet")]
    #[error("Parquet: {0}")]
    Parquet(#[from] parquet::errors::ParquetError),
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses a number of parts that differs from what it goes with.
pub(crate) fn fit(what: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Error::Mismatch {
        what: what.to_owned(),
        found,
        expected,
    })
}
