//! Loads of each vortex (`.fe`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::strip::{SurfaceHead, read_surface_coefficients};
use super::{AxisOrientation, Reference, SurfaceCoefficients, mrf};
use crate::error::AvlError;
use crate::source::{Field, Line, Source, f, line_reals};

/// Content of an `.fe` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ElementForces {
    /// Axes of the surfaces' moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point; MRF only.
    pub reference: Option<Reference>,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<ElementSurface>,
}

/// One surface of an `.fe` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ElementSurface {
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
    /// Coefficients of the whole surface.
    pub coefficients: SurfaceCoefficients,
    /// Strips.
    pub strips: Vec<ElementStrip>,
}

/// One strip of an `.fe` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ElementStrip {
    /// Number, from 1 over the whole aircraft.
    pub index: usize,
    /// Number of the first vortex, from 1 over the whole aircraft.
    pub first_vortex: usize,
    /// Leading edge, geometry axes: x aft, y right, z up.
    pub leading_edge: [f64; 3],
    /// Chord.
    pub chord: f64,
    /// Width.
    pub width: f64,
    /// Area.
    pub area: f64,
    /// Incidence, in degrees.
    pub incidence_deg: f64,
    /// Dihedral, in degrees.
    pub dihedral_deg: f64,
    /// Lift coefficient.
    pub cl: f64,
    /// Drag coefficient.
    pub cd: f64,
    /// Profile drag coefficient.
    pub cdv: f64,
    /// Normal force coefficient.
    pub cn: f64,
    /// Axial force coefficient.
    pub ca: f64,
    /// Chord times normal force coefficient.
    pub cnc: f64,
    /// Downwash in the Trefftz plane, in rad.
    pub wake_downwash: f64,
    /// Moment coefficient about the leading edge.
    pub cm_le: f64,
    /// Moment coefficient about the quarter chord.
    pub cm_c4: f64,
    /// Vortices from leading to trailing edge.
    pub elements: Vec<Element>,
}

/// One horseshoe vortex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// Number, from 1 over the whole aircraft.
    pub index: usize,
    /// Middle of the bound vortex, geometry axes.
    pub position: [f64; 3],
    /// Chordwise length of the element.
    pub dx: f64,
    /// Slope of the camber line.
    pub slope: f64,
    /// Pressure difference coefficient, lower minus upper.
    pub delta_cp: f64,
}

/// `(1X,I4,6(2X,F10.5))`; AVL up to 3.35 `(2X,I3,...)`.
const ELEMENT: [Field; 6] = [
    f("X", 2, 10, 5),
    f("Y", 2, 10, 5),
    f("Z", 2, 10, 5),
    f("DX", 2, 10, 5),
    f("Slope", 2, 10, 5),
    f("dCp", 2, 10, 5),
];

impl ElementForces {
    /// Reads an `.fe` file.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::ElementForces)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }
}

impl ElementSurface {
    /// A surface without strips yet.
    fn new(head: SurfaceHead, coefficients: SurfaceCoefficients) -> Self {
        let SurfaceHead {
            index,
            name,
            n_chord,
            n_span,
            first_strip,
            area,
            average_chord,
        } = head;
        Self {
            index,
            name,
            n_chord,
            n_span,
            first_strip,
            area,
            average_chord,
            coefficients,
            strips: Vec::new(),
        }
    }
}

fn read_text(source: &mut Source<'_>) -> Result<ElementForces, AvlError> {
    source.find("Vortex Strengths")?;
    let line = source.find("axis orientation")?;
    let axes = AxisOrientation::of(line.text).ok_or_else(|| line.syntax("the axis orientation"))?;
    let mut out = ElementForces {
        axes,
        ..Default::default()
    };
    loop {
        let line = source.require_text("the closing line of dashes")?;
        if line.is_rule() {
            return Ok(out);
        }
        if is_stars(&line) {
            continue;
        }
        let head = SurfaceHead::read(source, &line)?;
        let coefficients = read_surface_coefficients(source)?;
        let mut surface = ElementSurface::new(head, coefficients);
        let stars = source.require("a line of stars")?;
        if !is_stars(&stars) {
            return Err(stars.syntax("a line of stars"));
        }
        for _ in 0..surface.n_span {
            surface.strips.push(read_strip(source)?);
        }
        out.surfaces.push(surface);
    }
}

/// The lines of stars around a surface's head.
fn is_stars(line: &Line<'_>) -> bool {
    let text = line.text.trim();
    text.len() > 20 && text.bytes().all(|b| b == b'*')
}

