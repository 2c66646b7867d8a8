//! JSON for programs.

use serde_json::{Map, Value, json};

use super::{Cell, Footnotes, Table, mark};

impl Table {
    /// The table as a JSON value.
    ///
    /// ```json
    /// { "title": "…", "caption": "…",
    ///   "columns": [ { "key": "first peak: q", "group": "first peak", "name": "q", "unit": "deg/s" } ],
    ///   "rows": [ { "first peak: q": -1.51 } ],
    ///   "notes": [ { "mark": "a", "row": 0, "column": "first peak: q", "text": "…" } ] }
    /// ```
    ///
    /// Rows are keyed by the column's `key` (its name, with its group and a number where names repeat). Rows
    /// are counted from zero. A missing value is `null`, and so is one that is not a number, with a note that
    /// says which.
    pub fn to_json(&self) -> Value {
        let keys = self.keys();
        let columns: Vec<Value> = keys
            .iter()
            .zip(&self.columns)
            .map(|(key, column)| {
                let mut entry = Map::new();
                entry.insert("key".to_owned(), json!(key));
                if !column.group.is_empty() {
                    entry.insert("group".to_owned(), json!(column.group));
                }
                entry.insert("name".to_owned(), json!(column.name));
                entry.insert("unit".to_owned(), json!(column.unit));
                Value::Object(entry)
            })
            .collect();

        let footnotes = Footnotes::of(self);
        let mut notes: Vec<Value> = Vec::new();
        let mut rows: Vec<Value> = Vec::new();
        for (i, row) in self.rows.iter().enumerate() {
            let mut entry = Map::new();
            for (key, cell) in keys.iter().zip(row) {
                entry.insert(key.clone(), value(cell));
                for note in cell.notes() {
                    let label = footnotes.notes.iter().position(|known| known == note).map(mark);
                    notes.push(json!({ "mark": label, "row": i, "column": key, "text": note }));
                }
                if let Some(text) = why_not_a_number(cell) {
                    notes.push(json!({ "mark": null, "row": i, "column": key, "text": text }));
                }
            }
            rows.push(Value::Object(entry));
        }
        json!({
            "title": self.title,
            "caption": self.caption,
            "columns": columns,
            "rows": rows,
            "notes": notes,
        })
    }
}

fn value(cell: &Cell) -> Value {
    match cell.value() {
        Cell::Text(words) => json!(words),
        Cell::Number(number) | Cell::Formatted(number, _) => json!(number),
        Cell::Integer(number) => json!(number),
        Cell::Missing(_) | Cell::Flagged { .. } => Value::Null,
    }
}

/// JSON has no way to write these values; the note says which one `null` stands for.
fn why_not_a_number(cell: &Cell) -> Option<&'static str> {
    match cell.value() {
        Cell::Number(n) | Cell::Formatted(n, _) if n.is_nan() => Some("the value is not a number"),
        Cell::Number(n) | Cell::Formatted(n, _) if *n == f64::INFINITY => {
            Some("the value is positive infinity")
        }
        Cell::Number(n) | Cell::Formatted(n, _) if *n == f64::NEG_INFINITY => {
            Some("the value is negative infinity")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Column;
    use super::*;
    use crate::number::Format;

    #[test]
    fn golden_layout_with_notes_and_values_that_are_not_numbers() {
        let mut table = Table::new(
            "T",
            [
                Column::text("model"),
                Column::new("q", "deg/s", Format::Fixed(1)).in_group("first peak"),
            ],
        );
        table
            .push(["CFD".into(), Cell::from(-1.51).flagged("printed")])
            .unwrap();
        table.push(["none".into(), f64::NAN.into()]).unwrap();
        table.push(["far".into(), Cell::from(f64::INFINITY)]).unwrap();
        let expected = json!({
            "title": "T", "caption": "",
            "columns": [
                { "key": "model", "name": "model", "unit": "" },
                { "key": "first peak: q", "group": "first peak", "name": "q", "unit": "deg/s" }
            ],
            "rows": [
                { "model": "CFD", "first peak: q": -1.51 },
                { "model": "none", "first peak: q": null },
                { "model": "far", "first peak: q": null }
            ],
            "notes": [
                { "mark": "a", "row": 0, "column": "first peak: q", "text": "printed" },
                { "mark": null, "row": 1, "column": "first peak: q", "text": "the value is not a number" },
                { "mark": null, "row": 2, "column": "first peak: q", "text": "the value is positive infinity" }
            ]
        });
        assert_eq!(table.to_json(), expected);
        assert!(!table.to_json().to_string().contains("NaN"));
    }
}
