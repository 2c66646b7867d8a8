//! Integration tests of the flight mechanics.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod conservation;
mod elastic;
mod engines;
mod extremes;
mod integration;
mod lag_form;
mod linearization;
mod refusals;
mod rigid_modes;
mod sensors;
mod test_models;
mod trim;
