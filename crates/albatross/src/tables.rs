//! CSV and JSON inputs: time histories, lift slopes, longitudinal derivatives.

use crate::Error;
use albatross_flight::derivatives::LongitudinalCorrections;
use albatross_strip::slopes::{SlopeRow, SlopeTable};

/// A CSV table with a header line; lines that start with `#` are comments.
#[derive(Debug, Clone)]
pub struct Columns {
    file: String,
    header: Vec<String>,
    rows: Vec<(usize, Vec<String>)>,
}

impl Columns {
    /// Parses CSV text.
    ///
    /// # Errors
    /// [`Error::Table`] for ragged rows or text without a header.
    pub fn parse(text: &str, file: &str) -> Result<Self, Error> {
        let bad = |line: usize, message: String, expected: &str| Error::Table {
            file: file.to_owned(),
            line,
            message,
            expected: expected.to_owned(),
        };
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(false)
            .from_reader(text.as_bytes());
        let expected = "a header line and rows of as many fields";
        let line_of = |e: &csv::Error| e.position().map_or(0, |p| p.line() as usize);
        let header: Vec<String> = reader
            .headers()
            .map_err(|e| bad(line_of(&e), e.to_string(), expected))?
            .iter()
            .map(str::to_owned)
            .collect();
        if header.iter().all(String::is_empty) {
            return Err(bad(0, "the file has no header line".into(), expected));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| bad(line_of(&e), e.to_string(), expected))?;
            let line = record.position().map_or(0, |p| p.line() as usize);
            rows.push((line, record.iter().map(str::to_owned).collect()));
        }
        Ok(Self {
            file: file.to_owned(),
            header,
            rows,
        })
    }

    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.header
    }

    /// Whether there is a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.header.iter().any(|h| h == name)
    }

    /// A column as text, with the line of each field.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the columns there are.
    pub fn texts(&self, name: &str) -> Result<Vec<(usize, &str)>, Error> {
        let index = self
            .header
            .iter()
            .position(|h| h == name)
            .ok_or_else(|| Error::UnknownName {
                kind: "column",
                name: format!("{name}` in `{}", self.file),
                known: self.header.join(", "),
            })?;
        Ok(self
            .rows
            .iter()
            .map(|(line, row)| (*line, row.get(index).map_or("", String::as_str)))
            .collect())
    }

    /// A column as finite numbers.
    ///
    /// # Errors
    /// [`Error::UnknownName`]; [`Error::Table`] with the line of a field that is no number.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, Error> {
        self.texts(name)?
            .into_iter()
            .map(|(line, text)| match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(Error::Table {
                    file: self.file.clone(),
                    line,
                    message: format!("column `{name}` holds `{text}`"),
                    expected: "a finite number".into(),
                }),
            })
            .collect()
    }
}

/// Lift slopes: columns `surface` and `cl_alpha`, the position as `y`, or as `y_in` and `y_out` with the middle taken,
/// optionally `side` (`L` mirrors y to the left) and `cl0`.
///
/// # Errors
/// [`Error::Table`], [`Error::UnknownName`].
pub fn slope_table(text: &str, file: &str, provenance: &str) -> Result<SlopeTable, Error> {
    let columns = Columns::parse(text, file)?;
    let y = if columns.has("y") {
        columns.numbers("y")?
    } else {
        let (inner, outer) = (columns.numbers("y_in")?, columns.numbers("y_out")?);
        inner.iter().zip(&outer).map(|(a, b)| 0.5 * (a + b)).collect()
    };
    let sides: Vec<f64> = if columns.has("side") {
        columns
            .texts("side")?
            .into_iter()
            .map(|(line, side)| match side.to_ascii_uppercase().as_str() {
                "R" | "RIGHT" => Ok(1.0),
                "L" | "LEFT" => Ok(-1.0),
                _ => Err(Error::Table {
                    file: file.to_owned(),
                    line,
                    message: format!("column `side` holds `{side}`"),
                    expected: "L or R".into(),
                }),
            })
            .collect::<Result<_, _>>()?
    } else {
        vec![1.0; y.len()]
    };
    let slopes = columns.numbers("cl_alpha")?;
    let cl0 = if columns.has("cl0") {
        Some(columns.numbers("cl0")?)
    } else {
        None
    };
    let places = y.iter().zip(&sides).map(|(y, side)| y * side);
    let rows = columns
        .texts("surface")?
        .into_iter()
        .zip(places)
        .zip(slopes)
        .enumerate()
        .map(|(i, (((_, surface), y), cl_alpha))| SlopeRow {
            surface: surface.to_owned(),
            y,
            cl_alpha,
            cl0: cl0.as_ref().and_then(|c| c.get(i).copied()),
        })
        .collect();
    Ok(SlopeTable {
        provenance: provenance.to_owned(),
        rows,
    })
}

/// The longitudinal derivatives of a JSON object with the keys of [`LongitudinalCorrections`]; other keys are notes.
///
/// # Errors
/// [`Error::Table`] if the text is not such an object or names none of the eight.
pub fn longitudinal(text: &str, file: &str) -> Result<LongitudinalCorrections, Error> {
    let expected = "a JSON object with numbers among CL0, CLa, CLq, CLde, Cm0, Cma, Cmq, Cmde";
    let table = |line: usize, message: String| Error::Table {
        file: file.to_owned(),
        line,
        message,
        expected: expected.to_owned(),
    };
    let keys = ["CL0", "CLa", "CLq", "CLde", "Cm0", "Cma", "Cmq", "Cmde"];
    if let Ok(serde_json::Value::Object(map)) = serde_json::from_str(text) {
        let misspelt = |name: &&String| keys.iter().any(|k| k != name && k.eq_ignore_ascii_case(name));
        if let Some(name) = map.keys().find(misspelt) {
            return Err(table(
                0,
                format!("the key `{name}` differs from a derivative's by its capitals"),
            ));
        }
    }
    let corrections: LongitudinalCorrections =
        serde_json::from_str(text).map_err(|e| table(e.line(), e.to_string()))?;
    if corrections == LongitudinalCorrections::default() {
        return Err(table(0, "none of the eight derivatives is given".into()));
    }
    Ok(corrections)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_slope_table_layouts() {
        let by_bins =
            "# note\nsurface,side,y_in,y_out,cl_alpha,cl0\nWing,L,1.0,2.0,5.5,0.1\nWing,R,1.0,2.0,5.6,0.2\n";
        let table = slope_table(by_bins, "a.csv", "test").unwrap();
        assert_eq!((table.rows[0].y, table.rows[1].y), (-1.5, 1.5));
        assert_eq!(table.rows[1].cl0, Some(0.2));
        let by_y = "surface,strip,y,cl_alpha\nWing (YDUP),1,-3.0,5.5\n";
        assert_eq!(slope_table(by_y, "b.csv", "test").unwrap().rows[0].y, -3.0);
    }

    #[test]
    fn val_errors_name_line_and_column() {
        let error = Columns::parse("t,x\n0,1\n1,oops\n", "a.csv")
            .unwrap()
            .numbers("x")
            .unwrap_err();
        assert!(
            error.to_string().starts_with("a.csv:3: column `x` holds `oops`"),
            "{error}"
        );
        let error = Columns::parse("t,x\n0,1,2\n", "a.csv").unwrap_err().to_string();
        assert!(error.contains("a.csv:2"), "{error}");
        assert!(longitudinal("{\"note\": \"x\"}", "d.json").is_err());
    }
}
