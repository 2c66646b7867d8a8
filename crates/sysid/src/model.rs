//! The identified model: a sum of real fractions with common poles.
//!
//! Equations: THEORY (28).

use albatross_lti::{Signal, StateSpace, TransferFunction, Zpk};
use albatross_numerics::{C64, Mat};
use serde::{Deserialize, Serialize};

use crate::blocks::{self, Block, state_matrices};
use crate::data::mismatch;
use crate::filters::{Bank, Timing};
use crate::numerator::{combine, zeros_of};
use crate::{Error, Experiment, Intersample, Result};

/// Transfer functions from one input to one or several outputs with the same poles.
///
/// ```text
/// G_o(s) = e^{-s delay} ( sum_i c_oi x_i(s) + d_o )
/// ```
/// with the states x of the blocks ([`Block`]). This form keeps its digits at any order; zeros, poles, gain and
/// polynomials are derived from it for reading and never used for computing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Name and unit of the input.
    pub input: Signal,
    /// Names and units of the outputs.
    pub outputs: Vec<Signal>,
    /// Factors of the denominator.
    pub blocks: Vec<Block>,
    /// Coefficients of the states, outputs x poles.
    pub coefficients: Vec<Vec<f64>>,
    /// Direct paths, one an output; zero unless there are as many zeros as poles.
    pub direct: Vec<f64>,
    /// Number of zeros of each transfer function.
    pub zeros: usize,
    /// Transport delay \[s\].
    pub delay: f64,
}

impl Model {
    /// Number of poles.
    pub fn order(&self) -> usize {
        blocks::order(&self.blocks)
    }

    /// Poles \[rad/s\], modulus ascending, conjugates together with the positive imaginary part last.
    pub fn poles(&self) -> Vec<C64> {
        let mut poles = blocks::poles(&self.blocks);
        albatross_numerics::eigen::order_by_modulus(&mut poles);
        poles
    }

    /// Whether all poles lie in the open left half plane.
    pub fn is_stable(&self) -> bool {
        self.blocks.iter().all(|b| b.is_stable())
    }

    /// Holds the lists against the order: the fields are open to change, and come from files.
    fn check(&self) -> Result<()> {
        let (order, outputs) = (self.order(), self.outputs.len());
        for (what, found) in [
            ("lists of coefficients of the model", self.coefficients.len()),
            ("direct paths of the model", self.direct.len()),
        ] {
            if found != outputs {
                return Err(mismatch(what, found, format!("{outputs}, one an output")));
            }
        }
        for (c, output) in self.coefficients.iter().zip(&self.outputs) {
            if c.len() != order {
                return Err(mismatch(
                    format!("coefficients of {}", output.name),
                    c.len(),
                    format!("{order}, one a pole"),
                ));
            }
        }
        if self.zeros > order {
            return Err(Error::Order {
                poles: order,
                zeros: self.zeros,
                expected: "no more zeros than poles are possible",
            });
        }
        if !(self.delay.is_finite() && self.delay >= 0.0) {
            return Err(Error::Domain {
                what: "the transport delay [s]",
                value: self.delay,
                expected: "zero or a positive number",
            });
        }
        Ok(())
    }

    fn output(&self, output: usize) -> Result<(&[f64], f64)> {
        self.check()?;
        match (self.coefficients.get(output), self.direct.get(output)) {
            (Some(c), Some(d)) => Ok((c, *d)),
            _ => Err(Error::Mismatch {
                what: "position of an output".into(),
                found: output.to_string(),
                expected: format!("less than {}", self.outputs.len()),
            }),
        }
    }

    /// G(s) of an output, delay included.
    ///
    /// # Errors
    /// [`Error::Mismatch`] for an output that is not there or lists of other lengths than the order asks for,
    /// [`Error::Order`] for more zeros than poles, [`Error::Domain`] for a negative delay.
    pub fn evaluate(&self, output: usize, s: C64) -> Result<C64> {
        let (c, d) = self.output(output)?;
        Ok(self.value(c, d, s))
    }

