//! The files that a case names, each read on its own.

use super::document::Document;
use super::names::{self, nearest};
use super::{Findings, Severity};
use crate::case::SOLVE;
use crate::inputs::{Inputs, read_text};
use crate::tables;
use albatross_avl::AvlError;
use albatross_avl::geometry::Geometry;
use albatross_avl::mass::MassFile;
use albatross_avl::results::{StabilityDerivatives, StripForces};
use albatross_fem::MassProperties;
use albatross_flight::derivatives::LongitudinalCorrections;
use albatross_nastran::frames::Frames;
use albatross_nastran::{Deck, ModalResults, bdf, f06};
use albatross_strip::slopes::SlopeTable;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What could be read; a file in error is not there.
#[derive(Debug, Default)]
pub(super) struct Files {
    pub(super) directory: PathBuf,
    pub(super) deck: Option<Deck>,
    /// Grids in basic axes \[m\].
    pub(super) grids: BTreeMap<u32, [f64; 3]>,
    pub(super) results: Option<ModalResults>,
    pub(super) geometry: Option<Geometry>,
    pub(super) derivatives: Option<StabilityDerivatives>,
    pub(super) strips: [Option<StripForces>; 2],
    /// The mass file beside the geometry, with its path.
    pub(super) mass: Option<(String, MassFile)>,
    pub(super) slope_table: Option<SlopeTable>,
    pub(super) longitudinal: Option<LongitudinalCorrections>,
    /// The mass that flies, once the structure is checked.
    pub(super) flying: Option<MassProperties>,
    /// Whether modes and aerodynamics were computed for the check.
    computed: bool,
}

impl Files {
    /// Path of a file of the case, as the readers name it.
    pub(super) fn path(&self, name: &str) -> String {
        self.directory.join(name).display().to_string()
    }

    /// Takes what was computed in the place of files.
    pub(super) fn take_computed(&mut self, inputs: Inputs) {
        let [low, high] = inputs.strips;
        self.computed = true;
        self.results = Some(inputs.results);
        self.derivatives = Some(inputs.derivatives);
        self.strips = [Some(low), Some(high)];
    }

    /// What was read, one line each.
    pub(super) fn facts(&self) -> Vec<String> {
        let mut facts = Vec::new();
        let origin = if self.computed { "computed" } else { "read" };
        if let Some(deck) = &self.deck {
            let elements = deck.bars.len() + deck.beams.len() + deck.rods.len() + deck.springs.len();
            facts.push(format!(
                "deck: {} grids, {elements} bars, beams, rods and springs",
                deck.grids.len()
            ));
        }
        if let Some(mass) = &self.flying {
            let at = mass
                .cg
                .map(|v| names::digits((v * 1e4).round() * 1e-4, 7))
                .join(", ");
            facts.push(format!(
                "mass: {} kg, centre of gravity at {at} m",
                names::digits(mass.mass, 7)
            ));
        }
        let frequencies = self.results.iter().flat_map(|r| r.eigenvalues.first());
        for table in frequencies {
            let last = table.modes.last().map_or(0.0, |m| m.frequency_hz);
            facts.push(format!(
                "modes, {origin}: {} up to {last:.2} Hz",
                table.modes.len()
            ));
        }
        if let Some(geometry) = &self.geometry {
            let names: Vec<&str> = geometry.surfaces.iter().map(|s| s.name.trim()).collect();
            facts.push(format!(
                "geometry: {}; reference area {} m2, chord {} m, span {} m",
                names.join(", "),
                geometry.s_ref,
                geometry.c_ref,
                geometry.b_ref
            ));
        }
        if let Some(derivatives) = &self.derivatives {
            let run = &derivatives.run;
            facts.push(format!(
                "derivatives, {origin}: Mach {:.4}, CL {:.4}, alpha {:.3} deg, {} strips",
                run.mach, run.c_lift, run.alpha_deg, run.n_strips
            ));
        }
        facts
    }
}

/// Reads every file that the document names.
pub(super) fn read(document: &Document, directory: &Path, found: &mut Findings) -> Files {
    let mut reader = Reader {
        document,
        directory,
        found,
    };
    let mut files = Files {
        directory: directory.to_path_buf(),
        ..Files::default()
    };
    files.deck = reader.file("structure.deck", deck);
    if let Some(deck) = &files.deck {
        match Frames::resolve(deck) {
            Ok(frames) => {
                let place = |(id, grid): (&u32, &albatross_nastran::frames::ResolvedGrid)| {
                    (*id, [grid.position.x, grid.position.y, grid.position.z])
                };
                files.grids = frames.grids().iter().map(place).collect();
            }
            Err(error) => reader
                .found
                .of_error(&error.to_string(), &document.at("structure.deck")),
        }
    }
    files.results = reader.file("structure.results", results);
    files.geometry = reader.file("aerodynamics.geometry", geometry);
    files.mass = beside(document, directory, reader.found);
    files.derivatives = reader.file("aerodynamics.derivatives", |path, found| {
        avl(path, found, StabilityDerivatives::parse)
    });
    files.strips = ["aerodynamics.strips.0.file", "aerodynamics.strips.1.file"]
        .map(|key| reader.file(key, |path, found| avl(path, found, StripForces::parse)));
    let provenance = document.text("corrections.provenance").unwrap_or_default();
    files.slope_table = reader.file("corrections.lift_slopes", |path, found| {
        table(path, found, |text, file| {
            tables::slope_table(text, file, provenance)
        })
    });
    files.longitudinal = reader.file("corrections.derivatives", |path, found| {
        table(path, found, tables::longitudinal)
    });
    files
}

