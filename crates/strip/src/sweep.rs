//! Modes over a range of speeds, and where they become unstable.
//!
//! Two descriptions of the air are followed mode by mode from still air upwards:
//!
//! - **state space**: eigenvalues of the state matrix with lags, followed by the overlap of left and right
//!   eigenvectors ([`albatross_lti::Tracker`]);
//! - **p-k** (Hassig, J. Aircraft 8, 1971): roots of `F(p, V) u = 0` with Theodorsen's function at `k_j = Im(p) b_j / V` for each strip,
//!   followed by Newton's method and the likeness of the shape; real roots see `C = 1`.
//!
//! The crossings are those of [`neutral_points`] and [`divergence_points`], which do not depend on the speeds asked
//! for: an instability between two of them is not missed. Every mode is followed through the crossing speeds too, and
//! a crossing belongs to the mode that is neutral there.
//!
//! Equations: THEORY (27).

mod pk;
mod state_space;

use crate::Error;
use crate::check::ensure_not_negative;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use crate::neutral::{divergence_points, neutral_points};
use albatross_numerics::C64;
use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::f64::consts::TAU;

/// Which aerodynamics a sweep uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The model's lags.
    #[default]
    StateSpace,
    /// Theodorsen's function at each mode's own frequency.
    PK,
}

/// Modes over speed.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SpeedSweep {
    /// The aerodynamics.
    pub method: Method,
    /// Density \[kg/m³\].
    pub rho: f64,
    /// True airspeeds asked for \[m/s\].
    pub speeds: Vec<f64>,
    /// The modes, in the order of their frequency in still air.
    pub modes: Vec<SweptMode>,
    /// Flutter and divergence within the range of speeds, in the order of speed.
    pub crossings: Vec<Crossing>,
    /// What a reader of the figures should know.
    pub notes: Vec<String>,
}

/// A mode over speed; one entry per speed. Entries are NaN from where a mode could not be followed further.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweptMode {
    /// Eigenvalue \[rad/s\]: of a pair the member with positive imaginary part; of a pair that has become two real
    /// roots the less stable one. Serialised as `{re, im}`.
    pub eigenvalues: Vec<C64>,
    /// Damped frequency, `Im p / 2 pi` \[Hz\].
    pub frequency_hz: Vec<f64>,
    /// Damping ratio, `-Re p / |p|`; -1 or 1 for a real root.
    pub damping_ratio: Vec<f64>,
    /// Certainty that this is still the same mode: the lowest overlap (state space) or modal assurance criterion (p-k)
    /// of the steps since the speed before, 1 at best.
    pub confidence: Vec<f64>,
}

/// What happens at a neutral speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CrossingKind {
    /// An oscillatory mode is neutral.
    Flutter,
    /// A real root is zero.
    Divergence,
}

/// A speed at which a mode is neutral.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Crossing {
    /// Oscillatory or not.
    pub kind: CrossingKind,
    /// Index of the mode; none if the root is one of the wake's own (divergence often is), or was not followed.
    pub mode: Option<usize>,
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Frequency, 0 for divergence \[rad/s\].
    pub omega_rad_s: f64,
    /// Whether the mode is unstable above this speed; false where it recovers.
    pub unstable_above: bool,
}

impl Serialize for SweptMode {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(serde::Serialize)]
        struct Parts {
            re: Vec<f64>,
            im: Vec<f64>,
        }
        let mut s = serializer.serialize_struct("SweptMode", 4)?;
        let parts = Parts {
            re: self.eigenvalues.iter().map(|p| p.re).collect(),
            im: self.eigenvalues.iter().map(|p| p.im).collect(),
        };
        s.serialize_field("eigenvalues", &parts)?;
        s.serialize_field("frequency_hz", &self.frequency_hz)?;
        s.serialize_field("damping_ratio", &self.damping_ratio)?;
        s.serialize_field("confidence", &self.confidence)?;
        s.end()
    }
}

impl SweptMode {
    fn push(&mut self, step: Step) {
        let p = step.value;
        self.eigenvalues.push(p);
        self.frequency_hz.push(p.im / TAU);
        self.damping_ratio
            .push(if p.norm() == 0.0 { 0.0 } else { -p.re / p.norm() });
        self.confidence.push(step.confidence);
    }
}

/// A mode at a speed.
#[derive(Debug, Clone, Copy)]
struct Step {
    value: C64,
    confidence: f64,
}

impl Step {
    const LOST: Self = Self {
        value: C64::new(f64::NAN, f64::NAN),
        confidence: 0.0,
    };
}

/// Something that carries all modes to the next higher speed.
trait Follow {
    /// The modes at `speed`, not below the last one asked for; what is remarkable is added to `notes`.
    fn advance(&mut self, speed: f64, notes: &mut Vec<String>) -> Result<Vec<Step>, Error>;
}

