//! The output equation: what the sensors show in a state with its derivative.
//!
//! Acceleration of a point fixed in the mean axes plus its elastic acceleration, body axes:
//! `a_P = Vdot + omega x V + omegadot x r + omega x (omega x r)`, `a_z = [a_P]_z - phi_P etadd` (positive down).
//! The Coriolis term of the elastic motion is neglected, as the mean-axes equations do.
//!
//! Equations: THEORY (22), (22a).

use crate::Error;
use crate::equations::{EquationsOfMotion, cross, ensure_size};
use crate::scalar::Scalar;
use crate::sensor::{Quantity, Sensor, SensorPoint};

impl EquationsOfMotion {
    /// Sensor values; `xdot` is the derivative at `x`.
    ///
    /// # Errors
    /// [`Error::Sizes`] if an array has the wrong length.
    pub fn outputs<T: Scalar>(&self, x: &[T], xdot: &[T], y: &mut [T]) -> Result<(), Error> {
        ensure_size("states in x", x.len(), self.layout.n_states())?;
        ensure_size("states in xdot", xdot.len(), self.layout.n_states())?;
        ensure_size("outputs in y", y.len(), self.aircraft.sensors.len())?;
        self.measure(x, xdot, y);
        Ok(())
    }

    /// [`EquationsOfMotion::outputs`] for arrays whose sizes are known to fit.
    pub(crate) fn measure<T: Scalar>(&self, x: &[T], xdot: &[T], y: &mut [T]) {
        for (sensor, y) in self.aircraft.sensors.iter().zip(y) {
            *y = self.output(sensor, x, xdot);
        }
    }

    fn output<T: Scalar>(&self, sensor: &Sensor, x: &[T], xdot: &[T]) -> T {
        let point = sensor.point.as_ref();
        match sensor.quantity {
            Quantity::Alpha => self.alpha(point, x),
            Quantity::Beta => (x[1] / self.air_data(x).speed).asin(),
            Quantity::Airspeed => self.air_data(x).speed,
            Quantity::Altitude => x[self.layout.altitude()],
            Quantity::RollRate => x[3],
            Quantity::PitchRate => {
                x[4] + self.modal_sum(point, |p| &p.rotation_nose_up, &x[self.layout.eta_rate()])
            }
            Quantity::YawRate => x[5],
            Quantity::BankAngle => self.layout.bank_and_pitch(x).0,
            Quantity::PitchAngle => self.layout.bank_and_pitch(x).1,
            Quantity::VerticalAcceleration => self.vertical_acceleration(point, x, xdot),
            Quantity::LoadFactor => {
                let g = self.aircraft.gravity;
                let down = self.layout.down_in_body(x);
                -(self.vertical_acceleration(point, x, xdot) / g - down[2])
            }
        }
    }

    fn alpha<T: Scalar>(&self, point: Option<&SensorPoint>, x: &[T]) -> T {
        let Some(at) = point else {
            return (x[2] / x[0]).atan();
        };
        let turn = cross([x[3], x[4], x[5]], at.position.map(T::from));
        // Upward elastic velocity is along minus body z.
        let rising = self.modal_sum(point, |p| &p.translation_up, &x[self.layout.eta_rate()]);
        let twist = self.modal_sum(point, |p| &p.rotation_nose_up, &x[self.layout.eta()]);
        ((x[2] + turn[2] - rising) / (x[0] + turn[0])).atan() + twist
    }

    fn vertical_acceleration<T: Scalar>(&self, point: Option<&SensorPoint>, x: &[T], xdot: &[T]) -> T {
        let omega = [x[3], x[4], x[5]];
        let mut acceleration = xdot[2] + cross(omega, [x[0], x[1], x[2]])[2];
        if let Some(at) = point {
            let r = at.position.map(T::from);
            acceleration += cross([xdot[3], xdot[4], xdot[5]], r)[2] + cross(omega, cross(omega, r))[2];
            acceleration -= self.modal_sum(point, |p| &p.translation_up, &xdot[self.layout.eta_rate()]);
        }
        acceleration
    }

    /// `sum_k shape_k amplitude_k`; zero for a rigid model or without a point.
    fn modal_sum<T: Scalar>(
        &self,
        point: Option<&SensorPoint>,
        shape: impl Fn(&SensorPoint) -> &Vec<f64>,
        amplitudes: &[T],
    ) -> T {
        point.map_or_else(
            || T::from(0.0),
            |p| {
                shape(p)
                    .iter()
                    .zip(amplitudes)
                    .fold(T::from(0.0), |sum, (&s, &a)| sum + a * s)
            },
        )
    }
}
