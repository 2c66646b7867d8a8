//! Starting poles for the relocation.
//!
//! Lightly damped pairs spread evenly over the logarithm of the frequency, as vector fitting does (Gustavsen and Semlyen
//! 1999), between what the record can show at least and what the outputs hold. The upper end is uncertain, so several are
//! tried, each with and without instruments.

use std::f64::consts::PI;

use crate::DataSet;
use crate::blocks::Block;
use crate::estimate::{Delay, Initialisation, Options};
use crate::spectrum::{continued_spectrum, log_grid};

/// One start.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Start {
    /// Pairs spread over a band, then relocation.
    Spread {
        blocks: Vec<Block>,
        instruments: bool,
        band: [f64; 2],
        delay: f64,
    },
    /// One least-squares step from pairs spread over a band.
    Filters {
        blocks: Vec<Block>,
        band: [f64; 2],
        delay: f64,
    },
    /// Poles of a subspace identification.
    Subspace { delay: f64 },
    /// A denominator at hand.
    Given { blocks: Vec<Block>, delay: f64 },
}

impl Start {
    pub(crate) fn delay(&self) -> f64 {
        match self {
            Self::Spread { delay, .. }
            | Self::Filters { delay, .. }
            | Self::Subspace { delay }
            | Self::Given { delay, .. } => *delay,
        }
    }

    /// In words.
    pub(crate) fn description(&self) -> String {
        let band = |b: &[f64; 2]| format!("poles spread over {:.3} to {:.3} rad/s", b[0], b[1]);
        let name = match self {
            Self::Spread {
                instruments, band: b, ..
            } => {
                let how = if *instruments {
                    "instrumental variables"
                } else {
                    "least squares"
                };
                format!("{}, {how}", band(b))
            }
            Self::Filters { band: b, .. } => format!("state-variable filters, {}", band(b)),
            Self::Subspace { .. } => "subspace".to_owned(),
            Self::Given { .. } => "poles given".to_owned(),
        };
        if self.delay() > 0.0 {
            format!("{name}, delay {:.6} s", self.delay())
        } else {
            name
        }
    }
}

/// Damping ratio of the starting pairs.
const DAMPING: f64 = 0.05;
/// Upper ends of the band as multiples of the outputs' bandwidth.
const REACHES: [f64; 3] = [1.5, 1.0, 3.0];

/// All starts that the options ask for.
pub(crate) fn all(data: &DataSet, options: &Options) -> Vec<Start> {
    let delays = delays(data, options);
    let spread = |delay: f64| spread(data, options, delay);
    delays
        .iter()
        .flat_map(|&delay| {
            let filters = || {
                spread(delay).into_iter().filter_map(|s| match s {
                    Start::Spread {
                        blocks,
                        instruments: true,
                        band,
                        delay,
                    } => Some(Start::Filters { blocks, band, delay }),
                    _ => None,
                })
            };
            match &options.initialisation {
                Initialisation::Srivc => spread(delay),
                Initialisation::Svf => filters().collect(),
                Initialisation::Subspace => vec![Start::Subspace { delay }],
                Initialisation::Given(blocks) => vec![Start::Given {
                    blocks: blocks.clone(),
                    delay,
                }],
                Initialisation::All => {
                    let mut starts = spread(delay);
                    starts.extend(filters());
                    starts.push(Start::Subspace { delay });
                    starts
                }
            }
        })
        .collect()
}

/// Most delays from which a search begins.
const DELAYS: usize = 9;

/// Delays to begin with: the search moves them on.
fn delays(data: &DataSet, options: &Options) -> Vec<f64> {
    match options.delay {
        Delay::Fixed(delay) => vec![delay],
        Delay::UpTo(most) => {
            let samples = (most / data.dt()).floor() as usize;
            let count = (samples + 1).clamp(2, DELAYS);
            (0..count).map(|i| most * i as f64 / (count - 1) as f64).collect()
        }
    }
}

fn spread(data: &DataSet, options: &Options, delay: f64) -> Vec<Start> {
    let longest = data.longest();
    let nyquist = PI / data.dt();
    let low = (2.0 * PI / longest).min(0.1 * nyquist);
    let bandwidth = bandwidth(data).max(3.0 * low);
    let mut random = fastrand::Rng::with_seed(options.seed);
    (0..options.starts.max(1))
        .map(|i| {
            // The first six: three bands, with and without instruments. Then bands and dampings at random.
            let reach = REACHES[(i / 2) % 3];
            let (low, reach, damping) = if i < 6 {
                (low, reach, DAMPING)
            } else {
                (
                    low * 4_f64.powf(random.f64() - 0.5),
                    0.7 * 6_f64.powf(random.f64()),
                    0.01 * 30_f64.powf(random.f64()),
                )
            };
            let high = (reach * bandwidth).clamp(2.0 * low, 0.8 * nyquist);
            Start::Spread {
                blocks: blocks(options.poles, [low, high], damping),
                instruments: i % 2 == 0,
                band: [low, high],
                delay,
            }
        })
        .collect()
}

/// Pairs evenly over the logarithm of the frequency; an odd pole is real, at the lower end.
fn blocks(poles: usize, [low, high]: [f64; 2], damping: f64) -> Vec<Block> {
    let pairs = poles / 2;
    let mut blocks: Vec<Block> = (0..pairs)
        .map(|i| {
            let share = if pairs > 1 {
                i as f64 / (pairs - 1) as f64
            } else {
                0.5
            };
            let w = low * (high / low).powf(share);
            Block::Second {
                a1: 2.0 * damping * w,
                a0: w * w,
            }
        })
        .collect();
    if poles % 2 == 1 {
        blocks.insert(0, Block::First { a: low });
    }
    blocks
}

/// Share of the energy of an output's increments that its bandwidth holds.
const ENERGY: f64 = 0.98;
/// Frequencies looked at.
const LINES: usize = 120;

/// Angular frequency \[rad/s\] below which the outputs have nearly all of their energy, the largest of all outputs and
/// records.
///
/// The spectrum is weighted with the frequency, for a mode counts by its share in the acceleration and not in the
/// motion, and taken on a grid even over the logarithm.
pub(crate) fn bandwidth(data: &DataSet) -> f64 {
    let nyquist = PI / data.dt();
    let mut widest = 0.0_f64;
    for experiment in &data.experiments {
        let low = (2.0 * PI / experiment.duration()).min(0.5 * nyquist);
        let omega = log_grid(low, 0.95 * nyquist, LINES);
        for y in &experiment.outputs {
            let amplitude = continued_spectrum(y, experiment.dt, &omega);
            // Energy in a band of the logarithm: |Y|^2 w d(ln w).
            let energy: Vec<f64> = amplitude.iter().zip(&omega).map(|(a, w)| a * a * w).collect();
            let all: f64 = energy.iter().sum();
            let mut sum = 0.0;
            for (e, w) in energy.iter().zip(&omega) {
                sum += e;
                if sum >= ENERGY * all {
                    widest = widest.max(*w);
                    break;
                }
            }
        }
    }
    widest
}
