//! Output of the MODE menu: eigenvalues and the rigid-body system matrix.

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, is_system_heading, open};
use crate::error::AvlError;
use crate::source::{Line, columns};

/// Content of an `.eig` file. AVL does not sort: the order is its eigenvalue routine's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Eigenvalues {
    /// Title of the geometry file.
    pub title: String,
    /// Eigenvalues of all run cases.
    pub eigenvalues: Vec<Eigenvalue>,
}

/// One eigenvalue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Eigenvalue {
    /// Run case, from 1.
    pub run_case: usize,
    /// Real part, in 1/s when the mass file's time unit is the second.
    pub sigma: f64,
    /// Imaginary part, in rad/s when the mass file's time unit is the second.
    pub omega_rad_s: f64,
}

/// Content of a system matrix file: `x' = A x + B u`.
///
/// State order u w q theta v p r phi x y z psi, speeds and positions in the mass file's units, angles in rad;
/// controls in degrees (times gain). AVL up to 3.35 prints geometry axes (x aft, z up), later versions body
/// axes (x forward, z down).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SystemMatrix {
    /// Names of the states as printed.
    pub states: Vec<String>,
    /// Names of the controls as printed.
    pub controls: Vec<String>,
    /// A, one row per state.
    pub a: Vec<Vec<f64>>,
    /// B, one row per state.
    pub b: Vec<Vec<f64>>,
}

impl Eigenvalues {
    /// Reads an `.eig` file: lines of `(1X,I7,2G18.8)` below three comment lines.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, _) = open(text, file, FileKind::Eigenvalues)?;
        source.seek(0);
        let mut out = Self::default();
        while let Some(line) = source.read() {
            let text = line.text.trim();
            if let Some(comment) = text.strip_prefix('#') {
                if out.title.is_empty() {
                    out.title = comment.trim().to_owned();
                }
            } else if !text.is_empty() {
                // Eight columns and twice eighteen, of which the last four may be blank.
                source.refuse_cut(&line, 40, "the end of an eigenvalue")?;
                out.eigenvalues.push(eigenvalue(&line)?);
            }
        }
        Ok(out)
    }
}

fn eigenvalue(line: &Line<'_>) -> Result<Eigenvalue, AvlError> {
    let mut words = line.text.split_whitespace();
    let mut word = |name: &str| {
        words
            .next()
            .ok_or_else(|| line.syntax(format!("run case, sigma, omega; no {name}")))
    };
    Ok(Eigenvalue {
        run_case: line.parse_integer(word("run case")?, 0, "Run case")?,
        sigma: line.parse_real(word("sigma")?, 8, "sigma")?,
        omega_rad_s: line.parse_real(word("omega")?, 26, "omega")?,
    })
}

/// Number of states.
const STATES: usize = 12;

/// Controls that one line holds; more go to a second line.
const CONTROLS_PER_LINE: usize = 12;

impl SystemMatrix {
    /// Reads a system matrix file: a heading, then twelve rows `(1X,12F10.4,3X,12G12.4)`; OptVL prints A with
    /// `12G12.4`.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse). More than twelve controls are refused: AVL
    /// breaks their lines inside the format of A.
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, _) = open(text, file, FileKind::SystemMatrix)?;
        let heading = source.require("the heading of the states")?;
        let (states, names) = heading.text.split_once('|').unwrap_or((heading.text, ""));
        let mut out = Self {
            states: states.split_whitespace().map(str::to_owned).collect(),
            controls: control_names(names),
            ..Self::default()
        };
        for _ in 0..STATES {
            let line = source.require("twelve rows of the system matrix")?;
            let (a, b) = system_row(&line, out.controls.len())?;
            let end = if out.controls.is_empty() {
                1 + 10 * STATES
            } else {
                120 + 12 * out.controls.len()
            };
            source.refuse_cut(&line, end, "the end of the system matrix")?;
            out.a.push(a);
            out.b.push(b);
        }
        match source.lines().skip(source.position()).find(|l| !l.is_blank()) {
            None => Ok(out),
            Some(line) if is_system_heading(line.text) => {
                Err(line.syntax("one run case per file; write each system matrix to a file of its own"))
            }
            Some(line) => {
                Err(line
                    .syntax("nothing behind the twelve rows (AVL breaks the lines of more than 12 controls)"))
            }
        }
    }
}

/// Names of twelve columns each, two blanks behind the bar.
fn control_names(text: &str) -> Vec<String> {
    let count = (text.trim_end().chars().count().saturating_sub(2)).div_ceil(12);
    (0..count.min(CONTROLS_PER_LINE))
        .map(|k| columns(text, 2 + 12 * k, 12).trim().to_owned())
        .collect()
}

/// One row of A and B.
fn system_row(line: &Line<'_>, controls: usize) -> Result<(Vec<f64>, Vec<f64>), AvlError> {
    // The point of `F10.4` stands in the sixth column; stars fill the field.
    let is_fixed = (0..STATES).all(|k| {
        let text = columns(line.text, 1 + 10 * k, 10);
        columns(text, 5, 1) == "." || text.starts_with("***")
    });
    let width = if is_fixed { 10 } else { 12 };
    let a = (0..STATES)
        .map(|j| line.real(1 + width * j, width, "A"))
        .collect::<Result<_, _>>()?;
    let start = 1 + width * STATES + 3;
    let b = (0..controls)
        .map(|k| line.real(start + 12 * k, 12, "B"))
        .collect::<Result<_, _>>()?;
    Ok((a, b))
}
