//! The equations of motion: Eqs. 2, 3, 9 and 10 on one state vector.
//!
//! Order of evaluation: air variables, then `etadd` (which does not depend on the rigid-body accelerations), then lag
//! rates, then forces, then rigid-body accelerations: no algebraic loop.
//!
//! The hot loop allocates nothing. Its matrices are fused at construction: modal rows and body-force rows multiply the
//! same vectors, and the apparent mass is diagonalised once so that a changing density costs no factorisation.

use crate::Error;
use crate::aircraft::{Aircraft, ControlAerodynamics, ElasticPart, Fidelity, ModelOptions};
use crate::atmosphere;
use crate::layout::Layout;
use crate::scalar::Scalar;
use albatross_numerics::matrix::RowMatrix;
use albatross_numerics::{Mat, eigen};
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

/// Rows that modal and body forces share: modes first, then the six body forces.
#[derive(Debug, Clone)]
struct ElasticMatrices {
    n: usize,
    n_strips: usize,
    /// `-K`, per unit; modes x modes.
    stiffness: RowMatrix,
    /// `-D`; modes x modes.
    damping: RowMatrix,
    /// `Q_eta`, times rho V²; (modes + 6) x modes.
    by_eta: RowMatrix,
    /// `Q_etad`, times rho V; (modes + 6) x modes.
    by_etad: RowMatrix,
    /// `Q_lambda`, times rho V; (modes + 6) x strips. No columns when quasi-steady.
    by_lag: RowMatrix,
    /// Body forces of `etadd`, times rho; 6 x modes.
    by_etadd: RowMatrix,
    /// `W` with `W^T mu W = 1` and `-W^T Q_etadd W = diag(apparent)`.
    mass_shapes: RowMatrix,
    apparent: Vec<f64>,
    /// `[w_eta, w_etad]`, strips x 2 modes, on `[V etad; etadd]`.
    downwash_rate: RowMatrix,
    /// `2 a_i / c` for each lag state, times V.
    lag_rate: Vec<f64>,
    /// `A_i` of each lag.
    lag_gain: Vec<f64>,
    /// Incidence worth of controls on the strips when they are lagged, strips x controls.
    control_incidence: Option<RowMatrix>,
    /// `S cbar [Q_X, Q_u]`, modes x (5 + controls).
    by_air: RowMatrix,
    /// `S cbar Q_0`.
    at_zero: Vec<f64>,
    /// Work of the thrust input on the modes.
    thrust_work: Vec<f64>,
    /// Load of the reference shape, subtracted from the modal loads.
    reference_load: Vec<f64>,
}

/// Buffers of one evaluation.
#[derive(Debug, Clone)]
pub struct Workspace<T> {
    rows: Vec<T>,
    modal: Vec<T>,
    lag_sum: Vec<T>,
    rates: Vec<T>,
    rate_input: Vec<T>,
    air: Vec<T>,
    incidence: Vec<T>,
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
        let zeros = |n: usize| vec![T::from(0.0); n];
        let (n, n_strips) = self.elastic.as_ref().map_or((0, 0), |e| (e.n, e.n_strips));
        Workspace {
            rows: zeros(n + 6),
            modal: zeros(n),
            lag_sum: zeros(n_strips),
            rates: zeros(n_strips),
            rate_input: zeros(2 * n),
            air: zeros(5 + self.aircraft.controls.len()),
            incidence: zeros(n_strips),
        }
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
    pub fn derivative<T: Scalar>(&self, x: &[T], u: &[T], work: &mut Workspace<T>, xdot: &mut [T]) {
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
        density: f64,
        speed: f64,
        variables: [f64; 5],
        controls: &[f64],
        thrust: f64,
    ) -> Vec<f64> {
        let Some(elastic) = &self.elastic else {
            return Vec::new();
        };
        let dynamic_pressure = 0.5 * density * speed * speed;
        let air: Vec<f64> = variables.iter().chain(controls).copied().collect();
        let mut load = vec![0.0; elastic.n];
        elastic.by_air.mul_into(&air, &mut load);
        for ((load, zero), work) in load.iter_mut().zip(&elastic.at_zero).zip(&elastic.thrust_work) {
            *load = dynamic_pressure * (*load + zero) + thrust * work;
        }
        load
    }

