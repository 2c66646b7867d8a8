//! All eigenvalues and both sets of eigenvectors of one matrix, with the products tracking needs.

use albatross_numerics::eigen::{EigenBoth, eigen_both};
use albatross_numerics::{C64, Mat, MatRef};

use crate::Result;

/// Eigen-decomposition with the left vectors scaled to l_j^H r_j = 1.
#[derive(Debug, Clone)]
pub(super) struct Spectrum {
    values: Vec<C64>,
    right: Mat<C64>,
    /// Rows l_j^H/(l_j^H r_j).
    dual: Mat<C64>,
    /// |l_j^H r_j| with unit vectors: the reciprocal condition of the eigenvalue.
    cosine: Vec<f64>,
}

impl Spectrum {
    pub(super) fn of(a: MatRef<'_, f64>) -> Result<Self> {
        let EigenBoth { values, right, left } = eigen_both(a)?;
        let n = values.len();
        let products: Vec<C64> = (0..n)
            .map(|j| (0..n).map(|i| left[(i, j)].conj() * right[(i, j)]).sum())
            .collect();
        let dual = Mat::from_fn(n, n, |j, i| left[(i, j)].conj() / products[j]);
        let cosine = (0..n)
            .map(|j| {
                // Sum of magnitudes instead of norms: free of units.
                let size: f64 = (0..n).map(|i| (left[(i, j)].conj() * right[(i, j)]).norm()).sum();
                products[j].norm() / size
            })
            .collect();
        Ok(Self {
            values,
            right,
            dual,
            cosine,
        })
    }

    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    pub(super) fn value(&self, k: usize) -> C64 {
        self.values[k]
    }

    pub(super) fn right_vector(&self, k: usize) -> Vec<C64> {
        (0..self.len()).map(|i| self.right[(i, k)]).collect()
    }

    pub(super) fn is_real(&self, k: usize) -> bool {
        self.values[k].im == 0.0
    }

    pub(super) fn is_defective(&self, k: usize) -> bool {
        self.cosine[k].is_nan() || self.cosine[k] < 1e-10
    }

    /// Indices of a real value, or of a pair with the negative imaginary part first.
    pub(super) fn family(&self, k: usize) -> Vec<usize> {
        let im = self.values[k].im;
        // The order by modulus keeps pairs adjacent, negative imaginary part first.
        if im == 0.0 {
            vec![k]
        } else if im > 0.0 {
            vec![k - 1, k]
        } else {
            vec![k, k + 1]
        }
    }

    /// The family of the value nearest to `value` or its conjugate, to 1e-6, skipping those `taken`.
    pub(super) fn nearest(&self, value: C64, taken: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
        const SAME: f64 = 1e-6;
        let target = C64::new(value.re, value.im.abs());
        let scale = self.values.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let distance = |k: usize| (self.values[k] - target).norm();
        (0..self.len())
            .filter(|&k| self.values[k].im >= 0.0 && !taken(k))
            .min_by(|&p, &q| distance(p).total_cmp(&distance(q)))
            .filter(|&k| distance(k) <= SAME * target.norm() + f64::EPSILON * scale)
            .map(|k| self.family(k))
    }

    /// Shares o_j of every mode j of `next` in the mode spanned by each group of `members` of this spectrum.
    pub(super) fn overlaps(&self, groups: &[&[usize]], next: &Self) -> Vec<Vec<C64>> {
        let members: Vec<usize> = groups.iter().flat_map(|g| g.iter().copied()).collect();
        let n = self.len();
        let right = Mat::from_fn(n, members.len(), |i, m| self.right[(i, members[m])]);
        let dual = Mat::from_fn(members.len(), n, |m, i| self.dual[(members[m], i)]);
        // o_j = sum over members m of (l_j' r_m)(l_m r_j').
        let onto = &next.dual * &right;
        let from = &dual * &next.right;
        let mut first = 0;
        groups
            .iter()
            .map(|group| {
                let range = first..first + group.len();
                first = range.end;
                (0..n)
                    .map(|j| range.clone().map(|m| onto[(j, m)] * from[(m, j)]).sum())
                    .collect()
            })
            .collect()
    }
}
