//! Exact responses of the blocks to sampled signals.
//!
//! Beside its states x a block carries r, the same filter driven by x1:
//! ```text
//! second order   r1 = w^2/D x1,   r2 = w s/D x1,   w s/D x2 = x1 - (a1/w) r2 - (a0/w^2) r1,   w^2/D x2 = r2
//! first order    r  = w/D x
//! ```
//! from which every derivative with respect to the denominator follows (see [`crate::refine`]). States and r are one
//! linear system, discretised once by the matrix exponential, so there is no error of integration whatever the
//! sample time (Franklin, Powell and Workman, Digital Control of Dynamic Systems, 3rd ed., sec. 4.3; foh: sec. 6.3).

use albatross_lti::exponential::exponential;
use albatross_numerics::Mat;

use crate::blocks::Block;
use crate::{Intersample, Result};

/// States of a second-order block with its cascade.
const MOST: usize = 4;

/// When samples act: sample time, behaviour between samples, transport delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Timing {
    dt: f64,
    hold: Intersample,
    /// Whole samples of the delay.
    whole: usize,
    /// Rest of the delay in samples, 0 to 1.
    rest: f64,
}

impl Timing {
    /// Timing with a transport delay in s, not negative.
    pub(crate) fn new(dt: f64, hold: Intersample, delay: f64) -> Self {
        let samples = (delay / dt).max(0.0);
        // A delay of whole samples must not become one short of rounding.
        let nearest = samples.round();
        let (whole, rest) = if (samples - nearest).abs() < 1e-9 {
            (nearest, 0.0)
        } else {
            (samples.floor(), samples - samples.floor())
        };
        Self {
            dt,
            hold,
            whole: whole as usize,
            rest,
        }
    }

    /// Delayed input at the sample times; at rest before the record.
    pub(crate) fn delayed(&self, input: &[f64]) -> Vec<f64> {
        (0..input.len())
            .map(|k| {
                let (now, before) = (self.at(input, k), self.before(input, k));
                match self.hold {
                    _ if self.rest == 0.0 => now,
                    Intersample::Zoh => before,
                    Intersample::Foh => now + self.rest * (before - now),
                }
            })
            .collect()
    }

    /// Slope of the delayed input with respect to the delay \[1/s\].
    pub(crate) fn slope_with_delay(&self, input: &[f64]) -> Vec<f64> {
        (0..input.len())
            .map(|k| match self.hold {
                Intersample::Zoh => 0.0,
                Intersample::Foh => (self.before(input, k) - self.at(input, k)) / self.dt,
            })
            .collect()
    }

    fn at(&self, input: &[f64], k: usize) -> f64 {
        k.checked_sub(self.whole)
            .and_then(|i| input.get(i))
            .copied()
            .unwrap_or(0.0)
    }

    fn before(&self, input: &[f64], k: usize) -> f64 {
        k.checked_sub(self.whole + 1)
            .and_then(|i| input.get(i))
            .copied()
            .unwrap_or(0.0)
    }

    fn after(&self, input: &[f64], k: usize) -> f64 {
        (k + 1)
            .checked_sub(self.whole)
            .and_then(|i| input.get(i))
            .copied()
            .unwrap_or(0.0)
    }
}

/// A block sampled: `x[k+1] = E x[k] + t0 u[k-1-n] + t1 u[k-n] + t2 u[k+1-n]` with a delay of n samples.
#[derive(Debug, Clone)]
pub(crate) struct Sampled {
    /// Poles of the block.
    order: usize,
    e: [[f64; MOST]; MOST],
    taps: [[f64; MOST]; 3],
    timing: Timing,
}

