//! The denominator as real blocks of first and second order.
//!
//! Powers of s at order 20 with poles from 2 to 90 rad/s span thirty decades, and companion forms lose every digit.
//! Here a denominator is the list of its factors
//! ```text
//! D_i(s) = s + a            or            D_i(s) = s^2 + a1 s + a0
//! ```
//! and a transfer function the sum of one fraction a block. A second-order block holds a conjugate pair or two real
//! poles and passes smoothly from one to the other through the double pole, which (sigma, omega) does not.
//!
//! With the scale w of a block (its natural frequency) the states are of order one:
//! ```text
//! second order   x' = [ 0      w  ] x + [0] u        x1 = w^2/D u,  x2 = w s/D u
//!                     [-a0/w  -a1 ]     [w]
//! first order    x' = -a x + w u                     x  = w/D u
//! ```
//!
//! Equations: THEORY (28a).

use albatross_numerics::{C64, Mat};
use serde::{Deserialize, Serialize};

/// A factor of the denominator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "a factor of the denominator has neither `a1` and `a0` nor `a`"
)]
pub enum Block {
    /// s^2 + a1 s + a0.
    Second {
        /// Coefficient of s \[rad/s\].
        a1: f64,
        /// Constant coefficient \[rad2/s2\].
        a0: f64,
    },
    /// s + a.
    First {
        /// Constant coefficient \[rad/s\].
        a: f64,
    },
}

impl Block {
    /// Number of poles.
    pub fn order(self) -> usize {
        match self {
            Self::First { .. } => 1,
            Self::Second { .. } => 2,
        }
    }

    /// The block of a conjugate pair; only the modulus and the real part count.
    pub fn pair(pole: C64) -> Self {
        Self::Second {
            a1: -2.0 * pole.re,
            a0: pole.norm_sqr(),
        }
    }

    /// Blocks with the given poles \[rad/s\]: conjugate pairs by frequency, then real poles two by two, nearest together.
    ///
    /// Of conjugate members the one with positive imaginary part counts; an odd real pole gets a block of first order.
    pub fn from_poles(poles: &[C64]) -> Vec<Self> {
        from_poles(poles)
    }

    /// The poles \[rad/s\], the member with positive imaginary part first.
    pub fn poles(self) -> Vec<C64> {
        match self {
            Self::First { a } => vec![C64::new(-a, 0.0)],
            Self::Second { a1, a0 } => {
                let discriminant = 0.25 * a1 * a1 - a0;
                if discriminant < 0.0 {
                    let p = C64::new(-0.5 * a1, (-discriminant).sqrt());
                    return vec![p, p.conj()];
                }
                // The root of larger modulus first, so that no digits cancel.
                let large = -0.5 * a1 - discriminant.sqrt().copysign(a1);
                let small = if large == 0.0 { 0.0 } else { a0 / large };
                vec![C64::new(small, 0.0), C64::new(large, 0.0)]
            }
        }
    }

    /// Scale w of the states \[rad/s\], positive.
    pub fn scale(self) -> f64 {
        let w = match self {
            Self::First { a } => a.abs(),
            Self::Second { a1, a0 } => a0.abs().sqrt().max(1e-3 * a1.abs()),
        };
        w.max(1e-9)
    }

    /// Whether all poles lie in the open left half plane.
    pub fn is_stable(self) -> bool {
        match self {
            Self::First { a } => a > 0.0,
            // Routh.
            Self::Second { a1, a0 } => a1 > 0.0 && a0 > 0.0,
        }
    }

    /// D(s).
    pub fn denominator(self, s: C64) -> C64 {
        match self {
            Self::First { a } => s + a,
            Self::Second { a1, a0 } => (s + a1) * s + a0,
        }
    }

    /// Transfer functions from the input to the states, at s.
    pub(crate) fn states(self, s: C64) -> [C64; 2] {
        let (w, d) = (self.scale(), self.denominator(s));
        match self {
            Self::First { .. } => [w / d, C64::new(0.0, 0.0)],
            Self::Second { .. } => [w * w / d, w * s / d],
        }
    }

    /// State matrix and input column, row after row.
    pub(crate) fn matrices(self) -> (Vec<Vec<f64>>, Vec<f64>) {
        let w = self.scale();
        match self {
            Self::First { a } => (vec![vec![-a]], vec![w]),
            Self::Second { a1, a0 } => (vec![vec![0.0, w], vec![-a0 / w, -a1]], vec![0.0, w]),
        }
    }
}

/// Number of poles of a denominator.
pub(crate) fn order(blocks: &[Block]) -> usize {
    blocks.iter().map(|b| b.order()).sum()
}

/// Poles of a denominator \[rad/s\], block after block.
pub(crate) fn poles(blocks: &[Block]) -> Vec<C64> {
    blocks.iter().flat_map(|b| b.poles()).collect()
}

