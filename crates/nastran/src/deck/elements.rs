//! Elements with stiffness or mass: bars, beams, rods, springs, bushes and concentrated masses.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::{Components, Id};

/// The vector that fixes plane 1 (local x-y) of a bar or beam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Orientation {
    /// Components in the displacement system (CD) of end A.
    Vector([f64; 3]),
    /// From end A towards this grid.
    Grid(Id),
}

/// A uniform bar (CBAR).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cbar {
    /// Element number.
    pub id: Id,
    /// Property (PBAR or PBARL).
    pub pid: Id,
    /// End grids A and B.
    pub grids: [Id; 2],
    /// Orientation of plane 1. A blank one is taken from BAROR; if that lacks too, it is `None` and the reader
    /// reports an error.
    pub orientation: Option<Orientation>,
    /// OFFT: the frames of orientation and offsets, `GGG` when blank.
    pub offset_frames: Cow<'static, str>,
    /// Released components at ends A and B, in the element's frame (PA, PB).
    pub pins: [Components; 2],
    /// Offset from grid A to the bar's end A, in the CD system of A unless `offset_frames` says otherwise.
    pub wa: [f64; 3],
    /// Offset from grid B to the bar's end B.
    pub wb: [f64; 3],
}

/// A beam with a shear-centre axis and tapered section (CBEAM).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cbeam {
    /// Element number.
    pub id: Id,
    /// Property (PBEAM or PBEAML).
    pub pid: Id,
    /// End grids A and B.
    pub grids: [Id; 2],
    /// Orientation of plane 1, see [`Cbar::orientation`].
    pub orientation: Option<Orientation>,
    /// OFFT, `GGG` when blank.
    pub offset_frames: Cow<'static, str>,
    /// Built-in twist or parametric shape (BIT), which shares a field with OFFT.
    pub bit: Option<f64>,
    /// Released components at ends A and B.
    pub pins: [Components; 2],
    /// Offset from grid A to the shear centre at end A.
    pub wa: [f64; 3],
    /// Offset from grid B to the shear centre at end B.
    pub wb: [f64; 3],
    /// Scalar or grid points of the warping freedom at A and B; 0 for none.
    pub warping: [Id; 2],
}

/// A rod that carries axial load and torsion (CROD).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crod {
    /// Element number.
    pub id: Id,
    /// Property (PROD).
    pub pid: Id,
    /// End grids.
    pub grids: [Id; 2],
}

/// A rod with its properties on the card (CONROD).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conrod {
    /// Element number.
    pub id: Id,
    /// End grids.
    pub grids: [Id; 2],
    /// Material.
    pub mid: Id,
    /// Cross-section area, m^2.
    pub area: f64,
    /// Torsion constant, m^4.
    pub torsion_constant: f64,
    /// Stress coefficient, m.
    pub stress_coefficient: f64,
    /// Non-structural mass per length, kg/m.
    pub nsm: f64,
}

/// A symmetric 6x6 mass at a grid (CONM1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conm1 {
    /// Element number.
    pub id: Id,
    /// Grid.
    pub grid: Id,
    /// Frame of the matrix; 0 is the basic system.
    pub cid: Id,
    /// The full symmetric matrix, translations first: kg, kg m, kg m^2.
    pub mass: [[f64; 6]; 6],
}

/// How the centre of a [`Conm2`] is placed and oriented.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Conm2Frame {
    /// Offset and inertia in this coordinate system; 0 is the basic system.
    System(Id),
    /// CID = -1: the offset field holds the centre's position in the basic system, the inertia is about axes
    /// parallel to the basic system.
    BasicPosition,
}

/// A rigid concentrated mass (CONM2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conm2 {
    /// Element number.
    pub id: Id,
    /// Grid that carries the mass.
    pub grid: Id,
    /// Frame of offset and inertia.
    pub frame: Conm2Frame,
    /// Mass, kg.
    pub mass: f64,
    /// From the grid to the mass centre, m (or the centre's position, see [`Conm2Frame`]).
    pub offset: [f64; 3],
    /// Moments and products about the mass centre as on the card: I11, I21, I22, I31, I32, I33, kg m^2, with
    /// products `I21 = +int(x1 x2 dm)` (Nastran's sign). [`inertia_tensor`](Self::inertia_tensor) has the
    /// tensor's.
    pub inertia: [f64; 6],
}

impl Conm2 {
    /// Inertia tensor about the mass centre in the card's frame, kg m^2: products enter with the minus sign of
    /// the tensor, `J12 = -I21`.
    #[must_use]
    pub fn inertia_tensor(&self) -> [[f64; 3]; 3] {
        let [i11, i21, i22, i31, i32, i33] = self.inertia;
        [[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]]
    }
}

/// A point and one of its components, as scalar elements name them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ScalarEnd {
    /// Grid or scalar point; 0 is the ground.
    pub point: Id,
    /// Component 1 to 6 of a grid; 0 for a scalar point or the ground.
    pub component: u8,
}

/// Where a scalar mass has its value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum ScalarMassValue {
    /// From a PMASS card (CMASS1, CMASS3).
    Property(Id),
    /// On the card (CMASS2, CMASS4), kg or kg m^2.
    Value(f64),
}

/// A scalar mass (CMASS1, CMASS2; CMASS3 and CMASS4 with scalar points only).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cmass {
    /// Element number.
    pub id: Id,
    /// Its value or property.
    pub value: ScalarMassValue,
    /// The ends; the second is often the ground.
    pub ends: [ScalarEnd; 2],
    /// Read from the short form for scalar points (CMASS3, CMASS4).
    pub scalar_points_only: bool,
}

impl Cmass {
    /// The card that the element is written on.
    #[must_use]
    pub fn card_name(&self) -> &'static str {
        match (self.value, self.scalar_points_only) {
            (ScalarMassValue::Property(_), false) => "CMASS1",
            (ScalarMassValue::Value(_), false) => "CMASS2",
            (ScalarMassValue::Property(_), true) => "CMASS3",
            (ScalarMassValue::Value(_), true) => "CMASS4",
        }
    }
}

/// Stiffness of a scalar spring: by property (CELAS1) or on the card (CELAS2).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum ScalarSpringValue {
    /// CELAS1: a PELAS card.
    Property(Id),
    /// CELAS2: stiffness, damping and stress coefficient on the card.
    Value {
        /// Stiffness, N/m or N m/rad.
        k: f64,
        /// Structural damping coefficient.
        ge: f64,
        /// Stress coefficient.
        s: f64,
    },
}

/// A scalar spring (CELAS1, CELAS2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Celas {
    /// Element number.
    pub id: Id,
    /// Stiffness or property.
    pub value: ScalarSpringValue,
    /// The ends.
    pub ends: [ScalarEnd; 2],
}

/// A spring and damper in up to six directions (CBUSH).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cbush {
    /// Element number.
    pub id: Id,
    /// Property (PBUSH).
    pub pid: Id,
    /// End grids; the second is 0 when grounded.
    pub grids: [Id; 2],
    /// Orientation vector or grid.
    pub orientation: Option<Orientation>,
    /// Element frame, which overrides the orientation; `Some(0)` is the basic system.
    pub cid: Option<Id>,
    /// Location of the spring between the grids, 0 at A and 1 at B (0.5 when blank).
    pub location: f64,
    /// Frame of the offset; `None` (card: -1) keeps the spring on the line between the grids.
    pub offset_cid: Option<Id>,
    /// Location of the spring when `offset_cid` is given.
    pub offset: [f64; 3],
}
