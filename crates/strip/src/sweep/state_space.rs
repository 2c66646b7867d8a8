//! Eigenvalues of the state matrix, followed by left and right eigenvectors.

use super::{Follow, Step};
use crate::Error;
use crate::elastic::{AeroelasticModel, Flow, assemble_compact, check_compact};
use crate::operator::ModalOperator;
use albatross_lti::{TrackOptions, TrackedMode, Tracker};
use albatross_numerics::{C64, Mat, eigen};

pub(super) struct StateSpace<'a> {
    model: &'a AeroelasticModel,
    rho: f64,
    /// Eigenvalues in still air.
    still: Vec<C64>,
    tracker: Tracker,
    speed: f64,
}

/// Steps may be as wide as the way between two speeds: the overlap decides whether they are too wide.
const OPTIONS: TrackOptions = TrackOptions {
    largest_step: 1.0,
    least_step: 1.0 / 16384.0,
    tolerance: 0.25,
    most_decompositions: 200,
};

impl<'a> StateSpace<'a> {
    pub(super) fn new(model: &'a AeroelasticModel, rho: f64, speeds: &[f64]) -> Result<Self, Error> {
        let modal = ModalOperator::of(model, rho)?;
        check_compact(model)?;
        let still = still_air(&modal)?;
        // In still air all lag states are alike, and vectors not defined: start where the air hardly matters.
        let slowest = still.iter().map(|p| p.norm()).fold(f64::INFINITY, f64::min);
        let narrowest = model
            .strips
            .iter()
            .map(|s| s.semi_chord())
            .fold(f64::INFINITY, f64::min);
        let lowest = speeds.iter().copied().find(|v| *v > 0.0).unwrap_or(1.0);
        let speed = (1e-3 * slowest * narrowest).min(lowest);
        let a = assemble_compact(model, Flow { rho, speed })?;
        let chosen = nearest_unique(&still, &a)?;
        Ok(Self {
            model,
            rho,
            still,
            tracker: Tracker::new(a.as_ref(), &chosen, OPTIONS)?,
            speed,
        })
    }
}

impl Follow for StateSpace<'_> {
    fn advance(&mut self, to: f64, notes: &mut Vec<String>) -> Result<Vec<Step>, Error> {
        if to == 0.0 {
            let at_rest = |&value: &C64| Step {
                value,
                confidence: 1.0,
            };
            return Ok(self.still.iter().map(at_rest).collect());
        }
        let (model, rho, from) = (self.model, self.rho, self.speed);
        let at = |speed: f64| assemble_compact(model, Flow { rho, speed });
        if to > from {
            self.speed = to;
            match self.tracker.follow_path(|t| Ok(at(from + t * (to - from))?)) {
                Ok(followed) => return Ok(followed.modes.iter().map(step).collect()),
                Err(doubt) => {
                    notes.push(format!(
                        "between {from:.6} and {to:.6} m/s modes are named by nearness alone: {doubt}"
                    ));
                    let last: Vec<C64> = self.tracker.modes().iter().map(|m| step(m).value).collect();
                    let a = at(to)?;
                    let chosen = nearest_unique(&last, &a)?;
                    self.tracker = Tracker::new(a.as_ref(), &chosen, OPTIONS)?;
                    let by_nearness = |value| Step {
                        value,
                        confidence: 0.0,
                    };
                    return Ok(chosen.into_iter().map(by_nearness).collect());
                }
            }
        }
        Ok(self.tracker.modes().iter().map(step).collect())
    }
}

/// A tracked mode as it is shown: of a pair that has become two real roots the less stable one.
fn step(mode: &TrackedMode) -> Step {
    let less_stable = |a: C64, b: C64| if b.re > a.re { b } else { a };
    mode.values
        .iter()
        .copied()
        .reduce(less_stable)
        .map_or(Step::LOST, |value| Step {
            value,
            confidence: mode.confidence,
        })
}

/// Eigenvalues of the structure with the apparent mass of still air, one of each pair, by modulus; free modes, whose
/// eigenvalues are zero, are left out.
fn still_air(modal: &ModalOperator) -> Result<Vec<C64>, Error> {
    let n = modal.operator.n();
    let a = Mat::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
        (true, true) => 0.0,
        (true, false) => f64::from(u8::from(c == n + r)),
        (false, true) => -f64::from(u8::from(r == n + c)) * modal.omega[c].powi(2),
        (false, false) => -modal.operator.damping[(r - n, c - n)],
    });
    let slowest = modal
        .omega
        .iter()
        .copied()
        .filter(|w| *w > 0.0)
        .fold(f64::INFINITY, f64::min);
    Ok(eigen::eigenvalues(a.as_ref())?
        .into_iter()
        .filter(|p| p.im >= 0.0 && p.norm() > 1e-6 * slowest)
        .collect())
}

/// For each of `values` the nearest eigenvalue of `a` that is not yet taken, one of each pair.
fn nearest_unique(values: &[C64], a: &Mat<f64>) -> Result<Vec<C64>, Error> {
    let mut free: Vec<C64> = eigen::eigenvalues(a.as_ref())?
        .into_iter()
        .filter(|p| p.im >= 0.0)
        .collect();
    Ok(values
        .iter()
        .filter_map(|value| {
            let distance = |p: &C64| (p - value).norm();
            let at = (0..free.len()).min_by(|&i, &j| distance(&free[i]).total_cmp(&distance(&free[j])))?;
            Some(free.swap_remove(at))
        })
        .collect())
}
