//! The state vector: which state sits where, and the kinematics of attitude and position.
//!
//! Order: `u v w p q r | attitude | altitude | north, east (optional) | eta | etad | lags`. Attitude is
//! `phi theta psi` or the quaternion `q0 q1 q2 q3` from earth (north, east, down) to body.
//!
//! Equations: THEORY (21a), (21b), (21c).

use crate::aircraft::Attitude;
use crate::scalar::Scalar;
use albatross_lti::Signal;
use std::ops::Range;

/// Positions of the states.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// How attitude is kept.
    pub attitude: Attitude,
    /// Whether north and east are states.
    pub position: bool,
    /// Number of modes.
    pub n_modes: usize,
    /// Number of strips that carry lag states.
    pub n_strips: usize,
    /// Number of lag states.
    pub n_lags: usize,
}

/// Gain with which the quaternion's norm is pulled back to one \[1/s\].
const QUATERNION_CORRECTION: f64 = 1.0;

impl Layout {
    pub(crate) fn new(
        attitude: Attitude,
        position: bool,
        n_modes: usize,
        n_strips: usize,
        n_lags: usize,
    ) -> Self {
        Self {
            attitude,
            position,
            n_modes,
            n_strips,
            n_lags,
        }
    }

    fn n_attitude(&self) -> usize {
        match self.attitude {
            Attitude::Euler => 3,
            Attitude::Quaternion => 4,
        }
    }

    /// Index of the altitude.
    pub fn altitude(&self) -> usize {
        6 + self.n_attitude()
    }

    /// Number of rigid-body states.
    pub fn n_rigid(&self) -> usize {
        7 + self.n_attitude() + if self.position { 2 } else { 0 }
    }

    /// Modal amplitudes.
    pub fn eta(&self) -> Range<usize> {
        self.n_rigid()..self.n_rigid() + self.n_modes
    }

    /// Modal rates.
    pub fn eta_rate(&self) -> Range<usize> {
        let start = self.n_rigid() + self.n_modes;
        start..start + self.n_modes
    }

    /// Modal amplitudes and rates together.
    pub(crate) fn motion(&self) -> Range<usize> {
        self.n_rigid()..self.n_rigid() + 2 * self.n_modes
    }

    /// Lag states, lag by lag, strips within.
    pub fn lags(&self) -> Range<usize> {
        let start = self.n_rigid() + 2 * self.n_modes;
        start..start + self.n_lags
    }

    /// Number of states.
    pub fn n_states(&self) -> usize {
        self.n_rigid() + 2 * self.n_modes + self.n_lags
    }

    /// Names and units of the states.
    pub fn signals(&self) -> Vec<Signal> {
        let fixed =
            |pairs: &[(&str, &str)]| pairs.iter().map(|(n, u)| Signal::new(*n, *u)).collect::<Vec<_>>();
        let mut signals = fixed(&[
            ("u", "m/s"),
            ("v", "m/s"),
            ("w", "m/s"),
            ("p", "rad/s"),
            ("q", "rad/s"),
            ("r", "rad/s"),
        ]);
        signals.extend(match self.attitude {
            Attitude::Euler => fixed(&[("phi", "rad"), ("theta", "rad"), ("psi", "rad")]),
            Attitude::Quaternion => fixed(&[("q0", "-"), ("q1", "-"), ("q2", "-"), ("q3", "-")]),
        });
        signals.extend(fixed(&[("h", "m")]));
        if self.position {
            signals.extend(fixed(&[("north", "m"), ("east", "m")]));
        }
        signals.extend((1..=self.n_modes).map(|k| Signal::new(format!("eta_{k}"), "-")));
        signals.extend((1..=self.n_modes).map(|k| Signal::new(format!("etad_{k}"), "1/s")));
        let n_strips = self.n_strips.max(1);
        signals.extend((0..self.n_lags).map(|i| {
            let (lag, strip) = (i / n_strips, i % n_strips);
            Signal::new(format!("lambda{}_{}", lag + 1, strip + 1), "m/s")
        }));
        signals
    }

