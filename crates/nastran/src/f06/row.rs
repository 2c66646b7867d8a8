//! Rows of eigenvector tables by fixed columns: wide values touch their neighbours, so white space does not separate
//! them.

use crate::deck::Id;
use crate::number;
use crate::results::{EigenvectorRow, PointKind};

/// Column layout of an eigenvector table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// MSC, NX, Simcenter and NASTRAN-95: id to column 14, type in column 21, values 15 wide from column 27.
    Typed,
    /// MYSTRAN: id to column 15, CD to column 24, values 14 wide from column 25.
    Mystran,
}

/// What a line in an eigenvector table is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    /// A grid or other six-component row.
    Row(EigenvectorRow),
    /// Values of consecutive scalar points.
    Scalars { first: Id, values: [f64; 6], count: u32 },
    /// Begins like a row; the reason why it cannot be read.
    Malformed(String),
    /// Something else: blank, heading, remark.
    Other,
}

pub(super) fn parse(line: &[u8], layout: Layout) -> Line {
    match layout {
        Layout::Typed => typed(line),
        Layout::Mystran => mystran(line),
    }
}

fn typed(line: &[u8]) -> Line {
    // Without a right-justified number up to column 14 this is no row.
    let Some(last_digit) = line.get(13) else {
        return Line::Other;
    };
    if !last_digit.is_ascii_digit() {
        return Line::Other;
    }
    let Some(id) = line.get(..14).and_then(point_number) else {
        return Line::Other;
    };
    let Some(&letter) = line.get(20) else {
        return Line::Malformed("ends before its values; the file may be truncated".into());
    };
    let kind = match letter {
        b'G' => PointKind::Grid,
        b'S' => PointKind::Scalar,
        b'A'..=b'Z' => PointKind::Other(char::from(letter)),
        _ => return Line::Other,
    };
    let mut values = [f64::NAN; 6];
    let mut count = 0;
    for (k, value) in values.iter_mut().enumerate() {
        match printed_value(column(line, 26 + 15 * k, 15)) {
            Ok(Some(v)) => {
                *value = v;
                count += 1;
            }
            Ok(None) => {}
            Err(problem) => return Line::Malformed(problem),
        }
    }
    if count == 0 {
        return Line::Malformed("has no values; the file may be truncated".into());
    }
    if kind == PointKind::Scalar {
        return Line::Scalars {
            first: id,
            values,
            count,
        };
    }
    Line::Row(EigenvectorRow {
        id,
        kind,
        cd: None,
        values,
    })
}

fn mystran(line: &[u8]) -> Line {
    let Some(last_digit) = line.get(14) else {
        return Line::Other;
    };
    if !last_digit.is_ascii_digit() {
        return Line::Other;
    }
    let Some(id) = line.get(..15).and_then(point_number) else {
        return Line::Other;
    };
    let cd_field = column(line, 15, 9).trim_ascii();
    let cd = if cd_field.is_empty() {
        None
    } else {
        point_number(cd_field)
    };
    if cd.is_none() && !cd_field.is_empty() {
        return Line::Malformed(format!(
            "has {:?} where the coordinate system is expected",
            String::from_utf8_lossy(cd_field)
        ));
    }
    let mut values = [f64::NAN; 6];
    let mut count = 0;
    for (k, value) in values.iter_mut().enumerate() {
        match printed_value(column(line, 24 + 14 * k, 14)) {
            Ok(Some(v)) => {
                *value = v;
                count += 1;
            }
            Ok(None) => {}
            Err(problem) => return Line::Malformed(problem),
        }
    }
    if count == 0 {
        return Line::Malformed("has no values; the file may be truncated".into());
    }
    // Scalar points have no system and one value.
    let kind = if cd.is_none() && count == 1 {
        PointKind::Scalar
    } else {
        PointKind::Grid
    };
    Line::Row(EigenvectorRow { id, kind, cd, values })
}

/// `width` columns from `start` (0-based), fewer if the line ends before.
fn column(line: &[u8], start: usize, width: usize) -> &[u8] {
    let end = (start + width).min(line.len());
    line.get(start..end).unwrap_or_default()
}

fn point_number(text: &[u8]) -> Option<Id> {
    let text = text.trim_ascii();
    if text.is_empty() || text.len() > 9 {
        return None;
    }
    text.iter().try_fold(0, |n: Id, d| {
        d.is_ascii_digit().then(|| n * 10 + Id::from(d - b'0'))
    })
}

