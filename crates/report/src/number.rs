//! How a number is shown to a reader.
//!
//! A [`Format`] rounds once, from the exact binary value, so that the shown digits are the correctly rounded
//! ones; a value that rounds to zero loses its sign. Numbers keep the ASCII hyphen as minus sign: they may be
//! copied from a table into a program. (Plots use the typographic minus.)

/// Rule by which a number becomes text in a Markdown or terminal table.
///
/// CSV and JSON do not use it: they carry every digit.
///
/// ```
/// use albatross_report::Format;
/// assert_eq!(Format::Fixed(2).show(1.327), "1.33");
/// assert_eq!(Format::Significant(3).show(81018.49), "81000");
/// assert_eq!(Format::Scientific(2).show(-0.000_123_4), "-1.23e-4");
/// assert_eq!(Format::Engineering(3).show(12_340.0), "12.3e3");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Given number of decimals: 1.327 with 2 decimals is `1.33`.
    Fixed(u8),
    /// Given number of significant digits, plain between 1e-4 and 1e6 and scientific outside.
    Significant(u8),
    /// Mantissa with the given number of decimals and a power of ten: `1.23e-4`.
    Scientific(u8),
    /// Given number of significant digits and a power of ten that is a multiple of three: `12.3e3`.
    Engineering(u8),
    /// The shortest text that reads back to the same number.
    Exact,
}

/// A double has at most 17 significant decimal digits that mean anything.
const MOST_DIGITS: u8 = 17;

impl Format {
    /// The number as text. `NaN`, `∞` and `-∞` stand for values that are not numbers.
    pub fn show(self, value: f64) -> String {
        if value.is_nan() {
            return "NaN".to_owned();
        }
        if value.is_infinite() {
            return if value > 0.0 { "∞" } else { "-∞" }.to_owned();
        }
        match self {
            Self::Fixed(decimals) => {
                unsigned_zero(format!("{value:.*}", usize::from(decimals.min(MOST_DIGITS))))
            }
            Self::Significant(digits) => {
                let rounded = Rounded::new(value, digits);
                if (-4..6.max(rounded.count())).contains(&rounded.exponent) {
                    rounded.with_point_after(rounded.exponent)
                } else {
                    format!("{}e{}", rounded.with_point_after(0), rounded.exponent)
                }
            }
            Self::Scientific(decimals) => {
                let rounded = Rounded::new(value, decimals.saturating_add(1));
                format!("{}e{}", rounded.with_point_after(0), rounded.exponent)
            }
            Self::Engineering(digits) => {
                let rounded = Rounded::new(value, digits);
                let exponent = 3 * rounded.exponent.div_euclid(3);
                let mantissa = rounded.with_point_after(rounded.exponent - exponent);
                if exponent == 0 {
                    mantissa
                } else {
                    format!("{mantissa}e{exponent}")
                }
            }
            Self::Exact => unsigned_zero(shortest(value)),
        }
    }
}

/// The shortest text that reads back to the same finite number, with an exponent where that is shorter.
pub(crate) fn shortest(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// `-0.00` is an artefact of rounding, not a sign.
fn unsigned_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        _ => text,
    }
}

/// A finite number rounded to some significant digits: `±d.ddd · 10^exponent`.
struct Rounded {
    negative: bool,
    digits: String,
    exponent: i32,
}

impl Rounded {
    fn new(value: f64, digits: u8) -> Self {
        let decimals = usize::from(digits.clamp(1, MOST_DIGITS)) - 1;
        let text = format!("{:.decimals$e}", value.abs());
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        Self {
            negative: value < 0.0,
            digits: mantissa.chars().filter(char::is_ascii_digit).collect(),
            exponent: exponent.parse().unwrap_or(0),
        }
    }

    fn count(&self) -> i32 {
        i32::try_from(self.digits.len()).unwrap_or(i32::from(MOST_DIGITS))
    }

