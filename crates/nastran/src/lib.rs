//! Nastran decks (`.bdf`) and printed results of SOL 103 (`.f06`) as plain structs.
//!
//! # The problem
//! A structural model reaches flight dynamics as two texts: the deck, which says where the grids are, in which systems
//! they move and what masses they carry, and the printed modal analysis
//!
//! ```text
//! (K - lambda_i M) phi_i = 0,     phi_i^T M phi_i = m_i,     omega_i = sqrt(lambda_i)
//! ```
//!
//! with eigenvalues `lambda_i`, generalised masses `m_i`, eigenvectors `phi_i` by grid in each grid's own displacement
//! system (CD), and the rigid-body mass matrix. Both have grown since 1968, and every program prints its own dialect.
//! This crate reads them all into the same structs and does no physics with them.
//!
//! # In and out
//! - [`bdf`]: text or file to [`Deck`] and a list of [`Diagnostic`]s. One struct for each card that is understood;
//!   every other card is kept as it is.
//! - [`write`](mod@write): [`Deck`] to text; reading that text gives an equal deck.
//! - [`frames`]: coordinate systems in chains to the basic system, positions of grids, directions of their
//!   displacements.
//! - [`f06`]: text or file to [`ModalResults`]: eigenvalue tables, eigenvectors, grid point weight. MSC, NX, Simcenter,
//!   NASTRAN-95 and MYSTRAN.
//!
//! Values keep the units of the file; the project's files are in SI. Axes of a deck are usually x aft, y to the right
//! wing, z up, but nothing here depends on it.
//!
//! # From a deck and its results to mode shapes in the basic system
//! ```
//! use albatross_nastran::{bdf, f06, frames::Frames};
//!
//! # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like");
//! # let (deck_file, results_file) = (format!("{folder}/f25.bdf"), format!("{folder}/f25.f06"));
//! let (deck, _remarks) = bdf::read_strict(deck_file)?;
//! let results = f06::read(results_file)?;
//!
//! let weight = results.require_weight()?;
//! assert_eq!(weight.mass(), Some(81018.49));
//!
//! let frames = Frames::resolve(&deck)?;
//! let modes = results.eigenvectors_in_basic(&frames)?;
//! let first_elastic = results.eigenvalues[0].mode(7).ok_or("no mode 7")?;
//! assert_eq!(first_elastic.frequency_hz, 2.430880);
//! let tip = modes[6].grid(1025).ok_or("no grid 1025")?;
//! assert!(tip.translation().is_some_and(|t| t.z.abs() > 0.01));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Mistakes
//! A record that cannot be read is left out and becomes a [`Diagnostic`] with file, line, card, what was found, what was
//! expected and the cure; the rest of the file is returned. A caller that computes asks [`refuse_errors`] (or
//! [`bdf::read_strict`]) to turn diagnostics of severity error into an [`Error`]. What a whole file lacks is an
//! [`Error`] that names the output request to add. As printed:
//!
//! ```
//! use albatross_nastran::{bdf, refuse_errors};
//! let deck = b"GRID,1,,0.,0.,0.\nGRID,2,,1.O,0.,0.\nCONM2,7,3,,250.\n";
//! let refused = refuse_errors(bdf::parse(deck, "wing.bdf")).unwrap_err();
//! assert_eq!(
//!     refused.to_string(),
//!     r#"error: wing.bdf:2: GRID 2: field 4 (X1) is "1.O"; expected a real number such as 1.5, 1.5E-3 or 1.5-3
//! error: wing.bdf:3: CONM2 7: G is grid 3, which is not in the deck; add its GRID card or correct G"#
//! );
//! ```
//!
//! # Limits
//! - **Warning:** signs of eigenvectors and the basis of equal eigenvalues are arbitrary and differ between runs.
//! - Sort 2 output, complex modes and op2 files are not read.
//! - Superelement parts after BEGIN SUPER are read into the same deck, with a warning.
//! - Degrees of freedom that a program removes by itself (AUTOSPC) are not known from the text.
//!
//! # References
//! - MSC Nastran Quick Reference Guide: layout of cards and field formats.
//! - NASTRAN User's Manual, NASA SP-222(08), 1986: the same for NASTRAN-95.

// What is read comes from outside: nothing of it is indexed or cut by position.
#![warn(clippy::indexing_slicing, clippy::string_slice)]

pub mod bdf;
pub mod deck;
mod error;
pub mod f06;
pub mod frames;
mod lines;
pub mod number;
mod remarks;
mod results;
pub mod write;

pub use deck::Deck;
pub use error::{Diagnostic, Error, Severity, refuse_errors};
pub use results::{
    Dialect, EigenvalueTable, Eigenvector, EigenvectorRow, GridPointWeight, ModalResults, PointKind, RealMode,
};
