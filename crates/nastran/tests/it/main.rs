//! Tests on whole files: the fixtures, third-party samples, and pages written here after the formats' descriptions.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::panic,
    reason = "helpers of tests"
)]

mod any_deck;
mod damage;
mod deck_grammar;
mod decks;
mod f06_fixtures;
mod f06_pages;
mod frames;
mod numbers;
mod round_trip;
mod third_party;
