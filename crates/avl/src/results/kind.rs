//! The kinds of output file, what they hold and how AVL is asked for them.

use serde::{Deserialize, Serialize};

/// Kind of an AVL file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum FileKind {
    /// `.ft`, total forces.
    TotalForces,
    /// `.st`, stability-axis derivatives.
    StabilityDerivatives,
    /// `.sb`, body-axis derivatives.
    BodyDerivatives,
    /// `.fn`, forces of each surface.
    SurfaceForces,
    /// `.fb`, forces of each body.
    BodyForces,
    /// `.fs`, forces of each strip.
    StripForces,
    /// `.fsb`, forces of each strip in body axes.
    BodyAxesStripForces,
    /// `.fe`, loads of each vortex.
    ElementForces,
    /// `.hm`, hinge moments.
    HingeMoments,
    /// `.vm`, shear and bending moment.
    ShearMoments,
    /// `.cnc`, strip loading.
    StripLoads,
    /// `.eig`, eigenvalues.
    Eigenvalues,
    /// `.sys`, system matrix.
    SystemMatrix,
    /// `.avl`, geometry.
    Geometry,
    /// `.mass`, masses.
    Mass,
    /// `.run`, run cases.
    Run,
}

impl FileKind {
    /// What the file holds, with its article and usual extension.
    pub fn description(self) -> &'static str {
        match self {
            Self::TotalForces => "a file of total forces (.ft)",
            Self::StabilityDerivatives => "a file of stability derivatives (.st)",
            Self::BodyDerivatives => "a file of body-axis derivatives (.sb)",
            Self::SurfaceForces => "a file of surface forces (.fn)",
            Self::BodyForces => "a file of body forces (.fb)",
            Self::StripForces => "a file of strip forces (.fs)",
            Self::BodyAxesStripForces => "a file of body-axis strip forces (.fsb)",
            Self::ElementForces => "a file of element forces (.fe)",
            Self::HingeMoments => "a file of hinge moments (.hm)",
            Self::ShearMoments => "a file of shears and bending moments (.vm)",
            Self::StripLoads => "a strip loading file (.cnc)",
            Self::Eigenvalues => "a file of eigenvalues (.eig)",
            Self::SystemMatrix => "a system matrix (.sys)",
            Self::Geometry => "a geometry file (.avl)",
            Self::Mass => "a mass file (.mass)",
            Self::Run => "a run-case file (.run)",
        }
    }

    /// How AVL is asked for such a file.
    pub fn command(self) -> &'static str {
        match self {
            Self::TotalForces => "OPER > FT",
            Self::StabilityDerivatives => "OPER > ST",
            Self::BodyDerivatives => "OPER > SB",
            Self::SurfaceForces => "OPER > FN",
            Self::BodyForces => "OPER > FB",
            Self::StripForces => "OPER > FS",
            Self::BodyAxesStripForces => "OPER > FSB (AVL 3.5 or later)",
            Self::ElementForces => "OPER > FE",
            Self::HingeMoments => "OPER > HM",
            Self::ShearMoments => "OPER > VM",
            Self::StripLoads => "OPER > CN",
            Self::Eigenvalues => "MODE > W",
            Self::SystemMatrix => "MODE > S",
            Self::Geometry => "a text editor",
            Self::Mass => "a text editor",
            Self::Run => "OPER > S",
        }
    }
}
