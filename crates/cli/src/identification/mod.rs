//! Identification of transfer functions from records: `identify`, `identify search`, `compare`, `residuals`.

pub(crate) mod args;
mod identify;
mod json;
mod records;
mod search;
mod tables;

pub(crate) use identify::identify;
