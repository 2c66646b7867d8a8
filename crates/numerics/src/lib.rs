//! Dense numerical methods for flight dynamics and aeroelasticity.
//!
//! # The problem
//! Linearised aeroelastic models have a few hundred states whose units differ by many orders of
//! magnitude: radians beside metres of altitude, modal amplitudes beside lag velocities. Their
//! eigenvalues, responses and time histories must not depend on that choice of units. This crate is a
//! thin layer over [`faer`] (dense decompositions) and [`nalgebra`] (frames, rotations) that adds what
//! they leave out and this field needs.
//!
//! # Inputs and outputs
//! | module | what it solves |
//! |---|---|
//! | [`eigen`] | A v = lambda v, always balanced; A v = lambda B v; K phi = lambda M phi |
//! | [`solve`] | A x = b with equilibration and a condition estimate; min over x of the norm of A x - b |
//! | [`interp`] | linear, PCHIP, not-a-knot cubic and Akima interpolation on strictly increasing points |
//! | [`integrate`] | fixed-step RK4, and ETDRK4 with the diagonal part of the equation solved exactly |
//! | [`special`] | Bessel functions of real argument, K0 and K1 of complex argument |
//! | [`ShortNumber`] | a number in a message, in few letters |
//! | [`matrix`] | row-major matrices with fast products on slices, conversions, checks |
//!
//! Everything is deterministic and runs on the calling thread. Inputs that are not finite, have the wrong
//! shape, or make the problem singular are errors ([`Error`]) that carry the numbers needed to act.
//!
//! # Limits
//! Matrices are dense and of moderate order (up to about a thousand). Defective eigenvalues
//! (the chains of rigid-body integrators) are returned to the accuracy that their condition allows, which is
//! a root of the rounding unit.
//!
//! # Example
//! An oscillator with natural frequency 10 rad/s and damping ratio 0.02 in badly chosen units:
//! ```
//! use albatross_numerics::{Mat, eigen};
//!
//! let unit = 1e6; // the second state is counted in millionths
//! let a = Mat::from_fn(2, 2, |i, j| [[0.0, 1.0 / unit], [-100.0 * unit, -0.4]][i][j]);
//! let values = eigen::eigenvalues(a.as_ref())?;
//! assert!((values[1].norm() - 10.0).abs() < 1e-12);
//! assert!((-values[1].re / values[1].norm() - 0.02).abs() < 1e-14);
//! # Ok::<(), albatross_numerics::Error>(())
//! ```

pub mod eigen;
mod error;

pub mod integrate;
pub mod interp;
mod kernel;
pub mod matrix;
mod short_number;
pub mod solve;
pub mod special;

pub use error::{Error, Result};
pub use faer;
pub use faer::{Mat, MatRef};
pub use nalgebra;
pub use short_number::ShortNumber;

/// Complex number in double precision, the element type of every complex matrix here.
pub type C64 = num_complex::Complex<f64>;
