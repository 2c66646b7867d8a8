//! Relatives of the strip file: forces in body axes (`.fsb`) and spanwise loading (`.cnc`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::run_state::read_reference;
use super::strip::SurfaceHead;
use super::{AxisOrientation, Reference, mrf};
use crate::error::AvlError;
use crate::source::{Field, Line, Source, f, g};

/// Content of an `.fsb` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyAxesStripForces {
    /// Axes of the forces and moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point.
    pub reference: Reference,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<BodyAxesSurface>,
}

/// One surface of an `.fsb` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyAxesSurface {
    /// Number, from 1.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Chordwise vortices.
    pub n_chord: usize,
    /// Strips.
    pub n_span: usize,
    /// Number of the first strip.
    pub first_strip: usize,
    /// Area.
    pub area: f64,
    /// Average chord.
    pub average_chord: f64,
    /// Force over `q Sref`.
    pub force: [f64; 3],
    /// Moment over `q Sref Bref`, `q Sref Cref`, `q Sref Bref`.
    pub moment: [f64; 3],
    /// Strips.
    pub strips: Vec<BodyAxesStrip>,
}

/// One strip of an `.fsb` file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyAxesStrip {
    /// Number, from 1.
    pub index: usize,
    /// Quarter chord, geometry axes.
    pub quarter_chord: [f64; 3],
    /// Chord.
    pub chord: f64,
    /// Area.
    pub area: f64,
    /// Dihedral, in degrees.
    pub dihedral_deg: f64,
    /// Incidence, in degrees.
    pub incidence_deg: f64,
    /// Force over `q` times strip area.
    pub force: [f64; 3],
    /// Moment about the quarter chord over `q` times strip area and chord.
    pub moment: [f64; 3],
    /// Force normal to the chord over `q` times strip area.
    pub normal: f64,
    /// Force along the chord over `q` times strip area.
    pub axial: f64,
}

/// Content of a `.cnc` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StripLoads {
    /// Strips of all surfaces.
    pub strips: Vec<StripLoad>,
}

/// One line of a `.cnc` file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StripLoad {
    /// Middle of the strip's first bound vortex, geometry axes.
    pub position: [f64; 3],
    /// Chord times normal force coefficient.
    pub cnc: f64,
    /// Lift coefficient.
    pub cl: f64,
    /// Chord.
    pub chord: f64,
    /// Width.
    pub width: f64,
    /// Area.
    pub area: f64,
}

/// `(2X,I4,3(1X,F10.5),4(1X,F10.5),3X,8(1X,G12.5))`.
const ROW: [Field; 15] = [
    f("Xc/4", 1, 10, 5),
    f("Yc/4", 1, 10, 5),
    f("Zc/4", 1, 10, 5),
    f("Chord", 1, 10, 5),
    f("Area", 1, 10, 5),
    f("Dihedral", 1, 10, 5),
    f("Incid", 1, 10, 5),
    g("CFXstrp", 4, 12),
    g("CFYstrp", 1, 12),
    g("CFZstrp", 1, 12),
    g("CMXstrp", 1, 12),
    g("CMYstrp", 1, 12),
    g("CMZstrp", 1, 12),
    g("CNRMstrp", 1, 12),
    g("CAXLstrp", 1, 12),
];

impl BodyAxesStripForces {
    /// Reads an `.fsb` file.
    ///
    /// # Errors
    /// As [`StripForces::parse`](super::StripForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::BodyAxesStripForces)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => {
                Err(source.truncated("a text layout: AVL has no machine-readable form of this file"))
            }
        }
    }
}

fn read_text(source: &mut Source<'_>) -> Result<BodyAxesStripForces, AvlError> {
    source.find("Surface and Strip Forces by surface")?;
    let reference = read_reference(source)?;
    let mut out = BodyAxesStripForces {
        reference,
        ..Default::default()
    };
    loop {
        let line = source.require_text("the closing line of dashes")?;
        if line.is_rule() {
            return Ok(out);
        }
        let head = SurfaceHead::read(source, &line)?;
        source.find("Body Axes Forces referred to Sref")?;
        let line = source.require("the axis orientation")?;
        out.axes = AxisOrientation::of(line.text).ok_or_else(|| line.syntax("the axis orientation"))?;
        let [fx, mx] = source.find_reals([("CFXsurf", 12), ("CMXsurf", 12)])?;
        let [fy, my] = source.find_reals([("CFYsurf", 12), ("CMYsurf", 12)])?;
        let [fz, mz] = source.find_reals([("CFZsurf", 12), ("CMZsurf", 12)])?;
        source.find("CFXstrp")?;
        let mut strips = Vec::new();
        for k in 0..head.n_span {
            let line = source.require("a row for each strip that the surface announces")?;
            let strip = read_row(&line)?;
            let expected = head.first_strip + k;
            if strip.index != expected {
                return Err(line.syntax(format!("strip {expected}")));
            }
            strips.push(strip);
        }
        let SurfaceHead {
            index,
            name,
            n_chord,
            n_span,
            first_strip,
            area,
            average_chord,
        } = head;
        let (force, moment) = ([fx, fy, fz], [mx, my, mz]);
        out.surfaces.push(BodyAxesSurface {
            index,
            name,
            n_chord,
            n_span,
            first_strip,
            area,
            average_chord,
            force,
            moment,
            strips,
        });
    }
}

