//! Results as tables.

use albatross::analysis::{ModeTable, StructuralMode};
use albatross::flight::{TimeHistory, Trim};
use albatross::lti::{Mode, Response};
use albatross::modal::Symmetry;
use albatross::model::Model;
use albatross::report::{Cell, Column, Format, ReportError, Table};
use albatross::strips::StripSet;

fn symmetry(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Symmetric => "symmetric",
        Symmetry::Antisymmetric => "antisymmetric",
        Symmetry::Mixed => "mixed",
    }
}

pub(crate) fn modes(modes: &[StructuralMode]) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Structural modes",
        [
            Column::new("mode", "", Format::Fixed(0)),
            Column::new("in file", "", Format::Fixed(0)),
            Column::new("frequency", "Hz", Format::Fixed(4)),
            Column::new("frequency", "rad/s", Format::Fixed(3)),
            Column::new("modal mass", "kg m2", Format::Significant(6)),
            Column::new("damping", "-", Format::Significant(3)),
            Column::text("symmetry"),
            Column::new("rigid share", "-", Format::Scientific(1)),
            Column::text("kinetic energy"),
        ],
    );
    for mode in modes {
        table.push([
            Cell::from(mode.mode),
            Cell::from(mode.number_in_file),
            Cell::from(mode.frequency_hz),
            Cell::from(mode.omega_rad_s),
            Cell::from(mode.generalized_mass),
            Cell::from(mode.damping_ratio),
            Cell::from(symmetry(mode.symmetry)),
            Cell::from(mode.rigid_coupling),
            Cell::from(mode.description.as_str()),
        ])?;
    }
    Ok(table)
}

pub(crate) fn strips(set: &StripSet) -> Result<Table, ReportError> {
    let number = |name: &str, unit: &str, digits: u8| Column::new(name, unit, Format::Fixed(digits));
    let mut table = Table::new(
        "Strips",
        [
            Column::text("surface"),
            Column::new("strip", "", Format::Fixed(0)),
            number("y", "m", 4),
            number("z", "m", 4),
            number("x_ac", "m", 4),
            number("x_lra", "m", 4),
            number("chord", "m", 4),
            number("width", "m", 4),
            number("dihedral", "deg", 2),
            number("sweep", "deg", 2),
            number("cl_alpha, aircraft", "1/rad", 4),
            number("cl_alpha, own motion", "1/rad", 4),
            number("cl0", "-", 4),
            Column::text("axis"),
        ],
    );
    for ((record, strip), lra) in set.records.iter().zip(&set.strips).zip(&set.lra) {
        table.push([
            Cell::from(record.surface.as_str()),
            Cell::from(record.index),
            Cell::from(strip.y),
            Cell::from(strip.z),
            Cell::from(strip.x_ac),
            Cell::from(strip.x_lra),
            Cell::from(strip.chord),
            Cell::from(strip.width),
            Cell::from(record.dihedral_rad.to_degrees()),
            Cell::from(record.sweep_rad.to_degrees()),
            Cell::from(record.cl_alpha),
            Cell::from(strip.cl_alpha),
            Cell::from(record.cl0),
            Cell::from(lra.as_str()),
        ])?;
    }
    Ok(table)
}

pub(crate) fn trim(model: &Model, trim: &Trim) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Trim",
        [
            Column::text("quantity"),
            Column::new("value", "", Format::Significant(7)),
            Column::text("unit"),
        ],
    );
    let mut row = |name: &str, value: f64, unit: &str| {
        table.push([Cell::from(name), Cell::from(value), Cell::from(unit)])
    };
    row("Mach number", model.mach(), "-")?;
    row("true airspeed", trim.speed(), "m/s")?;
    row("altitude", model.point.altitude, "m")?;
    row("density", trim.density, "kg/m3")?;
    row("dynamic pressure", trim.dynamic_pressure, "Pa")?;
    row("mass", model.mass.mass, "kg")?;
    row("CG x (aft)", model.mass.cg[0], "m")?;
    row("CG z (up)", model.mass.cg[2], "m")?;
    row("alpha", trim.alpha_rad.to_degrees(), "deg")?;
    for (name, value) in model.aircraft.controls.iter().zip(&trim.controls_rad) {
        row(name, value.to_degrees(), "deg")?;
    }
    row("thrust", trim.thrust, "N")?;
    row("largest residual", trim.residual, "SI")?;
    Ok(table)
}

pub(crate) fn aeroelastic_modes(modes: &ModeTable) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Elastic modes in the flow, lag roots left out",
        [
            Column::new("mode", "", Format::Fixed(0)),
            Column::new("in vacuo", "rad/s", Format::Fixed(3)),
            Column::new("in the flow", "rad/s", Format::Fixed(3)),
            Column::new("damping", "-", Format::Fixed(4)),
            Column::new("re", "1/s", Format::Fixed(4)),
            Column::new("im", "rad/s", Format::Fixed(4)),
            Column::new("certainty", "-", Format::Fixed(3)),
        ],
    );
    for mode in &modes.elastic {
        table.push([
            Cell::from(mode.mode),
            Cell::from(mode.in_vacuo_rad_s),
            Cell::from(mode.omega_rad_s),
            Cell::from(mode.damping_ratio),
            Cell::from(mode.re),
            Cell::from(mode.im),
            Cell::from(mode.confidence),
        ])?;
    }
    Ok(table)
}

