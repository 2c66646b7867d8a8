//! Identification of continuous-time transfer functions from time histories.
//!
//! # The problem
//! A surface was deflected, an acceleration or a rate was recorded, once or several times. Which transfer function
//! ```text
//! G(s) = K (s - z_1) .. (s - z_nz) / ((s - p_1) .. (s - p_np)),        y = G u + e
//! ```
//! reproduces the records, which of its poles can be trusted, and how many does the record hold? The answer minimises
//! the output error over all experiments e and outputs o,
//! ```text
//! V = sum over e, o of w_eo |y_eo - yhat_eo|^2
//! ```
//! with exact sensitivities. At order 20 polynomials in s span thirty decades, so the model is a sum of real first- and
//! second-order fractions ([`Block`], [`Model`]) throughout; zeros, gain and polynomials are printed, never computed with.
//! The crate knows no aircraft: signals in, model out.
//!
//! # The way
//! | step | module | in, out |
//! |---|---|---|
//! | read | [`table`], [`data`] | text of a table; a record with names and units, a [`DataSet`] of several |
//! | prepare | [`trim`], [`hold`], [`mod@decimate`], [`advice`] | a record; deviations from trim, behaviour between samples, what the data can show |
//! | estimate | [`mod@estimate`], [`refine`] | a [`DataSet`] and [`Options`]; an [`Estimate`] with its [`model`] |
//! | judge | [`score`], [`uncertainty`], [`residuals`], [`mod@criteria`] | fits, standard deviations, whiteness, information criteria |
//! | choose the order | [`mod@search`] | a range of orders; scores on records not seen |
//! | compare | [`matching`], [`mod@bode_distance`], [`mod@response_peaks`], [`fit`], [`mod@peaks`] | poles, responses and histories beside others |
//! | discrete time | [`discrete`], [`arx`], [`iv4`], [`convert`], [`subspace`] | ARX, instrumental variables, conversions, N4SID and MOESP |
//!
//! An estimation begins with poles spread over a band, several bands of them; relocates them by instrumental variables in
//! the basis of the poles; searches the minimum by variable projection, with the directions of `tfest` tried in turn; and
//! tries the weakest poles elsewhere, since a weak mode beside strong ones is easily missed. Several experiments, outputs
//! with common poles, unknown initial states, constants and a delay are part of every step.
//!
//! # Limits
//! One input. Outputs estimated together share their poles. White output noise is what makes the estimate the most likely
//! one; standard deviations for coloured residuals are given beside. Poles far below the inverse of the record's length
//! stand for drift, poles near the Nyquist frequency for the hold. Doublets have nulls in their spectrum, and what they do
//! not excite cannot be identified: [`advise`] says where. The output error has local minima; [`Options::starts`] and
//! [`Options::reallocations`] say how hard they are fought, and nothing proves that the minimum found is the least.
//!
//! # Example
//! Two modes from samples `u` and `y` of a doublet, with noise of one percent (their making is not shown):
//! ```
//! # use albatross_numerics::C64;
//! # use albatross_sysid::{Block, Model};
//! use albatross_lti::Signal;
//! use albatross_sysid::{DataSet, Experiment, Intersample, Options, estimate};
//!
//! # let truth = Model {
//! #     input: Signal::new("elevator", "deg"),
//! #     outputs: vec![Signal::new("q", "deg/s")],
//! #     blocks: Block::from_poles(&[C64::new(-0.6, 1.6), C64::new(-0.5, 18.7)]),
//! #     coefficients: vec![vec![1.0, 0.4, -0.2, 0.1]],
//! #     direct: vec![0.0],
//! #     zeros: 3,
//! #     delay: 0.0,
//! # };
//! # let u: Vec<f64> = (0..1000).map(|k| f64::from((k / 50 == 1) as i8 - (k / 50 == 2) as i8)).collect();
//! # let mut random = fastrand::Rng::with_seed(1);
//! # let mut y = truth.simulate(&u, 0.01, Intersample::Zoh)?.remove(0);
//! # y.iter_mut().for_each(|y| *y += 0.01 * (random.f64() - 0.5));
//! let record = Experiment::new("doublet", 0.01, u, vec![y]);
//! let (input, outputs) = (Signal::new("elevator", "deg"), vec![Signal::new("q", "deg/s")]);
//! let data = DataSet::try_new(input, outputs, vec![record], Intersample::Zoh)?;
//! let found = estimate(&data, &Options::new(4, 3))?; // four poles, three zeros
//! for mode in &found.uncertainty.as_ref().ok_or("too few samples")?.modes {
//!     println!("{:.3} +- {:.3} rad/s", mode.frequency_rad_s, mode.sd_frequency_rad_s);
//! }
//! assert!((found.model.poles()[3].norm() - 18.7).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Sources
//! Ljung, System Identification, 2nd ed. 1999; Young, Recursive Estimation and Time-Series Analysis, 2nd ed. 2011; Garnier
//! and Wang (eds.), Identification of Continuous-time Models from Sampled Data, 2008; Gustavsen and Semlyen, IEEE Trans.
//! Power Delivery 14, 1999; Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973.

pub mod advice;
pub mod arx;
pub mod assignment;
mod blocks;
pub mod bode_distance;
pub mod convert;
pub mod criteria;
pub mod data;
pub mod decimate;
pub mod discrete;
mod elimination;
mod error;
pub mod estimate;
mod filters;
pub mod fit;
mod fourier;
pub mod hold;
pub mod iv4;
mod lanes;
mod logarithm;
pub mod matching;
pub mod model;
mod numerator;
pub mod peaks;
mod problem;
mod reallocate;
pub mod refine;
mod relocate;
pub mod residuals;
pub mod response_peaks;
pub mod score;
pub mod search;
mod spectrum;
mod start;
mod stillness;
pub mod subspace;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod table;
mod thinning;
mod triangle;
pub mod trim;
pub mod uncertainty;

pub use advice::{Advice, AdviceKind, advise};
pub use blocks::Block;
pub use bode_distance::{Band, BodeDistance, bode_distance, energy_spectrum, state_space_distance};
pub use criteria::{Criteria, criteria};
pub use data::{DataSet, Experiment, Intersample};
pub use decimate::decimate;
pub use error::{Error, Result};
pub use estimate::{Delay, Estimate, InitialCondition, Initialisation, Options, Weights, estimate};
pub use fit::{from_trim, nrmse_fit};
pub use hold::detect_intersample;
pub use matching::{MatchOptions, PoleMatching, match_poles};
pub use model::Model;
pub use peaks::{Peak, peaks};
pub use refine::{Iteration, SearchMethod, Stop};
pub use residuals::{ResidualCheck, ResidualOptions, check_residual, check_residuals};
pub use response_peaks::{ResponsePeak, ResponsePeakMatching, match_response_peaks, response_peaks};
pub use score::{InitialState, Simulated, simulate_records};
pub use search::{Candidate, OrderSearch, SearchOptions, Training, search};
pub use spectrum::spectrum;
pub use table::{Columns, Table};
pub use trim::{Detrend, TrimBasis, TrimRemoved, remove_trim};
pub use uncertainty::{ConfidenceBand, PoleEstimate, Residue, Uncertainty};
