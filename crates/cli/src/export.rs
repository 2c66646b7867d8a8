//! Results of a case in the formats of other programs, chosen by the ending of the file.

use crate::args::ExportOptions;
use crate::case::{self, Loaded};
use crate::output::{Failure, print, print_json, remark, write_bytes};
use crate::tables;
use albatross::analysis::{self, Trimmed};
use albatross::export::{self, Mesh, OperatingPoint, Record, Transfer};
use albatross::flight::TimeHistory;
use serde_json::json;
use std::path::Path;

/// A format by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Mat,
    Npz,
    Json,
    Csv,
    Parquet,
    Vtu,
}

/// What is exported, but for mode shapes, which have a format of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject<'a> {
    LinearModel,
    Transfer { input: &'a str, output: &'a str },
    Manoeuvre(&'a str),
}

impl<'a> Subject<'a> {
    fn of(options: &'a ExportOptions) -> Self {
        match (options.transfer.as_slice(), &options.manoeuvre) {
            ([input, output], _) => Self::Transfer { input, output },
            (_, Some(name)) => Self::Manoeuvre(name),
            _ => Self::LinearModel,
        }
    }
}

/// The subject, computed once for all files.
enum Outcome {
    LinearModel(Box<Trimmed>),
    Transfer(Transfer),
    Manoeuvre(String, TimeHistory),
    ModeShapes(Mesh),
}

pub(crate) fn export(options: &ExportOptions) -> Result<(), Failure> {
    // Before anything is read or computed.
    let subject = Subject::of(options);
    let formats = options
        .to
        .iter()
        .map(|path| allowed(path, subject))
        .collect::<Result<Vec<_>, _>>()?;
    if !(options.cancel.is_finite() && options.cancel >= 0.0) {
        return Err(Failure::Other(format!(
            "--cancel {}: expected a part of the modulus, 1e-6 say",
            options.cancel
        )));
    }
    let loaded = case::load_with_notes(&options.case)?;
    let has = |wanted: bool| formats.iter().any(|f| (*f == Format::Vtu) == wanted);
    let main = has(false)
        .then(|| compute(subject, options.cancel, &loaded))
        .transpose()?;
    let shapes = has(true).then(|| mode_shapes(&loaded)).transpose()?;
    let outcome_of = |format: Format| if format == Format::Vtu { &shapes } else { &main };
    // Nothing is written before all can be.
    let mut files = Vec::new();
    for (path, format) in options.to.iter().zip(&formats) {
        if let Some(outcome) = outcome_of(*format) {
            files.push((path, bytes(*format, outcome)?, description(outcome)));
        }
    }
    for (path, bytes, _) in &files {
        write_bytes(path, bytes)?;
    }
    let notes: Vec<String> = [&main, &shapes].into_iter().flatten().flat_map(notes).collect();
    if options.case.json {
        let list = files
            .iter()
            .map(|(path, _, what)| json!({ "file": path, "content": what }));
        return print_json(&json!({ "files": list.collect::<Vec<_>>(), "notes": notes }));
    }
    for (path, _, what) in &files {
        print(&format!("{}: {what}", path.display()))?;
    }
    if !options.case.quiet {
        notes.iter().for_each(|note| remark(&format!("note: {note}")));
    }
    Ok(())
}

/// The format of a file, if it can hold the subject.
fn allowed(path: &Path, subject: Subject<'_>) -> Result<Format, Failure> {
    let format = format_of(path)?;
    let problem = match (format, subject) {
        (Format::Parquet, Subject::Manoeuvre(_)) if !cfg!(feature = "parquet") => {
            "this program was built without Parquet; build it with `--features parquet`, or write .csv"
        }
        (Format::Parquet, Subject::LinearModel | Subject::Transfer { .. }) => {
            "Parquet holds time histories; add `--manoeuvre NAME`, or write .mat, .npz or .json"
        }
        (Format::Csv, Subject::Transfer { .. }) => {
            "a transfer function is no table; write .json, .mat or .npz"
        }
        _ => return Ok(format),
    };
    Err(refusal(path, problem))
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    match ending.as_str() {
        "mat" => Ok(Format::Mat),
        "npz" => Ok(Format::Npz),
        "json" => Ok(Format::Json),
        "csv" => Ok(Format::Csv),
        "parquet" => Ok(Format::Parquet),
        "vtu" => Ok(Format::Vtu),
        _ => Err(refusal(
            path,
            "the ending says no format: expected .mat, .npz, .json, .csv, .parquet or .vtu",
        )),
    }
}

fn refusal(path: &Path, why: &str) -> Failure {
    Failure::Other(format!("{}: {why}", path.display()))
}

