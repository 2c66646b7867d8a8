//! Elimination of states whose block in A is diagonal: the lags of unsteady strip aerodynamics.
//!
//! With core states x, lag states z and outputs y,
//! ```text
//! s x = Axx x + Axz z + Bx u
//! s z = Azx x + diag(l) z + Bz u          z = (s - l)^-1 (Azx x + Bz u)
//!   y = Cx x + Cz z + D u
//! ```
//! so that [sx; y] = (S0 + sum_g w_g(s) S_g) [x; u] with one real matrix S_g = [Axz; Cz]_g [Azx, Bz]_g per
//! distinct rate l_g and w_g = 1/(s - l_g). Only a matrix of the order of the core is factorised.
//!
//! Lags whose S_g differ by a factor alone, as the two of one strip do, share one matrix and add up their weights. States
//! that integrate one other core state, `s x_i = a x_j` (modal amplitudes are integrals of their rates), are put in by
//! substitution, so that a matrix of half the order is left. Frequencies are taken in batches: the sum over g for all of
//! them is one matrix product.
//!
//! Equations: THEORY (26a).

use albatross_numerics::faer::linalg::solvers::{PartialPivLu, Solve};
use albatross_numerics::matrix::axpy;
use albatross_numerics::solve::ComplexLu;
use albatross_numerics::{C64, Mat};

use crate::frequency::at_pole;
use crate::{Error, Result, StateSpace};

/// Frequencies evaluated together.
const BATCH: usize = 16;
/// Two condensed matrices are one times a factor if no entry differs by more than this share of the largest.
const ALIKE: f64 = 1e-14;
/// Ratio of pivots from which on the equilibrated factorisation with its condition estimate decides.
const LEAST_PIVOT: f64 = 1e-9;

/// Most numbers of the matrices of all rates, 0.5 GB.
const MOST_NUMBERS: usize = 1 << 26;

/// Lags that share a matrix: their rates with the factor of each.
type Shared = Vec<(f64, f64)>;

/// A system with its lag states eliminated.
#[derive(Debug, Clone)]
pub(crate) struct LagReduced {
    core: usize,
    lags: usize,
    inputs: usize,
    outputs: usize,
    /// S0 = [Axx, Bx; Cx, D], row after row.
    direct: Vec<f64>,
    groups: Vec<Shared>,
    /// S_g on the active rows and columns, row after row; one column per group.
    coupling: Mat<f64>,
    /// Rows of S that the lags act on.
    rows: Vec<usize>,
    /// Columns of S that drive the lags.
    columns: Vec<usize>,
    /// Integrators of one other core state: which, of which, and the coefficient.
    integrators: Vec<(usize, usize, f64)>,
    /// Core states that are none.
    kept: Vec<usize>,
}

impl LagReduced {
    /// Eliminates a largest set of mutually uncoupled states found greedily: of the states left, the one with
    /// the fewest couplings joins, its neighbours leave.
    pub(crate) fn detect(system: &StateSpace) -> Result<Self> {
        let n = system.states.len();
        let coupled = |i: usize, j: usize| i != j && (system.a[(i, j)] != 0.0 || system.a[(j, i)] != 0.0);
        let neighbours = |i: usize| (0..n).filter(move |&j| coupled(i, j));
        let mut degree: Vec<usize> = (0..n).map(|i| neighbours(i).count()).collect();
        // An integrator (rate 0) would put a false pole at zero frequency.
        let mut candidate: Vec<bool> = (0..n).map(|i| system.a[(i, i)] < 0.0).collect();
        let mut lags = Vec::new();
        while let Some(chosen) = (0..n).filter(|&i| candidate[i]).min_by_key(|&i| degree[i]) {
            lags.push(chosen);
            candidate[chosen] = false;
            let leaving: Vec<usize> = neighbours(chosen).filter(|&j| candidate[j]).collect();
            for &j in &leaving {
                candidate[j] = false;
                neighbours(j).for_each(|k| degree[k] -= 1);
            }
        }
        lags.sort_unstable();
        Self::new(system, &lags)
    }

