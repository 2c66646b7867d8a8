//! Identification of continuous-time transfer functions from time histories.

pub mod data;
mod error;
pub mod fit;
pub mod peaks;

pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
pub use fit::{from_trim, nrmse_fit};
pub use peaks::{Peak, peaks};
