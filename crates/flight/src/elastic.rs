//! The elastic part of the equations: Eqs. 9 and 10, and the body-force rows of Eqs. 7 and 8, on one state vector.
//!
//! Modal rows and body-force rows multiply the same vectors, so they are stacked at construction: modes first, then
//! `Fx Fy Fz Mx My Mz`. The apparent mass is diagonalised once, so that a changing density costs no factorisation.
//!
//! Equations: THEORY (11), (16b), (21), (21d).

use crate::Error;
use crate::aircraft::{Aircraft, ControlAerodynamics, ElasticPart, Fidelity, ModelOptions};
use crate::columns::ColumnMatrix;
use crate::equations::AirData;
use crate::layout::Layout;
use crate::scalar::Scalar;
use albatross_numerics::{Mat, eigen};
use albatross_strip::GeneralizedForces;
use albatross_strip::kernels::Lag;

/// Constant matrices of the elastic part.
#[derive(Debug, Clone)]
pub(crate) struct ElasticMatrices {
    pub(crate) n: usize,
    pub(crate) n_strips: usize,
    /// `[Q_eta, Q_etad]`, on `rho V [V eta; etad]`; (modes + 6) x 2 modes.
    by_motion: ColumnMatrix,
    /// `Q_lambda`, times rho V; (modes + 6) x strips. No columns when quasi-steady.
    by_lag: ColumnMatrix,
    /// `-[K, D]`, on `[eta; etad]`; modes x 2 modes.
    structure: ColumnMatrix,
    /// Body forces of `etadd`, times rho; 6 x modes.
    by_etadd: ColumnMatrix,
    /// `W` with `W^T mu W = 1` and `-W^T Q_etadd W = diag(apparent)`.
    mass_shapes: ColumnMatrix,
    mass_shapes_transposed: ColumnMatrix,
    apparent: Vec<f64>,
    /// `[w_eta, w_etad]`, on `[V etad; etadd]`; strips x 2 modes.
    downwash_rate: ColumnMatrix,
    /// `2 a_i / c` of each lag state, times V.
    pub(crate) lag_rate: Vec<f64>,
    /// `A_i` of each lag.
    lag_gain: Vec<f64>,
    /// Incidence that controls are worth on the strips, strips x controls; only where they are lagged.
    control_incidence: Option<ColumnMatrix>,
    /// `S cbar [Q_X, Q_u]`, modes x (5 + controls).
    by_air: ColumnMatrix,
    /// `S cbar Q_0`.
    at_zero: Vec<f64>,
    /// Work of the thrust input on the modes.
    thrust_work: Vec<f64>,
    /// Load of the reference shape, subtracted from the modal loads.
    pub(crate) reference_load: Vec<f64>,
}

/// Buffers of one evaluation.
#[derive(Debug, Clone)]
pub struct Workspace<T> {
    /// Modal forces, then the six body forces.
    pub(crate) rows: Vec<T>,
    modal: Vec<T>,
    body: [T; 6],
    /// A vector of the length of `[eta; etad]`.
    motion: Vec<T>,
    lag_sum: Vec<T>,
    downwash_rate: Vec<T>,
    air: Vec<T>,
    incidence: Vec<T>,
}

impl<T: Scalar> Workspace<T> {
    pub(crate) fn new(n_modes: usize, n_strips: usize, n_controls: usize) -> Self {
        let zeros = |n: usize| vec![T::from(0.0); n];
        Self {
            rows: zeros(n_modes + 6),
            modal: zeros(n_modes),
            body: [T::from(0.0); 6],
            motion: zeros(2 * n_modes),
            lag_sum: zeros(n_strips),
            downwash_rate: zeros(n_strips),
            air: zeros(5 + n_controls),
            incidence: zeros(n_strips),
        }
    }

    /// Whether the buffers have the sizes that `new` gives them.
    pub(crate) fn fits(&self, n_modes: usize, n_strips: usize, n_controls: usize) -> bool {
        self.modal.len() == n_modes && self.lag_sum.len() == n_strips && self.air.len() == 5 + n_controls
    }
}

