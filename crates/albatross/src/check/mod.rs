//! What is missing, unusual or inconsistent in a case, found before anything is analysed.
//!
//! The readers stop at the first thing that they cannot use. [`check`] goes on: it reads every file that the case names,
//! each on its own, and compares them with each other and with what aircraft are like. A misspelt key is read as the
//! key that was meant, so that the rest is looked at too. Where no error is found, the model of each variant is built and
//! trimmed, since the builder has the last word.
//!
//! # Limits
//! Units are told by size: a deck in millimetres, masses in tonnes, moduli in MPa. What passes need not be right.
//!
//! ```
//! # let case = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/case.toml");
//! let report = albatross::check::check(case.as_ref());
//! assert_eq!(report.worst(), Some(albatross::check::Severity::Note));
//! ```

mod aerodynamics;
mod build;
mod coefficients;
mod controls;
mod document;
mod files;
mod flight;
mod manoeuvres;
mod names;
mod parts;
mod reference;
mod strips;
mod structure;
mod units;

use crate::case::{Case, SOLVE};
use crate::inputs::Inputs;
use document::Document;
use files::Files;
pub(crate) use names::nearest;
use serde::Serialize;
use std::path::Path;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Unusual: often a mistake.
    Warning,
    /// The case does not run, or its results would be wrong.
    Error,
}

impl std::fmt::Display for Severity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

/// Something that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// File, with the line where it is known: `case.toml:12`.
    pub place: String,
    /// What was found.
    pub what: String,
    /// How to mend it; may be empty for a note.
    pub cure: String,
}

/// Result of [`check`].
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// What was read, one line each.
    pub facts: Vec<String>,
    /// What was found, in the order of the case file.
    pub findings: Vec<Finding>,
}

impl Report {
    /// The gravest severity among the findings.
    pub fn worst(&self) -> Option<Severity> {
        self.findings.iter().map(|f| f.severity).max()
    }

    /// How many findings have a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.findings.iter().filter(|f| f.severity == severity).count()
    }
}

/// Checks a case file and all that it names.
pub fn check(case_file: &Path) -> Report {
    let file = case_file.display().to_string();
    let mut found = Findings::default();
    let text = match crate::inputs::read_text(case_file) {
        Ok(text) => text,
        Err(error) => {
            found.error(
                &file,
                error.to_string(),
                "give the path of a case file; `albatross new DIR` writes one",
            );
            return found.report(Vec::new());
        }
    };
    let (document, case) = document::read(&text, &file, &mut found);
    let directory = case_file.parent().unwrap_or(Path::new(""));
    let mut files = files::read(&document, directory, &mut found);
    let Some(case) = case else {
        return found.report(files.facts());
    };
    if let Err(error) = case.check(&file) {
        found.of_error(&error.to_string(), &file);
    }
    let before = found.list.clone();
    checks(&document, &case, &mut files, &mut found);
    let computes = case.structure.results == SOLVE || case.aerodynamics.results.as_deref() == Some(SOLVE);
    if computes && !found.any_error() {
        match Inputs::of_case(case.clone(), directory) {
            Ok(inputs) => {
                files.take_computed(inputs);
                found.list = before;
                checks(&document, &case, &mut files, &mut found);
            }
            Err(error) => found.of_error(&error.to_string(), &file),
        }
    }
    if !found.any_error() {
        build::models(&document, case.clone(), directory, &mut found);
    }
    let facts = files.facts();
    found.report(facts)
}

/// Every check of a case with the files that could be read.
fn checks(document: &Document, case: &Case, files: &mut Files, found: &mut Findings) {
    let subject = Subject { document, case };
    units::check(&subject, files, found);
    files.flying = structure::check(&subject, files, found);
    aerodynamics::check(&subject, files, found);
    strips::check(&subject, files, found);
    coefficients::check(&subject, files, found);
    flight::check(&subject, files, found);
    parts::check(&subject, files, found);
    manoeuvres::check(&subject, files, found);
}

/// The case and where its keys stand.
struct Subject<'a> {
    document: &'a Document,
    case: &'a Case,
}

impl Subject<'_> {
    /// Place of a key, as `flight.mach` or `sensor.0.grid`.
    fn at(&self, key: &str) -> String {
        self.document.at(key)
    }
}

/// Findings as they come up.
#[derive(Debug, Default)]
struct Findings {
    list: Vec<Finding>,
}

impl Findings {
    fn push(&mut self, severity: Severity, place: &str, what: impl Into<String>, cure: impl Into<String>) {
        let finding = Finding {
            severity,
            place: place.to_owned(),
            what: what.into(),
            cure: cure.into(),
        };
        if !self.list.contains(&finding) {
            self.list.push(finding);
        }
    }

    fn error(&mut self, place: &str, what: impl Into<String>, cure: impl Into<String>) {
        self.push(Severity::Error, place, what, cure);
    }

    fn warning(&mut self, place: &str, what: impl Into<String>, cure: impl Into<String>) {
        self.push(Severity::Warning, place, what, cure);
    }

    fn note(&mut self, place: &str, what: impl Into<String>, cure: impl Into<String>) {
        self.push(Severity::Note, place, what, cure);
    }

    /// The message of a reader or solver: `place: what; cure`, where the place may be missing.
    fn of_error(&mut self, message: &str, place: &str) {
        self.of_message(Severity::Error, message, place);
    }

    fn of_message(&mut self, severity: Severity, message: &str, place: &str) {
        // Lists of a reader's remarks stand one a line.
        for line in message.lines() {
            let line = line.strip_prefix("error: ").unwrap_or(line);
            let (own, rest) = names::split_place(line, place);
            // Cures stand after a semicolon, or begin with "check".
            let cut = rest.find("; ").or_else(|| rest.find(": check "));
            let (what, cure) = cut.map_or((rest, ""), |i| {
                (rest.get(..i).unwrap_or(rest), rest.get(i + 2..).unwrap_or(""))
            });
            self.push(severity, own, what, cure);
        }
    }

    fn any_error(&self) -> bool {
        self.list.iter().any(|f| f.severity == Severity::Error)
    }

    fn report(self, facts: Vec<String>) -> Report {
        Report {
            facts,
            findings: self.list,
        }
    }
}
