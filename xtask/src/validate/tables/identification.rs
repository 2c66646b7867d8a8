//! Tables 4 and 5: transfer functions that the paper identified, and the poles that this project can put beside them.

use super::percent;
use crate::error::Error;
use crate::validate::study::{AVL, CORRECTED, Study};
use albatross::analysis::{AeroelasticMode, ModeTable};
use albatross::report::{Cell, Column, Format, Table};

const WAITS: &str = "waits for the identification crate";

/// Table 4: fits of the transfer functions that the paper identified from its CFD data.
pub(super) fn table4(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, group: &str| Column::new(name, "%", Format::Fixed(2)).in_group(group);
    let mut table = Table::new(
        "Table 4: transfer functions identified from CFD data",
        [
            Column::text("output"),
            Column::text("poles and zeros"),
            number("0.5 Hz", "fit, printed"),
            number("3 Hz", "fit, printed"),
            number("10 Hz", "fit, printed"),
            number("printed", "average"),
            number("recomputed", "average"),
            Column::text("identified from the reference's histories"),
        ],
    )
    .with_caption(
        "The paper speaks of an average fit between 93.11 % and 99.65 %. Those are single fits, and the least single \
         fit is 91.10 % (right wing tip, 10 Hz); the averages span 94.79 % to 97.81 %.",
    );
    for row in &study.paper.printed.table4.rows {
        let again = study
            .paper
            .recomputed
            .table4
            .get(&row.output)
            .map(|a| a.avg_recomputed);
        let printed = Cell::from(row.average_percent);
        // A correctly rounded figure is within half a unit of its last place.
        let places = if (10.0 * row.average_percent).fract().abs() < 1e-6 {
            0.05
        } else {
            0.005
        };
        let rounded = again.is_none_or(|a| (a - row.average_percent).abs() <= places + 1e-9);
        let mut cells = vec![
            Cell::from(output_name(&row.output)),
            format!("{} and {}", row.poles, row.zeros).into(),
        ];
        cells.extend(row.fits_percent.iter().map(|f| Cell::from(*f)));
        cells.push(if rounded {
            printed
        } else {
            printed.flagged("truncated, not rounded")
        });
        cells.push(again.into());
        cells.push(Cell::missing(WAITS));
        table.push(cells)?;
    }
    Ok(table)
}

fn output_name(code: &str) -> &str {
    match code {
        "CG" | "qCG" => "q, centre of gravity",
        "CP" => "a_z, cockpit",
        "LPAX" => "a_z, last passenger",
        "RWT" => "a_z, right wing tip",
        other => other,
    }
}

/// Table 5: the paper's poles, the reference's eigenvalues and those of the linearised models.
pub(super) fn table5(study: &Study) -> Result<Table, Error> {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Fixed(2)).in_group(group);
    let mut table = Table::new(
        "Table 5: poles seen in the transfer functions",
        [
            Column::text("output"),
            Column::text("mode"),
            number("identified", "rad/s", "paper"),
            number("ModSiG", "rad/s", "paper"),
            number("printed difference", "%", "paper"),
            number("recomputed against ModSiG", "%", "paper"),
            number("recomputed against identified", "%", "paper"),
            number("eigenvalue", "rad/s", "reference"),
            Column::text("identified").in_group("reference"),
            number("AVL only", "rad/s", "Albatross"),
            number("corrected", "rad/s", "Albatross"),
            number("AVL only", "%", "against the reference's eigenvalue"),
            number("corrected", "%", "against the reference's eigenvalue"),
        ],
    )
    .with_caption(
        "All modes that the paper identified are symmetric: an elevator moves no others. Modes of the reference and of \
         Albatross are matched as in Table 8. The surrogate's modes are numbered as the paper's but are its own.",
    );
    let (avl, corrected) = (&study.modes(AVL)?[0], &study.modes(CORRECTED)?[0]);
    let reference = study.ranked_reference()?;
    let (ranked_avl, ranked_corrected) = (study.ranked(avl)?, study.ranked(corrected)?);
    let rows = study
        .paper
        .printed
        .table5
        .rows
        .iter()
        .zip(&study.paper.recomputed.table5);
    for (row, again) in rows {
        let printed = Cell::from(row.relative_percent);
        let printed = match (again.possible_vs_cfd, again.possible_vs_modsig) {
            (true, true) => printed,
            (false, true) => printed.flagged("not possible with the identified pole as the base"),
            (true, false) => printed.flagged("not possible with ModSiG as the base"),
            (false, false) => printed.flagged("not possible with either base"),
        };
        let modsig = Cell::from(row.modsig);
        // Mode 0 is the short period.
        let own = |table: &ModeTable, ranked: &[Option<&AeroelasticMode>]| match row.mode.checked_sub(1) {
            None => short_period(table),
            Some(k) => ranked.get(k).copied().flatten().map(|m| m.omega_rad_s),
        };
        let (avl, corrected) = (own(avl, &ranked_avl), own(corrected, &ranked_corrected));
        let reference = match row.mode.checked_sub(1) {
            None => study.reference.modes.short_period(),
            Some(k) => reference.get(k).copied().flatten(),
        }
        .map(|e| e.omega_rad_s);
        let against = |value: Option<f64>| Cell::from(value.zip(reference).map(|(v, r)| percent(v, r)));
        table.push([
            Cell::from(output_name(&row.output)),
            if row.mode == 0 {
                Cell::from("short period")
            } else {
                Cell::from(row.mode)
            },
            row.identified.into(),
            if again.table8_match {
                modsig
            } else {
                modsig.flagged("18.95 in Table 8 and in the other rows")
            },
            printed,
            again.rel_vs_modsig.into(),
            again.rel_vs_cfd.into(),
            reference.into(),
            Cell::missing(WAITS),
            avl.into(),
            corrected.into(),
            against(avl),
            against(corrected),
        ])?;
    }
    Ok(table)
}

/// Frequency of the short period of the flexible aircraft.
fn short_period(table: &ModeTable) -> Option<f64> {
    let mode = table.rigid_body.iter().find(|m| m.name == "short period")?;
    Some(mode.flexible.as_ref()?.omega_rad_s)
}
