//! Integration tests of the modal basis.

mod axes;
mod f25;
mod frames;
mod interpolation;
mod mass;
mod mean_axes;
mod samples;
mod selection;
mod support;
