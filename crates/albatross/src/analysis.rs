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
use albatross_lti::{FrequencySolver, Response, StateSpace};
use albatross_modal::{Component, ModalBasis, Symmetry, describe, energy_shares};
use serde::Serialize;

pub use crate::mode_table::{AeroelasticMode, ModeTable, RigidBodyMode, mode_table_without_lags};

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
