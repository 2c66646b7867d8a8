//! The aerodynamics of a case from its geometry alone: AVL's results, computed.

use crate::Error;
use crate::case::{AvlVersion, LatticeCase};
use albatross_avl::geometry::Geometry;
use albatross_avl::results::{StabilityDerivatives, StripForces};
use albatross_avl::run::{RunTarget, RunVariable};
use albatross_numerics::Mat;
use albatross_vlm::{Condition, Lattice, Method, Solver, Trim};
use std::path::Path;

/// A geometry file, its lattice, and what was remarked about both.
#[derive(Debug, Clone)]
pub struct LatticeInput {
    /// The geometry as written.
    pub geometry: Geometry,
    /// The lattice.
    pub lattice: Lattice,
    /// Remarks of the reader and of the lattice.
    pub notes: Vec<String>,
}

/// Reads an AVL geometry and makes its lattice; aerofoil and body files are looked for beside it, then in the working
/// directory.
///
/// # Errors
/// [`Error::Avl`] of the reader; [`Error::Lattice`] with the file's name.
pub fn read(file: &Path) -> Result<LatticeInput, Error> {
    let text = albatross_avl::read_text(file)?;
    let (geometry, remarks) = Geometry::parse(&text, &file.display().to_string())?;
    let (lattice, of_lattice) = lattice_of(&geometry, file)?;
    let notes = remarks
        .iter()
        .map(ToString::to_string)
        .chain(of_lattice)
        .collect();
    Ok(LatticeInput {
        geometry,
        lattice,
        notes,
    })
}

/// The lattice of a geometry that was read from `file`, and remarks.
///
/// # Errors
/// [`Error::Lattice`] with the file's name.
pub fn lattice_of(geometry: &Geometry, file: &Path) -> Result<(Lattice, Vec<String>), Error> {
    let beside = file.parent().unwrap_or(Path::new(""));
    let text = |name: &str| {
        [beside.join(name), name.into()]
            .iter()
            .find_map(|path| albatross_avl::read_text(path).ok())
    };
    let (lattice, remarks) = Lattice::new(geometry, &text).map_err(of_file(file))?;
    let remarks = remarks
        .iter()
        .map(|r| format!("{}: {r}", file.display()))
        .collect();
    Ok((lattice, remarks))
}

/// Puts the file's name before an error of the lattice.
pub fn of_file(file: &Path) -> impl Fn(albatross_vlm::Error) -> Error {
    let file = file.display().to_string();
    move |source| Error::Lattice {
        file: file.clone(),
        source: Box::new(source),
    }
}

impl LatticeCase {
    /// The method of the version of AVL that is asked for.
    pub fn method(&self, lattice: &Lattice) -> Method {
        let method = match self.method {
            AvlVersion::Avl332 => Method::AVL_332,
            AvlVersion::Avl352 => Method::AVL_352,
        };
        let method = Method {
            leg_forces: self.leg_forces.unwrap_or(method.leg_forces),
            ..method
        };
        method.with_core_of(lattice)
    }
}

/// The flight condition that the lattice is trimmed for.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Mach number of the Prandtl-Glauert rule.
    pub mach: f64,
    /// Lift coefficient on the geometry's reference area.
    pub lift: f64,
    /// Control that brings the pitching moment to zero.
    pub control: String,
}

/// What the files of AVL would hold.
#[derive(Debug, Clone)]
pub struct LatticeResults {
    /// Derivatives about the trimmed condition.
    pub derivatives: StabilityDerivatives,
    /// Strip forces at the two incidences of the case, controls at zero.
    pub strips: [StripForces; 2],
    /// `d(c c_l) / d(local incidence)` of every strip (rows) by the incidence of every strip (columns) \[m/rad\], in the
    /// trimmed flow.
    pub slopes: Option<Mat<f64>>,
    /// On what: vortices, Mach number, trim.
    pub note: String,
}

/// Solves the lattice once, and evaluates it in trim and at two incidences; with lift slopes between strips if wanted.
///
/// # Errors
/// [`Error::Lattice`].
pub fn solve(
    lattice: &Lattice,
    choice: &LatticeCase,
    level: &Level,
    with_slopes: bool,
    file: &Path,
) -> Result<LatticeResults, Error> {
    let method = choice.method(lattice);
    let wrong = of_file(file);
    let solver = Solver::new(lattice, &method, level.mach).map_err(&wrong)?;
    let mut trim = Trim::new(lattice);
    trim.set(lattice, &RunVariable::Alpha, RunTarget::Lift, level.lift)
        .and_then(|()| {
            let control = RunVariable::Control(level.control.clone());
            trim.set(lattice, &control, RunTarget::PitchMoment, 0.0)
        })
        .map_err(&wrong)?;
    let trimmed = solver.trim(&trim).map_err(&wrong)?;
    let derivatives = trimmed.stability_derivatives("trimmed by the lattice");
    let slopes = if with_slopes {
        let all: Vec<usize> = (0..lattice.strips.len()).collect();
        Some(solver.strip_slopes(trimmed.condition(), &all).map_err(&wrong)?)
    } else {
        None
    };
    let at = |alpha_deg: f64| -> Result<StripForces, Error> {
        let condition = Condition::at_alpha_deg(alpha_deg, lattice);
        Ok(solver.solve(&condition).map_err(&wrong)?.strip_forces())
    };
    let [low, high] = choice.alphas_deg;
    let strips = [at(low)?, at(high)?];
    let run = &derivatives.run;
    let note = format!(
        "a lattice of {} vortices at Mach {:.6}, trimmed at CL {:.4} with alpha {:.4} deg",
        run.n_vortices, level.mach, run.c_lift, run.alpha_deg
    );
    Ok(LatticeResults {
        derivatives,
        strips,
        slopes,
        note,
    })
}
