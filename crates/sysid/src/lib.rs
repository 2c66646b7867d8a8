//! Identification of continuous-time transfer functions from time histories.

pub mod arx;
mod blocks;
pub mod convert;
pub mod data;
mod decimate;
pub mod discrete;
mod elimination;
mod error;
pub mod estimate;
mod filters;
mod fit;
pub mod iv4;
mod logarithm;
mod model;
mod numerator;
mod problem;
mod refine;
mod relocate;
mod score;
mod spectrum;
mod start;
pub mod subspace;
mod triangle;
mod uncertainty;

pub use blocks::Block;
pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
pub use estimate::{
    Delay, Estimate, InitialCondition, Initialisation, Options, StartReport, Weights, estimate,
};
pub use fit::nrmse_fit;
pub use model::Model;
pub use refine::{Iteration, SearchMethod, Stop};
pub use score::{InitialState, Simulated, simulate_records};
pub use uncertainty::{Band, PoleEstimate, Residue, Uncertainty};
