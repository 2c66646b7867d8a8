//! Results as tables and sentences.

use super::identify::Identified;
use crate::output::Failure;
use albatross::lti::Signal;
use albatross::report::{Cell, Column, Format, ReportError, Table};
use albatross::sysid::{Estimate, ResidualCheck, Simulated};

/// `q [deg/s]`, without the unit where there is none.
pub(crate) fn with_unit(signal: &Signal) -> String {
    match signal.unit.as_str() {
        "" | "1" | "-" => signal.name.clone(),
        unit => format!("{} [{unit}]", signal.name),
    }
}

pub(crate) fn fits(
    outputs: &[Signal],
    simulated: &[Simulated],
    training: &[usize],
) -> Result<Table, ReportError> {
    let mut columns = vec![Column::text("record"), Column::text("used")];
    columns.extend(
        outputs
            .iter()
            .map(|o| Column::new(&o.name, "%", Format::Fixed(2))),
    );
    let mut table = Table::new("Fit", columns);
    for (e, record) in simulated.iter().enumerate() {
        let used = if training.contains(&e) {
            "to fit"
        } else {
            "to score only"
        };
        let cells = record.fits.iter().map(|fit| match fit {
            Some(fit) => Cell::from(*fit),
            None => Cell::missing("the measured output is constant"),
        });
        table.push(
            [Cell::from(record.experiment.as_str()), Cell::from(used)]
                .into_iter()
                .chain(cells),
        )?;
    }
    Ok(table)
}

/// Fits of records that no one fitted.
pub(crate) fn scores(outputs: &[Signal], simulated: &[Simulated]) -> Result<Table, ReportError> {
    let mut columns = vec![Column::text("record")];
    columns.extend(
        outputs
            .iter()
            .map(|o| Column::new(&o.name, "%", Format::Fixed(2))),
    );
    let mut table = Table::new("Fit", columns);
    for record in simulated {
        let fits = record.fits.iter().map(|fit| Cell::from(*fit));
        table.push(std::iter::once(Cell::from(record.experiment.as_str())).chain(fits))?;
    }
    Ok(table)
}

/// Poles with standard deviations; without them if there are none.
pub(crate) fn poles(estimate: &Estimate) -> Result<Table, ReportError> {
    let model = &estimate.model;
    let Some(uncertainty) = &estimate.uncertainty else {
        return poles_alone(estimate);
    };
    let mut columns = vec![
        Column::new("frequency", "rad/s", Format::Significant(6)),
        Column::new("sd", "rad/s", Format::Significant(2)),
        Column::new("sd, coloured", "rad/s", Format::Significant(2)),
        Column::new("damping", "-", Format::Fixed(4)),
        Column::new("sd", "-", Format::Significant(2)),
        Column::new("sd, coloured", "-", Format::Significant(2)),
        Column::new("re", "1/s", Format::Significant(5)),
        Column::new("im", "rad/s", Format::Significant(5)),
    ];
    columns.extend(
        model
            .outputs
            .iter()
            .map(|o| Column::new(&o.name, "sd", Format::Significant(3)).in_group("residue")),
    );
    columns.push(Column::text("identified"));
    columns.push(Column::text("near a zero of"));
    let mut table = Table::new("Poles", columns);
    for mode in &uncertainty.modes {
        let mut cells: Vec<Cell> = [
            mode.frequency_rad_s,
            mode.sd_frequency_rad_s,
            mode.sd_frequency_coloured_rad_s,
            mode.damping_ratio,
            mode.sd_damping_ratio,
            mode.sd_damping_ratio_coloured,
            mode.re,
            mode.im,
        ]
        .map(Cell::from)
        .to_vec();
        if mode.im == 0.0 {
            // The damping ratio of a real pole is 1.
            cells.iter_mut().skip(4).take(2).for_each(|c| *c = Cell::EMPTY);
        }
        cells.extend(mode.residues.iter().map(|r| Cell::from(r.modulus / r.sd_modulus)));
        cells.push(Cell::from(if mode.identified { "yes" } else { "no" }));
        cells.push(Cell::from(mode.near_cancellation.join(", ")));
        table.push(cells)?;
    }
    Ok(table)
}

fn poles_alone(estimate: &Estimate) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Poles",
        [
            Column::new("frequency", "rad/s", Format::Significant(6)),
            Column::new("damping", "-", Format::Fixed(4)),
            Column::new("re", "1/s", Format::Significant(5)),
            Column::new("im", "rad/s", Format::Significant(5)),
        ],
    );
    for pole in estimate.model.poles().iter().filter(|p| p.im >= 0.0) {
        let modulus = pole.norm();
        table.push([modulus, -pole.re / modulus, pole.re, pole.im].map(Cell::from))?;
    }
    Ok(table)
}

fn zeros(found: &Identified) -> Result<Table, Failure> {
    let mut table = Table::new(
        "Zeros",
        [
            Column::text("output"),
            Column::new("re", "1/s", Format::Significant(5)),
            Column::new("im", "rad/s", Format::Significant(5)),
            Column::new("modulus", "rad/s", Format::Significant(5)),
        ],
    );
    let model = &found.estimate.model;
    for (o, output) in model.outputs.iter().enumerate() {
        for zero in model.zpk(o)?.zeros.iter().filter(|z| z.im >= 0.0) {
            table.push([
                Cell::from(output.name.as_str()),
                Cell::from(zero.re),
                Cell::from(zero.im),
                Cell::from(zero.norm()),
            ])?;
        }
    }
    Ok(table)
}

