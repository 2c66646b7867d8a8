//! The tables of the report, one file each for the paper's tables and the project's own.

mod cost;
mod identification;
mod modes;
mod peaks;

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
    /// Whether it holds times of the machine at hand, which no other run repeats.
    pub(crate) measured: bool,
}

impl Named {
    pub(crate) fn new(stem: &'static str, table: Table) -> Self {
        Self {
            stem,
            table,
            measured: false,
        }
    }
}

/// The paper's Tables 3 to 8 with the columns of this project, and the rigid-body modes.
pub(crate) fn all(study: &Study) -> Result<Vec<Named>, Error> {
    Ok(vec![
        Named::new("trim", peaks::trim(study)?),
        Named::new("table3_peaks", peaks::peaks(study)?),
        Named::new(
            "table3_paper_differences",
            peaks::paper_differences(&study.paper)?,
        ),
        Named::new("table4_fits_of_identified", identification::table4(study)?),
        Named::new("table5_poles", identification::table5(study)?),
        Named::new("table6_cost", cost::quoted(study)?),
        Named {
            stem: "table6_measured",
            table: cost::measured(study)?,
            measured: true,
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
