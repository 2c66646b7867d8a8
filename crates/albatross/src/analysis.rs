//! Analyses of a model: what the subcommands print and the report shows, as plain results.

use crate::case::{ManoeuvreCase, SignalCase};
use crate::inputs::Inputs;
use crate::model::Model;
use crate::{Error, case};
use albatross_flight::lag_form::diagonal_lag_form;
use albatross_flight::signal::Signal;
use albatross_flight::{
    Attitude, EquationsOfMotion, Fidelity, Manoeuvre, ModelOptions, TimeHistory, Trim, linearize, simulate,
    trim,
};
use albatross_lti::modes::{Mode, mode_table};
use albatross_lti::track::{TrackOptions, Tracker};
use albatross_lti::{FrequencySolver, Response, StateSpace};
use albatross_modal::{Component, ModalBasis, Symmetry, describe, energy_shares};
use albatross_numerics::{C64, Mat};
use serde::Serialize;

/// A structural mode of the basis.
#[derive(Debug, Clone, Serialize)]
pub struct StructuralMode {
    /// Rank in the basis, from 1.
    pub mode: usize,
    /// Number in the results file.
    pub number_in_file: usize,
    /// Frequency \[Hz\].
    pub frequency_hz: f64,
    /// Frequency \[rad/s\].
    pub omega_rad_s: f64,
    /// Modal mass \[kg m² per unit²\].
    pub generalized_mass: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// `symmetric`, `antisymmetric` or `mixed`.
    pub symmetry: Symmetry,
    /// Largest coupling with rigid motion, if it was checked.
    pub rigid_coupling: Option<f64>,
    /// Where the kinetic energy is: shares by component and direction.
    pub description: String,
}

/// The structural modes of a model with their kinetic-energy shares by load reference axis.
///
/// # Errors
/// [`Error::UnknownName`] for a range of grids that cannot be read.
pub fn structural_modes(inputs: &Inputs, model: &Model) -> Result<Vec<StructuralMode>, Error> {
    Ok(modes_of_basis(
        &model.basis,
        &model.damping,
        &inputs.components()?,
    ))
}

/// The modes of a basis with their kinetic-energy shares by component; modes beyond the list of damping ratios have none.
pub fn modes_of_basis(basis: &ModalBasis, damping: &[f64], components: &[Component]) -> Vec<StructuralMode> {
    // Without a mass matrix there are no energies to share.
    let shares = energy_shares(basis, components).unwrap_or_default();
    let coupling = match &basis.mean_axes {
        albatross_modal::MeanAxes::Checked(check) => Some(check),
        albatross_modal::MeanAxes::Refused { .. } => None,
    };
    basis
        .modes
        .iter()
        .enumerate()
        .map(|(k, mode)| StructuralMode {
            mode: k + 1,
            number_in_file: mode.number,
            frequency_hz: mode.frequency_hz,
            omega_rad_s: mode.omega_rad_s,
            generalized_mass: mode.generalized_mass,
            damping_ratio: damping.get(k).copied().unwrap_or(0.0),
            symmetry: mode.symmetry,
            rigid_coupling: coupling
                .and_then(|c| c.coupling.get(k))
                .map(|row| row.iter().fold(0.0, |m: f64, v| m.max(v.abs()))),
            description: shares.get(k).map_or_else(String::new, |s| describe(s, 0.05)),
        })
        .collect()
}

/// A trimmed model with its linearisation.
#[derive(Debug, Clone)]
pub struct Trimmed {
    /// The equations, with their reference shape.
    pub equations: EquationsOfMotion,
    /// The trim.
    pub trim: Trim,
    /// The linearisation about it.
    pub system: StateSpace,
}

/// Trims a model and linearises it, attitude in Euler angles.
///
/// # Errors
/// As [`albatross_flight::trim()`] and [`linearize()`].
pub fn trimmed(model: &Model) -> Result<Trimmed, Error> {
    with_fidelity(model, model.options.fidelity)
}

/// As [`trimmed`], with another fidelity of the same aircraft.
///
/// # Errors
/// As [`trimmed`].
pub fn with_fidelity(model: &Model, fidelity: Fidelity) -> Result<Trimmed, Error> {
    with_options(
        model,
        ModelOptions {
            fidelity,
            attitude: Attitude::Euler,
            ..model.options
        },
    )
}

