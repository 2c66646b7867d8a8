//! Trim and Table 3: the first three peaks after the 0.5 Hz doublet.

use super::percent;
use crate::error::Error;
use crate::validate::paper::Paper;
use crate::validate::reference::QUANTITIES;
use crate::validate::study::{Study, control_index};
use albatross::flight::Trim;
use albatross::report::{Cell, Column, Format, Table};
use albatross::{Model, sysid};

/// Turning points count as peaks if the series moves by this share of its range between them: the ripple that the
/// elevator's own lift makes in `n_z` before the aircraft follows is passed over.
const PROMINENCE: f64 = 0.1;

/// Peaks of a quantity that Table 3 lists.
const PEAKS: usize = 3;

/// The trimmed state.
pub(super) fn trim(study: &Study) -> Result<Table, Error> {
    let number = |name: &str, unit: &str, decimals| Column::new(name, unit, Format::Fixed(decimals));
    let mut table = Table::new(
        "Trim",
        [
            Column::text("model"),
            number("alpha", "deg", 4),
            number("elevator", "deg", 4),
            number("thrust", "N", 1),
            number("dynamic pressure", "Pa", 2),
            number("mass", "kg", 2),
            Column::new("largest residual", "m/s^2, rad/s^2", Format::Scientific(1)),
        ],
    )
    .with_caption(
        "Level flight at Mach 0.78, 10258 m. The residual is the largest acceleration left in any equation. Thrust acts \
         through the centre of gravity except where said.",
    );
    let [cfd, modsig] = paper_alpha(&study.paper);
    for (name, alpha) in [("paper, CFD", cfd), ("paper, ModSiG", modsig)] {
        let mut row = vec![Cell::from(name), Cell::from(alpha)];
        row.resize(table.columns().len(), Cell::EMPTY);
        table.push(row)?;
    }
    let reference = &study.reference.modes.trim;
    let mut row = vec![
        Cell::from("reference"),
        reference.alpha_deg.into(),
        reference.elevator_deg.into(),
        reference.thrust.into(),
    ];
    row.resize(table.columns().len(), Cell::EMPTY);
    table.push(row)?;
    for variant in &study.variants {
        let name = format!("Albatross, {}", variant.name);
        table.push(trim_row(name, &variant.model, &variant.trimmed.trim)?)?;
    }
    let engines = Model::build(
        &study.inputs,
        &study.inputs.case.variant(Some("engines_in_place"))?,
    )?;
    let (_, trim) = engines.trim()?;
    table.push(trim_row(
        "Albatross, AVL only, thrust at the engines".into(),
        &engines,
        &trim,
    )?)?;
    Ok(table)
}

fn trim_row(name: String, model: &Model, trim: &Trim) -> Result<[Cell; 7], Error> {
    let elevator = control_index(&model.aircraft.controls, &model.point.control)?;
    Ok([
        Cell::from(name),
        trim.alpha_rad.to_degrees().into(),
        trim.controls_rad.get(elevator).map(|v| v.to_degrees()).into(),
        trim.thrust.into(),
        trim.dynamic_pressure.into(),
        model.aircraft.mass.into(),
        // Below this a residual is rounding, which differs from one machine to the next.
        if trim.residual > 1e-9 {
            trim.residual.into()
        } else {
            Cell::from("below 1e-9")
        },
    ])
}

fn paper_alpha(paper: &Paper) -> [Option<f64>; 2] {
    let row = paper.printed.table3.rows.iter().find(|r| r.name == "alpha0");
    [row.map(|r| r.cfd), row.map(|r| r.modsig)]
}

/// One compared model: start and peaks of each of the three quantities.
struct Peaks {
    start: f64,
    values: Vec<f64>,
}

