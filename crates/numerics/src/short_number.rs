//! Numbers in messages.

use std::fmt;

/// A number in few letters, however large or small: as it is from 1e-6 to 1e9, else with an exponent.
///
/// ```
/// # use albatross_numerics::ShortNumber;
/// assert_eq!(ShortNumber(-0.5).to_string(), "-0.5");
/// assert_eq!(ShortNumber(1e300).to_string(), "1e300");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortNumber(
    /// The number, in the unit that the message names.
    pub f64,
);

impl fmt::Display for ShortNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if self.0.is_finite() && size != 0.0 && !(1e-6..1e9).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}
