//! Tables: what a cell may hold, and the four ways to write a table down.
//!
//! | rendering | for | numbers |
//! |---|---|---|
//! | [`Table::to_markdown`] | documents | rounded by the column's [`Format`] |
//! | [`Table::to_text`] | terminals | rounded by the column's [`Format`] |
//! | [`Table::to_csv`] | spreadsheets, pandas | every digit |
//! | [`Table::to_json`] | programs | every digit; `null` for what is not a number |
//!
//! A remark on a single value (*the paper's printed figure is a slip*, *did not converge*) is a note of its
//! cell, not of the table: it becomes a footnote in Markdown and text, and travels with the row in CSV and JSON.

mod csv;
mod json;
mod markdown;
mod text;

use crate::error::ReportError;
use crate::number::Format;

pub(crate) use markdown::escape as escape_markdown;

/// One value of a table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number, shown in the format of its column.
    Number(f64),
    /// A number with a format of its own, where rows of one column are different quantities.
    Formatted(f64, Format),
    /// A whole number.
    Integer(i64),
    /// No value; the reason, if any, becomes a footnote.
    Missing(Option<String>),
    /// A value with a remark, which becomes a footnote.
    Flagged {
        /// The value itself.
        cell: Box<Cell>,
        /// The remark.
        note: String,
    },
}

impl Cell {
    /// No value, and nothing to say about it.
    pub const EMPTY: Self = Self::Missing(None);

    /// No value, for a reason worth a footnote.
    pub fn missing(reason: impl Into<String>) -> Self {
        Self::Missing(Some(reason.into()))
    }

    /// This cell with a remark.
    #[must_use]
    pub fn flagged(self, note: impl Into<String>) -> Self {
        Self::Flagged {
            cell: Box::new(self),
            note: note.into(),
        }
    }

    /// The value without its remarks.
    fn value(&self) -> &Self {
        match self {
            Self::Flagged { cell, .. } => cell.value(),
            plain => plain,
        }
    }

    /// The remarks, outermost first.
    fn notes(&self) -> Vec<&str> {
        match self {
            Self::Flagged { cell, note } => {
                let mut notes = vec![note.as_str()];
                notes.extend(cell.notes());
                notes
            }
            Self::Missing(Some(reason)) => vec![reason.as_str()],
            _ => Vec::new(),
        }
    }

    fn is_numeric(&self) -> bool {
        matches!(
            self.value(),
            Self::Number(_) | Self::Formatted(..) | Self::Integer(_)
        )
    }

    /// The value as a reader sees it, without remarks.
    pub(crate) fn shown(&self, format: Format) -> String {
        match self.value() {
            Self::Text(words) => words.clone(),
            Self::Number(number) => format.show(*number),
            Self::Formatted(number, own) => own.show(*number),
            Self::Integer(number) => number.to_string(),
            Self::Missing(_) | Self::Flagged { .. } => "–".to_owned(),
        }
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<i64> for Cell {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<usize> for Cell {
    fn from(number: usize) -> Self {
        i64::try_from(number).map_or(Self::Number(number as f64), Self::Integer)
    }
}

impl From<&str> for Cell {
    fn from(words: &str) -> Self {
        Self::Text(words.to_owned())
    }
}

impl From<String> for Cell {
    fn from(words: String) -> Self {
        Self::Text(words)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::EMPTY, Into::into)
    }
}

/// One column: what it holds, in which unit, and how its numbers are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the quantity.
    pub name: String,
    /// Unit, empty for words and for quantities without one.
    pub unit: String,
    /// Heading that this column shares with its neighbours; empty for none.
    pub group: String,
    /// How numbers of this column are shown in Markdown and text.
    pub format: Format,
}

impl Column {
    /// A column of numbers.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, format: Format) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            group: String::new(),
            format,
        }
    }

    /// A column of words (numbers that stray into it are shown exactly).
    pub fn text(name: impl Into<String>) -> Self {
        Self::new(name, "", Format::Exact)
    }

    /// This column under a heading shared with its neighbours, such as *first peak*.
    #[must_use]
    pub fn in_group(mut self, group: impl Into<String>) -> Self {
        self.group = group.into();
        self
    }

    /// Group and name: what the column is called where there is one line for it.
    fn full_name(&self) -> String {
        match (self.group.as_str(), self.name.as_str()) {
            ("", name) => name.to_owned(),
            (group, "") => group.to_owned(),
            (group, name) => format!("{group}: {name}"),
        }
    }

    /// Group, name and unit: `first peak: q [deg/s]`.
    fn heading(&self) -> String {
        if self.unit.is_empty() {
            self.full_name()
        } else {
            format!("{} [{}]", self.full_name(), self.unit)
        }
    }
}

