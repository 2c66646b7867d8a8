//! The p-k method: roots of `F(p, V) u = 0` with Theodorsen's function at `k = Im(p) b / V`, mode by mode.

use super::{Follow, Step};
use crate::Error;
use crate::elastic::AeroelasticModel;
use crate::kernels::Kernel;
use crate::neutral::{bordered_step, weights};
use crate::operator::ModalOperator;
use albatross_numerics::{C64, Mat, eigen};

/// Least likeness of the shape over a step.
const LEAST_MAC: f64 = 0.95;
/// Most that a root may miss its extrapolation by, as a share of its modulus.
const LARGEST_SURPRISE: f64 = 0.1;
/// Largest steps tried, as shares of the way to the next speed, until no two modes meet on one root.
const LARGEST_STEPS: [f64; 3] = [1.0, 1.0 / 16.0, 1.0 / 128.0];
/// Steps are not cut below this share of the way to the next speed.
const LEAST_STEP: f64 = 1.0 / 4096.0;

pub(super) struct PK {
    modal: ModalOperator,
    modes: Vec<Option<Root>>,
    speed: f64,
    /// Lowest frequency in still air: what a root near zero is measured by \[rad/s\].
    slowest: f64,
}

/// A root with its shape in the modes of still air.
#[derive(Debug, Clone)]
struct Root {
    p: C64,
    shape: Vec<C64>,
}

impl PK {
    pub(super) fn new(model: &AeroelasticModel, rho: f64) -> Result<Self, Error> {
        let modal = ModalOperator::of(model, rho)?;
        let slowest = modal
            .omega
            .iter()
            .copied()
            .filter(|w| *w > 0.0)
            .fold(f64::INFINITY, f64::min);
        let modes = frozen_roots(&modal, 0.0)?
            .into_iter()
            .filter(|root| root.p.norm() > 1e-6 * slowest)
            .map(Some)
            .collect();
        Ok(Self {
            modal,
            modes,
            speed: 0.0,
            slowest,
        })
    }

    /// What changes of a root are small or large against.
    fn scale(&self, p: C64) -> f64 {
        p.norm().max(0.1 * self.slowest)
    }

    /// The root that continues `from` at `to`, with the lowest likeness of the steps.
    fn follow(&self, from: &Root, to: f64, largest_step: f64) -> Result<Option<(Root, f64)>, Error> {
        let gap = to - self.speed;
        let (mut root, mut speed, mut step) = (from.clone(), self.speed, largest_step * gap);
        let mut slope = C64::new(0.0, 0.0);
        let mut confidence = 1.0_f64;
        while speed < to {
            // Between neighbouring numbers a part of the way may be no way at all.
            let too_small = speed + step <= speed;
            let next = if too_small || speed + 1.001 * step >= to {
                to
            } else {
                speed + step
            };
            let guess = Root {
                p: root.p + slope * (next - speed),
                shape: root.shape.clone(),
            };
            let solved = self.solve(&guess, next).filter(|found| {
                likeness(&found.shape, &root.shape) >= LEAST_MAC
                    && (found.p - guess.p).norm() <= LARGEST_SURPRISE * self.scale(root.p)
            });
            let found = match solved {
                Some(found) => found,
                None if !too_small && step > LEAST_STEP * gap => {
                    step *= 0.5;
                    continue;
                }
                // Roots become real, and real ones oscillate again, with unbounded slope.
                None => match self.across_the_real_axis(&root, next)? {
                    Some(found) => found,
                    None => return Ok(None),
                },
            };
            confidence = confidence.min(likeness(&found.shape, &root.shape));
            let same_kind = (found.p.im == 0.0) == (root.p.im == 0.0);
            slope = if same_kind {
                (found.p - root.p) / (next - speed)
            } else {
                C64::new(0.0, 0.0)
            };
            (root, speed) = (found, next);
            step = (2.0 * step).min(largest_step * gap);
        }
        Ok(Some((root, confidence)))
    }

