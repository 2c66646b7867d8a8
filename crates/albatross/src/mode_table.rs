//! The modes of the aircraft, told from lag roots by following them from the aircraft without coupling.

use crate::Error;
use crate::analysis::{Trimmed, with_fidelity};
use crate::model::Model;
use albatross_flight::Fidelity;
use albatross_flight::lag_form::diagonal_lag_form;
use albatross_lti::modes::{Mode, mode_table};
use albatross_lti::track::{TrackOptions, Tracker};
use albatross_lti::{LagForm, StateSpace, lags};
use albatross_numerics::{C64, Mat};
use serde::Serialize;

/// An aeroelastic mode, followed from the structural one.
#[derive(Debug, Clone, Serialize)]
pub struct AeroelasticMode {
    /// Rank of the structural mode in the basis, from 1.
    pub mode: usize,
    /// Frequency in vacuo \[rad/s\].
    pub in_vacuo_rad_s: f64,
    /// Frequency in the flow, modulus of the eigenvalue \[rad/s\].
    pub omega_rad_s: f64,
    /// Damping ratio in the flow.
    pub damping_ratio: f64,
    /// Real part of the eigenvalue \[1/s\].
    pub re: f64,
    /// Imaginary part \[rad/s\].
    pub im: f64,
    /// Least certainty of the steps by which it was followed, 1 is best.
    pub confidence: f64,
}

/// A rigid-body mode, followed from the rigid aircraft.
#[derive(Debug, Clone, Serialize)]
pub struct RigidBodyMode {
    /// Name.
    pub name: &'static str,
    /// Of the rigid aircraft.
    pub rigid: Mode,
    /// Of the flexible aircraft; none if it could not be followed.
    pub flexible: Option<Mode>,
}

/// Modes of the aircraft without lag roots.
#[derive(Debug, Clone, Serialize)]
pub struct ModeTable {
    /// Elastic modes in the order of the basis.
    pub elastic: Vec<AeroelasticMode>,
    /// Rigid-body modes.
    pub rigid_body: Vec<RigidBodyMode>,
}

/// The elastic and rigid-body modes of a linearised model, told from lag roots by following them from the structure
/// in vacuo and the rigid aircraft: along `A(t) = A_0 + t (A - A_0)`, where `A_0` holds both uncoupled.
///
/// # Errors
/// [`Error::Lti`] if a mode cannot be followed with certainty.
pub fn mode_table_without_lags(model: &Model, trimmed: &Trimmed) -> Result<ModeTable, Error> {
    let Ends {
        path,
        in_vacuo,
        named,
    } = ends(model, trimmed)?;
    let rigid_values: Vec<C64> = named.iter().map(|(_, value)| *value).collect();
    let (elastic, flexible) = path.follow_all(&in_vacuo, &rigid_values)?;
    let elastic = elastic
        .into_iter()
        .enumerate()
        .map(|(k, (value, confidence))| AeroelasticMode {
            mode: k + 1,
            in_vacuo_rad_s: model.basis.modes.get(k).map_or(0.0, |m| m.omega_rad_s),
            omega_rad_s: value.norm(),
            damping_ratio: -value.re / value.norm(),
            re: value.re,
            im: value.im,
            confidence,
        })
        .collect();
    let rigid_body = named
        .into_iter()
        .zip(flexible)
        .map(|((name, value), flexible)| RigidBodyMode {
            name,
            rigid: Mode::from_eigenvalue(value),
            flexible: flexible.map(Mode::from_eigenvalue),
        })
        .collect();
    Ok(ModeTable { elastic, rigid_body })
}