    /// Writes level or pitched attitude without bank, heading north.
    pub(crate) fn set_pitch(&self, theta: f64, x: &mut [f64]) {
        match self.attitude {
            Attitude::Euler => x[6..9].copy_from_slice(&[0.0, theta, 0.0]),
            Attitude::Quaternion => {
                x[6..10].copy_from_slice(&[(0.5 * theta).cos(), 0.0, (0.5 * theta).sin(), 0.0]);
            }
        }
    }

    /// Bank and pitch angles \[rad\].
    pub(crate) fn bank_and_pitch<T: Scalar>(&self, x: &[T]) -> (T, T) {
        match self.attitude {
            Attitude::Euler => (x[6], x[7]),
            Attitude::Quaternion => {
                let [forward, right, down] = self.down_in_body(x);
                // Not the arc sine: rounding may carry the component beyond one.
                let level = (right * right + down * down).sqrt();
                (right.atan2(down), -forward.atan2(level))
            }
        }
    }

    /// Unit vector of gravity in body axes: the third column of the transformation from earth to body.
    pub(crate) fn down_in_body<T: Scalar>(&self, x: &[T]) -> [T; 3] {
        match self.attitude {
            Attitude::Euler => {
                let ((sin_phi, cos_phi), (sin_theta, cos_theta)) = (x[6].sin_cos(), x[7].sin_cos());
                [-sin_theta, sin_phi * cos_theta, cos_phi * cos_theta]
            }
            Attitude::Quaternion => {
                let [a, b, c, d] = [x[6], x[7], x[8], x[9]];
                [
                    (b * d - a * c) * 2.0,
                    (c * d + a * b) * 2.0,
                    a * a - b * b - c * c + d * d,
                ]
            }
        }
    }

    /// Rates of attitude, altitude and position.
    pub(crate) fn attitude_and_position_rates<T: Scalar>(
        &self,
        x: &[T],
        velocity: [T; 3],
        omega: [T; 3],
        down: [T; 3],
        xdot: &mut [T],
    ) {
        let [p, q, r] = omega;
        match self.attitude {
            Attitude::Euler => {
                let ((sin_phi, cos_phi), (sin_theta, cos_theta)) = (x[6].sin_cos(), x[7].sin_cos());
                let turn = (q * sin_phi + r * cos_phi) / cos_theta;
                xdot[6] = p + turn * sin_theta;
                xdot[7] = q * cos_phi - r * sin_phi;
                xdot[8] = turn;
            }
            Attitude::Quaternion => {
                let [a, b, c, d] = [x[6], x[7], x[8], x[9]];
                let excess = (a * a + b * b + c * c + d * d - 1.0) * QUATERNION_CORRECTION;
                xdot[6] = (-b * p - c * q - d * r) * 0.5 - excess * a;
                xdot[7] = (a * p + c * r - d * q) * 0.5 - excess * b;
                xdot[8] = (a * q + d * p - b * r) * 0.5 - excess * c;
                xdot[9] = (a * r + b * q - c * p) * 0.5 - excess * d;
            }
        }
        let along = |axis: [T; 3]| axis[0] * velocity[0] + axis[1] * velocity[1] + axis[2] * velocity[2];
        let h = self.altitude();
        xdot[h] = -along(down);
        if self.position {
            let (north, east) = self.north_and_east_in_body(x);
            xdot[h + 1] = along(north);
            xdot[h + 2] = along(east);
        }
    }

    fn north_and_east_in_body<T: Scalar>(&self, x: &[T]) -> ([T; 3], [T; 3]) {
        match self.attitude {
            Attitude::Euler => {
                let ((sp, cp), (st, ct), (ss, cs)) = (x[6].sin_cos(), x[7].sin_cos(), x[8].sin_cos());
                (
                    [ct * cs, sp * st * cs - cp * ss, cp * st * cs + sp * ss],
                    [ct * ss, sp * st * ss + cp * cs, cp * st * ss - sp * cs],
                )
            }
            Attitude::Quaternion => {
                let [a, b, c, d] = [x[6], x[7], x[8], x[9]];
                (
                    [
                        a * a + b * b - c * c - d * d,
                        (b * c - a * d) * 2.0,
                        (b * d + a * c) * 2.0,
                    ],
                    [
                        (b * c + a * d) * 2.0,
                        a * a - b * b + c * c - d * d,
                        (c * d - a * b) * 2.0,
                    ],
                )
            }
        }
    }
}
