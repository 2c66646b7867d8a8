//! All stages of a case in one run.

use crate::args::RunOptions;
use crate::case::{self, Loaded};
use crate::gathered::Gathered;
use crate::output::{Failure, print, print_json, write};
use crate::progress::Progress;
use crate::{figures, report, tables};
use albatross::analysis::{self, ModeTable, Trimmed};
use albatross::flight::TimeHistory;
use albatross::report::Table;
use albatross::{root_locus, shapes};
use serde_json::json;
use std::path::Path;

const STAGES: u64 = 9;

/// Speeds of the root locus: from and to, in parts of that of the flight point, and how many.
const LOCUS: (f64, f64, usize) = (0.6, 1.3, 13);

pub(crate) fn run(options: &RunOptions) -> Result<(), Failure> {
    let mut progress = Progress::new(STAGES, options.case.quiet);
    let Loaded { inputs, model } = progress.stage("read and build", |_| case::load(&options.case))?;
    let gathered = Gathered::beside(&options.out)?;
    let out = gathered.path();

    let modes = progress.stage("structural modes", |_| {
        let modes = analysis::structural_modes(&inputs, &model)?;
        write_table(out, "modes", &tables::modes(&modes)?)?;
        write(
            &out.join("modes.json"),
            &pretty(&case::modes_json(&model.basis, &modes))?,
        )?;
        Ok(modes)
    })?;
    progress.stage("strips", |_| {
        write(&out.join("strips.json"), &pretty(&case::strips_json(&model))?)?;
        write_table(out, "strips", &tables::strips(&model.strips)?)
    })?;
    let trimmed = progress.stage("trim and linearisation", |_| {
        let trimmed = analysis::trimmed(&model)?;
        write(
            &out.join("trim.json"),
            &pretty(&case::trim_json(&model, &trimmed.trim))?,
        )?;
        write(&out.join("state_space.json"), &pretty(&trimmed.system)?)?;
        Ok(trimmed)
    })?;
    let mode_table = progress.stage("modes in the flow", |_| {
        let table = analysis::mode_table_without_lags(&model, &trimmed)?;
        write(&out.join("modes_table.json"), &pretty(&table)?)?;
        write_table(out, "modes_elastic", &tables::aeroelastic_modes(&table)?)?;
        write_table(out, "modes_rigid_body", &tables::rigid_body_modes(&table)?)?;
        Ok(table)
    })?;
    let response = progress.stage("frequency response", |_| {
        // Without sensors there is nothing to respond.
        if inputs.case.sensors.is_empty() {
            return Ok(None);
        }
        let response = case::response(&inputs, &trimmed, None, None)?;
        write(&out.join("bode.json"), &pretty(&case::bode_json(&response)?)?)?;
        write_table(out, "bode", &case::bode_table(&response)?)?;
        let plot = figures::bode(&model.variant.name, &response)?;
        write(&out.join("bode.svg"), &plot.render()?.markup)?;
        Ok(Some(response))
    })?;
    let locus = progress.stage("root locus", |_| {
        let speeds = root_locus::speeds_around(model.point.speed, LOCUS.0, LOCUS.1, LOCUS.2);
        let locus = root_locus::root_locus(&model, &mode_table, &speeds)?;
        write(&out.join("root_locus.json"), &pretty(&locus)?)?;
        Ok(locus)
    })?;
    let histories = progress.stage("simulations", |progress| {
        simulations(out, &inputs, &analysis::trimmed_for_simulation(&model)?, progress)
    })?;
    progress.stage("report", |_| {
        let page = report::page(&report::Results {
            case_file: &options.case.case,
            inputs: &inputs,
            model: &model,
            modes: &modes,
            trimmed: &trimmed,
            mode_table: &mode_table,
            response: response.as_ref(),
            locus: &locus,
            flights: &histories,
        })?;
        write(&out.join("report.html"), &page)
    })?;
    write(
        &out.join("mode_shapes.svg"),
        &shapes::mode_shapes(&inputs, &model).render()?,
    )?;
    write(&out.join("notes.txt"), &(model.notes.join("\n") + "\n"))?;
    let files = gathered.names()?.len();
    gathered.move_to(&options.out)?;
    let done = Done {
        model: &model,
        trimmed: &trimmed,
        modes: &mode_table,
        n_modes: modes.len(),
        histories: &histories,
        files,
        seconds: progress.finish(),
    };
    if options.case.json {
        done.print_json(options)
    } else {
        done.print_text(options)
    }
}

fn simulations(
    out: &Path,
    inputs: &albatross::Inputs,
    trimmed: &Trimmed,
    progress: &Progress,
) -> Result<Vec<(String, TimeHistory)>, Failure> {
    let mut histories = Vec::new();
    for manoeuvre in &inputs.case.manoeuvres {
        progress.now(&format!("simulation of {}", manoeuvre.name));
        let history = analysis::simulate_case(inputs, trimmed, manoeuvre)?;
        write_table(out, &manoeuvre.name, &tables::history(&manoeuvre.name, &history)?)?;
        write(
            &out.join(format!("{}.svg", manoeuvre.name)),
            &figures::history(&manoeuvre.name, &history).render()?.markup,
        )?;
        histories.push((manoeuvre.name.clone(), history));
    }
    Ok(histories)
}

fn write_table(out: &Path, name: &str, table: &Table) -> Result<(), Failure> {
    write(&out.join(format!("{name}.csv")), &table.to_csv())
}

fn pretty(value: &impl serde::Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// What a run has come to.
struct Done<'a> {
    model: &'a albatross::Model,
    trimmed: &'a Trimmed,
    modes: &'a ModeTable,
    n_modes: usize,
    histories: &'a [(String, TimeHistory)],
    files: usize,
    seconds: f64,
}

impl Done<'_> {
    fn print_json(&self, options: &RunOptions) -> Result<(), Failure> {
        print_json(&json!({
            "variant": self.model.variant.name,
            "out": options.out,
            "trim": case::trim_json(self.model, &self.trimmed.trim),
            "modes": self.modes,
            "n_states": self.trimmed.system.states.len(),
            "n_strips": self.model.strips.strips.len(),
            "n_modes": self.n_modes,
            "notes": self.model.notes,
        }))
    }

    fn print_text(&self, options: &RunOptions) -> Result<(), Failure> {
        print(&tables::trim(self.model, &self.trimmed.trim)?.to_text())?;
        print("")?;
        print(&tables::rigid_body_modes(self.modes)?.to_text())?;
        print("")?;
        print(&tables::aeroelastic_modes(self.modes)?.to_text())?;
        if !self.histories.is_empty() {
            print("")?;
            print(&tables::extremes(self.histories)?.to_text())?;
        }
        for mode in self.modes.elastic.iter().filter(|m| m.re > 0.0) {
            let frequency = mode.omega_rad_s / std::f64::consts::TAU;
            print(&format!(
                "\nwarning: elastic mode {} grows, at {frequency:.2} Hz: flutter at this flight point",
                mode.mode
            ))?;
        }
        print(&format!(
            "\nVariant `{}` with {} modes, {} strips, {} states: {} files in {} after {:.1} s; {}",
            self.model.variant.name,
            self.n_modes,
            self.model.strips.strips.len(),
            self.trimmed.system.states.len(),
            self.files,
            options.out.display(),
            self.seconds,
            match self.model.notes.len() {
                0 => "nothing to note".to_owned(),
                1 => "what was assumed is in notes.txt (1 note)".to_owned(),
                n => format!("what was assumed is in notes.txt ({n} notes)"),
            }
        ))
    }
}
