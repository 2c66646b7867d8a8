//! Neutral points of motion without oscillation: divergence.

use crate::Error;
use crate::check::ensure_not_negative;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use crate::operator::{Operator, frequencies};
use albatross_numerics::{C64, Mat, eigen};

/// A speed at which the static aeroelastic stiffness `K - rho V^2 Q_eta` is singular.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DivergencePoint {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// `dp/d ln V` of the real root at zero \[1/s\]: positive where it becomes unstable as the speed grows.
    pub growth: f64,
}

/// All divergence points, in the order of speed.
///
/// Modes without stiffness are held: what diverges are the elastic modes, as in a tunnel or at a fixed attitude. The
/// kernel matters to the growth only; with Theodorsen's function real roots see `C = 1`, as in the p-k method.
///
/// # Errors
/// [`Error::BadFlow`] for a density that is negative or not finite; [`Error::BadMode`] for a structure that is
/// unstable by itself; [`Error::Numerics`] for matrices that are not finite, not symmetric, or a mass that is not
/// positive definite; what [`AeroelasticModel::check`] returns.
pub fn divergence_points(
    model: &AeroelasticModel,
    rho: f64,
    kernel: Kernel<'_>,
) -> Result<Vec<DivergencePoint>, Error> {
    ensure_not_negative("density", rho)?;
    model.check()?;
    let (squares, modes) =
        eigen::symmetric_generalized(model.structure.stiffness.as_ref(), model.structure.mass.as_ref())?;
    let omega = frequencies(&squares)?;
    let elastic: Vec<usize> = (0..omega.len()).filter(|&k| omega[k] > 0.0).collect();
    // In shapes of unit strain energy the eigenvalues of the air's work are 1/(rho V^2).
    let unit_energy = Mat::from_fn(modes.nrows(), elastic.len(), |i, k| {
        modes[(i, elastic[k])] / omega[elastic[k]]
    });
    let air = unit_energy.transpose() * model.forces.eta_eta() * &unit_energy;
    // Fewer strips than modes make zeros of rounding size.
    let rounding = 1e-13 * air.norm_max();
    let mut speeds: Vec<f64> = eigen::eigenvalues(air.as_ref())?
        .into_iter()
        .filter(|v| v.im.abs() <= 1e-9 * v.norm() && v.re > rounding)
        .map(|v| (1.0 / (rho * v.re)).sqrt())
        .filter(|speed| speed.is_finite())
        .collect();
    speeds.sort_by(f64::total_cmp);
    let operator = Operator::of(model, rho).in_basis(&unit_energy);
    speeds
        .into_iter()
        .map(|speed| {
            let growth = growth(&operator, kernel, speed)?;
            Ok(DivergencePoint { speed, growth })
        })
        .collect()
}

/// `-(l F_lnV r) / (l F_p r)` at p = 0.
fn growth(operator: &Operator, kernel: Kernel<'_>, speed: f64) -> Result<f64, Error> {
    // The kernel's part of F_p has the limit by_ln_s / p.
    let widest = operator.semi_chords.iter().copied().fold(0.0, f64::max);
    let p = C64::from(1e-8 * speed / widest);
    let f = operator.evaluate(p, speed, kernel);
    let at_rest = operator.evaluate(C64::new(0.0, 0.0), speed, kernel).value;
    let Some(super::NullVectors { right, left }) = super::null_vectors(&at_rest)? else {
        return Ok(f64::NAN);
    };
    let by_p = super::form(&left, &right, |r, c| f.by_p[(r, c)] + f.by_ln_s[(r, c)] / p);
    let by_ln_speed = super::form(&left, &right, |r, c| f.by_ln_speed[(r, c)]);
    Ok((-by_ln_speed / by_p).re)
}