/// As [`trimmed`], with attitude kept as the case asks for simulations.
///
/// # Errors
/// As [`trimmed`].
pub fn trimmed_for_simulation(model: &Model) -> Result<Trimmed, Error> {
    with_options(model, model.options)
}

fn with_options(model: &Model, options: ModelOptions) -> Result<Trimmed, Error> {
    let (equations, trim) = trim(&model.aircraft, options, &model.point)?;
    let system = linearize(&equations, &trim.state, &trim.input)?;
    Ok(Trimmed {
        equations,
        trim,
        system,
    })
}

/// An aeroelastic mode, followed from the structural one.
#[derive(Debug, Clone, Serialize)]
pub struct AeroelasticMode {
    /// Rank of the structural mode in the basis, from 1.
    pub mode: usize,
    /// Frequency in vacuo \[rad/s\].
    pub in_vacuo_rad_s: f64,
    /// Frequency in the flow, modulus of the eigenvalue \[rad/s\].
    pub omega_rad_s: f64,
    /// Damping ratio in the flow.
    pub damping_ratio: f64,
    /// Real part of the eigenvalue \[1/s\].
    pub re: f64,
    /// Imaginary part \[rad/s\].
    pub im: f64,
    /// Least certainty of the steps by which it was followed, 1 is best.
    pub confidence: f64,
}

/// A rigid-body mode, followed from the rigid aircraft.
#[derive(Debug, Clone, Serialize)]
pub struct RigidBodyMode {
    /// Name.
    pub name: &'static str,
    /// Of the rigid aircraft.
    pub rigid: Mode,
    /// Of the flexible aircraft; none if it could not be followed.
    pub flexible: Option<Mode>,
}

/// Modes of the aircraft without lag roots.
#[derive(Debug, Clone, Serialize)]
pub struct ModeTable {
    /// Elastic modes in the order of the basis.
    pub elastic: Vec<AeroelasticMode>,
    /// Rigid-body modes.
    pub rigid_body: Vec<RigidBodyMode>,
}

/// The elastic and rigid-body modes of a linearised model, told from lag roots by following them from the structure
/// in vacuo and the rigid aircraft: along `A(t) = A_0 + t (A - A_0)`, where `A_0` holds both uncoupled.
///
/// # Errors
/// [`Error::Lti`] if a mode cannot be followed with certainty.
pub fn mode_table_without_lags(model: &Model, trimmed: &Trimmed) -> Result<ModeTable, Error> {
    let layout = trimmed.equations.layout();
    // Heading and position move nothing: without them the matrix has no defective zero eigenvalues.
    let idle = ["psi", "north", "east"];
    let signals = &trimmed.system.states;
    let kept: Vec<usize> = (0..signals.len())
        .filter(|&i| !idle.contains(&signals[i].name.as_str()))
        .collect();
    let rigid = with_fidelity(model, Fidelity::Rigid)?;
    let pick =
        |a: &Mat<f64>, rows: &[usize]| Mat::from_fn(rows.len(), rows.len(), |i, j| a[(rows[i], rows[j])]);
    let coupled = pick(&trimmed.system.a, &kept);
    let n_rigid = kept.iter().filter(|&&i| i < layout.n_rigid()).count();
    let rigid_a = pick(&rigid.system.a, &kept[..n_rigid]);
    let uncoupled = uncoupled_matrix(model, trimmed, &coupled, &rigid_a);

    let rigid_names: Vec<&str> = kept[..n_rigid]
        .iter()
        .map(|&i| signals[i].name.as_str())
        .collect();
    let named = name_rigid_modes(&rigid_a, &rigid_names)?;
    let in_vacuo: Vec<C64> = model
        .basis
        .modes
        .iter()
        .zip(&model.damping)
        .take(layout.n_modes)
        .map(|(m, xi)| C64::new(-xi, (1.0 - xi * xi).sqrt()) * m.omega_rad_s)
        .collect();
    let rigid_values: Vec<C64> = named.iter().map(|(_, value)| *value).collect();
    let (elastic, flexible) = follow_all(&uncoupled, &coupled, &in_vacuo, &rigid_values)?;
    let elastic = elastic
        .into_iter()
        .enumerate()
        .map(|(k, (value, confidence))| AeroelasticMode {
            mode: k + 1,
            in_vacuo_rad_s: model.basis.modes.get(k).map_or(0.0, |m| m.omega_rad_s),
            omega_rad_s: value.norm(),
            damping_ratio: -value.re / value.norm(),
            re: value.re,
            im: value.im,
            confidence,
        })
        .collect();
    let rigid_body = named
        .into_iter()
        .zip(flexible)
        .map(|((name, value), flexible)| RigidBodyMode {
            name,
            rigid: Mode::from_eigenvalue(value),
            flexible: flexible.map(Mode::from_eigenvalue),
        })
        .collect();
    Ok(ModeTable { elastic, rigid_body })
}

