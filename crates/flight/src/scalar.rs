//! The number type of the equations of motion: `f64` to simulate, dual numbers to differentiate exactly.

use num_dual::DualNum;

/// A number on which the equations of motion are evaluated: `f64` or a dual number over it.
pub trait Scalar: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Scalar for T {}
