//! What can go wrong between the case file and the results.

use crate::check::nearest;

/// Errors of a case.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The case file cannot be used.
    #[error("{}: {message}; {cure}", place(file, *line))]
    Case {
        /// File.
        file: String,
        /// Line from 1, or 0 if the whole file is concerned.
        line: usize,
        /// What was found.
        message: String,
        /// How to mend it.
        cure: String,
    },
    /// A name that is not there.
    #[error("no {kind} `{name}`; there is: {known}{}", meant(name, known))]
    UnknownName {
        /// What sort of thing.
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// Two inputs do not fit together.
    #[error("{what}: found {found}, expected {expected}")]
    Mismatch {
        /// What was compared.
        what: String,
        /// What was found.
        found: String,
        /// What was expected, and the cure.
        expected: String,
    },
    /// A file cannot be read.
    #[error("{file}: {source}; check the path, which is relative to the case file")]
    Read {
        /// File.
        file: String,
        /// Cause.
        source: std::io::Error,
    },
    /// A table or JSON file is malformed.
    #[error("{}: {message}; expected {expected}", place(file, *line))]
    Table {
        /// File.
        file: String,
        /// Line from 1, or 0.
        line: usize,
        /// What was found.
        message: String,
        /// What was expected.
        expected: String,
    },
    /// From the Nastran reader.
    #[error(transparent)]
    Nastran(#[from] albatross_nastran::Error),
    /// From the AVL reader.
    #[error(transparent)]
    Avl(#[from] albatross_avl::AvlError),
    /// From the finite elements.
    #[error(transparent)]
    Fem(#[from] albatross_fem::Error),
    /// From the vortex lattice.
    #[error("{file}: {source}")]
    Lattice {
        /// Geometry file.
        file: String,
        /// Cause.
        source: Box<albatross_vlm::Error>,
    },
    /// From the modal basis.
    #[error(transparent)]
    Modal(#[from] albatross_modal::Error),
    /// From the strips.
    #[error(transparent)]
    Strip(#[from] albatross_strip::Error),
    /// From the flight mechanics.
    #[error(transparent)]
    Flight(#[from] albatross_flight::Error),
    /// From linear systems.
    #[error(transparent)]
    Lti(#[from] albatross_lti::Error),
    /// From the algebra.
    #[error(transparent)]
    Numerics(#[from] albatross_numerics::Error),
}

/// The name that may be meant, as the end of a cure.
fn meant(name: &str, known: &str) -> String {
    let name = name.split('`').next().unwrap_or(name);
    match nearest(name, known.split(", ")) {
        Some(meant) => format!("; did you mean `{meant}`?"),
        None => String::new(),
    }
}

fn place(file: &str, line: usize) -> String {
    if line == 0 {
        file.to_owned()
    } else {
        format!("{file}:{line}")
    }
}
