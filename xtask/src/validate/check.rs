//! `--check`: fresh results against those kept in the repository.
//!
//! | file | compared |
//! |---|---|
//! | JSON | every value; numbers to [`RELATIVE`] with the floor [`FLOOR`] |
//! | CSV | word by word; numbers as in JSON |
//! | Markdown | word by word outside measured blocks; numbers to one unit of their last printed place |
//! | SVG | the texts; curves are drawn from the same numbers |
//!
//! Tables of measured times are left out, but must be there. Numbers at which an iterative search ends are compared to
//! [`RELATIVE_ITERATED`] with the floor [`FLOOR_ITERATED`]: rounding, which differs between processors, moves the point
//! at which the search is content. Directories are left out.

use crate::error::Error;
use crate::workspace;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// Largest relative difference of two numbers that count as equal.
pub(crate) const RELATIVE: f64 = 1e-6;
/// Largest absolute difference of two numbers that count as equal however small they are.
pub(crate) const FLOOR: f64 = 1e-9;
/// The same for numbers at which an iterative search ends.
pub(crate) const RELATIVE_ITERATED: f64 = 1e-2;
/// Their floor.
pub(crate) const FLOOR_ITERATED: f64 = 1e-2;

/// Start of a block of the page that no other run repeats.
pub(crate) const MEASURED: &str = "<!-- measured: left out of the comparison -->";
/// Its end.
pub(crate) const END_OF_MEASURED: &str = "<!-- end of measured -->";
/// Start of a block of the page with numbers at which an iterative search ends.
pub(crate) const ITERATED_BLOCK: &str = "<!-- iterated: compared loosely -->";
/// Its end.
pub(crate) const END_OF_ITERATED: &str = "<!-- end of iterated -->";

/// Numbers that no other run repeats to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Times of the machine at hand.
    Measured,
    /// Ends of an iterative search.
    Iterated,
}

/// Compares two directories of results; `kinds` are the stems of files with numbers of a special kind. Directories
/// within them are left out. Returns a line for each difference.
pub(crate) fn compare(fresh: &Path, kept: &Path, kinds: &[(&str, Kind)]) -> Result<Vec<String>, Error> {
    let (new, old) = (names(fresh)?, names(kept)?);
    let mut differences: Vec<String> = new
        .difference(&old)
        .map(|name| format!("{name}: is missing"))
        .collect();
    differences.extend(
        old.difference(&new)
            .map(|name| format!("{name}: is no longer written")),
    );
    for name in new.intersection(&old) {
        let (stem, kind) = name.rsplit_once('.').unwrap_or((name, ""));
        let kind_of = kinds
            .iter()
            .find(|(known, _)| *known == stem)
            .map(|(_, kind)| *kind);
        let tolerance = match kind_of {
            Some(Kind::Measured) => continue,
            Some(Kind::Iterated) => ITERATED,
            None => ROUNDING,
        };
        let (fresh, kept) = (
            workspace::read(&fresh.join(name))?,
            workspace::read(&kept.join(name))?,
        );
        let found = match kind {
            "json" => {
                let parse = |text: &str| serde_json::from_str::<Value>(text);
                match (parse(&fresh), parse(&kept)) {
                    (Ok(fresh), Ok(kept)) => values(&fresh, &kept, tolerance),
                    (_, Err(e)) => vec![format!("is not JSON: {e}")],
                    (Err(e), _) => vec![format!("fresh file is not JSON: {e}")],
                }
            }
            "svg" => differences_of_drawings(&fresh, &kept),
            "csv" => words(&fresh, &kept, |new, old, _| tolerance.holds(new, old)),
            _ => {
                let (fresh, kept) = (Page::split(&fresh), Page::split(&kept));
                let mut found = words(&fresh.plain, &kept.plain, in_last_place);
                found.extend(words(&fresh.iterated, &kept.iterated, |new, old, decimals| {
                    in_last_place(new, old, decimals) || ITERATED.holds(new, old)
                }));
                found
            }
        };
        differences.extend(found.into_iter().map(|what| format!("{name}: {what}")));
    }
    Ok(differences)
}

