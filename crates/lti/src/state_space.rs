//! State space with named signals: x' = A x + B u, y = C x + D u.

use std::collections::HashSet;

use albatross_numerics::matrix::{check_finite, to_rows};
use albatross_numerics::solve::Lu;
use albatross_numerics::{Mat, MatRef, eigen};
use serde::{Deserialize, Serialize};

use crate::error::SignalKind;
use crate::{Error, Result};

/// Name and unit of a state, input or output.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Signal {
    /// Name, unique among the signals of its kind.
    pub name: String,
    /// Unit as text, "1" for a ratio.
    pub unit: String,
}

impl Signal {
    /// A signal with this name and unit.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
        }
    }
}

/// A linear time-invariant system with named states, inputs and outputs.
///
/// In JSON the matrices are lists of rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Rows", try_from = "Rows")]
pub struct StateSpace {
    /// State matrix, states x states.
    pub a: Mat<f64>,
    /// Input matrix, states x inputs.
    pub b: Mat<f64>,
    /// Output matrix, outputs x states.
    pub c: Mat<f64>,
    /// Feed-through matrix, outputs x inputs.
    pub d: Mat<f64>,
    /// Names of the states, in the order of the rows of A.
    pub states: Vec<Signal>,
    /// Names of the inputs, in the order of the columns of B.
    pub inputs: Vec<Signal>,
    /// Names of the outputs, in the order of the rows of C.
    pub outputs: Vec<Signal>,
}

impl StateSpace {
    /// Joins matrices and names after checking that they belong together.
    ///
    /// # Errors
    /// [`Error::Shape`], [`Error::DuplicateName`], [`Error::Numerics`] for entries that are not finite.
    pub fn try_new(
        (a, b, c, d): (Mat<f64>, Mat<f64>, Mat<f64>, Mat<f64>),
        states: Vec<Signal>,
        inputs: Vec<Signal>,
        outputs: Vec<Signal>,
    ) -> Result<Self> {
        let system = Self {
            a,
            b,
            c,
            d,
            states,
            inputs,
            outputs,
        };
        system.check()?;
        Ok(system)
    }

    /// Whether matrices and names belong together, as [`StateSpace::try_new`] asks for: the fields are open, and may have
    /// been changed since. Every function that takes a system begins with it.
    ///
    /// # Errors
    /// [`Error::Shape`], [`Error::DuplicateName`], [`Error::Numerics`] for entries that are not finite.
    pub fn check(&self) -> Result<()> {
        let (nx, nu, ny) = (self.states.len(), self.inputs.len(), self.outputs.len());
        let wanted: [(&'static str, MatRef<'_, f64>, (usize, usize)); 4] = [
            ("A", self.a.as_ref(), (nx, nx)),
            ("B", self.b.as_ref(), (nx, nu)),
            ("C", self.c.as_ref(), (ny, nx)),
            ("D", self.d.as_ref(), (ny, nu)),
        ];
        for (matrix, m, expected) in wanted {
            let found = (m.nrows(), m.ncols());
            if found != expected {
                return Err(Error::Shape {
                    matrix,
                    expected,
                    found,
                    states: nx,
                    inputs: nu,
                    outputs: ny,
                });
            }
            check_finite(matrix, m)?;
        }
        for (kind, signals) in [
            (SignalKind::State, &self.states),
            (SignalKind::Input, &self.inputs),
            (SignalKind::Output, &self.outputs),
        ] {
            let mut seen = HashSet::new();
            if let Some(signal) = signals.iter().find(|s| !seen.insert(&s.name)) {
                return Err(Error::DuplicateName {
                    kind,
                    name: signal.name.clone(),
                });
            }
        }
        Ok(())
    }

    /// A system with the names x1, x2, ..., u1, ..., y1, ... and unit "1".
    ///
    /// # Errors
    /// As [`StateSpace::try_new`].
    pub fn unnamed(a: Mat<f64>, b: Mat<f64>, c: Mat<f64>, d: Mat<f64>) -> Result<Self> {
        let numbered = |letter: &str, n: usize| {
            (1..=n)
                .map(|i| Signal::new(format!("{letter}{i}"), "1"))
                .collect()
        };
        let (x, u, y) = (
            numbered("x", a.nrows()),
            numbered("u", d.ncols()),
            numbered("y", d.nrows()),
        );
        Self::try_new((a, b, c, d), x, u, y)
    }

