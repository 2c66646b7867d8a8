//! Results in the formats of other programs.
//!
//! # The problem
//! A linear model goes into a control design in MATLAB, Octave or SciPy, a time history into a data frame, a mode shape
//! into a viewer. Each wants its own format, and all want names and units beside the numbers.
//!
//! # Inputs and outputs
//! In: results of the stages. Out: bytes or text, whole files that the caller writes; nothing here touches a file.
//!
//! | result | function | formats |
//! |---|---|---|
//! | [`StateSpace`](albatross_lti::StateSpace), with the trim it holds about | [`state_space`], [`state_space_table`] | [`mat`], [`npz`]; CSV |
//! | a channel's zeros, poles, gain and polynomials | [`Transfer`] | [`mat`], [`npz`]; JSON by serde |
//! | [`TimeHistory`](albatross_flight::TimeHistory) | [`history`] | [`mat`], [`npz`]; Parquet with the feature `parquet` |
//! | [`ModalBasis`](albatross_modal::ModalBasis), deck and strips | [`Mesh`] | [`vtu`] |
//!
//! Between a result and a binary format stands a [`Record`]: named numbers, matrices and texts. Doubles are written bit
//! by bit, and text with as many digits as bring the same double back: what is read is what was computed.
//!
//! # Limits
//! MAT-files are of level 5: 2 GiB a variable, names of at most 31 characters. Polynomials of transfer functions beyond
//! some ten poles lose digits, which [`Transfer::transfer_function_error`] tells; zeros, poles and gain do not.
//!
//! # Example
//! An oscillator for MATLAB, Octave and SciPy:
//!
//! ```
//! use albatross_export::{mat, npz, state_space};
//! use albatross_lti::{Signal, StateSpace};
//! use albatross_numerics::Mat;
//!
//! let a = Mat::from_fn(2, 2, |i, j| [[0.0, 1.0], [-100.0, -0.2]][i][j]);
//! let b = Mat::from_fn(2, 1, |i, _| i as f64);
//! let c = Mat::from_fn(1, 2, |_, j| [1.0, 0.0][j]);
//! let states = vec![Signal::new("bending", "m"), Signal::new("bending rate", "m/s")];
//! let (inputs, outputs) = (vec![Signal::new("force", "N/kg")], vec![Signal::new("tip", "m")]);
//! let system = StateSpace::try_new((a, b, c, Mat::zeros(1, 1)), states, inputs, outputs)?;
//! let record = state_space(&system, None)?;
//! let file = mat::write(&record)?; // sys = ss(A, B, C, D, 'StateName', StateName)
//! assert!(file.starts_with(b"MATLAB 5.0 MAT-file"));
//! let file = npz::write(&record)?; // numpy.load("model.npz")["A"]
//! assert!(file.starts_with(b"PK"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod history;
mod linear;
pub mod mat;
pub mod mesh;
pub mod npz;
#[cfg(feature = "parquet")]
pub mod parquet;
pub mod record;
mod transfer;
pub mod vtu;
mod zip;

pub use error::{Error, Result};
pub use history::history;
pub use linear::{OperatingPoint, state_space, table as state_space_table};
pub use mesh::Mesh;
pub use record::{Record, Value};
pub use transfer::Transfer;
