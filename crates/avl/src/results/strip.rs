//! Forces of each strip (`.fs`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::run_state::read_reference;
use super::{AxisOrientation, Reference, mrf};
use crate::error::AvlError;
use crate::source::{Field, Line, Source, f};

/// Content of an `.fs` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StripForces {
    /// Axes of the surfaces' moments.
    pub axes: AxisOrientation,
    /// Reference lengths and point; AVL up to 3.35 does not print them here.
    pub reference: Option<Reference>,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<StripSurface>,
}

/// Coefficients of one surface as the strip and element files head it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceCoefficients {
    /// Lift over `q Sref` (`CLsurf`).
    pub c_lift: f64,
    /// Rolling moment over `q Sref Bref` (`Clsurf`).
    pub c_roll: f64,
    /// Side force over `q Sref` (`CYsurf`).
    pub c_y: f64,
    /// Pitching moment over `q Sref Cref` (`Cmsurf`).
    pub c_m: f64,
    /// Drag over `q Sref` (`CDsurf`).
    pub c_drag: f64,
    /// Yawing moment over `q Sref Bref` (`Cnsurf`).
    pub c_n: f64,
    /// Induced drag over `q Sref` (`CDisurf`).
    pub c_drag_induced: f64,
    /// Profile drag over `q Sref` (`CDvsurf`).
    pub c_drag_viscous: f64,
    /// Lift over `q Ssurf`.
    pub cl_local: f64,
    /// Drag over `q Ssurf`.
    pub cd_local: f64,
}

/// One surface of an `.fs` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StripSurface {
    /// Number, from 1.
    pub index: usize,
    /// Name, up to 40 characters; mirror images end in ` (YDUP)`.
    pub name: String,
    /// Chordwise vortices.
    pub n_chord: usize,
    /// Strips.
    pub n_span: usize,
    /// Number of the first strip, from 1 over the whole aircraft.
    pub first_strip: usize,
    /// Area.
    pub area: f64,
    /// Average chord.
    pub average_chord: f64,
    /// Coefficients of the whole surface.
    pub coefficients: SurfaceCoefficients,
    /// Strips.
    pub strips: Vec<Strip>,
}

/// One strip. Positions are at the leading edge of the strip's middle, in geometry axes: x aft, y right, z up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Strip {
    /// Number, from 1 over the whole aircraft.
    pub index: usize,
    /// Leading edge, x aft; AVL 3.40 on.
    pub x_le: Option<f64>,
    /// Leading edge, y right.
    pub y_le: f64,
    /// Leading edge, z up; AVL 3.40 on.
    pub z_le: Option<f64>,
    /// Chord.
    pub chord: f64,
    /// Area.
    pub area: f64,
    /// Chord times lift coefficient normal to the sheet (`c cl`), a length.
    pub c_cl: f64,
    /// Induced angle in the Trefftz plane, in rad.
    pub ai: f64,
    /// Lift coefficient normal to the sweep line (`cl_norm`, `cl_perp`).
    pub cl_norm: f64,
    /// Lift coefficient.
    pub cl: f64,
    /// Drag coefficient.
    pub cd: f64,
    /// Profile drag coefficient.
    pub cdv: f64,
    /// Moment coefficient about the quarter chord, nose up.
    pub cm_c4: f64,
    /// Moment coefficient about the leading edge.
    pub cm_le: Option<f64>,
    /// Centre of pressure over chord; `None` when AVL leaves it out or prints 999.
    pub xcp: Option<f64>,
}

/// Columns of AVL 3.40 on: `(2X,I4,13(1X,F8.4),1X,F8.3)`.
const ROW: [Field; 14] = [
    f("Xle", 1, 8, 4),
    f("Yle", 1, 8, 4),
    f("Zle", 1, 8, 4),
    f("Chord", 1, 8, 4),
    f("Area", 1, 8, 4),
    f("c_cl", 1, 8, 4),
    f("ai", 1, 8, 4),
    f("cl_norm", 1, 8, 4),
    f("cl", 1, 8, 4),
    f("cd", 1, 8, 4),
    f("cdv", 1, 8, 4),
    f("cm_c/4", 1, 8, 4),
    f("cm_LE", 1, 8, 4),
    f("C.P.x/c", 1, 8, 3),
];