fn names(directory: &Path) -> Result<BTreeSet<String>, Error> {
    let entries = std::fs::read_dir(directory).map_err(Error::file(directory))?;
    let mut found = BTreeSet::new();
    for entry in entries {
        let entry = entry.map_err(Error::file(directory))?;
        if !entry.path().is_dir() {
            found.insert(entry.file_name().to_string_lossy().into_owned());
        }
    }
    Ok(found)
}

/// How far two numbers may be apart that count as equal.
#[derive(Debug, Clone, Copy)]
struct Tolerance {
    relative: f64,
    floor: f64,
}

/// Of numbers that differ by rounding.
const ROUNDING: Tolerance = Tolerance {
    relative: RELATIVE,
    floor: FLOOR,
};
/// Of numbers at which an iterative search ends.
const ITERATED: Tolerance = Tolerance {
    relative: RELATIVE_ITERATED,
    floor: FLOOR_ITERATED,
};

impl Tolerance {
    fn holds(self, new: f64, old: f64) -> bool {
        new == old || (new - old).abs() <= self.floor.max(self.relative * new.abs().max(old.abs()))
    }
}

/// Differences of two JSON values, each with the path to it.
fn values(new: &Value, old: &Value, tolerance: Tolerance) -> Vec<String> {
    let mut found = Vec::new();
    walk("", (new, old), tolerance, &mut found);
    found
}

fn walk(path: &str, pair: (&Value, &Value), tolerance: Tolerance, found: &mut Vec<String>) {
    match pair {
        (Value::Object(new), Value::Object(old)) => {
            for (key, value) in new {
                match old.get(key) {
                    Some(other) => walk(&format!("{path}/{key}"), (value, other), tolerance, found),
                    None => found.push(format!("{path}/{key} is missing")),
                }
            }
            for key in old.keys().filter(|key| !new.contains_key(*key)) {
                found.push(format!("{path}/{key} is no longer written"));
            }
        }
        (Value::Array(new), Value::Array(old)) => {
            if new.len() != old.len() {
                found.push(format!("{path} has {} entries, now {}", old.len(), new.len()));
            }
            for (index, (new, old)) in new.iter().zip(old).enumerate() {
                walk(&format!("{path}/{index}"), (new, old), tolerance, found);
            }
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap_or(f64::NAN), b.as_f64().unwrap_or(f64::NAN));
            if !tolerance.holds(a, b) {
                found.push(format!("{path} is {b}, now {a}"));
            }
        }
        (new, old) if new == old => {}
        (new, old) => found.push(format!("{path} is {old}, now {new}")),
    }
}

/// A page without its measured blocks.
#[derive(Debug, PartialEq)]
struct Page {
    /// What is compared to the last place.
    plain: String,
    /// The blocks of iterated numbers.
    iterated: String,
}

impl Page {
    fn split(text: &str) -> Self {
        let (mut plain, mut iterated) = (String::new(), String::new());
        let (mut in_measured, mut in_iterated) = (false, false);
        for line in text.lines() {
            let mark = line.trim();
            in_measured |= mark == MEASURED;
            in_iterated |= mark == ITERATED_BLOCK;
            if !in_measured {
                let kept = if in_iterated { &mut iterated } else { &mut plain };
                kept.push_str(line);
                kept.push('\n');
            }
            in_measured &= mark != END_OF_MEASURED;
            in_iterated &= mark != END_OF_ITERATED;
        }
        Self { plain, iterated }
    }
}

/// What an SVG document says in words, a line for each text.
fn svg_texts(svg: &str) -> String {
    let mut texts = String::new();
    for part in svg.split("<text").skip(1) {
        let inner = part.split("</text>").next().unwrap_or("");
        let mut in_tag = true;
        for character in inner.chars() {
            match character {
                '<' => in_tag = true,
                '>' => in_tag = false,
                other if !in_tag => texts.push(other),
                _ => {}
            }
        }
        texts.push('\n');
    }
    texts
}

/// A piece of text: a number with its decimals, or what stands between numbers.
#[derive(Debug, PartialEq)]
enum Piece {
    Number(f64, usize),
    Words(String),
}