/// A table: a title, columns, and rows of as many cells.
///
/// ```
/// use albatross_report::{Cell, Column, Format, Table};
/// # fn main() -> Result<(), albatross_report::ReportError> {
/// let mut table = Table::new(
///     "Trim",
///     [Column::text("model"), Column::new("alpha", "deg", Format::Fixed(2))],
/// );
/// table.push([Cell::from("CFD"), Cell::from(1.32)])?;
/// table.push([Cell::from("surrogate"), Cell::from(1.327).flagged("independent simulation")])?;
/// assert_eq!(table.to_csv(), "model,alpha [deg],notes\nCFD,1.32,\nsurrogate,1.327,independent simulation\n");
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Title, printed above.
    pub title: String,
    /// Explanation, printed below; may be empty.
    pub caption: String,
    columns: Vec<Column>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    pub fn new(title: impl Into<String>, columns: impl IntoIterator<Item = Column>) -> Self {
        Self {
            title: title.into(),
            caption: String::new(),
            columns: columns.into_iter().collect(),
            rows: Vec::new(),
        }
    }

    /// This table with an explanation below it.
    #[must_use]
    pub fn with_caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Appends a row.
    ///
    /// # Errors
    /// [`ReportError::RowLength`] if there is not one cell per column.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) -> Result<(), ReportError> {
        let row: Vec<Cell> = row.into_iter().collect();
        if row.len() != self.columns.len() {
            return Err(ReportError::RowLength {
                table: self.title.clone(),
                row: self.rows.len() + 1,
                found: row.len(),
                expected: self.columns.len(),
            });
        }
        self.rows.push(row);
        Ok(())
    }

    /// The columns.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The rows, each with one cell per column.
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// One key per column, made unique by a number in brackets where names repeat.
    fn keys(&self) -> Vec<String> {
        let mut keys: Vec<String> = Vec::with_capacity(self.columns.len());
        for column in &self.columns {
            let name = column.full_name();
            let mut key = name.clone();
            let mut number = 2;
            while keys.contains(&key) {
                key = format!("{name} ({number})");
                number += 1;
            }
            keys.push(key);
        }
        keys
    }

    /// Whether a column lines up on the right: it holds numbers, or nothing but gaps.
    pub(crate) fn is_right_aligned(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(column)).peekable();
        cells.peek().is_some() && {
            let mut words = false;
            let mut numbers = false;
            for cell in cells {
                numbers |= cell.is_numeric();
                words |= matches!(cell.value(), Cell::Text(_));
            }
            numbers || !words
        }
    }
}

/// The distinct notes of a table in order of appearance, marked (a), (b), …
pub(crate) struct Footnotes {
    notes: Vec<String>,
}

impl Footnotes {
    pub(crate) fn of(table: &Table) -> Self {
        let mut notes: Vec<String> = Vec::new();
        for note in table.rows.iter().flatten().flat_map(Cell::notes) {
            if !notes.iter().any(|known| known == note) {
                notes.push(note.to_owned());
            }
        }
        Self { notes }
    }

    /// The marks of a cell: empty, ` (a)`, or ` (a, c)`.
    pub(crate) fn marks(&self, cell: &Cell) -> String {
        let marks: Vec<String> = cell
            .notes()
            .into_iter()
            .filter_map(|note| self.notes.iter().position(|known| known == note))
            .map(mark)
            .collect();
        if marks.is_empty() {
            String::new()
        } else {
            format!(" ({})", marks.join(", "))
        }
    }

    pub(crate) fn marked(&self) -> impl Iterator<Item = (String, &str)> {
        self.notes
            .iter()
            .enumerate()
            .map(|(index, note)| (mark(index), note.as_str()))
    }
}

