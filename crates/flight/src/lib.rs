//! Non-linear flight dynamics of the flexible aircraft.
//!
//! # The problem
//! A rigid aircraft with aerodynamic derivatives, normal modes of its structure, and strips with unsteady
//! aerodynamics: how do they fly together, where do they balance, and how do they respond?
//!
//! # The equations
//! In mean axes (Waszak & Schmidt 1988) rigid-body and elastic motion couple through the air alone:
//!
//! ```text
//! V'     = -omega x V + T G + F/m                                        (Eq. 2)
//! omega' = -J^-1 (omega x J omega) + J^-1 M                              (Eq. 3)
//! [mu - rho Q_etadd] eta'' = ... + rho V Q_lambda lambda + q S cbar Q_X X (Eq. 10)
//! lambda_i' = (2 V a_i/c) lambda_i + A_i w'                              (Eq. 9)
//! ```
//!
//! F and M hold the rigid aircraft's coefficients, the engines, and the elastic rows of Eqs. 7 and 8. Density follows
//! the altitude, and speed is the instantaneous one, in every term.
//!
//! # Inputs and outputs
//! In: an [`Aircraft`] (plain data), [`ModelOptions`], a [`FlightPoint`]. Out: a [`Trim`], a linear
//! [`StateSpace`](albatross_lti::StateSpace) with named states, inputs and outputs, [`TimeHistory`]s.
//!
//! | module | in | out |
//! |---|---|---|
//! | [`derivatives`] | stability derivatives of AVL, corrections | [`RigidAerodynamics`](aerodynamics::RigidAerodynamics) about the centre of gravity |
//! | [`aircraft`] | | the data of an [`Aircraft`] and the choices of [`ModelOptions`] |
//! | [`mod@trim`] | an aircraft and a flight point | [`EquationsOfMotion`] and the [`Trim`] |
//! | [`mod@linearize`] | equations, state and input | A, B, C, D by dual numbers, exact to rounding |
//! | [`mod@simulate`] | equations, a trim, a [`signal`] | [`TimeHistory`] |
//! | [`sensor`] | | what is measured, and where |
//! | [`layout`] | | which state sits where |
//! | [`lag_form`] | a linear system with lags | the same with their block diagonal |
//! | [`atmosphere`] | geopotential altitude | density, temperature, speed of sound (ISA) |
//!
//! # Limits
//! Coefficients are linear in incidence and rates, the atmosphere is at rest, the earth is flat, inertia is that of
//! the undeformed shape. Deformation is small: linear structure, fixed mode shapes.
//!
//! # Example
//! A rigid glider-like aircraft trims where lift equals weight. It is plain data ([`Aircraft`]), not shown here:
//!
//! ```
//! # use albatross_flight::aerodynamics::{Coefficient, Drag, RigidAerodynamics};
//! # use albatross_flight::{Aircraft, Engine};
//! # use albatross_strip::quasi_steady::ReferenceDimensions;
//! use albatross_flight::{FlightPoint, ModelOptions, Quantity, Sensor, linearize, trim};
//! # let c = |zero, alpha, q_hat, elevator| Coefficient { zero, alpha, q_hat, controls: vec![elevator], ..Default::default() };
//! # let side = Coefficient { controls: vec![0.0], ..Default::default() };
//! # let mut aircraft = Aircraft {
//! #     mass: 81_000.0,
//! #     inertia: [[1.7e6, 0.0, 0.0], [0.0, 6.0e6, 0.0], [0.0, 0.0, 7.4e6]],
//! #     gravity: 9.80665,
//! #     reference: ReferenceDimensions { area: 130.1, chord: 3.35, span: 45.0 },
//! #     controls: vec!["elevator".into()],
//! #     rigid: RigidAerodynamics {
//! #         lift: c(0.4, 7.3, 18.0, 0.7),
//! #         drag: Drag::Polar { zero: 0.021, k: 0.0245 },
//! #         pitch: c(0.077, -3.3, -94.0, -4.4),
//! #         side: side.clone(), roll: side.clone(), yaw: side,
//! #     },
//! #     engines: vec![Engine::through_cg()],
//! #     elastic: None,
//! #     sensors: vec![],
//! # };
//! aircraft.sensors.push(Sensor::at_cg("n_z", Quantity::LoadFactor));
//! let point = FlightPoint { speed: 232.7, altitude: 10_258.0, path_angle_rad: 0.0, control: "elevator".into() };
//! let (equations, level) = trim(&aircraft, ModelOptions::default(), &point)?;
//! let lift = level.dynamic_pressure * 130.1 * (0.4 + 7.3 * level.alpha_rad + 0.7 * level.controls_rad[0]);
//! let weight = 81_000.0 * 9.80665;
//! assert!((lift - weight + level.thrust * level.alpha_rad.sin()).abs() < 1e-6 * weight);
//!
//! let system = linearize(&equations, &level.state, &level.input)?; // A, B, C, D with names
//! assert_eq!(system.outputs[0].name, "n_z");
//! # Ok::<(), albatross_flight::Error>(())
//! ```

pub mod aerodynamics;
pub mod aircraft;
pub mod atmosphere;
pub mod derivatives;
pub mod lag_form;
pub mod layout;
pub mod linearize;
pub mod scalar;
pub mod sensor;
pub mod signal;
pub mod simulate;
pub mod trim;

mod check;
mod columns;
mod elastic;
mod equations;
mod error;
mod outputs;

pub use aircraft::{
    Aircraft, Attitude, ControlAerodynamics, ElasticPart, Engine, Fidelity, ModelOptions, ShapeReference,
};
pub use elastic::Workspace;
pub use equations::EquationsOfMotion;
pub use error::Error;
pub use linearize::linearize;
pub use sensor::{Quantity, Sensor, SensorPoint};
pub use simulate::{Manoeuvre, Method, TimeHistory, simulate};
pub use trim::{FlightPoint, Trim, trim};

/// Name of the thrust input, the last one.
pub const THRUST: &str = "thrust";