/// What the modes are followed from and to.
struct Ends {
    path: Path,
    /// Eigenvalues of the structure in vacuo.
    in_vacuo: Vec<C64>,
    /// Those of the rigid aircraft.
    named: Vec<(&'static str, C64)>,
}

fn ends(model: &Model, trimmed: &Trimmed) -> Result<Ends, Error> {
    let layout = trimmed.equations.layout();
    let rigid = with_fidelity(model, Fidelity::Rigid)?;
    let of_rigid = rigid.equations.layout();
    if (of_rigid.attitude, of_rigid.position) != (layout.attitude, layout.position) {
        let states = |n: usize, attitude| format!("{n} rigid-body states, attitude by {attitude:?}");
        return Err(Error::Mismatch {
            what: "trimmed model of the mode table".to_owned(),
            found: states(layout.n_rigid(), layout.attitude),
            expected: format!(
                "{}; trim with `analysis::trimmed`",
                states(of_rigid.n_rigid(), of_rigid.attitude)
            ),
        });
    }
    let moving = moving_states(&trimmed.system);
    let n_rigid = moving.iter().filter(|&&i| i < layout.n_rigid()).count();
    let rigid_a = pick(&rigid.system.a, &moving[..n_rigid]);
    let uncoupled = StateSpace::try_new(
        without_signals(uncoupled_matrix(model, trimmed, &rigid.system.a)),
        trimmed.system.states.clone(),
        Vec::new(),
        Vec::new(),
    )?;
    let path = Path {
        from: moving_matrix(&uncoupled, trimmed)?,
        to: moving_matrix(&trimmed.system, trimmed)?,
        lags: lags_of(trimmed),
    };
    let rigid_names: Vec<&str> = moving[..n_rigid]
        .iter()
        .map(|&i| trimmed.system.states[i].name.as_str())
        .collect();
    let in_vacuo = model
        .basis
        .modes
        .iter()
        .zip(&model.damping)
        .take(layout.n_modes)
        .map(|(m, xi)| C64::new(-xi, (1.0 - xi * xi).sqrt()) * m.omega_rad_s)
        .collect();
    Ok(Ends {
        path,
        in_vacuo,
        named: name_rigid_modes(&rigid_a, &rigid_names)?,
    })
}

/// States without heading and position, which move nothing: without them the matrix has no defective zero eigenvalues.
fn moving_states(system: &StateSpace) -> Vec<usize> {
    let idle = ["psi", "north", "east"];
    let moving = |i: &usize| !idle.contains(&system.states[*i].name.as_str());
    (0..system.states.len()).filter(moving).collect()
}

/// The state matrix of the moving states, with lags that do not act on each other.
pub(crate) fn moving_matrix(system: &StateSpace, trimmed: &Trimmed) -> Result<Mat<f64>, Error> {
    let system = diagonal_lag_form(system, &trimmed.equations, trimmed.trim.speed())?;
    Ok(pick(&system.a, &moving_states(&system)))
}

/// Indices of the lags among the moving states: they are the last.
pub(crate) fn lags_of(trimmed: &Trimmed) -> Vec<usize> {
    let (n, lags) = (
        moving_states(&trimmed.system).len(),
        trimmed.equations.layout().lags().len(),
    );
    (n - lags..n).collect()
}

fn pick(a: &Mat<f64>, rows: &[usize]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows.len(), |i, j| a[(rows[i], rows[j])])
}

/// Matrices of a system without inputs and outputs.
fn without_signals(a: Mat<f64>) -> (Mat<f64>, Mat<f64>, Mat<f64>, Mat<f64>) {
    let n = a.nrows();
    (a, Mat::zeros(n, 0), Mat::zeros(0, n), Mat::zeros(0, 0))
}

/// Rigid aircraft, structure in vacuo and lags, none of which act on each other.
fn uncoupled_matrix(model: &Model, trimmed: &Trimmed, rigid: &Mat<f64>) -> Mat<f64> {
    let layout = trimmed.equations.layout();
    let (n_states, n_rigid) = (layout.n_states(), layout.n_rigid());
    let mut a = Mat::zeros(n_states, n_states);
    a.as_mut().submatrix_mut(0, 0, n_rigid, n_rigid).copy_from(rigid);
    let modes = model.basis.modes.iter().zip(&model.damping);
    for ((eta, etad), (mode, xi)) in layout.eta().zip(layout.eta_rate()).zip(modes) {
        a[(eta, etad)] = 1.0;
        a[(etad, eta)] = -mode.omega_rad_s.powi(2);
        a[(etad, etad)] = -2.0 * xi * mode.omega_rad_s;
    }
    let rates = trimmed.equations.lag_diagonal(trimmed.trim.speed());
    for lag in layout.lags() {
        a[(lag, lag)] = rates[lag];
    }
    a
}

