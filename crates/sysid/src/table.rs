//! Tables of samples as text: CSV as spreadsheets, MATLAB, Python and simulations write it.
//!
//! Lines that begin with `#` and empty lines are skipped anywhere. The first other line is the header; it decides the
//! delimiter: semicolon, tab, comma or blanks, in that order. A line of units may follow. A table whose first line
//! holds numbers only has no header, and its columns are called `c1`, `c2`, ...
//!
//! Cells that are no finite numbers are faults of their column, and concern only those who ask for that column: a
//! recording may contain texts and gaps in channels that nobody identifies.

mod header;
mod times;

use albatross_lti::Signal;

use crate::{Error, Experiment, Result};

/// A table with one column per signal and one row per time.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// File, for messages.
    pub file: String,
    /// The columns in the order of the file.
    pub columns: Vec<Column>,
    /// Line of every row in the file, counted from 1.
    pub lines: Vec<usize>,
    /// Line of the header, counted from 1; 0 without header.
    pub header_line: usize,
}

/// One column of a [`Table`].
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Header as written.
    pub header: String,
    /// Header without unit.
    pub name: String,
    /// Unit, if the header or a line of units has one, for example `deg/s`.
    pub unit: Option<String>,
    /// Values, as many as the table has rows; NaN where the cell is no finite number.
    pub values: Vec<f64>,
    /// The first cell that is no finite number.
    pub fault: Option<Fault>,
    /// How finely the values are printed.
    pub printed: Printed,
}

/// A cell that is no finite number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Line in the file, counted from 1.
    pub line: usize,
    /// The cell as written.
    pub text: String,
}

/// Digits of the values of a column, the most that occur.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Printed {
    /// Digits after the decimal point, the exponent taken into account.
    pub decimals: i32,
    /// Significant digits.
    pub significant: i32,
}

/// Which columns make an experiment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    /// Column of times; `None` looks for one called `t`, `time`, `t_s`, `time [s]` and the like.
    pub time: Option<String>,
    /// Sample time \[s\] of tables without times.
    pub sample_time: Option<f64>,
    /// Column of the input.
    pub input: String,
    /// Columns of the outputs.
    pub outputs: Vec<String>,
}

/// Reads the text of a table. `file` is used in messages only.
///
/// Numbers may have Fortran exponents (`1.0D-3`).
///
/// # Errors
/// [`Error::Table`] without header and rows, with fewer than two rows, for a row with more or fewer cells than the
/// header, and for numbers with decimal commas where they can be told.
pub fn parse(text: &str, file: &str) -> Result<Table> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .peekable();
    let Some(&(first_line, first)) = lines.peek() else {
        return Err(fault(file, 0, "no rows", "a header and rows of numbers"));
    };
    let delimiter = Delimiter::detect(first);
    let cells = header::cells(first, delimiter);
    let has_header = !cells.iter().all(|cell| number(cell).is_some());
    let mut units = Vec::new();
    if has_header {
        refuse_decimal_commas(file, first_line, first, delimiter)?;
        lines.next();
        if let Some((_, line)) = lines.peek() {
            units = header::units_line(&header::cells(line, delimiter), cells.len());
            if !units.is_empty() {
                lines.next();
            }
        }
    }
    let header_line = if has_header { first_line } else { 0 };
    let mut columns: Vec<Column> = if has_header {
        header::columns(&cells, &units)
    } else {
        (1..=cells.len())
            .map(|i| Column::new(format!("c{i}"), format!("c{i}"), None))
            .collect()
    };
    let mut rows = Vec::new();
    for (line, row) in lines {
        push_row(file, line, row, delimiter, &mut columns)?;
        rows.push(line);
    }
    if rows.len() < 2 {
        return Err(fault(
            file,
            0,
            format!("{} rows of numbers", rows.len()),
            "at least two: is this a table of samples?",
        ));
    }
    Ok(Table {
        file: file.to_owned(),
        columns,
        lines: rows,
        header_line,
    })
}

