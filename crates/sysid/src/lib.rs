//! Identification of continuous-time transfer functions from time histories.

pub mod data;
mod error;

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