/// Differences of two texts word by word: the first few with their line.
fn words(new: &str, old: &str, equal: impl Fn(f64, f64, usize) -> bool) -> Vec<String> {
    const SHOWN: usize = 5;
    let mut found = Vec::new();
    let (new, old): (Vec<&str>, Vec<&str>) = (new.lines().collect(), old.lines().collect());
    for (line, (a, b)) in new.iter().zip(&old).enumerate() {
        let (a_pieces, b_pieces) = (pieces(a), pieces(b));
        let alike = a_pieces.len() == b_pieces.len()
            && a_pieces.iter().zip(&b_pieces).all(|pair| match pair {
                (Piece::Number(a, decimals), Piece::Number(b, others)) => {
                    equal(*a, *b, *decimals.min(others))
                }
                (a, b) => a == b,
            });
        if !alike {
            found.push(format!(
                "line {}: `{}`, now `{}`",
                line + 1,
                shortened(b),
                shortened(a)
            ));
        }
    }
    if new.len() != old.len() {
        found.push(format!("has {} lines, now {}", old.len(), new.len()));
    }
    if found.len() > SHOWN {
        let more = found.len() - SHOWN;
        found.truncate(SHOWN);
        found.push(format!("and {more} more"));
    }
    found
}

/// Differences of two pages: words must agree, numbers to one unit of the last place shown; measured blocks are left out.
pub(crate) fn differences_of_pages(new: &str, old: &str) -> Vec<String> {
    words(&Page::split(new).plain, &Page::split(old).plain, in_last_place)
}

/// Differences of two SVG documents: of what they say in words.
pub(crate) fn differences_of_drawings(new: &str, old: &str) -> Vec<String> {
    words(&svg_texts(new), &svg_texts(old), in_last_place)
}

fn shortened(line: &str) -> String {
    const LONGEST: usize = 160;
    if line.chars().count() <= LONGEST {
        return line.to_owned();
    }
    line.chars().take(LONGEST).chain("…".chars()).collect()
}

/// One unit of the last place that both show, or the tolerance of JSON.
fn in_last_place(new: f64, old: f64, decimals: usize) -> bool {
    let unit = 10f64.powi(-i32::try_from(decimals).unwrap_or(0));
    // A hundredth of a unit for the rounding of this very subtraction.
    ROUNDING.holds(new, old) || (decimals > 0 && (new - old).abs() < 1.01 * unit)
}

