//! A pair of sparse matrices K, M and its lowest eigenvalues.

use albatross_numerics::Mat;

use crate::error::Error;
use crate::factor::{Analysis, Factor};
use crate::lanczos::{self, Pairs, Wanted};
use crate::sparse::Symmetric;

/// Vectors in a block: more than the rigid modes of a free body, so that they are found at once.
pub(crate) const BLOCK: usize = 8;

/// K x = lambda M x. `nodes[i]` is the point of freedom i, for the elimination order.
#[derive(Debug)]
pub(crate) struct Pencil<'a> {
    pub(crate) stiffness: &'a Symmetric,
    pub(crate) mass: &'a Symmetric,
    pub(crate) nodes: Vec<usize>,
}

/// A pencil ready to be solved: factor of K - sigma M, and a block of vectors to start with.
#[derive(Debug)]
pub(crate) struct Shifted<'a> {
    factor: Factor<'a>,
    stiffness: &'a Symmetric,
    mass: &'a Symmetric,
    start: Mat<f64>,
    sigma: f64,
}

impl<'a> Pencil<'a> {
    pub(crate) fn analysis(&self) -> Result<Analysis, Error> {
        Analysis::new(&self.stiffness.combined(1.0, self.mass, 1.0), &self.nodes)
    }

    /// The number of eigenvalues below one, by the negative pivots of K - lambda M.
    pub(crate) fn count_below(&self, analysis: &Analysis, lambda: f64) -> Result<usize, Error> {
        analysis.negative_count(&self.stiffness.combined(1.0, self.mass, -lambda))
    }

    /// A shift that is surely large enough to make K - sigma M definite in double precision: a millionth of the
    /// median of k_ii / m_ii.
    pub(crate) fn first_shift(&self) -> Result<f64, Error> {
        let (k, m) = (self.stiffness.diagonal(), self.mass.diagonal());
        let massive = k.iter().zip(&m).filter(|(_, m)| **m > 0.0);
        let mut ratios: Vec<f64> = massive.map(|(k, m)| k / m).collect();
        if ratios.is_empty() {
            return Err(Error::EmptyModel {
                problem: "no free freedom carries mass; give densities (RHO of MAT1) with areas (A of PBAR), NSM or CONM2".into(),
            });
        }
        ratios.sort_by(f64::total_cmp);
        let median = ratios.get(ratios.len() / 2).copied().unwrap_or(0.0);
        Ok(if median > 0.0 { -1e-6 * median } else { -1.0 })
    }

    /// Freedoms of motions that have neither stiffness nor mass, one for each motion found: those at which the factor
    /// breaks down, else the largest component of a vector that K - sigma M maps to nothing.
    pub(crate) fn massless_motions(&self, analysis: &Analysis, sigma: f64) -> Result<Vec<usize>, Error> {
        let a = self.stiffness.combined(1.0, self.mass, -sigma);
        let factor = analysis.factorise(&a)?;
        if !factor.singular.is_empty() {
            return Ok(factor.singular);
        }
        Ok(factor.null_motion(&a).into_iter().collect())
    }

    /// Factorises with a shift of the size of the lowest elastic eigenvalues, which a few steps of subspace iteration
    /// estimate. Shifts much smaller lose digits of elastic modes beside rigid ones, much larger ones converge slowly.
    pub(crate) fn shifted(&self, analysis: &'a Analysis) -> Result<Shifted<'a>, Error> {
        let n = self.mass.order();
        let mut sigma = self.first_shift()?;
        let mut block = random_block(n, BLOCK.min(n), 0);
        for round in 0.. {
            let a = self.stiffness.combined(1.0, self.mass, -sigma);
            let factor = analysis.factorise(&a)?;
            let (next, estimates) = lanczos::subspace(&factor, (self.stiffness, self.mass), sigma, block, 2)?;
            let size = estimates.last().copied().unwrap_or(0.0);
            // A shift above what it finds hides the spectrum: the estimates are then of its own size.
            let ratio = -sigma / size;
            if size <= 0.0 || round >= 8 || (0.01..1.0).contains(&ratio) {
                return Ok(Shifted {
                    factor,
                    stiffness: self.stiffness,
                    mass: self.mass,
                    start: next,
                    sigma,
                });
            }
            sigma = if ratio >= 1.0 { -size / 50.0 } else { -0.3 * size };
            block = next;
        }
        Err(Error::EmptyModel {
            problem: "no shift was found".into(),
        })
    }
}

impl Shifted<'_> {
    pub(crate) fn lowest(&self, wanted: Wanted) -> Result<Pairs, Error> {
        lanczos::lowest(
            &self.factor,
            (self.stiffness, self.mass),
            self.sigma,
            self.start.clone(),
            wanted,
        )
    }
}

/// Numbers in (-1, 1) that are the same in every run (a linear congruential sequence, Knuth's MMIX constants).
pub(crate) fn random_block(n: usize, columns: usize, seed: u64) -> Mat<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64.wrapping_add(seed);
    Mat::from_fn(n, columns, |_, _| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}