/// Elastic modes with their certainty, and rigid-body modes where they can be followed. One path serves all; a
/// rigid-body mode that cannot be followed (roll subsidence may meet a lag root) must not spoil the rest.
#[allow(clippy::type_complexity)]
fn follow_all(
    from: &Mat<f64>,
    to: &Mat<f64>,
    elastic: &[C64],
    rigid: &[C64],
) -> Result<(Vec<(C64, f64)>, Vec<Option<C64>>), Error> {
    let together: Vec<C64> = elastic.iter().chain(rigid).copied().collect();
    if let Ok(mut found) = follow(from, to, &together) {
        let rigid = found
            .split_off(elastic.len())
            .into_iter()
            .map(|(value, _)| Some(value))
            .collect();
        return Ok((found, rigid));
    }
    let alone = |value: &C64| {
        follow(from, to, &[*value])
            .ok()
            .and_then(|found| found.first().map(|(v, _)| *v))
    };
    Ok((follow(from, to, elastic)?, rigid.iter().map(alone).collect()))
}

/// Rigid aircraft, structure in vacuo and lags, none of which act on each other.
fn uncoupled_matrix(model: &Model, trimmed: &Trimmed, coupled: &Mat<f64>, rigid: &Mat<f64>) -> Mat<f64> {
    let n = trimmed.equations.n_modes();
    let n_rigid = rigid.nrows();
    let mut a = Mat::zeros(coupled.nrows(), coupled.ncols());
    a.as_mut().submatrix_mut(0, 0, n_rigid, n_rigid).copy_from(rigid);
    for (k, (mode, xi)) in model.basis.modes.iter().zip(&model.damping).enumerate().take(n) {
        let (eta, etad) = (n_rigid + k, n_rigid + n + k);
        a[(eta, etad)] = 1.0;
        a[(etad, eta)] = -mode.omega_rad_s.powi(2);
        a[(etad, etad)] = -2.0 * xi * mode.omega_rad_s;
    }
    let rates = trimmed.equations.lag_diagonal(trimmed.trim.speed());
    let first_lag = n_rigid + 2 * n;
    for (i, rate) in rates[trimmed.equations.layout().lags()].iter().enumerate() {
        a[(first_lag + i, first_lag + i)] = *rate;
    }
    a
}

fn follow(from: &Mat<f64>, to: &Mat<f64>, chosen: &[C64]) -> Result<Vec<(C64, f64)>, Error> {
    if chosen.is_empty() {
        return Ok(Vec::new());
    }
    let options = TrackOptions {
        largest_step: 0.125,
        ..TrackOptions::default()
    };
    let followed = Tracker::new(from.as_ref(), chosen, options)?.follow(to.as_ref())?;
    Ok(followed
        .modes
        .iter()
        .map(|m| (m.values.first().copied().unwrap_or_default(), m.confidence))
        .collect())
}

