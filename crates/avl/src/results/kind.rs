//! The kinds of AVL file, what they hold, how AVL is asked for them, and how the content tells.

use serde::{Deserialize, Serialize};

use crate::error::AvlError;
use crate::source::{Line, Source, excerpt};

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
    /// Derivatives of stability-axis forces and body-axis moments (`Derivatives...`).
    MixedDerivatives,
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
            Self::MixedDerivatives => "a file of derivatives with moments in body axes (`Derivatives...`)",
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
            Self::MixedDerivatives => "an older AVL",
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

/// Layout of an output file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// For people: fixed columns, few digits.
    Text,
    /// Machine-readable form of AVL 3.40 on: 16 digits, then `| names`.
    Mrf,
}

/// Kind and layout by content, and the line (index from 0) where the block starts.
fn recognise(source: &Source<'_>) -> Option<(FileKind, Layout, usize)> {
    let mut marked = None;
    for (i, line) in source.lines().enumerate() {
        if let Some(kind) = mrf_kind(line.text)
            && source
                .line(i + 1)
                .is_some_and(|l| l.text.trim_start().starts_with("VERSION"))
        {
            return Some((kind, Layout::Mrf, i));
        }
        if let Some(kind) = text_kind(line.text) {
            marked = Some((kind, Layout::Text, i));
            break;
        }
    }
    let (kind, layout, start) = marked.or_else(|| {
        let kind = if source.lines().any(|l| is_loading(&l)) {
            FileKind::StripLoads
        } else {
            input_kind(source)?
        };
        Some((kind, Layout::Text, 0))
    })?;
    let below = || {
        (start..source.len())
            .filter_map(|i| source.line(i))
            .map(|l| l.text.trim())
    };
    let kind = match kind {
        FileKind::TotalForces => below().find_map(derivative_kind).unwrap_or(kind),
        FileKind::StripForces if below().any(|l| l.starts_with("Body Axes Forces")) => {
            FileKind::BodyAxesStripForces
        }
        _ => kind,
    };
    Some((kind, layout, start))
}

/// Kind by the first line of an MRF file.
fn mrf_kind(line: &str) -> Option<FileKind> {
    Some(match line.trim() {
        "TOT" => FileKind::TotalForces,
        "DERMATS" => FileKind::StabilityDerivatives,
        "DERMATB" => FileKind::BodyDerivatives,
        "DERMATM" => FileKind::MixedDerivatives,
        "SURF" => FileKind::SurfaceForces,
        "BODY" => FileKind::BodyForces,
        "STRP" => FileKind::StripForces,
        "ELE" => FileKind::ElementForces,
        "HINGE" => FileKind::HingeMoments,
        "VM" => FileKind::ShearMoments,
        "CNC" => FileKind::StripLoads,
        _ => return None,
    })
}

/// Kind by a heading of a text file.
fn text_kind(line: &str) -> Option<FileKind> {
    let line = line.trim();
    let starts = |heading: &str| line.starts_with(heading);
    Some(match line {
        _ if starts("Vortex Lattice Output -- Total Forces") => FileKind::TotalForces,
        _ if starts("Surface and Strip Forces by surface") => FileKind::StripForces,
        _ if starts("Surface Forces (referred to Sref") => FileKind::SurfaceForces,
        _ if starts("Body Forces (referred to Sref") => FileKind::BodyForces,
        _ if starts("Vortex Strengths (by surface") => FileKind::ElementForces,
        _ if starts("Control Hinge Moments") => FileKind::HingeMoments,
        _ if starts("Shear/q and Bending Moment/q vs Y") => FileKind::ShearMoments,
        _ if starts("#") && line.contains("Run case") && line.contains("Eigenvalue") => FileKind::Eigenvalues,
        _ if is_system_heading(line) => FileKind::SystemMatrix,
        _ if starts("Run case") && line.contains(':') => FileKind::Run,
        _ => return None,
    })
}

/// Which derivatives a heading announces.
fn derivative_kind(line: &str) -> Option<FileKind> {
    match line {
        _ if line.starts_with("Stability-axis derivatives") => Some(FileKind::StabilityDerivatives),
        _ if line.starts_with("Geometry-axis derivatives") => Some(FileKind::BodyDerivatives),
        _ if line.starts_with("Body-axis derivatives") => Some(FileKind::BodyDerivatives),
        _ if line.starts_with("Derivatives...") => Some(FileKind::MixedDerivatives),
        _ => None,
    }
}

/// Head line of the system matrix: the twelve states, then `|`.
pub(crate) fn is_system_heading(line: &str) -> bool {
    let states = line.split('|').next().unwrap_or("");
    states
        .split_whitespace()
        .eq(["u", "w", "q", "the", "v", "p", "r", "phi", "x", "y", "z", "psi"])
}

/// A line of eight numbers with points, as in a strip loading file.
fn is_loading(line: &Line<'_>) -> bool {
    let words: Vec<&str> = line.text.split_whitespace().collect();
    words.len() == 8
        && words
            .iter()
            .all(|w| w.contains('.') && crate::fortran::parse_real(w).is_some())
}

/// Kind of an input file.
fn input_kind(source: &Source<'_>) -> Option<FileKind> {
    let starts = |word: &str| {
        source.lines().any(|l| {
            l.text
                .trim_start()
                .get(..word.len())
                .is_some_and(|t| t.eq_ignore_ascii_case(word))
        })
    };
    if starts("SURF") || starts("BODY") {
        Some(FileKind::Geometry)
    } else if starts("Lunit") || starts("Munit") || starts("Tunit") {
        Some(FileKind::Mass)
    } else {
        None
    }
}

/// The kind of a text's content; `None` when it is no known AVL file.
pub fn recognise_kind(text: &str) -> Option<FileKind> {
    recognise(&Source::new(text, "")).map(|r| r.0)
}

/// Checks that a text is of the wanted kind and gives it with its layout, to be read from its heading.
pub(crate) fn open<'a>(
    text: &'a str,
    file: &'a str,
    wanted: FileKind,
) -> Result<(Source<'a>, Layout), AvlError> {
    let mut source = Source::new(text, file);
    let first = source.lines().find(|l| !l.is_blank());
    let Some(first) = first else {
        let expected = format!("{}, written with {}", wanted.description(), wanted.command());
        return Err(AvlError::Empty {
            file: file.to_owned(),
            expected,
        });
    };
    let Some((kind, layout, start)) = recognise(&source) else {
        return Err(AvlError::UnknownKind {
            file: file.to_owned(),
            first: excerpt(first.text),
        });
    };
    if kind != wanted {
        return Err(AvlError::WrongKind {
            file: file.to_owned(),
            found: kind,
            wanted,
        });
    }
    refuse_second_block(&source, start)?;
    source.seek(start);
    Ok((source, layout))
}

/// AVL offers to append to a file that exists: two blocks in one file are ambiguous.
fn refuse_second_block(source: &Source<'_>, start: usize) -> Result<(), AvlError> {
    let heading = source.line(start).map_or("", |l| l.text.trim());
    let unique = text_kind(heading).is_some_and(|k| k != FileKind::Run && k != FileKind::SystemMatrix)
        || mrf_kind(heading).is_some_and(|k| k != FileKind::BodyForces);
    if !unique {
        return Ok(());
    }
    match (start + 1..source.len())
        .filter_map(|i| source.line(i))
        .find(|l| l.text.trim() == heading)
    {
        None => Ok(()),
        Some(line) => Err(line.syntax(
            "one solution per file (AVL appended a second one; delete the file before writing it again)",
        )),
    }
}
