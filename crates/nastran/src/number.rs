//! Numbers as Nastran writes them: reals such as `1.5-3`, `.5`, `2.D+4`, and integers.
//!
//! Values are those of Rust's own parser bit for bit. The fast path covers decimals of up to 15 digits with a power
//! of ten of at most 22, where one floating-point operation on exact operands rounds correctly (Clinger, W. D., "How
//! to Read Floating Point Numbers Accurately", PLDI 1990); all else goes to the standard library.

const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// A Nastran real, or an integer where a real is wanted. The exponent may be given by `E`, `D` (either case) or by
/// its sign alone. `None` if the text is not a finite number.
#[must_use]
pub fn real(text: &[u8]) -> Option<f64> {
    let text = text.trim_ascii();
    let (negative, digits) = match text.split_first()? {
        (b'-', rest) => (true, rest),
        (b'+', rest) => (false, rest),
        _ => (false, text),
    };
    let mut mantissa: u64 = 0;
    let mut significant = 0_u32;
    let mut any_digit = false;
    let mut scale: i32 = 0;
    let mut point = false;
    let mut at = 0;
    while let Some(&byte) = digits.get(at) {
        match byte {
            b'0'..=b'9' => {
                any_digit = true;
                // Leading zeros are not significant; past 19 digits the mantissa no longer fits.
                if significant > 0 || byte != b'0' {
                    significant += 1;
                    if significant <= 19 {
                        mantissa = mantissa * 10 + u64::from(byte - b'0');
                    }
                }
                if point {
                    scale = scale.saturating_sub(1);
                }
            }
            b'.' if !point => point = true,
            _ => break,
        }
        at += 1;
    }
    if !any_digit {
        return None;
    }
    let exponent = exponent(digits.get(at..)?)?;
    let power = scale.saturating_add(exponent);
    let small = if significant <= 15 {
        i64::try_from(mantissa).ok()
    } else {
        None
    };
    let magnitude = match small.and_then(|m| exact_product(m, power)) {
        Some(value) => value,
        None => by_standard_library(digits.get(..at)?, exponent)?,
    };
    Some(if negative { -magnitude } else { magnitude })
}

/// The exponent part: empty, `E+5`, `d-3`, `+5`, `-3`. `None` if malformed.
fn exponent(text: &[u8]) -> Option<i32> {
    let Some((&first, after)) = text.split_first() else {
        return Some(0);
    };
    let signed = match first {
        b'E' | b'e' | b'D' | b'd' => after,
        b'+' | b'-' => text,
        _ => return None,
    };
    let (negative, digits) = match signed.split_first()? {
        (b'-', rest) => (true, rest),
        (b'+', rest) => (false, rest),
        _ => (false, signed),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value: i32 = 0;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value.saturating_mul(10).saturating_add(i32::from(digit - b'0'));
    }
    Some(if negative { -value } else { value })
}

/// `mantissa * 10^power` for a mantissa below 2^53 if one correctly rounded operation on exact operands gives it.
fn exact_product(mantissa: i64, power: i32) -> Option<f64> {
    let factor = *POWERS_OF_TEN.get(usize::try_from(power.unsigned_abs()).ok()?)?;
    #[expect(clippy::cast_precision_loss, reason = "below 2^53")]
    let exact = mantissa as f64;
    Some(if power < 0 { exact / factor } else { exact * factor })
}

/// `mantissa * 10^power`, correctly rounded.
pub(crate) fn scaled(mantissa: i32, power: i32) -> Option<f64> {
    exact_product(i64::from(mantissa), power)
        .or_else(|| by_standard_library(mantissa.to_string().as_bytes(), power))
}

/// The standard library's parser on the mantissa and a plain exponent, put together on the stack.
#[cold]
fn by_standard_library(mantissa: &[u8], exponent: i32) -> Option<f64> {
    use std::io::Write;
    let mut buffer = [0_u8; 64];
    let mut free = &mut buffer[..];
    let parse = |text: &[u8]| {
        std::str::from_utf8(text)
            .ok()?
            .parse::<f64>()
            .ok()
            .filter(|v| v.is_finite())
    };
    if free.write_all(mantissa).is_ok() && write!(free, "e{exponent}").is_ok() {
        let unused = free.len();
        return parse(buffer.get(..buffer.len() - unused)?);
    }
    parse(&[mantissa, format!("e{exponent}").as_bytes()].concat())
}

/// A signed integer; `None` for anything else, including reals.
#[must_use]
pub fn integer(text: &[u8]) -> Option<i64> {
    let text = text.trim_ascii();
    let (negative, digits) = match text.split_first()? {
        (b'-', rest) => (true, rest),
        (b'+', rest) => (false, rest),
        _ => (false, text),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value: i64 = 0;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value * 10 + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}

/// Whether the text is written as a real: it has a point or an exponent.
#[must_use]
pub(crate) fn looks_real(text: &[u8]) -> bool {
    integer(text).is_none() && real(text).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nastran_forms() {
        for (text, value) in [
            ("1.5-3", 1.5e-3),
            ("1.44+9", 1.44e9),
            ("2.9+7", 2.9e7),
            ("1.-3", 1.0e-3),
            ("-.5", -0.5),
            ("27.11325", 27.11325),
            (".0011338", 0.001_133_8),
            ("7.+10", 7e10),
            ("+1.D+02", 100.0),
            ("1.0e5", 1e5),
            ("2.", 2.0),
            ("12", 12.0),
            (" 3.25 ", 3.25),
            ("1.23456789012345678901", 1.234_567_890_123_456_8),
            ("1.7976931348623157+308", f64::MAX),
            ("4.9-324", 5e-324),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
        for text in [
            "", "-", ".", "1.2.3", "1E", "1.+", "ABC", "1.0 2", "1e999", "12A", "--1", "0x10",
        ] {
            assert_eq!(real(text.as_bytes()), None, "{text}");
        }
        assert!(real(b"-0.0").is_some_and(f64::is_sign_negative));
    }

    #[test]
    fn integers_refuse_reals() {
        assert_eq!(integer(b" -12 "), Some(-12));
        assert_eq!(integer(b"+7"), Some(7));
        assert_eq!(integer(b"1."), None);
        assert_eq!(integer(b"1+3"), None);
        assert_eq!(integer(b"99999999999999999999"), None);
    }
}