/// Largest step along the path; where two modes repel each other it decides whether a label goes with the shape or with
/// the branch.
const LARGEST_STEP: f64 = 0.125;

/// A straight line between two matrices whose lags do not act on each other.
struct Path {
    from: Mat<f64>,
    to: Mat<f64>,
    lags: Vec<usize>,
}

type Certain = (C64, f64);

impl Path {
    /// Elastic modes with their certainty, and rigid-body modes where they can be followed. One path serves all; a
    /// rigid-body mode that cannot be followed (roll subsidence may meet a lag root) must not spoil the rest.
    fn follow_all(&self, elastic: &[C64], rigid: &[C64]) -> Result<(Vec<Certain>, Vec<Option<C64>>), Error> {
        let together: Vec<C64> = elastic.iter().chain(rigid).copied().collect();
        if let Ok(mut found) = self.follow(&together) {
            let rigid = found
                .split_off(elastic.len())
                .into_iter()
                .map(|(value, _)| Some(value))
                .collect();
            return Ok((found, rigid));
        }
        let alone = |value: &C64| {
            let found = self.follow(&[*value]).ok()?;
            found.first().map(|(value, _)| *value)
        };
        Ok((self.follow(elastic)?, rigid.iter().map(alone).collect()))
    }

    /// By elimination of the lags; where that is not certain, as when a pair splits, by all eigenvalues of every step.
    fn follow(&self, chosen: &[C64]) -> Result<Vec<Certain>, Error> {
        if chosen.is_empty() {
            return Ok(Vec::new());
        }
        let quick = if self.lags.is_empty() {
            None
        } else {
            self.through_lags(chosen).ok()
        };
        match quick {
            Some(found) => Ok(found),
            None => self.dense(chosen),
        }
    }

    fn options() -> TrackOptions {
        TrackOptions {
            largest_step: LARGEST_STEP,
            ..TrackOptions::default()
        }
    }

    fn through_lags(&self, chosen: &[C64]) -> Result<Vec<Certain>, albatross_lti::Error> {
        let from = LagForm::new(self.from.as_ref(), &self.lags)?;
        let to = LagForm::new(self.to.as_ref(), &self.lags)?;
        let roots = chosen
            .iter()
            .map(|value| from.root(*value))
            .collect::<Result<Vec<_>, _>>()?;
        let found = lags::follow(&from, &to, &roots, Self::options())?;
        Ok(found
            .roots
            .iter()
            .zip(&found.confidence)
            .map(|(root, confidence)| (root.value, *confidence))
            .collect())
    }

    fn dense(&self, chosen: &[C64]) -> Result<Vec<Certain>, Error> {
        let followed = Tracker::new(self.from.as_ref(), chosen, Self::options())?.follow(self.to.as_ref())?;
        Ok(followed
            .modes
            .iter()
            .map(|m| (m.values.first().copied().unwrap_or_default(), m.confidence))
            .collect())
    }
}

