//! Which mode is which: following eigenvalues along a path of matrices.
//!
//! A flutter curve, a root locus, or the modes of the full aircraft counted as "first wing bending" need the
//! eigenvalues of A(1) in the order of chosen eigenvalues of A(0). Sorting by frequency or damping fails where
//! modes cross, and counting fails where lag roots lie between them. Here each mode is carried by its spectral
//! projector P = r l^H / (l^H r), with r and l the right and left eigenvectors. Along a path the quantity
//! ```text
//! o_j = (l_j'^H P r_j') / (l_j'^H r_j')          sum over j of o_j = 1 (2 for a conjugate pair)
//! ```
//! is the share of mode j of the next matrix in the mode followed: 1 for the same mode and 0 for any other as
//! the step goes to zero. It uses left and right vectors together, hence does not depend on the units of the
//! states, as a modal assurance criterion on right vectors alone does.
//!
//! A conjugate pair may split into two real modes and two real modes may merge into a pair: the projector on
//! both together is smooth there, and the match is made on that sum.
//!
//! **Veering.** Where two modes repel each other sharply, steps wider than the repulsion keep the mode shape
//! and narrower ones keep the branch. [`TrackOptions::largest_step`] decides, and is part of the definition of
//! a label.
//!
//! Equations: THEORY (25a).

mod matching;
mod spectrum;

use albatross_numerics::eigen::eigen_both;
use albatross_numerics::matrix::check_shape;
use albatross_numerics::{C64, Mat, MatRef};

use crate::modes::participation;
use crate::{Error, Result};
use matching::{Block, Doubt, match_blocks};
use spectrum::Spectrum;

/// How carefully to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackOptions {
    /// Largest step along the path from 0 to 1.
    pub largest_step: f64,
    /// Least step; a mode that is not certain at this step is an error.
    pub least_step: f64,
    /// Largest deviation of the overlap from 1 at an accepted step.
    pub tolerance: f64,
    /// Most eigen-decompositions for one path.
    pub most_decompositions: usize,
}

impl Default for TrackOptions {
    fn default() -> Self {
        Self {
            largest_step: 0.25,
            least_step: 1.0 / 65536.0,
            tolerance: 0.25,
            most_decompositions: 400,
        }
    }
}

/// A mode at the end of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackedMode {
    /// Its eigenvalue, rad/s: of a pair the member with positive imaginary part; two real values when the pair
    /// has split, smaller modulus first.
    pub values: Vec<C64>,
    /// Another mode followed that now forms a conjugate pair together with this one.
    pub merged_with: Option<usize>,
    /// Lowest overlap of its steps: 1 is certain, 1 - tolerance is the least accepted.
    pub confidence: f64,
}

/// What became of the modes, and how certain that is.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// The modes in the order they were chosen.
    pub modes: Vec<TrackedMode>,
    /// Lowest confidence among them.
    pub confidence: f64,
    /// Steps taken.
    pub steps: usize,
    /// Eigen-decompositions made, rejected steps included.
    pub decompositions: usize,
    /// Smallest step taken.
    pub smallest_step: f64,
}

impl Followed {
    /// First eigenvalue of each mode: all there is unless a pair has split.
    pub fn values(&self) -> Vec<C64> {
        self.modes
            .iter()
            .filter_map(|mode| mode.values.first().copied())
            .collect()
    }
}

/// Follows chosen eigenvalues of `a0` to `a1` along A(t) = a0 + t (a1 - a0).
///
/// `chosen` holds one member of each conjugate pair, as found by [`eigenvalues`](albatross_numerics::eigen)
/// or [`modes_carried_by`].
///
/// # Errors
/// [`Error::BadStart`] when a chosen value is not an eigenvalue of `a0`, [`Error::Unresolved`] when a mode is
/// not certain at the least step, [`Error::Numerics`].
pub fn track(
    a0: MatRef<'_, f64>,
    a1: MatRef<'_, f64>,
    chosen: &[C64],
    options: TrackOptions,
) -> Result<Followed> {
    Tracker::new(a0, chosen, options)?.follow(a1)
}

