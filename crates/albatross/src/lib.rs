//! Flight dynamics of flexible high-aspect-ratio aircraft: the facade and the case file.

pub mod neutral;

pub use albatross_avl as avl;
pub use albatross_flight as flight;
pub use albatross_lti as lti;
pub use albatross_modal as modal;
pub use albatross_nastran as nastran;
pub use albatross_numerics as numerics;
pub use albatross_report as report;
pub use albatross_strip as strip;