impl ElasticMatrices {
    pub(crate) fn new(
        aircraft: &Aircraft,
        part: &ElasticPart,
        options: &ModelOptions,
    ) -> Result<Self, Error> {
        let model = &part.model;
        let (n, n_strips) = (model.n_modes(), model.strips.len());
        let unsteady = options.fidelity == Fidelity::Unsteady;
        let lags: &[Lag] = if unsteady { &model.lags } else { &[] };
        let lagged = options.control_aerodynamics == ControlAerodynamics::Lagged && !lags.is_empty();
        let (w_eta, w_etad) = (&model.downwash.w_eta, &model.downwash.w_etad);
        let moment_area = aircraft.reference.area * aircraft.reference.chord;
        let n_controls = aircraft.controls.len();
        let (mass_shapes, apparent) = diagonal_mass(part, unsteady)?;
        Ok(Self {
            n,
            n_strips,
            by_motion: by_motion(part, unsteady),
            by_lag: ColumnMatrix::from_fn(n + 6, if lags.is_empty() { 0 } else { n_strips }, |i, j| {
                stacked(&model.forces.eta_lambda_c, &part.rigid_rows.eta_lambda_c, i, j)
            }),
            structure: ColumnMatrix::from_fn(n, 2 * n, |i, j| {
                if j < n {
                    -model.structure.stiffness[(i, j)]
                } else {
                    -model.structure.damping[(i, j - n)]
                }
            }),
            by_etadd: ColumnMatrix::from_fn(6, n, |i, j| {
                if unsteady {
                    part.rigid_rows.eta_etadd_nc[(i, j)]
                } else {
                    0.0
                }
            }),
            mass_shapes: ColumnMatrix::from_fn(n, n, |i, j| mass_shapes[(i, j)]),
            mass_shapes_transposed: ColumnMatrix::from_fn(n, n, |i, j| mass_shapes[(j, i)]),
            apparent,
            downwash_rate: ColumnMatrix::from_fn(n_strips, 2 * n, |j, k| {
                if k < n { w_eta[(j, k)] } else { w_etad[(j, k - n)] }
            }),
            lag_rate: lags
                .iter()
                .flat_map(|l| model.strips.iter().map(|s| 2.0 * l.rate / s.chord))
                .collect(),
            lag_gain: lags.iter().map(|l| l.gain).collect(),
            control_incidence: lagged
                .then(|| ColumnMatrix::from_fn(n_strips, n_controls, |j, c| part.control_incidence[(j, c)])),
            by_air: ColumnMatrix::from_fn(n, 5 + n_controls, |k, x| {
                moment_area
                    * if x < 5 {
                        part.q_x[(k, x)]
                    } else {
                        part.q_u[(k, x - 5)]
                    }
            }),
            at_zero: part.q_0.iter().map(|q| moment_area * q).collect(),
            thrust_work: thrust_work(aircraft, n),
            reference_load: vec![0.0; n],
        })
    }

    /// Generalised loads of the air and the thrust on the modes at `eta = 0`.
    pub(crate) fn load_at_rest(&self, dynamic_pressure: f64, air: &[f64], thrust: f64) -> Vec<f64> {
        let mut load = vec![0.0; self.n];
        self.by_air.multiply(air, &mut load);
        for ((load, zero), work) in load.iter_mut().zip(&self.at_zero).zip(&self.thrust_work) {
            *load = dynamic_pressure * (*load + zero) + thrust * work;
        }
        load
    }

    /// Lag states in equilibrium with held controls: zero unless controls are lagged.
    pub(crate) fn steady_lags(&self, speed: f64, controls: &[f64]) -> Vec<f64> {
        let mut lags = vec![0.0; self.lag_rate.len()];
        if let Some(worth) = &self.control_incidence {
            let mut incidence = vec![0.0; self.n_strips];
            worth.multiply(controls, &mut incidence);
            for (state, (gain, w)) in lags.iter_mut().zip(self.each_lag(&incidence)) {
                *state = -gain * speed * w;
            }
        }
        lags
    }

    /// Gain and a strip's value for each lag state in turn.
    fn each_lag<'a, T: Copy>(&'a self, of_strips: &'a [T]) -> impl Iterator<Item = (f64, T)> + 'a {
        self.lag_gain
            .iter()
            .flat_map(move |&gain| of_strips.iter().map(move |&value| (gain, value)))
    }

