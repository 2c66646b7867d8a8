//! Loads of each vortex (`.fe`).

use serde::{Deserialize, Serialize};

use super::{AxisOrientation, Reference, SurfaceCoefficients};

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
