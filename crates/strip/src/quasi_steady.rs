//! Quasi-steady coupling of rigid-body motion and controls into the modes (Waszak & Schmidt 1988).
//!
//! The generalised force of a rigid-body variable X (an angle, a dimensionless rate, a deflection) is
//! `q S cbar Q_X X` with
//!
//! ```text
//! Q_X[k] = 1/(S cbar) sum_j c_j dy_j ( dc_l,j/dX phi_k^ac + c_j dc_m,j/dX gamma_k )
//! ```
//!
//! `c_m` about the aerodynamic centre, nose up. The distributions come from strip output (differences of two runs)
//! or, where there is none, from the analytic estimates of [`analytic_lift`].
//!
//! Equations: THEORY (14), (15), (16).

use crate::Error;
use crate::check::{ensure_rows, ensure_shape};
use crate::shapes::{DihedralForm, StripShapes};
use crate::strip::Strip;
use albatross_numerics::Mat;

/// Derivatives of the strips' lift and moment coefficients; strips x variables.
#[derive(Debug, Clone)]
pub struct StripLoads {
    /// `dc_l/dX`, c_l on the strip's own area.
    pub lift: Mat<f64>,
    /// `dc_m/dX` about the aerodynamic centre, nose up, on the strip's own area and chord.
    pub moment: Mat<f64>,
}

impl StripLoads {
    /// Lift without moment.
    pub fn from_lift(lift: Mat<f64>) -> Self {
        let moment = Mat::zeros(lift.nrows(), lift.ncols());
        Self { lift, moment }
    }
}

/// Reference area and chord that make the generalised forces dimensionless.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ReferenceDimensions {
    /// Reference area S \[m²\].
    pub area: f64,
    /// Reference chord `cbar` \[m\].
    pub chord: f64,
    /// Reference span b \[m\].
    pub span: f64,
}

impl ReferenceDimensions {
    /// Checks what the generalised forces are divided by.
    ///
    /// # Errors
    /// [`Error::BadOption`] for an area or chord that is not positive.
    pub fn check(&self) -> Result<(), Error> {
        for (option, value) in [
            ("the reference area", self.area),
            ("the reference chord", self.chord),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::BadOption {
                    option,
                    value,
                    expected: "a positive number; correct the reference shape",
                });
            }
        }
        Ok(())
    }
}

/// `Q_X`, shapes x variables.
///
/// # Errors
/// [`Error::Shape`] if strips, shapes and loads differ in number, [`Error::NotFinite`] for shapes with NaN or
/// infinities, [`Error::BadOption`] for a reference area or chord that is not positive.
pub fn rigid_to_elastic(
    strips: &[Strip],
    test: &StripShapes,
    loads: &StripLoads,
    reference: &ReferenceDimensions,
) -> Result<Mat<f64>, Error> {
    ensure_rows("test shapes", &test.phi, strips.len())?;
    ensure_rows("strip lift", &loads.lift, strips.len())?;
    ensure_shape("strip moment", &loads.moment, (strips.len(), loads.lift.ncols()))?;
    test.check()?;
    reference.check()?;
    let test_ac = test.at(strips, |s| s.x_ac);
    let norm = 1.0 / (reference.area * reference.chord);
    let force = Mat::from_fn(strips.len(), loads.lift.ncols(), |j, x| {
        norm * strips[j].area() * loads.lift[(j, x)]
    });
    let couple = Mat::from_fn(strips.len(), loads.moment.ncols(), |j, x| {
        norm * strips[j].area() * strips[j].chord * loads.moment[(j, x)]
    });
    Ok(test_ac.transpose() * force + test.gamma.transpose() * couple)
}

/// What the analytic strip lift derivatives need to know beside the strips.
#[derive(Debug, Clone, Copy)]
pub struct AnalyticLift<'a> {
    /// Lift slope of each strip in a change of the aircraft's incidence, downwash of the wing included \[1/rad\].
    pub alpha: &'a [f64],
    /// Lift coefficient of each strip at zero incidence.
    pub cl0: &'a [f64],
    /// Sweep of each strip, positive aft \[rad\].
    pub sweep_rad: &'a [f64],
    /// Centre of gravity, structural x and z \[m\].
    pub cg_xz: [f64; 2],
    /// How dihedral enters.
    pub form: DihedralForm,
}

/// Analytic `dc_l/dX` for X = alpha, beta, p b/2V, q cbar/2V, r b/2V; strips x 5.
///
/// Strip estimates: a roll rate adds the incidence `p y/V`, a pitch rate `q (x_34 - x_cg)/V`, a yaw rate changes the
/// local speed by `-r y`, sideslip acts through dihedral and through the sweep's cosine. In the general form the arms
/// are those of the strip's normal, so that a fin answers to roll and yaw too.
pub fn analytic_lift(
    strips: &[Strip],
    given: &AnalyticLift<'_>,
    reference: &ReferenceDimensions,
) -> Mat<f64> {
    let [x_cg, z_cg] = given.cg_xz;
    Mat::from_fn(strips.len(), 5, |j, variable| {
        let s = &strips[j];
        let cl0 = given.cl0.get(j).copied().unwrap_or(0.0);
        let sweep = given.sweep_rad.get(j).copied().unwrap_or(0.0);
        let (cos, sin) = given.form.components(s);
        let aft = s.x_three_quarter() - x_cg;
        match variable {
            0 => given.alpha.get(j).copied().unwrap_or(s.cl_alpha) * cos,
            1 => s.cl_alpha * s.dihedral_rad.sin() + s.y.signum() * 2.0 * cl0 * sweep.tan(),
            2 => s.cl_alpha * 2.0 * (s.y * cos + (s.z - z_cg) * sin) / reference.span,
            3 => s.cl_alpha * 2.0 * aft * cos / reference.chord,
            _ => -(4.0 * cl0 * s.y + s.cl_alpha * 2.0 * aft * sin) / reference.span,
        }
    })
}

/// Thin-airfoil derivatives of a plain flap: `dc_l/ddelta` as a share of the lift slope, and `dc_m,c/4/ddelta`.
///
/// `x_hinge` is the hinge's fraction of the chord. Glauert (1927): with `cos t = 1 - 2 x_hinge` (t measured from the
/// leading edge), `tau = 1 - (t - sin t)/pi` and `c_m = -(1/2) sin t (1 - cos t)` \[1/rad\].
pub fn flap_effectiveness(x_hinge: f64) -> (f64, f64) {
    let cos = (1.0 - 2.0 * x_hinge).clamp(-1.0, 1.0);
    let t = cos.acos();
    let tau = 1.0 - (t - t.sin()) / std::f64::consts::PI;
    (tau, -0.5 * t.sin() * (1.0 - cos))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Limits: an all-moving surface (hinge at the leading edge) has tau = 1 and no moment about the quarter chord;
    /// a flap of no chord has none of either. 30 % flap: tau = 0.6607 (thin-airfoil charts).
    #[test]
    fn val_flap_limits() {
        let (tau, moment) = flap_effectiveness(0.0);
        assert!((tau - 1.0).abs() < 1e-15 && moment.abs() < 1e-15);
        let (tau, moment) = flap_effectiveness(1.0);
        assert!(tau.abs() < 1e-15 && moment.abs() < 1e-15);
        assert!((flap_effectiveness(0.7).0 - 0.6607).abs() < 5e-5);
    }
}