    /// Newton's method on `F u = 0`, `l.u = 1` in u and the two parts of p. Real roots stay real: their `C` is 1.
    fn solve(&self, guess: &Root, speed: f64) -> Option<Root> {
        const MOST_STEPS: usize = 25;
        let weights = weights(&self.modal, guess.p.norm());
        let size = norm(&guess.shape);
        let mut shape: Vec<C64> = guess
            .shape
            .iter()
            .zip(&weights)
            .map(|(u, w)| u / (w * size))
            .collect();
        let length = norm(&shape).powi(2);
        let normal: Vec<C64> = shape.iter().map(|u| u.conj() / length).collect();
        let mut p = guess.p;
        let real = p.im == 0.0;
        let mut last_step = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let f = self
                .modal
                .operator
                .evaluate(p, speed, Kernel::Theodorsen)
                .scaled(&weights);
            let n = shape.len();
            let by_omega = Mat::from_fn(n, n, |r, c| {
                let by_kernel = if real {
                    C64::new(0.0, 0.0)
                } else {
                    f.by_ln_s[(r, c)] / p.im
                };
                C64::i() * f.by_p[(r, c)] + by_kernel
            });
            let (change, [sigma, omega]) =
                bordered_step(&f.value, [&f.by_p, &by_omega], &shape, &normal).ok()?;
            shape.iter_mut().zip(&change).for_each(|(u, du)| *u += du);
            p += C64::new(sigma, if real { 0.0 } else { omega });
            // An oscillatory root that comes down to the axis is a real one.
            if !p.is_finite() || (!real && p.im <= 1e-6 * self.scale(p)) {
                return None;
            }
            let step = sigma.hypot(omega) / self.scale(p);
            if step < 1e-14 || (step < 1e-10 && step >= 0.5 * last_step) {
                let shape = shape.iter().zip(&weights).map(|(u, w)| u * w).collect();
                return Some(Root { p, shape });
            }
            last_step = step;
        }
        None
    }

    /// The continuation of a root that has come to the real axis: of an oscillatory root the less stable one of the real
    /// roots nearby, of a real root the oscillatory root nearby.
    ///
    /// `dC/dk` is infinite at `k = 0`, so that the oscillatory branch need not begin where the real one ends: it is
    /// looked for at frequencies up to the lowest of still air.
    fn across_the_real_axis(&self, root: &Root, speed: f64) -> Result<Option<Root>, Error> {
        const FREQUENCIES: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.6, 1.0];
        let oscillates = root.p.im > 0.0;
        let frozen = frozen_roots(&self.modal, speed)?;
        let mut starts: Vec<Root> = frozen
            .into_iter()
            .filter(|start| (start.p.im == 0.0) == oscillates)
            .collect();
        if !oscillates {
            starts.extend(FREQUENCIES.map(|share| Root {
                p: C64::new(root.p.re, share * self.slowest),
                shape: root.shape.clone(),
            }));
        }
        let mut found: Vec<Root> = starts
            .iter()
            .filter_map(|start| self.solve(start, speed))
            .filter(|found| {
                (found.p - root.p).norm() <= self.scale(root.p).max(self.slowest)
                    && likeness(&found.shape, &root.shape) > 0.5
                    && !self.is_followed(found)
            })
            .collect();
        if oscillates {
            found.sort_by(|a, b| b.p.re.total_cmp(&a.p.re));
        } else {
            found.sort_by(|a, b| (a.p - root.p).norm().total_cmp(&(b.p - root.p).norm()));
        }
        Ok(found.into_iter().next())
    }

    /// Whether another oscillatory mode was close to `found` at the speed before.
    fn is_followed(&self, found: &Root) -> bool {
        self.modes.iter().flatten().any(|known| {
            known.p.im > 0.0
                && found.p.im > 0.0
                && (known.p - found.p).norm() <= 0.3 * known.p.norm()
                && likeness(&known.shape, &found.shape) > 0.9
        })
    }
}

impl PK {
    /// Two real roots may become one pair, which then belongs to both modes; otherwise the less certain of two modes on
    /// one root has jumped there and is lost.
    fn settle_duplicates(&self, found: &mut [Option<(Root, f64)>], to: f64, notes: &mut Vec<String>) {
        for i in 0..found.len() {
            for j in 0..i {
                let (Some(Some(a)), Some(Some(b))) = (found.get(j), found.get(i)) else {
                    continue;
                };
                if !same_root(&a.0, &b.0) {
                    continue;
                }
                let before = [j, i].map(|k| self.modes.get(k).and_then(|m| m.as_ref()));
                let [Some(p), Some(q)] = before else { continue };
                if same_root(p, q) {
                    continue;
                }
                if p.p.im == 0.0 && q.p.im == 0.0 {
                    notes.push(format!(
                        "modes {} and {} form one pair between {:.6} and {to:.6} m/s",
                        j + 1,
                        i + 1,
                        self.speed
                    ));
                } else {
                    let less_certain = if a.1 < b.1 { j } else { i };
                    found[less_certain] = None;
                }
            }
        }
    }
}

