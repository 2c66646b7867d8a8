//! How a card is laid out: fields as text, reals as short as they can be, small field where everything fits.

use crate::error::Error;
use crate::number;

/// A card under construction: its name and the text of its fields.
#[derive(Debug)]
pub(super) struct CardText {
    name: String,
    fields: Vec<String>,
    problem: Option<String>,
}

impl CardText {
    pub(super) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            fields: Vec::with_capacity(16),
            problem: None,
        }
    }

    pub(super) fn text(mut self, text: impl Into<String>) -> Self {
        self.fields.push(text.into());
        self
    }

    pub(super) fn blank(self) -> Self {
        self.text("")
    }

    pub(super) fn blanks(self, count: usize) -> Self {
        (0..count).fold(self, |card, _| card.blank())
    }

    pub(super) fn number(self, value: impl ToString) -> Self {
        self.text(value.to_string())
    }

    pub(super) fn optional<T: ToString>(self, value: Option<T>) -> Self {
        match value {
            Some(value) => self.number(value),
            None => self.blank(),
        }
    }

    pub(super) fn real(mut self, value: f64) -> Self {
        if !value.is_finite() {
            self.problem
                .get_or_insert_with(|| format!("the value {value} cannot be written; it must be finite"));
        }
        self.text(real_text(value))
    }

    pub(super) fn optional_real(self, value: Option<f64>) -> Self {
        match value {
            Some(value) => self.real(value),
            None => self.blank(),
        }
    }

    pub(super) fn reals<'v>(self, values: impl IntoIterator<Item = &'v f64>) -> Self {
        values.into_iter().fold(self, |card, &value| card.real(value))
    }

    pub(super) fn optional_reals<'v>(self, values: impl IntoIterator<Item = &'v Option<f64>>) -> Self {
        values
            .into_iter()
            .fold(self, |card, &value| card.optional_real(value))
    }

    pub(super) fn numbers<'v>(self, values: impl IntoIterator<Item = &'v u32>) -> Self {
        values.into_iter().fold(self, |card, value| card.number(value))
    }

    /// Blanks up to the end of the line of eight fields.
    pub(super) fn end_line(self) -> Self {
        let missing = self.fields.len().next_multiple_of(8) - self.fields.len();
        self.blanks(missing)
    }

    /// Appends the card to a deck.
    pub(super) fn write(mut self, out: &mut String) -> Result<(), Error> {
        if let Some(problem) = self.problem {
            let id = self.fields.first().map_or("", String::as_str);
            return Err(Error::Unwritable {
                card: format!("{} {id}", self.name),
                problem,
            });
        }
        while self.fields.last().is_some_and(String::is_empty) {
            self.fields.pop();
        }
        let longest = self.fields.iter().map(String::len).max().unwrap_or(0);
        if longest <= 8 && self.name.len() <= 8 {
            fixed(&self.name, &self.fields, 8, out);
        } else if longest <= 16 && self.name.len() <= 7 {
            fixed(&self.name, &self.fields, 16, out);
        } else if self.fields.iter().all(|f| !f.contains([',', '$'])) {
            free(&self.name, &self.fields, out);
        } else {
            return Err(Error::Unwritable {
                card: self.name,
                problem:
                    "a field is longer than 16 characters and has a comma or $; no field format holds it"
                        .into(),
            });
        }
        Ok(())
    }
}

/// Fields of 8 or 16 columns. Large-field lines come in pairs, which is what all programs accept.
fn fixed(name: &str, fields: &[String], width: usize, out: &mut String) {
    let (first, next) = if width == 8 {
        (name.to_owned(), "+")
    } else {
        (format!("{name}*"), "*")
    };
    let per_line = 64 / width;
    let lines = fields.len().div_ceil(8).max(1) * 8 / per_line;
    for line in 0..lines {
        let start = out.len();
        out.push_str(if line == 0 { &first } else { next });
        for (k, field) in fields.iter().skip(line * per_line).take(per_line).enumerate() {
            if field.is_empty() {
                continue;
            }
            // Numbers to the right, as they are easier to compare; the name's field is 8 wide.
            let column = start + 8 + (k + 1) * width - field.len();
            out.extend(std::iter::repeat_n(' ', column - out.len()));
            out.push_str(field);
        }
        out.push('\n');
    }
}

