//! Time histories of linear systems.
//!
//! [`simulate`] is exact for inputs held constant, or varying linearly, between samples: the step from sample
//! to sample is a matrix exponential. [`simulate_rk4`] integrates with the fixed-step method of the non-linear
//! model, so the two can be compared without a difference of method.

use albatross_numerics::Mat;
use albatross_numerics::integrate::{Rk4, Stage};
use albatross_numerics::matrix::{PreparedMatrix, RowMatrix};

use crate::error::SignalKind;
use crate::exponential::exponential;
use crate::{Error, Result, Signal, StateSpace};

/// How an input behaves between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Constant at the value of the earlier sample.
    Zero,
    /// Linear from sample to sample.
    First,
}

/// A sampled system: `x[k+1] = Phi x[k] + G0 u[k] + G1 u[k+1]`, `y[k] = C x[k] + D u[k]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrete {
    /// Step, s.
    pub dt: f64,
    /// Transition matrix exp(A dt).
    pub phi: Mat<f64>,
    /// Effect of the input at the beginning of the step.
    pub gamma0: Mat<f64>,
    /// Effect of the input at the end of the step; zero for [`Hold::Zero`].
    pub gamma1: Mat<f64>,
}

/// States and outputs over time.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// States, times x states.
    pub states: RowMatrix,
    /// Outputs, times x outputs.
    pub outputs: RowMatrix,
    /// Names of the columns of `states`.
    pub state_signals: Vec<Signal>,
    /// Names of the columns of `outputs`.
    pub output_signals: Vec<Signal>,
}

impl History {
    fn new(system: &StateSpace, dt: f64, samples: usize) -> Self {
        Self {
            time_s: (0..samples).map(|k| k as f64 * dt).collect(),
            states: RowMatrix::zeros(samples, system.states.len()),
            outputs: RowMatrix::zeros(samples, system.outputs.len()),
            state_signals: system.states.clone(),
            output_signals: system.outputs.clone(),
        }
    }

    /// One output over time.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are.
    pub fn output(&self, name: &str) -> Result<Vec<f64>> {
        column(SignalKind::Output, &self.output_signals, &self.outputs, name)
    }

    /// One state over time.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are.
    pub fn state(&self, name: &str) -> Result<Vec<f64>> {
        column(SignalKind::State, &self.state_signals, &self.states, name)
    }
}

fn column(kind: SignalKind, signals: &[Signal], table: &RowMatrix, name: &str) -> Result<Vec<f64>> {
    let j = crate::state_space::index_of(kind, signals, name)?;
    Ok((0..table.rows())
        .filter_map(|i| table.row(i).get(j).copied())
        .collect())
}

/// The exact step of `dt` (s) for inputs that follow `hold`.
///
/// Both input matrices come from one exponential of the system augmented by its input and the slope of the input
/// (Van Loan, IEEE Trans. Automatic Control 23, 1978).
///
/// # Errors
/// [`Error::Domain`] for a step that is not positive, [`Error::Numerics`] when the exponential overflows, those of
/// [`StateSpace::check`].
pub fn discretise(system: &StateSpace, dt: f64, hold: Hold) -> Result<Discrete> {
    check_step(dt)?;
    system.check()?;
    let (n, m) = (system.states.len(), system.inputs.len());
    let augmented = Mat::from_fn(n + 2 * m, n + 2 * m, |i, j| {
        if i < n && j < n {
            system.a[(i, j)] * dt
        } else if i < n && j < n + m {
            system.b[(i, j - n)] * dt
        } else if i >= n && j == i + m {
            1.0
        } else {
            0.0
        }
    });
    let e = exponential(augmented.as_ref())?;
    let phi = e.submatrix(0, 0, n, n).to_owned();
    let constant = e.submatrix(0, n, n, m).to_owned();
    let ramp = e.submatrix(0, n + m, n, m).to_owned();
    Ok(match hold {
        Hold::Zero => Discrete {
            dt,
            phi,
            gamma0: constant,
            gamma1: Mat::zeros(n, m),
        },
        Hold::First => Discrete {
            dt,
            phi,
            gamma0: &constant - &ramp,
            gamma1: ramp,
        },
    })
}

