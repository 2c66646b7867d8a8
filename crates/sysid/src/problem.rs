//! The output-error problem: which columns the unknowns of a model have in the data.
//!
//! For a denominator theta (and a delay) the model is linear in all else,
//! ```text
//! y(e, o) = X(theta) c(o) + d(o) u + F(theta) f(e, o) + offset(e, o)
//! ```
//! with the block states X, the free motions F of an unknown initial state, and constants where asked for. The
//! derivative with respect to theta needs no more than the cascade of each block, since for y_i, the part of the output
//! that block i gives,
//! ```text
//! dy/da1 = -(s/D_i) y_i,     dy/da0 = -(1/D_i) y_i,     dy/da = -(1/D_i) y_i.
//! ```
//! Parameters are counted in units of the block's scale w: da1 = w dp, da0 = w^2 dp, da = w dp.

use albatross_numerics::Mat;
use albatross_numerics::matrix::axpy;

use crate::blocks::Block;
use crate::elimination::{Elimination, Record, Unknowns};
use crate::filters::{Bank, Signals, Timing};
use crate::numerator::{Freedom, combine, tangents};
use crate::{DataSet, Result};

/// The unknowns that enter non-linearly.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Point {
    pub(crate) blocks: Vec<Block>,
    /// Transport delay \[s\].
    pub(crate) delay: f64,
}

impl Point {
    pub(crate) fn is_stable(&self) -> bool {
        self.blocks.iter().all(|b| b.is_stable())
    }

    /// Finite, with coefficients that the filters can represent.
    pub(crate) fn is_usable(&self) -> bool {
        let fine = |v: f64| v.is_finite() && v.abs() < 1e150;
        self.delay.is_finite()
            && self.blocks.iter().all(|b| match *b {
                Block::First { a } => fine(a),
                Block::Second { a1, a0 } => fine(a1) && fine(a0),
            })
    }
}

/// What is fixed while a model is sought.
#[derive(Debug, Clone)]
pub(crate) struct Problem<'a> {
    pub(crate) data: &'a DataSet,
    /// Number of zeros, at most that of the poles.
    pub(crate) zeros: usize,
    /// Whether every record has an initial state of its own.
    pub(crate) free_initial: bool,
    /// Whether the delay is an unknown.
    pub(crate) free_delay: bool,
    /// Samples in one row of the equations; 1 for all of them.
    pub(crate) block: usize,
    /// Root of the weight, by output and experiment.
    pub(crate) factors: Vec<Vec<f64>>,
}

/// A point with its best linear unknowns.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub(crate) point: Point,
    /// Own: free numerator coefficients, then the direct path. Local: initial state, then the constant.
    pub(crate) unknowns: Unknowns,
    pub(crate) freedom: Freedom,
}

impl Fitted {
    pub(crate) fn cost(&self) -> f64 {
        self.unknowns.cost
    }

    /// Coefficients of the states for an output.
    pub(crate) fn coefficients(&self, output: usize) -> Vec<f64> {
        self.freedom.expand(&self.unknowns.own[output])
    }

    /// The direct path of an output.
    pub(crate) fn direct(&self, output: usize) -> f64 {
        self.unknowns.own[output]
            .get(self.freedom.count())
            .copied()
            .unwrap_or(0.0)
    }
}

/// Columns of one record.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    pub(crate) local: Vec<Vec<f64>>,
    pub(crate) own: Vec<Vec<f64>>,
    pub(crate) shared: Vec<Vec<f64>>,
}

impl Columns {
    /// Rows of means over blocks of samples, the columns `extra` last.
    pub(crate) fn matrix(&self, extra: &[&Vec<f64>], block: usize) -> Mat<f64> {
        let columns: Vec<&Vec<f64>> = self
            .local
            .iter()
            .chain(&self.own)
            .chain(&self.shared)
            .chain(extra.iter().copied())
            .collect();
        matrix(&columns, block)
    }
}

/// Columns side by side, each `block` samples in one row: their sum over the root of their number.
///
/// The equations are linear, so they hold for sums as for samples; white noise keeps its variance and smooth signals
/// their energy, at a fraction of the rows.
pub(crate) fn matrix(columns: &[&Vec<f64>], block: usize) -> Mat<f64> {
    let rows = columns.first().map_or(0, |c| c.len().div_ceil(block));
    let mut matrix = Mat::zeros(rows, columns.len());
    for (j, column) in columns.iter().enumerate() {
        let to = matrix.col_as_slice_mut(j);
        if block == 1 {
            to.copy_from_slice(column);
        } else {
            for (t, samples) in to.iter_mut().zip(column.chunks(block)) {
                *t = samples.iter().sum::<f64>() / (samples.len() as f64).sqrt();
            }
        }
    }
    matrix
}

