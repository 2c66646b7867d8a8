//! Integration tests of the vortex lattice.
mod f25;
