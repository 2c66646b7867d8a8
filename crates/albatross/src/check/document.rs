//! The case file as text: misspelt keys, and the line of every key.

use super::Findings;
use super::names::{expected, nearest};
use crate::case::Case;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// Misspelt names that are mended before the reader gives up.
const MOST_MISSPELT: usize = 20;

/// A case file with the lines of its keys.
#[derive(Debug, Default)]
pub(super) struct Document {
    /// Path as given.
    pub(super) file: String,
    /// What the file says, as far as it is TOML.
    pub(super) table: toml::Table,
    lines: BTreeMap<String, usize>,
}

impl Document {
    fn new(text: &str, file: &str) -> Self {
        let mut lines = BTreeMap::new();
        if let Ok(table) = DeTable::parse(text) {
            walk_table(table.get_ref(), "", &LineEnds::of(text), &mut lines);
        }
        Self {
            file: file.to_owned(),
            table: text.parse().unwrap_or_default(),
            lines,
        }
    }

    /// `file:line` of a key such as `flight.mach` or `sensor.0.grid`, or of the nearest table around it.
    pub(super) fn at(&self, key: &str) -> String {
        let mut path = key;
        loop {
            if let Some(line) = self.lines.get(path) {
                return format!("{}:{line}", self.file);
            }
            match path.rsplit_once('.') {
                Some((around, _)) => path = around,
                None => return self.file.clone(),
            }
        }
    }

    /// Whether the file has a key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.lines.contains_key(key)
    }

    /// A text value by its path.
    pub(super) fn text(&self, key: &str) -> Option<&str> {
        let mut value: Option<&toml::Value> = None;
        for step in key.split('.') {
            value = match (value, step.parse::<usize>()) {
                (None, _) => self.table.get(step),
                (Some(toml::Value::Array(list)), Ok(index)) => list.get(index),
                (Some(toml::Value::Table(table)), _) => table.get(step),
                _ => None,
            };
            value?;
        }
        value.and_then(toml::Value::as_str)
    }
}

/// Places of the line ends, so that the line of each key is found without reading the text again.
struct LineEnds(Vec<usize>);

impl LineEnds {
    fn of(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(at, _)| at).collect())
    }

    /// Line from 1 of a byte.
    fn line(&self, byte: usize) -> usize {
        1 + self.0.partition_point(|&end| end < byte)
    }
}

fn walk_table(table: &DeTable<'_>, path: &str, ends: &LineEnds, lines: &mut BTreeMap<String, usize>) {
    for (key, value) in table.iter() {
        let name = key.get_ref();
        let own = if path.is_empty() {
            name.to_string()
        } else {
            format!("{path}.{name}")
        };
        lines.insert(own.clone(), ends.line(key.span().start));
        walk_value(value.get_ref(), &own, ends, lines);
    }
}

fn walk_value(value: &DeValue<'_>, path: &str, ends: &LineEnds, lines: &mut BTreeMap<String, usize>) {
    match value {
        DeValue::Table(table) => walk_table(table, path, ends, lines),
        DeValue::Array(list) => {
            for (i, item) in list.iter().enumerate() {
                let own = format!("{path}.{i}");
                lines.insert(own.clone(), ends.line(item.span().start));
                walk_value(item.get_ref(), &own, ends, lines);
            }
        }
        _ => {}
    }
}

/// Line from 1 of a byte.
fn line(text: &str, byte: usize) -> usize {
    1 + text.get(..byte).map_or(0, |t| t.matches('\n').count())
}

