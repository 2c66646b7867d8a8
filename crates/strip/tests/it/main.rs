//! Published figures, closed forms, properties and hostile input.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]
#![allow(clippy::print_stdout, reason = "figures reached, shown with --nocapture")]

mod extremes;
mod goland;
mod hostile;
mod models;
mod neutral;
mod properties;
mod sweep;