/// Free field, for uninterpreted cards with longer texts. Every line has its mark, so that no datum is taken for one.
fn free(name: &str, fields: &[String], out: &mut String) {
    let lines = fields.len().div_ceil(8);
    for (k, line) in fields.chunks(8).enumerate() {
        out.push_str(if k == 0 { name } else { "+" });
        for field in line {
            out.push(',');
            out.push_str(field);
        }
        if k + 1 < lines || line.last().is_some_and(|f| f.starts_with(['+', '*'])) {
            out.extend(std::iter::repeat_n(',', 9 - line.len()));
            out.push('+');
        }
        out.push('\n');
    }
}

/// The shortest text of at most 16 characters that reads back as the value; if there is none, the one with the most
/// digits that fit.
pub(super) fn real_text(value: f64) -> String {
    let exact = shortest_form(&format!("{value:e}"));
    if exact.len() <= 16 {
        return exact;
    }
    let fitting = |value: f64| {
        (0..16)
            .rev()
            .map(|digits| shortest_form(&format!("{value:.digits$e}")))
            .find(|text| text.len() <= 16 && number::real(text.as_bytes()).is_some())
    };
    // Rounding may go beyond the largest number; then towards zero.
    fitting(value)
        .or_else(|| fitting(value * (1.0 - 1e-9)))
        .unwrap_or(exact)
}

/// The shorter of positional and exponent form of a number in Rust's `{:e}` form.
fn shortest_form(scientific: &str) -> String {
    let (sign, unsigned) = match scientific.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", scientific),
    };
    let (mantissa, exponent) = unsigned.split_once('e').unwrap_or((unsigned, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = match digits.trim_end_matches('0') {
        "" => return format!("{sign}0."),
        digits => digits,
    };
    let (lead, rest) = digits.split_at(1);
    let powered = format!("{sign}{lead}.{rest}{exponent:+}");
    let count = i32::try_from(digits.len()).unwrap_or(i32::MAX);
    let positional = if (0..16).contains(&exponent) {
        let whole = usize::try_from(exponent).unwrap_or(0) + 1;
        if count > exponent {
            let (whole, fraction) = digits.split_at(whole);
            format!("{sign}{whole}.{fraction}")
        } else {
            format!("{sign}{digits:0<whole$}.")
        }
    } else if (-6..0).contains(&exponent) {
        let zeros = usize::try_from(-exponent - 1).unwrap_or(0);
        format!("{sign}.{}{digits}", "0".repeat(zeros))
    } else {
        return powered;
    };
    if positional.len() <= powered.len() {
        positional
    } else {
        powered
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_are_short_and_have_a_point() {
        for (value, text) in [
            (0.0, "0."),
            (-0.0, "-0."),
            (1.0, "1."),
            (-2.5, "-2.5"),
            (0.00118, ".00118"),
            (7e10, "7.+10"),
            (1.5e-12, "1.5-12"),
            (123_456.0, "123456."),
            (1e5, "1.+5"),
            (16.976_64, "16.97664"),
            (-1.234_567_890_123_456_7e-105, "-1.23456789-105"),
        ] {
            assert_eq!(real_text(value), text);
        }
        for value in [
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            0.1 + 0.2,
            1.0 / 3.0,
        ] {
            let text = real_text(value);
            assert!(text.len() <= 16 && text.contains('.'), "{text}");
            let back = number::real(text.as_bytes()).unwrap();
            assert!((back - value).abs() <= 1e-8 * value.abs(), "{text}");
        }
    }

    #[test]
    fn layouts() {
        let written = |card: CardText| {
            let mut out = String::new();
            card.write(&mut out).unwrap();
            out
        };
        assert_eq!(
            written(CardText::new("GRID").number(7).blank().real(1.5)),
            "GRID           7             1.5\n"
        );
        let long = CardText::new("GRID")
            .number(7)
            .blank()
            .real(1.0 / 3.0)
            .blank()
            .real(2.0);
        assert_eq!(
            written(long),
            "GRID*                  7                .333333333333333\n*                     2.\n"
                .replace(".333333333333333", &real_text(1.0 / 3.0))
        );
        assert!(matches!(
            CardText::new("GRID")
                .number(7)
                .real(f64::NAN)
                .write(&mut String::new()),
            Err(Error::Unwritable { .. })
        ));
    }
}
