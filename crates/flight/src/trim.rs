//! Trim: straight, symmetric flight at a given speed, altitude and flight-path angle.
//!
//! Unknowns are incidence, one control and the thrust; the modes follow from static equilibrium,
//! `(K - rho V^2 Q_eta) eta = q S cbar (Q_0 + Q_alpha alpha + Q_u u) + T phi_T`, so that Newton's method works on
//! three accelerations: along body x, along body z, in pitch.

use crate::aircraft::{Aircraft, ModelOptions, ShapeReference};
use crate::equations::EquationsOfMotion;
use crate::{Error, atmosphere};
use albatross_numerics::{Mat, solve};
use albatross_strip::flutter;

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
/// [`Error::TrimNotConverged`], [`Error::UnknownControl`], [`Error::BadQuantity`].
pub fn trim(
    aircraft: &Aircraft,
    options: ModelOptions,
    point: &FlightPoint,
) -> Result<(EquationsOfMotion, Trim), Error> {
    let mut equations = EquationsOfMotion::new(aircraft, options)?;
    let control = aircraft.control_index(&point.control)?;
    for (quantity, value) in [("speed", point.speed), ("density", density(point))] {
        if !(value.is_finite() && value > 0.0) {
            return Err(Error::BadQuantity {
                quantity,
                value,
                expected: "a positive number",
            });
        }
    }
    if !point.path_angle_rad.is_finite() {
        return Err(Error::BadQuantity {
            quantity: "flight-path angle",
            value: point.path_angle_rad,
            expected: "a finite angle",
        });
    }
    check_divergence(&equations, point)?;
    let statics = StaticShape::new(&equations, point)?;
    let found = newton(&mut equations, point, control, &statics)?;
    statics.hold_reference_shape(&mut equations, point, &found);
    let state = statics.state(&equations, point, &found);
    let mut residuals = vec![0.0; state.len()];
    let mut work = equations.workspace::<f64>();
    let input = found.input(control, aircraft.controls.len());
    equations.derivative(&state, &input, &mut work, &mut residuals);
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
        dynamic_pressure: 0.5 * density(point) * point.speed * point.speed,
        density: density(point),
        state,
        input,
        residual,
        iterations: found.iterations,
    };
    Ok((equations, trim))
}

fn density(point: &FlightPoint) -> f64 {
    atmosphere::standard(point.altitude).density
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
    density: f64,
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
                let stiffness = match equations.options().fidelity {
                    crate::aircraft::Fidelity::QuasiSteady => {
                        &part.model.structure.stiffness
                            - density * point.speed * point.speed * &part.model.forces.eta_eta_c
                    }
                    _ => part.model.static_stiffness(flow),
                };
                Some(solve::inverse(stiffness.as_ref())?)
            }
        };
        Ok(Self { flexibility, density })
    }

    fn load(&self, equations: &EquationsOfMotion, point: &FlightPoint, z: &Unknowns) -> Vec<f64> {
        let controls = z.controls(equations.aircraft().controls.len());
        let variables = [z.alpha, 0.0, 0.0, 0.0, 0.0];
        equations.modal_load(self.density, point.speed, variables, &controls, z.thrust)
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

fn newton(
    equations: &mut EquationsOfMotion,
    point: &FlightPoint,
    control: usize,
    statics: &StaticShape,
) -> Result<Unknowns, Error> {
    const MOST_ITERATIONS: usize = 50;
    const NAMES: [&str; 3] = [
        "the force along body x",
        "the force along body z",
        "the pitching moment",
    ];
    let n_controls = equations.aircraft().controls.len();
    let weight = equations.aircraft().mass * equations.aircraft().gravity;
    let chord = equations.aircraft().reference.chord;
    let mut work = equations.workspace::<f64>();
    let mut xdot = vec![0.0; equations.layout().n_states()];
    // Pitch acceleration on the reference chord: all three residuals are accelerations in m/s2.
    let mut residual = |z: &Unknowns| -> [f64; 3] {
        statics.hold_reference_shape(equations, point, z);
        let x = statics.state(equations, point, z);
        equations.derivative(&x, &z.input(control, n_controls), &mut work, &mut xdot);
        [xdot[0], xdot[2], chord * xdot[4]]
    };
    let mut z = Unknowns {
        alpha: 0.02,
        control: 0.0,
        thrust: 0.05 * weight,
        iterations: 0,
        index: control,
    };
    let steps = [1e-6, 1e-6, 1e-6 * weight];
    let mut previous = f64::INFINITY;
    let mut last = [f64::INFINITY; 3];
    for iteration in 1..=MOST_ITERATIONS {
        let r = residual(&z);
        let size = r.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        last = r;
        // Rounding of accelerations that balance gravity; stop when Newton no longer improves.
        if size < 1e-9 && size >= 0.5 * previous || size == 0.0 {
            return Ok(Unknowns {
                iterations: iteration,
                ..z
            });
        }
        if !size.is_finite() {
            break;
        }
        previous = size;
        let mut jacobian = Mat::zeros(3, 3);
        for (column, step) in steps.iter().enumerate() {
            let shifted = |sign: f64| {
                let mut s = z;
                match column {
                    0 => s.alpha += sign * step,
                    1 => s.control += sign * step,
                    _ => s.thrust += sign * step,
                }
                s
            };
            let (above, below) = (residual(&shifted(1.0)), residual(&shifted(-1.0)));
            for row in 0..3 {
                jacobian[(row, column)] = (above[row] - below[row]) / 2.0;
            }
        }
        let Ok(delta) = solve::solve_vec(jacobian.as_ref(), &r) else {
            break;
        };
        z.alpha = (z.alpha - delta[0] * steps[0]).clamp(-1.0, 1.0);
        z.control = (z.control - delta[1] * steps[1]).clamp(-1.5, 1.5);
        z.thrust -= delta[2] * steps[2];
    }
    let worst = (0..3).fold(0, |w, i| if last[i].abs() > last[w].abs() { i } else { w });
    Err(Error::TrimNotConverged {
        iterations: MOST_ITERATIONS,
        residual: last[worst],
        worst_equation: NAMES[worst],
        control: point.control.clone(),
    })
}
