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