/// Follows all elastic modes over `speeds` \[m/s\] and finds where they flutter and diverge.
///
/// # Errors
/// [`Error::BadFlow`] for a density or speed that is negative or not finite, [`Error::NotIncreasing`] for speeds out of
/// order, [`Error::Empty`] without speeds, what [`neutral_points`] returns, [`Error::BadOption`] for a state space of more
/// than 20 000 states, and [`Error::Tracking`] or [`Error::Numerics`] from the eigenproblems.
pub fn sweep(
    model: &AeroelasticModel,
    rho: f64,
    speeds: &[f64],
    method: Method,
) -> Result<SpeedSweep, Error> {
    ensure_not_negative("density", rho)?;
    let (Some(&first), Some(&last)) = (speeds.first(), speeds.last()) else {
        return Err(Error::Empty { what: "speeds" });
    };
    for (index, &found) in speeds.iter().enumerate() {
        ensure_not_negative("speed", found)?;
        if let Some(&previous) = index.checked_sub(1).and_then(|i| speeds.get(i))
            && found <= previous
        {
            return Err(Error::NotIncreasing {
                index,
                previous,
                found,
            });
        }
    }
    let mut notes = Vec::new();
    let all = crossings(model, rho, method, &mut notes)?;
    let below = all.iter().filter(|c| c.speed < first).count();
    if below > 0 {
        notes.push(format!(
            "{below} neutral points lie below the first speed, {first} m/s"
        ));
    }
    let mut crossings: Vec<Crossing> = all
        .into_iter()
        .filter(|c| (first..=last).contains(&c.speed))
        .collect();

    let mut stops: Vec<f64> = speeds
        .iter()
        .copied()
        .chain(crossings.iter().map(|c| c.speed))
        .collect();
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    let mut follower: Box<dyn Follow> = match method {
        Method::StateSpace => Box::new(state_space::StateSpace::new(model, rho, speeds)?),
        Method::PK => Box::new(pk::PK::new(model, rho)?),
    };
    let mut modes: Vec<SweptMode> = Vec::new();
    let mut lowest: Vec<f64> = Vec::new();
    for stop in stops {
        let steps = follower.advance(stop, &mut notes)?;
        modes.resize_with(steps.len(), SweptMode::default);
        lowest.resize(steps.len(), 1.0);
        for (low, step) in lowest.iter_mut().zip(&steps) {
            *low = low.min(step.confidence);
        }
        for crossing in crossings.iter_mut().filter(|c| c.speed == stop) {
            crossing.mode = neutral_mode(crossing, &steps);
        }
        if speeds.contains(&stop) {
            for ((mode, step), low) in modes.iter_mut().zip(steps).zip(&mut lowest) {
                mode.push(Step {
                    confidence: std::mem::replace(low, 1.0),
                    ..step
                });
            }
        }
    }
    Ok(SpeedSweep {
        method,
        rho,
        speeds: speeds.to_vec(),
        modes,
        crossings,
        notes,
    })
}

/// All neutral points, modes not yet named.
fn crossings(
    model: &AeroelasticModel,
    rho: f64,
    method: Method,
    notes: &mut Vec<String>,
) -> Result<Vec<Crossing>, Error> {
    let kernel = match method {
        Method::StateSpace => Kernel::Lags(&model.lags),
        Method::PK => Kernel::Theodorsen,
    };
    let oscillatory = neutral_points(model, rho, kernel)?;
    for omega in oscillatory.unstable_at_rest {
        notes.push(format!(
            "a mode of {omega:.4} rad/s grows however small the speed is: give the modes structural damping, or check the lift slopes"
        ));
    }
    let flutter = oscillatory.points.into_iter().map(|p| Crossing {
        kind: CrossingKind::Flutter,
        mode: None,
        speed: p.speed,
        omega_rad_s: p.omega_rad_s,
        unstable_above: p.growth > 0.0,
    });
    let divergence = divergence_points(model, rho, kernel)?
        .into_iter()
        .map(|p| Crossing {
            kind: CrossingKind::Divergence,
            mode: None,
            speed: p.speed,
            omega_rad_s: 0.0,
            unstable_above: p.growth > 0.0,
        });
    let mut all: Vec<Crossing> = flutter.chain(divergence).collect();
    all.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(all)
}

/// The mode whose eigenvalue at the crossing is the neutral one.
fn neutral_mode(crossing: &Crossing, steps: &[Step]) -> Option<usize> {
    const SAME: f64 = 1e-6;
    let neutral = C64::new(0.0, crossing.omega_rad_s);
    let slowest = steps
        .iter()
        .map(|s| s.value.im)
        .filter(|w| *w > 0.0)
        .fold(f64::INFINITY, f64::min);
    let scale = match crossing.kind {
        CrossingKind::Flutter => crossing.omega_rad_s,
        CrossingKind::Divergence => slowest,
    };
    steps
        .iter()
        .enumerate()
        .map(|(mode, step)| (mode, (step.value - neutral).norm()))
        .filter(|(_, distance)| *distance <= SAME * scale)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(mode, _)| mode)
}
