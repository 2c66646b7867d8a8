//! Geometry (`.avl`): surfaces of sections, bodies, controls.
//!
//! All lengths are in the file's own unit (AVL's `Lunit`), in geometry axes: x aft, y right, z up. Nothing is
//! computed here: `SCALE`, `TRANSLATE` and `ANGLE` are stored, not applied.

mod read;
mod records;
mod section;
mod write;

use serde::{Deserialize, Serialize};

/// Content of an `.avl` file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// First line.
    pub title: String,
    /// Mach number of the header. AVL up to 3.35 prints it and never uses it.
    pub mach: f64,
    /// 1: y = 0 is a plane of symmetry; -1: of antisymmetry (free surface); 0: none.
    pub i_ysym: i32,
    /// 1: z = `z_sym` is a ground plane; -1: a free surface; 0: none.
    pub i_zsym: i32,
    /// Height of the z symmetry plane.
    pub z_sym: f64,
    /// Reference area.
    pub s_ref: f64,
    /// Reference chord.
    pub c_ref: f64,
    /// Reference span.
    pub b_ref: f64,
    /// Moment reference point, x aft.
    pub x_ref: f64,
    /// Moment reference point, y right.
    pub y_ref: f64,
    /// Moment reference point, z up.
    pub z_ref: f64,
    /// Profile drag coefficient added to the configuration, if the optional header line is there.
    pub cd_p: Option<f64>,
    /// Vortex core radii of AVL 3.5x (`CORE`).
    pub core: Option<CoreRadii>,
    /// Lifting surfaces, in the order of the file.
    pub surfaces: Vec<Surface>,
    /// Slender bodies, in the order of the file.
    pub bodies: Vec<Body>,
}

impl Geometry {
    /// Names of the controls in AVL's order: that in which they first come (d01, d02, ...).
    pub fn control_names(&self) -> Vec<&str> {
        distinct(self.sections().flat_map(|s| &s.controls).map(|c| c.name.as_str()))
    }

    /// Names of the design variables in AVL's order (g01, ...).
    pub fn design_names(&self) -> Vec<&str> {
        distinct(self.sections().flat_map(|s| &s.designs).map(|d| d.name.as_str()))
    }

    /// All sections, surface after surface.
    fn sections(&self) -> impl Iterator<Item = &Section> {
        self.surfaces.iter().flat_map(|s| &s.sections)
    }
}

/// Each name once, where it first comes.
fn distinct<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut seen = std::collections::HashSet::new();
    names.filter(|name| seen.insert(*name)).collect()
}

/// Vortex core radii of AVL 3.5x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoreRadii {
    /// Core radius of bound vortices over strip chord (`VRCOREC`).
    pub chord_fraction: f64,
    /// Core radius of bound vortices over strip width (`VRCOREW`).
    pub width_fraction: f64,
    /// Core radius of source lines over body radius (`SRCORE`).
    pub source_fraction: f64,
}

/// Number of elements along a direction and their distribution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spacing {
    /// Number of elements (`Nspan`).
    pub count: usize,
    /// Distribution (`Sspace`): 0 and +-3 uniform, +-1 cosine, 2 sine (dense at the start), -2 dense at the
    /// end; between these a linear blend.
    pub distribution: f64,
}

/// One `SURFACE`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Name line.
    pub name: String,
    /// Number of chordwise vortices (`Nchord`).
    pub n_chord: usize,
    /// Chordwise distribution (`Cspace`), see [`Spacing::distribution`].
    pub c_space: f64,
    /// Spanwise vortices of the whole surface (`Nspan Sspace`); without it each section gives its own.
    pub spanwise: Option<Spacing>,
    /// Component number (`COMPONENT` or `INDEX`): surfaces that share one see each other as one lifting body.
    pub component: Option<i32>,
    /// y of the plane in which the surface is mirrored (`YDUPLICATE`).
    pub y_duplicate: Option<f64>,
    /// `SCALE`: acts before `TRANSLATE`; chords are multiplied by the first entry.
    pub scale: [f64; 3],
    /// `TRANSLATE`.
    pub translate: [f64; 3],
    /// `ANGLE`, added to the incidence of every section, in degrees. It tilts the normals only.
    pub angle_deg: f64,
    /// `NOWAKE`: the surface sheds no wake (and does not see the Kutta condition).
    pub no_wake: bool,
    /// `NOALBE`: the surface does not see alpha, beta and the rates.
    pub no_albe: bool,
    /// `NOLOAD`: its forces are left out of the totals.
    pub no_load: bool,
    /// Drag polar of all sections that have none of their own (`CDCL` before any `SECTION`; AVL 3.40 on).
    pub cdcl: Option<DragPolar>,
    /// Sections, in the order of the file.
    pub sections: Vec<Section>,
}

