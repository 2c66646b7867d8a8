//! Trim: variables driven to targets, as AVL's OPER menu pairs them.
//!
//! Every variable (alpha, beta, three rates, each control) has one target: a value of its own or of another
//! variable, or a value of CL, CY, Cl, Cm, Cn. Newton's method with the exact derivatives of the flow.

use albatross_avl::run::{RunCase, RunTarget, RunVariable};
use albatross_numerics::{Mat, solve};
use serde::{Deserialize, Serialize};

use crate::coefficients::{Coefficients, Stability, Table};
use crate::condition::{Condition, control_index};
use crate::error::{Error, Result};
use crate::flow::Solver;
use crate::lattice::Lattice;
use crate::output::Solution;

/// Iterations before giving up; three or four are usual.
const ITERATIONS: usize = 30;

/// Largest residual of a converged trim: coefficients, rates, and angles in rad.
const TOLERANCE: f64 = 1e-11;

/// Angles beyond which the trim is given up.
const ANGLE_LIMIT_DEG: f64 = 85.0;

/// A target and its value: degrees for angles and controls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// What is to reach the value.
    pub kind: RunTarget,
    /// The value.
    pub value: f64,
}

/// Axes of the roll and yaw rates and moments of a trim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrimAxes {
    /// x along the wind's projection on the plane of symmetry: AVL's default.
    #[default]
    Stability,
    /// x along the body.
    Body,
}

/// One target for each variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trim {
    /// Targets of alpha, beta, roll rate, pitch rate, yaw rate, and of each control in AVL's order.
    pub targets: Vec<Target>,
    /// Design variables, which stay.
    pub designs: Vec<f64>,
    /// Axes of the roll and yaw rates and of the roll and yaw moments.
    pub axes: TrimAxes,
}

impl Trim {
    /// Every variable at zero.
    pub fn new(lattice: &Lattice) -> Self {
        let own = [
            RunTarget::Alpha,
            RunTarget::Beta,
            RunTarget::RollRate,
            RunTarget::PitchRate,
            RunTarget::YawRate,
        ];
        let controls = lattice.control_names().map(|n| RunTarget::Control(n.to_owned()));
        Self {
            targets: own
                .into_iter()
                .chain(controls)
                .map(|kind| Target { kind, value: 0.0 })
                .collect(),
            designs: vec![0.0; lattice.designs.len()],
            axes: TrimAxes::default(),
        }
    }

    /// The constraints of a run case; variables that it does not name stay at zero. As AVL reads it, the values of
    /// alpha, beta and controls are in degrees, rates in stability axes.
    ///
    /// # Errors
    /// [`Error::UnknownControl`].
    pub fn of_run_case(lattice: &Lattice, case: &RunCase) -> Result<Self> {
        let mut trim = Self::new(lattice);
        for constraint in &case.constraints {
            trim.set(
                lattice,
                &constraint.variable,
                constraint.target.clone(),
                constraint.value,
            )?;
        }
        Ok(trim)
    }

    /// Drives a variable to a target.
    ///
    /// # Errors
    /// [`Error::UnknownControl`].
    pub fn set(
        &mut self,
        lattice: &Lattice,
        variable: &RunVariable,
        kind: RunTarget,
        value: f64,
    ) -> Result<()> {
        let index = match variable {
            RunVariable::Alpha => 0,
            RunVariable::Beta => 1,
            RunVariable::RollRate => 2,
            RunVariable::PitchRate => 3,
            RunVariable::YawRate => 4,
            RunVariable::Control(name) => 5 + control_index(lattice, name)?,
        };
        if let Some(target) = self.targets.get_mut(index) {
            *target = Target { kind, value };
        }
        Ok(())
    }
}