struct Reader<'a> {
    document: &'a Document,
    directory: &'a Path,
    found: &'a mut Findings,
}

impl Reader<'_> {
    /// Reads the file that a key names, if the key is there and the file too.
    fn file<T>(&mut self, key: &str, read: impl Fn(&Path, &mut Findings) -> Option<T>) -> Option<T> {
        let name = self.document.text(key).filter(|name| *name != SOLVE)?;
        let path = self.directory.join(name);
        if path.is_file() {
            return read(&path, self.found);
        }
        let what = if path.is_dir() {
            format!("`{name}` is a directory")
        } else {
            format!("there is no file `{name}`")
        };
        let cure = match similar(&path) {
            Some(other) => format!("did you mean `{other}`? Paths are relative to the case file"),
            None => "correct the path; it is relative to the case file".to_owned(),
        };
        self.found.error(&self.document.at(key), what, cure);
        None
    }
}

/// The file in the same directory whose name is nearest.
fn similar(path: &Path) -> Option<String> {
    let directory = path.parent()?;
    let wanted = path.file_name()?.to_str()?;
    let entries = std::fs::read_dir(if directory.as_os_str().is_empty() {
        Path::new(".")
    } else {
        directory
    });
    let names: Vec<String> = entries
        .ok()?
        .filter_map(|e| e.ok()?.file_name().into_string().ok())
        .collect();
    nearest(wanted, names.iter().map(String::as_str)).map(str::to_owned)
}

/// Remarks of the Nastran readers; true if none is an error.
fn remarks(remarks: &[albatross_nastran::Diagnostic], found: &mut Findings) -> bool {
    use albatross_nastran::Severity as Theirs;
    for remark in remarks {
        let severity = match remark.severity {
            Theirs::Error => Severity::Error,
            Theirs::Warning => Severity::Warning,
            Theirs::Note => Severity::Note,
        };
        let place = if remark.line > 0 {
            format!("{}:{}", remark.file, remark.line)
        } else {
            remark.file.clone()
        };
        let (what, cure) = remark
            .message
            .split_once("; ")
            .unwrap_or((remark.message.as_str(), ""));
        let what = if remark.card.is_empty() {
            what.to_owned()
        } else {
            format!("{}: {what}", remark.card)
        };
        found.push(severity, &place, what, cure);
    }
    remarks.iter().all(|r| r.severity != Theirs::Error)
}

fn deck(path: &Path, found: &mut Findings) -> Option<Deck> {
    let name = path.display().to_string();
    match bdf::read(path) {
        Ok((deck, diagnostics)) => remarks(&diagnostics, found).then_some(deck),
        Err(error) => {
            found.of_error(&error.to_string(), &name);
            None
        }
    }
}

fn results(path: &Path, found: &mut Findings) -> Option<ModalResults> {
    let name = path.display().to_string();
    match f06::read(path) {
        Ok(results) => remarks(&results.diagnostics, found).then_some(results),
        Err(error) => {
            found.of_error(&error.to_string(), &name);
            None
        }
    }
}

fn geometry(path: &Path, found: &mut Findings) -> Option<Geometry> {
    let (geometry, diagnostics) = avl(path, found, Geometry::parse)?;
    for remark in diagnostics {
        let (what, cure) = remark
            .message
            .split_once("; ")
            .unwrap_or((remark.message.as_str(), ""));
        found.note(
            &remark.at.to_string(),
            format!("{}: {what}", remark.keyword),
            cure,
        );
    }
    Some(geometry)
}

/// The mass file that AVL would take with the geometry: of the same name, with the ending `.mass`.
fn beside(document: &Document, directory: &Path, found: &mut Findings) -> Option<(String, MassFile)> {
    let path = directory
        .join(document.text("aerodynamics.geometry")?)
        .with_extension("mass");
    let (mass, _) = path
        .is_file()
        .then(|| avl(&path, found, MassFile::parse))
        .flatten()?;
    Some((path.display().to_string(), mass))
}

fn avl<T>(path: &Path, found: &mut Findings, parse: impl Fn(&str, &str) -> Result<T, AvlError>) -> Option<T> {
    let name = path.display().to_string();
    match albatross_avl::read_text(path).and_then(|text| parse(&text, &name)) {
        Ok(read) => Some(read),
        Err(error) => {
            found.of_error(&error.to_string(), &name);
            None
        }
    }
}

fn table<T>(
    path: &Path,
    found: &mut Findings,
    parse: impl Fn(&str, &str) -> Result<T, crate::Error>,
) -> Option<T> {
    let name = path.display().to_string();
    match read_text(path).and_then(|text| parse(&text, &name)) {
        Ok(read) => Some(read),
        Err(error) => {
            found.of_error(&error.to_string(), &name);
            None
        }
    }
}
