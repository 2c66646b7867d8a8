//! Identification of continuous-time transfer functions from time histories.

pub mod data;
mod error;

pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