impl Table {
    /// The column called `name`: by its header as written, else by its name without unit, else either of them
    /// without regard to capitals.
    ///
    /// # Errors
    /// [`Error::UnknownColumn`]; [`Error::Table`] if several columns fit equally well, and for a column with a cell
    /// that is no finite number.
    pub fn column(&self, name: &str) -> Result<&Column> {
        let column = self.find(name)?;
        match &column.fault {
            None => Ok(column),
            Some(cell) => Err(fault(
                &self.file,
                cell.line,
                format!("\"{}\" in column {}", cell.text, column.header),
                if decimal_comma(&cell.text) {
                    "a number: write decimal points instead of decimal commas"
                } else {
                    "a finite number: remove the row at both ends of the record, or interpolate the value within it"
                },
            )),
        }
    }

    /// The columns asked for as an experiment, and the names and units of the input and the outputs.
    ///
    /// The unit of a column without one is "1". The experiment has the name of the file; trim is not removed.
    ///
    /// # Errors
    /// Those of [`Table::column`]; [`Error::Table`] without times and without sample time, for a column of times that
    /// are not uniform or not in a unit of time, and for a sample time that contradicts the column of times;
    /// [`Error::Domain`] for a sample time that is not positive.
    pub fn experiment(&self, columns: &Columns) -> Result<(Experiment, Signal, Vec<Signal>)> {
        let dt = self.sample_time(columns)?;
        let input = self.column(&columns.input)?;
        let outputs = columns
            .outputs
            .iter()
            .map(|name| self.column(name))
            .collect::<Result<Vec<_>>>()?;
        let experiment = Experiment::new(
            self.file.clone(),
            dt,
            input.values.clone(),
            outputs.iter().map(|c| c.values.clone()).collect(),
        );
        let signals = outputs.iter().map(|c| self.signal(c)).collect();
        Ok((experiment, self.signal(input), signals))
    }

    /// Name without unit if no other column shares it, else the header.
    fn signal(&self, column: &Column) -> Signal {
        let unique = self.columns.iter().filter(|c| c.name == column.name).count() == 1;
        let name = if unique { &column.name } else { &column.header };
        Signal::new(name, column.unit.as_deref().unwrap_or("1"))
    }

    fn find(&self, name: &str) -> Result<&Column> {
        let name = name.trim();
        let lower = name.to_lowercase();
        type Rule<'a> = &'a dyn Fn(&Column) -> bool;
        let rules: [Rule; 6] = [
            &|c| c.header == name,
            &|c| header::without_brackets(&c.header) == name,
            &|c| c.name == name,
            &|c| c.header.to_lowercase() == lower,
            &|c| header::without_brackets(&c.header).to_lowercase() == lower,
            &|c| c.name.to_lowercase() == lower,
        ];
        for rule in rules {
            let mut fitting = self.columns.iter().filter(|c| rule(c));
            match (fitting.next(), fitting.next()) {
                (Some(only), None) => return Ok(only),
                (Some(_), Some(_)) => return Err(self.ambiguous(name, rule)),
                (None, _) => {}
            }
        }
        Err(Error::UnknownColumn {
            file: self.file.clone(),
            column: name.to_owned(),
            known: headers(self.columns.iter()),
        })
    }

    fn ambiguous(&self, name: &str, rule: &dyn Fn(&Column) -> bool) -> Error {
        let candidates = headers(self.columns.iter().filter(|c| rule(c)));
        fault(
            &self.file,
            self.header_line,
            format!("several columns for \"{name}\": {candidates}"),
            "one: give its full header, and rename columns with the same header",
        )
    }
}

impl Column {
    fn new(header: impl Into<String>, name: impl Into<String>, unit: Option<String>) -> Self {
        Self {
            header: header.into(),
            name: name.into(),
            unit,
            values: Vec::new(),
            fault: None,
            printed: Printed::default(),
        }
    }

    fn push(&mut self, line: usize, cell: &str) {
        let value = number(cell).filter(|v| v.is_finite());
        if value.is_none() && self.fault.is_none() {
            self.fault = Some(Fault {
                line,
                text: cell.to_owned(),
            });
        }
        self.printed = self.printed.or(cell);
        self.values.push(value.unwrap_or(f64::NAN));
    }
}

