//! Names and units in the header of a table.

use super::{Column, Delimiter, number};

/// Units that end a name after an underscore: `q_deg_s`. Letters that often are no unit (`a`, `v`, `in`) are missing.
const SUFFIXES: [&str; 36] = [
    "deg", "rad", "s", "sec", "ms", "us", "m", "mm", "cm", "km", "ft", "kt", "kts", "kn", "g", "kg", "n",
    "nm", "knm", "hz", "khz", "rpm", "pa", "kpa", "hpa", "bar", "pct", "percent", "mps", "mps2", "fps", "lb",
    "lbf", "slug", "degc", "psf",
];

/// Further units, in brackets or on a line of units only.
const UNITS: [&str; 23] = [
    "°", "%", "-", "1", "v", "mv", "a", "ma", "w", "kw", "k", "c", "°c", "j", "min", "h", "ns", "µs", "μs",
    "mach", "psi", "kn", "t",
];

/// Cells of a header; blanks within brackets do not separate.
pub(super) fn cells(line: &str, delimiter: Delimiter) -> Vec<String> {
    let mut cells = match delimiter {
        Delimiter::Character(c) => split_outside_quotes(line, c),
        Delimiter::Blanks => bracketed_words(line),
    };
    // One delimiter after the last name ends the line.
    if cells.len() > 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
    cells
}

fn split_outside_quotes(line: &str, delimiter: char) -> Vec<String> {
    let mut quoted = false;
    line.split(|c| {
        quoted ^= c == '"';
        c == delimiter && !quoted
    })
    .map(|cell| unquoted(cell.trim()).to_owned())
    .collect()
}

/// Words separated by blanks; a unit in brackets belongs to the word before it.
fn bracketed_words(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let (mut depth, mut quoted) = (0_i32, false);
    for piece in line.split_ascii_whitespace() {
        let unit = piece.starts_with(['[', '(']) && !words.is_empty();
        match words.last_mut().filter(|_| depth > 0 || quoted || unit) {
            Some(word) => {
                word.push(' ');
                word.push_str(piece);
            }
            None => words.push(piece.to_owned()),
        }
        for c in piece.chars() {
            quoted ^= c == '"';
            depth += i32::from(c == '[' || c == '(') - i32::from(c == ']' || c == ')');
        }
        depth = depth.max(0);
    }
    words.iter().map(|word| unquoted(word).to_owned()).collect()
}

pub(super) fn unquoted(cell: &str) -> &str {
    cell.strip_prefix('"')
        .and_then(|c| c.strip_suffix('"'))
        .unwrap_or(cell)
        .trim()
}

/// Columns from the cells of a header and, if there is one, a line of units.
pub(super) fn columns(cells: &[String], units: &[String]) -> Vec<Column> {
    cells
        .iter()
        .enumerate()
        .map(|(i, cell)| {
            let (name, mut unit) = name_and_unit(cell);
            if let Some(given) = units.get(i).filter(|u| !u.is_empty()) {
                unit = Some(bare_unit(given).to_owned());
            }
            Column::new(cell, name, unit.filter(|u| u != "-"))
        })
        .collect()
}

/// The cells of a line of units; empty if the line is none.
pub(super) fn units_line(cells: &[String], expected: usize) -> Vec<String> {
    let bracketed = |cell: &str| cell.len() > 2 && bare_unit(cell).len() < cell.len();
    let unit = |cell: &str| bracketed(cell) || is_unit(cell);
    let filled = || cells.iter().filter(|cell| !cell.is_empty());
    let (numbers, texts): (Vec<&String>, Vec<&String>) = filled().partition(|cell| number(cell).is_some());
    // A row of samples with a text has numbers other than 1.
    let dimensionless = numbers.iter().all(|cell| *cell == "1") && numbers.len() <= texts.len();
    if cells.len() <= expected && !texts.is_empty() && dimensionless && texts.iter().all(|cell| unit(cell)) {
        cells.to_vec()
    } else {
        Vec::new()
    }
}

