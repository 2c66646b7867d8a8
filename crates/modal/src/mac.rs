//! Modal assurance criterion: do two analyses describe the same modes?
//!
//! `MAC(k, l) = (phi_k^T M phi_l)^2 / (phi_k^T M phi_k  phi_l^T M phi_l)` (Allemang and Brown, IMAC 1982, with the
//! mass matrix as weight). It does not depend on sign and normalisation. Modes of a pair with equal frequency may
//! be turned against each other; compare the pair as a whole then.
//!
//! Equations: THEORY (4c).

use albatross_numerics::{Mat, MatRef};
use std::collections::BTreeMap;

use crate::basis::ModalBasis;
use crate::error::Error;
use crate::mass_matrix::dot;

/// MAC of every mode of `a` (rows) with every mode of `b` (columns), on the grids that both have.
///
/// The weight is the mass matrix of `a`, or that of `b`, if its grids are all common; otherwise the MAC is plain and
/// of the translations alone, since rotations have another unit.
///
/// # Errors
/// [`Error::NoCommonGrids`].
pub fn mac(a: &ModalBasis, b: &ModalBasis) -> Result<Mat<f64>, Error> {
    let index_b: BTreeMap<_, _> = b.grids.iter().enumerate().map(|(i, g)| (g.id, i)).collect();
    let common: Vec<(usize, usize)> = a
        .grids
        .iter()
        .enumerate()
        .filter_map(|(i, g)| Some((i, *index_b.get(&g.id)?)))
        .collect();
    if common.is_empty() {
        return Err(Error::NoCommonGrids);
    }
    let identity = |n: usize| (0..n).map(|i| (i, i)).collect::<Vec<_>>();
    let swapped: Vec<(usize, usize)> = common.iter().map(|&(i, j)| (j, i)).collect();
    // Both families on the grids of `a`, or on those of `b`.
    let on_a = |map_a: &[(usize, usize)]| {
        (
            on_grids(a, a.grids.len(), map_a),
            on_grids(b, a.grids.len(), &swapped),
        )
    };
    let on_b = || {
        (
            on_grids(a, b.grids.len(), &common),
            on_grids(b, b.grids.len(), &identity(b.grids.len())),
        )
    };
    match (&a.mass_matrix, &b.mass_matrix) {
        (Some(mass), _) if common.len() == a.grids.len() => {
            let (left, right) = on_a(&identity(a.grids.len()));
            Ok(matrix(&left, &right, |s| mass.apply(s)))
        }
        (_, Some(mass)) if common.len() == b.grids.len() => {
            let (left, right) = on_b();
            Ok(matrix(&left, &right, |s| mass.apply(s)))
        }
        _ => {
            let only_common: Vec<(usize, usize)> = common.iter().map(|&(i, _)| (i, i)).collect();
            let (left, right) = on_a(&only_common);
            let translations = |s: &Shape| s.iter().map(|&[x, y, z, ..]| [x, y, z, 0.0, 0.0, 0.0]).collect();
            Ok(matrix(&left, &right, translations))
        }
    }
}

type Shape = [[f64; 6]];

/// Every shape of a basis on `len` grids, by (from, to) pairs of indices; zero elsewhere.
fn on_grids(basis: &ModalBasis, len: usize, map: &[(usize, usize)]) -> Vec<Vec<[f64; 6]>> {
    basis
        .modes
        .iter()
        .map(|m| scatter(&m.shape, len, map.iter().copied()))
        .collect()
}

fn scatter(shape: &Shape, len: usize, map: impl Iterator<Item = (usize, usize)>) -> Vec<[f64; 6]> {
    let mut out = vec![[0.0; 6]; len];
    for (from, to) in map {
        if let (Some(source), Some(target)) = (shape.get(from), out.get_mut(to)) {
            *target = *source;
        }
    }
    out
}

fn matrix(
    left: &[Vec<[f64; 6]>],
    right: &[Vec<[f64; 6]>],
    weigh: impl Fn(&Shape) -> Vec<[f64; 6]>,
) -> Mat<f64> {
    let weighed: Vec<_> = right.iter().map(|s| weigh(s)).collect();
    let own_left: Vec<f64> = left.iter().map(|s| dot(s, &weigh(s))).collect();
    let own_right: Vec<f64> = right.iter().zip(&weighed).map(|(s, w)| dot(s, w)).collect();
    Mat::from_fn(left.len(), right.len(), |k, l| {
        let product = dot(&left[k], &weighed[l]);
        let own = own_left[k] * own_right[l];
        if own > 0.0 { product * product / own } else { 0.0 }
    })
}

/// Two modes that belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModePair {
    /// Row of the MAC matrix: index in the first basis.
    pub first: usize,
    /// Column: index in the second basis.
    pub second: usize,
    /// Their MAC.
    pub mac: f64,
}

/// Pairs modes by descending MAC, each mode once, down to `least`; in the order of the first basis.
#[must_use]
pub fn pair_modes(mac: MatRef<'_, f64>, least: f64) -> Vec<ModePair> {
    let mut candidates: Vec<ModePair> = (0..mac.nrows())
        .flat_map(|first| {
            (0..mac.ncols()).map(move |second| ModePair {
                first,
                second,
                mac: mac[(first, second)],
            })
        })
        .filter(|p| p.mac >= least)
        .collect();
    candidates.sort_by(|p, q| q.mac.total_cmp(&p.mac));
    let (mut rows, mut columns) = (vec![false; mac.nrows()], vec![false; mac.ncols()]);
    candidates.retain(|p| {
        let free = !rows[p.first] && !columns[p.second];
        if free {
            rows[p.first] = true;
            columns[p.second] = true;
        }
        free
    });
    candidates.sort_by_key(|p| p.first);
    candidates
}
