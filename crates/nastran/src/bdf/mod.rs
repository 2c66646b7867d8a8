//! Reader of input decks (.bdf, .dat, .nas, .inp).
//!
//! Small, large and free field with every way to continue a card; tabs, CR LF, lower case, comments; INCLUDE; ranges;
//! GRDSET and BAROR defaults; replication with `=` and `*`. A deck may lack executive and case control. A record that
//! cannot be read is left out and gets a [`Diagnostic`] of severity error; the rest of the deck is returned. Callers
//! that compute with the deck pass the result through [`refuse_errors`] or use [`read_strict`].

mod assemble;
mod build;
mod card;
mod check;
mod constraints;
mod elements;
mod fields;
mod include;
mod lists;
mod merge;
mod points;
mod properties;
mod replicate;
mod sections;

use std::path::Path;

use crate::deck::Deck;
use crate::error::{Diagnostic, Error, refuse_errors};

pub use include::Included;

/// Reads a deck from memory. `name` stands for the file in diagnostics. An INCLUDE is an error here; see
/// [`parse_with`].
#[must_use]
pub fn parse(text: &[u8], name: &str) -> (Deck, Vec<Diagnostic>) {
    parse_with(text, name, |path, _| {
        Err(format!(
            "cannot be followed to {path:?}: the deck is read from memory; read it from its file"
        ))
    })
}

/// Reads a deck from memory, with `resolve(path, from)` to supply the text of the file `path` that the file `from`
/// includes, or the reason why it cannot.
pub fn parse_with(
    text: &[u8],
    name: &str,
    mut resolve: impl FnMut(&str, &str) -> Result<Included, String>,
) -> (Deck, Vec<Diagnostic>) {
    sections::DeckReader::new(name, &mut resolve).read(text)
}

/// Reads a deck from a file; INCLUDE paths are relative to the including file, then to the main file.
///
/// # Errors
/// [`Error::Io`] if the main file cannot be read; [`Error::WrongKind`] if it is binary. A missing included file is a
/// diagnostic.
pub fn read(path: impl AsRef<Path>) -> Result<(Deck, Vec<Diagnostic>), Error> {
    let path = path.as_ref();
    let text = std::fs::read(path).map_err(|source| Error::Io {
        path: path.to_owned(),
        source,
    })?;
    let name = path.display().to_string();
    if text.iter().take(4096).any(|&b| b == 0) {
        return Err(Error::WrongKind {
            file: name,
            found: "the file is binary (an op2 result, perhaps, or UTF-16 text)".into(),
            expected: "a Nastran input deck as plain text".into(),
        });
    }
    let main_folder = path.parent().map(Path::to_owned).unwrap_or_default();
    Ok(parse_with(&text, &name, |include, from| {
        include::from_disk(include, Path::new(from), &main_folder)
    }))
}

/// Reads a deck from a file for a computation: any diagnostic of severity error is refused. Returns the deck with
/// its notes and warnings.
///
/// # Errors
/// Those of [`read`], and [`Error::Deck`] with all diagnostics of severity error.
pub fn read_strict(path: impl AsRef<Path>) -> Result<(Deck, Vec<Diagnostic>), Error> {
    refuse_errors(read(path)?)
}
