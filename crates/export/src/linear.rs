//! The linear model with its names and its trim.

use crate::record::{Record, Value};
use crate::{Error, Result};
use albatross_flight::{EquationsOfMotion, Trim};
use albatross_lti::{Signal, StateSpace};

/// The flight about which a linear model holds, in the order of its signals: the total is this plus the deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatingPoint {
    /// States.
    pub states: Vec<f64>,
    /// Inputs.
    pub inputs: Vec<f64>,
    /// Outputs.
    pub outputs: Vec<f64>,
}

impl OperatingPoint {
    /// The trimmed flight.
    ///
    /// # Errors
    /// [`Error::Flight`] if the trim is one of other equations.
    pub fn of_trim(equations: &EquationsOfMotion, trim: &Trim) -> Result<Self> {
        let mut rates = vec![0.0; trim.state.len()];
        equations.derivative(&trim.state, &trim.input, &mut equations.workspace(), &mut rates)?;
        let mut outputs = vec![0.0; equations.aircraft().sensors.len()];
        equations.outputs(&trim.state, &rates, &mut outputs)?;
        Ok(Self {
            states: trim.state.clone(),
            inputs: trim.input.clone(),
            outputs,
        })
    }
}

/// `A`, `B`, `C`, `D`; `StateName`, `StateUnit` and likewise `Input…`, `Output…`; with an operating point the group
/// `Trim` of `x`, `u`, `y`.
///
/// In MATLAB: `ss(A, B, C, D, 'StateName', StateName, 'InputName', InputName, 'OutputName', OutputName)`.
///
/// # Errors
/// [`Error::Mismatch`] if the operating point has other sizes than the system.
pub fn state_space(system: &StateSpace, about: Option<&OperatingPoint>) -> Result<Record> {
    let matrix = |m: &albatross_numerics::Mat<f64>| Value::Matrix(m.clone());
    let record = Record::new()
        .with("A", matrix(&system.a))
        .with("B", matrix(&system.b))
        .with("C", matrix(&system.c))
        .with("D", matrix(&system.d))
        .with_signals("State", &system.states)
        .with_signals("Input", &system.inputs)
        .with_signals("Output", &system.outputs);
    let Some(about) = about else {
        return Ok(record);
    };
    let column = |what: &str, values: &[f64], signals: &[Signal]| {
        if values.len() == signals.len() {
            return Ok(Value::Column(values.to_vec()));
        }
        Err(Error::Mismatch {
            what: format!("{what} of the operating point"),
            found: values.len(),
            expected: signals.len(),
        })
    };
    let trim = Record::new()
        .with("x", column("states", &about.states, &system.states)?)
        .with("u", column("inputs", &about.inputs, &system.inputs)?)
        .with("y", column("outputs", &about.outputs, &system.outputs)?);
    Ok(record.with("Trim", Value::Group(trim)))
}

/// The system as one table, `[A B; C D]`: a row for the derivative of each state and for each output, a column for
/// each state and each input.
///
/// The first three columns say what a row is, `derivative` or `output`, of which `name`, and the `unit` of that state
/// or output; the others are headed `state NAME [UNIT]` and `input NAME [UNIT]`.
///
/// # Errors
/// [`Error::Csv`]; [`Error::Lti`] for a system that fails its check.
pub fn table(system: &StateSpace) -> Result<String> {
    system.check()?;
    let mut writer = csv::Writer::from_writer(Vec::new());
    let heading = |kind: &'static str| move |s: &Signal| format!("{kind} {} [{}]", s.name, s.unit);
    let header = ["row", "name", "unit"].map(String::from).into_iter();
    let header = header
        .chain(system.states.iter().map(heading("state")))
        .chain(system.inputs.iter().map(heading("input")));
    writer.write_record(header)?;
    for (kind, signals, left, right) in [
        ("derivative", &system.states, &system.a, &system.b),
        ("output", &system.outputs, &system.c, &system.d),
    ] {
        for (i, signal) in signals.iter().enumerate() {
            let of = |m: &albatross_numerics::Mat<f64>| {
                (0..m.ncols())
                    .map(|j| format!("{:?}", m[(i, j)]))
                    .collect::<Vec<_>>()
            };
            let names = [kind, &signal.name, &signal.unit].map(String::from);
            writer.write_record(names.into_iter().chain(of(left)).chain(of(right)))?;
        }
    }
    let bytes = writer
        .into_inner()
        .map_err(|e| Error::Csv(e.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