/// a, b, …, z, aa, ab, …
fn mark(index: usize) -> String {
    let letter = |i: usize| u8::try_from(i % 26).map_or('?', |i| char::from(b'a' + i));
    if index < 26 {
        letter(index).to_string()
    } else {
        format!("{}{}", mark(index / 26 - 1), letter(index))
    }
}

/// Columns a text takes in a fixed-width font: combining marks take none, East Asian wide characters two.
fn display_width(text: &str) -> usize {
    text.chars()
        .map(|c| match u32::from(c) {
            0x0300..=0x036F | 0x200B..=0x200D | 0xFE00..=0xFE0F => 0,
            0x1100..=0x115F | 0x2E80..=0xA4CF | 0xAC00..=0xD7A3 | 0xF900..=0xFAFF | 0xFF00..=0xFF60 => 2,
            _ => 1,
        })
        .sum()
}

/// Pads with spaces on the left or right to a display width, but to no more than columns that anybody lines up: one very
/// long cell would else be paid for in every row.
fn pad(text: &str, width: usize, right_aligned: bool) -> String {
    const WIDEST: usize = 1000;
    let fill = " ".repeat(width.min(WIDEST).saturating_sub(display_width(text)));
    if right_aligned {
        format!("{fill}{text}")
    } else {
        format!("{text}{fill}")
    }
}

/// The body of a table as text: shown values and marks, with marks of a column padded to one width so that
/// digits stay in line.
fn body(table: &Table, footnotes: &Footnotes, escape: impl Fn(&str) -> String) -> Vec<Vec<String>> {
    let mark_widths: Vec<usize> = (0..table.columns.len())
        .map(|j| {
            let cells = table.rows.iter().filter_map(|row| row.get(j));
            cells
                .map(|cell| display_width(&footnotes.marks(cell)))
                .max()
                .unwrap_or(0)
        })
        .collect();
    table
        .rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(&table.columns).zip(&mark_widths);
            cells
                .map(|((cell, column), width)| {
                    let shown = escape(&cell.shown(column.format));
                    format!("{shown}{}", pad(&footnotes.marks(cell), *width, false))
                })
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_the_wrong_length_is_refused_and_named() {
        let mut table = Table::new("T", [Column::text("a"), Column::text("b")]);
        let error = table.push([Cell::from("only one")]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "table `T`, row 1: 1 cells for 2 columns; give one cell per column (Cell::Missing where there is no value)"
        );
        assert!(table.rows().is_empty());
    }

    #[test]
    fn marks_run_past_the_alphabet() {
        assert_eq!(
            (mark(0), mark(25), mark(26), mark(52)),
            ("a".into(), "z".into(), "aa".into(), "ba".into())
        );
    }

    #[test]
    fn regress_one_long_cell_does_not_widen_all() {
        let mut table = Table::new("T", [Column::text("a"), Column::text("b")]);
        let long = "x".repeat(200_000);
        table.push([long.as_str(), "1"].map(Cell::from)).unwrap();
        for _ in 0..500 {
            table.push(["y", "2"].map(Cell::from)).unwrap();
        }
        for text in [table.to_text(), table.to_markdown()] {
            assert!(text.contains(&long) && text.len() < 2_000_000, "{}", text.len());
        }
        assert_eq!(pad("ab", 5, true), "   ab");
    }

    #[test]
    fn keys_are_unique() {
        let column = |name: &str| Column::new(name, "", Format::Exact);
        let table = Table::new(
            "",
            [
                column("x"),
                column("x (2)"),
                column("x"),
                column("x").in_group("g"),
            ],
        );
        assert_eq!(table.keys(), ["x", "x (2)", "x (3)", "g: x"]);
    }

    #[test]
    fn equal_notes_share_a_mark() {
        let mut table = Table::new("T", [Column::new("v", "", Format::Fixed(0))]);
        for (value, note) in [(1.0, "slip"), (2.0, "other"), (3.0, "slip")] {
            table.push([Cell::from(value).flagged(note)]).unwrap();
        }
        let footnotes = Footnotes::of(&table);
        let marks: Vec<String> = table
            .rows()
            .iter()
            .flatten()
            .map(|cell| footnotes.marks(cell))
            .collect();
        assert_eq!(marks, [" (a)", " (b)", " (a)"]);
    }
}
