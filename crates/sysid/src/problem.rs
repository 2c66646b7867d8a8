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
use crate::lanes::rows_of;
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
    /// The columns side by side, those of `extra` last.
    pub(crate) fn matrix(&self, extra: &[&Vec<f64>]) -> Mat<f64> {
        let columns: Vec<&Vec<f64>> = self
            .local
            .iter()
            .chain(&self.own)
            .chain(&self.shared)
            .chain(extra.iter().copied())
            .collect();
        matrix(&columns)
    }
}

/// Columns side by side.
pub(crate) fn matrix(columns: &[&Vec<f64>]) -> Mat<f64> {
    let rows = columns.first().map_or(0, |c| c.len());
    let mut matrix = Mat::zeros(rows, columns.len());
    for (j, column) in columns.iter().enumerate() {
        matrix.col_as_slice_mut(j).copy_from_slice(column);
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

    /// Free motions of a record; none if its initial state is known.
    pub(crate) fn ring(&self, bank: &Bank, experiment: usize, wanted: bool, cascade: bool) -> Signals {
        if wanted {
            bank.ring(self.data.experiments[experiment].len(), cascade, self.block)
        } else {
            Signals::default()
        }
    }

    /// Columns of the initial state and the constant of a record with these free motions.
    pub(crate) fn local(&self, experiment: usize, ring: &Signals) -> Vec<Vec<f64>> {
        let record = &self.data.experiments[experiment];
        let mut local = ring.x.clone();
        if record.estimate_offset {
            local.push(rows_of(&vec![1.0; record.len()], self.block));
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
            let delayed = timing.delayed(&self.data.experiments[experiment].input);
            own.push(rows_of(&delayed, self.block));
        }
        own
    }

    /// A measured output.
    pub(crate) fn measured(&self, experiment: usize, output: usize) -> Vec<f64> {
        rows_of(&self.data.experiments[experiment].outputs[output], self.block)
    }

    /// The same with a row a sample.
    pub(crate) fn of_all_samples(&self) -> Self {
        Self {
            block: 1,
            ..self.clone()
        }
    }

    /// The best linear unknowns at a point.
    pub(crate) fn fit(&self, point: Point) -> Result<Fitted> {
        let timing = self.timing(point.delay);
        let bank = Bank::new(&point.blocks, timing)?;
        let freedom = Freedom::new(&point.blocks, self.zeros);
        let mut records = vec![Vec::new(); self.outputs()];
        let mut n_own = 0;
        for (e, experiment) in self.data.experiments.iter().enumerate() {
            let ring = self.ring(&bank, e, self.free_initial, false);
            let x = bank.respond(&experiment.input, false, self.block).x;
            let columns = Columns {
                local: self.local(e, &ring),
                own: self.own(e, x, &freedom, timing),
                shared: Vec::new(),
            };
            n_own = columns.own.len();
            for (o, of_output) in records.iter_mut().enumerate() {
                of_output.push(Record {
                    local: columns.local.len(),
                    matrix: columns.matrix(&[&self.measured(e, o)]),
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
        let mut records = vec![Vec::new(); self.outputs()];
        let (mut n_own, mut n_shared) = (0, 0);
        for (e, experiment) in self.data.experiments.iter().enumerate() {
            let ring = self.ring(&bank, e, self.free_initial, true);
            let forced = bank.respond(&experiment.input, true, self.block);
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
                    matrix: columns.matrix(&[&self.measured(e, o)]),
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
        let c = fitted.coefficients(o);
        let f = &fitted.unknowns.local[o][e];
        let rows = forced.x.first().map_or(0, Vec::len);
        let tangents = tangents(&fitted.point.blocks, self.zeros, &c);
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(c.len() + 1);
        let mut at = 0;
        for block in &fitted.point.blocks {
            let mut of_block = vec![vec![0.0; rows]; block.order()];
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
        let delayed = rows_of(&timing.delayed(input), self.block);
        let mut rate = vec![0.0; delayed.len()];
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
        let slope = rows_of(&timing.slope_with_delay(input), self.block);
        rate.iter()
            .zip(slope)
            .map(|(r, s)| dt * (direct * s - r))
            .collect()
    }

    /// The output of a fitted model for a record at every sample, initial state and constant included.
    pub(crate) fn predict(&self, fitted: &Fitted, e: usize) -> Result<Vec<Vec<f64>>> {
        let timing = self.timing(fitted.point.delay);
        let bank = Bank::new(&fitted.point.blocks, timing)?;
        let every = self.of_all_samples();
        let ring = every.ring(&bank, e, self.free_initial, false);
        let x = bank.respond(&self.data.experiments[e].input, false, 1).x;
        let (local, own) = (every.local(e, &ring), every.own(e, x, &fitted.freedom, timing));
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