/// Columns of AVL up to 3.35: `(2X,I4,11(1X,F8.4),1X,F8.3)`, the last left out outside (-1, 2).
const OLD_ROW: [Field; 12] = [
    f("Yle", 1, 8, 4),
    f("Chord", 1, 8, 4),
    f("Area", 1, 8, 4),
    f("c cl", 1, 8, 4),
    f("ai", 1, 8, 4),
    f("cl_norm", 1, 8, 4),
    f("cl", 1, 8, 4),
    f("cd", 1, 8, 4),
    f("cdv", 1, 8, 4),
    f("cm_c/4", 1, 8, 4),
    f("cm_LE", 1, 8, 4),
    f("C.P.x/c", 1, 8, 3),
];

/// What AVL 3.40 on prints for a centre of pressure that is not defined.
const NO_CENTRE_OF_PRESSURE: f64 = 999.0;

impl StripForces {
    /// Reads an `.fs` file.
    ///
    /// # Errors
    /// [`AvlError::WrongKind`] for another kind of file; [`AvlError::Truncated`] for a file that does not end
    /// in its line of dashes; [`AvlError::Count`] when strips are missing; [`AvlError::Number`],
    /// [`AvlError::Overflow`], [`AvlError::NotFinite`], [`AvlError::Syntax`] for a damaged line.
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::StripForces)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }

    /// The surface of this name; mirror images end in ` (YDUP)`.
    pub fn surface(&self, name: &str) -> Option<&StripSurface> {
        self.surfaces.iter().find(|s| s.name == name)
    }

    /// All strips, surface after surface.
    pub fn strips(&self) -> impl Iterator<Item = &Strip> {
        self.surfaces.iter().flat_map(|s| &s.strips)
    }
}

/// What heads a surface in strip and element files.
pub(crate) struct SurfaceHead {
    pub(crate) index: usize,
    pub(crate) name: String,
    pub(crate) n_chord: usize,
    pub(crate) n_span: usize,
    pub(crate) first_strip: usize,
    pub(crate) area: f64,
    pub(crate) average_chord: f64,
}

impl SurfaceHead {
    /// Reads `Surface # 1     Wing`, already taken from the source, and the two lines below it.
    pub(crate) fn read(source: &mut Source<'_>, line: &Line<'_>) -> Result<Self, AvlError> {
        let text = line.text.trim_start();
        let Some(head) = text.strip_prefix("Surface #") else {
            return Err(line.syntax("`Surface #` or the closing line of dashes"));
        };
        let (number, name) = head.split_at_checked(2).unwrap_or((head, ""));
        let index = line.parse_integer(number, line.text.len() - head.len(), "Surface #")?;
        let counts = source.require("`# Chordwise =`")?;
        let count = |name: &str| {
            counts
                .labelled_integer(name, 4)
                .unwrap_or_else(|| Err(counts.syntax(format!("`{name} =`"))))
        };
        let sizes = source.require("the surface's area and average chord")?;
        let size = |name: &str, long: &str| {
            let value = sizes
                .labelled_real(long, 12)
                .or_else(|| sizes.labelled_real(name, 12));
            value.unwrap_or_else(|| Err(sizes.syntax(format!("`{name} =`"))))
        };
        Ok(Self {
            index,
            name: name.trim().to_owned(),
            n_chord: count("# Chordwise")?,
            n_span: count("# Spanwise")?,
            first_strip: count("First strip")?,
            area: size("Surface area", "Surface area Ssurf")?,
            average_chord: size("Ave. chord", "Ave. chord Cave")?,
        })
    }

