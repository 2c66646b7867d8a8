//! How well a model reproduces a record: simulation, initial state, fit.

use albatross_numerics::Mat;
use serde::Serialize;

use crate::elimination::solve_triangle;
use crate::fit::nrmse_fit;
use crate::numerator::combine;
use crate::{DataSet, Experiment, Model, Result};
use albatross_numerics::solve::triangle;

/// What a record adds to the forced response of an output.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct InitialState {
    /// Coefficients of the free motions, one a pole; empty if the record starts at rest.
    pub free: Vec<f64>,
    /// Constant, in the unit of the output; zero if none was estimated.
    pub offset: f64,
}

pub(crate) fn initial_state(local: &[f64], free_initial: bool, order: usize) -> InitialState {
    let free = if free_initial { order } else { 0 };
    InitialState {
        free: local[..free.min(local.len())].to_vec(),
        offset: local.get(free).copied().unwrap_or(0.0),
    }
}

/// A record simulated by a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Simulated {
    /// Name of the record.
    pub experiment: String,
    /// Outputs, one list an output.
    #[serde(skip)]
    pub outputs: Vec<Vec<f64>>,
    /// NRMSE fit \[%\] of each output (Eq. 13 of the method); none for a constant one.
    pub fits: Vec<Option<f64>>,
    /// Initial state and constant of each output.
    pub initial: Vec<InitialState>,
}

/// Simulates all records; with `estimate_initial` the initial state is fitted to each of them, as it is for records used
/// in the estimation. Constants are estimated where the record asks for them.
///
/// # Errors
/// [`crate::Error::Lti`] when a pole overflows within one sample time, [`crate::Error::Mismatch`] when the model has
/// another number of outputs; those of [`DataSet::check`] and [`Model::simulate`].
pub fn simulate_records(model: &Model, data: &DataSet, estimate_initial: bool) -> Result<Vec<Simulated>> {
    data.check()?;
    if model.outputs.len() != data.outputs.len() {
        return Err(crate::data::mismatch(
            "outputs of the data",
            data.outputs.len(),
            model.outputs.len(),
        ));
    }
    data.experiments
        .iter()
        .map(|experiment| simulate_record(model, data, experiment, estimate_initial))
        .collect()
}

fn simulate_record(
    model: &Model,
    data: &DataSet,
    experiment: &Experiment,
    estimate_initial: bool,
) -> Result<Simulated> {
    let mut outputs = model.simulate(&experiment.input, experiment.dt, data.intersample)?;
    let mut columns = if estimate_initial {
        model.free_motions(experiment)?
    } else {
        Vec::new()
    };
    if experiment.estimate_offset {
        columns.push(vec![1.0; experiment.len()]);
    }
    let mut initial = Vec::with_capacity(outputs.len());
    for (simulated, measured) in outputs.iter_mut().zip(&experiment.outputs) {
        let mut local = Vec::new();
        if !columns.is_empty() {
            let n = columns.len();
            let all = Mat::from_fn(experiment.len(), n + 1, |i, j| match columns.get(j) {
                Some(column) => column[i],
                None => measured[i] - simulated[i],
            });
            let r = triangle(all);
            let rows = n.min(r.nrows());
            let right: Vec<f64> = (0..rows).map(|i| r[(i, n)]).collect();
            local = solve_triangle(r.submatrix(0, 0, rows, n), &right)?;
            let added = combine(&columns, |j| local[j]);
            simulated.iter_mut().zip(added).for_each(|(y, a)| *y += a);
        }
        initial.push(initial_state(&local, estimate_initial, model.order()));
    }
    let fits = outputs
        .iter()
        .zip(&experiment.outputs)
        .map(|(model, measured)| nrmse_fit(measured, model))
        .collect();
    Ok(Simulated {
        experiment: experiment.name.clone(),
        outputs,
        fits,
        initial,
    })
}
