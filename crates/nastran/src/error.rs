//! What can be wrong: diagnostics for records, errors for whole files.

use std::fmt;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// How much a diagnostic matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Severity {
    /// Worth knowing; nothing is lost.
    Note,
    /// Read, with an assumption that the message states.
    Warning,
    /// The record was not read, or the file contradicts itself: results that use it would be wrong.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

/// One remark of a reader about one record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// File as named to the reader or in the INCLUDE statement.
    pub file: String,
    /// Line, from 1; 0 when the remark is about the whole file.
    pub line: u32,
    /// Card or table, such as `GRID 1004` or `eigenvector 7`; may be empty.
    pub card: String,
    /// What was found, what was expected, and the cure.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.severity, self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        if !self.card.is_empty() {
            write!(f, ": {}", self.card)?;
        }
        write!(f, ": {}", self.message)
    }
}

/// Why a file could not be used at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file cannot be opened or read.
    #[error("{}: cannot be read: {source}; check the path and the permissions", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        #[source]
        source: std::io::Error,
    },
    /// The deck has records in error, and the caller asked for a deck without.
    #[error("{}", deck_errors(.errors))]
    Deck {
        /// The diagnostics of severity error, at least one.
        errors: Vec<Diagnostic>,
    },
    /// The file is of another kind than the reader's.
    #[error("{file}: {found}; expected {expected}")]
    WrongKind {
        /// The file.
        file: String,
        /// What the file seems to be.
        found: String,
        /// What the reader takes, and the cure.
        expected: String,
    },
    /// A results file lacks what a real modal analysis prints.
    #[error("{file}: {missing}; {cure}")]
    MissingResult {
        /// The file.
        file: String,
        /// What is not there.
        missing: String,
        /// Which output request or solution to add.
        cure: String,
    },
    /// A card that cannot be written in any field format.
    #[error("{card}: {problem}")]
    Unwritable {
        /// The card.
        card: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// Coordinate systems or points that cannot be resolved.
    #[error("{location}: {problem}")]
    Frame {
        /// File and line of the card when known, else the card's name and number.
        location: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// Results and deck do not belong together.
    #[error("{file}: {problem}")]
    Mismatch {
        /// The results file.
        file: String,
        /// What does not fit, and the cure.
        problem: String,
    },
}

fn deck_errors(errors: &[Diagnostic]) -> String {
    const SHOWN: usize = 10;
    let mut text = errors
        .iter()
        .take(SHOWN)
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n");
    if errors.len() > SHOWN {
        text.push_str(&format!("\nand {} further errors", errors.len() - SHOWN));
    }
    text
}

/// The model, unless a diagnostic is an error: for callers that compute with what was read. Notes and warnings are
/// handed on.
///
/// # Errors
/// [`Error::Deck`] with every diagnostic of severity error.
pub fn refuse_errors<T>((model, diagnostics): (T, Vec<Diagnostic>)) -> Result<(T, Vec<Diagnostic>), Error> {
    let (errors, others): (Vec<_>, Vec<_>) = diagnostics
        .into_iter()
        .partition(|d| d.severity == Severity::Error);
    if errors.is_empty() {
        Ok((model, others))
    } else {
        Err(Error::Deck { errors })
    }
}
