//! Following roots along the straight line from one matrix to another.

use albatross_numerics::matrix::check_shape;

use super::form::LagForm;
use super::root::{Effort, Root};
use crate::track::{TrackOptions, check_options};
use crate::{Error, Result};

/// Two roots nearer than this, relative, are one.
const SAME: f64 = 1e-8;
/// A pair whose imaginary part is below this share of its modulus is about to split.
const NEARLY_REAL: f64 = 1e-6;

/// Roots at the end of a path.
#[derive(Debug, Clone)]
pub struct FollowedRoots {
    /// The roots in the order they were given.
    pub roots: Vec<Root>,
    /// Lowest overlap of the steps of each: 1 is certain.
    pub confidence: Vec<f64>,
    /// Steps taken.
    pub steps: usize,
    /// Smallest step taken.
    pub smallest_step: f64,
    /// Work done, rejected steps included.
    pub effort: Effort,
}

/// A root in doubt: which one, and its overlap.
struct Doubt {
    root: usize,
    overlap: f64,
}

/// Follows `roots` of `from` to `to` along `from + t (to - from)`, with the steps and the certainty of
/// [`track`](crate::track()).
///
/// # Errors
/// [`Error::Unresolved`] where a root is not certain at the least step, meets another one, or leaves the real axis or comes
/// down on it; [`Error::Numerics`] for forms of different size, [`Error::Domain`] for options out of range.
pub fn follow(from: &LagForm, to: &LagForm, roots: &[Root], options: TrackOptions) -> Result<FollowedRoots> {
    check_options(&options)?;
    let size = |form: &LagForm| (form.core_count(), form.lag_count());
    check_shape("the form to follow to", size(to), size(from))?;
    for root in roots {
        check_shape("a root to follow", root.size(), size(from))?;
    }
    let mut found = FollowedRoots {
        roots: roots.to_vec(),
        confidence: vec![1.0; roots.len()],
        steps: 0,
        smallest_step: options.largest_step,
        effort: Effort::default(),
    };
    let (mut t, mut step, mut tried) = (0.0, options.largest_step, 0);
    while t < 1.0 {
        // Land on 1 exactly.
        let next_t = if t + 1.001 * step >= 1.0 { 1.0 } else { t + step };
        let form = from.between(to, next_t);
        tried += 1;
        match one_step(&form, &found.roots, options.tolerance, &mut found.effort) {
            Ok(next) => {
                let mut margin = 1.0_f64;
                for (lowest, (_, overlap)) in found.confidence.iter_mut().zip(&next) {
                    *lowest = lowest.min(*overlap);
                    margin = margin.min(*overlap);
                }
                found.roots = next.into_iter().map(|(root, _)| root).collect();
                found.steps += 1;
                found.smallest_step = found.smallest_step.min(next_t - t);
                t = next_t;
                if margin > 1.0 - 0.25 * options.tolerance {
                    step = (2.0 * step).min(options.largest_step);
                }
            }
            Err(doubt) => {
                step = 0.5 * (next_t - t);
                if step < options.least_step || tried >= options.most_decompositions {
                    let value = found.roots.get(doubt.root).map(|r| r.value).unwrap_or_default();
                    return Err(Error::Unresolved {
                        mode: doubt.root,
                        re: value.re,
                        im: value.im,
                        progress: t,
                        best: doubt.overlap,
                        next: 0.0,
                        least_step: options.least_step,
                    });
                }
            }
        }
    }
    Ok(found)
}

/// The roots of the next form with their overlaps, 1 - |deviation|.
fn one_step(
    form: &LagForm,
    roots: &[Root],
    tolerance: f64,
    effort: &mut Effort,
) -> std::result::Result<Vec<(Root, f64)>, Doubt> {
    let mut next: Vec<(Root, f64)> = Vec::with_capacity(roots.len());
    for (index, old) in roots.iter().enumerate() {
        let doubt = |overlap| Doubt { root: index, overlap };
        let new = form.root_like(old, effort).ok_or_else(|| doubt(0.0))?;
        let share = new.share_in(old);
        let certain = (1.0 - share).abs() <= tolerance;
        let pair = old.value.im != 0.0;
        let still_pair = new.value.im.abs() > NEARLY_REAL * new.value.norm();
        let met = next
            .iter()
            .any(|(other, _)| (other.value - new.value).norm() <= SAME * new.value.norm());
        if !certain || met || pair != still_pair {
            return Err(doubt(share));
        }
        next.push((new, 1.0 - (1.0 - share).abs()));
    }
    Ok(next)
}