    /// Lag states in equilibrium with held controls: zero unless controls are lagged.
    pub(crate) fn steady_lags(&self, speed: f64, controls: &[f64]) -> Vec<f64> {
        let Some(elastic) = &self.elastic else {
            return Vec::new();
        };
        let mut lags = vec![0.0; elastic.lag_rate.len()];
        if let Some(worth) = &elastic.control_incidence {
            let mut incidence = vec![0.0; elastic.n_strips];
            worth.mul_into(controls, &mut incidence);
            for (group, gain) in lags.chunks_exact_mut(elastic.n_strips).zip(&elastic.lag_gain) {
                for (lag, w) in group.iter_mut().zip(&incidence) {
                    *lag = -gain * speed * w;
                }
            }
        }
        lags
    }
}

impl ElasticMatrices {
    fn new(aircraft: &Aircraft, part: &ElasticPart, options: &ModelOptions) -> Result<Self, Error> {
        let model = &part.model;
        let (n, n_strips) = (model.n_modes(), model.strips.len());
        let unsteady = options.fidelity == Fidelity::Unsteady;
        let stack = |modes: &Mat<f64>, body: &Mat<f64>| {
            RowMatrix::from_fn(n + 6, modes.ncols(), |i, j| {
                if i < n { modes[(i, j)] } else { body[(i - n, j)] }
            })
        };
        let (own, rows) = (&model.forces, &part.rigid_rows);
        let (by_eta, by_etad, apparent_mass) = if unsteady {
            (
                stack(&own.eta_eta(), &rows.eta_eta()),
                stack(&own.eta_etad(), &rows.eta_etad()),
                -own.eta_etadd_nc.clone(),
            )
        } else {
            (
                stack(&own.eta_eta_c, &rows.eta_eta_c),
                stack(&own.eta_etad_c, &rows.eta_etad_c),
                Mat::zeros(n, n),
            )
        };
        let lags: &[albatross_strip::kernels::Lag] = if unsteady { &model.lags } else { &[] };
        let by_lag = if lags.is_empty() {
            RowMatrix::zeros(n + 6, 0)
        } else {
            stack(&own.eta_lambda_c, &rows.eta_lambda_c)
        };
        let by_etadd = RowMatrix::from_fn(
            6,
            n,
            |i, j| if unsteady { rows.eta_etadd_nc[(i, j)] } else { 0.0 },
        );
        let symmetric = Mat::from_fn(n, n, |i, j| 0.5 * (apparent_mass[(i, j)] + apparent_mass[(j, i)]));
        let (apparent, shapes) =
            eigen::symmetric_generalized(symmetric.as_ref(), model.structure.mass.as_ref())?;
        let (w_eta, w_etad) = (&model.downwash.w_eta, &model.downwash.w_etad);
        let lagged = options.control_aerodynamics == ControlAerodynamics::Lagged && !lags.is_empty();
        let moment_area = aircraft.reference.area * aircraft.reference.chord;
        let n_controls = aircraft.controls.len();
        let mut thrust_work = vec![0.0; n];
        for engine in &aircraft.engines {
            for (sum, work) in thrust_work.iter_mut().zip(&engine.modal_work) {
                *sum += engine.share * work;
            }
        }
        Ok(Self {
            n,
            n_strips,
            stiffness: RowMatrix::from_fn(n, n, |i, j| -model.structure.stiffness[(i, j)]),
            damping: RowMatrix::from_fn(n, n, |i, j| -model.structure.damping[(i, j)]),
            by_eta,
            by_etad,
            by_lag,
            by_etadd,
            mass_shapes: RowMatrix::from_fn(n, n, |i, j| shapes[(i, j)]),
            apparent,
            downwash_rate: RowMatrix::from_fn(n_strips, 2 * n, |j, k| {
                if k < n { w_eta[(j, k)] } else { w_etad[(j, k - n)] }
            }),
            lag_rate: lags
                .iter()
                .flat_map(|l| model.strips.iter().map(|s| 2.0 * l.rate / s.chord))
                .collect(),
            lag_gain: lags.iter().map(|l| l.gain).collect(),
            control_incidence: lagged
                .then(|| RowMatrix::from_fn(n_strips, n_controls, |j, c| part.control_incidence[(j, c)])),
            by_air: RowMatrix::from_fn(n, 5 + n_controls, |k, x| {
                moment_area
                    * if x < 5 {
                        part.q_x[(k, x)]
                    } else {
                        part.q_u[(k, x - 5)]
                    }
            }),
            at_zero: part.q_0.iter().map(|q| moment_area * q).collect(),
            thrust_work,
            reference_load: vec![0.0; n],
        })
    }

