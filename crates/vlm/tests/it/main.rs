//! Integration tests of the vortex lattice.

mod derivatives;
mod errors;
mod f25;
mod keywords;
mod models;
mod symmetry;
mod theory;
