//! NumPy's archives: `numpy.load("model.npz")["A"]`.
//!
//! "NPY format" (NEP 1, Kern 2007), version 1.0: a header of text, then the numbers. Lists of texts are arrays of fixed
//! width (`<U`), so that no file needs `allow_pickle`. Values of a group are named `Group.value`.

use crate::Result;
use crate::record::{Record, Value};
use crate::zip;

/// An archive with an array a value.
///
/// # Errors
/// [`crate::Error::TooLarge`] beyond 4 GiB.
pub fn write(record: &Record) -> Result<Vec<u8>> {
    let mut files = Vec::new();
    arrays("", record, &mut files)?;
    zip::archive(&files)
}

fn arrays(prefix: &str, record: &Record, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    for (name, value) in &record.fields {
        let name = format!("{prefix}{name}");
        match value {
            Value::Group(group) => arrays(&format!("{name}."), group, files)?,
            value => files.push((format!("{name}.npy"), array(&name, value)?)),
        }
    }
    Ok(())
}

fn array(name: &str, value: &Value) -> Result<Vec<u8>> {
    Ok(match value {
        Value::Scalar(x) => npy("<f8", "()", x.to_le_bytes()),
        Value::Column(list) => npy(
            "<f8",
            &row_of(list.len()),
            list.iter().flat_map(|x| x.to_le_bytes()),
        ),
        Value::ComplexColumn(list) => {
            let parts = list.iter().flat_map(|z| [z.re, z.im]);
            npy("<c16", &row_of(list.len()), parts.flat_map(f64::to_le_bytes))
        }
        Value::Matrix(m) => {
            let by_columns = (0..m.ncols()).flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)]));
            npy(
                "<f8",
                &format!("({}, {})", m.nrows(), m.ncols()),
                by_columns.flat_map(f64::to_le_bytes),
            )
        }
        Value::Text(text) => texts(name, "()", &[text.as_str()])?,
        Value::Texts(list) => {
            let list: Vec<&str> = list.iter().map(String::as_str).collect();
            texts(name, &row_of(list.len()), &list)?
        }
        // Taken apart by [`arrays`].
        Value::Group(_) => Vec::new(),
    })
}

fn row_of(length: usize) -> String {
    format!("({length},)")
}

/// Texts in UTF-32, zeros to the length of the longest.
fn texts(name: &str, shape: &str, list: &[&str]) -> Result<Vec<u8>> {
    let width = list.iter().map(|t| t.chars().count()).max().unwrap_or(0).max(1);
    // One long text among many makes an array much larger than the texts are.
    let (room, most) = (
        list.len().saturating_mul(width).saturating_mul(4),
        u32::MAX as usize,
    );
    if room > most {
        return Err(zip::too_large(name, room, most));
    }
    let padded = list.iter().flat_map(|text| {
        let codes = text.chars().map(u32::from).chain(std::iter::repeat(0));
        codes.take(width).flat_map(u32::to_le_bytes)
    });
    Ok(npy(&format!("<U{width}"), shape, padded))
}

/// An array stored by columns.
fn npy(kind: &str, shape: &str, data: impl IntoIterator<Item = u8>) -> Vec<u8> {
    const BEFORE: usize = 10;
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': True, 'shape': {shape}, }}");
    // A line whose end is a multiple of 64 bytes from the beginning; always far below 64 KiB.
    let blanks = (BEFORE + header.len() + 1).next_multiple_of(64) - (BEFORE + header.len() + 1);
    header.push_str(&" ".repeat(blanks));
    header.push('\n');
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.bytes());
    out.extend(data);
    out
}
