//! The stages of a case, one command each.

use crate::args::{BodeOptions, CaseOptions, ModesOptions, SimulateOptions};
use crate::output::{Failure, make_directory, print, print_json, remark, write};
use crate::tables;
use albatross::analysis::{self, Trimmed};
use albatross::flight::{TimeHistory, Trim};
use albatross::lti::Response;
use albatross::modal::{BasisOptions, ModalBasis, OnViolation, Selection};
use albatross::nastran::Deck;
use albatross::{Inputs, Model, shapes};
use serde_json::{Value, json};
use std::path::Path;

/// A case read and its model built.
pub(crate) struct Loaded {
    pub(crate) inputs: Inputs,
    pub(crate) model: Model,
}

pub(crate) fn load(options: &CaseOptions) -> Result<Loaded, Failure> {
    let inputs = Inputs::read(&options.case)?;
    let variant = inputs.case.variant(options.variant.as_deref())?;
    let model = Model::build(&inputs, &variant)?;
    Ok(Loaded { inputs, model })
}

pub(crate) fn load_with_notes(options: &CaseOptions) -> Result<Loaded, Failure> {
    let loaded = load(options)?;
    if !options.quiet {
        for note in &loaded.model.notes {
            remark(&format!("note: {note}"));
        }
    }
    Ok(loaded)
}

pub(crate) fn modes(options: &ModesOptions) -> Result<(), Failure> {
    let Modes { deck, basis, rows } = match (&options.case, &options.deck, &options.results) {
        (Some(case), None, None) => modes_of_case(case)?,
        (None, Some(deck), Some(results)) => modes_of_files(deck, results, options.modes)?,
        _ => {
            return Err(Failure::Usage(
                "give a case file, or --deck together with --results".into(),
            ));
        }
    };
    if !options.quiet {
        for note in &basis.notes {
            remark(&format!("note: {note}"));
        }
    }
    if let Some(file) = &options.svg {
        if let Some(directory) = file.parent() {
            make_directory(directory)?;
        }
        write(file, &shapes::of_structure(&deck, &basis).render()?)?;
    }
    if options.json {
        print_json(&modes_json(&basis, &rows))
    } else {
        print(&tables::modes(&rows)?.to_text())
    }
}

/// A basis, the deck that it is of, and what is said of each mode.
struct Modes {
    deck: Deck,
    basis: ModalBasis,
    rows: Vec<analysis::StructuralMode>,
}

fn modes_of_case(case: &Path) -> Result<Modes, Failure> {
    let inputs = Inputs::read(case)?;
    let basis = inputs.basis()?;
    let rows = analysis::modes_of_basis(&basis, &inputs.damping(basis.modes.len())?, &inputs.components()?);
    Ok(Modes {
        deck: inputs.deck,
        basis,
        rows,
    })
}

/// Modes of a deck and its results alone, without damping; elastic ones, all or as many as asked for.
fn modes_of_files(deck: &Path, results: &Path, how_many: Option<usize>) -> Result<Modes, Failure> {
    let (deck, _) = albatross::nastran::bdf::read_strict(deck).map_err(albatross::Error::from)?;
    let results = albatross::inputs::read_results(results)?;
    let choice = BasisOptions {
        modes: how_many.map_or(Selection::All, Selection::FirstElastic),
        on_violation: OnViolation::Accept,
        ..BasisOptions::default()
    };
    let basis = ModalBasis::from_nastran(&deck, &results, &choice).map_err(albatross::Error::from)?;
    let rows = analysis::modes_of_basis(&basis, &[], &[]);
    Ok(Modes { deck, basis, rows })
}

pub(crate) fn modes_json(basis: &ModalBasis, modes: &[analysis::StructuralMode]) -> Value {
    json!({
        "mass": basis.mass.as_ref().map(|m| m.mass),
        "cg": basis.mass.as_ref().map(|m| m.cg),
        "inertia": basis.mass.as_ref().map(|m| m.inertia),
        "mean_axes": basis.mean_axes_summary(),
        "modes": modes,
    })
}

pub(crate) fn strips(options: &CaseOptions) -> Result<(), Failure> {
    let Loaded { model, .. } = load_with_notes(options)?;
    if options.json {
        print_json(&strips_json(&model))
    } else {
        print(&tables::strips(&model.strips)?.to_text())
    }
}

pub(crate) fn strips_json(model: &Model) -> Value {
    let set = &model.strips;
    let rows: Vec<Value> = set
        .records
        .iter()
        .zip(&set.strips)
        .zip(&set.lra)
        .map(|((record, strip), lra)| json!({ "record": record, "strip": strip, "lra": lra }))
        .collect();
    json!({ "strips": rows, "notes": set.notes })
}

pub(crate) fn trim(options: &CaseOptions) -> Result<(), Failure> {
    let Loaded { model, .. } = load_with_notes(options)?;
    let (_, trim) = model.trim()?;
    if options.json {
        print_json(&trim_json(&model, &trim))
    } else {
        print(&tables::trim(&model, &trim)?.to_text())
    }
}

