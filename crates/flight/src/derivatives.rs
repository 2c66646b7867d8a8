//! The derivative data base: from AVL's stability-axis output to body-axis coefficients about the centre of gravity,
//! and the longitudinal corrections of higher fidelity.
//!
//! AVL takes moments and rates in stability axes (x along the flow at the run's incidence alpha_0). Rotated to body
//! axes:
//!
//! ```text
//! Cl = Cl' cos - Cn' sin      d/dp = cos d/dp' - sin d/dr'
//! Cn = Cn' cos + Cl' sin      d/dr = cos d/dr' + sin d/dp'
//! ```
//!
//! Equations: THEORY (17), (17a), (17b), (17c).

use crate::Error;
use crate::aerodynamics::{Coefficient, Drag, RigidAerodynamics};
use albatross_avl::results::{AxisOrientation, StabilityColumn, StabilityDerivatives};
use albatross_strip::quasi_steady::ReferenceDimensions;

/// Which drag law to make of AVL's output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DragLaw {
    /// `CDvis + (CDind / CL^2) CL^2` from the totals of the run.
    #[default]
    Polar,
    /// Linear by the CD row of the file (AVL 3.5x).
    Linear,
}

/// What the data base needs to know beside the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AvlOptions {
    /// Centre of gravity, geometry axes (x aft, z up) \[m\].
    pub cg: [f64; 3],
    /// Moment reference point of the run, geometry axes \[m\]. The file prints it to five digits only: give the
    /// geometry file's where there is one.
    pub moment_point: [f64; 3],
    /// Drag law.
    pub drag: DragLaw,
}

/// The rigid aircraft's coefficients from an AVL run, with the names of the controls and the reference shape.
///
/// Values at zero incidence, deflection and rate are extrapolated linearly from the run's totals. Moments are moved
/// from the moment point to the centre of gravity, the rate derivatives with them.
///
/// # Errors
/// [`Error::Derivatives`] for geometric axes, reference values that are not positive, a polar asked of a run without
/// lift, or a linear drag law asked of a file without the CD row.
pub fn from_avl(
    file: &StabilityDerivatives,
    options: &AvlOptions,
) -> Result<(RigidAerodynamics, Vec<String>, ReferenceDimensions), Error> {
    let run = &file.run;
    let refuse = |what: &str, cure: &str| {
        Err(Error::Derivatives {
            what: what.into(),
            cure: cure.into(),
        })
    };
    if run.axes == AxisOrientation::Geometric {
        return refuse(
            "the AVL run uses geometric axes (X aft, Z up)",
            "switch to standard axes (OPER, then O, then R) and write the .st file again",
        );
    }
    let reference = ReferenceDimensions {
        area: run.reference.s_ref,
        chord: run.reference.c_ref,
        span: run.reference.b_ref,
    };
    if ![reference.area, reference.chord, reference.span]
        .iter()
        .all(|v| v.is_finite() && *v > 0.0)
    {
        return refuse(
            "Sref, Cref and Bref of the AVL run must be positive",
            "correct the header of the .avl file",
        );
    }
    let state = RunPoint::of(file);
    let drag = match options.drag {
        DragLaw::Polar if run.c_lift.abs() < 1e-3 => {
            return refuse(
                "the AVL run has no lift, so that no drag polar can be made",
                "write the .st file at the trimmed lift coefficient, or set the drag law to `linear`",
            );
        }
        DragLaw::Polar => Drag::Polar {
            zero: run.c_drag_viscous,
            k: run.c_drag_induced / run.c_lift.powi(2),
        },
        DragLaw::Linear => {
            if file.alpha.drag.is_none() {
                return refuse(
                    "the .st file has no CD row (AVL before 3.5x)",
                    "set the drag law to `polar`",
                );
            }
            Drag::Linear(state.coefficient(run.c_drag, |c| c.drag.unwrap_or(0.0)))
        }
    };
    let (sin, cos) = run.alpha_deg.to_radians().sin_cos();
    let mut rigid = RigidAerodynamics {
        lift: state.coefficient(run.c_lift, |c| c.lift),
        drag,
        side: state.coefficient(run.c_y, |c| c.side_force),
        roll: state.coefficient(run.c_roll, |c| c.roll * cos - c.yaw * sin),
        pitch: state.coefficient(run.c_m, |c| c.pitch),
        yaw: state.coefficient(run.c_n, |c| c.yaw * cos + c.roll * sin),
    };
    let [x, _, z] = std::array::from_fn(|i| options.cg[i] - options.moment_point[i]);
    move_moments(&mut rigid, x, z, &reference);
    let controls = file.controls.iter().map(|c| c.name.trim().to_owned()).collect();
    Ok((rigid, controls, reference))
}

/// The run about which the derivatives were taken, angles in rad.
struct RunPoint<'a> {
    file: &'a StabilityDerivatives,
    sin: f64,
    cos: f64,
}

