//! Models as files: an identified model, or a state space.

use crate::output::Failure;
use albatross::linear::{self, LinearModel};
use albatross::lti::{self, FrequencySolver, Method, Signal, StateSpace};
use albatross::numerics::{C64, eigen};
use albatross::sysid::estimate::InitialCondition;
use albatross::sysid::{DataSet, Model, Simulated, nrmse_fit, simulate_records};
use std::path::Path;

/// A linear model read from a file.
pub(crate) struct System {
    /// File, for messages.
    pub(crate) name: String,
    pub(crate) form: Form,
    /// Whether its records began at an unknown state, if the file says so.
    pub(crate) initial: Option<InitialCondition>,
}

pub(crate) enum Form {
    Identified(Model),
    StateSpace(StateSpace),
}

/// A pole of a channel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenPole {
    pub(crate) value: C64,
    /// Share of the mode in the response at its own frequency, the largest of all outputs.
    pub(crate) share: f64,
}

impl System {
    /// Reads `model.json` or the result of `identify --json`, `state_space.json` or the result of `linearize --json`.
    pub(crate) fn read(file: &Path) -> Result<Self, Failure> {
        let name = file.display().to_string();
        let text = crate::output::read_text(file)?;
        let linear::LinearFile { model, initial } = linear::parse(&text, &name)?;
        let form = match model {
            LinearModel::Identified(model) => Form::Identified(model),
            LinearModel::StateSpace(system) => Form::StateSpace(system),
        };
        Ok(Self { name, form, initial })
    }

    pub(crate) fn inputs(&self) -> &[Signal] {
        match &self.form {
            Form::Identified(model) => std::slice::from_ref(&model.input),
            Form::StateSpace(system) => &system.inputs,
        }
    }

    pub(crate) fn outputs(&self) -> &[Signal] {
        match &self.form {
            Form::Identified(model) => &model.outputs,
            Form::StateSpace(system) => &system.outputs,
        }
    }

    /// The name asked for, or that of the only input.
    pub(crate) fn input_name(&self, asked: Option<&str>) -> Result<String, Failure> {
        match (asked, self.inputs()) {
            (Some(name), _) => Ok(name.to_owned()),
            (None, [only]) => Ok(only.name.clone()),
            (None, several) => Err(Failure::Other(format!(
                "{} has the inputs {}: choose one with --input",
                self.name,
                names(several)
            ))),
        }
    }

    /// This model with one input and the outputs named, in that order.
    pub(crate) fn select(&self, input: &str, outputs: &[String]) -> Result<Self, Failure> {
        let unknown = |kind, asked: &str, known: &[Signal]| {
            Failure::Albatross(albatross::Error::UnknownName {
                kind,
                name: format!("{asked}` in `{}", self.name),
                known: names(known),
            })
        };
        if !self.inputs().iter().any(|s| s.name == input) {
            return Err(unknown("input", input, self.inputs()));
        }
        let places = outputs
            .iter()
            .map(|name| {
                let place = self.outputs().iter().position(|s| &s.name == name);
                place.ok_or_else(|| unknown("output", name, self.outputs()))
            })
            .collect::<Result<Vec<usize>, _>>()?;
        let form = match &self.form {
            Form::Identified(model) => {
                let mut chosen = model.clone();
                let pick = |place: &usize| model.outputs.get(*place).cloned();
                chosen.outputs = places.iter().filter_map(pick).collect();
                chosen.coefficients = places
                    .iter()
                    .filter_map(|p| model.coefficients.get(*p).cloned())
                    .collect();
                chosen.direct = places
                    .iter()
                    .filter_map(|p| model.direct.get(*p).copied())
                    .collect();
                Form::Identified(chosen)
            }
            Form::StateSpace(system) => {
                let wanted: Vec<&str> = outputs.iter().map(String::as_str).collect();
                Form::StateSpace(system.select(&[input], &wanted)?)
            }
        };
        Ok(Self {
            name: self.name.clone(),
            form,
            initial: self.initial,
        })
    }

    /// Poles with positive imaginary part and real ones, with their share in the response of a selected model.
    pub(crate) fn poles(&self) -> Result<Vec<SeenPole>, Failure> {
        match &self.form {
            Form::Identified(model) => Ok(poles_of(model)),
            Form::StateSpace(system) => seen_poles(system),
        }
    }

    /// Response of a selected model, by output.
    pub(crate) fn response(&self, omega_rad_s: &[f64]) -> Result<Vec<Vec<C64>>, Failure> {
        match &self.form {
            Form::Identified(model) => (0..model.outputs.len())
                .map(|o| Ok(model.frequency_response(o, omega_rad_s)?))
                .collect(),
            Form::StateSpace(system) => {
                let response = solver(system)?.response(omega_rad_s)?;
                Ok((0..system.outputs.len())
                    .map(|o| response.values.iter().map(|h| h[(o, 0)]).collect())
                    .collect())
            }
        }
    }

