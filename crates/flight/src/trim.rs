//! Trim: straight, symmetric flight at a given speed, altitude and flight-path angle.
//!
//! Unknowns are incidence, one control and the thrust; the modes follow from static equilibrium,
//! `(K - rho V^2 Q_eta) eta = q S cbar (Q_0 + Q_alpha alpha + Q_u u) + T phi_T`, so that Newton's method works on
//! three accelerations: along body x, along body z, in pitch.
//!
//! Equations: THEORY (23), (23a), (23b).

use crate::aircraft::{Aircraft, ModelOptions, ShapeReference};
use crate::equations::EquationsOfMotion;
use crate::{Error, atmosphere};
use albatross_numerics::{Mat, solve};
use albatross_strip::flutter;
use std::f64::consts::FRAC_PI_2;

/// Where to trim.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FlightPoint {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Geopotential altitude \[m\].
    pub altitude: f64,
    /// Flight-path angle, positive climbing \[rad\].
    pub path_angle_rad: f64,
    /// Name of the control that trims pitch.
    pub control: String,
}

/// A trimmed state.
#[derive(Debug, Clone, PartialEq)]
pub struct Trim {
    /// Incidence \[rad\].
    pub alpha_rad: f64,
    /// Deflections of all controls \[rad\].
    pub controls_rad: Vec<f64>,
    /// Total thrust \[N\].
    pub thrust: f64,
    /// Modal amplitudes.
    pub eta: Vec<f64>,
    /// Dynamic pressure \[Pa\].
    pub dynamic_pressure: f64,
    /// Density \[kg/m³\].
    pub density: f64,
    /// State vector.
    pub state: Vec<f64>,
    /// Input vector: controls, thrust.
    pub input: Vec<f64>,
    /// Largest residual acceleration over all states \[SI\].
    pub residual: f64,
    /// Iterations of Newton's method.
    pub iterations: usize,
}

impl Trim {
    /// True airspeed \[m/s\].
    pub fn speed(&self) -> f64 {
        match self.state.as_slice() {
            [u, v, w, ..] => (u * u + v * v + w * w).sqrt(),
            _ => 0.0,
        }
    }
}

/// Trims the aircraft and returns the equations with the reference shape set to the trim where the options say so.
///
/// # Errors
/// [`Error::Divergence`] if the static aeroelastic stiffness is singular or negative at the flight point,
/// [`Error::NoTrimAuthority`] if an unknown has no effect, [`Error::TrimNotConverged`], [`Error::UnknownControl`],
/// [`Error::BadQuantity`], and what [`EquationsOfMotion::new`] returns.
pub fn trim(
    aircraft: &Aircraft,
    options: ModelOptions,
    point: &FlightPoint,
) -> Result<(EquationsOfMotion, Trim), Error> {
    let mut equations = EquationsOfMotion::new(aircraft, options)?;
    let control = aircraft.control_index(&point.control)?;
    point.check()?;
    check_divergence(&equations, point)?;
    let statics = StaticShape::new(&equations, point)?;
    let found = newton(&mut equations, point, control, &statics)?;
    statics.hold_reference_shape(&mut equations, point, &found);
    let state = statics.state(&equations, point, &found);
    let mut residuals = vec![0.0; state.len()];
    let mut work = equations.workspace::<f64>();
    let input = found.input(control, aircraft.controls.len());
    equations.rates(&state, &input, &mut work, &mut residuals);
    // Altitude and position move along the flight path by intent.
    let moving = equations.layout().altitude()..equations.layout().n_rigid();
    let residual = residuals
        .iter()
        .enumerate()
        .filter(|(i, _)| !moving.contains(i))
        .fold(0.0, |largest: f64, (_, r)| largest.max(r.abs()));
    let trim = Trim {
        alpha_rad: found.alpha,
        controls_rad: input[..aircraft.controls.len()].to_vec(),
        thrust: found.thrust,
        eta: state[equations.layout().eta()].to_vec(),
        dynamic_pressure: dynamic_pressure(point),
        density: density(point),
        state,
        input,
        residual,
        iterations: found.iterations,
    };
    Ok((equations, trim))
}

impl FlightPoint {
    fn check(&self) -> Result<(), Error> {
        let refuse = |quantity, value, expected| {
            Err(Error::BadQuantity {
                quantity,
                value,
                expected,
            })
        };
        if !(self.speed.is_finite() && self.speed > 0.0) {
            return refuse("speed", self.speed, "a positive number");
        }
        if !atmosphere::ALTITUDES.contains(&self.altitude) {
            return refuse(
                "altitude",
                self.altitude,
                "from -2000 to 32000 m, where the model of the atmosphere holds",
            );
        }
        if self.path_angle_rad.is_nan() || self.path_angle_rad.abs() >= FRAC_PI_2 {
            return refuse(
                "flight-path angle",
                self.path_angle_rad,
                "an angle within -90 and 90 deg, in rad",
            );
        }
        Ok(())
    }
}