impl Problem<'_> {
    pub(crate) fn timing(&self, delay: f64) -> Timing {
        Timing::new(self.data.dt(), self.data.intersample, delay)
    }

    pub(crate) fn outputs(&self) -> usize {
        self.data.outputs.len()
    }

    /// Free motions for the longest record; none if the initial states are known.
    pub(crate) fn ring(&self, bank: &Bank, wanted: bool, cascade: bool) -> Signals {
        let longest = self.data.experiments.iter().map(|e| e.len()).max().unwrap_or(0);
        if wanted {
            bank.ring(longest, cascade)
        } else {
            Signals::default()
        }
    }

    /// Columns of the initial state and the constant of a record.
    pub(crate) fn local(&self, experiment: usize, ring: &Signals) -> Vec<Vec<f64>> {
        let record = &self.data.experiments[experiment];
        let mut local: Vec<Vec<f64>> = ring.x.iter().map(|x| x[..record.len()].to_vec()).collect();
        if record.estimate_offset {
            local.push(vec![1.0; record.len()]);
        }
        local
    }

    /// Columns of the numerator in a record.
    pub(crate) fn own(
        &self,
        experiment: usize,
        x: Vec<Vec<f64>>,
        freedom: &Freedom,
        timing: Timing,
    ) -> Vec<Vec<f64>> {
        let order = x.len();
        let mut own = freedom.columns(x);
        if self.zeros >= order {
            own.push(timing.delayed(&self.data.experiments[experiment].input));
        }
        own
    }

    /// The best linear unknowns at a point.
    pub(crate) fn fit(&self, point: Point) -> Result<Fitted> {
        let timing = self.timing(point.delay);
        let bank = Bank::new(&point.blocks, timing)?;
        let freedom = Freedom::new(&point.blocks, self.zeros);
        let ring = self.ring(&bank, self.free_initial, false);
        let mut records = vec![Vec::new(); self.outputs()];
        let mut n_own = 0;
        for (e, experiment) in self.data.experiments.iter().enumerate() {
            let x = bank.respond(&experiment.input, false).x;
            let columns = Columns {
                local: self.local(e, &ring),
                own: self.own(e, x, &freedom, timing),
                shared: Vec::new(),
            };
            n_own = columns.own.len();
            for (o, of_output) in records.iter_mut().enumerate() {
                of_output.push(Record {
                    local: columns.local.len(),
                    matrix: columns.matrix(&[&experiment.outputs[o]], self.block),
                    factor: self.factors[o][e],
                });
            }
        }
        let unknowns = Elimination::new(n_own, 0, records).solve(&[])?;
        Ok(Fitted {
            point,
            unknowns,
            freedom,
        })
    }

    /// The problem linearised about a fitted point: shared unknowns are the parameters of the denominator, block by
    /// block, then the delay in samples.
    pub(crate) fn linearise(&self, fitted: &Fitted) -> Result<Elimination> {
        let timing = self.timing(fitted.point.delay);
        let bank = Bank::new(&fitted.point.blocks, timing)?;
        let ring = self.ring(&bank, self.free_initial, true);
        let mut records = vec![Vec::new(); self.outputs()];
        let (mut n_own, mut n_shared) = (0, 0);
        for (e, experiment) in self.data.experiments.iter().enumerate() {
            let forced = bank.respond(&experiment.input, true);
            let mut columns = Columns {
                local: self.local(e, &ring),
                own: self.own(e, forced.x.clone(), &fitted.freedom, timing),
                shared: Vec::new(),
            };
            n_own = columns.own.len();
            for (o, of_output) in records.iter_mut().enumerate() {
                columns.shared = self.shared(fitted, e, o, &forced, &ring);
                n_shared = columns.shared.len();
                of_output.push(Record {
                    local: columns.local.len(),
                    matrix: columns.matrix(&[&experiment.outputs[o]], self.block),
                    factor: self.factors[o][e],
                });
            }
        }
        Ok(Elimination::new(n_own, n_shared, records))
    }

    /// Columns of the denominator's parameters, and of the delay, for an output of a record.
    pub(crate) fn shared(
        &self,
        fitted: &Fitted,
        e: usize,
        o: usize,
        forced: &Signals,
        ring: &Signals,
    ) -> Vec<Vec<f64>> {
        let experiment = &self.data.experiments[e];
        let c = fitted.coefficients(o);
        let f = &fitted.unknowns.local[o][e];
        let samples = experiment.len();
        let tangents = tangents(&fitted.point.blocks, self.zeros, &c);
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(c.len() + 1);
        let mut at = 0;
        for block in &fitted.point.blocks {
            let mut of_block = vec![vec![0.0; samples]; block.order()];
            derivatives(*block, forced, at, &c, &mut of_block);
            if !ring.x.is_empty() {
                derivatives(*block, ring, at, f, &mut of_block);
            }
            columns.extend(of_block);
            at += block.order();
        }
        for (column, dc) in columns.iter_mut().zip(&tangents) {
            let moved = combine(&forced.x, |i| dc[i]);
            column.iter_mut().zip(moved).for_each(|(v, m)| *v += m);
        }
        if self.free_delay {
            columns.push(self.delay_column(fitted, e, &c, fitted.direct(o), forced));
        }
        columns
    }

    /// dy/d(delay) times the sample time: minus the rate of the forced output.
    fn delay_column(&self, fitted: &Fitted, e: usize, c: &[f64], direct: f64, forced: &Signals) -> Vec<f64> {
        let timing = self.timing(fitted.point.delay);
        let input = &self.data.experiments[e].input;
        let dt = self.data.dt();
        let delayed = timing.delayed(input);
        let mut rate = vec![0.0; input.len()];
        let mut at = 0;
        for block in &fitted.point.blocks {
            let (a, b) = block.matrices();
            let n = block.order();
            for (c, (row, input)) in c[at..at + n].iter().zip(a.iter().zip(b)) {
                for (a, x) in row.iter().zip(&forced.x[at..at + n]) {
                    axpy(c * a, x, &mut rate);
                }
                axpy(c * input, &delayed, &mut rate);
            }
            at += n;
        }
        let slope = timing.slope_with_delay(input);
        rate.iter()
            .zip(slope)
            .map(|(r, s)| dt * (direct * s - r))
            .collect()
    }

    /// The output of a fitted model for a record, initial state and constant included.
    pub(crate) fn predict(&self, fitted: &Fitted, e: usize) -> Result<Vec<Vec<f64>>> {
        let timing = self.timing(fitted.point.delay);
        let bank = Bank::new(&fitted.point.blocks, timing)?;
        let ring = self.ring(&bank, self.free_initial, false);
        let x = bank.respond(&self.data.experiments[e].input, false).x;
        let (local, own) = (self.local(e, &ring), self.own(e, x, &fitted.freedom, timing));
        Ok((0..self.outputs())
            .map(|o| {
                let mut y = combine(&own, |i| fitted.unknowns.own[o][i]);
                for (column, f) in local.iter().zip(&fitted.unknowns.local[o][e]) {
                    axpy(*f, column, &mut y);
                }
                y
            })
            .collect())
    }
}

/// Adds the derivatives of a block's part of the output, whose states have the coefficients `c` from `at` on.
fn derivatives(block: Block, signals: &Signals, at: usize, c: &[f64], into: &mut [Vec<f64>]) {
    let w = block.scale();
    match block {
        Block::First { .. } => {
            for (v, r) in into[0].iter_mut().zip(&signals.r[at]) {
                *v -= c[at] * r;
            }
        }
        Block::Second { a1, a0 } => {
            let (c1, c2) = (c[at], c[at + 1]);
            let (f1, f0) = (a1 / w, a0 / (w * w));
            let (first, second) = into.split_at_mut(1);
            let states = signals.x[at].iter().zip(&signals.r[at]).zip(&signals.r[at + 1]);
            for ((a1, a0), ((x1, r1), r2)) in first[0].iter_mut().zip(&mut second[0]).zip(states) {
                // (w s/D) y_i and (w^2/D) y_i.
                *a1 -= c1 * r2 + c2 * (x1 - f1 * r2 - f0 * r1);
                *a0 -= c1 * r1 + c2 * r2;
            }
        }
    }
}
