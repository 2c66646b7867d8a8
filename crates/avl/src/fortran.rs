//! Numbers as Fortran reads and prints them.

use nom::bytes::complete::take_while1;
use nom::{IResult, Parser};

/// Length of the Fortran real at the start of a text: `1`, `-.5`, `2.0d0`, `1.5-3`, `1.E+05`.
fn real_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let at = |i: usize| bytes.get(i).copied().unwrap_or(0);
    let digits = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_digit()).count();
    let mut end = usize::from(matches!(at(0), b'+' | b'-'));
    let whole = digits(end);
    end += whole;
    let mut fraction = 0;
    if at(end) == b'.' {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    let letter = usize::from(matches!(at(end), b'e' | b'E' | b'd' | b'D' | b'q' | b'Q'));
    let sign = usize::from(matches!(at(end + letter), b'+' | b'-'));
    let exponent = digits(end + letter + sign);
    if letter + sign > 0 && exponent > 0 {
        end += letter + sign + exponent;
    }
    Some(end)
}

/// Value of a text that is exactly one Fortran real; `None` for anything else, infinities and NaN included.
pub(crate) fn parse_real(text: &str) -> Option<f64> {
    if real_length(text)? != text.len() {
        return None;
    }
    // Most numbers are already as Rust writes them.
    let value: f64 = match text.parse() {
        Ok(value) => value,
        Err(_) => with_exponent_letter(text).parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// `2.0d0` and `1.5-3` as `2.0e0` and `1.5e-3`.
fn with_exponent_letter(number: &str) -> String {
    let mut out = String::with_capacity(number.len() + 1);
    let mut has_exponent = false;
    for (i, c) in number.chars().enumerate() {
        match c {
            'd' | 'D' | 'q' | 'Q' | 'e' | 'E' => {
                has_exponent = true;
                out.push('e');
            }
            '+' | '-' if i > 0 && !has_exponent => {
                has_exponent = true;
                out.push('e');
                out.push(c);
            }
            _ => out.push(c),
        }
    }
    out
}

/// Whether a text is how Fortran prints infinity or not-a-number.
pub(crate) fn is_not_finite(text: &str) -> bool {
    let bare = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    matches!(bare.as_str(), "nan" | "inf" | "infinity") || parse_overflowing(&bare)
}

/// A well-formed number too large for 64 bits.
fn parse_overflowing(text: &str) -> bool {
    real_length(text) == Some(text.len())
        && with_exponent_letter(text)
            .parse::<f64>()
            .is_ok_and(f64::is_infinite)
}

/// One item of a list-directed line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Item<'a> {
    /// A number, with its repeat count (1 unless written `3*0.`).
    Number {
        /// The value.
        value: f64,
        /// How often it counts.
        repeat: usize,
        /// The text as found.
        text: &'a str,
    },
    /// Anything else.
    Word(&'a str),
}

/// `3*0.`: repeat count and value.
fn repeated(text: &str) -> Option<(usize, f64)> {
    let (count, value) = text.split_once('*')?;
    let count: usize = count.parse().ok().filter(|n| (1..=1000).contains(n))?;
    Some((count, parse_real(value)?))
}

/// One blank-, tab- or comma-separated item.
fn item(input: &str) -> IResult<&str, Item<'_>> {
    let (rest, text) = take_while1(|c: char| !is_separator(c)).parse(input)?;
    let item = if let Some(value) = parse_real(text) {
        Item::Number {
            value,
            repeat: 1,
            text,
        }
    } else if let Some((repeat, value)) = repeated(text) {
        Item::Number { value, repeat, text }
    } else {
        Item::Word(text)
    };
    Ok((rest, item))
}

/// Whether a character separates items.
fn is_separator(c: char) -> bool {
    c.is_whitespace() || c == ','
}

/// Splits a line at blanks, tabs and commas.
pub(crate) fn items(line: &str) -> Vec<Item<'_>> {
    let mut out = Vec::new();
    let mut rest = line.trim_start_matches(is_separator);
    while let Ok((tail, found)) = item(rest) {
        out.push(found);
        rest = tail.trim_start_matches(is_separator);
    }
    out
}

/// `Fw.d`: right-justified in `width` columns; `None` when it does not fit (Fortran prints stars).
pub(crate) fn fixed(value: f64, width: usize, decimals: usize) -> Option<String> {
    if !value.is_finite() {
        return None;
    }
    let mut text = format!("{value:.decimals$}");
    if text.len() == width + 1 {
        // The zero before the point is dropped when it is what does not fit.
        if let Some(fraction) = text.strip_prefix("0.") {
            text = format!(".{fraction}");
        } else if let Some(fraction) = text.strip_prefix("-0.") {
            text = format!("-.{fraction}");
        }
    }
    (text.len() <= width).then(|| format!("{text:>width$}"))
}