    /// Eliminates the given states.
    pub(crate) fn new(system: &StateSpace, lags: &[usize]) -> Result<Self> {
        let n = system.states.len();
        let (nu, ny) = (system.inputs.len(), system.outputs.len());
        let name = |k: usize| &system.states[k].name;
        let refuse = |reason| Error::Method {
            method: "the elimination of lag states",
            reason,
        };
        for &i in lags {
            if system.a[(i, i)] == 0.0 {
                return Err(refuse(format!("state \"{}\" is an integrator", name(i))));
            }
            if let Some(&j) = lags.iter().find(|&&j| j != i && system.a[(i, j)] != 0.0) {
                return Err(refuse(format!(
                    "state \"{}\" acts on state \"{}\"",
                    name(j),
                    name(i)
                )));
            }
        }
        let core: Vec<usize> = (0..n).filter(|i| lags.binary_search(i).is_err()).collect();
        let nc = core.len();

        // Rows of [A; C] and columns of [A, B], core first.
        let row_of = |r: usize, j: usize| {
            if r < nc {
                system.a[(core[r], j)]
            } else {
                system.c[(r - nc, j)]
            }
        };
        let column_of = |i: usize, c: usize| {
            if c < nc {
                system.a[(i, core[c])]
            } else {
                system.b[(i, c - nc)]
            }
        };
        let mut direct = Vec::with_capacity((nc + ny) * (nc + nu));
        for r in 0..nc + ny {
            for c in 0..nc + nu {
                direct.push(match (r < nc, c < nc) {
                    (_, true) => row_of(r, core[c]),
                    (true, false) => system.b[(core[r], c - nc)],
                    (false, false) => system.d[(r - nc, c - nc)],
                });
            }
        }
        let rows: Vec<usize> = (0..nc + ny)
            .filter(|&r| lags.iter().any(|&j| row_of(r, j) != 0.0))
            .collect();
        let columns: Vec<usize> = (0..nc + nu)
            .filter(|&c| lags.iter().any(|&i| column_of(i, c) != 0.0))
            .collect();

        let mut by_rate = lags.to_vec();
        by_rate.sort_by(|&p, &q| system.a[(p, p)].total_cmp(&system.a[(q, q)]).then(p.cmp(&q)));
        // Modes of a structure, each with a rate of its own and tied to its own amplitude, are no lags in this sense.
        let rates = by_rate
            .chunk_by(|&p, &q| system.a[(p, p)] == system.a[(q, q)])
            .count();
        if rows.len().saturating_mul(columns.len()).saturating_mul(rates) > MOST_NUMBERS {
            return Err(refuse(format!(
                "{rates} rates couple {} rows with {} columns: choose LU",
                rows.len(),
                columns.len()
            )));
        }
        let condensed: Vec<(f64, Vec<f64>)> = by_rate
            .chunk_by(|&p, &q| system.a[(p, p)] == system.a[(q, q)])
            .map(|members| {
                let mut coupling = vec![0.0; rows.len() * columns.len()];
                for &z in members {
                    let drive: Vec<f64> = columns.iter().map(|&c| column_of(z, c)).collect();
                    for (line, &r) in coupling.chunks_exact_mut(columns.len().max(1)).zip(&rows) {
                        axpy(row_of(r, z), &drive, line);
                    }
                }
                (system.a[(members[0], members[0])], coupling)
            })
            .collect();
        let (groups, coupling) = shared(condensed, rows.len() * columns.len());
        let integrators = integrators(&direct, (nc, nu), &rows);
        let kept = (0..nc)
            .filter(|i| integrators.iter().all(|(integrator, ..)| integrator != i))
            .collect();
        Ok(Self {
            core: nc,
            lags: lags.len(),
            inputs: nu,
            outputs: ny,
            direct,
            groups,
            coupling,
            rows,
            columns,
            integrators,
            kept,
        })
    }

    /// Number of states eliminated.
    pub(crate) fn lag_count(&self) -> usize {
        self.lags
    }

    /// H(s), outputs x inputs, at each point.
    pub(crate) fn evaluate(&self, points: &[C64]) -> Result<Vec<Mat<C64>>> {
        let mut found = Vec::with_capacity(points.len());
        for batch in points.chunks(BATCH) {
            let mut weights = Mat::<f64>::zeros(self.groups.len(), 2 * batch.len());
            for (k, &s) in batch.iter().enumerate() {
                for (g, group) in self.groups.iter().enumerate() {
                    let weight = weight(group, s)?;
                    weights[(g, 2 * k)] = weight.re;
                    weights[(g, 2 * k + 1)] = weight.im;
                }
            }
            let through = &self.coupling * &weights;
            for (k, &s) in batch.iter().enumerate() {
                let (re, im) = (through.col_as_slice(2 * k), through.col_as_slice(2 * k + 1));
                found.push(self.at(s, re, im)?);
            }
        }
        Ok(found)
    }

    /// H(s) from the sum over the groups.
    fn at(&self, s: C64, re: &[f64], im: &[f64]) -> Result<Mat<C64>> {
        let width = self.core + self.inputs;
        let mut whole: Vec<C64> = self.direct.iter().map(|&v| C64::new(v, 0.0)).collect();
        for (k, &r) in self.rows.iter().enumerate() {
            for (l, &c) in self.columns.iter().enumerate() {
                let at = k * self.columns.len() + l;
                whole[r * width + c] += C64::new(re[at], im[at]);
            }
        }
        if s.norm() > 0.0 {
            let mut folded = whole.clone();
            for &(i, j, a) in &self.integrators {
                let factor = a / s;
                for line in folded.chunks_exact_mut(width) {
                    let add = line[i] * factor;
                    line[j] += add;
                }
            }
            if let Some(h) = self.solved(s, &folded) {
                return Ok(h);
            }
        }
        self.solved_with_care(s, &whole)
    }

