//! The elastic aircraft in the flow: Eqs. 10 to 12 and the state matrix of modes and lags.
//!
//! ```text
//! [mu - rho Q_etadd] etadd = [-2 mu xi omega + rho V Q_etad] etad + [-mu omega^2 + rho V^2 Q_eta] eta
//!                            + rho V Q_lambda (lambda_1 + lambda_2) + q S cbar (Q_X X + Q_u u)
//! ```
//!
//! Eq. 12 is printed with `Q_eta_etadd` inside Pi_1 and Pi_2; Eq. 10 shows that `Q_eta_eta` and `Q_eta_etad` are
//! meant, and they are used here.
//!
//! Equations: THEORY (21), (24), (25).

use crate::Error;
use crate::check::{ensure_finite_entries, ensure_not_negative, ensure_shape};
use crate::forces::{
    Downwash, GeneralizedForces, Split, downwash, generalized_forces, generalized_forces_between,
};
use crate::kernels::Lag;
use crate::shapes::StripShapes;
use crate::strip::{Strip, StripTheory};
use albatross_numerics::{Mat, solve};

/// Most states of a state matrix: one of as many takes 3.2 GB.
const MOST_STATES: usize = 20_000;

/// Structural mass, damping and stiffness in the shapes' coordinates, n x n, symmetric.
#[derive(Debug, Clone)]
pub struct Structure {
    /// Mass matrix (diagonal of modal masses for normal modes) \[kg m² per unit²\].
    pub mass: Mat<f64>,
    /// Damping matrix \[kg m²/s per unit²\].
    pub damping: Mat<f64>,
    /// Stiffness matrix \[N m per unit²\].
    pub stiffness: Mat<f64>,
}

impl Structure {
    /// Normal modes of modal mass `mu`, frequency `omega` \[rad/s\] and damping ratio `xi`.
    ///
    /// # Errors
    /// [`Error::BadMode`] for a modal mass that is not positive or a value that is not finite, [`Error::Shape`] if the
    /// three differ in length.
    pub fn modal(mu: &[f64], omega_rad_s: &[f64], xi: &[f64]) -> Result<Self, Error> {
        let n = mu.len();
        for (what, len) in [("omega", omega_rad_s.len()), ("xi", xi.len())] {
            if len != n {
                return Err(Error::Shape {
                    what,
                    expected: (n, 1),
                    found: (len, 1),
                });
            }
        }
        for (index, ((&m, &w), &x)) in mu.iter().zip(omega_rad_s).zip(xi).enumerate() {
            if !(m.is_finite() && m > 0.0) {
                return Err(Error::BadMode {
                    index,
                    quantity: "modal mass",
                    value: m,
                    expected: "a positive number",
                });
            }
            if !(w.is_finite() && w >= 0.0) {
                return Err(Error::BadMode {
                    index,
                    quantity: "frequency",
                    value: w,
                    expected: "zero or more",
                });
            }
            if !x.is_finite() {
                return Err(Error::BadMode {
                    index,
                    quantity: "damping ratio",
                    value: x,
                    expected: "a number",
                });
            }
        }
        let diagonal = |f: &dyn Fn(usize) -> f64| Mat::from_fn(n, n, |i, j| if i == j { f(i) } else { 0.0 });
        Ok(Self {
            mass: diagonal(&|i| mu[i]),
            damping: diagonal(&|i| 2.0 * mu[i] * xi[i] * omega_rad_s[i]),
            stiffness: diagonal(&|i| mu[i] * omega_rad_s[i].powi(2)),
        })
    }

    /// Checks that all matrices are square, of one size, and finite.
    ///
    /// # Errors
    /// [`Error::Shape`], [`Error::NotFinite`].
    pub fn check(&self) -> Result<(), Error> {
        let n = self.n();
        for (what, matrix) in [
            ("the mass matrix", &self.mass),
            ("the damping matrix", &self.damping),
            ("the stiffness matrix", &self.stiffness),
        ] {
            ensure_shape(what, matrix, (n, n))?;
            ensure_finite_entries(what, matrix)?;
        }
        Ok(())
    }

    /// Number of coordinates.
    pub fn n(&self) -> usize {
        self.mass.nrows()
    }
}

/// Density and speed.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Flow {
    /// Density \[kg/m³\].
    pub rho: f64,
    /// True airspeed \[m/s\].
    pub speed: f64,
}