fn density(point: &FlightPoint) -> f64 {
    atmosphere::standard(point.altitude).density
}

fn dynamic_pressure(point: &FlightPoint) -> f64 {
    0.5 * density(point) * point.speed * point.speed
}

fn check_divergence(equations: &EquationsOfMotion, point: &FlightPoint) -> Result<(), Error> {
    let Some(part) = equations
        .aircraft()
        .elastic
        .as_ref()
        .filter(|_| equations.n_modes() > 0)
    else {
        return Ok(());
    };
    let rho = density(point);
    match flutter::divergence_speed(&part.model, rho)? {
        Some(divergence_speed) if point.speed >= divergence_speed => Err(Error::Divergence {
            speed: point.speed,
            divergence_speed,
            rho,
        }),
        _ => Ok(()),
    }
}

/// The unknowns.
#[derive(Debug, Clone, Copy)]
struct Unknowns {
    alpha: f64,
    control: f64,
    thrust: f64,
    iterations: usize,
    index: usize,
}

impl Unknowns {
    fn controls(&self, n: usize) -> Vec<f64> {
        let mut controls = vec![0.0; n];
        if let Some(c) = controls.get_mut(self.index) {
            *c = self.control;
        }
        controls
    }

    fn input(&self, index: usize, n: usize) -> Vec<f64> {
        let mut input = Self { index, ..*self }.controls(n);
        input.push(self.thrust);
        input
    }
}

/// Static elastic equilibrium: linear in the loads, so the inverse is made once.
struct StaticShape {
    flexibility: Option<Mat<f64>>,
}

impl StaticShape {
    fn new(equations: &EquationsOfMotion, point: &FlightPoint) -> Result<Self, Error> {
        let density = density(point);
        let jig = equations.options().shape_reference == ShapeReference::Jig;
        let flexibility = match equations
            .aircraft()
            .elastic
            .as_ref()
            .filter(|_| jig && equations.n_modes() > 0)
        {
            None => None,
            Some(part) => {
                let flow = albatross_strip::Flow {
                    rho: density,
                    speed: point.speed,
                };
                // At rest quasi-steady air is the unsteady one: all lags are zero.
                let stiffness = part.model.static_stiffness(flow)?;
                Some(solve::inverse(stiffness.as_ref())?)
            }
        };
        Ok(Self { flexibility })
    }

    fn load(&self, equations: &EquationsOfMotion, point: &FlightPoint, z: &Unknowns) -> Vec<f64> {
        let controls = z.controls(equations.aircraft().controls.len());
        let variables = [z.alpha, 0.0, 0.0, 0.0, 0.0];
        equations.modal_load(dynamic_pressure(point), variables, &controls, z.thrust)
    }

    /// Where the flight shape is the reference, it carries the whole steady load.
    fn hold_reference_shape(&self, equations: &mut EquationsOfMotion, point: &FlightPoint, z: &Unknowns) {
        if equations.options().shape_reference == ShapeReference::Trimmed && equations.n_modes() > 0 {
            let load = self.load(equations, point, z);
            equations.set_reference_load(load);
        }
    }

    fn state(&self, equations: &EquationsOfMotion, point: &FlightPoint, z: &Unknowns) -> Vec<f64> {
        let layout = equations.layout();
        let mut x = vec![0.0; layout.n_states()];
        x[0] = point.speed * z.alpha.cos();
        x[2] = point.speed * z.alpha.sin();
        layout.set_pitch(z.alpha + point.path_angle_rad, &mut x);
        x[layout.altitude()] = point.altitude;
        if let Some(flexibility) = &self.flexibility {
            let load = self.load(equations, point, z);
            for (i, eta) in x[layout.eta()].iter_mut().enumerate() {
                *eta = load
                    .iter()
                    .enumerate()
                    .map(|(j, f)| flexibility[(i, j)] * f)
                    .sum();
            }
        }
        let controls = z.controls(equations.aircraft().controls.len());
        x[layout.lags()].copy_from_slice(&equations.steady_lags(point.speed, &controls));
        x
    }
}

/// Equations of the trim, in the order of the residuals.
const EQUATIONS: [&str; 3] = [
    "the force along body x",
    "the force along body z",
    "the pitching moment",
];
const MOST_ITERATIONS: usize = 50;
/// Residuals beside the accelerations that the air can give: far above rounding, far below any use.
const TOLERANCE: f64 = 1e-10;
/// Step of the differences: angles in rad, the thrust in forces of weight and air.
const STEP: f64 = 1e-6;
/// A derivative of a scaled residual below this is rounding.
const NO_EFFECT: f64 = 1e-8;

