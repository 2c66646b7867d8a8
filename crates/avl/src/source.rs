//! A text with its file name: lines, columns, labelled fields, and the errors that name them.

use crate::error::{AvlError, Diagnostic, Location};
use crate::fortran;

/// Reads a file as text. Bytes that are not UTF-8 are taken as Latin-1, one character each, so that columns
/// keep their places.
///
/// # Errors
/// [`AvlError::Io`] when the operating system does not give the file.
pub fn read_text(path: impl AsRef<std::path::Path>) -> Result<String, AvlError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(|e| AvlError::Io {
        file: path.display().to_string(),
        reason: e.to_string(),
    })?;
    Ok(String::from_utf8(bytes).unwrap_or_else(|e| e.as_bytes().iter().map(|&b| char::from(b)).collect()))
}

/// A text cut into lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<'a> {
    /// File name.
    pub(crate) file: &'a str,
    /// Line number from 1.
    pub(crate) number: usize,
    /// Text without its line end.
    pub(crate) text: &'a str,
    /// Last line of the file, and without a line end: the file was probably cut in it.
    pub(crate) is_open: bool,
}

/// Columns `start..start + width` counted from 0, cut where the line ends.
pub(crate) fn columns(text: &str, start: usize, width: usize) -> &str {
    if text.is_ascii() {
        let end = (start + width).min(text.len());
        text.get(start.min(end)..end).unwrap_or("")
    } else {
        let byte = |column: usize| text.char_indices().nth(column).map_or(text.len(), |(i, _)| i);
        text.get(byte(start)..byte(start + width)).unwrap_or("")
    }
}

/// A text for an error message: at most 60 characters.
pub(crate) fn excerpt(text: &str) -> String {
    let text = text.trim();
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or("")),
        None => text.to_owned(),
    }
}

/// Whether a text may be a number that was cut, or nothing at all.
fn is_start_of_number(text: &str) -> bool {
    text.bytes()
        .all(|b| b.is_ascii_digit() || b"+-.eEdD".contains(&b))
}

impl<'a> Line<'a> {
    /// Place of this line, or of a column of it (from 0).
    pub(crate) fn at(&self, column: Option<usize>) -> Location {
        Location {
            file: self.file.to_owned(),
            line: self.number,
            column: column.map_or(0, |c| c + 1),
        }
    }

    /// The whole line is not what was expected.
    pub(crate) fn syntax(&self, expected: impl Into<String>) -> AvlError {
        let expected = expected.into();
        if self.is_open {
            return self.cut(expected);
        }
        AvlError::Syntax {
            at: self.at(None),
            found: excerpt(self.text),
            expected,
        }
    }

    /// The file ends in this line, before something.
    pub(crate) fn cut(&self, expected: String) -> AvlError {
        AvlError::Truncated {
            file: self.file.to_owned(),
            line: self.number,
            expected,
        }
    }