    /// Position of a state.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are.
    pub fn state_index(&self, name: &str) -> Result<usize> {
        index_of(SignalKind::State, &self.states, name)
    }

    /// Position of an input.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are.
    pub fn input_index(&self, name: &str) -> Result<usize> {
        index_of(SignalKind::Input, &self.inputs, name)
    }

    /// Position of an output.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are.
    pub fn output_index(&self, name: &str) -> Result<usize> {
        index_of(SignalKind::Output, &self.outputs, name)
    }

    /// The system from the named inputs to the named outputs, in the order given, with all states.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`], [`Error::DuplicateName`], those of [`StateSpace::check`].
    pub fn select(&self, inputs: &[&str], outputs: &[&str]) -> Result<Self> {
        self.check()?;
        let u = inputs
            .iter()
            .map(|name| self.input_index(name))
            .collect::<Result<Vec<_>>>()?;
        let y = outputs
            .iter()
            .map(|name| self.output_index(name))
            .collect::<Result<Vec<_>>>()?;
        let n = self.states.len();
        Self::try_new(
            (
                self.a.clone(),
                Mat::from_fn(n, u.len(), |i, j| self.b[(i, u[j])]),
                Mat::from_fn(y.len(), n, |i, j| self.c[(y[i], j)]),
                Mat::from_fn(y.len(), u.len(), |i, j| self.d[(y[i], u[j])]),
            ),
            self.states.clone(),
            u.iter().map(|&i| self.inputs[i].clone()).collect(),
            y.iter().map(|&i| self.outputs[i].clone()).collect(),
        )
    }

    /// All eigenvalues in the left half plane, strictly: an integrator is not stable.
    ///
    /// # Errors
    /// [`Error::Numerics`] when the eigenvalues cannot be found.
    pub fn is_stable(&self) -> Result<bool> {
        Ok(eigen::eigenvalues(self.a.as_ref())?
            .iter()
            .all(|value| value.re < 0.0))
    }

    /// The system whose outputs feed the inputs of `next`: y = next(self(u)).
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless the outputs here are as many as the inputs there.
    pub fn series(&self, next: &Self) -> Result<Self> {
        self.check()?;
        next.check()?;
        if self.outputs.len() != next.inputs.len() {
            let (left, right) = (self.outputs.len(), next.inputs.len());
            return Err(Error::Mismatch {
                joint: "series connection",
                left,
                right,
            });
        }
        let a = blocks(&[
            &[Some(&self.a), None],
            &[Some(&(&next.b * &self.c)), Some(&next.a)],
        ]);
        let b = blocks(&[&[Some(&self.b)], &[Some(&(&next.b * &self.d))]]);
        let c = blocks(&[&[Some(&(&next.d * &self.c)), Some(&next.c)]]);
        let states = joined_states(&self.states, &next.states);
        Self::try_new(
            (a, b, c, &next.d * &self.d),
            states,
            self.inputs.clone(),
            next.outputs.clone(),
        )
    }

    /// The sum of two systems on the same inputs: y = self(u) + other(u). Names are those of `self`.
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless inputs and outputs are equally many.
    pub fn parallel(&self, other: &Self) -> Result<Self> {
        self.check()?;
        other.check()?;
        for (joint, left, right) in [
            (
                "inputs of the parallel connection",
                self.inputs.len(),
                other.inputs.len(),
            ),
            (
                "outputs of the parallel connection",
                self.outputs.len(),
                other.outputs.len(),
            ),
        ] {
            if left != right {
                return Err(Error::Mismatch { joint, left, right });
            }
        }
        let a = blocks(&[&[Some(&self.a), None], &[None, Some(&other.a)]]);
        let b = blocks(&[&[Some(&self.b)], &[Some(&other.b)]]);
        let c = blocks(&[&[Some(&self.c), Some(&other.c)]]);
        let states = joined_states(&self.states, &other.states);
        Self::try_new(
            (a, b, c, &self.d + &other.d),
            states,
            self.inputs.clone(),
            self.outputs.clone(),
        )
    }