    /// G(s) with these coefficients, as many as poles.
    fn value(&self, c: &[f64], d: f64, s: C64) -> C64 {
        let mut value = C64::new(d, 0.0);
        let mut at = 0;
        for block in &self.blocks {
            let states = block.states(s);
            for (x, c) in states.iter().zip(&c[at..at + block.order()]) {
                value += x * c;
            }
            at += block.order();
        }
        value * (-s * self.delay).exp()
    }

    /// Frequency response of an output at angular frequencies \[rad/s\].
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn frequency_response(&self, output: usize, omega_rad_s: &[f64]) -> Result<Vec<C64>> {
        let (c, d) = self.output(output)?;
        Ok(omega_rad_s
            .iter()
            .map(|w| self.value(c, d, C64::new(0.0, *w)))
            .collect())
    }

    /// Zeros, poles and gain of an output, without the delay.
    ///
    /// # Errors
    /// As [`Model::evaluate`]; [`Error::Lti`], [`Error::Numerics`].
    pub fn zpk(&self, output: usize) -> Result<Zpk> {
        let (c, d) = self.output(output)?;
        let zeros = zeros_of(&self.blocks, c, d, self.zeros)?;
        let unit = Zpk::try_new(zeros, self.poles(), 1.0)?;
        // The gain from one value of G, taken on the real axis beyond all poles and zeros, where nothing cancels.
        let reach = unit
            .poles
            .iter()
            .chain(&unit.zeros)
            .map(|v| v.norm())
            .fold(1e-3, f64::max);
        let s = C64::new(2.0 * reach, 0.0);
        let value = self.value(c, d, s) * (s * self.delay).exp();
        let gain = (value / unit.evaluate(s)).re;
        Ok(Zpk::try_new(unit.zeros, unit.poles, gain)?)
    }

    /// Numerator and denominator of an output by descending powers of s, without the delay: for reading.
    ///
    /// # Errors
    /// As [`Model::zpk`].
    pub fn transfer_function(&self, output: usize) -> Result<TransferFunction> {
        Ok(self.zpk(output)?.to_transfer_function()?)
    }

    /// Block-diagonal state space, without the delay.
    ///
    /// # Errors
    /// [`Error::Lti`] for names that repeat; as [`Model::evaluate`] for lists that do not fit.
    pub fn state_space(&self) -> Result<StateSpace> {
        self.check()?;
        let (a, b) = state_matrices(&self.blocks);
        let n = b.len();
        let ny = self.outputs.len();
        let states = (1..=n).map(|i| Signal::new(format!("x{i}"), "1")).collect();
        Ok(StateSpace::try_new(
            (
                a,
                Mat::from_fn(n, 1, |i, _| b[i]),
                Mat::from_fn(ny, n, |o, i| self.coefficients[o][i]),
                Mat::from_fn(ny, 1, |o, _| self.direct[o]),
            ),
            states,
            vec![self.input.clone()],
            self.outputs.clone(),
        )?)
    }

    /// Outputs from rest for a sampled input, one list an output; exact for the behaviour between samples.
    ///
    /// # Errors
    /// [`Error::Lti`] when a pole overflows within one sample time; as [`Model::evaluate`] for lists that do not fit.
    pub fn simulate(&self, input: &[f64], dt: f64, intersample: Intersample) -> Result<Vec<Vec<f64>>> {
        self.check()?;
        let timing = Timing::new(dt, intersample, self.delay);
        let states = Bank::new(&self.blocks, timing)?.respond(input, false, 1).x;
        let delayed = timing.delayed(input);
        Ok(self
            .coefficients
            .iter()
            .zip(&self.direct)
            .map(|(c, d)| {
                let mut y = if states.is_empty() {
                    vec![0.0; input.len()]
                } else {
                    combine(&states, |i| c[i])
                };
                if *d != 0.0 {
                    albatross_numerics::matrix::axpy(*d, &delayed, &mut y);
                }
                y
            })
            .collect())
    }

    /// Free motions of the model for a record: columns that an unknown initial state adds to every output.
    pub(crate) fn free_motions(&self, experiment: &Experiment) -> Result<Vec<Vec<f64>>> {
        let timing = Timing::new(experiment.dt, Intersample::Zoh, 0.0);
        Ok(Bank::new(&self.blocks, timing)?
            .ring(experiment.len(), false, 1)
            .x)
    }
}