    /// Writes the rates of modes and lags, and leaves the six body forces in `work.rows[n..]`.
    #[allow(clippy::too_many_arguments)]
    pub(crate) fn evaluate<T: Scalar>(
        &self,
        layout: &Layout,
        air: &AirData<T>,
        x: &[T],
        controls: &[T],
        thrust: T,
        work: &mut Workspace<T>,
        xdot: &mut [T],
    ) {
        let (motion, lags) = (&x[layout.motion()], &x[layout.lags()]);
        if let Some(worth) = &self.control_incidence {
            worth.multiply(controls, &mut work.incidence);
        }
        self.air_forces(air, motion, lags, work);
        self.modal_forces(air, motion, controls, thrust, work);
        self.accelerations(air, work, &mut xdot[layout.eta_rate()]);
        let (rigid_and_modes, lag_rates) = xdot.split_at_mut(layout.lags().start);
        let etadd = &rigid_and_modes[layout.eta_rate()];
        self.by_etadd.multiply(etadd, &mut work.body);
        for (force, apparent) in work.rows[self.n..].iter_mut().zip(work.body) {
            *force += apparent * air.density;
        }
        if !self.lag_gain.is_empty() {
            self.lag_rates(air, &motion[self.n..], etadd, lags, work, lag_rates);
        }
        xdot[layout.eta()].copy_from_slice(&motion[self.n..]);
    }

    /// Forces of elastic motion and lags on modes and body: the circulatory and apparent-mass terms of Eqs. 7, 8, 10.
    fn air_forces<T: Scalar>(&self, air: &AirData<T>, motion: &[T], lags: &[T], work: &mut Workspace<T>) {
        let (eta, etad) = motion.split_at(self.n);
        for (scaled, &amplitude) in work.motion.iter_mut().zip(eta) {
            *scaled = amplitude * air.speed;
        }
        work.motion[self.n..].copy_from_slice(etad);
        self.by_motion.multiply(&work.motion, &mut work.rows);
        if let [first, others @ ..] = self.lag_gain.as_slice() {
            work.lag_sum.copy_from_slice(&lags[..self.n_strips]);
            for group in 1..=others.len() {
                let group = &lags[group * self.n_strips..];
                work.lag_sum
                    .iter_mut()
                    .zip(group)
                    .for_each(|(sum, &lag)| *sum += lag);
            }
            if self.control_incidence.is_some() {
                // The states hold lambda_i - A_i V w; see `lag_rates`.
                let total_gain = others.iter().fold(*first, |sum, gain| sum + gain);
                for (sum, &w) in work.lag_sum.iter_mut().zip(&work.incidence) {
                    *sum += air.speed * w * total_gain;
                }
            }
            self.by_lag.multiply_add(&work.lag_sum, &mut work.rows);
        }
        let rho_v = air.density * air.speed;
        work.rows.iter_mut().for_each(|force| *force *= rho_v);
    }

    /// Adds structure, rigid-body motion, controls and thrust to the modal rows: the rest of Eq. 10's right side.
    fn modal_forces<T: Scalar>(
        &self,
        air: &AirData<T>,
        motion: &[T],
        controls: &[T],
        thrust: T,
        work: &mut Workspace<T>,
    ) {
        let modal_rows = &mut work.rows[..self.n];
        self.structure.multiply_add(motion, modal_rows);
        work.air[..5].copy_from_slice(&air.variables);
        work.air[5..].copy_from_slice(controls);
        self.by_air.multiply(&work.air, &mut work.modal);
        for (k, force) in modal_rows.iter_mut().enumerate() {
            *force += (work.modal[k] + self.at_zero[k]) * air.dynamic_pressure + thrust * self.thrust_work[k]
                - self.reference_load[k];
        }
    }

    /// `etadd = [mu - rho Q_etadd]^-1 (modal rows)`, by the shapes that make both matrices diagonal.
    fn accelerations<T: Scalar>(&self, air: &AirData<T>, work: &mut Workspace<T>, etadd: &mut [T]) {
        self.mass_shapes_transposed
            .multiply(&work.rows[..self.n], &mut work.modal);
        for (force, &apparent) in work.modal.iter_mut().zip(&self.apparent) {
            *force /= air.density * apparent + 1.0;
        }
        self.mass_shapes.multiply(&work.modal, etadd);
    }

