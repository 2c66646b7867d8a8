//! Keywords of a section: aerofoil, lift slope, controls, design variables.

use super::read::Reader;
use super::records::{Record, Style};
use super::{Airfoil, Control, Design};
use crate::error::AvlError;
use crate::fortran::{Item, items, parse_real};

/// Characters that AVL keeps of a control's or design variable's name.
const NAME_LENGTH: usize = 16;

/// Text between double quotes, or the whole text; and what follows the closing quote.
pub(super) fn unquoted<'t>(
    record: &Record<'_>,
    text: &'t str,
) -> Result<(String, Option<&'t str>), AvlError> {
    let Some((_, rest)) = text.split_once('"') else {
        return Ok((text.to_owned(), None));
    };
    match rest.split_once('"') {
        Some((name, tail)) if !name.is_empty() => Ok((name.to_owned(), Some(tail))),
        _ => Err(record.line.syntax("a file name between two double quotes")),
    }
}

/// First word and the rest of a text.
fn first_word(text: &str) -> (&str, &str) {
    text.split_once(char::is_whitespace).unwrap_or((text, ""))
}

/// Range of x/c, cut to 0 and 1 as AVL does.
fn x_range(numbers: &[f64]) -> Option<[f64; 2]> {
    match *numbers {
        [from, to, ..] => Some([from.max(0.0), to.min(1.0)]),
        _ => None,
    }
}

impl<'a> Reader<'a> {
    /// The x/c range behind a keyword: `AFILE 0.0 1.0`.
    fn keyword_range(&mut self, record: &Record<'a>, keyword: &str) -> Option<[f64; 2]> {
        let range = leading_numbers(first_word(record.text).1);
        let range = x_range(&range)?;
        let message =
            "AVL up to 3.35 reads the x/c range behind the file name or digits and ignores this one";
        self.records.remark(record, keyword, message);
        Some(range)
    }

    /// The x/c range behind a file name or digits.
    fn data_range(&mut self, record: &Record<'a>, keyword: &str, text: &str) -> Option<[f64; 2]> {
        let range = x_range(&leading_numbers(text))?;
        let message = "AVL since 3.40 reads the x/c range behind the keyword and ignores this one";
        self.records.remark(record, keyword, message);
        Some(range)
    }

    fn set_airfoil(&mut self, airfoil: Airfoil) {
        if let Some(section) = self.section() {
            section.airfoil = airfoil;
        }
    }