    /// A remark about this line.
    pub(crate) fn diagnostic(&self, keyword: &str, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            at: self.at(None),
            keyword: keyword.to_owned(),
            message: message.into(),
        }
    }

    /// Whether nothing is printed on the line.
    pub(crate) fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }

    /// Whether the line is a rule of dashes.
    pub(crate) fn is_rule(&self) -> bool {
        let text = self.text.trim();
        text.len() >= 20 && text.bytes().all(|b| b == b'-')
    }

    /// The number in columns `start..start + width` (from 0).
    pub(crate) fn real(&self, start: usize, width: usize, field: &str) -> Result<f64, AvlError> {
        self.parse_real(columns(self.text, start, width), start, field)
    }

    /// The whole number in columns `start..start + width` (from 0).
    pub(crate) fn integer(&self, start: usize, width: usize, field: &str) -> Result<usize, AvlError> {
        self.parse_integer(columns(self.text, start, width), start, field)
    }

    /// Reads a text found at a column as a number.
    pub(crate) fn parse_real(&self, text: &str, column: usize, field: &str) -> Result<f64, AvlError> {
        let found = text.trim();
        if let Some(value) = fortran::parse_real(found) {
            return Ok(value);
        }
        Err(self.bad_number(found, column, field, "a number"))
    }

    /// Reads a text found at a column as a whole number that is not negative.
    pub(crate) fn parse_integer(&self, text: &str, column: usize, field: &str) -> Result<usize, AvlError> {
        let found = text.trim();
        if let Ok(value) = found.parse::<u32>() {
            return Ok(value as usize);
        }
        Err(self.bad_number(found, column, field, "a whole number"))
    }

    /// The error for a text that should be a number.
    pub(crate) fn bad_number(
        &self,
        found: &str,
        column: usize,
        field: &str,
        expected: &'static str,
    ) -> AvlError {
        let (at, field, text) = (self.at(Some(column)), field.to_owned(), excerpt(found));
        if found.contains('*') {
            AvlError::Overflow {
                at,
                field,
                found: text,
            }
        } else if fortran::is_not_finite(found) {
            AvlError::NotFinite {
                at,
                field,
                found: text,
            }
        } else if self.is_open && self.text.trim_end().ends_with(found) && is_start_of_number(found) {
            self.cut(format!("the end of `{field}`"))
        } else {
            let found = if text.is_empty() {
                "(blank)".to_owned()
            } else {
                text
            };
            AvlError::Number {
                at,
                field,
                found,
                expected,
            }
        }
    }

    /// Column just after the `=` of `name =`, where the name stands alone.
    pub(crate) fn after_label(&self, name: &str) -> Option<usize> {
        let mut from = 0;
        while let Some(found) = self.text.get(from..).and_then(|t| t.find(name)) {
            let start = from + found;
            let end = start + name.len();
            let free = self
                .text
                .get(..start)
                .is_none_or(|t| t.is_empty() || t.ends_with([' ', '|', '(']));
            let tail = self.text.get(end..).unwrap_or("");
            let equals = tail.trim_start();
            if free && equals.starts_with('=') {
                return Some(end + (tail.len() - equals.len()) + 1);
            }
            from = end;
        }
        None
    }

    /// Field text of `width` columns at a byte offset after an `=`.
    ///
    /// A number that fills more than its columns (another version's format) is taken whole.
    fn field_text(&self, offset: usize, width: usize) -> &'a str {
        let tail = self.text.get(offset..).unwrap_or("");
        let cut = columns(tail, 0, width);
        let first = cut.split_whitespace().next().unwrap_or("");
        if cut.ends_with(first) && !first.is_empty() {
            tail.split_whitespace().next().unwrap_or("")
        } else {
            first
        }
    }

    /// The number after `name =`, if the label is on this line.
    pub(crate) fn labelled_real(&self, name: &str, width: usize) -> Option<Result<f64, AvlError>> {
        let offset = self.after_label(name)?;
        Some(self.parse_real(self.field_text(offset, width), offset, name))
    }

    /// The whole number after `name =`, if the label is on this line.
    pub(crate) fn labelled_integer(&self, name: &str, width: usize) -> Option<Result<usize, AvlError>> {
        let offset = self.after_label(name)?;
        Some(self.parse_integer(self.field_text(offset, width), offset, name))
    }

    /// The numbers of a table row.
    ///
    /// The row is read by column. A row whose points do not stand where the format puts them was re-spaced by
    /// another tool: it is then read by blanks, if the count is right.
    pub(crate) fn row(&self, start: usize, fields: &[Field]) -> Result<Vec<f64>, AvlError> {
        let misplaced = self.misplaced_point(start, fields);
        if misplaced.is_some() {
            let tail = self.text.get(start.min(self.text.len())..).unwrap_or(self.text);
            let words: Vec<&str> = tail.split_whitespace().take(fields.len() + 1).collect();
            if words.len() == fields.len() {
                return words
                    .iter()
                    .zip(fields)
                    .map(|(w, f)| self.parse_real(w, start, f.name))
                    .collect();
            }
        }
        let mut column = start;
        let mut out = Vec::with_capacity(fields.len());
        for field in fields {
            column += field.skip;
            out.push(self.real(column, field.width, field.name)?);
            column += field.width;
        }
        match misplaced {
            None => Ok(out),
            Some(field) => Err(self.syntax(format!(
                "`{}` with its decimal point where AVL prints it, or all numbers apart",
                field.name
            ))),
        }
    }

    /// A row number in columns `start..start + width`, then the numbers of the row. As [`Line::row`].
    pub(crate) fn indexed_row(
        &self,
        name: &str,
        start: usize,
        width: usize,
        fields: &[Field],
    ) -> Result<(usize, Vec<f64>), AvlError> {
        let after = start + width;
        if self.misplaced_point(after, fields).is_some() {
            let words: Vec<&str> = self.text.split_whitespace().take(fields.len() + 2).collect();
            if let Some((index, numbers)) = words.split_first()
                && numbers.len() == fields.len()
            {
                let index = self.parse_integer(index, 0, name)?;
                let row = numbers
                    .iter()
                    .zip(fields)
                    .map(|(w, f)| self.parse_real(w, start, f.name));
                return Ok((index, row.collect::<Result<_, _>>()?));
            }
        }
        Ok((self.integer(start, width, name)?, self.row(after, fields)?))
    }

    /// The first `Fw.d` field whose point does not stand in its column, or that has something before it.
    fn misplaced_point<'f>(&self, start: usize, fields: &'f [Field]) -> Option<&'f Field> {
        let mut column = start;
        fields.iter().find(|field| {
            let blank = columns(self.text, column, field.skip).trim().is_empty();
            column += field.skip;
            let text = columns(self.text, column, field.width);
            column += field.width;
            let point = field.decimals.and_then(|d| field.width.checked_sub(d + 1));
            let placed = point.is_none_or(|p| columns(text, p, 1) == ".");
            !(blank && (placed || text.contains('*') || text.trim().is_empty()))
        })
    }
}