/// `Gw.d`: `F` with four blanks behind between 0.1 and `10^d`, else `E`.
pub(crate) fn general(value: f64, width: usize, digits: usize) -> Option<String> {
    if !value.is_finite() || digits == 0 || width < 5 {
        return None;
    }
    let last = digits - 1;
    if value == 0.0 {
        return Some(fixed(value, width - 4, last)? + "    ");
    }
    // The choice is made on the rounded number.
    let rounded = format!("{value:.last$e}");
    let (mantissa, exponent) = rounded.split_once('e')?;
    let exponent: i32 = exponent.parse().ok()?;
    let magnitude = exponent + 1;
    match usize::try_from(magnitude) {
        Ok(whole) if whole <= digits => Some(fixed(value, width - 4, digits - whole)? + "    "),
        _ => {
            let (sign, digits) = match mantissa.strip_prefix('-') {
                Some(rest) => ("-", rest.replace('.', "")),
                None => ("", mantissa.replace('.', "")),
            };
            let exponent = if magnitude.abs() < 100 {
                format!("E{magnitude:+03}")
            } else {
                format!("{magnitude:+04}")
            };
            let text = format!("{sign}0.{digits}{exponent}");
            (text.len() <= width).then(|| format!("{text:>width$}"))
        }
    }
}

/// `Iw`; `None` when it does not fit.
pub(crate) fn integer(value: usize, width: usize) -> Option<String> {
    let text = value.to_string();
    (text.len() <= width).then(|| format!("{text:>width$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every form that Fortran 77 list-directed input takes for a real (ANSI X3.9-1978, 13.5.9).
    #[test]
    fn reals_of_every_form() {
        for (text, value) in [
            ("1", 1.0),
            ("130.10", 130.1),
            ("-.5", -0.5),
            ("+2.", 2.0),
            ("2.0d0", 2.0),
            ("1D-1", 0.1),
            ("1.5-3", 1.5e-3),
            ("-1.25+2", -125.0),
            ("0.40000E-04", 4e-5),
            ("3.E5", 3e5),
            ("1q2", 100.0),
        ] {
            assert_eq!(parse_real(text), Some(value), "{text}");
        }
        for text in [
            "", ".", "-", "1e", "1.2.3", "abc", "NaN", "inf", "1e999", "1 2", "0x10", "1_000", "--1",
        ] {
            assert_eq!(parse_real(text), None, "{text}");
        }
        assert!(is_not_finite("NaN") && is_not_finite("-Infinity") && is_not_finite("1E999"));
        assert!(!is_not_finite("1.0") && !is_not_finite("abc"));
    }

    #[test]
    fn items_with_commas_tabs_and_repeats() {
        let numbers: Vec<(f64, usize)> = items("0,0\t0.0 3*.25, 1D-1")
            .into_iter()
            .filter_map(|i| match i {
                Item::Number { value, repeat, .. } => Some((value, repeat)),
                Item::Word(_) => None,
            })
            .collect();
        assert_eq!(numbers, [(0.0, 1), (0.0, 1), (0.0, 1), (0.25, 3), (0.1, 1)]);
        assert_eq!(items("| text")[0], Item::Word("|"));
        assert!(items("   ").is_empty());
    }

    /// Against what gfortran printed in AVL 3.52's own files.
    #[test]
    fn val_formats_as_printed_by_gfortran() {
        assert_eq!(general(130.1, 12, 5).unwrap(), "  130.10    ");
        assert_eq!(general(3.34649, 12, 5).unwrap(), "  3.3465    ");
        assert_eq!(general(-0.42768, 12, 5).unwrap(), "-0.42768    ");
        assert_eq!(general(0.0, 12, 5).unwrap(), "  0.0000    ");
        assert_eq!(general(-0.0, 12, 5).unwrap(), " -0.0000    ");
        assert_eq!(general(4e-5, 12, 5).unwrap(), " 0.40000E-04");
        assert_eq!(general(0.05, 12, 5).unwrap(), " 0.50000E-01");
        assert_eq!(general(-0.049_809_7, 14, 6).unwrap(), " -0.498097E-01");
        assert_eq!(general(4_210.857_37, 14, 6).unwrap(), "   4210.86    ");
        assert_eq!(general(52_686.87, 12, 4).unwrap(), "  0.5269E+05");
        assert_eq!(general(1e-120, 12, 5).unwrap(), " 0.10000-119");
        // Rounding decides: 0.0999999 prints as 0.10000.
        assert_eq!(general(0.099_999_99, 12, 5).unwrap(), " 0.10000    ");
        assert_eq!(general(99_999.6, 12, 5).unwrap(), " 0.10000E+06");
        assert_eq!(fixed(-0.0, 10, 5).unwrap(), "  -0.00000");
        assert_eq!(fixed(0.007_823_3, 10, 7).unwrap(), " 0.0078233");
        assert_eq!(fixed(-0.5, 6, 4).unwrap(), "-.5000".to_string());
        assert_eq!(fixed(12_345.678_9, 10, 5), None);
        assert_eq!(fixed(f64::NAN, 10, 5), None);
        assert_eq!(integer(1000, 3), None);
    }
}
