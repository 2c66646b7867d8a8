//! The files that a case names, read.

use crate::Error;
use crate::case::{Case, LiftSlopes, SOLVE, SignalCase, StripFileCase};
use crate::lattice::{self, Level};
use crate::modes;
use crate::tables::{self, Columns};
use albatross_avl::geometry::Geometry;
use albatross_avl::results::{StabilityDerivatives, Strip, StripForces, StripSurface};
use albatross_flight::atmosphere;
use albatross_flight::derivatives::LongitudinalCorrections;
use albatross_modal::{MassProperties, ModalBasis};
use albatross_nastran::{Deck, ModalResults, bdf, f06};
use albatross_numerics::Mat;
use albatross_strip::slopes::SlopeTable;
use std::path::{Path, PathBuf};

/// Everything a case reads.
#[derive(Debug, Clone)]
pub struct Inputs {
    /// The case.
    pub case: Case,
    /// The directory that paths of the case are relative to.
    pub directory: PathBuf,
    /// Nastran deck.
    pub deck: Deck,
    /// Modal results.
    pub results: ModalResults,
    /// AVL geometry.
    pub geometry: Geometry,
    /// AVL derivatives.
    pub derivatives: StabilityDerivatives,
    /// AVL strip forces at two incidences.
    pub strips: [StripForces; 2],
    /// The two incidences \[deg\].
    pub strip_alphas_deg: [f64; 2],
    /// Lift slopes between all strips of the strip forces, rows that are lifted by columns that turn \[m/rad\].
    pub slopes_between: Option<Mat<f64>>,
    /// Lift slopes of higher fidelity.
    pub slope_table: Option<SlopeTable>,
    /// Longitudinal derivatives of higher fidelity.
    pub longitudinal: Option<LongitudinalCorrections>,
    /// What the readers remarked.
    pub notes: Vec<String>,
}

/// Times \[s\] and values.
pub type Samples = (Vec<f64>, Vec<f64>);

impl Inputs {
    /// Reads a case file and all that it names.
    ///
    /// # Errors
    /// The reader's error of the first file that cannot be used.
    pub fn read(case_file: &Path) -> Result<Self, Error> {
        let case = Case::parse(&read_text(case_file)?, &case_file.display().to_string())?;
        Self::of_case(case, case_file.parent().unwrap_or(Path::new("")))
    }

    /// Reads all that a case names, relative to a directory, and computes what it does not name.
    ///
    /// # Errors
    /// The error of the first file that cannot be used, or of a solver.
    pub fn of_case(case: Case, directory: &Path) -> Result<Self, Error> {
        let directory = directory.to_path_buf();
        let at = |name: &str| directory.join(name);
        let mut notes = Vec::new();

        let (deck, remarks) = bdf::read_strict(at(&case.structure.deck))?;
        notes.extend(remarks.iter().map(ToString::to_string));
        let results = if case.structure.results == SOLVE {
            let (results, remarks) = modes::solve(&deck, &case.structure)?;
            notes.extend(remarks);
            results
        } else {
            read_results(&at(&case.structure.results))?
        };
        notes.extend(results.diagnostics.iter().map(ToString::to_string));

        let Aerodynamics {
            geometry,
            derivatives,
            strips,
            strip_alphas_deg,
            slopes_between,
        } = match case.aerodynamics.files() {
            Some(files) => {
                let mut read = read_aerodynamics(&case.aerodynamics.geometry, files, &directory, &mut notes)?;
                if case.aerodynamics.lift_slopes == LiftSlopes::Lattice {
                    let solved = solve_aerodynamics(&case, &directory, &deck, &results)?;
                    same_strips(&read.strips[0], &solved.aerodynamics.strips[0])?;
                    read.slopes_between = solved.aerodynamics.slopes_between;
                    notes.extend(solved.of_lattice);
                    notes.push(format!("lift slopes between strips from {}", solved.note));
                }
                read
            }
            None => {
                let solved = solve_aerodynamics(&case, &directory, &deck, &results)?;
                notes.extend(solved.of_geometry.into_iter().chain(solved.of_lattice));
                let [low, high] = solved.aerodynamics.strip_alphas_deg;
                notes.push(format!(
                    "aerodynamics from {}; strips at {low} and {high} deg",
                    solved.note
                ));
                solved.aerodynamics
            }
        };

        let corrections = case.corrections.as_ref();
        let slope_table = corrections
            .and_then(|c| c.lift_slopes.as_ref().map(|file| (file, &c.provenance)))
            .map(|(file, provenance)| tables::slope_table(&read_text(&at(file))?, file, provenance))
            .transpose()?;
        let longitudinal = corrections
            .and_then(|c| c.derivatives.as_ref())
            .map(|file| tables::longitudinal(&read_text(&at(file))?, file))
            .transpose()?;
        Ok(Self {
            case,
            directory,
            deck,
            results,
            geometry,
            derivatives,
            strips,
            strip_alphas_deg,
            slopes_between,
            slope_table,
            longitudinal,
            notes,
        })
    }