/// A structure and the strips that move with it.
#[derive(Debug, Clone)]
pub struct AeroelasticModel {
    /// The structure.
    pub structure: Structure,
    /// The strips.
    pub strips: Vec<Strip>,
    /// Shapes of the structure on the strips.
    pub shapes: StripShapes,
    /// Generalised forces of the shapes on themselves.
    pub forces: GeneralizedForces,
    /// Downwash of the shapes.
    pub downwash: Downwash,
    /// Lags of each strip; none makes the circulation follow the downwash at once (`C = 1`).
    pub lags: Vec<Lag>,
}

impl AeroelasticModel {
    /// Assembles the matrices.
    ///
    /// # Errors
    /// [`Error::Shape`] if the structure has another number of coordinates than there are shapes, [`Error::NotFinite`]
    /// for a NaN or infinity in it; what [`generalized_forces`] returns; [`Error::Empty`] without strips or shapes;
    /// [`Error::BadLag`] for a lag that does not decay.
    pub fn try_new(
        structure: Structure,
        strips: Vec<Strip>,
        shapes: StripShapes,
        theory: &StripTheory,
        split: Split,
        lags: &[Lag],
    ) -> Result<Self, Error> {
        if strips.is_empty() {
            return Err(Error::Empty { what: "strips" });
        }
        if shapes.n_shapes() == 0 {
            return Err(Error::Empty { what: "mode shapes" });
        }
        if structure.n() != shapes.n_shapes() {
            return Err(Error::Shape {
                what: "structure",
                expected: (shapes.n_shapes(), shapes.n_shapes()),
                found: (structure.n(), structure.n()),
            });
        }
        structure.check()?;
        for (index, lag) in lags.iter().enumerate() {
            lag.check(index)?;
        }
        let forces = generalized_forces(&strips, &shapes, &shapes, theory, split)?;
        let downwash = downwash(&strips, &shapes, theory)?;
        Ok(Self {
            structure,
            strips,
            shapes,
            forces,
            downwash,
            lags: lags.to_vec(),
        })
    }

    /// The same with lift induced between the strips ([`generalized_forces_between`]).
    ///
    /// # Errors
    /// As [`generalized_forces_between`].
    pub fn with_influence(
        self,
        influence: &Mat<f64>,
        theory: &StripTheory,
        split: Split,
    ) -> Result<Self, Error> {
        let (strips, shapes) = (&self.strips, &self.shapes);
        let forces = generalized_forces_between(strips, influence, shapes, shapes, theory, split)?;
        Ok(Self { forces, ..self })
    }

    /// Checks that structure, forces, downwash and strips are of one size, and the structure's numbers finite. The shapes
    /// are not looked at: what follows from them is in forces and downwash.
    ///
    /// # Errors
    /// [`Error::Shape`], [`Error::NotFinite`].
    pub fn check(&self) -> Result<(), Error> {
        self.structure.check()?;
        let (n, strips) = (self.n_modes(), self.strips.len());
        let (forces, downwash) = (&self.forces, &self.downwash);
        for (what, matrix, expected) in [
            ("the force matrix eta_etadd_nc", &forces.eta_etadd_nc, (n, n)),
            ("the force matrix eta_etad_nc", &forces.eta_etad_nc, (n, n)),
            ("the force matrix eta_etad_c", &forces.eta_etad_c, (n, n)),
            ("the force matrix eta_eta_nc", &forces.eta_eta_nc, (n, n)),
            ("the force matrix eta_eta_c", &forces.eta_eta_c, (n, n)),
            ("the force matrix eta_lambda_c", &forces.eta_lambda_c, (n, strips)),
            ("the downwash matrix w_eta", &downwash.w_eta, (strips, n)),
            ("the downwash matrix w_etad", &downwash.w_etad, (strips, n)),
        ] {
            ensure_shape(what, matrix, expected)?;
        }
        Ok(())
    }

    /// Number of elastic coordinates.
    pub fn n_modes(&self) -> usize {
        self.structure.n()
    }

    /// `mu - rho Q_etadd`: structure and apparent mass.
    ///
    /// # Errors
    /// As [`AeroelasticModel::check`].
    pub fn mass(&self, rho: f64) -> Result<Mat<f64>, Error> {
        self.check()?;
        Ok(self.checked_mass(rho))
    }

