//! Nastran decks (.bdf) and SOL 103 results (.f06) as plain structs.

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
