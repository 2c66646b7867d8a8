//! Records: files in, one data set out.

use super::args::{DataOptions, SamplingOptions};
use crate::output::{Failure, read_text, remark};
use albatross::lti::Signal;
use albatross::sysid::{
    Columns, DataSet, Experiment, Intersample, TrimRemoved, decimate, detect_intersample, remove_trim, table,
};
use std::path::{Path, PathBuf};

/// Records read, and what was decided on the way.
pub(crate) struct Records {
    pub(crate) data: DataSet,
    /// What was subtracted from every record.
    pub(crate) trim: Vec<TrimRemoved>,
    /// How the behaviour of the input between samples was found.
    pub(crate) decision: String,
}

/// Reads the records that the options name.
pub(crate) fn read(options: &DataOptions, quiet: bool) -> Result<Records, Failure> {
    read_files(
        &options.files,
        &options.input,
        &options.output,
        &options.sampling,
        quiet,
    )
}

pub(crate) fn read_files(
    files: &[PathBuf],
    input: &str,
    outputs: &[String],
    sampling: &SamplingOptions,
    quiet: bool,
) -> Result<Records, Failure> {
    if let Some((i, file)) = files
        .iter()
        .enumerate()
        .find(|(i, f)| files.iter().take(*i).any(|g| g == *f))
    {
        return Err(Failure::Other(format!(
            "{} is given twice (record {}): name every record once",
            file.display(),
            i + 1
        )));
    }
    if let Some((_, name)) = outputs
        .iter()
        .enumerate()
        .find(|(i, o)| outputs.iter().take(*i).any(|p| p == *o))
    {
        return Err(Failure::Other(format!(
            "the output `{name}` is given twice: name every output once"
        )));
    }
    let columns = Columns {
        time: sampling.column_time.clone(),
        sample_time: sampling.sample_time,
        input: input.to_owned(),
        outputs: outputs.to_vec(),
    };
    let mut experiments = Vec::new();
    let mut trim = Vec::new();
    let mut signals: Option<(Signal, Vec<Signal>)> = None;
    let mut reference = None;
    for file in files {
        let reference = *reference.get_or_insert(file);
        let (mut experiment, input, outputs) = read_record(file, &columns)?;
        trim.push(remove_trim(&mut experiment, sampling.detrend.into()));
        experiments.push(experiment);
        match &signals {
            None => signals = Some((input, outputs)),
            Some(first) => same_units(reference, first, file, &(input, outputs))?,
        }
    }
    let (input, outputs) = signals.ok_or_else(|| Failure::Other("no records are given".into()))?;
    let (intersample, decision) = between_samples(&experiments, sampling.intersample.fixed());
    if sampling.decimate != 1 {
        experiments = experiments
            .iter()
            .map(|e| decimate(e, sampling.decimate, intersample))
            .collect::<Result<_, _>>()?;
    }
    if !quiet {
        remark(&format!("note: {decision}"));
    }
    Ok(Records {
        data: DataSet::try_new(input, outputs, experiments, intersample)?,
        trim,
        decision,
    })
}

fn read_record(file: &Path, columns: &Columns) -> Result<(Experiment, Signal, Vec<Signal>), Failure> {
    let text = read_text(file)?;
    let table = table::parse(&text, &file.display().to_string())?;
    Ok(table.experiment(columns)?)
}

/// Records in different units would be joined silently.
fn same_units(
    first_file: &Path,
    first: &(Signal, Vec<Signal>),
    file: &Path,
    other: &(Signal, Vec<Signal>),
) -> Result<(), Failure> {
    let pairs = std::iter::once((&first.0, &other.0)).chain(first.1.iter().zip(&other.1));
    for (expected, found) in pairs {
        if expected.unit != found.unit {
            return Err(Failure::Other(format!(
                "{}: {} has the unit {}, in {} it has {}: convert one of them",
                file.display(),
                found.name,
                found.unit,
                first_file.display(),
                expected.unit
            )));
        }
    }
    Ok(())
}

/// One behaviour for all records: linear if the samples of any are so, since a held input sampled at its edges is
/// told apart by its steps.
fn between_samples(experiments: &[Experiment], fixed: Option<Intersample>) -> (Intersample, String) {
    let word = |i: Intersample| match i {
        Intersample::Zoh => "held from sample to sample (zoh)",
        Intersample::Foh => "linear from sample to sample (foh)",
    };
    if let Some(fixed) = fixed {
        return (
            fixed,
            format!("the input is taken as {}, as asked for", word(fixed)),
        );
    }
    let found: Vec<Intersample> = experiments.iter().map(|e| detect_intersample(&e.input)).collect();
    let linear = found.iter().filter(|i| **i == Intersample::Foh).count();
    let chosen = if linear > 0 {
        Intersample::Foh
    } else {
        Intersample::Zoh
    };
    let basis = if linear == 0 || linear == found.len() {
        "judged from the samples".to_owned()
    } else {
        format!(
            "judged from the samples of {linear} of {} records; the others look held: check, and choose with --intersample",
            found.len()
        )
    };
    (chosen, format!("the input is taken as {}, {basis}", word(chosen)))
}