    /// The loop u = r - K y closed around this system, from r to y.
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless K takes all outputs and gives all inputs; [`Error::Numerics`] with a singular
    /// matrix when the direct paths make the loop ill-posed (I + D_K D singular).
    pub fn feedback(&self, controller: &Self) -> Result<Self> {
        self.check()?;
        controller.check()?;
        for (joint, left, right) in [
            (
                "outputs to the controller",
                self.outputs.len(),
                controller.inputs.len(),
            ),
            (
                "controller to the inputs",
                controller.outputs.len(),
                self.inputs.len(),
            ),
        ] {
            if left != right {
                return Err(Error::Mismatch { joint, left, right });
            }
        }
        let (g, k) = (self, controller);
        let nu = g.inputs.len();
        // u = E (r - Ck xk - Dk C x) with E = (I + Dk D)^-1.
        let e = Lu::new((Mat::<f64>::identity(nu, nu) + &k.d * &g.d).as_ref())?
            .solve(Mat::identity(nu, nu).as_ref())?;
        let u_x = -(&e * &k.d * &g.c);
        let u_k = -(&e * &k.c);
        // y = C x + D u drives the controller.
        let y_x = &g.c + &g.d * &u_x;
        let y_k = &g.d * &u_k;
        let y_r = &g.d * &e;
        let a = blocks(&[
            &[Some(&(&g.a + &g.b * &u_x)), Some(&(&g.b * &u_k))],
            &[Some(&(&k.b * &y_x)), Some(&(&k.a + &k.b * &y_k))],
        ]);
        let b = blocks(&[&[Some(&(&g.b * &e))], &[Some(&(&k.b * &y_r))]]);
        let c = blocks(&[&[Some(&y_x), Some(&y_k)]]);
        let states = joined_states(&g.states, &k.states);
        Self::try_new((a, b, c, y_r), states, g.inputs.clone(), g.outputs.clone())
    }

    /// Drops the states that no input reaches or that reach no output, judged by the pattern of zeros.
    ///
    /// The input-output behaviour is unchanged. Position and heading usually go: as integrators they would
    /// otherwise forbid a response at zero frequency to which they contribute nothing. A system that fails its
    /// [`StateSpace::check`] comes back as it is.
    pub fn without_idle_states(&self) -> Self {
        if self.check().is_err() {
            return self.clone();
        }
        let n = self.states.len();
        let driven = reach(
            n,
            |i| (0..self.b.ncols()).any(|j| self.b[(i, j)] != 0.0),
            |from, to| self.a[(to, from)] != 0.0,
        );
        let seen = reach(
            n,
            |j| (0..self.c.nrows()).any(|i| self.c[(i, j)] != 0.0),
            |from, to| self.a[(from, to)] != 0.0,
        );
        let kept: Vec<usize> = (0..n).filter(|&i| driven[i] && seen[i]).collect();
        Self {
            a: Mat::from_fn(kept.len(), kept.len(), |i, j| self.a[(kept[i], kept[j])]),
            b: Mat::from_fn(kept.len(), self.b.ncols(), |i, j| self.b[(kept[i], j)]),
            c: Mat::from_fn(self.c.nrows(), kept.len(), |i, j| self.c[(i, kept[j])]),
            d: self.d.clone(),
            states: kept.iter().map(|&i| self.states[i].clone()).collect(),
            inputs: self.inputs.clone(),
            outputs: self.outputs.clone(),
        }
    }
}

