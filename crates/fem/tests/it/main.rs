//! Integration tests of the finite element solver.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod altered;
mod beams;
mod fixtures;
mod grillage;
mod grillage_deck;
mod joints;
mod properties;
mod reductions;
mod support;
