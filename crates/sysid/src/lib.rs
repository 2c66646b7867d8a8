//! Identification of continuous-time transfer functions from time histories.

pub mod assignment;
pub mod bode_distance;
pub mod criteria;
pub mod data;
mod error;
pub mod fit;
mod fourier;
pub mod matching;
pub mod peaks;
pub mod residuals;
pub mod response_peaks;

pub use bode_distance::{Band, BodeDistance, bode_distance, energy_spectrum, state_space_distance};
pub use criteria::{Criteria, criteria};
pub use data::{DataSet, Experiment, Intersample};
pub use error::{Error, Result};
pub use fit::{from_trim, nrmse_fit};
pub use matching::{MatchOptions, PoleMatching, match_poles};
pub use peaks::{Peak, peaks};
pub use residuals::{ResidualCheck, ResidualOptions, check_residual, check_residuals};
pub use response_peaks::{ResponsePeak, ResponsePeakMatching, match_response_peaks, response_peaks};