fn read_strip(source: &mut Source<'_>) -> Result<ElementStrip, AvlError> {
    let line = source.require_text("`Strip #` for each strip that the surface announces")?;
    let head = line.text.trim_start();
    if !head.starts_with("Strip #") {
        return Err(line.syntax("`Strip #`"));
    }
    let number = head
        .strip_prefix("Strip #")
        .unwrap_or("")
        .split_whitespace()
        .next()
        .unwrap_or("");
    let index = line.parse_integer(number, 8, "Strip #")?;
    let n_chord = line
        .labelled_integer("# Chordwise", 4)
        .unwrap_or_else(|| Err(line.syntax("`# Chordwise =`")))?;
    let first_vortex = line
        .labelled_integer("First Vortex", 4)
        .unwrap_or_else(|| Err(line.syntax("`First Vortex =`")))?;
    let [x, chord, incidence_deg] =
        source.find_reals([("Xle", 10), ("Ave. Chord", 10), ("Incidence", 10)])?;
    let [y, width, area] = source.find_reals([("Yle", 10), ("Strip Width", 10), ("Strip Area", 12)])?;
    let [z, dihedral_deg] = source.find_reals([("Zle", 10), ("Strip Dihed.", 10)])?;
    let [cl, cd, cdv] = source.find_reals([("cl", 10), ("cd", 10), ("cdv", 10)])?;
    let [cn, ca, cnc, wake_downwash] =
        source.find_reals([("cn", 10), ("ca", 10), ("cnc", 10), ("wake dnwsh", 10)])?;
    let line = source.require("`cmLE=`")?;
    let name = if line.after_label("cmLE").is_some() {
        "cmLE"
    } else {
        "CMLE_LSTRP"
    };
    let [cm_le, cm_c4] = line_reals(&line, [(name, 10), ("cm c/4", 10)])?;
    let mut strip = ElementStrip {
        index,
        first_vortex,
        leading_edge: [x, y, z],
        chord,
        width,
        area,
        incidence_deg,
        dihedral_deg,
        cl,
        cd,
        cdv,
        cn,
        ca,
        cnc,
        wake_downwash,
        cm_le,
        cm_c4,
        elements: Vec::new(),
    };
    source.find("dCp")?;
    for _ in 0..n_chord {
        let line = source.require("a line for each chordwise vortex")?;
        let (index, values) = line.indexed_row("I", 1, 4, &ELEMENT)?;
        strip.elements.push(element(&line, index, &values)?);
    }
    Ok(strip)
}

fn element(line: &Line<'_>, index: usize, values: &[f64]) -> Result<Element, AvlError> {
    match *values {
        [x, y, z, dx, slope, delta_cp] => Ok(Element {
            index,
            position: [x, y, z],
            dx,
            slope,
            delta_cp,
        }),
        _ => Err(line.syntax("X, Y, Z, DX, Slope, dCp")),
    }
}

fn read_mrf(source: &mut Source<'_>) -> Result<ElementForces, AvlError> {
    mrf::opening(source)?;
    let axes = mrf::axes(source)?;
    let reference = Some(mrf::reference(source)?);
    source.require("`Vortex Strengths (by surface, by strip)`")?;
    let count = mrf::count(source, "surfaces")?;
    let mut surfaces = Vec::new();
    for _ in 0..count {
        let (head, coefficients) = SurfaceHead::read_mrf(source)?;
        let mut surface = ElementSurface::new(head, coefficients);
        for _ in 0..surface.n_span {
            surface.strips.push(read_mrf_strip(source)?);
        }
        surfaces.push(surface);
    }
    Ok(ElementForces {
        axes,
        reference,
        surfaces,
    })
}

fn read_mrf_strip(source: &mut Source<'_>) -> Result<ElementStrip, AvlError> {
    mrf::word(source, "STRIP")?;
    let line = mrf::labelled(source, "Strip #, # Chordwise, First Vortex")?;
    let [index, n_chord, first_vortex] =
        mrf::integers(&line, 4, 0, ["Strip #", "# Chordwise", "First Vortex"])?;
    let line = mrf::labelled(source, "Xle, Ave. Chord")?;
    let names = [
        "Xle",
        "Ave. Chord",
        "Incidence",
        "Yle",
        "Strip Width",
        "Strip Area",
        "Zle",
        "Strip Dihed",
    ];
    let [x, chord, incidence_deg, y, width, area, z, dihedral_deg] = mrf::reals(&line, 0, names)?;
    let line = mrf::labelled(source, "cl, cd, cdv")?;
    let names = [
        "cl",
        "cd",
        "cdv",
        "cn",
        "ca",
        "cnc",
        "wake dnwsh",
        "cmLE",
        "cm c/4",
    ];
    let [cl, cd, cdv, cn, ca, cnc, wake_downwash, cm_le, cm_c4] = mrf::reals(&line, 0, names)?;
    let mut strip = ElementStrip {
        index,
        first_vortex,
        leading_edge: [x, y, z],
        chord,
        width,
        area,
        incidence_deg,
        dihedral_deg,
        cl,
        cd,
        cdv,
        cn,
        ca,
        cnc,
        wake_downwash,
        cm_le,
        cm_c4,
        elements: Vec::new(),
    };
    for _ in 0..n_chord {
        let line = mrf::labelled(source, "I, X, Y, Z")?;
        let values = mrf::reals(&line, 4, ["X", "Y", "Z", "DX", "Slope", "dCp"])?;
        strip
            .elements
            .push(element(&line, line.integer(0, 4, "I")?, &values)?);
    }
    Ok(strip)
}