/// A printed value: `Ok(None)` if blank, an error if it is not a whole number of the tables' form. `0.0` has no
/// exponent; every other value has one of at least two digits, so a number cut by the end of the file is noticed.
pub(super) fn printed_value(field: &[u8]) -> Result<Option<f64>, String> {
    let text = field.trim_ascii();
    if text.is_empty() {
        return Ok(None);
    }
    if let Some(value) = usual_form(text) {
        return Ok(Some(value));
    }
    if matches!(text, b"0.0" | b"-0.0" | b"0." | b".0") {
        return Ok(Some(if text.starts_with(b"-") { -0.0 } else { 0.0 }));
    }
    let exponent_digits = text.iter().rev().take_while(|b| b.is_ascii_digit()).count();
    let has_exponent = text
        .len()
        .checked_sub(exponent_digits + 1)
        .filter(|&at| at > 0)
        .and_then(|at| text.get(at));
    match (number::real(text), has_exponent) {
        (Some(value), Some(b'+' | b'-' | b'E' | b'D')) if exponent_digits >= 2 => Ok(Some(value)),
        _ => Err(problem_with(text)),
    }
}

#[cold]
fn problem_with(text: &[u8]) -> String {
    let shown = String::from_utf8_lossy(text);
    if text.contains(&b'*') {
        format!(
            "has the overflow mark {shown:?} in place of a value; the number does not fit the printed field"
        )
    } else {
        format!(
            "has {shown:?} where a value such as -1.234567E-02 is expected; the file may be truncated or damaged"
        )
    }
}

/// `d.ddddddEsdd` with an optional sign: seven digits and a small power of ten, exact in one operation for
/// |power| <= 22 (see [`number`]).
fn usual_form(text: &[u8]) -> Option<f64> {
    let (negative, text) = match text.split_first() {
        Some((b'-', rest)) => (true, rest),
        _ => (false, text),
    };
    let &[d0, b'.', d1, d2, d3, d4, d5, d6, b'E', sign, e1, e0] = text else {
        return None;
    };
    let digit = |d: u8| d.wrapping_sub(b'0');
    let digits = [d0, d1, d2, d3, d4, d5, d6, e1, e0].map(digit);
    if digits.iter().any(|&d| d > 9) || !matches!(sign, b'+' | b'-') {
        return None;
    }
    let [d0, d1, d2, d3, d4, d5, d6, e1, e0] = digits.map(i32::from);
    let mantissa = ((((((d0 * 10 + d1) * 10 + d2) * 10 + d3) * 10 + d4) * 10 + d5) * 10) + d6;
    let exponent = e1 * 10 + e0;
    let power = if sign == b'-' { -exponent } else { exponent } - 6;
    let magnitude = number::scaled(mantissa, power)?;
    Some(if negative { -magnitude } else { magnitude })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_must_be_whole() {
        assert_eq!(printed_value(b"  0.0          "), Ok(Some(0.0)));
        assert_eq!(printed_value(b"               "), Ok(None));
        assert_eq!(printed_value(b" -1.234567E-02 "), Ok(Some(-1.234_567e-2)));
        assert_eq!(printed_value(b"-1.500483E-18"), Ok(Some(-1.500_483e-18)));
        assert_eq!(printed_value(b"1.50048E-118"), Ok(Some(1.500_48e-118)));
        assert_eq!(printed_value(b"1.234567-101"), Ok(Some(1.234_567e-101)));
        assert_eq!(printed_value(b"4.12087860D+04"), Ok(Some(4.120_878_60e4)));
        for cut in [
            &b"-1.2345"[..],
            b"-1.234567E-0",
            b"-1.234567E",
            b"1",
            b"***********",
            b"NaN",
        ] {
            assert!(printed_value(cut).is_err(), "{cut:?}");
        }
    }

    #[test]
    fn rows_by_column() {
        let line =
            b"             4      S      1.000000E+01   1.100000E+01   1.200000E+01                                 ";
        let Line::Scalars { first, count, values } = parse(line, Layout::Typed) else {
            panic!("not scalars")
        };
        assert_eq!(
            (first, count, values[..3].to_vec()),
            (4, 3, vec![10.0, 11.0, 12.0])
        );
        let line =
            b"           1001       12 -2.869056E-03 -1.561041E-03  3.647242E-04-4.351228E-105 -1.154566E-05  0.0";
        let Line::Row(row) = parse(line, Layout::Mystran) else {
            panic!("not a row")
        };
        assert_eq!((row.id, row.cd, row.values[1]), (1001, Some(12), -1.561_041e-3));
        assert_eq!((row.values[3], row.values[5]), (-4.351_228e-105, 0.0));
        assert_eq!(
            parse(b"      POINT ID.   TYPE          T1", Layout::Typed),
            Line::Other
        );
        assert!(matches!(
            parse(b"          1000      G      4.19256", Layout::Typed),
            Line::Malformed(_)
        ));
        assert!(matches!(
            parse(b"          1000", Layout::Typed),
            Line::Malformed(_)
        ));
    }
}
