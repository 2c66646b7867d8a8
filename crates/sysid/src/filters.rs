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
use crate::lanes::{LANES, Length, Motion, side_by_side};
use crate::{Intersample, Result};

/// States of a second-order block with its cascade.
pub(crate) const MOST: usize = 4;

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
        // A delay of any length: whole + 1 need not be a number.
        k.checked_sub(self.whole)
            .and_then(|i| i.checked_sub(1))
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
    /// Lower triangular by blocks of the order: states x do not depend on their cascade r.
    pub(crate) e: [[f64; MOST]; MOST],
    pub(crate) taps: [[f64; MOST]; 3],
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
        Ok(Self { order, e, taps })
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
///
/// A row stands for some samples, see [`rows_of`].
#[derive(Debug, Clone, Default)]
pub(crate) struct Signals {
    pub(crate) x: Vec<Vec<f64>>,
    pub(crate) r: Vec<Vec<f64>>,
}

/// All blocks of a denominator, sampled.
#[derive(Debug, Clone)]
pub(crate) struct Bank {
    sampled: Vec<Sampled>,
    timing: Timing,
}

impl Bank {
    pub(crate) fn new(blocks: &[Block], timing: Timing) -> Result<Self> {
        let sampled = blocks
            .iter()
            .map(|block| Sampled::new(*block, timing))
            .collect::<Result<_>>()?;
        Ok(Self { sampled, timing })
    }

    /// Responses to an input, from rest; `block` samples a row.
    pub(crate) fn respond(&self, input: &[f64], cascade: bool, block: usize) -> Signals {
        // One before the first sample and one after the last: inputs at k-1, k and k+1 are neighbours.
        let delayed: Vec<f64> = std::iter::once(0.0)
            .chain((0..=input.len()).map(|k| self.timing.at(input, k)))
            .collect();
        self.gather(Motion::Forced(&delayed), input.len(), cascade, block)
    }

    /// Free motions from unit rate, the states of a block struck at the first sample; `block` samples a row.
    ///
    /// Numerators of degree below the block's order span all its free motions, so x alone does.
    pub(crate) fn ring(&self, samples: usize, cascade: bool, block: usize) -> Signals {
        self.gather(Motion::Free, samples, cascade, block)
    }

    fn gather(&self, motion: Motion<'_>, samples: usize, cascade: bool, block: usize) -> Signals {
        let length = Length { samples, block };
        let mut of_block: Vec<Vec<Vec<f64>>> = vec![Vec::new(); self.sampled.len()];
        for order in [1, 2] {
            let alike: Vec<usize> = (0..self.sampled.len())
                .filter(|&i| self.sampled[i].order == order)
                .collect();
            for group in alike.chunks(LANES) {
                let members: Vec<&Sampled> = group.iter().map(|&i| &self.sampled[i]).collect();
                let columns = match (order, cascade) {
                    (1, false) => side_by_side::<1, 1>(&members, motion, length),
                    (1, true) => side_by_side::<2, 1>(&members, motion, length),
                    (_, false) => side_by_side::<2, 2>(&members, motion, length),
                    _ => side_by_side::<4, 2>(&members, motion, length),
                };
                for (&i, columns) in group.iter().zip(columns) {
                    of_block[i] = columns;
                }
            }
        }
        let mut signals = Signals::default();
        for (columns, sampled) in of_block.into_iter().zip(&self.sampled) {
            for (i, column) in columns.into_iter().enumerate() {
                if i < sampled.order {
                    signals.x.push(column);
                } else {
                    signals.r.push(column);
                }
            }
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
                    .respond(&u, true, 1);
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
                    .respond(&u, true, 1);
                let whole = Bank::new(&[block], Timing::new(0.005, hold, 0.115))
                    .unwrap()
                    .respond(&between, true, 1);
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
        let s = bank.respond(&u, true, 1);
        // w s/D x2 by filtering x2 itself (linear between samples: second-order accurate).
        let again = bank.respond(&s.x[1], false, 1);
        for k in 0..u.len() {
            let exact = s.x[0][k] - a1 / w * s.r[1][k] - a0 / (w * w) * s.r[0][k];
            assert!((again.x[1][k] - exact).abs() < 2e-5, "{k}");
            assert!((again.x[0][k] - s.r[1][k]).abs() < 2e-5, "{k}");
        }
    }
    /// Many blocks at once, several samples a row: each column is the sum of the one alone over the root of its terms, the
    /// last row of fewer samples; forced and free, with a delay between samples.
    #[test]
    fn val_rows_are_sums_of_samples() {
        let mut blocks: Vec<Block> = (0..11)
            .map(|i| Block::Second {
                a1: 0.3 + 0.1 * f64::from(i),
                a0: 9.0 + 8.0 * f64::from(i),
            })
            .collect();
        blocks.insert(4, BLOCKS[3]);
        let u = input(103);
        let bank = Bank::new(&blocks, Timing::new(0.05, Intersample::Foh, 0.115)).unwrap();
        for cascade in [false, true] {
            let of = |block| {
                let (forced, free) = (bank.respond(&u, cascade, block), bank.ring(103, cascade, block));
                let all = [forced.x, forced.r, free.x, free.r].concat();
                assert_eq!(all.len(), if cascade { 4 * 23 } else { 2 * 23 });
                all
            };
            for (each, summed) in of(1).iter().zip(of(4)) {
                assert_eq!(summed.len(), 26);
                for (row, samples) in summed.iter().zip(each.chunks(4)) {
                    let expected = samples.iter().sum::<f64>() / (samples.len() as f64).sqrt();
                    assert!((row - expected).abs() < 1e-13 * (1.0 + expected.abs()));
                }
            }
        }
        // A block is the same alone and beside others.
        let alone = Bank::new(&blocks[4..5], Timing::new(0.05, Intersample::Foh, 0.115)).unwrap();
        assert_eq!(alone.respond(&u, true, 1).x[0], bank.respond(&u, true, 1).x[8]);
    }
}
