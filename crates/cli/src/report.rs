//! The report of a run: what goes into it, and in which order.

use crate::output::{Failure, read_text};
use crate::{figures, tables};
use albatross::analysis::{ModeTable, StructuralMode, Trimmed};
use albatross::case::ThrustLine;
use albatross::flight::TimeHistory;
use albatross::lti::Response;
use albatross::report::html::{HtmlReport, Section};
use albatross::report::{Cell, Column, Format, ReportError, Table};
use albatross::root_locus::RootLocus;
use albatross::shapes::mode_shapes;
use albatross::{Inputs, Model};
use serde::Serialize;
use std::path::Path;

/// What a run has computed.
pub(crate) struct Results<'a> {
    pub(crate) case_file: &'a Path,
    pub(crate) inputs: &'a Inputs,
    pub(crate) model: &'a Model,
    pub(crate) modes: &'a [StructuralMode],
    pub(crate) trimmed: &'a Trimmed,
    pub(crate) mode_table: &'a ModeTable,
    /// None without sensors.
    pub(crate) response: Option<&'a Response>,
    pub(crate) locus: &'a RootLocus,
    pub(crate) flights: &'a [(String, TimeHistory)],
}

/// The report as one HTML file.
pub(crate) fn page(results: &Results<'_>) -> Result<String, Failure> {
    let variant = &results.model.variant;
    let subtitle = match variant.description.as_str() {
        "" => format!("variant {}", variant.name),
        description => format!("variant {}: {description}", variant.name),
    };
    let mut report = HtmlReport::new(&results.inputs.case.title, subtitle);
    report
        .push(summary(results))
        .push(trim(results)?)
        .push(structure(results)?)
        .push(flow(results)?)
        .push(locus(results)?)
        .push(response(results)?)
        .push(simulations(results)?)
        .push(strips(results)?)
        .push(settings(results)?)
        .push(provenance(results)?);
    Ok(report.render())
}

fn summary(results: &Results<'_>) -> Section {
    let (model, trim) = (results.model, &results.trimmed.trim);
    let control = &model.point.control;
    let deflection = model
        .aircraft
        .controls
        .iter()
        .zip(&trim.controls_rad)
        .find(|(name, _)| *name == control)
        .map_or(0.0, |(_, value)| value.to_degrees());
    let shown = |value: f64, digits: u8, unit: &str| format!("{} {unit}", Format::Fixed(digits).show(value));
    let mut section = Section::new("Summary");
    section.facts([
        ("Mach number", Format::Fixed(3).show(model.mach())),
        ("True airspeed", shown(trim.speed(), 1, "m/s")),
        ("Altitude", shown(model.point.altitude, 0, "m")),
        ("Mass", shown(model.mass.mass, 0, "kg")),
        ("Incidence in trim", shown(trim.alpha_rad.to_degrees(), 3, "deg")),
        (&format!("{control} in trim"), shown(deflection, 3, "deg")),
        ("Thrust", shown(1e-3 * trim.thrust, 2, "kN")),
        ("Elastic modes", model.basis.modes.len().to_string()),
        ("Strips", model.strips.strips.len().to_string()),
        ("States", results.trimmed.system.states.len().to_string()),
    ]);
    section.paragraph(&stability(results));
    section.heading("Warnings and notes");
    let notes = model.notes.iter().chain(&results.locus.notes);
    let notes: Vec<&str> = notes.map(String::as_str).collect();
    if notes.is_empty() {
        section.paragraph("None.");
    }
    section.list(notes);
    section
}

/// What is unstable at the flight point, and the least damped elastic mode.
fn stability(results: &Results<'_>) -> String {
    let rigid = results.mode_table.rigid_body.iter().filter_map(|m| {
        let flexible = m.flexible.as_ref()?;
        (flexible.re > 0.0).then(|| m.name.to_owned())
    });
    let elastic = &results.mode_table.elastic;
    let unstable: Vec<String> = rigid
        .chain(
            elastic
                .iter()
                .filter(|m| m.re > 0.0)
                .map(|m| format!("elastic mode {}", m.mode)),
        )
        .collect();
    let first = if unstable.is_empty() {
        "All modes that could be followed decay at the flight point.".to_owned()
    } else {
        format!("Unstable at the flight point: {}.", unstable.join(", "))
    };
    let least = elastic
        .iter()
        .min_by(|a, b| a.damping_ratio.total_cmp(&b.damping_ratio));
    match least {
        Some(mode) => format!(
            "{first} Least damped of the elastic modes: mode {}, damping ratio {:.4} at {:.2} rad/s.",
            mode.mode, mode.damping_ratio, mode.omega_rad_s
        ),
        None => first,
    }
}

fn trim(results: &Results<'_>) -> Result<Section, ReportError> {
    let mut section = Section::new("Trim");
    section.table(&tables::trim(results.model, &results.trimmed.trim)?);
    Ok(section)
}

fn structure(results: &Results<'_>) -> Result<Section, ReportError> {
    let mut section = Section::new("Structure");
    section
        .shapes(
            &mode_shapes(results.inputs, results.model),
            "Elements of the deck, and strips as the strip theory moves them: chords stay straight, surfaces that take no \
             part stand still. Grey: at rest. All shapes are drawn with the same greatest displacement.",
        )?
        .table(&tables::modes(results.modes)?)
        .paragraph(&results.model.basis.mean_axes_summary());
    Ok(section)
}

fn flow(results: &Results<'_>) -> Result<Section, ReportError> {
    let mut section = Section::new("Modes in the flow");
    section
        .table(&tables::rigid_body_modes(results.mode_table)?)
        .table(&tables::aeroelastic_modes(results.mode_table)?)
        .figure(
            &figures::poles(results.mode_table),
            "Modes at the flight point without lag roots; numbers are those of the elastic modes. Dashed: constant damping \
             ratio.",
        )?;
    Ok(section)
}

