//! Integration tests of the finite element solver.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod beams;
mod fixtures;
mod grillage;
mod grillage_deck;
mod joints;
mod properties;
mod reductions;
mod support;