/// One `SECTION`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Leading edge, x aft.
    pub x_le: f64,
    /// Leading edge, y right.
    pub y_le: f64,
    /// Leading edge, z up.
    pub z_le: f64,
    /// Chord.
    pub chord: f64,
    /// Incidence in degrees, about the surface's spanwise axis; it tilts the normals only.
    pub a_inc_deg: f64,
    /// Spanwise vortices from this section to the next. AVL reads it only when the surface has none.
    pub spanwise: Option<Spacing>,
    /// Camber line.
    pub airfoil: Airfoil,
    /// Lift slope over 2 pi (`CLAF`), 1 by default.
    pub claf: f64,
    /// Drag polar (`CDCL`).
    pub cdcl: Option<DragPolar>,
    /// Controls that this section declares.
    pub controls: Vec<Control>,
    /// Design variables that this section declares.
    pub designs: Vec<Design>,
}

/// Where a section's camber line comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Airfoil {
    /// Flat plate: no camber.
    Flat,
    /// `NACA` 4 digits; AVL uses the camber line only.
    Naca {
        /// Digits, as in `2412`.
        digits: String,
        /// Part of the chord that is used, x/c from and to.
        x_range: Option<[f64; 2]>,
    },
    /// `AIRFOIL`: coordinates in the file, trailing edge, upper side, leading edge, lower side.
    Inline {
        /// x/c and y/c.
        points: Vec<[f64; 2]>,
        /// Part of the chord that is used, x/c from and to.
        x_range: Option<[f64; 2]>,
    },
    /// `AFILE`: coordinates in another file.
    File {
        /// As written; AVL takes it relative to the directory in which it runs.
        path: String,
        /// Part of the chord that is used, x/c from and to.
        x_range: Option<[f64; 2]>,
    },
}

/// Parabolic drag polar through three points (`CDCL`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DragPolar {
    /// Lift coefficients: negative stall, minimum drag, positive stall.
    pub cl: [f64; 3],
    /// Drag coefficients at these.
    pub cd: [f64; 3],
}

/// One `CONTROL` of a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Name; AVL keeps 16 characters.
    pub name: String,
    /// Degrees of deflection per unit of the control variable.
    pub gain: f64,
    /// Hinge x/c. Positive: flap from there to the trailing edge; negative: slat from the leading edge to
    /// |x/c|.
    pub x_hinge: f64,
    /// Hinge axis; all zero means along the hinge line.
    pub hinge_axis: [f64; 3],
    /// Sign of the deflection of the mirrored surface: +1 same, -1 opposite.
    pub sgn_dup: f64,
}

/// One `DESIGN` of a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// Name; AVL keeps 16 characters.
    pub name: String,
    /// Degrees of incidence per unit of the design variable.
    pub weight: f64,
}

/// One `BODY`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Name line.
    pub name: String,
    /// Number of source-line nodes and their distribution (`Nbody Bspace`).
    pub spacing: Spacing,
    /// y of the plane in which the body is mirrored (`YDUPLICATE`).
    pub y_duplicate: Option<f64>,
    /// `SCALE`: acts before `TRANSLATE`.
    pub scale: [f64; 3],
    /// `TRANSLATE`.
    pub translate: [f64; 3],
    /// Side view of the body (`BFILE`), as written.
    pub file: Option<String>,
    /// Cross-sections (`BSECTION`, AVL 3.5x).
    pub sections: Vec<BodySection>,
}

/// One `BSECTION` of a body: an ellipse around a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodySection {
    /// Centre, x aft, y right, z up.
    pub centre: [f64; 3],
    /// Half-width, along y.
    pub radius_y: f64,
    /// Half-height, along z; equal to the half-width when the file gives one radius.
    pub radius_z: f64,
}