/// One field of a table row: blanks before it, width, decimals of an `F` format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// Name as AVL heads the column.
    pub(crate) name: &'static str,
    /// Blanks before the field.
    pub(crate) skip: usize,
    /// Width.
    pub(crate) width: usize,
    /// Decimals, for `F` formats.
    pub(crate) decimals: Option<usize>,
}

/// `nX,Fw.d`.
pub(crate) const fn f(name: &'static str, skip: usize, width: usize, decimals: usize) -> Field {
    Field {
        name,
        skip,
        width,
        decimals: Some(decimals),
    }
}

/// `nX,Gw.d`.
pub(crate) const fn g(name: &'static str, skip: usize, width: usize) -> Field {
    Field {
        name,
        skip,
        width,
        decimals: None,
    }
}

/// All lines of a file, with a reading position.
#[derive(Clone, Debug)]
pub(crate) struct Source<'a> {
    /// File name.
    pub(crate) file: &'a str,
    lines: Vec<&'a str>,
    next: usize,
    is_open: bool,
}

impl<'a> Source<'a> {
    /// Cuts a text into lines.
    pub(crate) fn new(text: &'a str, file: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self {
            file,
            lines: text.lines().collect(),
            next: 0,
            is_open: !text.ends_with('\n'),
        }
    }

    /// Number of lines.
    pub(crate) fn len(&self) -> usize {
        self.lines.len()
    }

    /// Line by index from 0.
    pub(crate) fn line(&self, index: usize) -> Option<Line<'a>> {
        let is_open = self.is_open && index + 1 == self.lines.len();
        self.lines.get(index).map(|&text| Line {
            file: self.file,
            number: index + 1,
            text,
            is_open,
        })
    }

    /// All lines.
    pub(crate) fn lines(&self) -> impl Iterator<Item = Line<'a>> + '_ {
        (0..self.lines.len()).filter_map(|i| self.line(i))
    }

    /// Index of the next line to be read.
    pub(crate) fn position(&self) -> usize {
        self.next
    }

    /// Reads on from a line index.
    pub(crate) fn seek(&mut self, index: usize) {
        self.next = index;
    }

    /// The next line, without reading it.
    pub(crate) fn peek(&self) -> Option<Line<'a>> {
        self.line(self.next)
    }

    /// Reads the next line.
    pub(crate) fn read(&mut self) -> Option<Line<'a>> {
        let line = self.peek();
        if line.is_some() {
            self.next += 1;
        }
        line
    }

    /// Reads the next line; the file must have one.
    pub(crate) fn require(&mut self, expected: &str) -> Result<Line<'a>, AvlError> {
        self.read().ok_or_else(|| self.truncated(expected))
    }

    /// Reads on to the next line with something on it.
    pub(crate) fn require_text(&mut self, expected: &str) -> Result<Line<'a>, AvlError> {
        loop {
            let line = self.require(expected)?;
            if !line.is_blank() {
                return Ok(line);
            }
        }
    }

    /// Reads on to the first line that contains a text.
    pub(crate) fn find(&mut self, text: &str) -> Result<Line<'a>, AvlError> {
        loop {
            let line = self.require(&format!("`{text}`"))?;
            if line.text.contains(text) {
                return Ok(line);
            }
        }
    }

    /// Reads on to the first line with all labels, and gives their numbers, each `width` columns wide.
    pub(crate) fn find_reals<const N: usize>(
        &mut self,
        labels: [(&str, usize); N],
    ) -> Result<[f64; N], AvlError> {
        let first = labels.first().map_or("", |l| l.0);
        loop {
            let line = self.require(&format!("`{first} =`"))?;
            if line.after_label(first).is_some() {
                return line_reals(&line, labels);
            }
        }
    }

    /// Refuses a last line that ends before a column: it was cut inside a number.
    pub(crate) fn refuse_cut(&self, line: &Line<'_>, end: usize, expected: &str) -> Result<(), AvlError> {
        let is_last = self.lines.iter().skip(line.number).all(|l| l.trim().is_empty());
        if is_last && line.text.trim_end().len() < end {
            return Err(self.truncated(expected));
        }
        Ok(())
    }

    /// The file ended before something.
    pub(crate) fn truncated(&self, expected: &str) -> AvlError {
        AvlError::Truncated {
            file: self.file.to_owned(),
            line: self.len(),
            expected: expected.to_owned(),
        }
    }
}

/// The numbers after several labels of one line.
pub(crate) fn line_reals<const N: usize>(
    line: &Line<'_>,
    labels: [(&str, usize); N],
) -> Result<[f64; N], AvlError> {
    let mut out = [0.0; N];
    for (value, (name, width)) in out.iter_mut().zip(labels) {
        *value = line
            .labelled_real(name, width)
            .unwrap_or_else(|| Err(line.syntax(format!("`{name} =`"))))?;
    }
    Ok(out)
}
