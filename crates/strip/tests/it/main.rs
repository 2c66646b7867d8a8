//! Published figures, closed forms, properties and hostile input.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod goland;
mod models;
mod neutral;