/// The header without a unit in brackets at its end.
pub(super) fn without_brackets(header: &str) -> &str {
    bracket(header).map_or(header, |(name, _)| name)
}

/// Splits `elevator [deg]`, `elevator (deg)` and `elevator_deg`.
fn name_and_unit(header: &str) -> (String, Option<String>) {
    if let Some((name, unit)) = bracket(header) {
        // `q_deg_s [deg/s]` says its unit twice.
        let stem = suffix(name)
            .filter(|(_, s)| s == unit)
            .map_or(name, |(stem, _)| stem);
        return (stem.to_owned(), Some(unit.to_owned()));
    }
    match suffix(header) {
        Some((name, unit)) => (name.to_owned(), Some(unit)),
        None => (header.to_owned(), None),
    }
}

/// Name and text of the brackets at the end; an index such as `x(3)` is part of the name.
fn bracket(header: &str) -> Option<(&str, &str)> {
    let (open, inner) = match header.strip_suffix(']') {
        Some(inner) => ('[', inner),
        None => ('(', header.strip_suffix(')')?),
    };
    let (name, unit) = inner.rsplit_once(open)?;
    let (name, unit) = (name.trim(), unit.trim());
    let index = unit.bytes().all(|b| b.is_ascii_digit()) && !(open == '[' && unit == "1");
    (!name.is_empty() && !index).then_some((name, unit))
}

/// Name and unit of `q_deg_s`: the longest end that consists of units.
fn suffix(header: &str) -> Option<(&str, String)> {
    let mut at = None;
    for (position, _) in header.rmatch_indices('_') {
        let unit = header
            .get(position + 1..)?
            .split('_')
            .next()
            .is_some_and(|piece| is_suffix(&piece.to_lowercase()));
        if !unit {
            break;
        }
        if position > 0 {
            at = Some(position);
        }
    }
    // Times in minutes; elsewhere `_min` is a minimum.
    let minutes = ["t_min", "time_min"].contains(&header.to_lowercase().as_str());
    let at = at.or_else(|| header.rfind('_').filter(|_| minutes))?;
    let name = header.get(..at)?.trim_end_matches('_');
    (!name.is_empty()).then_some((name, written_unit(header.get(at + 1..)?)))
}

fn is_suffix(piece: &str) -> bool {
    SUFFIXES.contains(&piece.trim_end_matches(['2', '3'])) || SUFFIXES.contains(&piece)
}

/// `deg_s` becomes `deg/s`, `m_s2` becomes `m/s^2`; other pieces multiply.
fn written_unit(suffix: &str) -> String {
    suffix
        .split('_')
        .enumerate()
        .fold(String::new(), |mut text, (i, piece)| {
            let piece = match piece {
                "pct" | "percent" => "%".to_owned(),
                "mps" => "m/s".to_owned(),
                "mps2" => "m/s^2".to_owned(),
                _ => match piece.strip_suffix(['2', '3']) {
                    Some(base) if !base.is_empty() => {
                        format!("{base}^{}", piece.get(base.len()..).unwrap_or_default())
                    }
                    _ => piece.to_owned(),
                },
            };
            if i > 0 {
                let divides = piece.starts_with("s^") || piece == "s";
                text.push(if divides { '/' } else { ' ' });
            }
            text.push_str(&piece);
            text
        })
}

fn bare_unit(text: &str) -> &str {
    text.trim_matches(['[', ']', '(', ')', ' '])
}

/// Products and quotients of known units.
fn is_unit(text: &str) -> bool {
    let lower = text.to_lowercase();
    let known = |piece: &&str| SUFFIXES.contains(piece) || UNITS.contains(piece);
    let mut pieces = lower
        .split(['/', '*', '·', ' ', '_', '^', '(', ')'])
        .map(|piece| piece.trim_end_matches(|c: char| c.is_ascii_digit() || "²³-".contains(c)))
        .filter(|piece| !piece.is_empty())
        .peekable();
    // Digits and strokes alone are a date or a gap, one stroke is the unit of ratios.
    lower == "-" || (pieces.peek().is_some() && pieces.all(|piece| known(&piece)))
}
