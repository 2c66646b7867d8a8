//! Tests of the estimation as a whole.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod order20;
mod rao_garnier;
mod real_data;
mod systems;
