//! Flutter and divergence speeds at a fixed density.
//!
//! Three descriptions of the same physics, which agree at a neutral point:
//! the state space with lags ([`lag_flutter`]), the exact Theodorsen function on the imaginary axis
//! ([`exact_flutter`]), and the static limit ([`divergence_speed`]). [`crate::sweep`] follows all modes over speed.
//!
//! Equations: THEORY (27), (27b).

use crate::Error;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use crate::neutral::{divergence_points, lowest_onset};
use crate::operator::Operator;
use albatross_numerics::{C64, Mat};

/// A neutral point of oscillatory motion.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Flutter {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Frequency of the neutral oscillation \[rad/s\].
    pub omega_rad_s: f64,
}

/// The lowest speed at which the static aeroelastic stiffness `K - rho V^2 Q_eta` is singular \[m/s\]; none if the air
/// stiffens every combination of modes.
///
/// # Errors
/// As [`divergence_points`].
pub fn divergence_speed(model: &AeroelasticModel, rho: f64) -> Result<Option<f64>, Error> {
    let points = divergence_points(model, rho, Kernel::Lags(&[]))?;
    Ok(points.first().map(|p| p.speed))
}

/// The lowest flutter speed of the state space with the model's lags; none if no oscillatory mode loses its stability
/// at a reduced frequency between 200 and 1e-4.
///
/// A structure with negative damping has the flutter speed 0. Modes to which the air itself gives energy from the
/// smallest speed on lose no stability and are passed over; [`crate::neutral::NeutralPoints`] lists them.
///
/// # Errors
/// As [`neutral_points`](crate::neutral::neutral_points).
pub fn lag_flutter(model: &AeroelasticModel, rho: f64) -> Result<Option<Flutter>, Error> {
    lowest(model, rho, Kernel::Lags(&model.lags))
}

/// The lowest flutter speed of the exact Theodorsen aerodynamics; none and 0 as for [`lag_flutter`].
///
/// # Errors
/// As [`neutral_points`](crate::neutral::neutral_points).
pub fn exact_flutter(model: &AeroelasticModel, rho: f64) -> Result<Option<Flutter>, Error> {
    lowest(model, rho, Kernel::Theodorsen)
}

fn lowest(model: &AeroelasticModel, rho: f64, kernel: Kernel<'_>) -> Result<Option<Flutter>, Error> {
    let found = lowest_onset(model, rho, kernel)?;
    Ok(found.map(|(speed, omega_rad_s)| Flutter { speed, omega_rad_s }))
}

/// The aeroelastic operator of exact harmonic aerodynamics, `F(p, V)` with `F u = 0` for free motion `u exp(p t)`;
/// Theodorsen's function is taken at `k_j = Im(p) b_j / V`.
///
/// # Errors
/// As [`AeroelasticModel::check`].
pub fn harmonic_operator(model: &AeroelasticModel, rho: f64, p: C64, speed: f64) -> Result<Mat<C64>, Error> {
    model.check()?;
    let operator = Operator::of(model, rho);
    Ok(operator.evaluate(p, speed, Kernel::Theodorsen).value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::JONES;
    use crate::section::TypicalSection;

    fn perry() -> TypicalSection {
        TypicalSection {
            mass: 31.41592653589793,
            static_moment: std::f64::consts::TAU,
            inertia: 2.5 * std::f64::consts::PI,
            plunge_stiffness: 78539.81633974482,
            pitch_stiffness: 78539.81633974482,
            semi_chord: 1.0,
            axis: -0.4,
            cl_alpha: std::f64::consts::TAU,
        }
    }

    /// Perry, NASA/TP-2015-218765 app. C: 173.26 ft/s; ContourRoots' test gives 173.262350488 and 75.4620174044.
    #[test]
    fn val_nasa_tp_2015_218765() {
        let model = perry().model(&JONES).unwrap();
        let exact = exact_flutter(&model, 1.0).unwrap().unwrap();
        assert!((exact.speed / 173.262350488 - 1.0).abs() < 3e-12, "{exact:?}");
        assert!(
            (exact.omega_rad_s / 75.4620174044 - 1.0).abs() < 1e-11,
            "{exact:?}"
        );
        let jones = lag_flutter(&model, 1.0).unwrap().unwrap();
        assert!((jones.speed / 172.857309432729 - 1.0).abs() < 1e-9, "{jones:?}");
        let instant = lag_flutter(&perry().model(&[]).unwrap(), 1.0).unwrap().unwrap();
        assert!((instant.speed / 100.01064226 - 1.0).abs() < 1e-9, "{instant:?}");
        // K_alpha = 2 pi rho V^2 b^2 (a + 1/2) at divergence.
        let closed_form = (78539.81633974482 / (2.0 * std::f64::consts::PI * 0.1)).sqrt();
        let divergence = divergence_speed(&model, 1.0).unwrap().unwrap();
        assert!((divergence / closed_form - 1.0).abs() < 1e-13);
    }

    #[test]
    fn prop_still_air_has_no_flutter() {
        let model = perry().model(&JONES).unwrap();
        assert_eq!(lag_flutter(&model, 0.0).unwrap(), None);
        assert!(matches!(
            lag_flutter(&model, f64::NAN),
            Err(Error::BadFlow { .. })
        ));
    }
}