/// Response to sampled inputs, one row of input values per time k dt, from the initial state (zero when `None`).
///
/// # Errors
/// [`Error::InputWidth`] for a row of the wrong length, those of [`discretise`], and [`Error::Numerics`] for an
/// initial state of the wrong length.
pub fn simulate(
    system: &StateSpace,
    dt: f64,
    inputs: &[Vec<f64>],
    initial: Option<&[f64]>,
    hold: Hold,
) -> Result<History> {
    let expected = system.inputs.len();
    if let Some((sample, row)) = inputs.iter().enumerate().find(|(_, row)| row.len() != expected) {
        return Err(Error::InputWidth {
            sample,
            expected,
            found: row.len(),
        });
    }
    let step = discretise(system, dt, hold)?;
    let [phi, gamma0, gamma1, c, d] = [&step.phi, &step.gamma0, &step.gamma1, &system.c, &system.d]
        .map(|m| PreparedMatrix::new(m.as_ref()));
    let mut x = initial_state(system, initial)?;
    let mut next_x = x.clone();
    let mut history = History::new(system, dt, inputs.len());
    for (k, u) in inputs.iter().enumerate() {
        record(&mut history, k, (&c, &d), &x, u);
        let Some(next_u) = inputs.get(k + 1) else { break };
        phi.mul_into(&x, &mut next_x);
        gamma0.mul_add_into(u, &mut next_x);
        gamma1.mul_add_into(next_u, &mut next_x);
        std::mem::swap(&mut x, &mut next_x);
    }
    Ok(history)
}

/// Most numbers that a history may hold, 8 GB.
const MOST_NUMBERS: usize = 1_000_000_000;

/// Response to a continuous input by `steps` steps of the classical Runge-Kutta method.
///
/// `input(t, stage, u)` writes the input at `t`; at the end of a step ([`Stage::End`]) a discontinuous input
/// gives its limit from the left, and at [`Stage::Start`] the one from the right. Outputs use the latter.
///
/// # Errors
/// [`Error::Domain`] for a step that is not positive and for more than 1e9 numbers, [`Error::Numerics`] for an initial
/// state of the wrong length, those of [`StateSpace::check`].
pub fn simulate_rk4(
    system: &StateSpace,
    dt: f64,
    steps: usize,
    initial: Option<&[f64]>,
    mut input: impl FnMut(f64, Stage, &mut [f64]),
) -> Result<History> {
    check_step(dt)?;
    system.check()?;
    let width = 1 + system.states.len() + system.outputs.len();
    let numbers = steps.checked_add(1).and_then(|n| n.checked_mul(width));
    if numbers.is_none_or(|n| n > MOST_NUMBERS) {
        return Err(Error::Domain {
            what: "the number of steps",
            value: steps as f64,
            expected: "a history of at most 1e9 numbers, states and outputs together",
        });
    }
    let [a, b, c, d] = [&system.a, &system.b, &system.c, &system.d].map(|m| PreparedMatrix::new(m.as_ref()));
    let mut x = initial_state(system, initial)?;
    let mut u = vec![0.0; system.inputs.len()];
    let mut method = Rk4::new(x.len());
    let mut history = History::new(system, dt, steps + 1);
    for k in 0..=steps {
        let t = k as f64 * dt;
        input(t, Stage::Start, &mut u);
        record(&mut history, k, (&c, &d), &x, &u);
        if k < steps {
            method.step(t, dt, &mut x, |t, stage, x, xdot| {
                input(t, stage, &mut u);
                a.mul_into(x, xdot);
                b.mul_add_into(&u, xdot);
            });
        }
    }
    Ok(history)
}

fn check_step(dt: f64) -> Result<()> {
    if dt > 0.0 && dt.is_finite() {
        return Ok(());
    }
    Err(Error::Domain {
        what: "the time step",
        value: dt,
        expected: "a positive number of seconds",
    })
}

fn initial_state(system: &StateSpace, initial: Option<&[f64]>) -> Result<Vec<f64>> {
    let n = system.states.len();
    let x = initial.map_or_else(|| vec![0.0; n], <[f64]>::to_vec);
    albatross_numerics::matrix::check_shape("the initial state", (x.len(), 1), (n, 1))?;
    Ok(x)
}

/// Writes x and y = C x + D u as row `k`.
fn record(history: &mut History, k: usize, (c, d): (&PreparedMatrix, &PreparedMatrix), x: &[f64], u: &[f64]) {
    let (nx, ny) = (history.states.cols(), history.outputs.cols());
    if let Some(row) = history.states.data_mut().get_mut(k * nx..(k + 1) * nx) {
        row.copy_from_slice(x);
    }
    if let Some(row) = history.outputs.data_mut().get_mut(k * ny..(k + 1) * ny) {
        c.mul_into(x, row);
        d.mul_add_into(u, row);
    }
}
