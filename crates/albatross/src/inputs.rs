//! The files that a case names, read.

use crate::Error;
use crate::case::{Case, SignalCase};
use crate::tables::{self, Columns};
use albatross_avl::geometry::Geometry;
use albatross_avl::results::{StabilityDerivatives, StripForces};
use albatross_flight::derivatives::LongitudinalCorrections;
use albatross_nastran::{Deck, ModalResults, bdf, f06};
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
    /// AVL strip forces at the two incidences of the case.
    pub strips: [StripForces; 2],
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
        let directory = case_file.parent().unwrap_or(Path::new("")).to_path_buf();
        let at = |name: &str| directory.join(name);
        let mut notes = Vec::new();

        let (deck, remarks) = bdf::read_strict(at(&case.structure.deck))?;
        notes.extend(remarks.iter().map(ToString::to_string));
        let results = read_results(&at(&case.structure.results))?;
        notes.extend(results.diagnostics.iter().map(ToString::to_string));

        let (geometry, remarks) = avl(&at(&case.aerodynamics.geometry), Geometry::parse)?;
        notes.extend(remarks.iter().map(ToString::to_string));
        let derivatives = avl(&at(&case.aerodynamics.derivatives), StabilityDerivatives::parse)?;
        let [low, high] = &case.aerodynamics.strips;
        let strips = [
            avl(&at(&low.file), StripForces::parse)?,
            avl(&at(&high.file), StripForces::parse)?,
        ];

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