impl Printed {
    /// The larger of the present digits and those of one more cell.
    fn or(self, cell: &str) -> Self {
        let (mut decimals, mut significant, mut point, mut leading) = (0, 0, false, true);
        let mut exponent = 0;
        for (i, byte) in cell.bytes().enumerate() {
            match byte {
                b'0'..=b'9' => {
                    leading &= byte == b'0';
                    significant += i32::from(!leading);
                    decimals += i32::from(point);
                }
                b'.' => point = true,
                b'e' | b'E' | b'd' | b'D' => {
                    exponent = cell.get(i + 1..).and_then(|t| t.parse().ok()).unwrap_or(0);
                    break;
                }
                _ => {}
            }
        }
        Self {
            decimals: self.decimals.max(decimals.saturating_sub(exponent)),
            significant: self.significant.max(significant),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Delimiter {
    Character(char),
    Blanks,
}

impl Delimiter {
    /// From the first line; texts in quotes do not count.
    fn detect(line: &str) -> Self {
        let bare: String = line
            .split('"')
            .step_by(2)
            .flat_map(|piece| [piece, " "])
            .collect();
        [';', '\t', ',']
            .into_iter()
            .find(|&c| bare.contains(c))
            .map_or(Self::Blanks, Self::Character)
    }
}

/// Appends a row of cells to the columns.
fn push_row(file: &str, line: usize, row: &str, delimiter: Delimiter, columns: &mut [Column]) -> Result<()> {
    let expected = columns.len();
    let mut found = 0;
    let mut push = |cell: &str| {
        if let Some(column) = columns.get_mut(found) {
            column.push(line, header::unquoted(cell));
        }
        // One delimiter after the last cell ends the row.
        found += usize::from(found < expected || !cell.is_empty());
    };
    match delimiter {
        Delimiter::Character(c) => row.split(c).map(str::trim).for_each(&mut push),
        Delimiter::Blanks => row.split_ascii_whitespace().for_each(&mut push),
    }
    if found == expected {
        return Ok(());
    }
    let cure = if delimiter == Delimiter::Character(',') && found > expected {
        "; if these are decimal commas, write decimal points"
    } else {
        "; complete or remove the row"
    };
    Err(fault(
        file,
        line,
        format!("{found} cells"),
        format!("{expected} as the first line has{cure}"),
    ))
}

/// A number of Rust's or Fortran's writing, also infinite and NaN.
fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().or_else(|| {
        let exponent = cell.find(['d', 'D'])?;
        let digits = |t: &str| t.bytes().any(|b| b.is_ascii_digit());
        let (mantissa, rest) = (cell.get(..exponent)?, cell.get(exponent + 1..)?);
        (digits(mantissa) && digits(rest))
            .then(|| format!("{mantissa}e{rest}").parse().ok())
            .flatten()
    })
}

fn decimal_comma(cell: &str) -> bool {
    cell.contains(',') && number(&cell.replacen(',', ".", 1)).is_some()
}

/// A first line of numbers with decimal commas would pass for a header.
fn refuse_decimal_commas(file: &str, line: usize, text: &str, delimiter: Delimiter) -> Result<()> {
    let split = |delimiter| header::cells(text, delimiter);
    let all = |cells: Vec<String>| cells.iter().all(|c| decimal_comma(c) || number(c).is_some());
    if all(split(delimiter)) || all(split(Delimiter::Blanks)) {
        return Err(fault(
            file,
            line,
            "numbers with decimal commas",
            "decimal points: replace the commas within numbers",
        ));
    }
    Ok(())
}

fn headers<'a>(columns: impl Iterator<Item = &'a Column>) -> String {
    columns.map(|c| c.header.as_str()).collect::<Vec<_>>().join(", ")
}

fn fault(file: &str, line: usize, found: impl Into<String>, expected: impl Into<String>) -> Error {
    Error::Table {
        file: file.to_owned(),
        line,
        found: found.into(),
        expected: expected.into(),
    }
}

#[cfg(test)]
mod tests;