impl<'a> RunPoint<'a> {
    fn of(file: &'a StabilityDerivatives) -> Self {
        let (sin, cos) = file.run.alpha_deg.to_radians().sin_cos();
        Self { file, sin, cos }
    }

    /// A coefficient from its total at the run and the entry that `pick` takes of each column.
    fn coefficient(&self, total: f64, pick: impl Fn(&StabilityColumn) -> f64) -> Coefficient {
        let (file, run) = (self.file, &self.file.run);
        let (by_p, by_r) = (pick(&file.roll_rate), pick(&file.yaw_rate));
        let mut c = Coefficient {
            zero: total,
            alpha: pick(&file.alpha),
            beta: pick(&file.beta),
            p_hat: self.cos * by_p - self.sin * by_r,
            q_hat: pick(&file.pitch_rate),
            r_hat: self.cos * by_r + self.sin * by_p,
            controls: Vec::with_capacity(file.controls.len()),
        };
        c.zero -= c.alpha * run.alpha_deg.to_radians()
            + c.beta * run.beta_deg.to_radians()
            + c.p_hat * run.pb_2v
            + c.q_hat * run.qc_2v
            + c.r_hat * run.rb_2v;
        for (index, control) in file.controls.iter().enumerate() {
            let per_degree = pick(&control.column);
            let deflection = run.controls.get(index).map_or(0.0, |d| d.value);
            c.zero -= per_degree * deflection;
            c.controls.push(per_degree.to_degrees());
        }
        c
    }
}

/// Moves moments and rates to a point `x` further aft and `z` higher.
///
/// Forces act at the old point: `Cm += CL x/c`, `Cn += CY x/b`, `Cl -= CY z/b` (body axes); drag's arm is neglected.
/// Rates about the new point move the old one: incidence `-q x/V`, sideslip `(r x - p z)/V`.
fn move_moments(rigid: &mut RigidAerodynamics, x: f64, z: f64, reference: &ReferenceDimensions) {
    if x == 0.0 && z == 0.0 {
        return;
    }
    let (c, b) = (reference.chord, reference.span);
    let shift_rates = |k: &mut Coefficient| {
        k.q_hat -= k.alpha * 2.0 * x / c;
        k.r_hat += k.beta * 2.0 * x / b;
        k.p_hat -= k.beta * 2.0 * z / b;
    };
    for k in [
        &mut rigid.lift,
        &mut rigid.side,
        &mut rigid.roll,
        &mut rigid.pitch,
        &mut rigid.yaw,
    ] {
        shift_rates(k);
    }
    let (lift, side) = (rigid.lift.clone(), rigid.side.clone());
    add_scaled(&mut rigid.pitch, &lift, x / c);
    add_scaled(&mut rigid.yaw, &side, x / b);
    add_scaled(&mut rigid.roll, &side, -z / b);
}

fn add_scaled(to: &mut Coefficient, from: &Coefficient, factor: f64) {
    to.zero += factor * from.zero;
    to.alpha += factor * from.alpha;
    to.beta += factor * from.beta;
    to.p_hat += factor * from.p_hat;
    to.q_hat += factor * from.q_hat;
    to.r_hat += factor * from.r_hat;
    for (to, from) in to.controls.iter_mut().zip(&from.controls) {
        *to += factor * from;
    }
}

/// The eight longitudinal derivatives that the paper takes from CFD, per rad and per `q cbar/2V`, about the centre of
/// gravity. Those that are absent keep their value.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[allow(non_snake_case)]
pub struct LongitudinalCorrections {
    /// Lift at zero incidence.
    pub CL0: Option<f64>,
    /// Lift slope \[1/rad\].
    pub CLa: Option<f64>,
    /// Lift with `q cbar/2V`.
    pub CLq: Option<f64>,
    /// Lift with the elevator \[1/rad\].
    pub CLde: Option<f64>,
    /// Pitching moment at zero incidence.
    pub Cm0: Option<f64>,
    /// Pitching moment with incidence \[1/rad\].
    pub Cma: Option<f64>,
    /// Pitching moment with `q cbar/2V`.
    pub Cmq: Option<f64>,
    /// Pitching moment with the elevator \[1/rad\].
    pub Cmde: Option<f64>,
}

