//! The tables of the report, one file each for the paper's tables and the project's own.

mod cost;
mod modes;
mod peaks;

use super::check::Kind;
use super::study::Study;
use crate::error::Error;
use albatross::report::Table;

pub(crate) use modes::mean_differences;

/// A table and the stem of its files.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    /// Stem of the CSV and JSON files.
    pub(crate) stem: &'static str,
    pub(crate) table: Table,
    /// How its numbers come about, if no other run repeats them to rounding.
    pub(crate) kind: Option<Kind>,
}

impl Named {
    pub(crate) fn new(stem: &'static str, table: Table) -> Self {
        Self {
            stem,
            table,
            kind: None,
        }
    }

    /// A table of numbers that an iterative search found.
    pub(crate) fn iterated(stem: &'static str, table: Table) -> Self {
        Self {
            kind: Some(Kind::Iterated),
            ..Self::new(stem, table)
        }
    }
}

/// The paper's Tables 3 and 6 to 8 with the columns of this project, and the rigid-body modes.
pub(crate) fn all(study: &Study) -> Result<Vec<Named>, Error> {
    Ok(vec![
        Named::new("trim", peaks::trim(study)?),
        Named::new("table3_peaks", peaks::peaks(study)?),
        Named::new(
            "table3_paper_differences",
            peaks::paper_differences(&study.paper)?,
        ),
        Named::new("table6_cost", cost::quoted(study)?),
        Named {
            kind: Some(Kind::Measured),
            ..Named::new("table6_measured", cost::measured(study)?)
        },
        Named::new("table7_structural_modes", modes::structural(study)?),
        Named::new("table8_aeroelastic_modes", modes::aeroelastic(study)?),
        Named::new("table8_mean_differences", modes::summary(study)?),
        Named::new("rigid_body_modes", modes::rigid_body(study)?),
    ])
}

/// `100 (value - base) / |base|`.
pub(crate) fn percent(value: f64, base: f64) -> f64 {
    100.0 * (value - base) / base.abs()
}
