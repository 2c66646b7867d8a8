//! What can be wrong with a file, and what to do about it.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::results::FileKind;

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Location {
    /// File name as the caller gave it.
    pub file: String,
    /// Line, counted from 1.
    pub line: usize,
    /// First column of the field, counted from 1; zero when the whole line is meant.
    pub column: usize,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.line)?;
        if self.column > 0 {
            write!(f, ":{}", self.column)
        } else {
            Ok(())
        }
    }
}

/// Errors of the readers and writers of this crate.
///
/// Every message names the file, the place, what was found and what was expected, and ends with the cure
/// where there is one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AvlError {
    /// The operating system did not give the file.
    #[error("{file}: cannot be read ({reason}); check the path and the permissions")]
    Io {
        /// File name.
        file: String,
        /// Message of the operating system.
        reason: String,
    },
    /// Nothing but blank lines.
    #[error("{file}: the file is empty; expected {expected}")]
    Empty {
        /// File name.
        file: String,
        /// What the reader was asked for.
        expected: String,
    },
    /// The file is a readable AVL file of another kind.
    #[error(
        "{file}: this is {found}, but {wanted} is needed; write it with {command}",
        found = .found.description(),
        wanted = .wanted.description(),
        command = .wanted.command()
    )]
    WrongKind {
        /// File name.
        file: String,
        /// What the content says it is.
        found: FileKind,
        /// What the caller asked for.
        wanted: FileKind,
    },
    /// The content is none of the known AVL files.
    #[error(
        "{file}: not recognised as an AVL output file (first line with text: `{first}`); \
         expected the text or MRF output of OPER FT, ST, SB, FN, FB, FS, FSB, FE, HM, VM, CN or MODE S, W"
    )]
    UnknownKind {
        /// File name.
        file: String,
        /// First line with text, cut to 60 characters.
        first: String,
    },
    /// Fortran filled a field with `*` because the number did not fit.
    #[error(
        "{at}: field `{field}` overflowed (`{found}`): AVL printed stars because the number does not fit its \
         columns; check Sref, Cref, Bref and the units, or rerun AVL 3.40 or later with OPER > MRF, which \
         prints 16 digits"
    )]
    Overflow {
        /// Where.
        at: Location,
        /// Name of the field as AVL prints it.
        field: String,
        /// The characters found.
        found: String,
    },
    /// A field that should be a number is not.
    #[error("{at}: field `{field}`: `{found}` is not {expected}")]
    Number {
        /// Where.
        at: Location,
        /// Name of the field as AVL prints it.
        field: String,
        /// The characters found.
        found: String,
        /// What was expected, with its article: "a number", "a whole number".
        expected: &'static str,
    },
    /// `NaN` or `Infinity`: the AVL run that wrote the file failed.
    #[error(
        "{at}: field `{field}` is `{found}`, not a finite number: the AVL run that wrote this file failed; \
         check the geometry for zero chords or areas and run it again"
    )]
    NotFinite {
        /// Where.
        at: Location,
        /// Name of the field.
        field: String,
        /// The characters found.
        found: String,
    },
    /// The file ends before what it must hold.
    #[error(
        "{file}: the file ends at line {line} before {expected}; it was cut short: write or copy it again"
    )]
    Truncated {
        /// File name.
        file: String,
        /// Number of lines of the file.
        line: usize,
        /// What was to come.
        expected: String,
    },
    /// A field that the file must hold is not there.
    #[error("{file}:{line}: no `{field}` in the block that starts here; {cure}")]
    Missing {
        /// File name.
        file: String,
        /// First line of the block that should hold it.
        line: usize,
        /// Name of the field as AVL prints it.
        field: String,
        /// What to do.
        cure: &'static str,
    },
    /// A line does not have the form that its place in the file asks for.
    #[error("{at}: found `{found}`, expected {expected}")]
    Syntax {
        /// Where.
        at: Location,
        /// The characters found, cut to 60.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Two statements of the same count differ.
    #[error(
        "{at}: {what}: the file announces {announced} but holds {found}; it was edited or cut: write it again"
    )]
    Count {
        /// Where.
        at: Location,
        /// What is counted.
        what: String,
        /// Number announced.
        announced: usize,
        /// Number found.
        found: usize,
    },
    /// A number cannot be written in the columns that AVL gives it.
    #[error("cannot write `{field}`: {value:?} does not fit the Fortran format {format}; {cure}")]
    DoesNotFit {
        /// Name of the field.
        field: String,
        /// The number.
        value: f64,
        /// Format, as in `F10.5`.
        format: &'static str,
        /// What to do.
        cure: &'static str,
    },
    /// A text cannot be written where AVL would read it back.
    #[error("cannot write `{field}`: `{text}` {reason}")]
    BadText {
        /// Name of the field.
        field: String,
        /// The text.
        text: String,
        /// Why AVL would not read it back.
        reason: &'static str,
    },
}

/// Something the reader accepted, but which AVL, or some versions of it, treats otherwise.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// Where.
    pub at: Location,
    /// Keyword or field concerned, as in `SECTION`.
    pub keyword: String,
    /// What was found, and what AVL makes of it.
    pub message: String,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: warning: {}: {}", self.at, self.keyword, self.message)
    }
}
