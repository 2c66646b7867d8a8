//! Lines of a geometry file as AVL takes them: comments dropped, numbers read in one of two ways.

use crate::error::{AvlError, Diagnostic};
use crate::fortran::{Item, is_not_finite, items};
use crate::source::{Line, Source};

/// A line with something on it, without leading blanks and without what follows `!`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record<'a> {
    /// The line as it is.
    pub(super) line: Line<'a>,
    /// What counts.
    pub(super) text: &'a str,
}

impl Record<'_> {
    /// An indented comment: AVL takes only `!` and `#` in the first column for one.
    fn is_indented_comment(&self) -> bool {
        self.text.starts_with(['!', '#'])
    }
}

/// How AVL reads the numbers of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// Fortran's list-directed input: blanks, tabs, commas, `3*0.`; what follows the last number is ignored.
    List,
    /// AVL's own routine: words between blanks and commas, as many as are wanted, all of them numbers.
    Words,
}

/// Reads records and collects remarks.
pub(super) struct Records<'a> {
    source: Source<'a>,
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl<'a> Records<'a> {
    pub(super) fn new(text: &'a str, file: &'a str) -> Self {
        Self {
            source: Source::new(text, file),
            diagnostics: Vec::new(),
        }
    }

    /// The next record.
    pub(super) fn read(&mut self) -> Option<Record<'a>> {
        loop {
            let line = self.source.read()?;
            if line.is_blank() || line.text.starts_with(['!', '#']) {
                continue;
            }
            let text = line.text.trim();
            let text = match text.find('!') {
                Some(end) if end > 0 => text.get(..end).unwrap_or(text).trim_end(),
                _ => text,
            };
            return Some(Record { line, text });
        }
    }

    /// The next record, whatever it is; the file must have one.
    pub(super) fn require(&mut self, expected: &str) -> Result<Record<'a>, AvlError> {
        self.read().ok_or_else(|| self.source.truncated(expected))
    }

    /// The next record with data: indented comments are passed over with a remark.
    pub(super) fn data(&mut self, keyword: &str, expected: &str) -> Result<Record<'a>, AvlError> {
        loop {
            let record = self.require(expected)?;
            if !record.is_indented_comment() {
                return Ok(record);
            }
            let message = "indented comment where data is expected: AVL knows comments by `!` or `#` in the first \
                           column and would read this line as data";
            self.remark(&record, keyword, message);
        }
    }

    /// Makes a remark.
    pub(super) fn remark(&mut self, record: &Record<'_>, keyword: &str, message: impl Into<String>) {
        self.diagnostics.push(record.line.diagnostic(keyword, message));
    }

    /// From `least` to `most` numbers at the start of a text that belongs to a record.
    pub(super) fn numbers(
        &mut self,
        record: &Record<'_>,
        text: &str,
        keyword: &str,
        (least, most): (usize, usize),
        style: Style,
    ) -> Result<Vec<f64>, AvlError> {
        if has_empty_value(text, most) {
            return Err(record
                .line
                .syntax("a number between two commas (AVL would keep an old value there)"));
        }
        let mut out = Vec::with_capacity(most);
        let mut has_repeats = false;
        for item in items(text) {
            if out.len() >= most {
                break;
            }
            match item {
                Item::Number { value, repeat, .. } => {
                    has_repeats |= repeat > 1;
                    out.extend(std::iter::repeat_n(value, repeat.min(most - out.len())));
                }
                Item::Word(word) if out.len() < least || is_no_number(word) => {
                    let column = record.line.text.find(word).unwrap_or(0);
                    return Err(record.line.bad_number(word, column, keyword, "a number"));
                }
                Item::Word(word) => {
                    if style == Style::Words {
                        let message = format!(
                            "`{word}` stands where AVL looks for an optional number: AVL stops here with `Read error`; \
                             put `!` before it"
                        );
                        self.remark(record, keyword, message);
                    }
                    break;
                }
            }
        }
        if out.len() < least {
            let expected = format!("{least} numbers for {keyword}, found {}", out.len());
            return Err(record.line.syntax(expected));
        }
        if style == Style::Words && (has_repeats || text.trim_end().contains('\t')) {
            let what = if has_repeats {
                "repeat counts (`3*0.`)"
            } else {
                "tabs between the numbers"
            };
            self.remark(
                record,
                keyword,
                format!("{what}: AVL stops here with `Read error`; use blanks"),
            );
        }
        Ok(out)
    }

    /// Exactly `N` numbers of the next record.
    pub(super) fn reals<const N: usize>(&mut self, keyword: &str, names: &str) -> Result<[f64; N], AvlError> {
        let record = self.data(keyword, names)?;
        let numbers = self.numbers(&record, record.text, names, (N, N), Style::List)?;
        numbers
            .try_into()
            .map_err(|_| record.line.syntax(format!("{N} numbers for {names}")))
    }

    /// A whole number: AVL reads it as an integer and fails on a decimal point.
    pub(super) fn whole(&mut self, record: &Record<'_>, keyword: &str, value: f64) -> Result<i32, AvlError> {
        const MOST: f64 = 1e6;
        if value.fract() != 0.0 || value.abs() > MOST {
            return Err(record
                .line
                .syntax(format!("a whole number for {keyword}, not {value}")));
        }
        // In range by the check above.
        Ok(value as i32)
    }

    /// A number of elements: AVL adds 0.001 and cuts.
    pub(super) fn count(record: &Record<'_>, keyword: &str, value: f64) -> Result<usize, AvlError> {
        const MOST: f64 = 1e6;
        if (-0.001..MOST).contains(&value) {
            // Not negative and in range by the check above.
            Ok((value + 0.001) as usize)
        } else {
            Err(record
                .line
                .syntax(format!("a number of elements for {keyword}, not {value}")))
        }
    }
}

/// Whether a word is what programs print in the place of a number that is none: `NaN`, `inf`, stars. Where a number may
/// stand it is never a remark.
fn is_no_number(word: &str) -> bool {
    is_not_finite(word) || (!word.is_empty() && word.bytes().all(|b| b == b'*'))
}

/// Whether one of the first `most` values is left empty between commas.
fn has_empty_value(text: &str, most: usize) -> bool {
    let mut before = 0;
    let mut parts = text.split(',').peekable();
    while let Some(part) = parts.next() {
        if part.trim().is_empty() && parts.peek().is_some() && before < most {
            return true;
        }
        let found = items(part);
        if found.iter().any(|item| matches!(item, Item::Word(_))) {
            return false;
        }
        before += found.len();
    }
    false
}
