//! Output files of AVL's OPER and MODE menus.
//!
//! One module per file, each with its plain struct.
//!
//! Coefficients are AVL's own: forces over `q Sref`, moments over `q Sref Cref` (pitch) or `q Sref Bref` (roll,
//! yaw) about `Xref, Yref, Zref`. Moments and X, Z forces follow the printed [`AxisOrientation`].

mod kind;
mod mrf;
mod run_state;
mod table;
mod write;

pub mod body;
pub mod derivatives;
pub mod element;
pub mod hinge;
pub mod loading;
pub mod mode;
pub mod shear;
pub mod strip;
pub mod surface;

use serde::{Deserialize, Serialize};

use crate::error::AvlError;

pub use body::{BodyForce, BodyForces};
pub use derivatives::{
    BodyCoefficient, BodyColumn, BodyDerivatives, BodyVariable, Coefficient, NamedColumn, StabilityColumn,
    StabilityDerivatives, Variable,
};
pub use element::{Element, ElementForces, ElementStrip, ElementSurface};
pub use hinge::{HingeMoment, HingeMoments};
pub use kind::{FileKind, recognise_kind};
pub use loading::{BodyAxesStrip, BodyAxesStripForces, BodyAxesSurface, StripLoad, StripLoads};
pub use mode::{Eigenvalue, Eigenvalues, SystemMatrix};
pub use run_state::{NamedValue, Reference, RunState, TotalForces};
pub use shear::{ShearMoments, ShearStation, ShearSurface};
pub use strip::{Strip, StripForces, StripSurface, SurfaceCoefficients};
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

impl AxisOrientation {
    /// The orientation that a line announces.
    fn of(line: &str) -> Option<Self> {
        let line = line.trim_start();
        if line.starts_with("Standard axis orientation") {
            Some(Self::Standard)
        } else if line.starts_with("Geometric axis orientation") {
            Some(Self::Geometric)
        } else {
            None
        }
    }
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

/// Reads any output file, by its content.
///
/// # Errors
/// [`AvlError::UnknownKind`] when the content is no AVL output; else as the reader of the kind found.
pub fn parse_any(text: &str, file: &str) -> Result<ResultFile, AvlError> {
    let kind = recognise_kind(text);
    Ok(match kind {
        Some(FileKind::StabilityDerivatives) => {
            ResultFile::StabilityDerivatives(StabilityDerivatives::parse(text, file)?)
        }
        Some(FileKind::BodyDerivatives) => ResultFile::BodyDerivatives(BodyDerivatives::parse(text, file)?),
        Some(FileKind::SurfaceForces) => ResultFile::SurfaceForces(SurfaceForces::parse(text, file)?),
        Some(FileKind::BodyForces) => ResultFile::BodyForces(BodyForces::parse(text, file)?),
        Some(FileKind::StripForces) => ResultFile::StripForces(StripForces::parse(text, file)?),
        Some(FileKind::BodyAxesStripForces) => {
            ResultFile::BodyAxesStripForces(BodyAxesStripForces::parse(text, file)?)
        }
        Some(FileKind::ElementForces) => ResultFile::ElementForces(ElementForces::parse(text, file)?),
        Some(FileKind::HingeMoments) => ResultFile::HingeMoments(HingeMoments::parse(text, file)?),
        Some(FileKind::ShearMoments) => ResultFile::ShearMoments(ShearMoments::parse(text, file)?),
        Some(FileKind::StripLoads) => ResultFile::StripLoads(StripLoads::parse(text, file)?),
        Some(FileKind::Eigenvalues) => ResultFile::Eigenvalues(Eigenvalues::parse(text, file)?),
        Some(FileKind::SystemMatrix) => ResultFile::SystemMatrix(SystemMatrix::parse(text, file)?),
        // Input files, derivatives in mixed axes and unknown content get this reader's error.
        _ => ResultFile::TotalForces(RunState::parse(text, file)?),
    })
}
