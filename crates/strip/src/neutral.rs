//! All neutral points: where a mode neither grows nor decays.
//!
//! On a line `V = p / (i kappa)` every strip's reduced frequency `kappa b` is known, and the aeroelastic operator is a
//! polynomial, `F = p^2 A(kappa) + p D + K`. A root on the imaginary axis is a neutral point with `omega = Im p` and
//! `V = omega / kappa`, without approximation; roots off the axis have no meaning of their own. This is the k method
//! (Theodorsen & Garrick 1940, NACA Report 685; Smilg & Wasserman 1942) with the structure's own damping in place of
//! the fictitious one. Following all roots from `kappa = infinity`, where they are the modes in still air, to zero
//! passes every neutral point of the model: humps and repeated crossings included, at any speed.
//!
//! The scan only has to find signs; each point is then solved for by Newton's method on `F(i omega, V) u = 0`.
//!
//! Equations: THEORY (27a).

mod divergence;
mod refine;
mod scan;

use crate::Error;
use crate::check::ensure_not_negative;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use crate::operator::ModalOperator;
use albatross_numerics::C64;

pub use divergence::{DivergencePoint, divergence_points};
pub(crate) use refine::{NullVectors, bordered_step, form, null_vectors, weights};

/// A neutral point of oscillatory motion.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NeutralPoint {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Frequency \[rad/s\].
    pub omega_rad_s: f64,
    /// `V dsigma/dV / omega` with sigma the real part of the eigenvalue: positive where the mode becomes unstable as
    /// the speed grows, negative where it recovers.
    pub growth: f64,
}

/// Where oscillatory modes lose and regain stability.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct NeutralPoints {
    /// Frequencies of modes that grow however small the speed \[rad/s\], ascending. Negative structural damping does
    /// this, and so may a lift slope other than 2 pi with the downwash at three-quarter chord: the damping at the high
    /// reduced frequencies of small speeds, `-k/2 phi_34^2` for 2 pi, then has no definite sign.
    pub unstable_at_rest: Vec<f64>,
    /// Neutral points in the order of speed.
    pub points: Vec<NeutralPoint>,
}

/// All neutral points between the reduced frequencies 200 (on the narrowest strip) and 1e-4 (on the widest).
///
/// Modes on which the air does no work and that have no damping of their own are neutral everywhere and make no point;
/// neither do free modes by themselves. `n` modes and `s` strips cost some hundred times `n^2 s` for the matrices and
/// `30 n^3` for the roots (`240 n^3` with structural damping).
///
/// # Errors
/// [`Error::BadFlow`] for a density that is negative or not finite, [`Error::BadMode`] for a structure that is
/// unstable by itself, [`Error::Numerics`] for a mass matrix that is not positive definite or entries that are not
/// finite; what [`AeroelasticModel::check`] returns.
pub fn neutral_points(
    model: &AeroelasticModel,
    rho: f64,
    kernel: Kernel<'_>,
) -> Result<NeutralPoints, Error> {
    ensure_not_negative("density", rho)?;
    let modal = ModalOperator::of(model, rho)?;
    if rho == 0.0 || modal.n_elastic() == 0 {
        return Ok(NeutralPoints::default());
    }
    let (unstable_at_rest, brackets) = scan::scan(&modal, kernel)?;
    let mut points: Vec<NeutralPoint> = Vec::new();
    for bracket in brackets {
        if let Some(point) = refine::refine_within(&modal, kernel, bracket)?
            && !points.iter().any(|known| same(known, &point))
        {
            points.push(point);
        }
    }
    points.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(NeutralPoints {
        unstable_at_rest,
        points,
    })
}

/// The lowest speed at which an oscillatory mode loses its stability, with its frequency; speed 0 if the structure's own
/// damping feeds a mode.
///
/// # Errors
/// As [`neutral_points`].
pub(crate) fn lowest_onset(
    model: &AeroelasticModel,
    rho: f64,
    kernel: Kernel<'_>,
) -> Result<Option<(f64, f64)>, Error> {
    ensure_not_negative("density", rho)?;
    let modal = ModalOperator::of(model, rho)?;
    if rho == 0.0 || modal.n_elastic() == 0 {
        return Ok(None);
    }
    let (unstable_at_rest, mut brackets) = scan::scan(&modal, kernel)?;
    if let Some(&omega) = unstable_at_rest.first()
        && modal.damping_feeds_energy()?
    {
        return Ok(Some((0.0, omega)));
    }
    brackets.sort_by(|a, b| a.least_speed().total_cmp(&b.least_speed()));
    let mut lowest: Option<(f64, f64)> = None;
    for bracket in brackets {
        // A bracket's speeds are those at its ends, give or take its width.
        if lowest.is_some_and(|(speed, _)| bracket.least_speed() > 1.2 * speed) {
            break;
        }
        if let Some(point) = refine::refine_within(&modal, kernel, bracket)?
            && point.growth > 0.0
            && lowest.is_none_or(|(speed, _)| point.speed < speed)
        {
            lowest = Some((point.speed, point.omega_rad_s));
        }
    }
    Ok(lowest)
}

fn same(a: &NeutralPoint, b: &NeutralPoint) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-8 * x.abs().max(y.abs());
    close(a.speed, b.speed) && close(a.omega_rad_s, b.omega_rad_s)
}

/// A root that changes the sign of its real part between two wave numbers.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    /// Wave numbers, the larger first \[1/m\].
    kappa: [f64; 2],
    /// The root at each \[rad/s\].
    p: [C64; 2],
}

impl Bracket {
    /// The lower of the speeds `Im p / kappa` at its ends.
    fn least_speed(&self) -> f64 {
        (self.p[0].im / self.kappa[0]).min(self.p[1].im / self.kappa[1])
    }
}