fn criteria(found: &Identified) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Criteria of the records fitted",
        [
            Column::text("output"),
            Column::new("mean square", "unit2", Format::Significant(4)),
            Column::new("FPE", "unit2", Format::Significant(4)),
            Column::new("AIC", "", Format::Fixed(1)),
            Column::new("AICc", "", Format::Fixed(1)),
            Column::new("BIC", "", Format::Fixed(1)),
        ],
    );
    for (output, of_output) in found.estimate.model.outputs.iter().zip(&found.criteria) {
        table.push([
            Cell::from(output.name.as_str()),
            Cell::from(of_output.mse),
            Cell::from(of_output.fpe),
            Cell::from(of_output.aic),
            Cell::from(of_output.aicc),
            Cell::from(of_output.bic),
        ])?;
    }
    Ok(table)
}

pub(crate) fn residuals(checks: &[ResidualCheck]) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Residuals",
        [
            Column::text("record"),
            Column::text("output"),
            Column::new("rms", "unit", Format::Significant(4)),
            Column::new("Ljung-Box", "", Format::Significant(4)),
            Column::new("bound", "", Format::Significant(4)),
            Column::text("white"),
            Column::new("largest with input", "", Format::Fixed(3)),
            Column::new("bound", "", Format::Fixed(3)),
            Column::text("independent of input"),
        ],
    );
    let word = |verdict: Option<bool>| match verdict {
        Some(true) => "yes",
        Some(false) => "no",
        None => "zero",
    };
    for check in checks {
        let largest = check.cross.values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        table.push([
            Cell::from(check.experiment.as_str()),
            Cell::from(check.output.as_str()),
            Cell::from(check.rms),
            Cell::from(check.ljung_box),
            Cell::from(check.ljung_box_bound),
            Cell::from(word(check.white)),
            Cell::from(largest),
            Cell::from(check.cross_bound_of_all),
            Cell::from(word(check.independent)),
        ])?;
    }
    Ok(table)
}

fn log(estimate: &Estimate) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Search",
        [
            Column::new("iteration", "", Format::Fixed(0)),
            Column::new("cost", "", Format::Significant(8)),
            Column::new("step", "", Format::Significant(3)),
            Column::new("expected gain", "", Format::Scientific(1)),
            Column::text("direction"),
            Column::new("halvings", "", Format::Fixed(0)),
            Column::new("samples a row", "", Format::Fixed(0)),
        ],
    );
    for (i, iteration) in estimate.iterations.iter().enumerate() {
        let direction = serde_json::to_value(iteration.method)
            .ok()
            .and_then(|v| v.as_str().map(str::to_owned))
            .unwrap_or_default();
        table.push([
            Cell::from(i + 1),
            Cell::from(iteration.cost),
            Cell::from(iteration.step),
            Cell::from(iteration.expected),
            Cell::from(direction),
            Cell::from(iteration.halvings),
            Cell::from(iteration.samples_a_row),
        ])?;
    }
    Ok(table)
}

/// The whole result for a reader.
pub(crate) fn summary(found: &Identified, with_log: bool) -> Result<String, Failure> {
    let estimate = &found.estimate;
    let model = &estimate.model;
    let outputs: Vec<String> = model.outputs.iter().map(with_unit).collect();
    let mut parts = vec![format!(
        "{} poles and {} zeros from {} to {}\n",
        model.order(),
        model.zeros,
        with_unit(&model.input),
        outputs.join(", ")
    )];
    parts.push(fits(&model.outputs, &found.simulated, &found.training)?.to_text());
    parts.push(poles(estimate)?.to_text());
    parts.push(zeros(found)?.to_text());
    parts.push(criteria(found)?.to_text());
    parts.push(residuals(&found.residuals)?.to_text());
    if with_log {
        parts.push(log(estimate)?.to_text());
    }
    parts.push(how(found));
    let warnings: String = found.warnings.iter().map(|w| format!("warning: {w}\n")).collect();
    if !warnings.is_empty() {
        parts.push(warnings);
    }
    Ok(parts.join("\n"))
}

/// How the model was found.
fn how(found: &Identified) -> String {
    let estimate = &found.estimate;
    let start = estimate
        .starts
        .get(estimate.chosen)
        .map_or("", |s| s.description.as_str());
    let initial = if estimate.initial_estimated {
        "estimated for every record"
    } else {
        "at rest"
    };
    let delay = if estimate.model.delay > 0.0 {
        format!("delay:    {:.6} s\n", estimate.model.delay)
    } else {
        String::new()
    };
    format!(
        "search:   {} iterations in {:.2} s; it ended since {}\n\
         start:    {} of {}, {start}; seed {}\n\
         state:    {initial} at the first sample\n{delay}",
        estimate.iterations.len(),
        found.seconds,
        estimate.stop,
        estimate.chosen + 1,
        estimate.starts.len(),
        estimate.seed,
    )
}
