//! Flight dynamics of flexible high-aspect-ratio aircraft: the facade and the case file.

pub mod analysis;
pub mod case;
pub mod compare;
pub mod controls;
pub mod inputs;
pub mod model;
pub mod neutral;
pub mod strips;
pub mod tables;

mod error;

pub use albatross_avl as avl;
pub use albatross_flight as flight;
pub use albatross_lti as lti;
pub use albatross_modal as modal;
pub use albatross_nastran as nastran;
pub use albatross_numerics as numerics;
pub use albatross_report as report;
pub use albatross_strip as strip;
pub use case::Case;
pub use error::Error;
pub use inputs::Inputs;
pub use model::Model;