    /// `NACA`: four digits on the next line.
    pub(super) fn naca(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let range = self.keyword_range(record, "NACA");
        let line = self.records.data("NACA", "the four digits of the NACA section")?;
        let end = line
            .text
            .find([' ', '\t', ',', '/', ';'])
            .unwrap_or(line.text.len());
        let (digits, rest) = line.text.split_at_checked(end).unwrap_or((line.text, ""));
        if digits.is_empty() || digits.len() > 9 || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return Err(line
                .line
                .syntax("the digits of the NACA section, on the line below the keyword"));
        }
        if digits.len() > 4 {
            let message = format!("AVL knows the 4-digit family only and takes {digits} for a member of it");
            self.records.remark(&line, "NACA", message);
        }
        let data_range = self.data_range(&line, "NACA", rest);
        self.set_airfoil(Airfoil::Naca {
            digits: digits.to_owned(),
            x_range: range.or(data_range),
        });
        Ok(())
    }

    /// `AIRFOIL`: lines of x/c and y/c, ended by the first line that is not two numbers.
    pub(super) fn inline_airfoil(&mut self, record: &Record<'a>) -> Result<Option<Record<'a>>, AvlError> {
        let x_range = self.keyword_range(record, "AIRFOIL");
        let message = "AVL up to 3.35 stops on coordinates in the geometry file (`End of file`); write them to a file \
                       and name it with AFILE";
        self.records.remark(record, "AIRFOIL", message);
        let mut points = Vec::new();
        let next = loop {
            let Some(line) = self.records.read() else {
                break None;
            };
            match *leading_numbers(line.text).as_slice() {
                [x, y, ..] => points.push([x, y]),
                _ => break Some(line),
            }
        };
        if points.len() < 3 {
            return Err(record
                .line
                .syntax(format!("three coordinate lines or more, found {}", points.len())));
        }
        self.set_airfoil(Airfoil::Inline { points, x_range });
        Ok(next)
    }

    /// `AFILE`: file name on the next line, in double quotes if it has blanks.
    pub(super) fn airfoil_file(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let keyword_range = self.keyword_range(record, "AFILE");
        let line = self.records.require("the name of the aerofoil file")?;
        let (mut path, tail) = unquoted(&line, line.text)?;
        let mut range = None;
        if let Some(tail) = tail {
            range = self.data_range(&line, "AFILE", tail);
        } else if let Some((name, numbers)) = name_and_range(line.text) {
            range = self.data_range(&line, "AFILE", numbers);
            path = name.to_owned();
        } else if path.contains(char::is_whitespace) {
            let message =
                "a file name with blanks and without double quotes: AVL up to 3.35 takes the first word only";
            self.records.remark(&line, "AFILE", message);
        }
        self.set_airfoil(Airfoil::File {
            path,
            x_range: keyword_range.or(range),
        });
        Ok(())
    }

    /// `CLAF`: lift slope over 2 pi.
    pub(super) fn claf(&mut self, record: &Record<'a>) -> Result<(), AvlError> {
        let [mut claf] = self.records.reals("CLAF", "CLaf")?;
        if claf <= 0.0 || claf >= 2.0 {
            let message = format!("{claf} is not between 0 and 2: AVL takes 1, and so do we");
            self.records.remark(record, "CLAF", message);
            claf = 1.0;
        }
        if let Some(section) = self.section() {
            section.claf = claf;
        }
        Ok(())
    }

    /// Name and numbers of a `CONTROL` or `DESIGN` line.
    fn named_numbers(
        &mut self,
        keyword: &str,
        names: &str,
        most: usize,
    ) -> Result<(Record<'a>, String, Vec<f64>), AvlError> {
        let line = self.records.data(keyword, names)?;
        let (word, rest) = first_word(line.text);
        if word.len() < line.text.len() && !line.text.get(word.len()..).unwrap_or("").starts_with(' ') {
            self.records.remark(
                &line,
                keyword,
                "a tab behind the name: AVL ends names at a blank only",
            );
        }
        let name: String = word.chars().take(NAME_LENGTH).collect();
        if name.len() < word.len() {
            self.records.remark(
                &line,
                keyword,
                format!("`{word}` is cut to 16 characters: `{name}`"),
            );
        }
        let numbers = self
            .records
            .numbers(&line, rest, names, (0, most), Style::Words)?;
        Ok((line, name, numbers))
    }

    /// `CONTROL`: name, gain, hinge x/c, hinge axis, sign of the mirrored deflection.
    pub(super) fn control(&mut self, _: &Record<'a>) -> Result<(), AvlError> {
        let (line, name, numbers) = self.named_numbers("CONTROL", "name gain Xhinge XYZhvec SgnDup", 6)?;
        let value = |i: usize, default: f64| numbers.get(i).copied().unwrap_or(default);
        let hinge_axis = if numbers.len() >= 5 {
            [2, 3, 4].map(|i| value(i, 0.0))
        } else {
            [0.0; 3]
        };
        let control = Control {
            gain: value(0, 1.0),
            x_hinge: value(1, 0.0),
            hinge_axis,
            sgn_dup: value(5, 1.0),
            name: name.clone(),
        };
        if !self.control_names.contains_key(&name) {
            let longer = self.control_names.range(name.clone()..);
            let longer = longer.take_while(|(known, _)| known.starts_with(&name));
            if let Some((first, _)) = longer.min_by_key(|(_, place)| **place) {
                let message =
                    format!("AVL up to 3.40 takes `{name}` for `{first}`, whose first letters are the same");
                self.records.remark(&line, "CONTROL", message);
            }
            self.control_names.insert(name, self.control_names.len());
        }
        if let Some(section) = self.section() {
            section.controls.push(control);
        }
        Ok(())
    }

    /// `DESIGN`: name, weight.
    pub(super) fn design(&mut self, _: &Record<'a>) -> Result<(), AvlError> {
        let (_, name, numbers) = self.named_numbers("DESIGN", "name weight", 1)?;
        let design = Design {
            name,
            weight: numbers.first().copied().unwrap_or(1.0),
        };
        if let Some(section) = self.section() {
            section.designs.push(design);
        }
        Ok(())
    }
}

/// The two numbers at the start of a text, if there are two.
fn leading_numbers(text: &str) -> Vec<f64> {
    let numbers = items(text).into_iter().map_while(|item| match item {
        Item::Number { value, repeat: 1, .. } => Some(value),
        _ => None,
    });
    numbers.take(2).collect()
}

/// `wing root.dat 0.1 0.9`: file name and the two numbers behind it.
fn name_and_range(text: &str) -> Option<(&str, &str)> {
    let (head, last) = text.rsplit_once(char::is_whitespace)?;
    let (name, first) = head.trim_end().rsplit_once(char::is_whitespace)?;
    parse_real(first).and(parse_real(last))?;
    Some((name.trim_end(), text.get(name.len()..)?))
}
