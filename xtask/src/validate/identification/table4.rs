//! Table 4: fits of the identified transfer functions.

use super::{Identification, Target};
use crate::error::Error;
use crate::validate::study::Study;
use albatross::report::{Cell, Column, Format, Table};

/// The paper's fits beside those of the transfer functions identified here, at its orders and at the searched ones.
pub(super) fn fits(study: &Study, identification: &Identification) -> Result<Table, Error> {
    const PRINTED: &str = "paper, CFD";
    const AT_PAPER: &str = "reference's histories, paper's order";
    const SEARCHED: &str = "reference's histories, searched order";
    let number = |name: &str, group: &str| Column::new(name, "%", Format::Fixed(2)).in_group(group);
    let fits = |group: &str| ["0.5 Hz", "3 Hz", "10 Hz"].map(|name| number(name, group));
    let mut heads = vec![
        Column::text("output"),
        Column::text("poles and zeros").in_group(PRINTED),
    ];
    heads.extend(fits(PRINTED));
    heads.push(number("average", PRINTED));
    heads.push(number("average recomputed", PRINTED));
    heads.extend(fits(AT_PAPER));
    heads.push(number("average", AT_PAPER));
    heads.push(Column::text("poles and zeros").in_group(SEARCHED));
    heads.extend(fits(SEARCHED));
    heads.push(number("average", SEARCHED));
    let mut table = Table::new("Table 4: fits of identified transfer functions", heads).with_caption(
        "Fits of the simulated transfer function to each history, started at rest. The paper's are those of another \
         aircraft and of CFD; the others come from the DLM-based histories of the surrogate, trained on all three \
         together. The paper speaks of an average fit between 93.11 % and 99.65 %. Those are single fits, and the \
         least single fit is 91.10 % (right wing tip, 10 Hz); the averages span 94.79 % to 97.81 %.",
    );
    for row in &study.paper.printed.table4.rows {
        let again = study.paper.recomputed.table4.get(&row.output);
        let again = again.map(|a| a.avg_recomputed);
        let printed = Cell::from(row.average_percent);
        // A correctly rounded figure is within half a unit of its last place.
        let places = if (10.0 * row.average_percent).fract().abs() < 1e-6 {
            0.05
        } else {
            0.005
        };
        let rounded = again.is_none_or(|a| (a - row.average_percent).abs() <= places + 1e-9);
        let output = Target::of_code(&row.output).and_then(|i| identification.outputs.get(i));
        let name = output.map_or(row.output.as_str(), |o| o.target.name());
        let mut cells = vec![
            Cell::from(name),
            format!("{} and {}", row.poles, row.zeros).into(),
        ];
        cells.extend(row.fits_percent.iter().map(|f| Cell::from(*f)));
        cells.push(if rounded {
            printed
        } else {
            printed.flagged("truncated, not rounded")
        });
        cells.push(again.into());
        if let Some(output) = output {
            cells.extend(output.paper.fits.iter().map(|f| Cell::from(*f)));
            cells.push(output.paper.average().into());
            let searched = &output.searched;
            cells.push(format!("{} and {}", searched.poles, searched.zeros).into());
            cells.extend(searched.fits.iter().map(|f| Cell::from(*f)));
            cells.push(searched.average().into());
        }
        cells.resize(table.columns().len(), Cell::EMPTY);
        table.push(cells)?;
    }
    Ok(table)
}
