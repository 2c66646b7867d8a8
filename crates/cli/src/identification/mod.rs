//! Identification of transfer functions from records: `identify`, `identify search`, `compare`, `residuals`.

pub(crate) mod args;
mod compare;
mod figures;
mod files;
mod identify;
mod json;
mod records;
mod residuals;
mod search;
mod system;
mod tables;

pub(crate) use compare::compare;
pub(crate) use identify::identify;
pub(crate) use residuals::residuals;