pub(crate) fn rigid_body_modes(modes: &ModeTable) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Rigid-body modes",
        [
            Column::text("mode"),
            Column::new("frequency", "rad/s", Format::Significant(5)).in_group("rigid aircraft"),
            Column::new("damping", "-", Format::Fixed(4)).in_group("rigid aircraft"),
            Column::new("frequency", "rad/s", Format::Significant(5)).in_group("flexible aircraft"),
            Column::new("damping", "-", Format::Fixed(4)).in_group("flexible aircraft"),
        ],
    );
    let of = |mode: Option<&Mode>, f: fn(&Mode) -> f64| {
        mode.map_or_else(
            || Cell::missing("not followed with certainty"),
            |m| Cell::from(f(m)),
        )
    };
    for mode in &modes.rigid_body {
        table.push([
            Cell::from(mode.name),
            of(Some(&mode.rigid), |m| m.omega_rad_s),
            of(Some(&mode.rigid), |m| m.damping_ratio),
            of(mode.flexible.as_ref(), |m| m.omega_rad_s),
            of(mode.flexible.as_ref(), |m| m.damping_ratio),
        ])?;
    }
    Ok(table)
}

pub(crate) fn bode(response: &Response) -> Result<Table, Box<dyn std::error::Error>> {
    let input = response.inputs.first().map_or("", |s| s.name.as_str());
    let mut columns = vec![Column::new("omega", "rad/s", Format::Significant(6))];
    let mut channels = Vec::new();
    for output in &response.outputs {
        columns.push(Column::new(
            format!("{} magnitude", output.name),
            "dB",
            Format::Fixed(3),
        ));
        columns.push(Column::new(
            format!("{} phase", output.name),
            "deg",
            Format::Fixed(2),
        ));
        let channel = response.get(&output.name, input)?;
        channels.push((channel.magnitude_db(), channel.phase_deg()));
    }
    let mut table = Table::new(format!("Frequency response to {input}"), columns);
    for (i, &omega) in response.omega_rad_s.iter().enumerate() {
        let cells = channels.iter().flat_map(|(magnitude, phase)| {
            [
                Cell::from(magnitude.get(i).copied()),
                Cell::from(phase.get(i).copied()),
            ]
        });
        table.push(std::iter::once(Cell::from(omega)).chain(cells))?;
    }
    Ok(table)
}

pub(crate) fn history(name: &str, history: &TimeHistory) -> Result<Table, ReportError> {
    let mut columns = vec![Column::new("t", "s", Format::Significant(9))];
    columns.extend(
        history
            .channels
            .iter()
            .map(|c| Column::new(&c.name, &c.unit, Format::Significant(9))),
    );
    let mut table = Table::new(name, columns);
    for (i, &t) in history.time.iter().enumerate() {
        let values = history.series.iter().map(|s| Cell::from(s.get(i).copied()));
        table.push(std::iter::once(Cell::from(t)).chain(values))?;
    }
    Ok(table)
}

pub(crate) fn history_summary(name: &str, history: &TimeHistory) -> Result<Table, ReportError> {
    let mut table = Table::new(
        format!(
            "Simulation of {name}: {:.3} s",
            history.time.last().copied().unwrap_or(0.0)
        ),
        [
            Column::text("channel"),
            Column::text("unit"),
            Column::new("in trim", "", Format::Significant(6)),
            Column::new("least", "", Format::Significant(6)),
            Column::new("greatest", "", Format::Significant(6)),
            Column::new("at the end", "", Format::Significant(6)),
        ],
    );
    for (channel, series) in history.channels.iter().zip(&history.series) {
        table.push([
            Cell::from(channel.name.as_str()),
            Cell::from(channel.unit.as_str()),
            Cell::from(series.first().copied()),
            Cell::from(series.iter().copied().reduce(f64::min)),
            Cell::from(series.iter().copied().reduce(f64::max)),
            Cell::from(series.last().copied()),
        ])?;
    }
    Ok(table)
}

/// Least and greatest value of what moves in each simulation.
pub(crate) fn extremes(histories: &[(String, TimeHistory)]) -> Result<Table, ReportError> {
    let mut table = Table::new(
        "Simulations",
        [
            Column::text("manoeuvre"),
            Column::text("output"),
            Column::text("unit"),
            Column::new("in trim", "", Format::Significant(5)),
            Column::new("least", "", Format::Significant(5)),
            Column::new("greatest", "", Format::Significant(5)),
        ],
    );
    for (name, history) in histories {
        for (channel, series) in history.channels.iter().zip(&history.series) {
            let fold = |f: fn(f64, f64) -> f64| series.iter().copied().reduce(f).unwrap_or(0.0);
            let (least, greatest) = (fold(f64::min), fold(f64::max));
            let moves = greatest - least;
            if moves <= 1e-9 * greatest.abs().max(least.abs()) {
                continue;
            }
            // Rounding in trim is zero beside the motion.
            let clean = |v: f64| Cell::from(if v.abs() < 1e-9 * moves { 0.0 } else { v });
            table.push([
                Cell::from(name.as_str()),
                Cell::from(channel.name.as_str()),
                Cell::from(channel.unit.as_str()),
                clean(series.first().copied().unwrap_or(0.0)),
                clean(least),
                clean(greatest),
            ])?;
        }
    }
    Ok(table)
}
