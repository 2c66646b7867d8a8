//! Output files of AVL's OPER and MODE menus.
//!
//! One module per file, each with its plain struct.
//!
//! Coefficients are AVL's own: forces over `q Sref`, moments over `q Sref Cref` (pitch) or `q Sref Bref` (roll,
//! yaw) about `Xref, Yref, Zref`. Moments and X, Z forces follow the printed [`AxisOrientation`].

mod kind;
mod run_state;

pub mod body;
pub mod derivatives;
pub mod element;
pub mod hinge;
pub mod mode;
pub mod shear;
pub mod strip;
pub mod surface;

use serde::{Deserialize, Serialize};

pub use body::{BodyForce, BodyForces};
pub use derivatives::{
    BodyCoefficient, BodyColumn, BodyDerivatives, BodyVariable, Coefficient, NamedColumn, StabilityColumn,
    StabilityDerivatives, Variable,
};
pub use element::{Element, ElementForces, ElementStrip, ElementSurface};
pub use hinge::{HingeMoment, HingeMoments};
pub use kind::FileKind;
pub use mode::{Eigenvalue, Eigenvalues, SystemMatrix};
pub use run_state::{NamedValue, Reference, RunState, TotalForces};
pub use shear::{ShearMoments, ShearStation, ShearSurface};
pub use strip::{
    BodyAxesStrip, BodyAxesStripForces, BodyAxesSurface, Strip, StripForces, StripLoad, StripLoads,
    StripSurface, SurfaceCoefficients,
};
pub use surface::{SurfaceForce, SurfaceForces};

/// Axes in which AVL prints x and z forces, moments and rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisOrientation {
    /// `Standard axis orientation,  X fwd, Z down`: AVL's default.
    #[default]
    Standard,
    /// `Geometric axis orientation,  X aft, Z up`.
    Geometric,
}

/// Any output file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ResultFile {
    /// OPER > FT.
    TotalForces(TotalForces),
    /// OPER > ST.
    StabilityDerivatives(StabilityDerivatives),
    /// OPER > SB.
    BodyDerivatives(BodyDerivatives),
    /// OPER > FN.
    SurfaceForces(SurfaceForces),
    /// OPER > FB.
    BodyForces(BodyForces),
    /// OPER > FS.
    StripForces(StripForces),
    /// OPER > FSB, AVL 3.5x.
    BodyAxesStripForces(BodyAxesStripForces),
    /// OPER > FE.
    ElementForces(ElementForces),
    /// OPER > HM.
    HingeMoments(HingeMoments),
    /// OPER > VM.
    ShearMoments(ShearMoments),
    /// OPER > CN.
    StripLoads(StripLoads),
    /// MODE > W.
    Eigenvalues(Eigenvalues),
    /// MODE > S.
    SystemMatrix(SystemMatrix),
}
