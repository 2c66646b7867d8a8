//! Rigid elements, constraints, sets, eigenvalue methods and parameters.

use serde::{Deserialize, Serialize};

use super::{Components, Id};

/// A rigid body: dependents follow one grid (RBE2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rbe2 {
    /// Element number.
    pub id: Id,
    /// Independent grid.
    pub independent: Id,
    /// Dependent components of every dependent grid, in their CD systems.
    pub components: Components,
    /// Dependent grids.
    pub dependents: Vec<Id>,
    /// Thermal expansion coefficient.
    pub expansion: Option<f64>,
}

/// Grids of an [`Rbe3`] with one weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rbe3Group {
    /// Weight.
    pub weight: f64,
    /// Components that are averaged.
    pub components: Components,
    /// Grids.
    pub grids: Vec<Id>,
}

/// A grid that moves with the weighted mean of others (RBE3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rbe3 {
    /// Element number.
    pub id: Id,
    /// Reference grid.
    pub reference: Id,
    /// Dependent components at the reference grid.
    pub components: Components,
    /// The averaged grids.
    pub groups: Vec<Rbe3Group>,
    /// UM: components made dependent instead of the reference grid's.
    pub um: Vec<(Id, Components)>,
    /// Thermal expansion coefficient.
    pub expansion: Option<f64>,
}

/// A rigid bar between two grids (RBAR).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rbar {
    /// Element number.
    pub id: Id,
    /// The grids A and B.
    pub grids: [Id; 2],
    /// Independent components at A and B (CNA, CNB).
    pub independent: [Components; 2],
    /// Dependent components at A and B (CMA, CMB); both empty means all that are not independent.
    pub dependent: [Components; 2],
    /// Thermal expansion coefficient.
    pub expansion: Option<f64>,
}

/// One term of a multipoint constraint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MpcTerm {
    /// Grid or scalar point.
    pub point: Id,
    /// Component 1 to 6; 0 for a scalar point.
    pub component: u8,
    /// Coefficient.
    pub coefficient: f64,
}

/// A linear relation, the sum of `coefficient * displacement` being zero (MPC). The first term is the dependent one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mpc {
    /// Set number.
    pub sid: Id,
    /// Terms.
    pub terms: Vec<MpcTerm>,
}

/// A single-point constraint with optional enforced motion (SPC; a card with two points gives two of these).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spc {
    /// Set number.
    pub sid: Id,
    /// Grid or scalar point.
    pub point: Id,
    /// Components.
    pub components: Components,
    /// Enforced motion, m or rad.
    pub enforced: f64,
}

/// The same components fixed at many points (SPC1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spc1 {
    /// Set number.
    pub sid: Id,
    /// Components.
    pub components: Components,
    /// Points; those of a THRU range that the deck lacks are not an error.
    pub points: Vec<Id>,
}

/// Reference freedoms of rigid motion (SUPORT, SUPORT1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Suport {
    /// Set number of SUPORT1; `None` for SUPORT, which is always active.
    pub sid: Option<Id>,
    /// Grid or scalar point.
    pub point: Id,
    /// Components.
    pub components: Components,
}

/// Freedoms of the analysis or omitted set (ASET, ASET1, OMIT, OMIT1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DofSet {
    /// Components.
    pub components: Components,
    /// Points.
    pub points: Vec<Id>,
}

/// A list of numbers that other cards name (SET1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Set1 {
    /// Set number.
    pub id: Id,
    /// SKIN keyword: the list is of skin grids.
    pub skin: bool,
    /// Members, ranges expanded.
    pub members: Vec<Id>,
}

/// A real eigenvalue method (EIGR).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Eigr {
    /// Method number.
    pub id: Id,
    /// Method name, for example `LAN`, `FEER`, `SINV`, `MGIV`.
    pub method: String,
    /// Lower end of the frequency range, Hz.
    pub lower_hz: Option<f64>,
    /// Upper end of the frequency range, Hz.
    pub upper_hz: Option<f64>,
    /// Estimated number of roots.
    pub estimated: Option<i32>,
    /// Desired number of roots.
    pub desired: Option<i32>,
    /// Number of zero roots (NZ of NASTRAN-95).
    pub zero_roots: Option<i32>,
    /// Convergence criterion (the field NASTRAN-95 and older decks use).
    pub criterion: Option<f64>,
    /// Normalisation: `MASS`, `MAX` or `POINT`; empty when blank.
    pub normalization: String,
    /// Grid for POINT.
    pub point: Option<Id>,
    /// Component for POINT.
    pub component: Option<u8>,
}

/// A Lanczos method (EIGRL).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Eigrl {
    /// Method number.
    pub id: Id,
    /// Lower end of the range, Hz.
    pub lower_hz: Option<f64>,
    /// Upper end of the range, Hz.
    pub upper_hz: Option<f64>,
    /// Desired number of roots.
    pub desired: Option<i32>,
    /// Diagnostic level.
    pub message_level: Option<i32>,
    /// Vectors in a block.
    pub block_size: Option<i32>,
    /// Estimate of the first flexible frequency, Hz.
    pub shift_hz: Option<f64>,
    /// Normalisation: `MASS` or `MAX`; empty when blank.
    pub normalization: String,
    /// Further lines (`ALPH=`, `NUMS=`, ...), as fields.
    pub options: Vec<String>,
}

/// A parameter (PARAM) with its values as written, upper case.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Param {
    /// Name, upper case.
    pub name: String,
    /// First value.
    pub value: String,
    /// Second value: the imaginary part of a complex parameter, or empty.
    pub imaginary: String,
}

impl Param {
    /// The first value as an integer.
    #[must_use]
    pub fn as_integer(&self) -> Option<i64> {
        crate::number::integer(self.value.as_bytes())
    }

    /// The first value as a number (a Nastran real or an integer).
    #[must_use]
    pub fn as_real(&self) -> Option<f64> {
        crate::number::real(self.value.as_bytes())
    }
}