/// Splits a line into numbers and what is between them. Runs of blanks and dashes, which align tables, count as one.
fn pieces(line: &str) -> Vec<Piece> {
    let mut found = Vec::new();
    let mut words = String::new();
    let characters: Vec<char> = line.chars().collect();
    let at = |i: usize| characters.get(i).copied();
    let digit = |i: usize| at(i).is_some_and(|c| c.is_ascii_digit());
    let mut i = 0;
    while let Some(character) = at(i) {
        // Digits within a word, as in a checksum, are no number.
        let in_word = words.ends_with(char::is_alphanumeric);
        if !character.is_ascii_digit() || in_word {
            let repeated = matches!(character, ' ' | '-') && words.ends_with(character);
            if !repeated {
                words.push(character);
            }
            i += 1;
            continue;
        }
        let start = i;
        let mut decimals = 0;
        while digit(i) {
            i += 1;
        }
        if at(i) == Some('.') && digit(i + 1) {
            i += 1;
            while digit(i) {
                i += 1;
                decimals += 1;
            }
        }
        let sign = usize::from(matches!(at(i + 1), Some('-' | '+')));
        if at(i) == Some('e') && digit(i + 1 + sign) {
            i += 1 + sign;
            while digit(i) {
                i += 1;
            }
            // The last place of a mantissa says nothing without its power of ten: compared as in JSON.
            decimals = 0;
        }
        let text: String = characters.get(start..i).unwrap_or_default().iter().collect();
        found.push(Piece::Words(std::mem::take(&mut words)));
        found.push(Piece::Number(text.parse().unwrap_or(f64::NAN), decimals));
    }
    found.push(Piece::Words(words));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn json_numbers_are_compared_to_tolerance_and_named() {
        let old = json!({"rows": [{"a": 1.0, "b": "x"}, {"a": 0.0}], "gone": 1});
        assert!(values(&old, &old, ROUNDING).is_empty());
        let new = json!({"rows": [{"a": 1.0 + 5e-7, "b": "x"}, {"a": 5e-10}], "gone": 1});
        assert!(values(&new, &old, ROUNDING).is_empty());
        let new = json!({"rows": [{"a": 1.0 + 5e-6, "b": "y"}, {"a": null}], "new": 1});
        assert_eq!(
            values(&new, &old, ROUNDING),
            [
                "/rows/0/a is 1, now 1.000005",
                "/rows/0/b is \"x\", now \"y\"",
                "/rows/1/a is 0.0, now null",
                "/new is missing",
                "/gone is no longer written",
            ]
        );
    }

    #[test]
    fn texts_differ_by_words_and_by_more_than_the_last_place() {
        let differ = |a: &str, b: &str| !words(a, b, in_last_place).is_empty();
        assert!(!differ("| fit |  81.4 |", "| fit | 81.5 |"));
        assert!(differ("| fit | 81.4 |", "| fit | 81.6 |"));
        assert!(differ("mode 4", "mode 5"));
        assert!(differ("better", "worse"));
        assert!(!differ("| ----- |", "| --- |"));
        assert!(differ("1.0e-5", "1.0e-6"));
        assert!(differ("a\nb", "a"));
        assert!(!differ("c7d1b4e2410ba646", "c7d1b4e2410ba646"));
        assert!(differ("x1000000001", "x1000000002"));
    }

    #[test]
    fn measured_blocks_are_left_out() {
        let page = |t: &str| format!("a\n{MEASURED}\n{t} s\n{END_OF_MEASURED}\nb\n");
        assert_eq!(Page::split(&page("1.0")).plain, "a\nb\n");
        assert_eq!(Page::split(&page("1.0")), Page::split(&page("2.0")));
    }

    #[test]
    fn iterated_numbers_are_compared_loosely_on_the_page_and_in_files() {
        let page = |t: &str| format!("1.00\n{ITERATED_BLOCK}\n{t} rad/s\n{END_OF_ITERATED}\n2.00\n");
        let directories = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let write = |fresh: &str, kept: &str| {
            for (directory, number) in [(directories.0.path(), fresh), (directories.1.path(), kept)] {
                std::fs::write(directory.join("README.md"), page(number)).unwrap();
                std::fs::write(directory.join("i.json"), format!("{{\"x\": {number}}}")).unwrap();
            }
            compare(
                directories.0.path(),
                directories.1.path(),
                &[("i", Kind::Iterated)],
            )
            .unwrap()
        };
        let within = 100.0 * (1.0 + 0.5 * RELATIVE_ITERATED);
        let beyond = 100.0 * (1.0 + 2.0 * RELATIVE_ITERATED);
        assert!(write("100.00", &format!("{within:.2}")).is_empty());
        assert_eq!(write("100.00", &format!("{beyond:.2}")).len(), 2);
        // Directories, as that of the kept search, are not compared.
        std::fs::create_dir(directories.1.path().join("search")).unwrap();
        assert!(write("100.00", "100.00").is_empty());
    }

    #[test]
    fn texts_of_a_drawing_are_found() {
        let svg = "<svg><path d=\"M0 1\"/><text x=\"1\">n<tspan>z</tspan></text><text>5</text></svg>";
        assert_eq!(svg_texts(svg), "nz\n5\n");
    }

    #[test]
    fn an_altered_a_missing_and_a_surplus_file_are_found() {
        let (fresh, kept) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let write =
            |directory: &Path, name: &str, text: &str| std::fs::write(directory.join(name), text).unwrap();
        write(fresh.path(), "a.json", "{\"x\": 1.0}");
        write(kept.path(), "a.json", "{\"x\": 1.1}");
        write(fresh.path(), "b.csv", "x\n1\n");
        write(kept.path(), "c.csv", "x\n1\n");
        write(fresh.path(), "t.csv", "s\n1\n");
        write(kept.path(), "t.csv", "s\n2\n");
        let found = compare(fresh.path(), kept.path(), &[("t", Kind::Measured)]).unwrap();
        assert_eq!(
            found,
            [
                "b.csv: is missing",
                "c.csv: is no longer written",
                "a.json: /x is 1.1, now 1"
            ]
        );
    }
}
