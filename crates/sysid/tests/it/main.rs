//! Tests of the estimation as a whole.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test stops where it fails, and says what it skips"
)]

mod kinds;
mod order20;
mod rao_garnier;
mod real_data;
mod refusals;
mod systems;
