//! Shear and bending moment along each surface (`.vm`).

use serde::{Deserialize, Serialize};

use super::kind::{FileKind, Layout, open};
use super::mrf;
use crate::error::AvlError;
use crate::source::{Field, Line, Source, f, g};

/// Content of a `.vm` file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearMoments {
    /// Title of the geometry file.
    pub title: String,
    /// Mach number.
    pub mach: f64,
    /// Angle of attack, in degrees.
    pub alpha_deg: f64,
    /// Sideslip, in degrees.
    pub beta_deg: f64,
    /// Lift coefficient.
    pub c_lift: f64,
    /// Reference area.
    pub s_ref: f64,
    /// Reference span.
    pub b_ref: f64,
    /// Surfaces, mirror images included.
    pub surfaces: Vec<ShearSurface>,
}

/// Shear and moment of one surface. Each surface is integrated by itself: nothing is carried across to another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearSurface {
    /// Number, from 1.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Smallest `2Y/Bref`.
    pub eta_min: f64,
    /// Largest `2Y/Bref`.
    pub eta_max: f64,
    /// Root, one per strip, tip.
    pub stations: Vec<ShearStation>,
}

/// Shear and moment at one station.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShearStation {
    /// `2Y/Bref`.
    pub eta: f64,
    /// `Vz / (q Sref)`.
    pub shear: f64,
    /// `Mx / (q Bref Sref)`.
    pub moment: f64,
}

/// `(F10.4,G14.6,3X,G14.6)`.
const STATION: [Field; 3] = [
    f("2Y/Bref", 0, 10, 4),
    g("Vz/(q*Sref)", 0, 14),
    g("Mx/(q*Bref*Sref)", 3, 14),
];

impl ShearMoments {
    /// Reads a `.vm` file.
    ///
    /// # Errors
    /// As [`SurfaceForces::parse`](super::SurfaceForces::parse).
    pub fn parse(text: &str, file: &str) -> Result<Self, AvlError> {
        let (mut source, layout) = open(text, file, FileKind::ShearMoments)?;
        match layout {
            Layout::Text => read_text(&mut source),
            Layout::Mrf => read_mrf(&mut source),
        }
    }
}

fn read_text(source: &mut Source<'_>) -> Result<ShearMoments, AvlError> {
    source.find("Shear/q and Bending Moment/q")?;
    let title = source.find("Configuration:")?;
    let title = title.text.split_once(':').map_or("", |t| t.1).trim().to_owned();
    let [mach] = source.find_reals([("Mach", 10)])?;
    let [alpha_deg, c_lift] = source.find_reals([("alpha", 10), ("CLtot", 10)])?;
    let [beta_deg] = source.find_reals([("beta", 10)])?;
    let [s_ref] = source.find_reals([("Sref", 12)])?;
    let [b_ref] = source.find_reals([("Bref", 12)])?;
    let mut out = ShearMoments {
        title,
        mach,
        alpha_deg,
        beta_deg,
        c_lift,
        s_ref,
        b_ref,
        surfaces: Vec::new(),
    };
    loop {
        while source.peek().is_some_and(|l| l.is_blank()) {
            source.read();
        }
        if source.peek().is_none_or(|l| l.is_rule()) {
            break;
        }
        out.surfaces.push(read_surface(source)?);
    }
    if out.surfaces.is_empty() {
        Err(source.truncated("`Surface:`"))
    } else {
        Ok(out)
    }
}

/// One surface: number and name on one line or two, range of y, then the stations from root to tip.
fn read_surface(source: &mut Source<'_>) -> Result<ShearSurface, AvlError> {
    let line = source.require("`Surface:`")?;
    let head = line
        .text
        .trim_start()
        .strip_prefix("Surface:")
        .ok_or_else(|| line.syntax("`Surface:`"))?
        .trim();
    let (number, name) = head.split_once(char::is_whitespace).unwrap_or((head, ""));
    let index = line.parse_integer(number, 0, "Surface")?;
    let name = if name.trim().is_empty() {
        source.require("the surface's name")?.text
    } else {
        name
    };
    let [eta_min] = source.find_reals([("2Ymin/Bref", 24)])?;
    let [eta_max] = source.find_reals([("2Ymax/Bref", 24)])?;
    let mut surface = ShearSurface {
        index,
        name: name.trim().to_owned(),
        eta_min,
        eta_max,
        stations: Vec::new(),
    };
    source.find("Vz/(q")?;
    while let Some(line) = source.peek().filter(|l| !l.is_blank() && !l.is_rule()) {
        surface.stations.push(station(&line)?);
        source.read();
    }
    // The last station is the tip: the end of the range that lies farther out. Four decimals are printed.
    let tip = surface.stations.last().map_or(f64::NAN, |s| s.eta);
    let at_end = [surface.eta_min, surface.eta_max]
        .iter()
        .any(|end| (end - tip).abs() < 1e-4);
    if surface.stations.len() >= 2 && at_end {
        Ok(surface)
    } else {
        Err(source.truncated(&format!("the tip station of surface {index}")))
    }
}

fn station(line: &Line<'_>) -> Result<ShearStation, AvlError> {
    match line.row(0, &STATION)?.as_slice() {
        &[eta, shear, moment] => Ok(ShearStation { eta, shear, moment }),
        _ => Err(line.syntax("2Y/Bref, Vz/(q*Sref), Mx/(q*Bref*Sref)")),
    }
}

fn read_mrf(source: &mut Source<'_>) -> Result<ShearMoments, AvlError> {
    mrf::opening(source)?;
    source.require("`Shear/q and Bending Moment/q vs Y`")?;
    let title = source.require("the title")?.text.trim().to_owned();
    let line = mrf::labelled(source, "Mach, alpha, CLtot, beta, Sref, Bref")?;
    let names = ["Mach", "alpha", "CLtot", "beta", "Sref", "Bref"];
    let [mach, alpha_deg, c_lift, beta_deg, s_ref, b_ref] = mrf::reals(&line, 0, names)?;
    let count = mrf::count(source, "# surfaces")?;
    let mut surfaces = Vec::new();
    for _ in 0..count {
        mrf::word(source, "SURFACE")?;
        let name = source.require("the surface's name")?.text.trim().to_owned();
        let line = mrf::labelled(source, "Surface #, # strips")?;
        let [index, n_strips] = mrf::integers(&line, 4, 1, ["Surface #", "# strips"])?;
        let line = mrf::labelled(source, "2Ymin/Bref, 2Ymax/Bref")?;
        let [eta_min, eta_max] = mrf::reals(&line, 0, ["2Ymin/Bref", "2Ymax/Bref"])?;
        let mut stations = Vec::new();
        // Root and tip besides the strips.
        for _ in 0..n_strips.saturating_add(2) {
            let line = mrf::labelled(source, "2Y/Bref")?;
            let [eta, shear, moment] = mrf::reals(&line, 0, ["2Y/Bref", "Vz/(q*Sref)", "Mx/(q*Bref*Sref)"])?;
            stations.push(ShearStation { eta, shear, moment });
        }
        surfaces.push(ShearSurface {
            index,
            name,
            eta_min,
            eta_max,
            stations,
        });
    }
    Ok(ShearMoments {
        title,
        mach,
        alpha_deg,
        beta_deg,
        c_lift,
        s_ref,
        b_ref,
        surfaces,
    })
}