impl Follow for PK {
    fn advance(&mut self, to: f64, notes: &mut Vec<String>) -> Result<Vec<Step>, Error> {
        let advance_all = |largest_step: f64| -> Result<Vec<Option<(Root, f64)>>, Error> {
            let one = |mode: &Option<Root>| match mode {
                Some(root) => self.follow(root, to, largest_step),
                None => Ok(None),
            };
            self.modes.iter().map(one).collect()
        };
        let mut found = Vec::new();
        for largest_step in LARGEST_STEPS {
            found = advance_all(largest_step)?;
            if !duplicates(&found) {
                break;
            }
        }
        self.settle_duplicates(&mut found, to, notes);
        for (mode, (before, after)) in self.modes.iter().zip(&found).enumerate() {
            if before.is_some() && after.is_none() {
                notes.push(format!(
                    "mode {} could not be followed beyond {:.6} m/s",
                    mode + 1,
                    self.speed
                ));
            }
        }
        self.speed = to;
        let steps = found
            .iter()
            .map(|mode| {
                mode.as_ref().map_or(Step::LOST, |(root, confidence)| Step {
                    value: root.p,
                    confidence: *confidence,
                })
            })
            .collect();
        self.modes = found.into_iter().map(|mode| mode.map(|(root, _)| root)).collect();
        Ok(steps)
    }
}

/// Roots with `C = 1` everywhere, one of each pair, by modulus: exact in still air and on the real axis.
fn frozen_roots(modal: &ModalOperator, speed: f64) -> Result<Vec<Root>, Error> {
    let n = modal.operator.n();
    let f = modal
        .operator
        .evaluate(C64::new(0.0, 0.0), speed, Kernel::Theodorsen);
    let a = Mat::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
        (true, _) => f64::from(u8::from(c == n + r)),
        (false, true) => -f.value[(r - n, c)].re,
        (false, false) => -f.by_p[(r - n, c - n)].re,
    });
    let found = eigen::eigen(a.as_ref())?;
    Ok((0..2 * n)
        .filter(|&j| found.values[j].im >= 0.0)
        .map(|j| Root {
            p: found.values[j],
            shape: (0..n).map(|k| found.vectors[(k, j)]).collect(),
        })
        .collect())
}

/// Modal assurance criterion; the mass matrix is the identity in the modes of still air.
fn likeness(u: &[C64], v: &[C64]) -> f64 {
    let product: C64 = u.iter().zip(v).map(|(a, b)| a.conj() * b).sum();
    (product.norm() / (norm(u) * norm(v))).powi(2)
}

fn norm(u: &[C64]) -> f64 {
    u.iter().map(C64::norm_sqr).sum::<f64>().sqrt()
}

fn same_root(a: &Root, b: &Root) -> bool {
    (a.p - b.p).norm() <= 1e-7 * a.p.norm() && likeness(&a.shape, &b.shape) > 0.999
}

/// Whether two modes have one root and one shape.
fn duplicates(modes: &[Option<(Root, f64)>]) -> bool {
    let roots: Vec<&Root> = modes.iter().flatten().map(|(root, _)| root).collect();
    (0..roots.len()).any(|i| (0..i).any(|j| same_root(roots[i], roots[j])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::section::TypicalSection;

    /// Steps of a part of the way between neighbouring numbers once led nowhere.
    #[test]
    fn regress_neighbouring_speeds() {
        let section = TypicalSection {
            mass: 31.41592653589793,
            static_moment: std::f64::consts::TAU,
            inertia: 2.5 * std::f64::consts::PI,
            plunge_stiffness: 78539.81633974482,
            pitch_stiffness: 78539.81633974482,
            semi_chord: 1.0,
            axis: -0.4,
            cl_alpha: std::f64::consts::TAU,
        };
        let mut pk = PK::new(&section.model(&[]).unwrap(), 1.0).unwrap();
        pk.advance(100.0, &mut Vec::new()).unwrap();
        for root in pk.modes.iter().flatten() {
            for largest_step in LARGEST_STEPS {
                let found = pk.follow(root, 100.0_f64.next_up(), largest_step).unwrap();
                let Some((found, confidence)) = found else {
                    panic!("lost {root:?}");
                };
                assert!((found.p - root.p).norm() < 1e-9 * root.p.norm() && confidence > 0.999);
            }
        }
    }
}
