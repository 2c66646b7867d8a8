//! All stages of a case in one run.

use crate::args::RunOptions;
use crate::case::{self, Loaded};
use crate::output::{Failure, Gathered, print, print_json, remark, write};
use crate::{figures, report, tables};
use albatross::analysis::{self, ModeTable, Trimmed};
use albatross::flight::TimeHistory;
use albatross::report::Table;
use albatross::root_locus;
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// A progress line on standard error for each stage, with what it took.
struct Progress {
    quiet: bool,
    stage: usize,
}

const STAGES: usize = 9;

/// Speeds of the root locus: from and to, in parts of that of the flight point, and how many.
const LOCUS: (f64, f64, usize) = (0.6, 1.3, 13);

impl Progress {
    fn stage<T>(&mut self, name: &str, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        self.stage += 1;
        let start = Instant::now();
        let done = work()?;
        if !self.quiet {
            remark(&format!(
                "[{}/{STAGES}] {name:<24} {:>8.3} s",
                self.stage,
                start.elapsed().as_secs_f64()
            ));
        }
        Ok(done)
    }
}

pub(crate) fn run(options: &RunOptions) -> Result<(), Failure> {
    let mut progress = Progress {
        quiet: options.case.quiet,
        stage: 0,
    };
    let Loaded { inputs, model } = progress.stage("read and build", || case::load(&options.case))?;
    let gathered = Gathered::beside(&options.out)?;
    let out = gathered.path();

    let modes = progress.stage("structural modes", || {
        let modes = analysis::structural_modes(&inputs, &model)?;
        write_table(out, "modes", &tables::modes(&modes)?)?;
        write(
            &out.join("modes.json"),
            &pretty(&case::modes_json(&model.basis, &modes))?,
        )?;
        Ok(modes)
    })?;
    progress.stage("strips", || {
        write(&out.join("strips.json"), &pretty(&case::strips_json(&model))?)?;
        write_table(out, "strips", &tables::strips(&model.strips)?)
    })?;
    let trimmed = progress.stage("trim and linearisation", || {
        let trimmed = analysis::trimmed(&model)?;
        write(
            &out.join("trim.json"),
            &pretty(&case::trim_json(&model, &trimmed.trim))?,
        )?;
        write(&out.join("state_space.json"), &pretty(&trimmed.system)?)?;
        Ok(trimmed)
    })?;
    let mode_table = progress.stage("modes in the flow", || {
        let table = analysis::mode_table_without_lags(&model, &trimmed)?;
        write(&out.join("modes_table.json"), &pretty(&table)?)?;
        write_table(out, "modes_elastic", &tables::aeroelastic_modes(&table)?)?;
        write_table(out, "modes_rigid_body", &tables::rigid_body_modes(&table)?)?;
        Ok(table)
    })?;
    let response = progress.stage("frequency response", || {
        let response = case::response(&inputs, &trimmed, None, None)?;
        write(&out.join("bode.json"), &pretty(&case::bode_json(&response)?)?)?;
        write_table(out, "bode", &case::bode_table(&response)?)?;
        let plot = figures::bode(&model.variant.name, &response)?;
        write(&out.join("bode.svg"), &plot.render()?.markup)?;
        Ok(response)
    })?;
    let locus = progress.stage("root locus", || {
        let speeds = root_locus::speeds_around(model.point.speed, LOCUS.0, LOCUS.1, LOCUS.2);
        let locus = root_locus::root_locus(&model, &speeds)?;
        write(&out.join("root_locus.json"), &pretty(&locus)?)?;
        Ok(locus)
    })?;
    let flights = progress.stage("simulations", || {
        simulations(out, &inputs, &analysis::trimmed_for_simulation(&model)?)
    })?;
    progress.stage("report", || {
        let page = report::page(&report::Results {
            case_file: &options.case.case,
            inputs: &inputs,
            model: &model,
            modes: &modes,
            trimmed: &trimmed,
            mode_table: &mode_table,
            response: &response,
            locus: &locus,
            flights: &flights,
        })?;
        write(&out.join("report.html"), &page)
    })?;
    write(&out.join("notes.txt"), &(model.notes.join("\n") + "\n"))?;
    gathered.move_to(&options.out)?;
    summary(options, &model, &trimmed, &mode_table, modes.len())
}

fn simulations(
    out: &Path,
    inputs: &albatross::Inputs,
    trimmed: &Trimmed,
) -> Result<Vec<(String, TimeHistory)>, Failure> {
    let mut flights = Vec::new();
    for manoeuvre in &inputs.case.manoeuvres {
        let history = analysis::simulate_case(inputs, trimmed, manoeuvre)?;
        write_table(out, &manoeuvre.name, &tables::history(&manoeuvre.name, &history)?)?;
        write(
            &out.join(format!("{}.svg", manoeuvre.name)),
            &figures::history(&manoeuvre.name, &history).render()?.markup,
        )?;
        flights.push((manoeuvre.name.clone(), history));
    }
    Ok(flights)
}

fn write_table(out: &Path, name: &str, table: &Table) -> Result<(), Failure> {
    write(&out.join(format!("{name}.csv")), &table.to_csv())
}

fn pretty(value: &impl serde::Serialize) -> Result<String, Failure> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

fn summary(
    options: &RunOptions,
    model: &albatross::Model,
    trimmed: &Trimmed,
    modes: &ModeTable,
    n_modes: usize,
) -> Result<(), Failure> {
    if options.case.json {
        return print_json(&json!({
            "variant": model.variant.name,
            "out": options.out,
            "trim": case::trim_json(model, &trimmed.trim),
            "modes": modes,
            "n_states": trimmed.system.states.len(),
            "n_strips": model.strips.strips.len(),
            "n_modes": n_modes,
            "notes": model.notes,
        }));
    }
    print(&tables::trim(model, &trimmed.trim)?.to_text())?;
    print("")?;
    print(&tables::rigid_body_modes(modes)?.to_text())?;
    print("")?;
    print(&tables::aeroelastic_modes(modes)?.to_text())?;
    print(&format!(
        "\n{} modes, {} strips, {} states; results of variant `{}` are in {}",
        n_modes,
        model.strips.strips.len(),
        trimmed.system.states.len(),
        model.variant.name,
        options.out.display()
    ))
}