    /// `K - rho V^2 Q_eta`: the static aeroelastic stiffness.
    ///
    /// # Errors
    /// As [`AeroelasticModel::check`].
    pub fn static_stiffness(&self, flow: Flow) -> Result<Mat<f64>, Error> {
        self.check()?;
        Ok(self.checked_stiffness(flow))
    }

    /// [`AeroelasticModel::mass`] of a model known to fit together.
    pub(crate) fn checked_mass(&self, rho: f64) -> Mat<f64> {
        &self.structure.mass - rho * &self.forces.eta_etadd_nc
    }

    /// [`AeroelasticModel::static_stiffness`] of a model known to fit together.
    fn checked_stiffness(&self, flow: Flow) -> Mat<f64> {
        &self.structure.stiffness - flow.rho * flow.speed.powi(2) * self.forces.eta_eta()
    }

    /// The rates of decay of the lag states, lag by lag, strips within: `2 V a_i / c` \[1/s\].
    pub fn lag_rates(&self, speed: f64) -> Vec<f64> {
        self.lags
            .iter()
            .flat_map(|lag| self.strips.iter().map(move |s| 2.0 * speed * lag.rate / s.chord))
            .collect()
    }
}

/// The matrices of Eq. 11.
#[derive(Debug, Clone)]
pub struct PiMatrices {
    /// `Pi_1`, on `eta`, n x n.
    pub pi1: Mat<f64>,
    /// `Pi_2`, on `etad`, n x n.
    pub pi2: Mat<f64>,
    /// `Pi_3`, on the sum of lags of each strip, n x strips.
    pub pi3: Mat<f64>,
    /// `Pi_4`, on the rigid-body variables, n x variables.
    pub pi4: Mat<f64>,
    /// `Pi_5`, on the controls, n x controls.
    pub pi5: Mat<f64>,
}

/// Eq. 12 with the indices corrected (see the module text).
///
/// `q_x` and `q_u` are the quasi-steady matrices of [`crate::quasi_steady`], shapes x variables.
///
/// # Errors
/// [`Error::Numerics`] if `mu - rho Q_etadd` is singular or `q_x` or `q_u` have another number of rows than there are
/// modes, [`Error::BadFlow`] for a density or speed that is negative or not finite; what [`AeroelasticModel::check`]
/// returns.
pub fn pi_matrices(
    model: &AeroelasticModel,
    flow: Flow,
    reference: &crate::quasi_steady::ReferenceDimensions,
    q_x: &Mat<f64>,
    q_u: &Mat<f64>,
) -> Result<PiMatrices, Error> {
    model.check()?;
    ensure_not_negative("density", flow.rho)?;
    ensure_not_negative("speed", flow.speed)?;
    let Flow { rho, speed } = flow;
    let mass = model.checked_mass(rho);
    let per_mass = |right: Mat<f64>| solve::solve(mass.as_ref(), right.as_ref());
    let q_s_cbar = 0.5 * rho * speed * speed * reference.area * reference.chord;
    Ok(PiMatrices {
        pi1: per_mass(-model.checked_stiffness(flow))?,
        pi2: per_mass(rho * speed * model.forces.eta_etad() - &model.structure.damping)?,
        pi3: per_mass(rho * speed * &model.forces.eta_lambda_c)?,
        pi4: per_mass(q_s_cbar * q_x)?,
        pi5: per_mass(q_s_cbar * q_u)?,
    })
}