pub(crate) fn trim_json(model: &Model, trim: &Trim) -> Value {
    let controls: serde_json::Map<String, Value> = model
        .aircraft
        .controls
        .iter()
        .cloned()
        .zip(trim.controls_rad.iter().map(|c| json!(c.to_degrees())))
        .collect();
    json!({
        "variant": model.variant.name,
        "mach": model.mach(),
        "speed": trim.speed(),
        "altitude": model.point.altitude,
        "density": trim.density,
        "dynamic_pressure": trim.dynamic_pressure,
        "mass": model.mass.mass,
        "cg": model.mass.cg,
        "alpha_deg": trim.alpha_rad.to_degrees(),
        "alpha_rad": trim.alpha_rad,
        "controls_deg": controls,
        "thrust": trim.thrust,
        "eta": trim.eta,
        "residual": trim.residual,
        "iterations": trim.iterations,
    })
}

pub(crate) fn linearize(options: &CaseOptions) -> Result<(), Failure> {
    let Loaded { model, .. } = load_with_notes(options)?;
    let system = analysis::trimmed(&model)?.system;
    if options.json {
        return print_json(&system);
    }
    let names = |signals: &[albatross::lti::Signal]| {
        signals
            .iter()
            .map(|s| format!("{} [{}]", s.name, s.unit))
            .collect::<Vec<_>>()
            .join(", ")
    };
    print(&format!(
        "State space of variant `{}`: {} states, {} inputs, {} outputs; --json prints A, B, C, D.\n\
         states:  {}\ninputs:  {}\noutputs: {}\n",
        model.variant.name,
        system.states.len(),
        system.inputs.len(),
        system.outputs.len(),
        names(&system.states),
        names(&system.inputs),
        names(&system.outputs),
    ))
}

pub(crate) fn modes_table(options: &CaseOptions) -> Result<(), Failure> {
    let Loaded { model, .. } = load_with_notes(options)?;
    let table = analysis::mode_table_without_lags(&model, &analysis::trimmed(&model)?)?;
    if options.json {
        return print_json(&table);
    }
    print(&tables::rigid_body_modes(&table)?.to_text())?;
    print("")?;
    print(&tables::aeroelastic_modes(&table)?.to_text())
}

pub(crate) fn bode(options: &BodeOptions) -> Result<(), Failure> {
    let Loaded { inputs, model } = load_with_notes(&options.case)?;
    if inputs.case.sensors.is_empty() {
        return Err(without("frequency response", "[[sensor]]").into());
    }
    let trimmed = analysis::trimmed(&model)?;
    let response = response(
        &inputs,
        &trimmed,
        options.input.as_deref(),
        options.omega.as_deref(),
    )?;
    if options.case.json {
        print_json(&bode_json(&response)?)
    } else {
        print(&bode_table(&response)?.to_text())
    }
}

/// An analysis of what the case does not have.
fn without(what: &str, table: &str) -> albatross::Error {
    albatross::Error::Mismatch {
        what: what.to_owned(),
        found: format!("no {table} in the case"),
        expected: format!("one at least: add a {table}"),
    }
}

pub(crate) fn response(
    inputs: &Inputs,
    trimmed: &Trimmed,
    input: Option<&str>,
    omega: Option<&[f64]>,
) -> Result<Response, Failure> {
    let input = input.unwrap_or(&inputs.case.flight.trim_control);
    let omega = omega.map_or_else(|| inputs.case.bode.frequencies(), <[f64]>::to_vec);
    Ok(analysis::frequency_response(trimmed, input, &omega)?)
}

pub(crate) fn bode_table(response: &Response) -> Result<albatross::report::Table, Failure> {
    Ok(tables::bode(response)?)
}

pub(crate) fn bode_json(response: &Response) -> Result<Value, Failure> {
    let input = response.inputs.first().map_or("", |s| s.name.as_str());
    let mut outputs = serde_json::Map::new();
    for output in &response.outputs {
        let channel = response.get(&output.name, input)?;
        outputs.insert(
            output.name.clone(),
            json!({
                "unit": output.unit,
                "re": channel.values.iter().map(|h| h.re).collect::<Vec<_>>(),
                "im": channel.values.iter().map(|h| h.im).collect::<Vec<_>>(),
                "magnitude_db": channel.magnitude_db(),
                "phase_deg": channel.phase_deg(),
            }),
        );
    }
    Ok(json!({ "input": input, "omega_rad_s": response.omega_rad_s, "outputs": outputs }))
}

pub(crate) fn simulate(options: &SimulateOptions) -> Result<(), Failure> {
    let Loaded { inputs, model } = load_with_notes(&options.case)?;
    let trimmed = analysis::trimmed_for_simulation(&model)?;
    let case = match &options.manoeuvre {
        Some(name) => inputs.case.manoeuvre(name)?,
        None => inputs
            .case
            .manoeuvres
            .first()
            .ok_or_else(|| without("simulation", "[[manoeuvre]]"))?,
    };
    let history = analysis::simulate_case(&inputs, &trimmed, case)?;
    if let Some(path) = &options.csv {
        write(path, &tables::history(&case.name, &history)?.to_csv())?;
    }
    if options.case.json {
        print_json(&history_json(&case.name, &history))
    } else {
        print(&tables::history_summary(&case.name, &history)?.to_text())
    }
}

pub(crate) fn history_json(name: &str, history: &TimeHistory) -> Value {
    let channels: Vec<Value> = history
        .channels
        .iter()
        .zip(&history.series)
        .map(|(c, series)| json!({ "name": c.name, "unit": c.unit, "values": series }))
        .collect();
    json!({ "manoeuvre": name, "t": history.time, "channels": channels, "evaluations": history.evaluations })
}
