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
//! Equations: THEORY (26a).

use albatross_numerics::matrix::axpy;
use albatross_numerics::solve::ComplexLu;
use albatross_numerics::{C64, Mat};

use crate::frequency::at_pole;
use crate::{Error, Result, StateSpace};

/// Lags of one rate, condensed onto the rows they act on and the columns that drive them.
#[derive(Debug, Clone)]
struct Group {
    rate: f64,
    /// S_g on the active rows and columns, row after row.
    coupling: Vec<f64>,
}

/// A system with its lag states eliminated.
#[derive(Debug, Clone)]
pub(crate) struct LagReduced {
    core: usize,
    lags: usize,
    inputs: usize,
    outputs: usize,
    /// S0 = [Axx, Bx; Cx, D], row after row.
    direct: Vec<f64>,
    groups: Vec<Group>,
    /// Rows of S that the lags act on.
    rows: Vec<usize>,
    /// Columns of S that drive the lags.
    columns: Vec<usize>,
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
        let groups = by_rate
            .chunk_by(|&p, &q| system.a[(p, p)] == system.a[(q, q)])
            .map(|members| {
                let mut coupling = vec![0.0; rows.len() * columns.len()];
                for &z in members {
                    let drive: Vec<f64> = columns.iter().map(|&c| column_of(z, c)).collect();
                    for (line, &r) in coupling.chunks_exact_mut(columns.len().max(1)).zip(&rows) {
                        axpy(row_of(r, z), &drive, line);
                    }
                }
                Group {
                    rate: system.a[(members[0], members[0])],
                    coupling,
                }
            })
            .collect();
        Ok(Self {
            core: nc,
            lags: lags.len(),
            inputs: nu,
            outputs: ny,
            direct,
            groups,
            rows,
            columns,
        })
    }

    /// Number of states eliminated.
    pub(crate) fn lag_count(&self) -> usize {
        self.lags
    }

    /// H(s), outputs x inputs.
    pub(crate) fn evaluate(&self, s: C64) -> Result<Mat<C64>> {
        let (nc, nu, ny) = (self.core, self.inputs, self.outputs);
        let size = self.rows.len() * self.columns.len();
        let (mut re, mut im) = (vec![0.0; size], vec![0.0; size]);
        for group in &self.groups {
            let distance = s - group.rate;
            if distance.norm() <= 4.0 * f64::EPSILON * s.norm() {
                return Err(Error::PoleAtFrequency {
                    omega_rad_s: s.im,
                    re: s.re,
                    im: s.im,
                });
            }
            let weight = distance.inv();
            axpy(weight.re, &group.coupling, &mut re);
            axpy(weight.im, &group.coupling, &mut im);
        }
        let width = nc + nu;
        let mut whole: Vec<C64> = self.direct.iter().map(|&v| C64::new(v, 0.0)).collect();
        for (k, &r) in self.rows.iter().enumerate() {
            for (l, &c) in self.columns.iter().enumerate() {
                let at = k * self.columns.len() + l;
                whole[r * width + c] += C64::new(re[at], im[at]);
            }
        }
        let entry = |r: usize, c: usize| whole[r * width + c];
        let shifted = Mat::from_fn(nc, nc, |i, j| if i == j { s - entry(i, j) } else { -entry(i, j) });
        let b = Mat::from_fn(nc, nu, |i, j| entry(i, nc + j));
        let x = ComplexLu::new(shifted.as_ref())
            .and_then(|lu| lu.solve(b.as_ref()))
            .map_err(|e| at_pole(e, s))?;
        let c = Mat::from_fn(ny, nc, |i, j| entry(nc + i, j));
        Ok(&c * &x + Mat::from_fn(ny, nu, |i, j| entry(nc + i, nc + j)))
    }
}