    /// Eq. 9 with V(t) frozen in the downwash rate.
    ///
    /// A lagged control enters without its rate: the state is `nu_i = lambda_i - A_i V w`, with
    /// `nu_i' = (2 V a_i/c) (nu_i + A_i V w)`.
    fn lag_rates<T: Scalar>(
        &self,
        air: &AirData<T>,
        etad: &[T],
        etadd: &[T],
        lags: &[T],
        work: &mut Workspace<T>,
        rates: &mut [T],
    ) {
        for (scaled, &rate) in work.motion.iter_mut().zip(etad) {
            *scaled = rate * air.speed;
        }
        work.motion[self.n..].copy_from_slice(etadd);
        self.downwash_rate.multiply(&work.motion, &mut work.downwash_rate);
        let n_strips = self.n_strips.max(1);
        let groups = rates.chunks_exact_mut(n_strips).zip(lags.chunks_exact(n_strips));
        for (((rates, lags), decay), &gain) in groups
            .zip(self.lag_rate.chunks_exact(n_strips))
            .zip(&self.lag_gain)
        {
            for (((rate, &lag), &decay), &w) in rates.iter_mut().zip(lags).zip(decay).zip(&work.downwash_rate)
            {
                *rate = lag * air.speed * decay + w * gain;
            }
            if self.control_incidence.is_some() {
                let scale = air.speed * air.speed * gain;
                for ((rate, &decay), &w) in rates.iter_mut().zip(decay).zip(&work.incidence) {
                    *rate += scale * w * decay;
                }
            }
        }
    }
}

/// Entry of the modal rows stacked on the body rows.
fn stacked(modes: &Mat<f64>, body: &Mat<f64>, i: usize, j: usize) -> f64 {
    if i < modes.nrows() {
        modes[(i, j)]
    } else {
        body[(i - modes.nrows(), j)]
    }
}

/// `[Q_eta, Q_etad]` of modes and body. Quasi-steady air is circulation that follows the downwash at once,
/// `rho V Q_lambda (V w_eta eta + w_etad etad)`, however the apparent-mass terms are booked.
fn by_motion(part: &ElasticPart, unsteady: bool) -> ColumnMatrix {
    let (own, rows) = (&part.model.forces, &part.rigid_rows);
    let (w_eta, w_etad) = (&part.model.downwash.w_eta, &part.model.downwash.w_etad);
    let n = part.model.n_modes();
    let of = |q: &GeneralizedForces| {
        if unsteady {
            (q.eta_eta(), q.eta_etad())
        } else {
            (&q.eta_lambda_c * w_eta, &q.eta_lambda_c * w_etad)
        }
    };
    let ((eta, etad), (body_eta, body_etad)) = (of(own), of(rows));
    ColumnMatrix::from_fn(n + 6, 2 * n, |i, j| {
        if j < n {
            stacked(&eta, &body_eta, i, j)
        } else {
            stacked(&etad, &body_etad, i, j - n)
        }
    })
}

/// Shapes `W` (in columns) and the apparent mass in them, with `W^T mu W = 1`.
fn diagonal_mass(part: &ElasticPart, unsteady: bool) -> Result<(Mat<f64>, Vec<f64>), Error> {
    let (own, n) = (&part.model.forces.eta_etadd_nc, part.model.n_modes());
    let apparent_mass = Mat::from_fn(n, n, |i, j| {
        if unsteady {
            -0.5 * (own[(i, j)] + own[(j, i)])
        } else {
            0.0
        }
    });
    let (apparent, shapes) =
        eigen::symmetric_generalized(apparent_mass.as_ref(), part.model.structure.mass.as_ref())?;
    Ok((shapes, apparent))
}

fn thrust_work(aircraft: &Aircraft, n: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n];
    for engine in &aircraft.engines {
        for (sum, work) in sum.iter_mut().zip(&engine.modal_work) {
            *sum += engine.share * work;
        }
    }
    sum
}
