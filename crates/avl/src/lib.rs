//! AVL geometry, mass, run-case and output files as plain structs.

mod error;
mod fortran;
mod source;

pub mod geometry;
pub mod mass;
pub mod results;
pub mod run;

pub use error::{AvlError, Diagnostic, Location};
pub use source::read_text;