/// See [`Block::from_poles`].
pub(crate) fn from_poles(poles: &[C64]) -> Vec<Block> {
    let mut pairs: Vec<C64> = poles.iter().copied().filter(|p| p.im > 0.0).collect();
    pairs.sort_by(|p, q| p.norm().total_cmp(&q.norm()));
    let mut blocks: Vec<Block> = pairs.into_iter().map(Block::pair).collect();
    let real: Vec<f64> = poles.iter().filter(|p| p.im == 0.0).map(|p| p.re).collect();
    blocks.extend(real_blocks(real));
    blocks
}

/// Pairs real poles so that near ones share a block: only there can they meet and become a conjugate pair.
fn real_blocks(mut real: Vec<f64>) -> Vec<Block> {
    real.sort_by(|p, q| q.total_cmp(p));
    let mut blocks = Vec::new();
    if real.len() % 2 == 1 {
        // The one left over: that without which the others pair best.
        let cost = |left: usize| -> f64 {
            let rest: Vec<f64> = (0..real.len()).filter(|&i| i != left).map(|i| real[i]).collect();
            rest.chunks(2)
                .map(|c| (c[0] - c[1]).abs() / (c[0].abs() + c[1].abs()).max(f64::MIN_POSITIVE))
                .sum()
        };
        let left = (0..real.len()).min_by(|&p, &q| cost(p).total_cmp(&cost(q)));
        if let Some(left) = left {
            blocks.push(Block::First {
                a: -real.remove(left),
            });
        }
    }
    blocks.extend(real.chunks(2).map(|c| Block::Second {
        a1: -(c[0] + c[1]),
        a0: c[0] * c[1],
    }));
    blocks
}

/// The same denominator with its real poles paired anew.
pub(crate) fn repaired(blocks: &[Block]) -> Vec<Block> {
    let real_poles = poles(blocks).iter().filter(|p| p.im == 0.0).count();
    if real_poles > 2 {
        from_poles(&poles(blocks))
    } else {
        blocks.to_vec()
    }
}

/// Block-diagonal state matrix and input column of a denominator.
pub(crate) fn state_matrices(blocks: &[Block]) -> (Mat<f64>, Vec<f64>) {
    let n = order(blocks);
    let (mut a, mut b) = (Mat::zeros(n, n), Vec::with_capacity(n));
    for block in blocks {
        let at = b.len();
        let (rows, input) = block.matrices();
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                a[(at + i, at + j)] = *value;
            }
        }
        b.extend(input);
    }
    (a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Poles to blocks and back, real ones of any number among them.
        #[test]
        fn prop_poles_survive(re in proptest::collection::vec(-100.0..-0.01_f64, 0..7),
                              pairs in proptest::collection::vec((-50.0..-0.01_f64, 0.1..90.0_f64), 0..6)) {
            let mut given: Vec<C64> = re.iter().map(|r| C64::new(*r, 0.0)).collect();
            for (r, i) in &pairs {
                given.push(C64::new(*r, *i));
                given.push(C64::new(*r, -*i));
            }
            let blocks = from_poles(&given);
            prop_assert_eq!(order(&blocks), given.len());
            prop_assert!(blocks.iter().all(|b| b.is_stable()));
            let mut found = poles(&blocks);
            for p in &given {
                // Two close real poles are a double root of their block: half the digits.
                let near = (0..found.len()).min_by(|&a, &b| (found[a] - p).norm().total_cmp(&(found[b] - p).norm())).unwrap();
                let error = (found.swap_remove(near) - p).norm();
                prop_assert!(error <= 1e-6 * p.norm(), "{} {}", p, error);
            }
        }
    }

    #[test]
    fn val_states_are_the_resolvent() {
        let s = C64::new(-0.3, 4.0);
        for block in [
            Block::Second { a1: 0.4, a0: 9.0 },
            Block::Second { a1: 8.0, a0: 7.0 },
            Block::First { a: 2.5 },
        ] {
            let (a, b) = state_matrices(&[block]);
            let n = block.order();
            // (s I - A) x = b.
            let x = block.states(s);
            for i in 0..n {
                let row: C64 = (0..n)
                    .map(|j| (if i == j { s } else { C64::new(0.0, 0.0) } - a[(i, j)]) * x[j])
                    .sum();
                assert!((row - b[i]).norm() < 1e-13, "{block:?}");
            }
        }
    }

    #[test]
    fn val_roots_keep_their_digits() {
        let roots = Block::Second {
            a1: 1e8 + 1e-8,
            a0: 1.0,
        }
        .poles();
        assert!((roots[0].re / -1e-8 - 1.0).abs() < 1e-15 && (roots[1].re / -1e8 - 1.0).abs() < 1e-15);
    }
}
