//! The aeroelastic operator: free motion `u exp(p t)` at speed V satisfies `F(p, V) u = 0`.
//!
//! ```text
//! F = p^2 (M - rho Q_etadd) + p (D - rho V Q'_etad) + K - rho V^2 Q'_eta - rho V Q_lambda C(p b/V) (V w_eta + p w_etad)
//! ```
//!
//! The primes take out of `Q_etad` and `Q_eta` what is proportional to the downwash, so that the whole circulatory
//! lift appears once, behind the kernel `C` of each strip. With the lags' kernel the roots are the eigenvalues of
//! [`crate::elastic::state_matrix`] other than pure lag roots: an eigenproblem of the size of the modes however many
//! strips there are.

use crate::Error;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use albatross_numerics::{C64, Mat, eigen};

/// The matrices of `F` at a density, in some basis of the elastic coordinates.
pub(crate) struct Operator {
    rho: f64,
    /// `M - rho Q_etadd`.
    pub(crate) mass: Mat<f64>,
    pub(crate) damping: Mat<f64>,
    pub(crate) stiffness: Mat<f64>,
    /// `Q'_etad`.
    rate: Mat<f64>,
    /// `Q'_eta`.
    displacement: Mat<f64>,
    /// `Q_lambda`, coordinates x strips.
    lift: Mat<f64>,
    /// Strips x coordinates.
    w_eta: Mat<f64>,
    w_etad: Mat<f64>,
    pub(crate) semi_chords: Vec<f64>,
}

/// `F` and what is needed to differentiate it.
pub(crate) struct Evaluation {
    pub(crate) value: Mat<C64>,
    /// With the kernel held.
    pub(crate) by_p: Mat<C64>,
    /// With the frequency held, kernel included.
    pub(crate) by_ln_speed: Mat<C64>,
    /// By the kernel's argument alone.
    pub(crate) by_ln_s: Mat<C64>,
}

impl Evaluation {
    /// All parts with rows and columns multiplied by `weights`.
    pub(crate) fn scaled(self, weights: &[f64]) -> Self {
        let scale =
            |a: Mat<C64>| Mat::from_fn(a.nrows(), a.ncols(), |k, l| a[(k, l)] * (weights[k] * weights[l]));
        Self {
            value: scale(self.value),
            by_p: scale(self.by_p),
            by_ln_speed: scale(self.by_ln_speed),
            by_ln_s: scale(self.by_ln_s),
        }
    }
}

impl Operator {
    /// In the own coordinates of a model known to fit together.
    pub(crate) fn of(model: &AeroelasticModel, rho: f64) -> Self {
        let (forces, downwash) = (&model.forces, &model.downwash);
        Self {
            rho,
            mass: model.checked_mass(rho),
            damping: model.structure.damping.clone(),
            stiffness: model.structure.stiffness.clone(),
            rate: forces.eta_etad() - &forces.eta_lambda_c * &downwash.w_etad,
            displacement: forces.eta_eta() - &forces.eta_lambda_c * &downwash.w_eta,
            lift: forces.eta_lambda_c.clone(),
            w_eta: downwash.w_eta.clone(),
            w_etad: downwash.w_etad.clone(),
            semi_chords: model.strips.iter().map(|s| s.semi_chord()).collect(),
        }
    }

    /// In the basis whose vectors are the columns of `psi`.
    pub(crate) fn in_basis(&self, psi: &Mat<f64>) -> Self {
        let both = |a: &Mat<f64>| psi.transpose() * a * psi;
        Self {
            rho: self.rho,
            mass: both(&self.mass),
            damping: both(&self.damping),
            stiffness: both(&self.stiffness),
            rate: both(&self.rate),
            displacement: both(&self.displacement),
            lift: psi.transpose() * &self.lift,
            w_eta: &self.w_eta * psi,
            w_etad: &self.w_etad * psi,
            semi_chords: self.semi_chords.clone(),
        }
    }

    /// Number of coordinates.
    pub(crate) fn n(&self) -> usize {
        self.mass.nrows()
    }

    /// `Q_lambda diag(c) w_eta` and `Q_lambda diag(c) w_etad`.
    fn circulation(&self, c: &[C64]) -> [Mat<C64>; 2] {
        let (n, strips) = (self.n(), c.len());
        [&self.w_eta, &self.w_etad].map(|w| {
            let re = &self.lift * Mat::from_fn(strips, n, |j, l| c[j].re * w[(j, l)]);
            let im = &self.lift * Mat::from_fn(strips, n, |j, l| c[j].im * w[(j, l)]);
            Mat::from_fn(n, n, |k, l| C64::new(re[(k, l)], im[(k, l)]))
        })
    }