/// Reads a case. A misspelt key or choice is a finding and read as the one that was meant.
pub(super) fn read(text: &str, file: &str, found: &mut Findings) -> (Document, Option<Case>) {
    let mut text = text.to_owned();
    for _ in 0..MOST_MISSPELT {
        let error = match toml::from_str::<Case>(&text) {
            Ok(case) => return (Document::new(&text, file), Some(case)),
            Err(error) => error,
        };
        let message = error.message().trim();
        let span = error.span().unwrap_or(0..0);
        let place = if error.span().is_some() {
            format!("{file}:{}", line(&text, span.start))
        } else {
            file.to_owned()
        };
        let unknown = message
            .strip_prefix("unknown field `")
            .or_else(|| message.strip_prefix("unknown variant `"))
            .and_then(|rest| rest.split('`').next());
        let Some(name) = unknown else {
            let is_toml = DeTable::parse(&text).is_ok() || file.ends_with(".toml");
            let cure = if is_toml {
                cure(message)
            } else {
                "give the case file (TOML) that names deck and geometry; `albatross new DIR` writes one"
            };
            found.error(&place, message, cure);
            break;
        };
        let known = expected(message);
        let meant = nearest(name, known.iter().map(String::as_str));
        let choices = known.join(", ");
        let kind = if message.starts_with("unknown field") {
            "key"
        } else {
            "choice"
        };
        let cure = match meant {
            Some(meant) => format!("did you mean `{meant}`? There are: {choices}"),
            None => format!("use one of: {choices}"),
        };
        found.error(&place, format!("`{name}` is no {kind} here"), cure);
        match mended(&text, &span, name, meant, kind) {
            Some(next) => text = next,
            None => break,
        }
    }
    (Document::new(&text, file), None)
}

/// The text with an unknown name replaced by the one that is meant, or its line taken out; none if that is no TOML.
fn mended(
    text: &str,
    span: &std::ops::Range<usize>,
    name: &str,
    meant: Option<&str>,
    kind: &str,
) -> Option<String> {
    let at = span.start + text.get(span.clone())?.find(name)?;
    let replaced = meant.map(|meant| {
        let mut next = text.to_owned();
        next.replace_range(at..at + name.len(), meant);
        next
    });
    let without = (kind == "key").then(|| {
        let begin = text.get(..at).and_then(|t| t.rfind('\n')).map_or(0, |i| i + 1);
        let mut next = text.to_owned();
        next.insert(begin, '#');
        next
    });
    replaced
        .into_iter()
        .chain(without)
        .find(|next| DeTable::parse(next).is_ok())
}

fn cure(message: &str) -> &'static str {
    if message.contains("missing field `damping_ratio`") {
        "add the structural damping as a ratio of critical, such as `damping_ratio = 0.01`; there is no default"
    } else if message.contains("missing field") {
        "add the key; docs/CASE.md describes each"
    } else if message.contains("damping_ratio is neither") {
        "give a number such as 0.01, or a list of numbers, one for each mode"
    } else {
        "correct the line; docs/CASE.md describes every key"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = include_str!("../../../../fixtures/f25-like/case.toml");

    #[test]
    fn val_lines_of_keys() {
        let document = Document::new(CASE, "case.toml");
        let line = |text: &str| 1 + CASE.lines().position(|l| l.starts_with(text)).unwrap();
        assert_eq!(
            document.at("flight.mach"),
            format!("case.toml:{}", line("mach = "))
        );
        assert_eq!(
            document.at("sensor.5.grid"),
            format!("case.toml:{}", line("grid = 3003"))
        );
        assert_eq!(
            document.at("structure.solve"),
            format!("case.toml:{}", line("[structure]"))
        );
        assert_eq!(
            document.text("aerodynamics.strips.1.file"),
            Some("avl_out/alpha2.fs")
        );
    }

    /// Two misspelt keys and a misspelt choice: each is found, and the case is read as it was meant.
    #[test]
    fn val_misspelt_names() {
        let text = CASE
            .replace("modes = 20", "mode = 20")
            .replace("trim_control", "trimcontrol")
            .replace("interpolation = \"cubic\"", "interpolation = \"qubic\"")
            .replace("path_angle_deg = 0.0", "weather = \"fair\"");
        let mut found = Findings::default();
        let (_, case) = read(&text, "case.toml", &mut found);
        assert_eq!(case.unwrap().flight.trim_control, "elevator");
        let cures: Vec<&str> = found.list.iter().map(|f| f.cure.as_str()).collect();
        assert_eq!(cures.len(), 4, "{cures:?}");
        for meant in ["`modes`", "`trim_control`", "`cubic`"] {
            assert!(
                cures.iter().any(|c| c.contains(&format!("did you mean {meant}"))),
                "{cures:?}"
            );
        }
    }
}