impl Sampled {
    /// Samples a block with its cascade.
    pub(crate) fn new(block: Block, timing: Timing) -> Result<Self> {
        let order = block.order();
        let states = 2 * order;
        let (a, b) = cascade(block);
        // exp of [A b 0; 0 0 1/dt; 0 0 0] L: transition over L, response to a constant, to a ramp of one a sample.
        let interval = |length: f64| {
            exponential(
                Mat::from_fn(states + 2, states + 2, |i, j| {
                    length
                        * match (i < states, j) {
                            (true, j) if j < states => a[i][j],
                            (true, j) if j == states => b[i],
                            (false, j) if i == states && j == states + 1 => 1.0 / timing.dt,
                            _ => 0.0,
                        }
                })
                .as_ref(),
            )
        };
        let second = interval((1.0 - timing.rest) * timing.dt)?;
        let column = |m: &Mat<f64>, j: usize| -> [f64; MOST] {
            std::array::from_fn(|i| if i < states { m[(i, j)] } else { 0.0 })
        };
        let transition = |m: &Mat<f64>| -> [[f64; MOST]; MOST] {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| if i < states && j < states { m[(i, j)] } else { 0.0 })
            })
        };
        let (constant, ramp) = (column(&second, states), column(&second, states + 1));
        let ramp = match timing.hold {
            Intersample::Zoh => [0.0; MOST],
            Intersample::Foh => ramp,
        };
        // Second part of the interval: u[k-n] + (u[k+1-n] - u[k-n]) s.
        let mut taps = [[0.0; MOST], subtract(constant, ramp), ramp];
        let mut e = transition(&second);
        if timing.rest > 0.0 {
            // First part: u[k-1-n] + (u[k-n] - u[k-1-n]) (1 - rest + s), then carried through the second part.
            let first = interval(timing.rest * timing.dt)?;
            let constant = multiply(&e, column(&first, states));
            let ramp = multiply(&e, column(&first, states + 1));
            let share = match timing.hold {
                Intersample::Zoh => [0.0; MOST],
                Intersample::Foh => std::array::from_fn(|i| (1.0 - timing.rest) * constant[i] + ramp[i]),
            };
            taps[0] = subtract(constant, share);
            taps[1] = std::array::from_fn(|i| taps[1][i] + share[i]);
            let first = transition(&first);
            e = std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..MOST).map(|k| e[i][k] * first[k][j]).sum())
            });
        }
        Ok(Self {
            order,
            e,
            taps,
            timing,
        })
    }

    /// Appends the states over time, starting from rest: x, and r if `cascade`.
    pub(crate) fn respond(&self, input: &[f64], cascade: bool, columns: &mut Vec<Vec<f64>>) {
        let samples = input.len();
        let input = Some(input);
        match (self.order, cascade) {
            (1, false) => self.run::<1>(input, [0.0; 1], samples, columns),
            (1, true) | (2, false) => self.run::<2>(input, [0.0; 2], samples, columns),
            _ => self.run::<4>(input, [0.0; 4], samples, columns),
        }
    }

    /// Appends the free motion from unit rate: the states of a block struck at the first sample.
    ///
    /// Numerators of degree below the block's order span all its free motions, so x alone does.
    pub(crate) fn ring(&self, samples: usize, cascade: bool, columns: &mut Vec<Vec<f64>>) {
        match (self.order, cascade) {
            (1, false) => self.run::<1>(None, [1.0], samples, columns),
            (1, true) => self.run::<2>(None, [1.0, 0.0], samples, columns),
            (_, false) => self.run::<2>(None, [0.0, 1.0], samples, columns),
            _ => self.run::<4>(None, [0.0, 1.0, 0.0, 0.0], samples, columns),
        }
    }

    /// The first N states; E is lower triangular by blocks, so they do not depend on the others.
    fn run<const N: usize>(
        &self,
        input: Option<&[f64]>,
        start: [f64; N],
        samples: usize,
        columns: &mut Vec<Vec<f64>>,
    ) {
        let e: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| self.e[i][j]));
        let taps: [[f64; N]; 3] = self.taps.map(|tap| std::array::from_fn(|i| tap[i]));
        let mut out: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(samples));
        let mut x = start;
        for k in 0..samples {
            for (column, value) in out.iter_mut().zip(x) {
                column.push(value);
            }
            let mut next: [f64; N] = std::array::from_fn(|i| (0..N).map(|j| e[i][j] * x[j]).sum());
            if let Some(u) = input {
                let u1 = self.timing.at(u, k);
                // After the last sample nothing is asked for.
                let u2 = self.timing.after(u, k);
                let u0 = if self.timing.rest > 0.0 {
                    self.timing.before(u, k)
                } else {
                    0.0
                };
                for i in 0..N {
                    next[i] += taps[0][i] * u0 + taps[1][i] * u1 + taps[2][i] * u2;
                }
            }
            x = next;
        }
        columns.extend(out);
    }
}

/// State matrix and input column of a block with its cascade, states x then r.
fn cascade(block: Block) -> (Vec<Vec<f64>>, Vec<f64>) {
    let (a, b) = block.matrices();
    let n = a.len();
    let rows = (0..2 * n)
        .map(|i| {
            (0..2 * n)
                .map(|j| match (i < n, j < n) {
                    (true, true) => a[i][j],
                    (false, false) => a[i - n][j - n],
                    // r is driven by the first state.
                    (false, true) if j == 0 => b[i - n],
                    _ => 0.0,
                })
                .collect()
        })
        .collect();
    (rows, b.into_iter().chain(std::iter::repeat_n(0.0, n)).collect())
}

fn subtract(a: [f64; MOST], b: [f64; MOST]) -> [f64; MOST] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn multiply(e: &[[f64; MOST]; MOST], x: [f64; MOST]) -> [f64; MOST] {
    std::array::from_fn(|i| (0..MOST).map(|j| e[i][j] * x[j]).sum())
}

/// States of all blocks: `x` as they are, `r` of their cascades (empty if not asked for), in the order of the states.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signals {
    pub(crate) x: Vec<Vec<f64>>,
    pub(crate) r: Vec<Vec<f64>>,
}

impl Signals {
    fn take(&mut self, columns: Vec<Vec<f64>>, order: usize) {
        for (i, column) in columns.into_iter().enumerate() {
            if i < order {
                self.x.push(column);
            } else {
                self.r.push(column);
            }
        }
    }
}

/// All blocks of a denominator, sampled.
#[derive(Debug, Clone)]
pub(crate) struct Bank {
    sampled: Vec<Sampled>,
}