/// Table 3: a row for each peak, a column for each model.
pub(super) fn peaks(study: &Study) -> Result<Table, Error> {
    let number = |name: &str| Column::new(name, "", Format::Fixed(3));
    let mut columns = vec![
        Column::text("peak"),
        Column::text("quantity"),
        Column::text("unit"),
        number("CFD").in_group("paper"),
        number("ModSiG").in_group("paper"),
        number("").in_group("reference"),
    ];
    columns.extend(
        study
            .variants
            .iter()
            .map(|v| number(v.name).in_group("Albatross")),
    );
    columns.extend(study.variants.iter().map(|v| {
        Column::new(v.name, "%", Format::Fixed(1)).in_group("excursion from trim against the reference's")
    }));
    let mut table = Table::new("Table 3: peaks after the 0.5 Hz elevator doublet", columns).with_caption(
        "Values as the paper lists them, trim included. Reference and Albatross fly the same elevator deflection from \
         each one's own trim. The last columns compare excursions, value minus trim, so that n_z = 1 does not flatter \
         the figures. The paper's columns are another aircraft's.",
    );
    let names = [("alpha", 0), ("nz", 2), ("q", 1)];
    // In the order of the paper: incidence in trim, then n_z, q and alpha for each peak.
    let order = std::iter::once((0, "alpha"))
        .chain((1..=PEAKS).flat_map(|peak| ["nz", "q", "alpha"].into_iter().map(move |name| (peak, name))));
    for (peak, name) in order {
        let Some(&(_, quantity)) = names.iter().find(|(known, _)| *known == name) else {
            continue;
        };
        let Some(shown) = QUANTITIES.get(quantity) else {
            continue;
        };
        let key = format!("{name}{peak}");
        let printed = study.paper.printed.table3.rows.iter().find(|r| r.name == key);
        let reference = reference_peaks(study, quantity);
        let models = model_peaks(study, quantity);
        let value = |p: &Peaks| {
            if peak == 0 {
                Some(p.start)
            } else {
                p.values.get(peak - 1).copied()
            }
        };
        let excursion = |p: &Peaks| value(p).map(|v| v - p.start);
        let mut row = vec![
            if peak == 0 {
                Cell::from("trim")
            } else {
                Cell::from(peak)
            },
            shown.name.into(),
            if shown.unit.is_empty() {
                "-".into()
            } else {
                shown.unit.into()
            },
            printed.map(|r| r.cfd).into(),
            printed.map(|r| r.modsig).into(),
            reference.as_ref().and_then(value).into(),
        ];
        row.extend(models.iter().map(|p| Cell::from(value(p))));
        row.extend(models.iter().map(|p| {
            let base = reference.as_ref().and_then(excursion);
            let compared = excursion(p).zip(base).filter(|_| peak > 0);
            Cell::from(compared.map(|(own, base)| percent(own, base)))
        }));
        table.push(row)?;
    }
    Ok(table)
}

fn reference_peaks(study: &Study, quantity: usize) -> Option<Peaks> {
    let history = study.reference.histories.first()?;
    Some(peaks_of(&history.time, history.series.get(quantity)?))
}

fn model_peaks(study: &Study, quantity: usize) -> Vec<Peaks> {
    study
        .variants
        .iter()
        .filter_map(|v| v.flights.first())
        .filter_map(|flight| Some(peaks_of(&flight.time, flight.series.get(quantity)?)))
        .collect()
}

fn peaks_of(time: &[f64], series: &[f64]) -> Peaks {
    Peaks {
        start: series.first().copied().unwrap_or(f64::NAN),
        values: sysid::peaks(time, series, PEAKS, PROMINENCE)
            .iter()
            .map(|p| p.value)
            .collect(),
    }
}

/// The differences that the paper prints in Table 3, and what its own figures give.
pub(super) fn paper_differences(paper: &Paper) -> Result<Table, Error> {
    let number =
        |name: &str, unit: &str, group: &str| Column::new(name, unit, Format::Fixed(2)).in_group(group);
    let mut table = Table::new(
        "Table 3: the paper's differences recomputed",
        [
            Column::text("peak"),
            number("CFD", "", "printed"),
            number("ModSiG", "", "printed"),
            number("absolute difference", "", "printed"),
            number("relative difference", "%", "printed"),
            number("absolute", "", "recomputed"),
            number("relative to CFD", "%", "recomputed"),
            number("relative to ModSiG", "%", "recomputed"),
        ],
    )
    .with_caption(
        "The paper's relative differences are referred to ModSiG, not to the CFD data: those flagged cannot come from \
         the CFD figures however these were rounded, and all can come from the ModSiG figures.",
    );
    for row in &paper.printed.table3.rows {
        let Some(again) = paper.recomputed.table3.iter().find(|r| r.name == row.name) else {
            continue;
        };
        let printed = Cell::from(row.relative_percent);
        table.push([
            Cell::from(row.name.as_str()),
            row.cfd.into(),
            row.modsig.into(),
            row.absolute.into(),
            match (again.printed_possible_vs_cfd, again.printed_possible_vs_modsig) {
                (true, true) => printed,
                (false, true) => printed.flagged("not possible with CFD as the base"),
                (true, false) => printed.flagged("not possible with ModSiG as the base"),
                (false, false) => printed.flagged("not possible with either base"),
            },
            again.abs_recomputed.into(),
            again.rel_vs_cfd.into(),
            again.rel_vs_modsig.into(),
        ])?;
    }
    Ok(table)
}
