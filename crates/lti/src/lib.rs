//! Linear time-invariant systems with named signals.
//!
//! # The problem
//! Linearised about a trimmed flight, the flexible aircraft is
//! ```text
//! x' = A x + B u        x: rigid-body, modal and lag states
//! y  = C x + D u        y: accelerations, rates, load factors at sensors
//! ```
//! and the questions asked of it are: which modes has it ([`mode_table`]), what became of a mode when speed
//! or mass changed ([`Tracker`]), how does it answer a sinusoid ([`frequency_response`]) or a manoeuvre
//! ([`simulate`]), and which low-order transfer function has the same poles and zeros ([`Zpk`]).
//!
//! # Inputs and outputs
//! | module | in | out |
//! |---|---|---|
//! | [`state_space`] | matrices and names | [`StateSpace`]: selection and connection by name |
//! | [`modes`] | a system | [`Mode`]: frequency, damping, participating states |
//! | [`track`](mod@track) | a family of matrices | eigenvalues in the order of the modes chosen at its start |
//! | [`lags`] | a matrix with lag states | single eigenvalues by their elimination, followed along a path |
//! | [`frequency`] | a system, frequencies in rad/s | [`Response`]: magnitude and unwrapped phase |
//! | [`simulation`] | a system, sampled or continuous inputs | [`History`] of states and outputs |
//! | [`exponential`](mod@exponential) | a matrix | its exponential |
//! | [`stride`] | a system, sampled inputs | outputs alone, many steps at a time |
//! | [`zpk`], [`polynomial`] | a channel | zeros, poles and gain; transfer function; state space again |
//!
//! Units are SI: time in s, frequencies in rad/s, and outputs per input in the units of the signals. All
//! results are independent of the units chosen for the states, because every eigenproblem and resolvent is
//! balanced first.
//!
//! # Limits
//! Coalescing eigenvalues have ill-conditioned vectors; tracking through them is reported with
//! a confidence and refused rather than guessed ([`Error::Unresolved`]). Transfer-function coefficients of
//! systems beyond about ten states lose digits; zeros, poles and gain do not.
//!
//! # Example
//! A wing bending mode at 2.5 Hz with 1 % damping, driven by a force:
//! ```
//! use albatross_lti::{Signal, StateSpace, frequency_response, mode_table};
//! use albatross_numerics::Mat;
//!
//! let omega = 2.5 * std::f64::consts::TAU;
//! let a = Mat::from_fn(2, 2, |i, j| [[0.0, 1.0], [-omega * omega, -2.0 * 0.01 * omega]][i][j]);
//! let b = Mat::from_fn(2, 1, |i, _| [0.0, 1.0][i]);
//! let c = Mat::from_fn(1, 2, |_, j| [omega * omega, 0.0][j]);
//! let states = vec![Signal::new("bending", "m"), Signal::new("bending rate", "m/s")];
//! let (inputs, outputs) = (vec![Signal::new("force", "N/kg")], vec![Signal::new("tip", "m")]);
//! let system = StateSpace::try_new((a, b, c, Mat::zeros(1, 1)), states, inputs, outputs)?;
//! let mode = &mode_table(&system)?[0];
//! assert!((mode.frequency_hz - 2.5).abs() < 1e-12 && (mode.damping_ratio - 0.01).abs() < 1e-14);
//!
//! let tip = frequency_response(&system, &[0.0, omega])?.get("tip", "force")?;
//! assert!((tip.magnitude()[1] - 50.0).abs() < 1e-9); // 1/(2 zeta) at resonance
//! assert!((tip.phase_deg()[1] + 90.0).abs() < 1e-9);
//! # Ok::<(), albatross_lti::Error>(())
//! ```

mod error;
pub mod exponential;
pub mod frequency;
pub mod lags;
pub mod modes;
pub mod polynomial;
mod realisation;
mod reduced;
pub mod simulation;
pub mod state_space;
pub mod stride;
pub mod track;
mod zeros;
pub mod zpk;

pub use error::{Error, Result, SignalKind};
pub use frequency::{Channel, FrequencySolver, Method, Response, frequency_response};
pub use lags::{LagForm, Root};
pub use modes::{Mode, Participation, mode_table, mode_table_of};
pub use polynomial::TransferFunction;
pub use simulation::{History, Hold, simulate, simulate_rk4};
pub use state_space::{Signal, StateSpace};
pub use stride::OutputSimulator;
pub use track::{Followed, TrackOptions, TrackedMode, Tracker, modes_carried_by, track};
pub use zpk::Zpk;
