//! The recurrences of several blocks side by side.
//!
//! The next state of a block waits for its last one: one block alone leaves most of a processor idle. Blocks do not wait for
//! each other, so eight of one kind are stepped at once, a lane each, compiled for the vector instructions found at run
//! time. Where a row of the equations stands for several samples, their sum is formed on the way: columns of all samples,
//! which nobody reads, are never written.

use albatross_numerics::faer::traits::pulp::{Arch, Simd, WithSimd};

use crate::filters::Sampled;

/// Blocks stepped at once.
pub(crate) const LANES: usize = 8;
/// Rows gathered before they are handed out to their columns.
const CHUNK: usize = 32;

type Lane = [f64; LANES];

/// What moves the blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Motion<'a> {
    /// Delayed inputs at the samples, one before the first and one after the last included; from rest.
    Forced(&'a [f64]),
    /// A unit rate at the first sample.
    Free,
}

/// How long.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Length {
    pub(crate) samples: usize,
    /// Samples in one row.
    pub(crate) block: usize,
}

/// Samples as rows: sums of `block` of them over the root of their number.
///
/// The equations are linear, so they hold for sums as for samples; white noise keeps its variance and smooth signals
/// their energy, at a fraction of the rows.
pub(crate) fn rows_of(samples: &[f64], block: usize) -> Vec<f64> {
    if block == 1 {
        return samples.to_vec();
    }
    samples
        .chunks(block)
        .map(|c| c.iter().sum::<f64>() / (c.len() as f64).sqrt())
        .collect()
}

/// The first N states over time of at most [`LANES`] blocks of order B: by block, then by state.
pub(crate) fn side_by_side<const N: usize, const B: usize>(
    members: &[&Sampled],
    motion: Motion<'_>,
    length: Length,
) -> Vec<Vec<Vec<f64>>> {
    let rows = length.samples.div_ceil(length.block);
    let lane = |of: &dyn Fn(&Sampled) -> f64| -> Lane {
        std::array::from_fn(|l| members.get(l).map_or(0.0, |block| of(block)))
    };
    // Not by `vec!`: clones of an empty vector have no room.
    let of_block = |_: &&Sampled| (0..N).map(|_| Vec::with_capacity(rows)).collect();
    let mut columns: Vec<Vec<Vec<f64>>> = members.iter().map(of_block).collect();
    Arch::new().dispatch(SideBySide::<N, B> {
        e: std::array::from_fn(|i| std::array::from_fn(|j| lane(&|block| block.e[i][j]))),
        taps: std::array::from_fn(|t| std::array::from_fn(|i| lane(&|block| block.taps[t][i]))),
        motion,
        length,
        columns: &mut columns,
    });
    columns
}

struct SideBySide<'a, const N: usize, const B: usize> {
    e: [[Lane; N]; N],
    taps: [[Lane; N]; 3],
    motion: Motion<'a>,
    length: Length,
    columns: &'a mut [Vec<Vec<f64>>],
}

impl<const N: usize, const B: usize> WithSimd for SideBySide<'_, N, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Length { samples, block } = self.length;
        let mut x = [[0.0; LANES]; N];
        if let Motion::Free = self.motion {
            x[B - 1] = [1.0; LANES];
        }
        let mut rows = [[[0.0; LANES]; N]; CHUNK];
        let (mut filled, mut k) = (0, 0);
        while k < samples {
            let end = (k + block).min(samples);
            let scale = 1.0 / ((end - k) as f64).sqrt();
            let mut sum = x;
            self.step(k, &mut x);
            for k in k + 1..end {
                for i in 0..N {
                    for l in 0..LANES {
                        sum[i][l] += x[i][l];
                    }
                }
                self.step(k, &mut x);
            }
            for i in 0..N {
                for l in 0..LANES {
                    rows[filled][i][l] = scale * sum[i][l];
                }
            }
            filled += 1;
            k = end;
            if filled == CHUNK || k == samples {
                for (l, columns) in self.columns.iter_mut().enumerate() {
                    for (i, column) in columns.iter_mut().enumerate() {
                        column.extend(rows[..filled].iter().map(|row| row[i][l]));
                    }
                }
                filled = 0;
            }
        }
    }
}

impl<const N: usize, const B: usize> SideBySide<'_, N, B> {
    /// From sample k to the next.
    #[inline(always)]
    fn step(&self, k: usize, x: &mut [Lane; N]) {
        let mut next = [[0.0; LANES]; N];
        if let Motion::Forced(inputs) = self.motion {
            for (tap, &u) in self.taps.iter().zip(&inputs[k..k + 3]) {
                for i in 0..N {
                    for l in 0..LANES {
                        next[i][l] = tap[i][l].mul_add(u, next[i][l]);
                    }
                }
            }
        }
        for (i, (next, row)) in next.iter_mut().zip(&self.e).enumerate() {
            for (e, x) in row.iter().zip(x.iter()).take((i / B + 1) * B) {
                for l in 0..LANES {
                    next[l] = e[l].mul_add(x[l], next[l]);
                }
            }
        }
        *x = next;
    }
}
