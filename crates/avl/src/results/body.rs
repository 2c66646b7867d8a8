//! Forces of each body (`.fb`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::run_state::read_reference;
use super::{AxisOrientation, Reference, mrf};
use crate::error::AvlError;
use crate::source::{Field, Line, Source, columns, f};

/// Content of an `.fb` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyForces {
    /// Axes of the moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Bodies, mirror images included.
    pub bodies: Vec<BodyForce>,
}

/// Forces of one body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyForce {
    /// Number, from 1.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Length.
    pub length: f64,
    /// Surface area.
    pub area: f64,
    /// Volume.
    pub volume: f64,
    /// Lift over `q Sref`.
    pub c_lift: f64,
    /// Drag over `q Sref`.
    pub c_drag: f64,
    /// Pitching moment over `q Sref Cref`.
    pub c_m: f64,
    /// Side force over `q Sref`.
    pub c_y: f64,
    /// Yawing moment over `q Sref Bref`.
    pub c_n: f64,
    /// Rolling moment over `q Sref Bref`.
    pub c_roll: f64,
}

/// `(I4,3(1X,F9.3),6F8.4,3X,A)`, AVL up to 3.35.
const NARROW: [Field; 9] = [
    f("Length", 1, 9, 3),
    f("Asurf", 1, 9, 3),
    f("Vol", 1, 9, 3),
    f("CL", 0, 8, 4),
    f("CD", 0, 8, 4),
    f("Cm", 0, 8, 4),
    f("CY", 0, 8, 4),
    f("Cn", 0, 8, 4),
    f("Cl", 0, 8, 4),
];

/// `(1X,I4,3(1X,F12.6),6F12.6,3X,A)`, AVL 3.40 on.
const WIDE: [Field; 9] = [
    f("Length", 1, 12, 6),
    f("Asurf", 1, 12, 6),
    f("Vol", 1, 12, 6),
    f("CL", 0, 12, 6),
    f("CD", 0, 12, 6),
    f("Cm", 0, 12, 6),
    f("CY", 0, 12, 6),
    f("Cn", 0, 12, 6),
    f("Cl", 0, 12, 6),
];

impl BodyForces {
    /// Reads an `.fb` file.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::BodyForces)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }
}

/// The numbers of one body, in AVL's order.
fn body(line: &Line<'_>, index: usize, name: String, values: &[f64]) -> Result<BodyForce, AvlError> {
    let &[length, area, volume, c_lift, c_drag, c_m, c_y, c_n, c_roll] = values else {
        return Err(line.syntax("nine numbers"));
    };
    Ok(BodyForce {
        index,
        name,
        length,
        area,
        volume,
        c_lift,
        c_drag,
        c_m,
        c_y,
        c_n,
        c_roll,
    })
}

fn read_text(source: &mut Source<'_>) -> Result<BodyForces, AvlError> {
    source.find("Body Forces (referred to Sref")?;
    let line = source.require("the axis orientation")?;
    let axes = AxisOrientation::of(line.text).ok_or_else(|| line.syntax("the axis orientation"))?;
    let reference = read_reference(source)?;
    let heading = source.find("Ibdy")?;
    // `Ibdy` stands under its number, in columns 1 to 4 or 2 to 5.
    let (start, fields) = if heading.text.starts_with("Ibdy") {
        (0, &NARROW)
    } else {
        (1, &WIDE)
    };
    let end = start + 4 + fields.iter().map(|f| f.skip + f.width).sum::<usize>();
    let mut bodies = Vec::new();
    loop {
        let line = source.require("the closing line of dashes")?;
        if line.is_rule() {
            return Ok(BodyForces {
                axes,
                reference,
                bodies,
            });
        }
        let numbers = Line {
            text: columns(line.text, 0, end),
            ..line
        };
        let (index, values) = numbers.indexed_row("Ibdy", start, 4, fields)?;
        let name = columns(line.text, end, 256).trim().to_owned();
        bodies.push(body(&line, index, name, &values)?);
    }
}

fn read_mrf(source: &mut Source<'_>) -> Result<BodyForces, AvlError> {
    mrf::opening(source)?;
    let axes = mrf::axes(source)?;
    let reference = mrf::reference(source)?;
    let count = mrf::count(source, "# bodies")?;
    let mut bodies = Vec::new();
    for _ in 0..count {
        mrf::word(source, "BODY")?;
        let name = source.require("the body's name")?.text.trim().to_owned();
        let line = mrf::labelled(source, "Body Forces (referred to Sref")?;
        let names = ["Length", "Asurf", "Vol", "CL", "CD", "Cm", "CY", "Cn", "Cl"];
        let values = mrf::reals(&line, 5, names)?;
        bodies.push(body(&line, line.integer(0, 4, "Ibdy")?, name, &values)?);
    }
    Ok(BodyForces {
        axes,
        reference,
        bodies,
    })
}