    pub(crate) fn evaluate(&self, p: C64, speed: f64, kernel: Kernel<'_>) -> Evaluation {
        let (rho, v, n) = (self.rho, speed, self.n());
        // In still air the kernel has no argument, and nothing to act on.
        let per_strip = |f: &dyn Fn(C64) -> C64| -> Vec<C64> {
            let at = |b: &f64| {
                if v > 0.0 {
                    f(p * (b / v))
                } else {
                    C64::new(0.0, 0.0)
                }
            };
            self.semi_chords.iter().map(at).collect()
        };
        let [c_eta, c_etad] = self.circulation(&per_strip(&|s| kernel.at(s)));
        let [e_eta, e_etad] = self.circulation(&per_strip(&|s| kernel.by_logarithm(s)));
        let rate = |k: usize, l: usize| self.rate[(k, l)] + c_etad[(k, l)];
        let displacement = |k: usize, l: usize| self.displacement[(k, l)] + c_eta[(k, l)];
        let by_p =
            |k: usize, l: usize| 2.0 * p * self.mass[(k, l)] + self.damping[(k, l)] - rho * v * rate(k, l);
        let by_ln_s = |k: usize, l: usize| -rho * v * (p * e_etad[(k, l)] + v * e_eta[(k, l)]);
        Evaluation {
            value: Mat::from_fn(n, n, |k, l| {
                p * p * self.mass[(k, l)]
                    + p * (self.damping[(k, l)] - rho * v * rate(k, l))
                    + self.stiffness[(k, l)]
                    - rho * v * v * displacement(k, l)
            }),
            by_p: Mat::from_fn(n, n, by_p),
            // The kernel's argument p b/V falls as the speed grows.
            by_ln_speed: Mat::from_fn(n, n, |k, l| {
                -p * rho * v * rate(k, l) - 2.0 * rho * v * v * displacement(k, l) - by_ln_s(k, l)
            }),
            by_ln_s: Mat::from_fn(n, n, by_ln_s),
        }
    }

    /// `A(kappa)` of `F = p^2 A + p D + K` on the lines `V = p / (i kappa)` of constant wave number.
    ///
    /// There the kernel's argument `i kappa b` is known, and what is left is a polynomial in p.
    pub(crate) fn apparent_mass(&self, kappa: f64, kernel: Kernel<'_>) -> Mat<C64> {
        let c: Vec<C64> = self
            .semi_chords
            .iter()
            .map(|b| kernel.at(C64::new(0.0, kappa * b)))
            .collect();
        let [c_eta, c_etad] = self.circulation(&c);
        let i = C64::i();
        Mat::from_fn(self.n(), self.n(), |k, l| {
            let rate = self.rate[(k, l)] + c_etad[(k, l)];
            let displacement = self.displacement[(k, l)] + c_eta[(k, l)];
            self.mass[(k, l)] + self.rho * (displacement / (kappa * kappa) + i * rate / kappa)
        })
    }
}

/// The operator in the normal modes of the structure with the apparent mass of still air, highest first.
///
/// In this basis the mass is the identity and the stiffness `diag(omega^2)`. Modes without stiffness come last, with
/// `omega = 0` exactly.
pub(crate) struct ModalOperator {
    pub(crate) operator: Operator,
    /// Frequencies, descending; zero for rigid-body modes \[rad/s\].
    pub(crate) omega: Vec<f64>,
}

impl ModalOperator {
    pub(crate) fn of(model: &AeroelasticModel, rho: f64) -> Result<Self, Error> {
        model.check()?;
        let operator = Operator::of(model, rho);
        let (squares, modes) =
            eigen::symmetric_generalized(operator.stiffness.as_ref(), operator.mass.as_ref())?;
        let omega = frequencies(&squares)?;
        let n = omega.len();
        let descending = Mat::from_fn(n, n, |i, k| modes[(i, n - 1 - k)]);
        Ok(Self {
            operator: operator.in_basis(&descending),
            omega: omega.into_iter().rev().collect(),
        })
    }

    /// Whether some motion is fed by the structure's damping matrix.
    pub(crate) fn damping_feeds_energy(&self) -> Result<bool, Error> {
        let damping = &self.operator.damping;
        let n = self.operator.n();
        let symmetric = Mat::from_fn(n, n, |k, l| 0.5 * (damping[(k, l)] + damping[(l, k)]));
        let identity = Mat::<f64>::identity(n, n);
        let (powers, _) = eigen::symmetric_generalized(symmetric.as_ref(), identity.as_ref())?;
        let rounding = 1e-12 * symmetric.norm_max();
        Ok(powers.first().is_some_and(|least| *least < -rounding))
    }

    /// Number of modes with stiffness; the first ones.
    pub(crate) fn n_elastic(&self) -> usize {
        self.omega.iter().filter(|w| **w > 0.0).count()
    }
}

/// Square roots of the eigenvalues of a stiffness matrix; those at rounding level are zero.
///
/// # Errors
/// [`Error::BadMode`] for an eigenvalue that is clearly negative: the structure by itself is unstable.
pub(crate) fn frequencies(squares: &[f64]) -> Result<Vec<f64>, Error> {
    let largest = squares.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let rounding = 16.0 * f64::EPSILON * squares.len() as f64 * largest;
    squares
        .iter()
        .enumerate()
        .map(|(index, &square)| {
            if square < -rounding {
                return Err(Error::BadMode {
                    index,
                    quantity: "eigenvalue of the stiffness matrix (square of the frequency)",
                    value: square,
                    expected: "zero or more",
                });
            }
            Ok(if square <= rounding { 0.0 } else { square.sqrt() })
        })
        .collect()
}