/// State matrix of `[eta, etad, lambda_1, lambda_2, ...]`, lags strip by strip within each.
///
/// # Errors
/// [`Error::Numerics`] if `mu - rho Q_etadd` is singular, [`Error::BadFlow`] for a density or speed that is negative
/// or not finite, [`Error::BadOption`] for more than 20 000 states; what [`AeroelasticModel::check`] returns.
pub fn state_matrix(model: &AeroelasticModel, flow: Flow) -> Result<Mat<f64>, Error> {
    model.check()?;
    ensure_not_negative("density", flow.rho)?;
    ensure_not_negative("speed", flow.speed)?;
    let Flow { rho, speed } = flow;
    let (n, n_strips) = (model.n_modes(), model.strips.len());
    let n_states = n_states(n, model.lags.len(), n_strips)?;
    let mass = model.checked_mass(rho);
    let pi1 = solve::solve(mass.as_ref(), (-model.checked_stiffness(flow)).as_ref())?;
    let pi2 = solve::solve(
        mass.as_ref(),
        (rho * speed * model.forces.eta_etad() - &model.structure.damping).as_ref(),
    )?;
    let pi3 = solve::solve(mass.as_ref(), (rho * speed * &model.forces.eta_lambda_c).as_ref())?;

    // wd = V w_eta etad + w_etad etadd, with etadd from Eq. 11.
    let (w_eta, w_etad) = (&model.downwash.w_eta, &model.downwash.w_etad);
    let rate_by_eta = w_etad * &pi1;
    let rate_by_etad = speed * w_eta + w_etad * &pi2;
    let rate_by_lag = w_etad * &pi3;

    let mut a = Mat::zeros(n_states, n_states);
    for k in 0..n {
        a[(k, n + k)] = 1.0;
    }
    a.as_mut().submatrix_mut(n, 0, n, n).copy_from(&pi1);
    a.as_mut().submatrix_mut(n, n, n, n).copy_from(&pi2);
    for (i, lag) in model.lags.iter().enumerate() {
        let row = 2 * n + i * n_strips;
        a.as_mut().submatrix_mut(n, row, n, n_strips).copy_from(&pi3);
        a.as_mut()
            .submatrix_mut(row, 0, n_strips, n)
            .copy_from(lag.gain * &rate_by_eta);
        a.as_mut()
            .submatrix_mut(row, n, n_strips, n)
            .copy_from(lag.gain * &rate_by_etad);
        for other in 0..model.lags.len() {
            let column = 2 * n + other * n_strips;
            a.as_mut()
                .submatrix_mut(row, column, n_strips, n_strips)
                .copy_from(lag.gain * &rate_by_lag);
        }
    }
    for (j, rate) in model.lag_rates(speed).into_iter().enumerate() {
        a[(2 * n + j, 2 * n + j)] += rate;
    }
    Ok(a)
}

/// Number of states of `n` modes and `each` for every lag.
fn n_states(n: usize, lags: usize, each: usize) -> Result<usize, Error> {
    let states = n.saturating_mul(2).saturating_add(lags.saturating_mul(each));
    if states <= MOST_STATES {
        return Ok(states);
    }
    Err(Error::BadOption {
        option: "the number of states",
        value: states as f64,
        expected: "at most 20000: take fewer modes, strips or lags",
    })
}

/// A smaller state matrix with the same eigenvalues but for pure lag roots.
///
/// Lag states of strips of one chord decay at one rate `r`, and act on the modes only by their sum
/// `z_i = sum_j Q_lambda,j lambda_i,j`, which obeys `z_i' = r_i z_i + A_i sum_j Q_lambda,j w_j'`. Where more strips
/// share a chord than there are modes, the `n` sums of each lag replace the strips' states.
///
/// States: `eta`, `etad`, then lag by lag the sums or strips of one chord after another.
///
/// # Errors
/// As [`state_matrix`].
pub fn compact_state_matrix(model: &AeroelasticModel, flow: Flow) -> Result<Mat<f64>, Error> {
    model.check()?;
    ensure_not_negative("density", flow.rho)?;
    ensure_not_negative("speed", flow.speed)?;
    check_compact(model)?;
    Ok(assemble_compact(model, flow)?)
}

/// Lag states of each lag in the compact form.
fn n_compact(groups: &[Vec<usize>], n: usize) -> usize {
    groups.iter().map(|g| g.len().min(n)).sum()
}

/// Refuses a compact form of too many states.
pub(crate) fn check_compact(model: &AeroelasticModel) -> Result<(), Error> {
    let n = model.n_modes();
    let each = n_compact(&strips_of_one_chord(&model.strips), n);
    n_states(n, model.lags.len(), each).map(|_| ())
}