pub(crate) fn index_of(kind: SignalKind, signals: &[Signal], name: &str) -> Result<usize> {
    signals
        .iter()
        .position(|s| s.name == name)
        .ok_or_else(|| Error::UnknownSignal {
            kind,
            name: name.to_owned(),
            known: signals
                .iter()
                .map(|s| s.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })
}

/// Nodes connected to the starting nodes along directed edges.
fn reach(n: usize, start: impl Fn(usize) -> bool, edge: impl Fn(usize, usize) -> bool) -> Vec<bool> {
    let mut reached: Vec<bool> = (0..n).map(start).collect();
    let mut frontier: Vec<usize> = (0..n).filter(|&i| reached[i]).collect();
    while let Some(from) = frontier.pop() {
        let next: Vec<usize> = (0..n).filter(|&to| !reached[to] && edge(from, to)).collect();
        next.iter().for_each(|&to| reached[to] = true);
        frontier.extend(next);
    }
    reached
}

/// Block matrix; `None` is a block of zeros sized by its neighbours.
fn blocks(rows: &[&[Option<&Mat<f64>>]]) -> Mat<f64> {
    let block_columns = rows.first().map_or(0, |row| row.len());
    let heights: Vec<usize> = rows
        .iter()
        .map(|row| row.iter().flatten().map(|m| m.nrows()).next().unwrap_or(0))
        .collect();
    let widths: Vec<usize> = (0..block_columns)
        .map(|j| {
            rows.iter()
                .filter_map(|row| row[j])
                .map(|m| m.ncols())
                .next()
                .unwrap_or(0)
        })
        .collect();
    let mut whole = Mat::zeros(heights.iter().sum(), widths.iter().sum());
    let mut top = 0;
    for (row, height) in rows.iter().zip(&heights) {
        let mut left = 0;
        for (block, width) in row.iter().zip(&widths) {
            if let Some(m) = block {
                whole
                    .as_mut()
                    .submatrix_mut(top, left, m.nrows(), m.ncols())
                    .copy_from(m);
            }
            left += width;
        }
        top += height;
    }
    whole
}

/// States of two systems in one list; a name taken already gets the suffix _2, _3, ...
fn joined_states(first: &[Signal], second: &[Signal]) -> Vec<Signal> {
    let mut all = first.to_vec();
    for signal in second {
        let mut name = signal.name.clone();
        let mut copy = 2;
        while all.iter().any(|s| s.name == name) {
            name = format!("{}_{copy}", signal.name);
            copy += 1;
        }
        all.push(Signal {
            name,
            unit: signal.unit.clone(),
        });
    }
    all
}

/// The form in files: matrices as lists of rows.
#[derive(Serialize, Deserialize)]
struct Rows {
    states: Vec<Signal>,
    inputs: Vec<Signal>,
    outputs: Vec<Signal>,
    a: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
    c: Vec<Vec<f64>>,
    d: Vec<Vec<f64>>,
}

impl From<StateSpace> for Rows {
    fn from(s: StateSpace) -> Self {
        let [a, b, c, d] = [&s.a, &s.b, &s.c, &s.d].map(|m| to_rows(m.as_ref()));
        Self {
            states: s.states,
            inputs: s.inputs,
            outputs: s.outputs,
            a,
            b,
            c,
            d,
        }
    }
}

impl TryFrom<Rows> for StateSpace {
    type Error = Error;

    fn try_from(r: Rows) -> Result<Self> {
        let (nx, nu, ny) = (r.states.len(), r.inputs.len(), r.outputs.len());
        // A matrix without rows says nothing about its columns: the names do.
        let read = |matrix: &'static str, rows: &[Vec<f64>], expected: (usize, usize)| {
            let ragged = rows.iter().map(Vec::len).find(|&len| len != expected.1);
            if rows.len() != expected.0 || ragged.is_some() {
                let found = (rows.len(), ragged.unwrap_or(expected.1));
                return Err(Error::Shape {
                    matrix,
                    expected,
                    found,
                    states: nx,
                    inputs: nu,
                    outputs: ny,
                });
            }
            Ok(Mat::from_fn(expected.0, expected.1, |i, j| rows[i][j]))
        };
        let a = read("A", &r.a, (nx, nx))?;
        let b = read("B", &r.b, (nx, nu))?;
        let c = read("C", &r.c, (ny, nx))?;
        let d = read("D", &r.d, (ny, nu))?;
        Self::try_new((a, b, c, d), r.states, r.inputs, r.outputs)
    }
}
