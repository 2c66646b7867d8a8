//! Numbers in messages.

use std::fmt;

/// A number in few letters, however large or small: as it is from 1e-6 to 1e9, else with an exponent.
///
/// ```
/// # use albatross_numerics::Figure;
/// assert_eq!(Figure(-0.5).to_string(), "-0.5");
/// assert_eq!(Figure(1e300).to_string(), "1e300");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure(
    /// The number, in the unit that the message names.
    pub f64,
);

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if self.0.is_finite() && size != 0.0 && !(1e-6..1e9).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}
