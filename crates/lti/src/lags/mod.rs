//! Eigenvalues of interest of a system most of whose states are lags.
//!
//! The lags of unsteady strip aerodynamics are nine tenths of the states of a flexible aircraft, and do not act on each
//! other. Without them, s is an eigenvalue where the matrix of the order of the core,
//! ```text
//! T(s) = s - Axx - Axz (s - l)^-1 Azx,
//! ```
//! is singular: a non-linear eigenproblem whose vectors are the core's part of those of the whole matrix. A root with its
//! vectors costs one or two factorisations of that order ([`LagForm::root`]), where all eigenvalues of the whole cost some
//! twenty-five times the cube of its order. [`follow`] carries roots along a path of matrices by the overlaps that
//! [`track`](mod@crate::track) uses, step for step, so both give the same labels; it does not book pairs that split and real
//! roots that merge, and refuses there.

mod follow;
mod form;
mod root;

pub use follow::{FollowedRoots, follow};
pub use form::LagForm;
pub use root::{Effort, Root};