fn newton(
    equations: &mut EquationsOfMotion,
    point: &FlightPoint,
    control: usize,
    statics: &StaticShape,
) -> Result<Unknowns, Error> {
    let scales = residual_scales(equations, point);
    let n_controls = equations.aircraft().controls.len();
    let weight = equations.aircraft().mass * equations.aircraft().gravity;
    let force = dynamic_pressure(point) * equations.aircraft().reference.area;
    let mut work = equations.workspace::<f64>();
    let mut xdot = vec![0.0; equations.layout().n_states()];
    let mut residual = |z: &Unknowns| -> [f64; 3] {
        statics.hold_reference_shape(equations, point, z);
        let x = statics.state(equations, point, z);
        equations.rates(&x, &z.input(control, n_controls), &mut work, &mut xdot);
        [xdot[0] / scales[0], xdot[2] / scales[1], xdot[4] / scales[2]]
    };
    let mut z = Unknowns {
        alpha: 0.02,
        control: 0.0,
        thrust: 0.05 * weight,
        iterations: 0,
        index: control,
    };
    let steps = [STEP, STEP, STEP * (weight + force)];
    let mut previous = f64::INFINITY;
    let mut last = [f64::INFINITY; 3];
    let mut made = 0;
    for iteration in 1..=MOST_ITERATIONS {
        last = residual(&z);
        made = iteration;
        let size = last.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        // Newton goes on until rounding stops it.
        if size == 0.0 || (size < TOLERANCE && size >= 0.5 * previous) {
            return Ok(Unknowns {
                iterations: iteration,
                ..z
            });
        }
        previous = size;
        let jacobian = jacobian(&mut residual, &z, &steps);
        if iteration == 1 {
            check_authority(&jacobian, &point.control)?;
        }
        // A singular or non-finite Jacobian leaves the last residual to be reported.
        let Ok(delta) = solve::solve_vec(jacobian.as_ref(), &last) else {
            break;
        };
        z.alpha = (z.alpha - delta[0] * steps[0]).clamp(-1.0, 1.0);
        z.control = (z.control - delta[1] * steps[1]).clamp(-1.5, 1.5);
        z.thrust -= delta[2] * steps[2];
    }
    let worst = (0..3).fold(0, |w, i| if last[i].abs() > last[w].abs() { i } else { w });
    Err(Error::TrimNotConverged {
        iterations: made,
        residual: last[worst] * scales[worst],
        worst_equation: EQUATIONS[worst],
        control: point.control.clone(),
    })
}

/// Accelerations that weight and unit coefficients give: x, z \[m/s²\], pitch \[rad/s²\].
fn residual_scales(equations: &EquationsOfMotion, point: &FlightPoint) -> [f64; 3] {
    let aircraft = equations.aircraft();
    let force = dynamic_pressure(point) * aircraft.reference.area;
    let linear = aircraft.gravity + force / aircraft.mass;
    [
        linear,
        linear,
        force * aircraft.reference.chord / aircraft.inertia[1][1],
    ]
}

/// Central differences for one step of each unknown.
fn jacobian(residual: &mut impl FnMut(&Unknowns) -> [f64; 3], z: &Unknowns, steps: &[f64; 3]) -> Mat<f64> {
    let mut jacobian = Mat::zeros(3, 3);
    for (column, step) in steps.iter().enumerate() {
        let mut shifted = |sign: f64| {
            let mut s = *z;
            match column {
                0 => s.alpha += sign * step,
                1 => s.control += sign * step,
                _ => s.thrust += sign * step,
            }
            residual(&s)
        };
        let (above, below) = (shifted(1.0), shifted(-1.0));
        for row in 0..3 {
            jacobian[(row, column)] = 0.5 * (above[row] - below[row]);
        }
    }
    jacobian
}

/// Incidence must change the lift, the control the pitching moment, the thrust the force forwards.
fn check_authority(jacobian: &Mat<f64>, control: &str) -> Result<(), Error> {
    for (column, row, unknown, cure) in [
        (0, 1, "the incidence", "check the lift slope CLa"),
        (
            1,
            2,
            control,
            "choose a trim control with a pitching-moment derivative",
        ),
        (
            2,
            0,
            "the thrust",
            "give the aircraft an engine whose share is not zero and that points forward",
        ),
    ] {
        let effect = jacobian[(row, column)] / STEP;
        if effect.abs() < NO_EFFECT {
            return Err(Error::NoTrimAuthority {
                unknown: unknown.to_owned(),
                equation: EQUATIONS[row],
                cure,
            });
        }
    }
    Ok(())
}