impl LongitudinalCorrections {
    /// Replaces the derivatives that are given; `elevator` is the index of the elevator among the controls.
    pub fn apply(&self, rigid: &mut RigidAerodynamics, elevator: usize) {
        let set = |to: &mut f64, value: Option<f64>| {
            if let Some(value) = value {
                *to = value;
            }
        };
        set(&mut rigid.lift.zero, self.CL0);
        set(&mut rigid.lift.alpha, self.CLa);
        set(&mut rigid.lift.q_hat, self.CLq);
        set(&mut rigid.pitch.zero, self.Cm0);
        set(&mut rigid.pitch.alpha, self.Cma);
        set(&mut rigid.pitch.q_hat, self.Cmq);
        if let Some(to) = rigid.lift.controls.get_mut(elevator) {
            set(to, self.CLde);
        }
        if let Some(to) = rigid.pitch.controls.get_mut(elevator) {
            set(to, self.Cmde);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use albatross_avl::results::BodyDerivatives;

    fn fixture(name: &str) -> String {
        let path = format!(
            "{}/../../fixtures/f25-like/avl_out/{name}",
            env!("CARGO_MANIFEST_DIR")
        );
        std::fs::read_to_string(path).unwrap()
    }

    /// AVL prints the same run in stability axes (.st) and body axes (.sb): the rotation must carry one into the other
    /// to the printed digits.
    #[test]
    fn val_rotation_against_avl_body_axes() {
        let st = StabilityDerivatives::parse(&fixture("trim.st"), "trim.st").unwrap();
        let sb = BodyDerivatives::parse(&fixture("trim.sb"), "trim.sb").unwrap();
        let point = [20.34355, 0.0, -0.42768];
        let options = AvlOptions {
            cg: point,
            moment_point: point,
            drag: DragLaw::Polar,
        };
        let (rigid, controls, reference) = from_avl(&st, &options).unwrap();
        assert_eq!(controls, ["aileron_in", "aileron_out", "elevator", "rudder"]);
        assert_eq!(reference.area, 130.1);
        let close = |found: f64, expected: f64, what: &str| {
            assert!(
                (found - expected).abs() < 3e-6,
                "{what}: {found} against {expected}"
            );
        };
        let (p, r, v) = (&sb.p, &sb.r, &sb.v);
        close(rigid.roll.p_hat, p.roll, "Clp");
        close(rigid.yaw.p_hat, p.yaw, "Cnp");
        close(rigid.side.p_hat, p.y, "CYp");
        close(rigid.roll.r_hat, r.roll, "Clr");
        close(rigid.yaw.r_hat, r.yaw, "Cnr");
        close(rigid.side.r_hat, r.y, "CYr");
        // v/V is the sine of sideslip; AVL's CYv also turns the wind, by the drag coefficient 0.0209.
        close(rigid.roll.beta, v.roll, "Clb");
        close(rigid.yaw.beta, v.yaw, "Cnb");
        assert!((rigid.pitch.q_hat - sb.q.pitch).abs() < 1e-5);
        let rudder = &sb.controls[3].column;
        close(rigid.roll.controls[3].to_radians(), rudder.roll, "Cl rudder");
        close(rigid.yaw.controls[3].to_radians(), rudder.yaw, "Cn rudder");
    }

    /// Totals of the run are recovered at the run's incidence and deflections.
    #[test]
    fn val_totals_are_recovered() {
        let st = StabilityDerivatives::parse(&fixture("trim.st"), "trim.st").unwrap();
        let point = [20.34355, 0.0, -0.42768];
        let (rigid, ..) = from_avl(
            &st,
            &AvlOptions {
                cg: point,
                moment_point: point,
                drag: DragLaw::Polar,
            },
        )
        .unwrap();
        let alpha = 1.33236_f64.to_radians();
        let elevator = (-0.01128_f64).to_radians();
        let variables = [alpha, 0.0, 0.0, 0.0, 0.0];
        let controls = [0.0, 0.0, elevator, 0.0];
        assert!((rigid.lift.at(&variables, &controls) - 0.56440).abs() < 1e-12);
        assert!(rigid.pitch.at(&variables, &controls).abs() < 1e-12);
        let Drag::Polar { zero, k } = rigid.drag else {
            panic!("polar expected")
        };
        assert!((zero + k * 0.5644_f64.powi(2) - (0.0209 + 0.0078233)).abs() < 1e-12);
    }

    /// A pure lift slope at a point: moved aft by x, it gives `Cma = CLa x/c`, `CLq = -2 CLa x/c`,
    /// `Cmq = -2 CLa (x/c)^2` (Etkin & Reid 1996, section 5.4 for a point surface).
    #[test]
    fn val_moving_the_moment_point() {
        let lift = Coefficient {
            alpha: 5.0,
            ..Coefficient::default()
        };
        let mut rigid = RigidAerodynamics {
            lift,
            drag: Drag::Polar { zero: 0.0, k: 0.0 },
            side: Coefficient::default(),
            roll: Coefficient::default(),
            pitch: Coefficient::default(),
            yaw: Coefficient::default(),
        };
        move_moments(
            &mut rigid,
            0.3,
            0.0,
            &ReferenceDimensions {
                area: 1.0,
                chord: 2.0,
                span: 9.0,
            },
        );
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
        close(rigid.pitch.alpha, 5.0 * 0.15);
        close(rigid.lift.q_hat, -2.0 * 5.0 * 0.15);
        close(rigid.pitch.q_hat, -2.0 * 5.0 * 0.15 * 0.15);
    }
}
