//! Outputs of long linear histories, many steps at a time.
//!
//! From sample to sample the whole transition matrix is read, which for some hundred states is all that an exact simulation
//! does. Where outputs alone are wanted, L steps are one: with the last state of the stride before and the inputs within,
//! ```text
//! x[k+L]            = Phi^L x[k] + F w            w = (u[k], ..., u[k+L])
//! (y[k..k+L])       = O x[k] + M w                O = (C; C Phi; ...; C Phi^(L-1))
//! ```
//! The matrices are formed once, the large one by squaring. The result is that of [`simulate`](crate::simulate()) but for
//! rounding.

use albatross_numerics::Mat;
use albatross_numerics::matrix::PreparedMatrix;

use crate::simulation::{Discrete, discretise};
use crate::{Error, Hold, Result, StateSpace};

/// Squarings of the transition matrix; a stride is two to this power.
const SQUARINGS: usize = 5;
/// Steps of one stride.
const STRIDE: usize = 1 << SQUARINGS;

/// A system prepared for histories of its outputs at one step.
#[derive(Debug, Clone)]
pub struct OutputSimulator {
    states: usize,
    inputs: usize,
    outputs: usize,
    /// Phi^L.
    transition: PreparedMatrix,
    /// F.
    forcing: PreparedMatrix,
    /// O.
    observation: PreparedMatrix,
    /// M.
    markov: PreparedMatrix,
}

impl OutputSimulator {
    /// Prepares a system for steps of `dt` (s) and inputs that follow `hold`.
    ///
    /// # Errors
    /// As [`discretise`].
    pub fn new(system: &StateSpace, dt: f64, hold: Hold) -> Result<Self> {
        let Discrete {
            phi, gamma0, gamma1, ..
        } = discretise(system, dt, hold)?;
        let (n, m, p) = (system.states.len(), system.inputs.len(), system.outputs.len());
        // Phi^k [G0, G1]: what an input of k + 1 steps ago has left in the state.
        let mut pulse = Mat::from_fn(
            n,
            2 * m,
            |i, j| {
                if j < m { gamma0[(i, j)] } else { gamma1[(i, j - m)] }
            },
        );
        let mut forcing = Mat::<f64>::zeros(n, (STRIDE + 1) * m);
        let mut markov = Mat::<f64>::zeros(STRIDE * p, (STRIDE + 1) * m);
        let mut observation = Mat::<f64>::zeros(STRIDE * p, n);
        let mut row = system.c.clone();
        for k in 0..STRIDE {
            observation.submatrix_mut(k * p, 0, p, n).copy_from(&row);
            let seen = &system.c * &pulse;
            for j in 0..2 * m {
                // The step that begins at input l ends at l + 1: its second half belongs to that input.
                let (half, input) = (j / m.max(1), j % m.max(1));
                let last = (STRIDE - 1 - k + half) * m + input;
                for i in 0..n {
                    forcing[(i, last)] += pulse[(i, j)];
                }
                for l in 0..STRIDE {
                    let time = l + k + 1;
                    if time < STRIDE {
                        for i in 0..p {
                            markov[(time * p + i, (l + half) * m + input)] += seen[(i, j)];
                        }
                    }
                }
            }
            for j in 0..m {
                for i in 0..p {
                    markov[(k * p + i, k * m + j)] += system.d[(i, j)];
                }
            }
            row = &row * &phi;
            pulse = &phi * &pulse;
        }
        let mut transition = phi;
        for _ in 0..SQUARINGS {
            transition = &transition * &transition;
        }
        Ok(Self {
            states: n,
            inputs: m,
            outputs: p,
            transition: PreparedMatrix::new(transition.as_ref()),
            forcing: PreparedMatrix::new(forcing.as_ref()),
            observation: PreparedMatrix::new(observation.as_ref()),
            markov: PreparedMatrix::new(markov.as_ref()),
        })
    }

    /// Outputs from rest, one list per output, for one row of input values per sample.
    ///
    /// # Errors
    /// [`Error::InputWidth`] for a row of the wrong length.
    pub fn outputs(&self, inputs: &[Vec<f64>]) -> Result<Vec<Vec<f64>>> {
        let (m, p) = (self.inputs, self.outputs);
        if let Some((sample, row)) = inputs.iter().enumerate().find(|(_, row)| row.len() != m) {
            return Err(Error::InputWidth {
                sample,
                expected: m,
                found: row.len(),
            });
        }
        let mut series = vec![Vec::with_capacity(inputs.len()); p];
        let (mut x, mut next) = (vec![0.0; self.states], vec![0.0; self.states]);
        let (mut w, mut y) = (vec![0.0; (STRIDE + 1) * m], vec![0.0; STRIDE * p]);
        for first in (0..inputs.len()).step_by(STRIDE) {
            // Beyond the record the last input goes on: no output that is kept depends on it.
            for (k, u) in w.chunks_exact_mut(m.max(1)).enumerate() {
                if let Some(row) = inputs.get(first + k).or(inputs.last()) {
                    u.copy_from_slice(row);
                }
            }
            self.observation.mul_into(&x, &mut y);
            self.markov.mul_add_into(&w, &mut y);
            for values in y.chunks_exact(p.max(1)).take(inputs.len() - first) {
                for (series, value) in series.iter_mut().zip(values) {
                    series.push(*value);
                }
            }
            self.transition.mul_into(&x, &mut next);
            self.forcing.mul_add_into(&w, &mut next);
            std::mem::swap(&mut x, &mut next);
        }
        Ok(series)
    }
}
