//! Tests on whole files: the fixtures, third-party samples, and pages written here after the formats' descriptions.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests"
)]

mod decks;
mod f06_fixtures;
mod round_trip;
