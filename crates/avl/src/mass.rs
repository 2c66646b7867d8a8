//! Mass file (`.mass`): units, and mass items with their place and inertia.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::error::{AvlError, Diagnostic};
use crate::fortran::{Item, items};
use crate::source::{Line, Source, excerpt};

/// Content of a `.mass` file. Items are in the file's units, after its multipliers and adders.
///
/// AVL uses the masses (and the CG) only after `MSET 0`, or when the file is read at start-up together with a
/// `.run` file that has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MassFile {
    /// `Lunit`: length of one unit of the geometry file.
    pub length_unit: Unit,
    /// `Munit`: mass of one unit of this file.
    pub mass_unit: Unit,
    /// `Tunit`: time of one unit.
    pub time_unit: Unit,
    /// `g`, in the named units (m/s^2 where these are SI); AVL takes 1 when the line is missing.
    pub gravity: Option<f64>,
    /// `rho`, in the named units (kg/m^3 where these are SI); AVL takes 1 when the line is missing.
    pub density: Option<f64>,
    /// Mass items.
    pub items: Vec<MassItem>,
}

/// Size and name of a unit, as in `Lunit = 0.0254 m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    /// Size of the file's unit in the named unit: 0.0254.
    pub factor: f64,
    /// Name: `m`; `Lunit` and so on when the file gives none.
    pub name: String,
}

/// One line of masses.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MassItem {
    /// Mass.
    pub mass: f64,
    /// Position x aft, y right, z up, in the axes of the geometry file.
    pub position: [f64; 3],
    /// Ixx, Iyy, Izz about the item's own centre.
    pub moments: [f64; 3],
    /// Products Ixy, Ixz, Iyz about the item's own centre, positive for the sum of `m x y` and so on: the
    /// entries of the inertia tensor are their negatives.
    pub products: [f64; 3],
    /// Text after `!`.
    pub comment: String,
}

impl MassItem {
    /// The item in the named units (SI where `Lunit = ... m`, `Munit = ... kg`): lengths times `Lunit`, masses
    /// times `Munit`, inertias times `Munit Lunit^2`.
    pub fn in_named_units(&self, file: &MassFile) -> Self {
        let (length, mass) = (file.length_unit.factor, file.mass_unit.factor);
        let inertia = mass * length * length;
        Self {
            mass: self.mass * mass,
            position: self.position.map(|v| v * length),
            moments: self.moments.map(|v| v * inertia),
            products: self.products.map(|v| v * inertia),
            comment: self.comment.clone(),
        }
    }
}

/// Numbers of an item: mass, x, y, z, Ixx, Iyy, Izz, Ixy, Ixz, Iyz.
const COLUMNS: usize = 10;

impl MassFile {
    /// Reads a `.mass` file as AVL does: names of units are case sensitive and stand anywhere before `=`; any
    /// other line with a `g` before `=` is gravity; `*` and `+` lines change the items below them; missing
    /// numbers are zero; `!` starts a comment; lines that cannot be read are passed over with a remark.
    ///
    /// # Errors
    /// [`AvlError::Empty`]; [`AvlError::Missing`] when no line gives a mass; [`AvlError::Syntax`] for a unit
    /// that is not positive; [`AvlError::NotFinite`] for infinite results of the multipliers.
    pub fn parse(text: &str, file: &str) -> Result<(Self, Vec<Diagnostic>), AvlError> {
        let mut source = Source::new(text, file);
        let mut out = Self {
            length_unit: Unit {
                factor: 1.0,
                name: "Lunit".to_owned(),
            },
            mass_unit: Unit {
                factor: 1.0,
                name: "Munit".to_owned(),
            },
            time_unit: Unit {
                factor: 1.0,
                name: "Tunit".to_owned(),
            },
            gravity: None,
            density: None,
            items: Vec::new(),
        };
        let mut diagnostics = Vec::new();
        let mut factors = [1.0; COLUMNS];
        let mut addends = [0.0; COLUMNS];
        while let Some(line) = source.read() {
            if line.is_blank() || line.text.starts_with(['#', '!']) {
                continue;
            }
            let read = match line.text.chars().next() {
                Some('*') => numbers(&line, line.text.get(1..).unwrap_or("")).map(|n| copy(&n, &mut factors)),
                Some('+') => numbers(&line, line.text.get(1..).unwrap_or("")).map(|n| copy(&n, &mut addends)),
                _ => match line.text.split_once('=') {
                    Some((name, value)) if !name.is_empty() && out.set(name, value, &line)? => Ok(()),
                    _ => out.push_item(&line, &factors, &addends)?,
                },
            };
            if let Err(message) = read {
                diagnostics.push(line.diagnostic("mass", message));
            }
        }
        if source.len() == 0 || text.trim().is_empty() {
            let expected = "an AVL mass file".to_owned();
            return Err(AvlError::Empty {
                file: file.to_owned(),
                expected,
            });
        }
        if out.items.is_empty() {
            return Err(AvlError::Missing {
                file: file.to_owned(),
                line: 1,
                field: "mass x y z Ixx Iyy Izz Ixy Ixz Iyz".to_owned(),
                cure: "give at least one line of numbers",
            });
        }
        Ok((out, diagnostics))
    }

