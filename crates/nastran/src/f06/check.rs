//! What a results file must have, and whether what it has is whole.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::error::{Error, Severity};
use crate::remarks::Remarks;
use crate::results::ModalResults;

use super::reader::Evidence;

/// Refuses binary files before they are read as text.
pub(super) fn is_text(text: &[u8], file: &str) -> Result<(), Error> {
    if text.iter().take(4096).any(|&b| b == 0) {
        return Err(Error::WrongKind {
            file: file.to_owned(),
            found: "the file is binary (an op2 result, perhaps, or UTF-16 text)".into(),
            expected: "the printed output (.f06 or .out) as plain text".into(),
        });
    }
    if text.trim_ascii().is_empty() {
        return Err(Error::WrongKind {
            file: file.to_owned(),
            found: "the file is empty".into(),
            expected: "the printed output (.f06 or .out) of a SOL 103 run".into(),
        });
    }
    Ok(())
}

/// That there is any result of a real modal analysis.
pub(super) fn anything(results: &ModalResults, evidence: &Evidence) -> Result<(), Error> {
    let file = results.source.clone();
    let missing = |missing: &str, cure: &str| {
        Err(Error::MissingResult {
            file: file.clone(),
            missing: missing.into(),
            cure: cure.into(),
        })
    };
    if evidence.buckling && !results.eigenvalues.is_empty() {
        return missing(
            "its eigenvalues are buckling load factors (SOL 105), not modes",
            "run the model with SOL 103, METHOD = n with EIGRL,n, and DISPLACEMENT(PRINT) = ALL",
        );
    }
    if !(results.eigenvalues.is_empty() && results.eigenvectors.is_empty() && results.weights.is_empty()) {
        return Ok(());
    }
    if evidence.complex {
        return missing(
            "it has complex eigenvalues only",
            "run SOL 103 (real modes) with METHOD = n, EIGRL,n and DISPLACEMENT(PRINT) = ALL",
        );
    }
    if let Some(fatal) = &evidence.fatal {
        return Err(Error::MissingResult {
            file,
            missing: format!("the run failed before any result: {fatal:?}"),
            cure: "correct the model and run it again".into(),
        });
    }
    if evidence.printed {
        return missing(
            "it has no real eigenvalues, no eigenvectors and no grid point weight",
            "run SOL 103 with METHOD = n in case control, EIGRL,n in the bulk data, DISPLACEMENT(PRINT) = ALL and \
             PARAM,GRDPNT,0",
        );
    }
    Err(Error::WrongKind {
        file,
        found: if evidence.deck {
            "the file is an input deck".into()
        } else {
            "no page or heading of Nastran is in the file".into()
        },
        expected: "the printed output (.f06 or .out) of a SOL 103 run".into(),
    })
}

/// Remarks on vectors that are shorter than their neighbours, missing, or at odds with the table.
pub(super) fn complete(results: &ModalResults, remarks: &mut Remarks) {
    row_counts(results, remarks);
    let mut of_subcase: HashMap<Option<u32>, BTreeSet<u32>> = HashMap::new();
    for v in &results.eigenvectors {
        of_subcase.entry(v.subcase).or_default().insert(v.mode);
    }
    let of_all: BTreeSet<u32> = results.eigenvectors.iter().map(|v| v.mode).collect();
    let none = BTreeSet::new();
    for table in &results.eigenvalues {
        let printed = match table.subcase {
            Some(_) => of_subcase.get(&table.subcase).unwrap_or(&none),
            None => &of_all,
        };
        if printed.is_empty() {
            remarks.push(
                Severity::Warning,
                &results.source,
                table.line,
                "eigenvalue table",
                "no eigenvectors are printed for it; add DISPLACEMENT(PRINT) = ALL (NASTRAN-95: VECTOR = ALL under \
                 OUTPUT) to case control",
            );
            continue;
        }
        let absent: Vec<String> = table
            .modes
            .iter()
            .filter(|m| m.has_vector() && !printed.contains(&m.mode))
            .map(|m| m.mode.to_string())
            .collect();
        if !absent.is_empty() {
            let shown = absent.iter().take(12).cloned().collect::<Vec<_>>().join(", ");
            let more = if absent.len() > 12 { ", ..." } else { "" };
            remarks.push(
                Severity::Warning,
                &results.source,
                table.line,
                "eigenvalue table",
                format!(
                    "{} modes have a generalised mass but no printed vector ({shown}{more}); the file may be \
                     truncated, or the output request names fewer modes",
                    absent.len()
                ),
            );
        }
    }
    header_against_table(results, remarks);
}

/// All modes of a subcase and block are printed for the same points.
fn row_counts(results: &ModalResults, remarks: &mut Remarks) {
    let mut longest: BTreeMap<_, usize> = BTreeMap::new();
    for v in &results.eigenvectors {
        let rows = longest.entry((v.subcase, v.block)).or_insert(0);
        *rows = (*rows).max(v.rows.len());
    }
    for v in &results.eigenvectors {
        let expected = longest.get(&(v.subcase, v.block)).copied().unwrap_or(0);
        if v.rows.len() < expected {
            remarks.push(
                Severity::Error,
                &results.source,
                v.line,
                format!("eigenvector {}", v.mode),
                format!(
                    "has {} rows where others of the same output have {expected}; the file may be truncated or \
                     damaged",
                    v.rows.len()
                ),
            );
        }
    }
}

/// The eigenvalue above a vector repeats the table's up to the last digit.
fn header_against_table(results: &ModalResults, remarks: &mut Remarks) {
    let mut of_mode: HashMap<(Option<u32>, u32), f64> = HashMap::new();
    for table in results.eigenvalues.iter().rev() {
        for m in &table.modes {
            of_mode.insert((table.subcase, m.mode), m.eigenvalue);
            of_mode.insert((None, m.mode), m.eigenvalue);
        }
    }
    for v in &results.eigenvectors {
        let Some(header) = v.eigenvalue else { continue };
        let found = of_mode
            .get(&(v.subcase, v.mode))
            .or_else(|| of_mode.get(&(None, v.mode)));
        let Some(&eigenvalue) = found else { continue };
        // Rigid modes are rounding noise and are exempt.
        let noise = 1e-6;
        if (header - eigenvalue).abs() > 1e-5 * eigenvalue.abs() + noise {
            remarks.push(
                Severity::Warning,
                &results.source,
                v.line,
                format!("eigenvector {}", v.mode),
                format!("is headed by eigenvalue {header:.6e}, but the table has {eigenvalue:.6e}"),
            );
        }
    }
}