fn locus(results: &Results<'_>) -> Result<Section, ReportError> {
    let (locus, modes, speed) = (results.locus, results.mode_table, results.model.point.speed);
    let mut section = Section::new("Root locus");
    section.paragraph(
        "Eigenvalues of the linearised aircraft, trimmed anew at each speed. Only the speed changes: altitude, mass and the \
         aerodynamic data of the flight point's Mach number are kept, so far from it the locus shows a tendency.",
    );
    section.figure(
        &figures::locus(locus, modes, speed),
        "Upper half of the complex plane: the modes followed from the flight point, where elastic modes carry their number, \
         down to the lowest and up to the highest speed. Grey: all eigenvalues at these speeds, lag roots included. Dashed: \
         constant damping ratio.",
    )?;
    if let Some(plot) = figures::locus_of_rigid_body(locus, speed) {
        section.figure(&plot, "The oscillatory rigid-body modes alone.")?;
    }
    section.figure(
        &figures::frequency_and_damping(locus, modes, speed),
        "The same modes over speed. Damping ratios above 0.25 are left out; points too near for a label each share one.",
    )?;
    Ok(section)
}

fn response(results: &Results<'_>) -> Result<Section, Failure> {
    let mut section = Section::new("Frequency response");
    let Some(of_sensors) = results.response else {
        section.paragraph("The case has no sensor.");
        return Ok(section);
    };
    let plot = figures::bode(&results.model.variant.name, of_sensors)?;
    section
        .figure(&plot, "Of the linearised aircraft, lags eliminated exactly.")?
        .folded_table(&tables::bode(of_sensors)?);
    Ok(section)
}

fn simulations(results: &Results<'_>) -> Result<Section, ReportError> {
    let mut section = Section::new("Simulations");
    if results.flights.is_empty() {
        section.paragraph("The case has no manoeuvre.");
    }
    for (name, history) in results.flights {
        let summary = tables::history_summary(name, history)?
            .with_caption(format!("All samples are in {name}.csv beside this report."));
        section
            .heading(name)
            .figure(
                &figures::history(name, history).without_heading(),
                "Non-linear simulation from trim; what does not move is not drawn.",
            )?
            .folded_table(&summary);
    }
    Ok(section)
}

fn strips(results: &Results<'_>) -> Result<Section, ReportError> {
    let mut section = Section::new("Strips");
    section.folded_table(&tables::strips(&results.model.strips)?);
    Ok(section)
}

fn settings(results: &Results<'_>) -> Result<Section, Failure> {
    let (case, model) = (&results.inputs.case, results.model);
    let mut table = Table::new(
        "As this run took them",
        [Column::text("setting"), Column::text("value")],
    );
    let thrust = match model.variant.thrust_line {
        ThrustLine::ThroughCg => "through the centre of gravity",
        ThrustLine::Engines => "of the engines",
    };
    for (name, value) in [
        ("variant", model.variant.name.clone()),
        ("fidelity", word(&model.options.fidelity)?),
        ("control aerodynamics", word(&model.options.control_aerodynamics)?),
        ("shape reference", word(&model.options.shape_reference)?),
        ("attitude of simulations", word(&model.options.attitude)?),
        (
            "corrections",
            if model.variant.corrections { "yes" } else { "no" }.into(),
        ),
        ("thrust line", thrust.into()),
        ("downwash point", word(&case.aerodynamics.downwash_point)?),
        ("split of the circulatory lift", word(&case.aerodynamics.split)?),
        ("dihedral", word(&case.aerodynamics.dihedral)?),
        (
            "apparent mass factor",
            case.aerodynamics.apparent_mass_factor.to_string(),
        ),
        ("damping ratios of the structure", damping(&model.damping)),
        ("gravity [m/s2]", case.flight.gravity.to_string()),
    ] {
        table.push([Cell::from(name), Cell::from(value)])?;
    }
    let mut section = Section::new("Settings");
    section
        .table(&table)
        .code("The case file", &read_text(results.case_file)?);
    Ok(section)
}

/// A choice as it is written in a case file.
fn word(choice: &impl Serialize) -> Result<String, Failure> {
    Ok(match serde_json::to_value(choice)? {
        serde_json::Value::String(word) => word,
        other => other.to_string(),
    })
}

/// One ratio if all modes share it.
fn damping(ratios: &[f64]) -> String {
    match ratios {
        [first, rest @ ..] if rest.iter().all(|r| r == first) => format!("{first}, all modes"),
        ratios => ratios.iter().map(f64::to_string).collect::<Vec<_>>().join(", "),
    }
}

fn provenance(results: &Results<'_>) -> Result<Section, Failure> {
    let mut table = Table::new(
        "Files read",
        [
            Column::text("file"),
            Column::text("what"),
            Column::new("size", "bytes", Format::Exact),
            Column::text("written by"),
            Column::text("SHA-256"),
        ],
    )
    .with_caption("Paths are relative to the case file.");
    for source in results.inputs.sources(results.case_file)? {
        table.push([
            Cell::from(source.path),
            Cell::from(source.role),
            Cell::from(source.bytes),
            Cell::from(source.written_by),
            Cell::from(source.sha256),
        ])?;
    }
    let mut section = Section::new("Provenance");
    section.table(&table).paragraph(&format!(
        "Made by albatross {} from {}.",
        env!("CARGO_PKG_VERSION"),
        results.case_file.display()
    ));
    if let Some(corrections) = &results.inputs.case.corrections {
        section.paragraph(&format!("Corrections of the case: {}.", corrections.provenance));
    }
    Ok(section)
}
