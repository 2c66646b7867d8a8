//! Flight dynamics of flexible high-aspect-ratio aircraft: the facade and the case file.
//!
//! # The problem
//! A Nastran deck with its SOL 103 results, AVL geometry and output, perhaps lift slopes and derivatives of higher
//! fidelity: make of them one trimmed, coupled, non-linear model of the flexible aircraft, and answer what is asked of it.
//!
//! # The chain
//! [`Inputs::read`] reads a case file and all that it names. [`Model::build`] makes the model of one of its variants:
//! modal basis ([`modal`]), strips and their lift slopes ([`strip`]), derivatives about the centre of gravity and
//! the coupled aircraft ([`flight`]). [`analysis`] trims, linearises, lists modes, and simulates it. The stages are
//! crates of their own, re-exported here under their short names.
//!
//! # Inputs and outputs
//! | module | in | out |
//! |---|---|---|
//! | [`case`](mod@case) | a case file | [`Case`]: every key, checked |
//! | [`inputs`] | a case and the files that it names, or the solvers in their place ([`modes`], [`lattice`]) | [`Inputs`] |
//! | [`check`](mod@check) | a case file | what is missing, unusual or inconsistent, with place and cure |
//! | [`model`] | [`Inputs`] and a variant, through [`strips`] and [`controls`] | [`Model`] |
//! | [`analysis`] | a [`Model`] | trim, linear system, modes in the flow, frequency response, time histories |
//! | [`root_locus`] | a [`Model`] and speeds | eigenvalues over speed and the modes as branches |
//! | [`shapes`] | a [`Model`] | mode shapes of grids and strips, to draw |
//! | [`neutral`] | a wing or an aircraft as JSON from any other tool | its matrices, flutter, trims, responses |
//! | [`linear`] | a linear system or identified model as JSON | the same, checked |
//! | [`tables`], [`sources`] | lift slopes (CSV), derivatives (JSON); a case | their structs; the files that it reads |
//!
//! # Limits
//! Those of the stages: strip theory with incompressible lags, linear coefficients, small deformation. The case file
//! describes one flight point.
//!
//! # Example
//! The shipped F25-like surrogate (an invented aircraft), trimmed with AVL data:
//!
//! ```
//! use albatross::{Inputs, Model, analysis};
//! # let case = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/case.toml");
//! # /*
//! let case = "fixtures/f25-like/case.toml";
//! # */
//! let inputs = Inputs::read(case.as_ref())?;
//! let model = Model::build(&inputs, &inputs.case.variant(None)?)?;
//! let level = analysis::trimmed(&model)?;
//! assert_eq!(format!("{:.2}", level.trim.alpha_rad.to_degrees()), "1.33");
//! assert_eq!(level.system.states.len(), 444);
//! # Ok::<(), albatross::Error>(())
//! ```

// Modules that read do not index or cut by position; for the others see the invariants of docs/ARCHITECTURE.md.
pub mod analysis;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod case;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod check;
pub mod controls;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod inputs;
pub mod lattice;
pub mod linear;
mod mode_table;
pub mod model;
pub mod modes;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod neutral;
pub mod root_locus;
pub mod shapes;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod sources;
pub mod strips;
#[warn(clippy::indexing_slicing, clippy::string_slice)]
pub mod tables;

mod error;

pub use albatross_avl as avl;
pub use albatross_export as export;
pub use albatross_fem as fem;
pub use albatross_flight as flight;
pub use albatross_lti as lti;
pub use albatross_modal as modal;
pub use albatross_nastran as nastran;
pub use albatross_numerics as numerics;
pub use albatross_report as report;
pub use albatross_strip as strip;
pub use albatross_sysid as sysid;
pub use albatross_vlm as vlm;
pub use case::Case;
pub use error::Error;
pub use inputs::Inputs;
pub use model::Model;
