//! Properties of the dense methods on random problems.

#![allow(clippy::unwrap_used, reason = "a test stops where it fails")]

mod algebra;
mod tables;