    /// Without the integrators, by plain factors; none where a pivot is small.
    fn solved(&self, s: C64, whole: &[C64]) -> Option<Mat<C64>> {
        let (nc, nu, ny, n) = (self.core, self.inputs, self.outputs, self.kept.len());
        let entry = |r: usize, c: usize| whole[r * (nc + nu) + c];
        let shifted = Mat::from_fn(n, n, |i, j| {
            let value = -entry(self.kept[i], self.kept[j]);
            if i == j { s + value } else { value }
        });
        let lu = PartialPivLu::new(shifted.as_ref());
        let pivots = (0..n).map(|i| lu.U()[(i, i)].norm());
        let (least, largest) = pivots.fold((f64::INFINITY, 0.0_f64), |(l, m), p| (l.min(p), m.max(p)));
        // Also for a NaN.
        let fine = n == 0 || least > LEAST_PIVOT * largest;
        if !fine {
            return None;
        }
        let mut x = Mat::from_fn(n, nu, |i, j| entry(self.kept[i], nc + j));
        lu.solve_in_place(x.as_mut());
        Some(Mat::from_fn(ny, nu, |o, j| {
            let states = self.kept.iter().enumerate();
            let seen: C64 = states.map(|(k, &c)| entry(nc + o, c) * x[(k, j)]).sum();
            seen + entry(nc + o, nc + j)
        }))
    }

    /// The whole core, equilibrated, with an estimate of its condition.
    fn solved_with_care(&self, s: C64, whole: &[C64]) -> Result<Mat<C64>> {
        let (nc, nu, ny) = (self.core, self.inputs, self.outputs);
        let entry = |r: usize, c: usize| whole[r * (nc + nu) + c];
        let shifted = Mat::from_fn(nc, nc, |i, j| if i == j { s - entry(i, j) } else { -entry(i, j) });
        let b = Mat::from_fn(nc, nu, |i, j| entry(i, nc + j));
        let x = ComplexLu::new(shifted.as_ref())
            .and_then(|lu| lu.solve(b.as_ref()))
            .map_err(|e| at_pole(e, s))?;
        let c = Mat::from_fn(ny, nc, |i, j| entry(nc + i, j));
        Ok(&c * &x + Mat::from_fn(ny, nu, |i, j| entry(nc + i, nc + j)))
    }
}

/// Sum of the lags' factors over s - l.
fn weight(group: &Shared, s: C64) -> Result<C64> {
    let mut sum = C64::new(0.0, 0.0);
    for &(rate, factor) in group {
        let distance = s - rate;
        if distance.norm_sqr() <= (4.0 * f64::EPSILON).powi(2) * s.norm_sqr() {
            return Err(Error::PoleAtFrequency {
                omega_rad_s: s.im,
                re: s.re,
                im: s.im,
            });
        }
        sum += distance.conj() * (factor / distance.norm_sqr());
    }
    Ok(sum)
}

/// Puts rates together whose condensed matrices differ by a factor; one column per group.
fn shared(condensed: Vec<(f64, Vec<f64>)>, size: usize) -> (Vec<Shared>, Mat<f64>) {
    let peak = |v: &[f64]| {
        let largest =
            |best: (usize, f64), (i, v): (usize, &f64)| if v.abs() > best.1.abs() { (i, *v) } else { best };
        v.iter().enumerate().fold((0, 0.0), largest)
    };
    let mut groups: Vec<Shared> = Vec::new();
    // Matrices with the place and the value of their largest entry.
    let mut kept: Vec<(Vec<f64>, usize, f64)> = Vec::new();
    for (rate, coupling) in condensed {
        let (place, value) = peak(&coupling);
        let found = kept.iter().position(|(other, at, largest)| {
            // Of entries that are equal but for rounding either may be the largest.
            let factor = coupling[*at] / largest;
            value.abs() <= (1.0 + 1e-12) * coupling[*at].abs()
                && coupling
                    .iter()
                    .zip(other)
                    .all(|(c, o)| (c - factor * o).abs() <= ALIKE * value.abs())
        });
        match found {
            Some(k) => {
                let (_, at, largest) = &kept[k];
                groups[k].push((rate, coupling[*at] / largest));
            }
            None => {
                groups.push(vec![(rate, 1.0)]);
                kept.push((coupling, place, value));
            }
        }
    }
    let matrix = Mat::from_fn(size, kept.len(), |i, g| kept[g].0[i]);
    (groups, matrix)
}

/// Core states whose rate is another core state times a number, which is none of them itself.
fn integrators(direct: &[f64], (nc, nu): (usize, usize), rows: &[usize]) -> Vec<(usize, usize, f64)> {
    let mut found: Vec<(usize, usize, f64)> = Vec::new();
    let mut sources: Vec<usize> = Vec::new();
    for (i, line) in direct.chunks_exact((nc + nu).max(1)).take(nc).enumerate() {
        let mut entries = line.iter().enumerate().filter(|(_, v)| **v != 0.0);
        let (Some((j, &a)), None) = (entries.next(), entries.next()) else {
            continue;
        };
        let integrates = j != i && j < nc && !rows.contains(&i);
        if integrates && !sources.contains(&i) && found.iter().all(|(other, ..)| *other != j) {
            found.push((i, j, a));
            sources.push(j);
        }
    }
    found
}