/// Flight condition of the trim's unknowns: alpha, beta in rad, rates, controls.
fn condition(x: &[f64], trim: &Trim) -> Condition {
    let at = |k: usize| x.get(k).copied().unwrap_or(0.0);
    let (s, c) = match trim.axes {
        TrimAxes::Stability => at(0).sin_cos(),
        TrimAxes::Body => (0.0, 1.0),
    };
    Condition {
        alpha_rad: at(0),
        beta_rad: at(1),
        pb_2v: at(2) * c - at(4) * s,
        qc_2v: at(3),
        rb_2v: at(2) * s + at(4) * c,
        controls: x.iter().skip(5).copied().collect(),
        designs: trim.designs.clone(),
    }
}

/// What the targets measure, lift, side force and moments, of a derivative.
fn measured(table: &Table, change: &Coefficients, axes: TrimAxes) -> Stability {
    in_axes(table.resolved(change), change, axes)
}

/// With the moments of body axes where the trim is in these.
fn in_axes(stability: Stability, own: &Coefficients, axes: TrimAxes) -> Stability {
    match axes {
        TrimAxes::Stability => stability,
        TrimAxes::Body => Stability {
            moment: own.body().1,
            ..stability
        },
    }
}

/// Derivative of what the targets measure by unknown `k`.
fn derivative(table: &Table, k: usize, axes: TrimAxes) -> Stability {
    match (k, axes) {
        (0, TrimAxes::Stability) => table.stability_alpha(false),
        (0, TrimAxes::Body) => Stability {
            moment: table.alpha_body_rates().body().1,
            ..table.stability_alpha_body_rates()
        },
        (1, _) => {
            let own = measured(table, &table.beta(), axes);
            Stability {
                side: own.side + table.profile_side_force_beta(),
                ..own
            }
        }
        (2..=4, TrimAxes::Stability) => table.stability_rate(k - 2),
        (2..=4, TrimAxes::Body) => measured(table, &table.body_rate(k - 2), axes),
        _ => measured(table, &table.setting(k.saturating_sub(5)), axes),
    }
}

/// What a target compares: one of the unknowns, or a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Measure {
    Unknown(usize),
    Lift,
    Side,
    Moment(usize),
}

impl Measure {
    fn of(lattice: &Lattice, kind: &RunTarget) -> Result<Self> {
        Ok(match kind {
            RunTarget::Alpha => Self::Unknown(0),
            RunTarget::Beta => Self::Unknown(1),
            RunTarget::RollRate => Self::Unknown(2),
            RunTarget::PitchRate => Self::Unknown(3),
            RunTarget::YawRate => Self::Unknown(4),
            RunTarget::Control(name) => Self::Unknown(5 + control_index(lattice, name)?),
            RunTarget::Lift => Self::Lift,
            RunTarget::SideForce => Self::Side,
            RunTarget::RollMoment => Self::Moment(0),
            RunTarget::PitchMoment => Self::Moment(1),
            RunTarget::YawMoment => Self::Moment(2),
        })
    }

    fn goal(self, value: f64) -> f64 {
        match self {
            Self::Unknown(0 | 1) => value.to_radians(),
            _ => value,
        }
    }

    /// Value and derivatives by the unknowns.
    fn row(self, solution: &Solution<'_>, x: &[f64], axes: TrimAxes, row: &mut [f64]) -> f64 {
        if let Self::Unknown(k) = self {
            row.fill(0.0);
            if let Some(own) = row.get_mut(k) {
                *own = 1.0;
            }
            return x.get(k).copied().unwrap_or(0.0);
        }
        let pick = |s: &Stability| match self {
            Self::Lift => s.lift,
            Self::Side => s.side,
            Self::Moment(axis) => s.moment[axis.min(2)],
            Self::Unknown(_) => 0.0,
        };
        let table = solution.table();
        for (k, to) in row.iter_mut().enumerate() {
            *to = pick(&derivative(table, k, axes));
        }
        pick(&in_axes(table.stability(), &table.total(), axes))
    }
}

/// Name of a target in messages.
fn target_name(kind: &RunTarget) -> String {
    kind.name().to_owned()
}

/// Names of the variables.
fn variable_name(lattice: &Lattice, k: usize) -> String {
    ["alpha", "beta", "pb/2V", "qc/2V", "rb/2V"].get(k).map_or_else(
        || {
            lattice
                .controls
                .get(k - 5)
                .map_or_else(String::new, |c| c.name.clone())
        },
        |n| (*n).to_owned(),
    )
}