/// Eigenvalues of `a` (one per pair, modulus ascending) carried for more than half by the given states.
///
/// With the structural and rigid-body states this selects the modes proper and leaves out lag roots.
///
/// # Errors
/// [`Error::Numerics`].
pub fn modes_carried_by(a: MatRef<'_, f64>, states: &[usize]) -> Result<Vec<C64>> {
    let eigen = eigen_both(a)?;
    let carried = |k: usize| {
        let shares = participation(eigen.left.as_ref(), eigen.right.as_ref(), k);
        let total: f64 = shares.iter().sum();
        states.iter().filter_map(|&i| shares.get(i)).sum::<f64>() > 0.5 * total
    };
    Ok((0..eigen.values.len())
        .filter(|&k| eigen.values[k].im >= 0.0 && carried(k))
        .map(|k| eigen.values[k])
        .collect())
}

/// Follows modes through a sequence of matrices, such as A(V) over a list of speeds.
#[derive(Debug, Clone)]
pub struct Tracker {
    matrix: Mat<f64>,
    spectrum: Spectrum,
    blocks: Vec<Block>,
    modes: usize,
    options: TrackOptions,
}

impl Tracker {
    /// Starts at `a0` with one member of each chosen pair.
    ///
    /// # Errors
    /// [`Error::BadStart`] when a chosen value is not an eigenvalue of `a0` to 1e-6, is chosen twice, or is
    /// defective; [`Error::Domain`] for options out of range; [`Error::Numerics`].
    pub fn new(a0: MatRef<'_, f64>, chosen: &[C64], options: TrackOptions) -> Result<Self> {
        check_options(&options)?;
        let spectrum = Spectrum::of(a0)?;
        let mut blocks: Vec<Block> = Vec::with_capacity(chosen.len());
        for (mode, &value) in chosen.iter().enumerate() {
            let bad = |reason| Error::BadStart {
                re: value.re,
                im: value.im,
                reason,
            };
            let members = spectrum
                .nearest(value, |k| blocks.iter().any(|b| b.members.contains(&k)))
                .ok_or_else(|| bad("it is not an eigenvalue of the first matrix, or is chosen twice"))?;
            if members.iter().any(|&k| spectrum.is_defective(k)) {
                return Err(bad(
                    "its left and right eigenvectors are orthogonal (a multiple root)",
                ));
            }
            blocks.push(Block {
                members,
                owners: vec![mode],
                overlap: 1.0,
            });
        }
        Ok(Self {
            matrix: a0.to_owned(),
            spectrum,
            blocks,
            modes: chosen.len(),
            options,
        })
    }

    /// Follows to `a` along the straight line from the last matrix.
    ///
    /// # Errors
    /// [`Error::Unresolved`], [`Error::Numerics`]; the tracker then stays at the last matrix.
    pub fn follow(&mut self, a: MatRef<'_, f64>) -> Result<Followed> {
        let shape = (self.matrix.nrows(), self.matrix.ncols());
        check_shape("the matrix to follow to", (a.nrows(), a.ncols()), shape)?;
        let from = self.matrix.clone();
        let n = shape.0;
        self.follow_path(|t| {
            Ok(Mat::from_fn(n, n, |i, j| {
                from[(i, j)] + t * (a[(i, j)] - from[(i, j)])
            }))
        })
    }

