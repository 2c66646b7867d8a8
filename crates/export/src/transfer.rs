//! A transfer function: zeros, poles and gain first, polynomials with their error.

use crate::Result;
use crate::record::{Record, Value};
use albatross_lti::{Signal, StateSpace, TransferFunction, Zpk};
use albatross_numerics::C64;
use serde::Serialize;

/// The transfer function of one channel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Transfer {
    /// Input.
    pub input: Signal,
    /// Output.
    pub output: Signal,
    /// Zeros, poles \[rad/s\] and gain.
    #[serde(flatten)]
    pub zpk: Zpk,
    /// Numerator and denominator; none where a coefficient leaves the range of numbers.
    pub transfer_function: Option<TransferFunction>,
    /// How far the polynomials are from zeros, poles and gain: the largest relative difference of the response at the
    /// moduli of the poles.
    pub transfer_function_error: Option<f64>,
}

impl Transfer {
    /// The transfer function from an input to an output of a system, without pairs of zeros and poles that lie within
    /// `cancel` times their modulus of each other; zero keeps all that differ.
    ///
    /// # Errors
    /// [`crate::Error::Lti`] for a name that is not there, and as [`Zpk::from_state_space`].
    pub fn of_system(system: &StateSpace, input: &str, output: &str, cancel: f64) -> Result<Self> {
        let channel = system.select(&[input], &[output])?;
        let zpk = Zpk::from_state_space(&channel)?.cancelled(cancel);
        let (input, output) = (system.input_index(input)?, system.output_index(output)?);
        Self::new(system.inputs[input].clone(), system.outputs[output].clone(), zpk)
    }

    /// Zeros, poles and gain with their polynomials.
    ///
    /// # Errors
    /// [`crate::Error::Lti`] for a complex root without its conjugate.
    pub fn new(input: Signal, output: Signal, zpk: Zpk) -> Result<Self> {
        let polynomials = zpk.to_transfer_function()?;
        let error = difference(&zpk, &polynomials);
        Ok(Self {
            input,
            output,
            zpk,
            transfer_function: error.map(|_| polynomials),
            transfer_function_error: error,
        })
    }

    /// `Z`, `P`, `K`, `Numerator`, `Denominator` (empty where there are none), `PolynomialError`, and `InputName`,
    /// `InputUnit`, `OutputName`, `OutputUnit`.
    ///
    /// In MATLAB: `zpk(Z, P, K)`; in SciPy: `scipy.signal.ZerosPolesGain(Z, P, K)`.
    #[must_use]
    pub fn record(&self) -> Record {
        let row =
            |list: &[f64]| Value::Matrix(albatross_numerics::Mat::from_fn(1, list.len(), |_, j| list[j]));
        let (numerator, denominator) = match &self.transfer_function {
            Some(t) => (row(&t.numerator), row(&t.denominator)),
            None => (row(&[]), row(&[])),
        };
        Record::new()
            .with("Z", Value::ComplexColumn(self.zpk.zeros.clone()))
            .with("P", Value::ComplexColumn(self.zpk.poles.clone()))
            .with("K", Value::Scalar(self.zpk.gain))
            .with("Numerator", numerator)
            .with("Denominator", denominator)
            .with(
                "PolynomialError",
                Value::Scalar(self.transfer_function_error.unwrap_or(f64::NAN)),
            )
            .with_signals("Input", std::slice::from_ref(&self.input))
            .with_signals("Output", std::slice::from_ref(&self.output))
    }
}

/// Largest relative difference of two forms at `i |p|` of all poles; none if a coefficient or a value is not finite.
fn difference(zpk: &Zpk, polynomials: &TransferFunction) -> Option<f64> {
    let coefficients = polynomials.numerator.iter().chain(&polynomials.denominator);
    if !coefficients.into_iter().all(|c| c.is_finite()) {
        return None;
    }
    let mut worst = 0.0_f64;
    for pole in &zpk.poles {
        let s = C64::new(0.0, pole.norm());
        let (exact, found) = (zpk.evaluate(s), polynomials.evaluate(s));
        // On an undamped pole or at a zero there is nothing to compare with.
        if !exact.is_finite() || exact.norm() == 0.0 {
            continue;
        }
        let error = (found - exact).norm() / exact.norm();
        if !error.is_finite() {
            return None;
        }
        worst = worst.max(error);
    }
    Some(worst)
}