    /// Simulates the records with a selected model; a state space starts at rest.
    pub(crate) fn simulate(&self, data: &DataSet, estimate_initial: bool) -> Result<Vec<Simulated>, Failure> {
        let system = match &self.form {
            Form::Identified(model) => return Ok(simulate_records(model, data, estimate_initial)?),
            Form::StateSpace(system) => system,
        };
        let order = system.without_idle_states();
        data.experiments
            .iter()
            .map(|experiment| {
                let rows: Vec<Vec<f64>> = experiment.input.iter().map(|u| vec![*u]).collect();
                let history = lti::simulate(&order, experiment.dt, &rows, None, data.intersample.into())?;
                let mut outputs = Vec::new();
                for (signal, measured) in order.outputs.iter().zip(&experiment.outputs) {
                    let mut y = history.output(&signal.name)?;
                    if experiment.estimate_offset {
                        let n = y.len().max(1) as f64;
                        let constant = measured.iter().zip(&y).map(|(m, y)| m - y).sum::<f64>() / n;
                        y.iter_mut().for_each(|y| *y += constant);
                    }
                    outputs.push(y);
                }
                let fits = outputs
                    .iter()
                    .zip(&experiment.outputs)
                    .map(|(y, m)| nrmse_fit(m, y))
                    .collect();
                Ok(Simulated {
                    experiment: experiment.name.clone(),
                    initial: vec![albatross::sysid::InitialState::default(); outputs.len()],
                    outputs,
                    fits,
                })
            })
            .collect()
    }
}

/// Poles of an identified model, which the data have seen.
pub(crate) fn poles_of(model: &Model) -> Vec<SeenPole> {
    let poles = model.poles().into_iter().filter(|p| p.im >= 0.0);
    poles.map(|value| SeenPole { value, share: 1.0 }).collect()
}

/// States from which on one eigen-decomposition is cheaper than factors at every frequency.
const MANY_STATES: usize = 60;

/// A system prepared for many frequencies; where eigenvectors are nearly dependent, by factors at each of them.
fn solver(system: &StateSpace) -> Result<FrequencySolver, lti::Error> {
    if system.states.len() >= MANY_STATES
        && let Ok(solver) = FrequencySolver::new(system, Method::Eigen)
    {
        return Ok(solver);
    }
    FrequencySolver::new(system, Method::Auto)
}

/// Modes of a state space with one input: with right and left vectors v and w, `r = (C v)(w* B)/(w* v)` is the residue, and
/// the mode contributes `r/(i w - p)` to the response.
fn seen_poles(system: &StateSpace) -> Result<Vec<SeenPole>, Failure> {
    let system = system.without_idle_states();
    let vectors = eigen::eigen_both(system.a.as_ref()).map_err(albatross::Error::from)?;
    let solver = solver(&system)?;
    let n = system.states.len();
    let mut poles = Vec::new();
    for (k, &value) in vectors.values.iter().enumerate().filter(|(_, p)| p.im >= 0.0) {
        let own: C64 = (0..n)
            .map(|i| vectors.left[(i, k)].conj() * vectors.right[(i, k)])
            .sum();
        let driven: C64 = (0..n)
            .map(|i| vectors.left[(i, k)].conj() * system.b[(i, 0)])
            .sum();
        let at = C64::new(0.0, value.norm());
        let mut share = 0.0_f64;
        if value.im > 0.0 {
            let response = solver.evaluate(at)?;
            for o in 0..system.outputs.len() {
                let seen: C64 = (0..n).map(|i| vectors.right[(i, k)] * system.c[(o, i)]).sum();
                let part = seen * driven / own / (at - value);
                let whole = response[(o, 0)].norm();
                // Parts that cancel in sum count all the same.
                let of = part.norm() / whole.max(f64::MIN_POSITIVE);
                share = share.max(if of.is_finite() { of } else { 0.0 });
            }
        }
        poles.push(SeenPole { value, share });
    }
    Ok(poles)
}

pub(crate) fn names(signals: &[Signal]) -> String {
    let names: Vec<&str> = signals.iter().map(|s| s.name.as_str()).collect();
    names.join(", ")
}

/// Factor from one unit to another, and whether it is known: angles are converted, units that are not given are taken as
/// equal.
pub(crate) fn conversion(from: &Signal, to: &Signal) -> Option<f64> {
    let (a, b) = (plain(&from.unit), plain(&to.unit));
    match (a, b) {
        (Some((_, "")), _) | (_, Some((_, ""))) => Some(1.0),
        (Some((f, a)), Some((g, b))) if a == b => Some(f / g),
        _ => None,
    }
}

/// Factor to radians and the rest of the unit; empty for a unit that is not given.
fn plain(unit: &str) -> Option<(f64, &str)> {
    let angle = [("deg", 1.0_f64.to_radians()), ("rad", 1.0)];
    if ["", "-", "1"].contains(&unit) {
        return Some((1.0, ""));
    }
    for (name, factor) in angle {
        if let Some(rest) = unit.strip_prefix(name) {
            return Some((factor, if rest.is_empty() { "rad" } else { rest }));
        }
    }
    Some((1.0, unit))
}
