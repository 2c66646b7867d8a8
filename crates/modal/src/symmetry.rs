//! Symmetric and antisymmetric modes, by grids that mirror each other about the plane y = 0.
//!
//! The mirror S maps (T1, T2, T3, R1, R2, R3) to (T1, -T2, T3, -R1, R2, -R3): translations are a polar vector,
//! rotations an axial one. A shape splits into (u + S u') / 2 and (u - S u') / 2 with u' the motion of the mirrored
//! grid; the two parts are orthogonal for a mirrored mass, so their kinetic energies add up.
//!
//! Equations: THEORY (4b).

use serde::Serialize;
use std::collections::BTreeMap;

use crate::basis::BasisGrid;
use crate::mass_matrix::MassMatrix;

/// Class of a mode about the plane y = 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub enum Symmetry {
    /// Both sides move alike: excited by elevator, heave and pitch.
    Symmetric,
    /// The sides move oppositely: excited by aileron, rudder, roll and yaw.
    Antisymmetric,
    /// Neither, as in a pair of modes with nearly equal frequency, or in a half model.
    Mixed,
}

impl Symmetry {
    /// Class from the measure: at least 0.9 symmetric, at most -0.9 antisymmetric.
    #[must_use]
    pub fn from_measure(measure: f64) -> Self {
        if measure >= 0.9 {
            Self::Symmetric
        } else if measure <= -0.9 {
            Self::Antisymmetric
        } else {
            Self::Mixed
        }
    }
}

impl std::fmt::Display for Symmetry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Symmetric => "symmetric",
            Self::Antisymmetric => "antisymmetric",
            Self::Mixed => "mixed",
        })
    }
}

/// Grids and their mirror images.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MirrorPairs {
    /// Index of the mirrored grid for each grid (itself on the plane), `None` where there is none.
    pub partner: Vec<Option<usize>>,
}

impl MirrorPairs {
    /// Pairs grids whose mirrored positions agree within `tolerance` metres in every coordinate.
    ///
    /// Of several grids at one place (joints, rigid elements), the one whose rank by number among them is the same
    /// is taken.
    #[must_use]
    pub fn find(grids: &[BasisGrid], tolerance: f64) -> Self {
        // Cells of twice the tolerance: a partner lies in the mirrored cell or one next to it.
        let cell = |v: f64| (v / (2.0 * tolerance)).round() as i64;
        let key = |[x, y, z]: [f64; 3]| [cell(x), cell(y), cell(z)];
        let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        for (i, grid) in grids.iter().enumerate() {
            cells.entry(key(grid.position)).or_default().push(i);
        }
        let near = |p: [f64; 3]| {
            let [kx, ky, kz] = key(p);
            let mut found: Vec<usize> = Vec::new();
            for n in 0..27 {
                let step = |k: i64, d: i64| k.saturating_add(d - 1);
                let neighbour = [step(kx, n % 3), step(ky, n / 3 % 3), step(kz, n / 9)];
                let candidates = cells.get(&neighbour).map_or(&[][..], Vec::as_slice);
                found.extend(candidates.iter().filter(|&&i| {
                    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance;
                    grids.get(i).is_some_and(|g| g.position.iter().zip(&p).all(close))
                }));
            }
            found.sort_by_key(|&i| grids.get(i).map(|g| g.id));
            found
        };
        let partner = grids
            .iter()
            .enumerate()
            .map(|(i, grid)| {
                let [x, y, z] = grid.position;
                if y.abs() <= tolerance {
                    return Some(i);
                }
                let rank = near(grid.position).iter().position(|&j| j == i)?;
                let mirrored = near([x, -y, z]);
                mirrored.get(rank).or(mirrored.last()).copied()
            })
            .collect();
        Self { partner }
    }

    /// Number of grids without a mirror image.
    #[must_use]
    pub fn unpaired(&self) -> usize {
        self.partner.iter().filter(|p| p.is_none()).count()
    }

    /// Whether some grid off the plane has an image.
    #[must_use]
    pub fn any_pair(&self) -> bool {
        self.partner
            .iter()
            .enumerate()
            .any(|(i, p)| p.is_some_and(|j| j != i))
    }
}

/// Energy of the symmetric part minus that of the antisymmetric part over their sum: 1 for a symmetric mode, -1 for
/// an antisymmetric one. With the mass matrix the kinetic energies of the translations are compared, otherwise the
/// plain squares. 0 when no grid has an image.
#[must_use]
pub fn symmetry_measure(shape: &[[f64; 6]], pairs: &MirrorPairs, mass: Option<&MassMatrix>) -> f64 {
    if !pairs.any_pair() {
        return 0.0;
    }
    let mirror = [1.0, -1.0, 1.0];
    let (mut symmetric, mut antisymmetric) = (0.0, 0.0);
    for (i, (motion, partner)) in shape.iter().zip(&pairs.partner).enumerate() {
        let Some(image) = partner.and_then(|j| shape.get(j)) else {
            continue;
        };
        let weight = mass.map_or(1.0, |m| m.translational_mass(i));
        for ((u, v), sign) in motion.iter().zip(image).zip(mirror) {
            symmetric += weight * (u + sign * v).powi(2);
            antisymmetric += weight * (u - sign * v).powi(2);
        }
    }
    let sum = symmetric + antisymmetric;
    if sum > 0.0 {
        (symmetric - antisymmetric) / sum
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use albatross_fem::rigid_shape;

    fn cross() -> Vec<BasisGrid> {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 2.0, 0.5],
            [1.0, -2.0, 0.5],
            [4.0, 0.0, 1.0],
            [1.0, -2.0, 0.5],
            [1.0, 2.0, 0.5],
        ];
        positions
            .iter()
            .enumerate()
            .map(|(i, &position)| BasisGrid {
                id: i as u32 + 1,
                position,
            })
            .collect()
    }

    #[test]
    fn coincident_grids_pair_by_rank_of_number() {
        let pairs = MirrorPairs::find(&cross(), 1e-6);
        assert_eq!(
            pairs.partner,
            [Some(0), Some(2), Some(1), Some(3), Some(5), Some(4)]
        );
    }

    /// Heave, surge and pitch are symmetric; sway, roll and yaw antisymmetric.
    #[test]
    fn val_rigid_motions_have_their_class() {
        let grids = cross();
        let pairs = MirrorPairs::find(&grids, 1e-6);
        let positions: Vec<_> = grids.iter().map(|g| g.position).collect();
        for (direction, expected) in [1.0, -1.0, 1.0, -1.0, 1.0, -1.0].into_iter().enumerate() {
            let shape = rigid_shape(direction, [0.0; 3], &positions);
            let measure = symmetry_measure(&shape, &pairs, None);
            assert!(
                (measure - expected).abs() < 1e-12,
                "direction {direction}: {measure}"
            );
        }
    }

    #[test]
    fn half_model_has_no_class() {
        let grids: Vec<_> = cross().into_iter().filter(|g| g.position[1] >= 0.0).collect();
        let pairs = MirrorPairs::find(&grids, 1e-6);
        assert!(!pairs.any_pair());
        assert_eq!(pairs.unpaired(), 2);
        assert_eq!(symmetry_measure(&vec![[1.0; 6]; grids.len()], &pairs, None), 0.0);
    }
}