/// Names of the modes of the rigid aircraft, by the states that carry them.
fn name_rigid_modes(a: &Mat<f64>, states: &[&str]) -> Result<Vec<(&'static str, C64)>, Error> {
    let n = a.nrows();
    let signal = |name: &&str| albatross_lti::Signal::new(*name, "");
    let system = StateSpace::try_new(
        (a.clone(), Mat::zeros(n, 0), Mat::zeros(0, n), Mat::zeros(0, 0)),
        states.iter().map(signal).collect(),
        Vec::new(),
        Vec::new(),
    )?;
    let lateral = |mode: &Mode| {
        let share = |names: &[&str]| {
            mode.participation
                .iter()
                .filter(|p| names.contains(&p.state.as_str()))
                .map(|p| p.share)
                .sum::<f64>()
        };
        share(&["v", "p", "r", "phi"]) > 0.5
    };
    let modes = mode_table(&system)?;
    let mut named = Vec::new();
    let mut name_last = |wanted: &dyn Fn(&Mode) -> bool, names: &[&'static str]| {
        // From the fastest: modes are in order of modulus.
        for (mode, name) in modes.iter().rev().filter(|m| wanted(m)).zip(names) {
            named.push((*name, mode.eigenvalue()));
        }
    };
    name_last(&|m| m.oscillatory && !lateral(m), &["short period", "phugoid"]);
    name_last(&|m| m.oscillatory && lateral(m), &["Dutch roll"]);
    name_last(&|m| !m.oscillatory && lateral(m), &["roll subsidence", "spiral"]);
    Ok(named)
}

/// Frequency response of a linearised model; the lag states are eliminated.
///
/// # Errors
/// [`Error::Lti`].
pub fn frequency_response(trimmed: &Trimmed, input: &str, omega_rad_s: &[f64]) -> Result<Response, Error> {
    let system = diagonal_lag_form(&trimmed.system, &trimmed.equations, trimmed.trim.speed())?;
    let outputs: Vec<&str> = system.outputs.iter().map(|o| o.name.as_str()).collect();
    let lags: Vec<&str> = system.states[trimmed.equations.layout().lags()]
        .iter()
        .map(|s| s.name.as_str())
        .collect();
    let system = system.select(&[input], &outputs)?;
    Ok(FrequencySolver::with_lags(&system, &lags)?.response(omega_rad_s)?)
}

/// The manoeuvre of a case as the flight crate takes it.
///
/// # Errors
/// [`Error::UnknownName`] for the input, what reading a signal's file returns.
pub fn manoeuvre(
    inputs: &Inputs,
    equations: &EquationsOfMotion,
    case: &ManoeuvreCase,
) -> Result<Manoeuvre, Error> {
    let controls = &equations.aircraft().controls;
    let index = if case.input == "thrust" {
        controls.len()
    } else {
        controls
            .iter()
            .position(|c| *c == case.input)
            .ok_or_else(|| Error::UnknownName {
                kind: "input",
                name: case.input.clone(),
                known: format!("{}, thrust", controls.join(", ")),
            })?
    };
    // Amplitudes of controls are in degrees in the case file.
    let unit = if index < controls.len() {
        1.0_f64.to_radians()
    } else {
        1.0
    };
    let signal = match inputs.signal_samples(&case.signal)? {
        Some((time, value)) => {
            let first = match &case.signal {
                SignalCase::Csv {
                    offset: case::manoeuvre::Offset::First,
                    ..
                } => value.first().copied().unwrap_or(0.0),
                _ => 0.0,
            };
            Signal::Table {
                time,
                value: value.iter().map(|v| unit * (v - first)).collect(),
            }
        }
        None => case.signal.signal(unit).unwrap_or(Signal::Step {
            amplitude: 0.0,
            start: 0.0,
        }),
    };
    Ok(Manoeuvre {
        dt: case.dt,
        end: case.end,
        output_every: case.output_every,
        method: case.method,
        inputs: vec![(index, signal)],
    })
}

/// Simulates a manoeuvre of the case with the non-linear model.
///
/// # Errors
/// As [`manoeuvre()`] and [`simulate()`].
pub fn simulate_case(inputs: &Inputs, trimmed: &Trimmed, case: &ManoeuvreCase) -> Result<TimeHistory, Error> {
    let manoeuvre = manoeuvre(inputs, &trimmed.equations, case)?;
    Ok(simulate(&trimmed.equations, &trimmed.trim, &manoeuvre)?)
}
