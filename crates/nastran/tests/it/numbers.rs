//! Numbers against the standard library's parser.

use albatross_nastran::number;
use proptest::prelude::*;

proptest! {
    /// Every way to write a number, bit for bit.
    #[test]
    fn prop_reals_are_those_of_the_standard_library(
        sign in prop::sample::select(vec!["", "+", "-"]),
        whole in "[0-9]{0,19}",
        fraction in "[0-9]{0,19}",
        exponent in prop::option::of(-320_i32..300),
        mark in prop::sample::select(vec!["E", "e", "D", "d", ""]),
        plus in any::<bool>(),
    ) {
        prop_assume!(!(whole.is_empty() && fraction.is_empty()));
        let nastran_exponent = exponent.map_or(String::new(), |e| {
            // Without a letter the sign is required.
            let signed = if e < 0 { e.to_string() } else if plus || mark.is_empty() { format!("+{e}") } else { e.to_string() };
            format!("{mark}{signed}")
        });
        let text = format!("{sign}{whole}.{fraction}{nastran_exponent}");
        let expected: f64 = format!("{sign}{whole}.{fraction}e{}", exponent.unwrap_or(0)).parse().unwrap();
        let read = number::real(text.as_bytes());
        if expected.is_finite() {
            prop_assert_eq!(read.map(f64::to_bits), Some(expected.to_bits()), "{}", text);
        } else {
            prop_assert_eq!(read, None, "{}", text);
        }
    }

    #[test]
    fn prop_integers_are_those_of_the_standard_library(value in -999_999_999_999_999_999_i64..=999_999_999_999_999_999) {
        prop_assert_eq!(number::integer(value.to_string().as_bytes()), Some(value));
        prop_assert_eq!(number::integer(format!(" {value:+} ").as_bytes()), Some(value));
    }

    #[test]
    fn prop_no_text_makes_the_parsers_panic(text in proptest::collection::vec(any::<u8>(), 0..40)) {
        let _ = number::real(&text);
        let _ = number::integer(&text);
    }
}