/// [`compact_state_matrix`] of a model and a flow known to be usable.
pub(crate) fn assemble_compact(
    model: &AeroelasticModel,
    flow: Flow,
) -> Result<Mat<f64>, albatross_numerics::Error> {
    let Flow { rho, speed } = flow;
    let n = model.n_modes();
    let lift = &model.forces.eta_lambda_c;
    // Strips' downwash to lag states, lag states to modes: their product is Q_lambda.
    let groups = strips_of_one_chord(&model.strips);
    let n_lag = n_compact(&groups, n);
    let (mut gather, mut emit) = (Mat::zeros(n_lag, model.strips.len()), Mat::zeros(n, n_lag));
    let mut chord_of_state = Vec::with_capacity(n_lag);
    for group in &groups {
        let first = chord_of_state.len();
        for (i, &j) in group.iter().enumerate() {
            if group.len() > n {
                (0..n).for_each(|k| gather[(first + k, j)] = lift[(k, j)]);
            } else {
                gather[(first + i, j)] = 1.0;
                (0..n).for_each(|k| emit[(k, first + i)] = lift[(k, j)]);
            }
        }
        if group.len() > n {
            (0..n).for_each(|k| emit[(k, first + k)] = 1.0);
        }
        let chord = group.first().map_or(f64::NAN, |&j| model.strips[j].chord);
        chord_of_state.extend(std::iter::repeat_n(chord, group.len().min(n)));
    }

    let mass = model.checked_mass(rho);
    let per_mass = |right: Mat<f64>| solve::solve(mass.as_ref(), right.as_ref());
    let by_eta = per_mass(-model.checked_stiffness(flow))?;
    let by_etad = per_mass(rho * speed * model.forces.eta_etad() - &model.structure.damping)?;
    let by_lag = per_mass(rho * speed * &emit)?;
    let by_acceleration = &gather * &model.downwash.w_etad;
    let rate_by_eta = &by_acceleration * &by_eta;
    let rate_by_etad = speed * (&gather * &model.downwash.w_eta) + &by_acceleration * &by_etad;
    let rate_by_lag = &by_acceleration * &by_lag;

    let lag_at = |i: usize| model.lags[i / n_lag];
    let n_states = 2 * n + model.lags.len() * n_lag;
    Ok(Mat::from_fn(n_states, n_states, |r, c| {
        let (lag_row, lag_column) = (r.checked_sub(2 * n), c.checked_sub(2 * n));
        match (lag_row, lag_column) {
            (None, _) if r < n => f64::from(u8::from(c == n + r)),
            (None, None) if c < n => by_eta[(r - n, c)],
            (None, None) => by_etad[(r - n, c - n)],
            (None, Some(s)) => by_lag[(r - n, s % n_lag)],
            (Some(t), None) if c < n => lag_at(t).gain * rate_by_eta[(t % n_lag, c)],
            (Some(t), None) => lag_at(t).gain * rate_by_etad[(t % n_lag, c - n)],
            (Some(t), Some(s)) => {
                let decay = if t == s {
                    2.0 * speed * lag_at(t).rate / chord_of_state[t % n_lag]
                } else {
                    0.0
                };
                decay + lag_at(t).gain * rate_by_lag[(t % n_lag, s % n_lag)]
            }
        }
    }))
}

/// Indices of strips grouped by equal chords, in the order of first appearance.
fn strips_of_one_chord(strips: &[Strip]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (j, strip) in strips.iter().enumerate() {
        let of_this_chord = |group: &&mut Vec<usize>| {
            let chord = group.first().map_or(f64::NAN, |&i| strips[i].chord);
            (chord - strip.chord).abs() <= 4.0 * f64::EPSILON * strip.chord
        };
        match groups.iter_mut().find(of_this_chord) {
            Some(group) => group.push(j),
            None => groups.push(vec![j]),
        }
    }
    groups
}

/// State matrix of `[eta, etad]` for quasi-steady aerodynamics: circulation without lag and no apparent mass.
///
/// # Errors
/// As [`state_matrix`].
pub fn quasi_steady_state_matrix(model: &AeroelasticModel, flow: Flow) -> Result<Mat<f64>, Error> {
    model.check()?;
    ensure_not_negative("density", flow.rho)?;
    ensure_not_negative("speed", flow.speed)?;
    let Flow { rho, speed } = flow;
    let n = model.n_modes();
    let n_states = n_states(n, 0, 0)?;
    let mass = model.structure.mass.as_ref();
    let stiffness = rho * speed * speed * &model.forces.eta_eta_c - &model.structure.stiffness;
    let damping = rho * speed * &model.forces.eta_etad_c - &model.structure.damping;
    let mut a = Mat::zeros(n_states, n_states);
    for k in 0..n {
        a[(k, n + k)] = 1.0;
    }
    a.as_mut()
        .submatrix_mut(n, 0, n, n)
        .copy_from(&solve::solve(mass, stiffness.as_ref())?);
    a.as_mut()
        .submatrix_mut(n, n, n, n)
        .copy_from(&solve::solve(mass, damping.as_ref())?);
    Ok(a)
}