    /// Follows along `path(t)` from t = 0, which must be the last matrix, to t = 1.
    ///
    /// # Errors
    /// As [`Tracker::follow`], and those of `path`.
    pub fn follow_path(&mut self, mut path: impl FnMut(f64) -> Result<Mat<f64>>) -> Result<Followed> {
        let mut report = Followed {
            modes: Vec::new(),
            confidence: 1.0,
            steps: 0,
            decompositions: 0,
            smallest_step: self.options.largest_step,
        };
        let mut lowest = vec![1.0_f64; self.modes];
        let (mut spectrum, mut blocks) = (self.spectrum.clone(), self.blocks.clone());
        let mut matrix = self.matrix.clone();
        let (mut t, mut step) = (0.0, self.options.largest_step);
        while t < 1.0 {
            // Land on 1 exactly.
            let next_t = if t + 1.001 * step >= 1.0 { 1.0 } else { t + step };
            let a = path(next_t)?;
            let size = |m: &Mat<f64>| (m.nrows(), m.ncols());
            check_shape("the matrix of the path", size(&a), size(&self.matrix))?;
            let next = Spectrum::of(a.as_ref())?;
            report.decompositions += 1;
            match match_blocks(&spectrum, &blocks, &next, self.options.tolerance) {
                Ok(matched) => {
                    for block in &matched {
                        block
                            .owners
                            .iter()
                            .for_each(|&mode| lowest[mode] = lowest[mode].min(block.overlap));
                    }
                    let margin = matched.iter().fold(1.0_f64, |m, b| m.min(b.overlap));
                    report.steps += 1;
                    report.smallest_step = report.smallest_step.min(next_t - t);
                    (t, spectrum, blocks, matrix) = (next_t, next, matched, a);
                    if margin > 1.0 - 0.25 * self.options.tolerance {
                        step = (2.0 * step).min(self.options.largest_step);
                    }
                }
                Err(doubt) => {
                    step = 0.5 * (next_t - t);
                    let exhausted = report.decompositions >= self.options.most_decompositions;
                    if step < self.options.least_step || exhausted {
                        return Err(self.unresolved(&spectrum, &blocks, doubt, t));
                    }
                }
            }
        }
        (self.spectrum, self.blocks, self.matrix) = (spectrum, blocks, matrix);
        report.modes = self.current(&lowest);
        report.confidence = lowest.iter().copied().fold(1.0, f64::min);
        Ok(report)
    }

    /// The modes at the last matrix.
    pub fn modes(&self) -> Vec<TrackedMode> {
        self.current(&vec![1.0; self.modes])
    }

    /// Right eigenvector of mode `mode` at the last matrix, unit 2-norm; that of its first value if it has two.
    pub fn vector(&self, mode: usize) -> Option<Vec<C64>> {
        let block = self.blocks.iter().find(|b| b.owners.contains(&mode))?;
        Some(self.spectrum.right_vector(*block.members.last()?))
    }

    fn current(&self, lowest: &[f64]) -> Vec<TrackedMode> {
        (0..self.modes)
            .map(|mode| {
                let own: Vec<&Block> = self.blocks.iter().filter(|b| b.owners.contains(&mode)).collect();
                // The last member of a pair is the one with positive imaginary part.
                let mut values: Vec<C64> = own
                    .iter()
                    .filter_map(|b| b.members.last())
                    .map(|&k| self.spectrum.value(k))
                    .collect();
                values.sort_by(|p, q| p.norm().total_cmp(&q.norm()));
                let merged_with = own
                    .iter()
                    .flat_map(|b| &b.owners)
                    .copied()
                    .find(|&other| other != mode);
                TrackedMode {
                    values,
                    merged_with,
                    confidence: lowest[mode],
                }
            })
            .collect()
    }

    fn unresolved(&self, spectrum: &Spectrum, blocks: &[Block], doubt: Doubt, progress: f64) -> Error {
        let block = blocks.get(doubt.block);
        let value = block
            .and_then(|b| b.members.last())
            .map(|&k| spectrum.value(k))
            .unwrap_or_default();
        Error::Unresolved {
            mode: block.and_then(|b| b.owners.first().copied()).unwrap_or(0),
            re: value.re,
            im: value.im,
            progress,
            best: doubt.best,
            next: doubt.next,
            least_step: self.options.least_step,
        }
    }
}

pub(crate) fn check_options(options: &TrackOptions) -> Result<()> {
    // A path of accepted steps alone ends within the work that is allowed, too.
    let reach = options.largest_step * options.most_decompositions as f64;
    if reach < 1.0 {
        return Err(Error::Domain {
            what: "the largest step times the most decompositions",
            value: reach,
            expected: "1 or more, the length of a path",
        });
    }
    let checks = [
        ("the largest step", options.largest_step, 0.0, 1.0),
        ("the least step", options.least_step, 0.0, options.largest_step),
        ("the tolerance", options.tolerance, 0.0, 0.45),
    ];
    for (what, value, low, high) in checks {
        if !(value > low && value <= high) {
            let expected = "more than 0 and at most 1 (least step: the largest step; tolerance: 0.45)";
            return Err(Error::Domain {
                what,
                value,
                expected,
            });
        }
    }
    Ok(())
}
