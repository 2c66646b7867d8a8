//! The report for a browser: every figure to zoom, every table, in one file.

use super::figures::Figure;
use super::tables::Named;
use crate::error::Error;
use albatross::report::html::{HtmlReport, Section};

/// Figures first, then tables in the order of their files; the inputs are the last of them.
pub(crate) fn page(tables: &[Named], figures: &[Figure]) -> Result<String, Error> {
    let mut report = HtmlReport::new(
        "Validation: the F25-like aircraft",
        "Albatross against an independent simulation of the same invented surrogate",
    );
    report.push(about()).push(drawn(figures)?);
    for (heading, stems) in CHAPTERS {
        report.push(chapter(heading, tables, |stem| {
            stems.iter().any(|s| stem.starts_with(s))
        }));
    }
    let elsewhere = |stem: &str| {
        let in_chapters = CHAPTERS.iter().flat_map(|(_, stems)| stems.iter());
        stem != INPUTS && !in_chapters.into_iter().any(|s| stem.starts_with(s))
    };
    report.push(chapter("Further tables", tables, elsewhere));
    report.push(chapter("Provenance", tables, |stem| stem == INPUTS));
    Ok(report.render())
}

/// Stem of the table of input files.
const INPUTS: &str = "inputs";

/// Headings and beginnings of the stems of their tables.
const CHAPTERS: [(&str, &[&str]); 5] = [
    (
        "Trim, peaks and fits",
        &["trim", "table3", "fits", "claim", "account"],
    ),
    ("Identification", &["table4"]),
    ("Poles and frequency responses", &["table5", "bode"]),
    ("Modes", &["table7", "table8", "rigid"]),
    ("From deck and geometry alone", &["solved"]),
];

fn about() -> Section {
    let mut section = Section::new("About");
    section
        .list([
            "The aircraft is an invented surrogate, not the DLR-F25, whose model is not public.",
            "The reference is not CFD: its histories, trim and eigenvalues come from an independent simulation of the same \
             surrogate with the doublet lattice method.",
            "The paper's columns are printed figures of another aircraft; they stand beside for orientation.",
        ])
        .paragraph(
            "Written by cargo xtask validate together with docs/validation/README.md, which says more to each of the tables.",
        );
    section
}

fn drawn(figures: &[Figure]) -> Result<Section, Error> {
    let mut section = Section::new("Figures");
    for figure in figures {
        // Captions are Markdown with nothing but emphasis in it.
        section.figure(&figure.plot, &figure.caption.replace("**", ""))?;
    }
    Ok(section)
}

fn chapter(heading: &str, tables: &[Named], belongs: impl Fn(&str) -> bool) -> Section {
    let mut section = Section::new(heading);
    for named in tables.iter().filter(|named| belongs(named.stem)) {
        section.folded_table(&named.table);
    }
    section
}
