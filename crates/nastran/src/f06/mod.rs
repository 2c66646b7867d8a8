//! Reader of printed results (.f06, .out) of SOL 103: MSC, NX, Simcenter, NASTRAN-95 and MYSTRAN.
//!
//! The file is read line by line in one pass. Headings are letter-spaced and differ in blanks, so they are compared
//! with blanks removed; rows of eigenvectors are cut by column. Headings are repeated on every page: rows with the
//! same subcase and mode are merged as long as point numbers rise, and a restart begins a new block.

mod check;
mod reader;
mod row;
mod weight;

use std::path::Path;

use crate::error::Error;
use crate::results::ModalResults;

/// Reads printed results from memory. `source` names them in diagnostics.
///
/// What is there is returned, with remarks in [`ModalResults::diagnostics`]; damaged rows, vectors with fewer rows
/// than others and similar are remarks of severity error, see [`refuse_errors`](crate::refuse_errors). Use
/// [`ModalResults::require_eigenvectors`] and [`ModalResults::require_weight`] for what a computation needs.
///
/// # Errors
/// [`Error::WrongKind`] for a file that is not a printed result; [`Error::MissingResult`] for one without
/// eigenvalues, eigenvectors and weight, with the output request to add.
pub fn parse(text: &[u8], source: &str) -> Result<ModalResults, Error> {
    reader::Reader::new(source).read(text)
}

/// Reads printed results from a file.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, and the errors of [`parse`].
pub fn read(path: impl AsRef<Path>) -> Result<ModalResults, Error> {
    let path = path.as_ref();
    let text = std::fs::read(path).map_err(|source| Error::Io {
        path: path.to_owned(),
        source,
    })?;
    parse(&text, &path.display().to_string())
}