impl Solver<'_> {
    /// The flight condition at which all targets are met.
    ///
    /// # Errors
    /// [`Error::TargetTwice`], [`Error::TrimSingular`], [`Error::TrimNotConverged`], [`Error::TrimOutOfRange`];
    /// [`Error::Length`] for targets that do not fit the lattice; [`Error::Value`] for a target that is not finite.
    pub fn trim(&self, trim: &Trim) -> Result<Solution<'_>> {
        let lattice = self.lattice();
        let n = 5 + lattice.controls.len();
        if trim.targets.len() != n {
            return Err(Error::Length {
                what: "targets of the trim (alpha, beta, three rates, each control)",
                found: trim.targets.len(),
                expected: n,
            });
        }
        if let Some(target) = trim.targets.iter().find(|t| !t.value.is_finite()) {
            return Err(Error::Value {
                what: format!("the target {}", target_name(&target.kind)),
                value: target.value,
                expected: "it must be finite",
            });
        }
        let measures: Vec<Measure> = trim
            .targets
            .iter()
            .map(|t| Measure::of(lattice, &t.kind))
            .collect::<Result<_>>()?;
        for (k, measure) in measures.iter().enumerate() {
            if let Some(first) = measures[..k].iter().position(|m| m == measure) {
                return Err(Error::TargetTwice {
                    target: target_name(&trim.targets[k].kind),
                    first: variable_name(lattice, first),
                    second: variable_name(lattice, k),
                });
            }
        }
        let goals: Vec<f64> = measures
            .iter()
            .zip(&trim.targets)
            .map(|(m, t)| m.goal(t.value))
            .collect();
        // Variables that are given directly start at their value.
        let mut x = vec![0.0; n];
        for (measure, goal) in measures.iter().zip(&goals) {
            if let Measure::Unknown(k) = measure {
                x[*k] = *goal;
            }
        }
        let mut jacobian = Mat::zeros(n, n);
        let mut row = vec![0.0; n];
        let mut residual = vec![0.0; n];
        let mut worst = (0, f64::INFINITY);
        let mut last = 0;
        for iteration in 0..=ITERATIONS {
            let solution = self.solve(&condition(&x, trim))?;
            for (i, (measure, goal)) in measures.iter().zip(&goals).enumerate() {
                residual[i] = goal - measure.row(&solution, &x, trim.axes, &mut row);
                for (j, value) in row.iter().enumerate() {
                    jacobian[(i, j)] = *value;
                }
            }
            // What is not a number is off by most.
            worst = residual
                .iter()
                .map(|r| r.abs())
                .enumerate()
                .fold((0, 0.0), |w, r| if r.1 > w.1 || r.1.is_nan() { r } else { w });
            if worst.1 <= TOLERANCE {
                return Ok(solution);
            }
            last = iteration;
            if worst.1.is_nan() {
                break;
            }
            let step = solve::solve_vec(jacobian.as_ref(), &residual).map_err(|_| Error::TrimSingular {
                target: trim
                    .targets
                    .get(worst.0)
                    .map_or_else(String::new, |t| target_name(&t.kind)),
                iteration,
            })?;
            x.iter_mut().zip(&step).for_each(|(x, d)| *x += d);
            for (variable, value) in [("alpha", x[0]), ("beta", x[1])] {
                let value_deg = value.to_degrees();
                if value_deg.is_nan() || value_deg.abs() > ANGLE_LIMIT_DEG {
                    return Err(Error::TrimOutOfRange {
                        variable,
                        value_deg,
                        limit_deg: ANGLE_LIMIT_DEG,
                    });
                }
            }
        }
        Err(Error::TrimNotConverged {
            iterations: last,
            target: trim
                .targets
                .get(worst.0)
                .map_or_else(String::new, |t| target_name(&t.kind)),
            residual: worst.1,
        })
    }
}
