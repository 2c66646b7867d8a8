//! The paper's printed tables and what they should have been.

use crate::error::Error;
use crate::workspace;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::Path;

/// The paper's figures: as printed, and recomputed from what is printed.
#[derive(Debug, Clone)]
pub(crate) struct Paper {
    pub(crate) printed: Printed,
    pub(crate) recomputed: Recomputed,
}

impl Paper {
    /// Reads `paper_tables.json` and `paper_recomputed.json` of a directory.
    pub(crate) fn read(directory: &Path) -> Result<Self, Error> {
        Ok(Self {
            printed: read_json(&directory.join("paper_tables.json"))?,
            recomputed: read_json(&directory.join("paper_recomputed.json"))?,
        })
    }
}

pub(crate) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, Error> {
    serde_json::from_str(&workspace::read(path)?).map_err(Error::json(path))
}

/// Tables 3 to 8 as printed.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Printed {
    pub(crate) table3: Rows<Table3Row>,
    pub(crate) table4: Rows<Table4Row>,
    pub(crate) table5: Rows<Table5Row>,
    pub(crate) table6: Table6,
    pub(crate) table7: Rows<Table7Row>,
    pub(crate) table8: Table8,
}

/// Rows of a table.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Rows<T> {
    pub(crate) rows: Vec<T>,
}

/// One peak; `name` is a quantity and the number of the peak, 0 for the trim.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table3Row {
    pub(crate) name: String,
    pub(crate) cfd: f64,
    pub(crate) modsig: f64,
    pub(crate) absolute: f64,
    pub(crate) relative_percent: f64,
}

/// One identified transfer function.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table4Row {
    pub(crate) output: String,
    pub(crate) poles: i64,
    pub(crate) zeros: i64,
    pub(crate) fits_percent: [f64; 3],
    pub(crate) average_percent: f64,
}

/// One pole; mode 0 is the short period.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table5Row {
    pub(crate) output: String,
    pub(crate) mode: usize,
    pub(crate) identified: f64,
    pub(crate) modsig: f64,
    pub(crate) relative_percent: f64,
}

/// Cost of a simulation.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table6 {
    pub(crate) simulated_s: f64,
    pub(crate) modsig_s: [f64; 2],
    pub(crate) cfd_h: [f64; 2],
}

/// One structural mode.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table7Row {
    pub(crate) mode: usize,
    pub(crate) frequency_hz: f64,
    pub(crate) omega_rad_s: f64,
    pub(crate) description: String,
}

/// Aeroelastic frequencies.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table8 {
    pub(crate) omega_rad_s: Vec<f64>,
}

/// What follows from the printed figures.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Recomputed {
    pub(crate) table3: Vec<RelativeDifference>,
    pub(crate) table4: BTreeMap<String, Average>,
    pub(crate) table5: Vec<RelativeDifference5>,
    pub(crate) table5_claims: Claims,
    pub(crate) table6: Speed,
    pub(crate) table7: Vec<Table7Check>,
}

/// A relative difference of Table 3 with either column as the base.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct RelativeDifference {
    pub(crate) name: String,
    pub(crate) abs_recomputed: f64,
    pub(crate) rel_vs_cfd: f64,
    pub(crate) rel_vs_modsig: f64,
    pub(crate) printed_possible_vs_cfd: bool,
    pub(crate) printed_possible_vs_modsig: bool,
}

/// A mean fit of Table 4.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Average {
    pub(crate) avg_recomputed: f64,
}

/// A relative difference of Table 5 with either column as the base.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct RelativeDifference5 {
    pub(crate) rel_vs_cfd: f64,
    pub(crate) rel_vs_modsig: f64,
    pub(crate) possible_vs_cfd: bool,
    pub(crate) possible_vs_modsig: bool,
    pub(crate) table8_match: bool,
}

/// Counts behind the paper's sentences on Table 5.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Claims {
    pub(crate) n_rows: usize,
    pub(crate) n_flexible: usize,
    pub(crate) max_flexible_printed: f64,
    pub(crate) max_all_printed: f64,
    pub(crate) n_flex_below_3p5: usize,
    pub(crate) n_all_above_6: usize,
}

/// Ratios of Table 6: lowest and highest.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Speed {
    pub(crate) real_time_factor: [f64; 2],
    pub(crate) speedup: [f64; 2],
}

/// Hz against rad/s of Table 7.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Table7Check {
    pub(crate) within_rounding: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Paper {
        Paper::read(&workspace::root().join("fixtures/paper")).unwrap()
    }

    fn close(found: f64, expected: f64, what: &str) {
        assert!(
            (found - expected).abs() < 1e-9,
            "{what}: {found} against {expected}"
        );
    }

    /// The recomputed file follows from the printed one by the definitions.
    #[test]
    fn val_recomputed_figures_follow_from_the_printed_ones() {
        let Paper { printed, recomputed } = paper();
        for (row, r) in printed.table3.rows.iter().zip(&recomputed.table3) {
            assert_eq!(row.name, r.name);
            let difference = (row.cfd - row.modsig).abs();
            close(r.abs_recomputed, difference, &row.name);
            close(r.rel_vs_cfd, 100.0 * difference / row.cfd.abs(), &row.name);
            close(r.rel_vs_modsig, 100.0 * difference / row.modsig.abs(), &row.name);
        }
        for row in &printed.table4.rows {
            let mean = row.fits_percent.iter().sum::<f64>() / 3.0;
            close(recomputed.table4[&row.output].avg_recomputed, mean, &row.output);
        }
        assert_eq!(printed.table5.rows.len(), recomputed.table5.len());
        for (row, r) in printed.table5.rows.iter().zip(&recomputed.table5) {
            let difference = 100.0 * (row.identified - row.modsig).abs();
            close(r.rel_vs_cfd, difference / row.identified, &row.output);
            close(r.rel_vs_modsig, difference / row.modsig, &row.output);
            let in_table8 = (row.mode > 0).then(|| printed.table8.omega_rad_s[row.mode - 1]);
            assert_eq!(r.table8_match, in_table8.is_none_or(|w| w == row.modsig));
        }
        let t6 = &printed.table6;
        close(
            recomputed.table6.real_time_factor[0],
            t6.modsig_s[0] / t6.simulated_s,
            "real time",
        );
        close(
            recomputed.table6.speedup[0],
            t6.cfd_h[0] * 3600.0 / t6.modsig_s[1],
            "speed-up",
        );
    }

    /// The counts behind the sentences of the paper's conclusion.
    #[test]
    fn val_claims_on_table_5() {
        let Paper { printed, recomputed } = paper();
        let claims = &recomputed.table5_claims;
        let rows = &printed.table5.rows;
        let flexible: Vec<f64> = rows
            .iter()
            .filter(|r| r.mode > 0)
            .map(|r| r.relative_percent)
            .collect();
        assert_eq!((rows.len(), flexible.len()), (claims.n_rows, claims.n_flexible));
        assert_eq!(
            flexible.iter().filter(|v| **v < 3.5).count(),
            claims.n_flex_below_3p5
        );
        assert_eq!(
            rows.iter().filter(|r| r.relative_percent > 6.0).count(),
            claims.n_all_above_6
        );
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        close(
            largest(&mut flexible.iter().copied()),
            claims.max_flexible_printed,
            "elastic",
        );
        close(
            largest(&mut rows.iter().map(|r| r.relative_percent)),
            claims.max_all_printed,
            "all",
        );
    }
}