    /// Writes the rates of modes and lags, and leaves the six body forces in `work.rows[n..]`.
    #[allow(clippy::too_many_arguments)]
    fn evaluate<T: Scalar>(
        &self,
        layout: &Layout,
        air: &AirData<T>,
        x: &[T],
        controls: &[T],
        thrust: T,
        work: &mut Workspace<T>,
        xdot: &mut [T],
    ) {
        let n = self.n;
        let (eta, etad, lags) = (&x[layout.eta()], &x[layout.eta_rate()], &x[layout.lags()]);
        let rho_v = air.density * air.speed;
        let rho_v2 = rho_v * air.speed;

        if let Some(worth) = &self.control_incidence {
            T::multiply(worth, controls, &mut work.incidence);
        }

        // Eq. 10, right side: modes and body forces together.
        work.rows.iter_mut().for_each(|r| *r = T::from(0.0));
        T::multiply_add(rho_v2, &self.by_eta, eta, &mut work.rows);
        T::multiply_add(rho_v, &self.by_etad, etad, &mut work.rows);
        if !self.lag_gain.is_empty() {
            work.lag_sum.copy_from_slice(&lags[..self.n_strips]);
            for group in lags.chunks_exact(self.n_strips).skip(1) {
                for (sum, &lag) in work.lag_sum.iter_mut().zip(group) {
                    *sum += lag;
                }
            }
            if self.control_incidence.is_some() {
                let total_gain: f64 = self.lag_gain.iter().sum();
                for (sum, &w) in work.lag_sum.iter_mut().zip(&work.incidence) {
                    *sum += air.speed * w * total_gain;
                }
            }
            T::multiply_add(rho_v, &self.by_lag, &work.lag_sum, &mut work.rows);
        }
        let (modal_rows, body_rows) = work.rows.split_at_mut(n);
        T::multiply_add(T::from(1.0), &self.stiffness, eta, modal_rows);
        T::multiply_add(T::from(1.0), &self.damping, etad, modal_rows);
        work.air[..5].copy_from_slice(&air.variables);
        work.air[5..].copy_from_slice(controls);
        T::multiply(&self.by_air, &work.air, &mut work.modal);
        for k in 0..n {
            modal_rows[k] += (work.modal[k] + self.at_zero[k]) * air.dynamic_pressure
                + thrust * self.thrust_work[k]
                - self.reference_load[k];
        }

        // [mu - rho Q_etadd]^-1 by the shapes that make both diagonal.
        T::multiply_transposed(&self.mass_shapes, modal_rows, &mut work.modal);
        for (r, &apparent) in work.modal.iter_mut().zip(&self.apparent) {
            *r /= air.density * apparent + 1.0;
        }
        let rates = layout.eta_rate();
        T::multiply(&self.mass_shapes, &work.modal, &mut xdot[rates.clone()]);
        xdot[layout.eta()].copy_from_slice(etad);
        T::multiply_add(air.density, &self.by_etadd, &xdot[rates.clone()], body_rows);

        // Eq. 9 with V(t) frozen in the downwash rate.
        if !self.lag_gain.is_empty() {
            for (k, &rate) in etad.iter().enumerate() {
                work.rate_input[k] = rate * air.speed;
            }
            work.rate_input[n..].copy_from_slice(&xdot[rates]);
            T::multiply(&self.downwash_rate, &work.rate_input, &mut work.rates);
            let lag_rates = &mut xdot[layout.lags()];
            for (i, &gain) in self.lag_gain.iter().enumerate() {
                let group = i * self.n_strips..(i + 1) * self.n_strips;
                let decay = &self.lag_rate[group.clone()];
                for (((rate, &lag), &a), &w) in lag_rates[group.clone()]
                    .iter_mut()
                    .zip(&lags[group])
                    .zip(decay)
                    .zip(&work.rates)
                {
                    *rate = lag * air.speed * a + w * gain;
                }
            }
            if self.control_incidence.is_some() {
                let speed_squared = air.speed * air.speed;
                for (i, &gain) in self.lag_gain.iter().enumerate() {
                    let group = i * self.n_strips..(i + 1) * self.n_strips;
                    let decay = &self.lag_rate[group.clone()];
                    for ((rate, &a), &w) in lag_rates[group].iter_mut().zip(decay).zip(&work.incidence) {
                        *rate += speed_squared * w * (a * gain);
                    }
                }
            }
        }
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
