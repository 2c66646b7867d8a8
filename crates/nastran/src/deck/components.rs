//! Sets of the six components of motion, as the cards write them: `123456`.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A set of components 1 to 6: translations 1 to 3 along, and rotations 4 to 6 about, the axes of the point's CD
/// system. Empty stands for a scalar point (`0` or blank on the card).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub struct Components(u8);

impl Components {
    /// No component.
    pub const NONE: Self = Self(0);
    /// All six.
    pub const ALL: Self = Self(0b11_1111);
    /// The three translations.
    pub const TRANSLATIONS: Self = Self(0b00_0111);

    /// From the card's digits, in any order: `b"1235"`; blank or `0` is empty. `None` for anything else.
    #[must_use]
    pub fn parse(digits: &[u8]) -> Option<Self> {
        let digits = digits.trim_ascii();
        if digits == b"0" {
            return Some(Self::NONE);
        }
        digits.iter().try_fold(Self::NONE, |set, digit| match digit {
            b'1'..=b'6' => Some(Self(set.0 | 1 << (digit - b'1'))),
            _ => None,
        })
    }

    /// From the lowest six bits: bit 0 is component 1. Higher bits are dropped.
    #[must_use]
    pub fn from_bits(bits: u8) -> Self {
        Self(bits & Self::ALL.0)
    }

    /// Whether `component` (1 to 6) is in the set.
    #[must_use]
    pub fn contains(self, component: u8) -> bool {
        (1..=6).contains(&component) && self.0 & (1 << (component - 1)) != 0
    }

    /// Whether the set is empty.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The components in ascending order, 1 to 6.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        (1..=6).filter(move |&c| self.contains(c))
    }
}

impl fmt::Display for Components {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("0");
        }
        self.iter().try_for_each(|c| write!(f, "{c}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_in_any_order_and_back() {
        assert_eq!(
            Components::parse(b"531").map(|c| c.to_string()).as_deref(),
            Some("135")
        );
        assert_eq!(Components::parse(b" 0 "), Some(Components::NONE));
        assert_eq!(Components::parse(b""), Some(Components::NONE));
        assert_eq!(Components::parse(b"123456"), Some(Components::ALL));
        assert_eq!(Components::parse(b"127"), None);
        assert_eq!(Components::parse(b"1.3"), None);
    }
}
