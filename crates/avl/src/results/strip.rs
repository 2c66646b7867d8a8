//! Forces of each strip: `.fs`, and its relatives `.fsb` (body axes) and `.cnc` (loading).

use serde::{Deserialize, Serialize};

use super::{AxisOrientation, Reference};

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
    /// Area; AVL 3.32 on.
    pub area: f64,
}
