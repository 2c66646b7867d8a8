//! Identification of continuous-time transfer functions from time histories.

pub mod arx;
pub mod convert;
pub mod data;
mod decimate;
pub mod discrete;
mod error;
pub mod iv4;
mod logarithm;
pub mod subspace;
mod triangle;

pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
mod blocks;
mod elimination;
mod filters;
pub use blocks::Block;
mod model;
mod numerator;
mod problem;
mod refine;
mod relocate;
pub use model::Model;
pub use refine::{Iteration, SearchMethod, Stop};
