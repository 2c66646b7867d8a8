//! MAT-files of level 5, which MATLAB, Octave and SciPy read.
//!
//! "MAT-File Format" (The MathWorks, 2024), chapter 1: a header of 128 bytes, then one data element of type `miMATRIX`
//! a variable. An element is a tag (type, number of bytes) and data padded to eight bytes; up to four bytes of data
//! fit within the tag. Numbers are little endian, nothing is compressed.

use crate::record::{Record, Value};
use crate::{Error, Result};
use albatross_numerics::C64;

const FORMAT: &str = "MAT-file";

/// Bytes of one variable that MATLAB reads of a level-5 file.
const MOST_BYTES: usize = i32::MAX as usize;

/// Length of a field name with its closing zero.
const FIELD_NAME: usize = 32;

/// Types of data elements (table 1-1).
#[derive(Debug, Clone, Copy)]
enum Kind {
    Int8 = 1,
    Int32 = 5,
    Uint32 = 6,
    Double = 9,
    Matrix = 14,
    Utf16 = 17,
}

/// Classes of arrays (table 1-3).
#[derive(Debug, Clone, Copy)]
enum Class {
    Cell = 1,
    Struct = 2,
    Char = 4,
    Double = 6,
}

/// Flag of arrays with an imaginary part, beside the class.
const COMPLEX: u32 = 0x0800;

/// A MAT-file with one variable a field of the record: numbers as double arrays, texts as char arrays, lists of texts
/// as cell columns, groups as structs.
///
/// # Errors
/// [`Error::Name`] unless names are a letter and at most 30 letters, digits or underscores; [`Error::TooLarge`] for a
/// variable of 2 GiB.
pub fn write(record: &Record) -> Result<Vec<u8>> {
    let mut out = header();
    for (name, value) in &record.fields {
        check_name(name)?;
        out.extend(array(name, value)?);
    }
    Ok(out)
}

fn header() -> Vec<u8> {
    let mut out = format!(
        "MATLAB 5.0 MAT-file, written by Albatross {}",
        env!("CARGO_PKG_VERSION")
    )
    .into_bytes();
    out.resize(116, b' ');
    // No data of subsystems; version 1; the letters MI as the writer's byte order has them.
    out.extend([0; 8]);
    out.extend(0x0100_u16.to_le_bytes());
    out.extend(b"IM");
    out
}

fn check_name(name: &str) -> Result<()> {
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let goes_on = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if begins && goes_on && name.len() < FIELD_NAME {
        return Ok(());
    }
    Err(Error::Name {
        name: name.to_owned(),
        format: FORMAT,
        expected: "a letter, then at most 30 letters, digits or underscores",
    })
}

/// An element of type `miMATRIX`.
fn array(name: &str, value: &Value) -> Result<Vec<u8>> {
    let of = |class, dimensions, data| wrap(name, class, 0, dimensions, data);
    match value {
        Value::Scalar(x) => of(Class::Double, (1, 1), doubles([*x])),
        Value::Column(list) => of(Class::Double, (list.len(), 1), doubles(list.iter().copied())),
        Value::ComplexColumn(list) => {
            let mut data = doubles(list.iter().map(|z: &C64| z.re));
            data.extend(doubles(list.iter().map(|z| z.im)));
            wrap(name, Class::Double, COMPLEX, (list.len(), 1), data)
        }
        Value::Matrix(m) => {
            let by_columns = (0..m.ncols()).flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)]));
            of(Class::Double, (m.nrows(), m.ncols()), doubles(by_columns))
        }
        Value::Text(text) => {
            let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
            let length = units.len() / 2;
            of(
                Class::Char,
                (usize::from(length > 0), length),
                element(Kind::Utf16, &units),
            )
        }
        Value::Texts(list) => {
            let mut data = Vec::new();
            for text in list {
                data.extend(array("", &Value::Text(text.clone()))?);
            }
            of(Class::Cell, (list.len(), 1), data)
        }
        Value::Group(record) => {
            let mut data = element(Kind::Int32, &(FIELD_NAME as i32).to_le_bytes());
            let mut names = Vec::new();
            for (name, _) in &record.fields {
                check_name(name)?;
                let end = names.len() + FIELD_NAME;
                names.extend(name.bytes());
                names.resize(end, 0);
            }
            data.extend(element(Kind::Int8, &names));
            for (_, value) in &record.fields {
                data.extend(array("", value)?);
            }
            of(Class::Struct, (1, 1), data)
        }
    }
}

/// Flags, dimensions and name before the data.
fn wrap(
    name: &str,
    class: Class,
    flags: u32,
    (rows, columns): (usize, usize),
    data: Vec<u8>,
) -> Result<Vec<u8>> {
    let too_large = |found: usize| Error::TooLarge {
        what: format!("the variable `{name}`"),
        format: FORMAT,
        found,
        most: MOST_BYTES,
    };
    let dimension = |n: usize| i32::try_from(n).map_err(|_| too_large(data.len()));
    let dimensions = [dimension(rows)?, dimension(columns)?];
    let pair = |a: [u8; 4], b: [u8; 4]| [a, b].concat();
    let mut body = element(Kind::Uint32, &pair((class as u32 | flags).to_le_bytes(), [0; 4]));
    body.extend(element(
        Kind::Int32,
        &pair(dimensions[0].to_le_bytes(), dimensions[1].to_le_bytes()),
    ));
    body.extend(element(Kind::Int8, name.as_bytes()));
    body.extend(data);
    if body.len() > MOST_BYTES {
        return Err(too_large(body.len()));
    }
    Ok(element(Kind::Matrix, &body))
}

fn doubles(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
    element(Kind::Double, &bytes)
}

/// Tag and data. Sizes beyond 32 bits are caught by [`wrap`] before they are used.
fn element(kind: Kind, data: &[u8]) -> Vec<u8> {
    let (kind, length) = (kind as u32, data.len() as u32);
    let mut out = Vec::with_capacity(data.len() + 16);
    if (1..=4).contains(&data.len()) {
        out.extend((length << 16 | kind).to_le_bytes());
        out.extend(data);
    } else {
        out.extend(kind.to_le_bytes());
        out.extend(length.to_le_bytes());
        out.extend(data);
    }
    out.resize(out.len().next_multiple_of(8), 0);
    out
}