/// Names of the modes of the rigid aircraft, by the states that carry them.
fn name_rigid_modes(a: &Mat<f64>, states: &[&str]) -> Result<Vec<(&'static str, C64)>, Error> {
    let signal = |name: &&str| albatross_lti::Signal::new(*name, "");
    let system = StateSpace::try_new(
        without_signals(a.clone()),
        states.iter().map(signal).collect(),
        Vec::new(),
        Vec::new(),
    )?;
    let lateral = |mode: &Mode| {
        let share = |names: &[&str]| {
            mode.participation
                .iter()
                .filter(|p| names.contains(&p.state.as_str()))
                .map(|p| p.share)
                .sum::<f64>()
        };
        share(&["v", "p", "r", "phi"]) > 0.5
    };
    let modes = mode_table(&system)?;
    let mut named = Vec::new();
    let mut name_last = |wanted: &dyn Fn(&Mode) -> bool, names: &[&'static str]| {
        // From the fastest: modes are in order of modulus.
        for (mode, name) in modes.iter().rev().filter(|m| wanted(m)).zip(names) {
            named.push((*name, mode.eigenvalue()));
        }
    };
    name_last(&|m| m.oscillatory && !lateral(m), &["short period", "phugoid"]);
    name_last(&|m| m.oscillatory && lateral(m), &["Dutch roll"]);
    name_last(&|m| !m.oscillatory && lateral(m), &["roll subsidence", "spiral"]);
    Ok(named)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Inputs, analysis};
    use std::path::Path as FilePath;

    /// The elimination of the lags against all eigenvalues and vectors of every step, for every variant of the F25-like
    /// surrogate: the same labels, values and certainties.
    #[test]
    fn val_modes_through_the_lags_are_those_of_the_dense_way() {
        let file = FilePath::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let inputs = Inputs::read(file).unwrap();
        for variant in ["avl", "corrected"] {
            let model = Model::build(&inputs, &inputs.case.variant(Some(variant)).unwrap()).unwrap();
            let trimmed = analysis::trimmed(&model).unwrap();
            let Ends {
                path,
                in_vacuo,
                named,
            } = ends(&model, &trimmed).unwrap();
            assert_eq!(path.lags.len(), trimmed.equations.layout().n_lags);
            let chosen: Vec<C64> = in_vacuo
                .iter()
                .copied()
                .chain(named.iter().map(|n| n.1))
                .collect();
            let quick = path.through_lags(&chosen).unwrap();
            let dense = path.dense(&chosen).unwrap();
            assert_eq!(quick.len(), chosen.len());
            for ((q, certain), (d, dense_certain)) in quick.iter().zip(&dense) {
                let d = C64::new(d.re, d.im.abs());
                assert!((q - d).norm() < 1e-8 * d.norm(), "{variant}: {q} {d}");
                assert!((certain - dense_certain).abs() < 1e-5, "{variant}: {q}");
            }
        }
    }

    /// The work of the solvers, counted: a change that makes them work more shows here and not in the seconds of a machine.
    /// Counts of iterations have some room, since rounding differs between processors.
    #[test]
    fn regress_work_of_the_solvers() {
        let file = FilePath::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let inputs = Inputs::read(file).unwrap();
        let model = Model::build(&inputs, &inputs.case.variant(Some("avl")).unwrap()).unwrap();
        let trimmed = analysis::trimmed(&model).unwrap();
        let mut manoeuvre = inputs.case.manoeuvres[0].clone();
        manoeuvre.end = 1.0;
        let flown = analysis::simulate_case(&inputs, &trimmed, &manoeuvre).unwrap();
        let Ends {
            path,
            in_vacuo,
            named,
        } = ends(&model, &trimmed).unwrap();
        let chosen: Vec<C64> = in_vacuo.into_iter().chain(named.iter().map(|n| n.1)).collect();
        let [from, to] = [&path.from, &path.to].map(|a| LagForm::new(a.as_ref(), &path.lags).unwrap());
        let roots: Vec<_> = chosen.iter().map(|v| from.root(*v).unwrap()).collect();
        let found = lags::follow(&from, &to, &roots, Path::options()).unwrap();
        let counts = [
            ("states", trimmed.system.states.len(), 444..=444),
            ("iterations of the trim", trimmed.trim.iterations, 6..=10),
            (
                "evaluations of the derivative in 1 s at 1 kHz",
                flown.evaluations,
                4000..=4000,
            ),
            ("order of the matrices factorised", to.core_count(), 49..=49),
            ("modes followed", chosen.len(), 25..=25),
            ("steps along the path", found.steps, 8..=9),
            ("factorisations", found.effort.factorisations, 200..=260),
            ("iterations of the roots", found.effort.iterations, 500..=620),
        ];
        let outside: Vec<String> = counts
            .iter()
            .filter(|(_, count, range)| !range.contains(count))
            .map(|(what, count, range)| format!("{what}: {count}, expected {range:?}"))
            .collect();
        assert!(outside.is_empty(), "{outside:#?}");
    }
}
