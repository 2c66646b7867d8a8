//! The lattice: surfaces, strips, horseshoe vortices, and what controls do to their normals.
//!
//! Geometry axes: x aft, y right, z up, in the unit of the geometry file.

mod build;
mod span;
mod station;

use std::ops::Range;

use albatross_avl::geometry::{CoreRadii, DragPolar};
use albatross_avl::results::Reference;

use crate::body::LatticeBody;
use crate::error::{Error, Result};

pub use build::Files;

/// A point or vector in geometry axes.
pub type V3 = nalgebra::Vector3<f64>;

/// A discretised geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Title of the geometry.
    pub title: String,
    /// Reference area, lengths and moment point.
    pub reference: Reference,
    /// Profile drag coefficient added to the whole configuration.
    pub cd_p: f64,
    /// Mach number of the header.
    pub mach: f64,
    /// +1: mirrored flow at y = 0; -1: mirrored with opposite circulation; 0: none.
    pub i_ysym: i32,
    /// The same for the plane z = `z_sym`.
    pub i_zsym: i32,
    /// Height of the z plane of symmetry.
    pub z_sym: f64,
    /// Core radii that the geometry file sets.
    pub core: Option<CoreRadii>,
    /// Surfaces, mirror images included, in AVL's order.
    pub surfaces: Vec<LatticeSurface>,
    /// Strips of all surfaces.
    pub strips: Vec<LatticeStrip>,
    /// Vortices of all strips, from leading to trailing edge.
    pub vortices: Vec<Vortex>,
    /// Control variables in AVL's order (d01, ...).
    pub controls: Vec<NormalChange>,
    /// Design variables in AVL's order (g01, ...).
    pub designs: Vec<NormalChange>,
    /// Bodies, mirror images included.
    pub bodies: Vec<LatticeBody>,
}

/// One surface of the lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeSurface {
    /// Name; mirror images end in ` (YDUP)`.
    pub name: String,
    /// Component: surfaces that share one see each other's vortices with thin cores.
    pub component: i32,
    /// Chordwise vortices.
    pub n_chord: usize,
    /// Its strips.
    pub strips: Range<usize>,
    /// Mirror image of the surface before it.
    pub is_image: bool,
    /// Sheds no wake.
    pub no_wake: bool,
    /// Sees neither freestream nor rates.
    pub no_albe: bool,
    /// Left out of the totals.
    pub no_load: bool,
    /// Area: sum of the strips'.
    pub area: f64,
    /// Area over the span along the surface.
    pub average_chord: f64,
}

/// One chordwise strip.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeStrip {
    /// Its surface.
    pub surface: usize,
    /// Its vortices.
    pub vortices: Range<usize>,
    /// Leading edge at the two sides, in the direction of the bound vortices.
    pub edges: [V3; 2],
    /// Chords at the two sides.
    pub edge_chords: [f64; 2],
    /// Leading edge at the strip's station.
    pub leading_edge: V3,
    /// Chord at the strip's station.
    pub chord: f64,
    /// Width along the surface, in the y-z plane.
    pub width: f64,
    /// Incidence in rad, without camber.
    pub incidence_rad: f64,
    /// Unit normal in the y-z plane.
    pub normal: V3,
    /// Drag polar.
    pub polar: Option<DragPolar>,
}

impl LatticeStrip {
    /// Area, the chord at the station times the width.
    pub fn area(&self) -> f64 {
        self.chord * self.width
    }

    /// Quarter chord of the station.
    pub fn quarter_chord(&self) -> V3 {
        self.leading_edge + V3::new(0.25 * self.chord, 0.0, 0.0)
    }
}

/// One horseshoe vortex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vortex {
    /// Its strip.
    pub strip: usize,
    /// Ends of the bound leg; positive circulation runs from the first to the second.
    pub ends: [V3; 2],
    /// Where the bound leg's force acts.
    pub force_point: V3,
    /// Where the flow is tangential.
    pub control_point: V3,
    /// Unit normal at the control point.
    pub normal: V3,
    /// d normal / d local incidence, per rad: the normal of a strip that turns nose up.
    pub normal_incidence: V3,
    /// Chordwise length of the element.
    pub dx: f64,
    /// Camber slope at the bound vortex.
    pub slope: f64,
}

impl Vortex {
    /// Vector along the bound leg.
    pub fn bound(&self) -> V3 {
        self.ends[1] - self.ends[0]
    }
}

/// What one unit of a control or design variable does, linearised.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalChange {
    /// Name, up to 16 characters.
    pub name: String,
    /// The vortices that it moves.
    pub panels: Vec<PanelChange>,
}

/// Change of one vortex' normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanelChange {
    /// Vortex.
    pub vortex: usize,
    /// d normal / d variable, per unit of the variable (degrees times gain).
    pub normal: V3,
    /// Fraction of the element that moves, times gain; zero for design variables.
    pub fraction: f64,
    /// A point of the hinge line.
    pub hinge_point: V3,
    /// Unit vector along the hinge.
    pub hinge_axis: V3,
}

impl Lattice {
    /// Names of the controls.
    pub fn control_names(&self) -> impl Iterator<Item = &str> {
        self.controls.iter().map(|c| c.name.as_str())
    }

    /// Checks that surfaces, strips, vortices and what controls and design variables move name each other's places, and
    /// that the reference can be divided by.
    ///
    /// # Errors
    /// [`Error::Length`] for an index or a range that leads out of its list; [`Error::Value`] for a reference length or
    /// area that is not positive and finite, or a moment point that is not finite.
    pub fn check(&self) -> Result<()> {
        let r = &self.reference;
        for (what, value, length) in [
            ("reference area Sref", r.s_ref, true),
            ("reference chord Cref", r.c_ref, true),
            ("reference span Bref", r.b_ref, true),
            ("moment reference point x", r.x_ref, false),
            ("moment reference point y", r.y_ref, false),
            ("moment reference point z", r.z_ref, false),
        ] {
            if !value.is_finite() || (length && value <= 0.0) {
                return Err(Error::Value {
                    what: format!("the lattice's {what}"),
                    value,
                    expected: if length {
                        "it must be positive and finite"
                    } else {
                        "it must be finite"
                    },
                });
            }
        }
        // An index needs a list that is longer, a range one that is as long as its end.
        let reaches = |what: &'static str, needed: usize, length: usize| {
            if needed <= length {
                return Ok(());
            }
            Err(Error::Length {
                what,
                found: length,
                expected: needed,
            })
        };
        let ordered = |what: &'static str, range: &Range<usize>, length: usize| {
            reaches(what, range.start, range.end)?;
            reaches(what, range.end, length)
        };
        let (strips, vortices) = (self.strips.len(), self.vortices.len());
        for surface in &self.surfaces {
            ordered("strips for the range of a surface", &surface.strips, strips)?;
        }
        for strip in &self.strips {
            let needed = strip.surface.saturating_add(1);
            reaches("surfaces for the index of a strip", needed, self.surfaces.len())?;
            ordered("vortices for the range of a strip", &strip.vortices, vortices)?;
        }
        for vortex in &self.vortices {
            let needed = vortex.strip.saturating_add(1);
            reaches("strips for the index of a vortex", needed, strips)?;
        }
        for change in self.controls.iter().chain(&self.designs) {
            for panel in &change.panels {
                let needed = panel.vortex.saturating_add(1);
                reaches("vortices for the index of a moved panel", needed, vortices)?;
            }
        }
        Ok(())
    }

    /// Surface of a vortex.
    pub(crate) fn surface_of(&self, vortex: &Vortex) -> &LatticeSurface {
        &self.surfaces[self.strips[vortex.strip].surface]
    }
}