    /// Digits with the decimal point placed after the digit that stands for `10^place` of the leading one.
    fn with_point_after(&self, place: i32) -> String {
        let sign = if self.negative { "-" } else { "" };
        let zeros = |n: i32| "0".repeat(usize::try_from(n).unwrap_or(0));
        if place < 0 {
            return format!("{sign}0.{}{}", zeros(-place - 1), self.digits);
        }
        let whole = usize::try_from(place).unwrap_or(0) + 1;
        match self.digits.split_at_checked(whole) {
            Some((whole, "")) => format!("{sign}{whole}"),
            Some((whole, fraction)) => format!("{sign}{whole}.{fraction}"),
            None => format!("{sign}{}{}", self.digits, zeros(place + 1 - self.count())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rounding_carries_into_the_next_decade() {
        assert_eq!(Format::Significant(3).show(999.6), "1000");
        assert_eq!(Format::Significant(3).show(0.099_96), "0.100");
        assert_eq!(Format::Engineering(3).show(999_960.0), "1.00e6");
        assert_eq!(Format::Scientific(1).show(9.96), "1.0e1");
    }

    #[test]
    fn small_and_large_numbers_change_to_scientific_form() {
        assert_eq!(Format::Significant(4).show(0.000_123_45), "0.0001234");
        assert_eq!(Format::Significant(4).show(0.000_012_345), "1.234e-5");
        assert_eq!(Format::Significant(2).show(123_456.0), "120000");
        assert_eq!(Format::Significant(2).show(1_234_567.0), "1.2e6");
        assert_eq!(Format::Significant(9).show(123_456_789.0), "123456789");
    }

    #[test]
    fn engineering_exponents_are_multiples_of_three() {
        assert_eq!(Format::Engineering(3).show(0.012_34), "12.3e-3");
        assert_eq!(Format::Engineering(2).show(123.0), "120");
        assert_eq!(Format::Engineering(4).show(-1.5), "-1.500");
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(Format::Fixed(2).show(-0.001), "0.00");
        assert_eq!(Format::Exact.show(-0.0), "0");
        assert_eq!(Format::Significant(3).show(-0.0), "0.00");
    }

    #[test]
    fn values_that_are_not_numbers_are_named() {
        for format in [
            Format::Fixed(2),
            Format::Significant(3),
            Format::Scientific(3),
            Format::Exact,
        ] {
            assert_eq!(format.show(f64::NAN), "NaN");
            assert_eq!(format.show(f64::INFINITY), "∞");
            assert_eq!(format.show(f64::NEG_INFINITY), "-∞");
        }
    }

    proptest! {
        #[test]
        fn prop_fixed_reads_back_within_half_a_unit_of_the_last_place(v in -1e9..1e9f64, d in 0u8..10) {
            let back: f64 = Format::Fixed(d).show(v).parse().unwrap();
            let half = 0.5 * 10f64.powi(-i32::from(d));
            prop_assert!((back - v).abs() <= half + 4.0 * f64::EPSILON * v.abs());
        }

        #[test]
        fn prop_significant_forms_read_back_within_half_a_unit(
            mantissa in 1.0..10.0f64, exponent in -280i32..280, negative: bool, d in 1u8..17,
        ) {
            let v = mantissa * 10f64.powi(exponent) * if negative { -1.0 } else { 1.0 };
            for format in [Format::Significant(d), Format::Engineering(d), Format::Scientific(d - 1)] {
                let back: f64 = format.show(v).parse().unwrap();
                // Half a unit of the d-th digit is at most 0.5·10^(1-d) of the value.
                let most = v.abs() * (0.5 * 10f64.powi(1 - i32::from(d)) + 4.0 * f64::EPSILON);
                prop_assert!((back - v).abs() <= most, "{} -> {}", v, format.show(v));
            }
        }

        #[test]
        fn prop_exact_reads_back_to_the_same_number(v in proptest::num::f64::NORMAL) {
            prop_assert_eq!(Format::Exact.show(v).parse::<f64>().unwrap(), v);
        }
    }
}