impl Bank {
    pub(crate) fn new(blocks: &[Block], timing: Timing) -> Result<Self> {
        let sampled = blocks
            .iter()
            .map(|block| Sampled::new(*block, timing))
            .collect::<Result<_>>()?;
        Ok(Self { sampled })
    }

    /// Responses to an input, from rest.
    pub(crate) fn respond(&self, input: &[f64], cascade: bool) -> Signals {
        self.gather(|sampled, columns| sampled.respond(input, cascade, columns))
    }

    /// Free motions.
    pub(crate) fn ring(&self, samples: usize, cascade: bool) -> Signals {
        self.gather(|sampled, columns| sampled.ring(samples, cascade, columns))
    }

    fn gather(&self, mut of: impl FnMut(&Sampled, &mut Vec<Vec<f64>>)) -> Signals {
        let mut signals = Signals::default();
        for sampled in &self.sampled {
            let mut columns = Vec::with_capacity(MOST);
            of(sampled, &mut columns);
            signals.take(columns, sampled.order);
        }
        signals
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocks::state_matrices;
    use albatross_lti::{StateSpace, simulate};

    const BLOCKS: [Block; 4] = [
        Block::Second { a1: 0.5, a0: 30.0 },
        Block::Second { a1: 9.0, a0: 8.0 },
        Block::Second { a1: 4.0, a0: 4.0 },
        Block::First { a: 0.7 },
    ];

    fn input(n: usize) -> Vec<f64> {
        (0..n)
            .map(|k| if k % 13 < 6 { 1.0 } else { -0.4 } + 0.01 * k as f64)
            .collect()
    }

    /// Against the exact simulation of the block's state space, states alone.
    #[test]
    fn val_states_match_the_state_space() {
        let u = input(120);
        for hold in [Intersample::Zoh, Intersample::Foh] {
            for block in BLOCKS {
                let (a, b) = state_matrices(&[block]);
                let n = block.order();
                let system = StateSpace::unnamed(
                    a,
                    Mat::from_fn(n, 1, |i, _| b[i]),
                    Mat::identity(n, n),
                    Mat::zeros(n, 1),
                )
                .unwrap();
                let samples: Vec<Vec<f64>> = u.iter().map(|v| vec![*v]).collect();
                let expected = simulate(&system, 0.05, &samples, None, hold.into()).unwrap();
                let signals = Bank::new(&[block], Timing::new(0.05, hold, 0.0))
                    .unwrap()
                    .respond(&u, true);
                for k in 0..u.len() {
                    for i in 0..n {
                        assert!((signals.x[i][k] - expected.outputs.row(k)[i]).abs() < 1e-12);
                    }
                }
            }
        }
    }

    /// A delay of 2.3 samples on a fine grid of a tenth of the step is one of 23 whole samples there.
    #[test]
    fn val_delays_between_samples() {
        let (n, fine) = (60, 10);
        // Before the record the input rests at zero.
        let mut u = input(n);
        u[0] = 0.0;
        for hold in [Intersample::Zoh, Intersample::Foh] {
            let between: Vec<f64> = (0..n * fine)
                .map(|k| {
                    let (i, f) = (k / fine, (k % fine) as f64 / fine as f64);
                    let next = u.get(i + 1).copied().unwrap_or(u[i]);
                    match hold {
                        Intersample::Zoh => u[i],
                        Intersample::Foh => u[i] + f * (next - u[i]),
                    }
                })
                .collect();
            for block in BLOCKS {
                let coarse = Bank::new(&[block], Timing::new(0.05, hold, 0.115))
                    .unwrap()
                    .respond(&u, true);
                let whole = Bank::new(&[block], Timing::new(0.005, hold, 0.115))
                    .unwrap()
                    .respond(&between, true);
                for k in 0..n {
                    for (c, f) in coarse
                        .x
                        .iter()
                        .chain(&coarse.r)
                        .zip(whole.x.iter().chain(&whole.r))
                    {
                        assert!((c[k] - f[k * fine]).abs() < 1e-11, "{block:?} {k}");
                    }
                }
            }
        }
    }

    /// r2 as the derivative of r1, and the identity for the cascade of x2.
    #[test]
    fn val_cascade_identities() {
        let block = BLOCKS[0];
        let (w, a1, a0) = (block.scale(), 0.5, 30.0);
        let u = input(4000);
        let timing = Timing::new(1e-3, Intersample::Foh, 0.0);
        let bank = Bank::new(&[block], timing).unwrap();
        let s = bank.respond(&u, true);
        // w s/D x2 by filtering x2 itself (linear between samples: second-order accurate).
        let again = bank.respond(&s.x[1], false);
        for k in 0..u.len() {
            let exact = s.x[0][k] - a1 / w * s.r[1][k] - a0 / (w * w) * s.r[0][k];
            assert!((again.x[1][k] - exact).abs() < 2e-5, "{k}");
            assert!((again.x[0][k] - s.r[1][k]).abs() < 2e-5, "{k}");
        }
    }
}
