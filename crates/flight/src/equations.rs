//! The equations of motion: Eqs. 2, 3, 9 and 10 on one state vector.
//!
//! Order of evaluation: air variables, then `etadd` (which does not depend on the rigid-body accelerations), then lag
//! rates, then forces, then rigid-body accelerations: no algebraic loop. Nothing is allocated.
//!
//! Equations: THEORY (19), (20), (21).

use crate::Error;
use crate::aircraft::{Aircraft, Fidelity, ModelOptions};
use crate::atmosphere;
use crate::elastic::{ElasticMatrices, Workspace};
use crate::layout::Layout;
use crate::scalar::Scalar;
use nalgebra::Matrix3;

/// The assembled equations of one aircraft with one set of options.
#[derive(Debug, Clone)]
pub struct EquationsOfMotion {
    pub(crate) aircraft: Aircraft,
    pub(crate) options: ModelOptions,
    pub(crate) layout: Layout,
    inverse_inertia: [[f64; 3]; 3],
    elastic: Option<ElasticMatrices>,
}

/// Air data of one evaluation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AirData<T> {
    pub(crate) density: T,
    pub(crate) speed: T,
    pub(crate) dynamic_pressure: T,
    /// `[alpha, beta, p_hat, q_hat, r_hat]`.
    pub(crate) variables: [T; 5],
}

impl EquationsOfMotion {
    /// Assembles the equations.
    ///
    /// # Errors
    /// What [`Aircraft::check`] returns; [`Error::Numerics`] if the inertia tensor or the modal mass is singular.
    pub fn new(aircraft: &Aircraft, options: ModelOptions) -> Result<Self, Error> {
        aircraft.check()?;
        let inertia = Matrix3::from_fn(|i, j| aircraft.inertia[i][j]);
        let inverse = inertia.try_inverse().ok_or(Error::BadQuantity {
            quantity: "determinant of the inertia tensor",
            value: inertia.determinant(),
            expected: "a regular tensor",
        })?;
        let elastic = match (&aircraft.elastic, options.fidelity) {
            (None, _) | (_, Fidelity::Rigid) => None,
            (Some(part), _) => Some(ElasticMatrices::new(aircraft, part, &options)?),
        };
        let (n_modes, n_strips, n_lags) = elastic
            .as_ref()
            .map_or((0, 0, 0), |e| (e.n, e.n_strips, e.lag_rate.len()));
        let layout = Layout::new(options.attitude, options.position, n_modes, n_strips, n_lags);
        let inverse_inertia = std::array::from_fn(|i| std::array::from_fn(|j| inverse[(i, j)]));
        Ok(Self {
            aircraft: aircraft.clone(),
            options,
            layout,
            inverse_inertia,
            elastic,
        })
    }

    /// Where each state sits in the state vector.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The aircraft.
    pub fn aircraft(&self) -> &Aircraft {
        &self.aircraft
    }

    /// The options.
    pub fn options(&self) -> ModelOptions {
        self.options
    }

    /// Number of inputs: the controls and the thrust.
    pub fn n_inputs(&self) -> usize {
        self.aircraft.controls.len() + 1
    }

    /// Number of modes in the state vector.
    pub fn n_modes(&self) -> usize {
        self.layout.n_modes
    }

