//! Balancing, eigenproblems, splines, least squares, integration and special functions.