    /// Takes `name = value`; false when the name is none of AVL's.
    fn set(&mut self, name: &str, value: &str, line: &Line<'_>) -> Result<bool, AvlError> {
        let value = value.trim();
        let (number, unit) = value.split_once([' ', '\t']).unwrap_or((value, ""));
        let column = line.text.find('=').map_or(0, |i| i + 1);
        // AVL asks in this order; `g` is any other name with that letter.
        let field = ["Lunit", "Munit", "Tunit", "g", "rho"]
            .into_iter()
            .find(|f| name.contains(f));
        let Some(field) = field else { return Ok(false) };
        let number = line.parse_real(number.split('!').next().unwrap_or(""), column, field)?;
        let unit = unit.split('!').next().unwrap_or("").trim();
        let target = match field {
            "Lunit" => &mut self.length_unit,
            "Munit" => &mut self.mass_unit,
            "Tunit" => &mut self.time_unit,
            "g" => {
                self.gravity = Some(number);
                return Ok(true);
            }
            _ => {
                self.density = Some(number);
                return Ok(true);
            }
        };
        if number <= 0.0 {
            return Err(line.syntax(format!("a positive size for {field}, not {number}")));
        }
        target.factor = number;
        if !unit.is_empty() {
            unit.clone_into(&mut target.name);
        }
        Ok(true)
    }

    /// Takes a line of masses. The inner error is a remark.
    fn push_item(
        &mut self,
        line: &Line<'_>,
        factors: &[f64; COLUMNS],
        addends: &[f64; COLUMNS],
    ) -> Result<Result<(), String>, AvlError> {
        let (data, comment) = line.text.split_once('!').unwrap_or((line.text, ""));
        let found = match numbers(line, data) {
            Ok(found) => found,
            Err(message) => return Ok(Err(message)),
        };
        if found.is_empty() {
            return Ok(Err(format!(
                "`{}` is no mass: ignored, as AVL does",
                excerpt(line.text)
            )));
        }
        let mut values = [0.0; COLUMNS];
        copy(&found, &mut values);
        for ((value, factor), addend) in values.iter_mut().zip(factors).zip(addends) {
            *value = factor * *value + addend;
            if !value.is_finite() {
                let (field, found) = ("mass".to_owned(), value.to_string());
                return Err(AvlError::NotFinite {
                    at: line.at(None),
                    field,
                    found,
                });
            }
        }
        let [mass, x, y, z, ixx, iyy, izz, ixy, ixz, iyz] = values;
        self.items.push(MassItem {
            mass,
            position: [x, y, z],
            moments: [ixx, iyy, izz],
            products: [ixy, ixz, iyz],
            comment: comment.trim().to_owned(),
        });
        Ok(Ok(()))
    }

    /// The text of a `.mass` file that reads back as this one.
    ///
    /// # Errors
    /// [`AvlError::DoesNotFit`] for a number that is not finite; [`AvlError::BadText`] for a comment or name
    /// with a line end.
    pub fn to_text(&self) -> Result<String, AvlError> {
        let mut out = String::new();
        for (name, unit) in [
            ("Lunit", &self.length_unit),
            ("Munit", &self.mass_unit),
            ("Tunit", &self.time_unit),
        ] {
            let _ = writeln!(
                out,
                "{name} = {} {}",
                number(name, unit.factor)?,
                one_line(name, &unit.name)?
            );
        }
        for (name, value) in [("g", self.gravity), ("rho", self.density)] {
            if let Some(value) = value {
                let _ = writeln!(out, "{name} = {}", number(name, value)?);
            }
        }
        out.push_str("#  mass  x  y  z  Ixx  Iyy  Izz  Ixy  Ixz  Iyz\n");
        for item in &self.items {
            let values = [item.mass]
                .into_iter()
                .chain(item.position)
                .chain(item.moments)
                .chain(item.products);
            let values: Vec<String> = values.map(|v| number("mass", v)).collect::<Result<_, _>>()?;
            out.push_str(&values.join(" "));
            if !item.comment.is_empty() {
                let _ = write!(out, "  ! {}", one_line("comment", &item.comment)?);
            }
            out.push('\n');
        }
        Ok(out)
    }
}

/// Numbers of a line as AVL reads them: between blanks and commas, at most ten.
fn numbers(line: &Line<'_>, data: &str) -> Result<Vec<f64>, String> {
    let data = data.split('!').next().unwrap_or("");
    let mut out = Vec::new();
    for item in items(data).into_iter().take(COLUMNS) {
        match item {
            Item::Number { value, repeat: 1, .. } => out.push(value),
            _ => {
                return Err(format!(
                    "`{}` is not a line of numbers: ignored, as AVL does",
                    excerpt(line.text)
                ));
            }
        }
    }
    Ok(out)
}

/// The numbers that a line gives; the others stay.
fn copy(numbers: &[f64], target: &mut [f64; COLUMNS]) {
    for (target, &number) in target.iter_mut().zip(numbers) {
        *target = number;
    }
}

/// Shortest form that reads back the same.
fn number(field: &str, value: f64) -> Result<String, AvlError> {
    if value.is_finite() {
        return Ok(format!("{value:?}"));
    }
    let field = field.to_owned();
    Err(AvlError::DoesNotFit {
        field,
        value,
        format: "list-directed",
        cure: "give a finite number",
    })
}

/// A text that stays on its line.
fn one_line<'t>(field: &str, text: &'t str) -> Result<&'t str, AvlError> {
    let bad = |reason| {
        let (field, text) = (field.to_owned(), text.to_owned());
        Err(AvlError::BadText { field, text, reason })
    };
    if text.contains(['\n', '\r']) {
        bad("contains a line end")
    } else if field != "comment" && text.contains('!') {
        bad("contains `!`, which starts a comment")
    } else if text.trim() != text {
        bad("begins or ends with a blank, which is dropped")
    } else {
        Ok(text)
    }
}
