//! The machine-readable form (OPER > MRF, AVL 3.40 on): `ES23.15` numbers, then `| names`.

use super::{AxisOrientation, Reference};
use crate::error::AvlError;
use crate::source::{Line, Source, columns};

/// Width of a number.
const WIDTH: usize = 23;

/// What AVL writes where a number is not defined.
const UNDEFINED: f64 = -1.0e30;

/// A number, or none where AVL writes -1e30.
pub(crate) fn defined(value: f64) -> Option<f64> {
    (value > UNDEFINED).then_some(value)
}

/// One number. It ends in the last of its columns: a shorter one was cut.
pub(crate) fn real(line: &Line<'_>, start: usize, name: &str) -> Result<f64, AvlError> {
    let value = line.real(start, WIDTH, name)?;
    if columns(line.text, start + WIDTH - 1, 1).trim().is_empty() {
        return Err(line.syntax(format!("`{name}` in columns {} to {}", start + 1, start + WIDTH)));
    }
    Ok(value)
}

/// Numbers before the `|` of a line, `start` columns in, and the names after it.
pub(crate) fn reals<const N: usize>(
    line: &Line<'_>,
    start: usize,
    names: [&str; N],
) -> Result<[f64; N], AvlError> {
    let mut out = [0.0; N];
    for (k, (value, name)) in out.iter_mut().zip(names).enumerate() {
        *value = real(line, start + k * WIDTH, name)?;
    }
    Ok(out)
}

/// All numbers of a line before its `|`.
pub(crate) fn all_reals(line: &Line<'_>) -> Result<Vec<f64>, AvlError> {
    let (numbers, label) = line.text.split_once('|').unwrap_or((line.text, ""));
    // Two blanks stand between the numbers and the bar.
    let count = (numbers.trim_end().len() + WIDTH / 2) / WIDTH;
    (0..count).map(|k| real(line, k * WIDTH, label.trim())).collect()
}

/// Reads the next line, whose label must hold a text.
pub(crate) fn labelled<'a>(source: &mut Source<'a>, label: &str) -> Result<Line<'a>, AvlError> {
    let line = source.require(&format!("`| {label}`"))?;
    let found = line
        .text
        .split_once('|')
        .is_some_and(|(_, names)| names.contains(label));
    if found {
        Ok(line)
    } else {
        Err(line.syntax(format!("numbers and `| {label}`")))
    }
}

/// A count: `     2      | # surfaces`.
pub(crate) fn count(source: &mut Source<'_>, label: &str) -> Result<usize, AvlError> {
    let line = labelled(source, label)?;
    let number = line.text.split('|').next().unwrap_or("");
    line.parse_integer(number, 0, label)
}

/// Whole numbers of a given width and the blanks behind each.
pub(crate) fn integers<const N: usize>(
    line: &Line<'_>,
    width: usize,
    gap: usize,
    names: [&str; N],
) -> Result<[usize; N], AvlError> {
    let mut out = [0; N];
    for (k, (value, name)) in out.iter_mut().zip(names).enumerate() {
        *value = line.integer(k * (width + gap), width, name)?;
    }
    Ok(out)
}

/// Axis orientation line.
pub(crate) fn axes(source: &mut Source<'_>) -> Result<AxisOrientation, AvlError> {
    let line = source.require("the axis orientation")?;
    AxisOrientation::of(line.text)
        .ok_or_else(|| line.syntax("`Standard axis orientation, ...` or `Geometric ...`"))
}

/// The two lines of reference lengths and moment point.
pub(crate) fn reference(source: &mut Source<'_>) -> Result<Reference, AvlError> {
    let lengths = labelled(source, "Sref, Cref, Bref")?;
    let [s_ref, c_ref, b_ref] = reals(&lengths, 0, ["Sref", "Cref", "Bref"])?;
    let point = labelled(source, "Xref, Yref, Zref")?;
    let [x_ref, y_ref, z_ref] = reals(&point, 0, ["Xref", "Yref", "Zref"])?;
    Ok(Reference {
        s_ref,
        c_ref,
        b_ref,
        x_ref,
        y_ref,
        z_ref,
    })
}

/// Reads the two lines that open every MRF file.
pub(crate) fn opening(source: &mut Source<'_>) -> Result<(), AvlError> {
    source.require("the name of the block")?;
    let version = source.require("`VERSION 1.0`")?;
    if version.text.trim() == "VERSION 1.0" {
        Ok(())
    } else {
        Err(version.syntax("`VERSION 1.0`, the only version of the machine-readable form that is known"))
    }
}

/// A line that must hold one word.
pub(crate) fn word(source: &mut Source<'_>, wanted: &str) -> Result<(), AvlError> {
    let line = source.require(&format!("`{wanted}`"))?;
    if line.text.trim() == wanted {
        Ok(())
    } else {
        Err(line.syntax(format!("`{wanted}`")))
    }
}
