//! Hinge moments (`.hm`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::{AxisOrientation, mrf};
use crate::error::AvlError;
use crate::source::{Source, columns, line_reals};

/// Content of an `.hm` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HingeMoments {
    /// Axes; MRF only.
    pub axes: Option<AxisOrientation>,
    /// Reference area.
    pub s_ref: f64,
    /// Reference chord.
    pub c_ref: f64,
    /// One entry per control, in AVL's order.
    pub controls: Vec<HingeMoment>,
}

/// Hinge moment of one control.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HingeMoment {
    /// Name, up to 16 characters.
    pub name: String,
    /// Hinge moment over `q Sref Cref`.
    pub c_hinge: f64,
    /// Deflection in degrees (times gain); AVL 3.5x.
    pub deflection_deg: Option<f64>,
    /// Moment in N m, when the run case has density and speed; AVL 3.5x.
    pub moment_n_m: Option<f64>,
}

impl HingeMoments {
    /// Reads an `.hm` file.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::HingeMoments)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }

    /// Hinge moment of the control of this name.
    pub fn control(&self, name: &str) -> Option<&HingeMoment> {
        self.controls.iter().find(|c| c.name == name)
    }
}

/// `(1X,A16,G12.4,3X,G12.4,3X,G12.4)`; the last two since AVL 3.5x.
fn read_text(source: &mut Source<'_>) -> Result<HingeMoments, AvlError> {
    source.find("Control Hinge Moments")?;
    let line = source.require("`Sref =`, `Cref =`")?;
    let bare = crate::source::Line {
        text: line.text.trim_end().trim_end_matches(')'),
        ..line
    };
    let [s_ref, c_ref] = line_reals(&bare, [("Sref", 12), ("Cref", 10)])?;
    let heading = source.find("Chinge")?;
    let with_deflection = heading.text.contains("Deflection");
    let with_moment = heading.text.contains("Moment");
    source.require("the line below `Chinge`")?;
    let mut controls = Vec::new();
    loop {
        let line = source.require("the closing line of dashes")?;
        if line.is_rule() {
            return Ok(HingeMoments {
                axes: None,
                s_ref,
                c_ref,
                controls,
            });
        }
        controls.push(HingeMoment {
            name: columns(line.text, 1, 16).trim().to_owned(),
            c_hinge: line.real(17, 12, "Chinge")?,
            deflection_deg: with_deflection
                .then(|| line.real(32, 12, "Deflection"))
                .transpose()?,
            moment_n_m: with_moment
                .then(|| line.real(47, 12, "Moment(N-m)"))
                .transpose()?,
        });
    }
}

fn read_mrf(source: &mut Source<'_>) -> Result<HingeMoments, AvlError> {
    mrf::opening(source)?;
    let axes = Some(mrf::axes(source)?);
    let line = mrf::labelled(source, "Sref, Cref")?;
    let [s_ref, c_ref] = mrf::reals(&line, 0, ["Sref", "Cref"])?;
    let count = mrf::count(source, "# controls")?;
    let mut controls = Vec::new();
    for _ in 0..count {
        let line = mrf::labelled(source, "Control Hinge Moments")?;
        controls.push(HingeMoment {
            name: columns(line.text, 25, 16).trim().to_owned(),
            c_hinge: mrf::real(&line, 0, "Chinge")?,
            deflection_deg: None,
            moment_n_m: None,
        });
    }
    Ok(HingeMoments {
        axes,
        s_ref,
        c_ref,
        controls,
    })
}
