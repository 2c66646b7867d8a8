//! Integration tests of the modal basis.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "helpers of tests fail by panicking"
)]

mod axes;
mod comparison;
mod f25;
mod frames;
mod interpolation;
mod mass;
mod mean_axes;
mod samples;
mod selection;
mod support;
