//! CSV, quoted after RFC 4180.

use super::{Cell, Table};
use crate::number::shortest;

impl Table {
    /// The table as comma-separated values: one header line of `name [unit]`, then every row with all digits.
    ///
    /// Fields are quoted after RFC 4180 (Shafranovich, 2005); lines end in a line feed. A missing value is an
    /// empty field, a value that is not a number reads `nan`, `inf` or `-inf`. If any cell carries a remark,
    /// a last column `notes` holds the remarks of each row.
    pub fn to_csv(&self) -> String {
        let notes: Vec<String> = self.rows.iter().map(|row| self.notes_of(row)).collect();
        let with_notes = notes.iter().any(|note| !note.is_empty());
        let mut header: Vec<String> = self
            .keys()
            .into_iter()
            .zip(&self.columns)
            .map(|(key, column)| {
                if column.unit.is_empty() {
                    key
                } else {
                    format!("{key} [{}]", column.unit)
                }
            })
            .collect();
        if with_notes {
            header.push("notes".to_owned());
        }
        let mut out = line(&header);
        for (row, note) in self.rows.iter().zip(notes) {
            let mut fields: Vec<String> = row.iter().map(field).collect();
            if with_notes {
                fields.push(note);
            }
            out += &line(&fields);
        }
        out
    }

    /// Remarks of a row; each names its column where the row has more than one.
    fn notes_of(&self, row: &[Cell]) -> String {
        let notes: Vec<(usize, &str)> = row
            .iter()
            .enumerate()
            .flat_map(|(j, cell)| cell.notes().into_iter().map(move |n| (j, n)))
            .collect();
        match notes.as_slice() {
            [(_, note)] => (*note).to_owned(),
            many => {
                let name = |j: usize| self.columns.get(j).map_or(String::new(), |c| c.full_name());
                many.iter()
                    .map(|(j, note)| format!("{}: {note}", name(*j)))
                    .collect::<Vec<_>>()
                    .join("; ")
            }
        }
    }
}

fn field(cell: &Cell) -> String {
    match cell.value() {
        Cell::Text(words) => words.clone(),
        Cell::Number(number) | Cell::Formatted(number, _) => match number {
            n if n.is_nan() => "nan".to_owned(),
            n if n.is_infinite() => if *n > 0.0 { "inf" } else { "-inf" }.to_owned(),
            n => shortest(*n),
        },
        Cell::Integer(number) => number.to_string(),
        Cell::Missing(_) | Cell::Flagged { .. } => String::new(),
    }
}

fn line(fields: &[String]) -> String {
    let quoted: Vec<String> = fields.iter().map(|field| quote(field)).collect();
    format!("{}\n", quoted.join(","))
}

fn quote(field: &str) -> String {
    let needs = field.contains([',', '"', '\r', '\n']) || field.trim() != field;
    if needs {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Column;
    use super::*;
    use crate::number::Format;

    #[test]
    fn golden_fields_are_quoted_and_keep_every_digit() {
        let mut table = Table::new(
            "ignored",
            [
                Column::text("name, \"quoted\""),
                Column::new("x", "m", Format::Fixed(1)),
                Column::text("x"),
            ],
        );
        table
            .push(["a\nb".into(), 0.1234567890123.into(), 7i64.into()])
            .unwrap();
        table
            .push([" c".into(), f64::NEG_INFINITY.into(), Cell::EMPTY])
            .unwrap();
        table.push(["d".into(), 1e-30.into(), f64::NAN.into()]).unwrap();
        assert_eq!(
            table.to_csv(),
            "\"name, \"\"quoted\"\"\",x [m],x (2)\n\"a\nb\",0.1234567890123,7\n\" c\",-inf,\nd,1e-30,nan\n"
        );
    }

    #[test]
    fn several_notes_of_a_row_name_their_columns() {
        let mut table = Table::new("", [Column::text("p"), Column::text("q")]);
        table
            .push([Cell::missing("one"), Cell::from(2.0).flagged("two")])
            .unwrap();
        table
            .push([Cell::EMPTY, Cell::from(3.0).flagged("three")])
            .unwrap();
        assert_eq!(table.to_csv(), "p,q,notes\n,2,p: one; q: two\n,3,three\n");
    }
}
