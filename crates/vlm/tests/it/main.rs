//! Integration tests of the vortex lattice.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]
#![allow(clippy::print_stdout, reason = "figures reached, shown with --nocapture")]

mod derivatives;
mod errors;
mod f25;
mod keywords;
mod models;
mod symmetry;
mod theory;