    /// Rates of decay of the lag states at a speed, zero for all other states: the diagonal that
    /// [`albatross_numerics::integrate::EtdRk4`] takes out \[1/s\].
    pub fn lag_diagonal(&self, speed: f64) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.layout.n_states()];
        if let Some(elastic) = &self.elastic {
            for (d, rate) in diagonal[self.layout.lags()].iter_mut().zip(&elastic.lag_rate) {
                *d = rate * speed;
            }
        }
        diagonal
    }

    /// Buffers for [`EquationsOfMotion::derivative`].
    pub fn workspace<T: Scalar>(&self) -> Workspace<T> {
        let (n_modes, n_strips) = self.elastic_sizes();
        Workspace::new(n_modes, n_strips, self.aircraft.controls.len())
    }

    fn elastic_sizes(&self) -> (usize, usize) {
        self.elastic.as_ref().map_or((0, 0), |e| (e.n, e.n_strips))
    }

    /// Sets the load that the modes' reference shape carries already (no-op for a rigid model).
    pub(crate) fn set_reference_load(&mut self, load: Vec<f64>) {
        if let Some(elastic) = &mut self.elastic {
            elastic.reference_load = load;
        }
    }

    pub(crate) fn air_data<T: Scalar>(&self, x: &[T]) -> AirData<T> {
        let [u, v, w] = [x[0], x[1], x[2]];
        let speed = (u * u + v * v + w * w).sqrt();
        let density = atmosphere::standard(x[self.layout.altitude()]).density;
        let half_time = speed.recip() * 0.5;
        let reference = &self.aircraft.reference;
        AirData {
            density,
            speed,
            dynamic_pressure: density * speed * speed * 0.5,
            variables: [
                (w / u).atan(),
                (v / speed).asin(),
                x[3] * half_time * reference.span,
                x[4] * half_time * reference.chord,
                x[5] * half_time * reference.span,
            ],
        }
    }

    /// `xdot = f(x, u)`; `u` holds the controls \[rad\] and then the thrust \[N\].
    ///
    /// # Errors
    /// [`Error::Sizes`] if `x`, `u` or `xdot` have the wrong length or `work` was made by other equations.
    pub fn derivative<T: Scalar>(
        &self,
        x: &[T],
        u: &[T],
        work: &mut Workspace<T>,
        xdot: &mut [T],
    ) -> Result<(), Error> {
        let (n_modes, n_strips) = self.elastic_sizes();
        let n_states = self.layout.n_states();
        ensure_size("states in x", x.len(), n_states)?;
        ensure_size("states in xdot", xdot.len(), n_states)?;
        ensure_size("inputs in u", u.len(), self.n_inputs())?;
        if !work.fits(n_modes, n_strips, self.aircraft.controls.len()) {
            return Err(Error::Sizes {
                what: "body and modal rows of the workspace",
                expected: n_modes + 6,
                found: work.rows.len(),
            });
        }
        self.rates(x, u, work, xdot);
        Ok(())
    }

    /// [`EquationsOfMotion::derivative`] for arrays whose sizes are known to fit.
    pub(crate) fn rates<T: Scalar>(&self, x: &[T], u: &[T], work: &mut Workspace<T>, xdot: &mut [T]) {
        let air = self.air_data(x);
        let (controls, thrust) = u.split_at(self.aircraft.controls.len());
        let thrust = thrust.first().copied().unwrap_or_else(|| T::from(0.0));
        let loads = self
            .aircraft
            .rigid
            .body_loads(&air.variables, controls, &self.aircraft.reference);
        let mut force = loads.force.map(|f| f * air.dynamic_pressure);
        let mut moment = loads.moment.map(|m| m * air.dynamic_pressure);
        for engine in &self.aircraft.engines {
            let t = engine.direction.map(|d| thrust * (d * engine.share));
            let r = engine.position;
            for i in 0..3 {
                force[i] += t[i];
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                moment[i] += t[k] * r[j] - t[j] * r[k];
            }
        }
        if let Some(elastic) = &self.elastic {
            elastic.evaluate(&self.layout, &air, x, controls, thrust, work, xdot);
            for i in 0..3 {
                force[i] += work.rows[elastic.n + i];
                moment[i] += work.rows[elastic.n + 3 + i];
            }
        }
        self.rigid_body(x, force, moment, xdot);
    }

    fn rigid_body<T: Scalar>(&self, x: &[T], force: [T; 3], moment: [T; 3], xdot: &mut [T]) {
        let velocity = [x[0], x[1], x[2]];
        let omega = [x[3], x[4], x[5]];
        let down = self.layout.down_in_body(x);
        let turn = cross(omega, velocity);
        for i in 0..3 {
            xdot[i] = force[i] / self.aircraft.mass + down[i] * self.aircraft.gravity - turn[i];
        }
        let momentum = times(&self.aircraft.inertia, omega);
        let gyroscopic = cross(omega, momentum);
        let net: [T; 3] = std::array::from_fn(|i| moment[i] - gyroscopic[i]);
        let acceleration = times(&self.inverse_inertia, net);
        xdot[3..6].copy_from_slice(&acceleration);
        self.layout
            .attitude_and_position_rates(x, velocity, omega, down, xdot);
    }

    /// Generalised loads of the air and the thrust on the modes at given air variables, `eta = 0`.
    pub(crate) fn modal_load(
        &self,
        dynamic_pressure: f64,
        variables: [f64; 5],
        controls: &[f64],
        thrust: f64,
    ) -> Vec<f64> {
        let air: Vec<f64> = variables.iter().chain(controls).copied().collect();
        self.elastic
            .as_ref()
            .map_or_else(Vec::new, |e| e.load_at_rest(dynamic_pressure, &air, thrust))
    }

    /// Lag states in equilibrium with held controls: zero unless controls are lagged.
    pub(crate) fn steady_lags(&self, speed: f64, controls: &[f64]) -> Vec<f64> {
        self.elastic
            .as_ref()
            .map_or_else(Vec::new, |e| e.steady_lags(speed, controls))
    }
}

/// Refuses an array of the wrong length.
pub(crate) fn ensure_size(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::Sizes {
            what,
            expected,
            found,
        })
    }
}

/// `a x b`.
pub(crate) fn cross<T: Scalar>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn times<T: Scalar>(matrix: &[[f64; 3]; 3], x: [T; 3]) -> [T; 3] {
    matrix.map(|row| x[0] * row[0] + x[1] * row[1] + x[2] * row[2])
}