fn read_row(line: &Line<'_>) -> Result<BodyAxesStrip, AvlError> {
    let (index, values) = line.indexed_row("j", 2, 4, &ROW)?;
    let &[
        x,
        y,
        z,
        chord,
        area,
        dihedral_deg,
        incidence_deg,
        fx,
        fy,
        fz,
        mx,
        my,
        mz,
        normal,
        axial,
    ] = values.as_slice()
    else {
        return Err(line.syntax("fifteen numbers"));
    };
    let (quarter_chord, force, moment) = ([x, y, z], [fx, fy, fz], [mx, my, mz]);
    Ok(BodyAxesStrip {
        index,
        quarter_chord,
        chord,
        area,
        dihedral_deg,
        incidence_deg,
        force,
        moment,
        normal,
        axial,
    })
}

/// `(8(F12.6,1X))` of AVL 3.40 on.
const LOADING: [Field; 8] = [
    f("x", 0, 12, 6),
    f("y", 1, 12, 6),
    f("z", 1, 12, 6),
    f("cnc", 1, 12, 6),
    f("cl", 1, 12, 6),
    f("c", 1, 12, 6),
    f("dy", 1, 12, 6),
    f("area", 1, 12, 6),
];

/// `(3(F8.3,1X),2(F10.4,1X),2(F8.4,1X),F9.4)` of AVL up to 3.35.
const OLD_LOADING: [Field; 8] = [
    f("x", 0, 8, 3),
    f("y", 1, 8, 3),
    f("z", 1, 8, 3),
    f("cnc", 1, 10, 4),
    f("cl", 1, 10, 4),
    f("c", 1, 8, 4),
    f("dy", 1, 8, 4),
    f("area", 1, 9, 4),
];

impl StripLoads {
    /// Reads a `.cnc` file.
    ///
    /// # Errors
    /// As [`StripForces::parse`](super::StripForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::StripLoads)?;
        match layout {
            Layout::Text => read_loading(&mut source),
            Layout::Mrf => read_mrf_loading(&mut source),
        }
    }
}

fn read_loading(source: &mut Source<'_>) -> Result<StripLoads, AvlError> {
    let mut strips = Vec::new();
    while let Some(line) = source.read() {
        if line.is_blank() {
            continue;
        }
        // Eight twelves and seven blanks are 103 columns; the old row has 74.
        let fields = if line.text.trim_end().len() > 80 {
            &LOADING
        } else {
            &OLD_LOADING
        };
        let end = fields.iter().map(|f| f.skip + f.width).sum();
        source.refuse_cut(&line, end, "the end of a strip")?;
        strips.push(load(&line, &line.row(0, fields)?)?);
    }
    Ok(StripLoads { strips })
}

fn load(line: &Line<'_>, values: &[f64]) -> Result<StripLoad, AvlError> {
    let &[x, y, z, cnc, cl, chord, width, area] = values else {
        return Err(line.syntax("eight numbers"));
    };
    Ok(StripLoad {
        position: [x, y, z],
        cnc,
        cl,
        chord,
        width,
        area,
    })
}

fn read_mrf_loading(source: &mut Source<'_>) -> Result<StripLoads, AvlError> {
    mrf::opening(source)?;
    source.require("`Strip Loadings:`")?;
    let count = mrf::count(source, "# strips")?;
    let mut strips = Vec::new();
    for _ in 0..count {
        let line = source.require("a row for each strip")?;
        let values = mrf::reals(&line, 0, LOADING.map(|f| f.name))?;
        strips.push(load(&line, &values)?);
    }
    Ok(StripLoads { strips })
}