    /// The samples of a signal that lives in a file: times \[s\] and values in the file's unit.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Table`]; none of them for other signals, which return no samples.
    pub fn signal_samples(&self, signal: &SignalCase) -> Result<Option<Samples>, Error> {
        let SignalCase::Csv {
            file,
            time_column,
            value_column,
            ..
        } = signal
        else {
            return Ok(None);
        };
        let columns = Columns::parse(&read_text(&self.directory.join(file))?, file)?;
        Ok(Some((
            columns.numbers(time_column)?,
            columns.numbers(value_column)?,
        )))
    }
}

/// What a case takes of AVL.
struct Aerodynamics {
    geometry: Geometry,
    derivatives: StabilityDerivatives,
    strips: [StripForces; 2],
    strip_alphas_deg: [f64; 2],
    slopes_between: Option<Mat<f64>>,
}

fn read_aerodynamics(
    geometry: &str,
    (derivatives, [low, high]): (&String, &[StripFileCase; 2]),
    directory: &Path,
    notes: &mut Vec<String>,
) -> Result<Aerodynamics, Error> {
    let at = |name: &str| directory.join(name);
    let (geometry, remarks) = avl(&at(geometry), Geometry::parse)?;
    notes.extend(remarks.iter().map(ToString::to_string));
    Ok(Aerodynamics {
        geometry,
        derivatives: avl(&at(derivatives), StabilityDerivatives::parse)?,
        strips: [
            avl(&at(&low.file), StripForces::parse)?,
            avl(&at(&high.file), StripForces::parse)?,
        ],
        strip_alphas_deg: [low.alpha_deg, high.alpha_deg],
        slopes_between: None,
    })
}

/// Aerodynamics that were computed, and remarks.
struct Solved {
    aerodynamics: Aerodynamics,
    /// Remarks of the geometry's reader.
    of_geometry: Vec<String>,
    /// Remarks of the lattice.
    of_lattice: Vec<String>,
    /// On what they were computed.
    note: String,
}

