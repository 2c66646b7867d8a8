//! The rigid aircraft's aerodynamic coefficients: linear in incidence, dimensionless rates and controls.
//!
//! Lift and drag are in wind axes by incidence, side force and moments in body axes (x forward, y right, z down)
//! about the centre of gravity. Angles in rad, rates as `p b/2V`, `q cbar/2V`, `r b/2V`, controls in rad.
//!
//! Equations: THEORY (18).

use crate::scalar::Scalar;
use albatross_strip::quasi_steady::ReferenceDimensions;

/// A coefficient linear in the aircraft's variables.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Coefficient {
    /// Value with all variables zero.
    pub zero: f64,
    /// With incidence \[1/rad\].
    pub alpha: f64,
    /// With sideslip \[1/rad\].
    pub beta: f64,
    /// With `p b/2V`.
    pub p_hat: f64,
    /// With `q cbar/2V`.
    pub q_hat: f64,
    /// With `r b/2V`.
    pub r_hat: f64,
    /// With each control \[1/rad\], in the order of the aircraft's controls.
    pub controls: Vec<f64>,
}

/// Drag.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Drag {
    /// `C_D = zero + k C_L^2`, with the rigid aircraft's lift coefficient.
    Polar {
        /// Drag coefficient at zero lift.
        zero: f64,
        /// Induced-drag factor.
        k: f64,
    },
    /// Linear in the aircraft's variables.
    Linear(Coefficient),
}

/// The rigid aircraft's coefficients.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RigidAerodynamics {
    /// Lift, normal to the flight path in the plane of symmetry.
    pub lift: Coefficient,
    /// Drag, along the projection of the flight path on the plane of symmetry.
    pub drag: Drag,
    /// Side force along body y.
    pub side: Coefficient,
    /// Rolling moment about body x, on the span.
    pub roll: Coefficient,
    /// Pitching moment about body y, on the chord, nose up.
    pub pitch: Coefficient,
    /// Yawing moment about body z, on the span, nose right.
    pub yaw: Coefficient,
}

/// The variables that the coefficients depend on: `[alpha, beta, p_hat, q_hat, r_hat]`.
pub type AirVariables<T> = [T; 5];

impl Coefficient {
    /// Value at the given variables and controls.
    pub fn at<T: Scalar>(&self, variables: &AirVariables<T>, controls: &[T]) -> T {
        let [alpha, beta, p_hat, q_hat, r_hat] = *variables;
        let motion = alpha * self.alpha
            + beta * self.beta
            + p_hat * self.p_hat
            + q_hat * self.q_hat
            + r_hat * self.r_hat
            + self.zero;
        self.controls
            .iter()
            .zip(controls)
            .fold(motion, |sum, (&slope, &delta)| sum + delta * slope)
    }
}

/// Forces and moments in body axes, per dynamic pressure.
pub struct BodyLoads<T> {
    /// Force over dynamic pressure \[m²\].
    pub force: [T; 3],
    /// Moment over dynamic pressure \[m³\].
    pub moment: [T; 3],
}

impl RigidAerodynamics {
    /// Forces and moments per dynamic pressure in body axes.
    pub fn body_loads<T: Scalar>(
        &self,
        variables: &AirVariables<T>,
        controls: &[T],
        reference: &ReferenceDimensions,
    ) -> BodyLoads<T> {
        let lift = self.lift.at(variables, controls);
        let drag = match &self.drag {
            Drag::Polar { zero, k } => lift * lift * *k + *zero,
            Drag::Linear(coefficient) => coefficient.at(variables, controls),
        };
        let (sin, cos) = variables[0].sin_cos();
        let area = reference.area;
        BodyLoads {
            force: [
                (lift * sin - drag * cos) * area,
                self.side.at(variables, controls) * area,
                -(lift * cos + drag * sin) * area,
            ],
            moment: [
                self.roll.at(variables, controls) * (area * reference.span),
                self.pitch.at(variables, controls) * (area * reference.chord),
                self.yaw.at(variables, controls) * (area * reference.span),
            ],
        }
    }
}
