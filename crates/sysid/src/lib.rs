//! Identification of continuous-time transfer functions from time histories.

pub mod advice;
pub mod data;
mod error;
pub mod hold;
pub mod resample;
mod spectrum;
mod stillness;
pub mod table;
pub mod trim;

pub use advice::{Advice, AdviceKind, advise};
pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
pub use hold::detect_intersample;
pub use resample::decimate;
pub use spectrum::spectrum;
pub use table::{Columns, Table};
pub use trim::{Detrend, TrimBasis, TrimRemoved, remove_trim};