/// AVL's results computed: the lattice is trimmed in level flight about the centre of gravity that flies.
fn solve_aerodynamics(
    case: &Case,
    directory: &Path,
    deck: &Deck,
    results: &ModalResults,
) -> Result<Solved, Error> {
    let file = directory.join(&case.aerodynamics.geometry);
    let (mut geometry, of_geometry) = avl(&file, Geometry::parse)?;
    let mass = mass_that_flies(&case.basis(deck, results)?)?;
    [geometry.x_ref, geometry.y_ref, geometry.z_ref] = mass.cg;
    let (lattice, of_lattice) = lattice::lattice_of(&geometry, &file)?;
    let choice = case.aerodynamics.lattice.clone().unwrap_or_default();
    let flight = &case.flight;
    let pressure = 0.5 * atmosphere::standard(flight.altitude).density * flight.speed().powi(2);
    let level = Level {
        // A negative Mach number is refused by the lattice, not replaced.
        mach: choice.mach.unwrap_or(if geometry.mach != 0.0 {
            geometry.mach
        } else {
            flight.mach()
        }),
        lift: mass.mass * flight.gravity * flight.path_angle_deg.to_radians().cos()
            / (pressure * geometry.s_ref),
        control: flight.trim_control.clone(),
    };
    let with_slopes = case.aerodynamics.lift_slopes == LiftSlopes::Lattice;
    let solved = lattice::solve(&lattice, &choice, &level, with_slopes, &file)?;
    Ok(Solved {
        aerodynamics: Aerodynamics {
            geometry,
            derivatives: solved.derivatives,
            strips: solved.strips,
            strip_alphas_deg: choice.alphas_deg,
            slopes_between: solved.slopes,
        },
        of_geometry: of_geometry.iter().map(ToString::to_string).collect(),
        of_lattice,
        note: solved.note,
    })
}

/// Refuses a geometry whose strips are not those of a strip file, to the four digits of the file.
fn same_strips(file: &StripForces, lattice: &StripForces) -> Result<(), Error> {
    let rows = |forces: &StripForces| -> Vec<(String, f64, f64)> {
        let of = |s: &StripSurface| {
            let row = |r: &Strip| (s.name.trim().to_owned(), r.y_le, r.chord);
            s.strips.iter().map(row).collect::<Vec<_>>()
        };
        forces.surfaces.iter().flat_map(of).collect()
    };
    let (read, made) = (rows(file), rows(lattice));
    let differ = |a: f64, b: f64| (a - b).abs() > 2e-4 * b.abs().max(1.0);
    let pairs = read.iter().zip(&made);
    let first = pairs
        .enumerate()
        .find(|(_, (a, b))| a.0 != b.0 || differ(a.1, b.1) || differ(a.2, b.2));
    let (found, expected) = match first {
        Some((j, (a, b))) => (
            format!("strip {} of `{}` at y = {} with chord {}", j + 1, a.0, a.1, a.2),
            format!("`{}`, y = {:.4}, chord {:.4}", b.0, b.1, b.2),
        ),
        None if read.len() != made.len() => {
            (format!("{} strips", read.len()), format!("{} strips", made.len()))
        }
        None => return Ok(()),
    };
    Err(Error::Mismatch {
        what: "strip file against the lattice of the geometry".into(),
        found,
        expected: format!(
            "{expected}, as in the geometry; run AVL on that geometry, or set results = \"solve\""
        ),
    })
}

/// Mass, centre of gravity and inertia of the basis.
///
/// # Errors
/// [`Error::Mismatch`] if neither deck nor results tell them.
pub fn mass_that_flies(basis: &ModalBasis) -> Result<MassProperties, Error> {
    basis.mass.ok_or_else(|| Error::Mismatch {
        what: "mass of the aircraft".into(),
        found: "neither a complete mass matrix in the deck nor a grid point weight generator in the results"
            .into(),
        expected: "PARAM,GRDPNT,0 in the deck, so that the results hold the weight generator".into(),
    })
}

/// Reads modal results; remarks of severity error are refused with their places.
///
/// # Errors
/// [`Error::Nastran`].
pub fn read_results(path: &Path) -> Result<ModalResults, Error> {
    let results = f06::read(path)?;
    let remarks = results.diagnostics.clone();
    let (results, _) = albatross_nastran::refuse_errors((results, remarks))?;
    Ok(results)
}

/// Reads a text file.
///
/// # Errors
/// [`Error::Read`].
pub fn read_text(path: &Path) -> Result<String, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::Read {
        file: path.display().to_string(),
        source,
    })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn avl<T>(path: &Path, parse: impl Fn(&str, &str) -> Result<T, albatross_avl::AvlError>) -> Result<T, Error> {
    let text = albatross_avl::read_text(path)?;
    Ok(parse(&text, &path.display().to_string())?)
}
