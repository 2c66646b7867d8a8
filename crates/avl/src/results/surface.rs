//! Forces of each surface (`.fn`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::run_state::read_reference;
use super::{AxisOrientation, Reference, mrf};
use crate::error::AvlError;
use crate::source::{Field, Source, columns, f};

/// Content of an `.fn` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceForces {
    /// Axes of the moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<SurfaceForce>,
}

/// Forces of one surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceForce {
    /// Number, from 1.
    pub index: usize,
    /// Name; mirror images end in ` (YDUP)`.
    pub name: String,
    /// Area.
    pub area: f64,
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
    /// Induced drag over `q Sref`.
    pub c_drag_induced: f64,
    /// Profile drag over `q Sref`.
    pub c_drag_viscous: f64,
    /// Average chord.
    pub average_chord: f64,
    /// Lift over `q` times the surface's own area.
    pub cl_local: f64,
    /// Drag over `q` times the surface's own area.
    pub cd_local: f64,
    /// Profile drag over `q` times the surface's own area.
    pub cdv_local: f64,
    /// Moment about the leading edge; AVL up to 3.35 only.
    pub cm_le_local: Option<f64>,
}

/// `(I2,1X,F9.3,8F8.4,3X,A)`: no blanks between the numbers, so they run together.
const TOTALS: [Field; 9] = [
    f("Area", 1, 9, 3),
    f("CL", 0, 8, 4),
    f("CD", 0, 8, 4),
    f("Cm", 0, 8, 4),
    f("CY", 0, 8, 4),
    f("Cn", 0, 8, 4),
    f("Cl", 0, 8, 4),
    f("CDi", 0, 8, 4),
    f("CDv", 0, 8, 4),
];

/// `(2X,I2,F10.3,F10.3,4(1X,F8.4),2X,A)`; the last number up to AVL 3.35 only.
const LOCALS: [Field; 6] = [
    f("Ssurf", 0, 10, 3),
    f("Cave", 0, 10, 3),
    f("cl", 1, 8, 4),
    f("cd", 1, 8, 4),
    f("cdv", 1, 8, 4),
    f("cm_LE", 1, 8, 4),
];

impl SurfaceForces {
    /// Reads an `.fn` file.
    ///
    /// # Errors
    /// [`AvlError::WrongKind`] for another kind of file; [`AvlError::Truncated`], [`AvlError::Count`],
    /// [`AvlError::Number`], [`AvlError::Overflow`], [`AvlError::NotFinite`], [`AvlError::Syntax`] for a
    /// damaged one.
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::SurfaceForces)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }
}

/// One row: number, fields, and the name behind them.
fn read_row(
    line: &crate::source::Line<'_>,
    (start, width): (usize, usize),
    fields: &[Field],
) -> Result<(usize, Vec<f64>, String), AvlError> {
    let end = start + width + fields.iter().map(|f| f.skip + f.width).sum::<usize>();
    let numbers = crate::source::Line {
        text: columns(line.text, 0, end),
        ..*line
    };
    let (index, values) = numbers.indexed_row("n", start, width, fields)?;
    Ok((index, values, columns(line.text, end, 256).trim().to_owned()))
}

fn read_text(source: &mut Source<'_>) -> Result<SurfaceForces, AvlError> {
    source.find("Surface Forces (referred to Sref")?;
    let line = source.require("the axis orientation")?;
    let axes = AxisOrientation::of(line.text).ok_or_else(|| line.syntax("the axis orientation"))?;
    let reference = read_reference(source)?;
    let mut surfaces = Vec::new();
    source.find("Area")?;
    loop {
        let line = source.require("the table of surface forces referred to Ssurf")?;
        if line.is_blank() {
            break;
        }
        let (index, values, name) = read_row(&line, (0, 2), &TOTALS)?;
        let &[
            area,
            c_lift,
            c_drag,
            c_m,
            c_y,
            c_n,
            c_roll,
            c_drag_induced,
            c_drag_viscous,
        ] = values.as_slice()
        else {
            return Err(line.syntax("nine numbers"));
        };
        surfaces.push(SurfaceForce {
            index,
            name,
            area,
            c_lift,
            c_drag,
            c_m,
            c_y,
            c_n,
            c_roll,
            c_drag_induced,
            c_drag_viscous,
            ..Default::default()
        });
    }
    let heading = source.find("Cave ")?;
    let heading = if heading.text.contains("Ssurf ") && heading.text.contains("cdv") {
        heading
    } else {
        source.find("cdv")?
    };
    let fields = LOCALS
        .get(..if heading.text.contains("cm_LE") { 6 } else { 5 })
        .unwrap_or(&LOCALS);
    for surface in &mut surfaces {
        let line = source.require("a row of surface forces referred to Ssurf for each surface")?;
        let (index, values, _) = read_row(&line, (2, 2), fields)?;
        if index != surface.index {
            return Err(line.syntax(format!("surface {}", surface.index)));
        }
        if let &[_, average_chord, cl_local, cd_local, cdv_local, ref rest @ ..] = values.as_slice() {
            surface.average_chord = average_chord;
            surface.cl_local = cl_local;
            surface.cd_local = cd_local;
            surface.cdv_local = cdv_local;
            surface.cm_le_local = rest.first().copied();
        }
    }
    let end = source.require("the closing line of dashes")?;
    if end.is_rule() {
        Ok(SurfaceForces {
            axes,
            reference,
            surfaces,
        })
    } else {
        Err(end.syntax("a line of dashes"))
    }
}

fn read_mrf(source: &mut Source<'_>) -> Result<SurfaceForces, AvlError> {
    mrf::opening(source)?;
    let axes = mrf::axes(source)?;
    let reference = mrf::reference(source)?;
    let count = mrf::count(source, "# surfaces")?;
    let mut surfaces = Vec::new();
    for _ in 0..count {
        mrf::word(source, "SURFACE")?;
        let name = source.require("the surface's name")?.text.trim().to_owned();
        let line = mrf::labelled(source, "Surface Forces (referred to Sref")?;
        let index = line.integer(0, 3, "n")?;
        let names = ["Area", "CL", "CD", "Cm", "CY", "Cn", "Cl", "CDi", "CDv"];
        let [
            area,
            c_lift,
            c_drag,
            c_m,
            c_y,
            c_n,
            c_roll,
            c_drag_induced,
            c_drag_viscous,
        ] = mrf::reals(&line, 4, names)?;
        let line = mrf::labelled(source, "Surface Forces (referred to Ssurf")?;
        let [_, average_chord, cl_local, cd_local, cdv_local] =
            mrf::reals(&line, 4, ["Ssurf", "Cave", "cl", "cd", "cdv"])?;
        surfaces.push(SurfaceForce {
            index,
            name,
            area,
            c_lift,
            c_drag,
            c_m,
            c_y,
            c_n,
            c_roll,
            c_drag_induced,
            c_drag_viscous,
            average_chord,
            cl_local,
            cd_local,
            cdv_local,
            cm_le_local: None,
        });
    }
    Ok(SurfaceForces {
        axes,
        reference,
        surfaces,
    })
}
