//! Bytes read back by readers of the tests' own, written from the formats' descriptions; `crates/cli/tests/it/export.rs`
//! gives them to SciPy, NumPy, Octave, VTK and Arrow where these are installed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops where it fails")]

mod linear;
mod mat;
mod meshes;
mod npz;
#[cfg(feature = "parquet")]
mod parquet;
mod support;
mod transfer;