fn compute(subject: Subject<'_>, cancel: f64, loaded: &Loaded) -> Result<Outcome, Failure> {
    let Loaded { inputs, model } = loaded;
    Ok(match subject {
        Subject::LinearModel => Outcome::LinearModel(Box::new(analysis::trimmed(model)?)),
        Subject::Transfer { input, output } => {
            let system = analysis::trimmed(model)?.system;
            Outcome::Transfer(Transfer::of_system(&system, input, output, cancel)?)
        }
        Subject::Manoeuvre(name) => {
            let case = inputs.case.manoeuvre(name)?;
            let trimmed = analysis::trimmed_for_simulation(model)?;
            let history = analysis::simulate_case(inputs, &trimmed, case)?;
            Outcome::Manoeuvre(name.to_owned(), history)
        }
    })
}

fn mode_shapes(loaded: &Loaded) -> Result<Outcome, Failure> {
    let Loaded { inputs, model } = loaded;
    let mut mesh = Mesh::of_structure(&model.basis, &inputs.deck);
    let strips = &model.strips;
    mesh.add_strips(&strips.records, &strips.strips, &strips.shapes)?;
    Ok(Outcome::ModeShapes(mesh))
}

fn description(outcome: &Outcome) -> String {
    match outcome {
        Outcome::LinearModel(trimmed) => format!(
            "linear model, {} states, {} inputs, {} outputs",
            trimmed.system.states.len(),
            trimmed.system.inputs.len(),
            trimmed.system.outputs.len()
        ),
        Outcome::Transfer(transfer) => format!(
            "{} to {}, {} poles, {} zeros",
            transfer.input.name,
            transfer.output.name,
            transfer.zpk.poles.len(),
            transfer.zpk.zeros.len()
        ),
        Outcome::Manoeuvre(name, history) => format!(
            "{name}, {} samples of {} channels",
            history.time.len(),
            history.channels.len()
        ),
        Outcome::ModeShapes(mesh) => format!(
            "{} modes on {} points and {} cells",
            mesh.modes.len(),
            mesh.points.len(),
            mesh.cells.len()
        ),
    }
}

fn bytes(format: Format, outcome: &Outcome) -> Result<Vec<u8>, Failure> {
    match outcome {
        Outcome::LinearModel(trimmed) => linear_model(format, trimmed),
        Outcome::Transfer(transfer) => match format {
            Format::Json => pretty(transfer),
            _ => binary(format, &transfer.record()),
        },
        Outcome::Manoeuvre(name, history) => time_history(format, name, history),
        Outcome::ModeShapes(mesh) => Ok(export::vtu::write(mesh).into_bytes()),
    }
}

fn linear_model(format: Format, trimmed: &Trimmed) -> Result<Vec<u8>, Failure> {
    let system = &trimmed.system;
    match format {
        Format::Json => pretty(system),
        Format::Csv => Ok(export::state_space_table(system)?.into_bytes()),
        _ => {
            let about = OperatingPoint::of_trim(&trimmed.equations, &trimmed.trim)?;
            binary(format, &export::state_space(system, Some(&about))?)
        }
    }
}

fn time_history(format: Format, name: &str, history: &TimeHistory) -> Result<Vec<u8>, Failure> {
    match format {
        Format::Json => pretty(&case::history_json(name, history)),
        Format::Csv => Ok(tables::history(name, history)?.to_csv().into_bytes()),
        #[cfg(feature = "parquet")]
        Format::Parquet => Ok(export::parquet::write(history)?),
        _ => binary(format, &export::history(history)?),
    }
}

fn binary(format: Format, record: &Record) -> Result<Vec<u8>, Failure> {
    Ok(match format {
        Format::Npz => export::npz::write(record)?,
        _ => export::mat::write(record)?,
    })
}

fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    Ok((serde_json::to_string_pretty(value)? + "\n").into_bytes())
}

fn notes(outcome: &Outcome) -> Vec<String> {
    match outcome {
        Outcome::Transfer(transfer) => note_on_polynomials(transfer).into_iter().collect(),
        Outcome::ModeShapes(mesh) => mesh.notes.clone(),
        Outcome::LinearModel(_) | Outcome::Manoeuvre(..) => Vec::new(),
    }
}

/// Polynomials that have lost more than half of their digits are not to be trusted unseen.
fn note_on_polynomials(transfer: &Transfer) -> Option<String> {
    const HALF_OF_THE_DIGITS: f64 = 1e-8;
    let order = transfer.zpk.poles.len();
    match transfer.transfer_function_error {
        None => Some(format!(
            "numerator and denominator of order {order} leave the range of numbers and are left out; use zeros, poles \
             and gain"
        )),
        Some(error) if error > HALF_OF_THE_DIGITS => Some(format!(
            "numerator and denominator of order {order} are off by {error:.1e}; use zeros, poles and gain"
        )),
        Some(_) => None,
    }
}