    /// The same in machine-readable form, with the coefficients of the surface.
    pub(crate) fn read_mrf(source: &mut Source<'_>) -> Result<(Self, SurfaceCoefficients), AvlError> {
        mrf::word(source, "SURFACE")?;
        let name = source.require("the surface's name")?.text.trim().to_owned();
        let line = mrf::labelled(source, "Surface #, # Chordwise, # Spanwise, First strip")?;
        let names = ["Surface #", "# Chordwise", "# Spanwise", "First strip"];
        let [index, n_chord, n_span, first_strip] = mrf::integers(&line, 4, 1, names)?;
        let line = mrf::labelled(source, "Surface area")?;
        let [area, average_chord] = mrf::reals(&line, 0, ["Surface area", "Ave. chord"])?;
        let line = mrf::labelled(source, "CLsurf, Clsurf")?;
        let names = [
            "CLsurf", "Clsurf", "CYsurf", "Cmsurf", "CDsurf", "Cnsurf", "CDisurf", "CDvsurf",
        ];
        let [
            c_lift,
            c_roll,
            c_y,
            c_m,
            c_drag,
            c_n,
            c_drag_induced,
            c_drag_viscous,
        ] = mrf::reals(&line, 0, names)?;
        let line = mrf::labelled(source, "Forces referred to Ssurf, Cave")?;
        let [cl_local, cd_local] = mrf::reals(&line, 0, ["CLsurf", "CDsurf"])?;
        let coefficients = SurfaceCoefficients {
            c_lift,
            c_roll,
            c_y,
            c_m,
            c_drag,
            c_n,
            c_drag_induced,
            c_drag_viscous,
            cl_local,
            cd_local,
        };
        Ok((
            Self {
                index,
                name,
                n_chord,
                n_span,
                first_strip,
                area,
                average_chord,
            },
            coefficients,
        ))
    }
}

/// The coefficients of a surface, from `CLsurf =` over `Sref` to those over `Ssurf`.
pub(crate) fn read_surface_coefficients(source: &mut Source<'_>) -> Result<SurfaceCoefficients, AvlError> {
    let [c_lift, c_roll] = source.find_reals([("CLsurf", 10), ("Clsurf", 10)])?;
    let [c_y, c_m] = source.find_reals([("CYsurf", 10), ("Cmsurf", 10)])?;
    let [c_drag, c_n] = source.find_reals([("CDsurf", 10), ("Cnsurf", 10)])?;
    let [c_drag_induced, c_drag_viscous] = source.find_reals([("CDisurf", 10), ("CDvsurf", 10)])?;
    let next = source.require_text("`Forces referred to Ssurf, Cave`")?;
    if !next.text.contains("Forces referred to Ssurf") {
        // Some builds of OptVL print the induced drag of every surface here and shift what follows.
        return Err(next.syntax("`Forces referred to Ssurf, Cave` behind one line of CDisurf and CDvsurf"));
    }
    let [cl_local, cd_local] = source.find_reals([("CLsurf", 10), ("CDsurf", 10)])?;
    Ok(SurfaceCoefficients {
        c_lift,
        c_roll,
        c_y,
        c_m,
        c_drag,
        c_n,
        c_drag_induced,
        c_drag_viscous,
        cl_local,
        cd_local,
    })
}

impl StripSurface {
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

    /// Appends a strip, which must be the next by its number.
    fn push(&mut self, line: &Line<'_>, strip: Strip) -> Result<(), AvlError> {
        let expected = self.first_strip + self.strips.len();
        if strip.index != expected {
            return Err(line.syntax(format!("strip {expected}")));
        }
        self.strips.push(strip);
        Ok(())
    }
}

fn read_text(source: &mut Source<'_>) -> Result<StripForces, AvlError> {
    source.find("Surface and Strip Forces by surface")?;
    let mut out = StripForces::default();
    let mut axes = None;
    loop {
        let line = source.require_text("the closing line of dashes")?;
        if line.is_rule() {
            break;
        }
        // AVL 3.40 on: reference lengths here, axes in each surface. Before: axes here.
        if line.after_label("Sref").is_some() {
            source.seek(source.position() - 1);
            out.reference = Some(read_reference(source)?);
        } else if line.text.contains("Forces referred to Sref") {
            axes = source.peek().and_then(|l| AxisOrientation::of(l.text)).or(axes);
            source.read();
        } else {
            let head = SurfaceHead::read(source, &line)?;
            let start = source.position();
            let coefficients = read_surface_coefficients(source)?;
            axes = (start..source.position())
                .filter_map(|i| source.line(i))
                .find_map(|l| AxisOrientation::of(l.text))
                .or(axes);
            let mut surface = StripSurface::new(head, coefficients);
            read_strips(source, &mut surface)?;
            out.surfaces.push(surface);
        }
    }
    let Some(axes) = axes else {
        return Err(source.truncated("`Standard axis orientation, ...` or `Geometric ...`"));
    };
    out.axes = axes;
    Ok(out)
}

