//! Integration tests of tables and plots.
// Helpers outside `#[test]` functions fail the test by panicking, too.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod plots;
mod svg_check;
mod tables;
