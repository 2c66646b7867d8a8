//! Linearisation about a state: exact Jacobians by dual numbers, one state or input at a time.

use crate::Error;
use crate::equations::{EquationsOfMotion, ensure_size};
use albatross_lti::{Signal, StateSpace};
use albatross_numerics::Mat;
use num_dual::Dual64;

/// `A, B, C, D` of small deviations from the state `x` and the input `u` (controls \[rad\], thrust \[N\]), with named
/// states, inputs and outputs.
///
/// # Errors
/// [`Error::Sizes`] if `x` or `u` have the wrong length; [`Error::Lti`] if a derivative is not finite, as at a speed of
/// zero or at a pitch angle of 90 deg with Euler angles.
pub fn linearize(equations: &EquationsOfMotion, x: &[f64], u: &[f64]) -> Result<StateSpace, Error> {
    let (n, m, p) = (
        equations.layout().n_states(),
        equations.n_inputs(),
        equations.aircraft().sensors.len(),
    );
    ensure_size("states in x", x.len(), n)?;
    ensure_size("inputs in u", u.len(), m)?;
    let mut state: Vec<Dual64> = x.iter().map(|&v| Dual64::from(v)).collect();
    let mut input: Vec<Dual64> = u.iter().map(|&v| Dual64::from(v)).collect();
    let mut rate = vec![Dual64::from(0.0); n];
    let mut output = vec![Dual64::from(0.0); p];
    let mut work = equations.workspace::<Dual64>();
    let mut jacobian = Mat::zeros(n + p, n + m);
    for column in 0..n + m {
        let seed = if column < n {
            &mut state[column]
        } else {
            &mut input[column - n]
        };
        seed.eps = 1.0;
        equations.rates(&state, &input, &mut work, &mut rate);
        equations.measure(&state, &rate, &mut output);
        for (row, value) in rate.iter().chain(&output).enumerate() {
            jacobian[(row, column)] = value.eps;
        }
        let seed = if column < n {
            &mut state[column]
        } else {
            &mut input[column - n]
        };
        seed.eps = 0.0;
    }
    let block = |row: usize, column: usize, rows: usize, columns: usize| {
        jacobian.submatrix(row, column, rows, columns).to_owned()
    };
    let mut inputs: Vec<Signal> = equations
        .aircraft()
        .controls
        .iter()
        .map(|c| Signal::new(c, "rad"))
        .collect();
    inputs.push(Signal::new(crate::THRUST, "N"));
    let outputs = equations
        .aircraft()
        .sensors
        .iter()
        .map(|s| Signal::new(&s.name, s.quantity.unit()))
        .collect();
    Ok(StateSpace::try_new(
        (
            block(0, 0, n, n),
            block(0, n, n, m),
            block(n, 0, p, n),
            block(n, n, p, m),
        ),
        equations.layout().signals(),
        inputs,
        outputs,
    )?)
}