/// The rows of one surface.
fn read_strips(source: &mut Source<'_>, surface: &mut StripSurface) -> Result<(), AvlError> {
    source.find("Strip Forces referred to Strip Area")?;
    let heading = source.require("the column names of the strips")?;
    if !heading.text.contains("C.P.x/c") {
        return Err(heading.syntax("the column names of the strips, to `C.P.x/c`"));
    }
    let has_x = heading.text.contains("Xle");
    for _ in 0..surface.n_span {
        let line = source.require("a row for each strip that the surface announces")?;
        // Six columns and nine for each field; the old row may lack its last.
        if !line.is_rule() {
            source.refuse_cut(&line, if has_x { 132 } else { 105 }, "the end of a strip")?;
        }
        if line.is_blank() || line.is_rule() {
            return Err(AvlError::Count {
                at: line.at(None),
                what: format!("strips of surface {}", surface.index),
                announced: surface.n_span,
                found: surface.strips.len(),
            });
        }
        let strip = if has_x {
            read_row(&line)
        } else {
            read_old_row(&line)
        }?;
        surface.push(&line, strip)?;
    }
    Ok(())
}

/// AVL's 999 stands for "not defined".
fn centre_of_pressure(value: f64) -> Option<f64> {
    (value != NO_CENTRE_OF_PRESSURE).then_some(value)
}

/// Row of AVL 3.40 on.
fn read_row(line: &Line<'_>) -> Result<Strip, AvlError> {
    let (index, values) = line.indexed_row("j", 2, 4, &ROW)?;
    strip(line, index, &values)
}

/// The fourteen numbers of a strip.
fn strip(line: &Line<'_>, index: usize, values: &[f64]) -> Result<Strip, AvlError> {
    let &[
        x_le,
        y_le,
        z_le,
        chord,
        area,
        c_cl,
        ai,
        cl_norm,
        cl,
        cd,
        cdv,
        cm_c4,
        cm_le,
        xcp,
    ] = values
    else {
        return Err(line.syntax("fourteen numbers"));
    };
    Ok(Strip {
        index,
        x_le: Some(x_le),
        y_le,
        z_le: Some(z_le),
        chord,
        area,
        c_cl,
        ai,
        cl_norm,
        cl,
        cd,
        cdv,
        cm_c4,
        cm_le: Some(cm_le),
        xcp: centre_of_pressure(xcp),
    })
}

/// Row of AVL up to 3.35, which may end before the centre of pressure.
fn read_old_row(line: &Line<'_>) -> Result<Strip, AvlError> {
    const WITHOUT_CENTRE: usize = OLD_ROW.len() - 1;
    let end = 6 + WITHOUT_CENTRE * 9;
    let has_centre = line.text.trim_end().len() > end;
    let fields = if has_centre {
        &OLD_ROW[..]
    } else {
        OLD_ROW.split_at(WITHOUT_CENTRE).0
    };
    let (index, values) = line.indexed_row("j", 2, 4, fields)?;
    let &[
        y_le,
        chord,
        area,
        c_cl,
        ai,
        cl_norm,
        cl,
        cd,
        cdv,
        cm_c4,
        cm_le,
        ref rest @ ..,
    ] = values.as_slice()
    else {
        return Err(line.syntax("eleven or twelve numbers"));
    };
    Ok(Strip {
        index,
        x_le: None,
        y_le,
        z_le: None,
        chord,
        area,
        c_cl,
        ai,
        cl_norm,
        cl,
        cd,
        cdv,
        cm_c4,
        cm_le: Some(cm_le),
        xcp: rest.first().copied().and_then(centre_of_pressure),
    })
}

fn read_mrf(source: &mut Source<'_>) -> Result<StripForces, AvlError> {
    mrf::opening(source)?;
    let axes = mrf::axes(source)?;
    let reference = Some(mrf::reference(source)?);
    source.require("`Surface and Strip Forces by surface`")?;
    let count = mrf::count(source, "surfaces")?;
    let mut surfaces = Vec::new();
    for _ in 0..count {
        let (head, coefficients) = SurfaceHead::read_mrf(source)?;
        let mut surface = StripSurface::new(head, coefficients);
        source.find("Strip Forces referred to Strip Area")?;
        source.require("the column names of the strips")?;
        for _ in 0..surface.n_span {
            let line = source.require("a row for each strip that the surface announces")?;
            let values = mrf::reals(&line, 4, ROW.map(|f| f.name))?;
            surface.push(&line, strip(&line, line.integer(0, 4, "j")?, &values)?)?;
        }
        surfaces.push(surface);
    }
    Ok(StripForces {
        axes,
        reference,
        surfaces,
    })
}
