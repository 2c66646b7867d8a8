//! Closed forms, properties and published figures for linear systems.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod altered;
mod frequency;
mod lags;
mod models;
mod modes;
mod simulation;
mod state_space;
mod tracking;
mod zpk;
