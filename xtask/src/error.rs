//! What can go wrong in a task.

use std::path::{Path, PathBuf};

/// Errors of the tasks.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum Error {
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// A JSON file does not hold what it should.
    #[error("{}: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: serde_json::Error,
    },
    /// Data do not fit together.
    #[error("{what}: found {found}, expected {expected}")]
    Mismatch {
        /// What was compared.
        what: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A program cannot be started or failed.
    #[error("`{command}` {outcome}")]
    Command {
        /// The command line.
        command: String,
        /// How it ended.
        outcome: String,
    },
    /// A check found something; the list has been printed.
    #[error("{0}")]
    Failed(String),
    /// From the model.
    #[error(transparent)]
    Albatross(#[from] albatross::Error),
    /// From the frequency response and linear simulation.
    #[error(transparent)]
    Lti(#[from] albatross::lti::Error),
    /// From the equations of motion.
    #[error(transparent)]
    Flight(#[from] albatross::flight::Error),
    /// From the algebra.
    #[error(transparent)]
    Numerics(#[from] albatross::numerics::Error),
    /// From the identification.
    #[error(transparent)]
    Sysid(#[from] albatross::sysid::Error),
    /// From tables and plots.
    #[error(transparent)]
    Report(#[from] albatross::report::ReportError),
}

impl Error {
    /// For use with `map_err` on file operations.
    pub(crate) fn file(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::File {
            path: path.to_owned(),
            source,
        }
    }

    /// For use with `map_err` on JSON.
    pub(crate) fn json(path: &Path) -> impl FnOnce(serde_json::Error) -> Self {
        move |source| Self::Json {
            path: path.to_owned(),
            source,
        }
    }
}
