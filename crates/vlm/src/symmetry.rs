//! Left-right symmetry of a lattice.
//!
//! Where every vortex has a mirror image in the plane y = 0 with the mirrored normal, the influence matrix
//! commutes with the reflection. Circulations that the reflection keeps and those that it reverses are then solved
//! for separately: two systems of half the order, a quarter of the work.

use std::collections::HashMap;

use crate::lattice::{Lattice, V3};

/// A vortex of the right half, or of the middle, and its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    /// Vortex whose boundary condition is kept.
    pub(crate) own: usize,
    /// Its image; itself in the middle.
    pub(crate) image: usize,
    /// Circulation of the image in symmetric flow, for unit circulation of its own.
    pub(crate) sign: f64,
}

/// How the vortices are paired.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pairing {
    /// Two vortices each.
    pub(crate) pairs: Vec<Pair>,
    /// Vortices that are their own image: zero in antisymmetric flow (+1) or in symmetric flow (-1).
    pub(crate) middle: Vec<(usize, f64)>,
}

/// Which part of the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// No symmetry: everything.
    Whole,
    /// What the reflection keeps.
    Symmetric,
    /// What the reflection reverses.
    Antisymmetric,
}

impl Part {
    /// Factor of the image's sign.
    pub(crate) fn sign(self) -> f64 {
        if self == Self::Antisymmetric { -1.0 } else { 1.0 }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Symmetric => "symmetric",
            Self::Antisymmetric => "antisymmetric",
        }
    }
}

/// The unknowns of one part: representative vortices, and each one's image with the sign of its circulation.
#[derive(Clone, Debug)]
pub(crate) struct Unknowns {
    pub(crate) part: Part,
    /// Vortex, image and the image's circulation for unit circulation of its own; no image in the middle.
    pub(crate) members: Vec<(usize, Option<(usize, f64)>)>,
}

impl Unknowns {
    /// All vortices.
    pub(crate) fn whole(n: usize) -> Self {
        Self {
            part: Part::Whole,
            members: (0..n).map(|k| (k, None)).collect(),
        }
    }

    /// Sum over own vortices and images of a row over all vortices.
    pub(crate) fn fold(&self, row: &[f64], out: &mut [f64]) {
        for (to, &(own, image)) in out.iter_mut().zip(&self.members) {
            *to = row[own] + image.map_or(0.0, |(k, sign)| sign * row[k]);
        }
    }

    /// Part of a right-hand side (one value for each vortex) that belongs to these unknowns.
    pub(crate) fn project(&self, rhs: &[f64], out: &mut [f64]) {
        for (to, &(own, image)) in out.iter_mut().zip(&self.members) {
            *to = match image {
                Some((k, sign)) => 0.5 * (rhs[own] + sign * rhs[k]),
                None => rhs[own],
            };
        }
    }

    /// Adds the circulations of these unknowns to those of all vortices.
    pub(crate) fn spread(&self, solution: impl Iterator<Item = f64>, out: &mut [f64]) {
        for (value, &(own, image)) in solution.zip(&self.members) {
            out[own] += value;
            if let Some((k, sign)) = image {
                out[k] += sign * value;
            }
        }
    }
}

impl Pairing {
    /// Looks for symmetry; `None` where a vortex has no image.
    pub(crate) fn find(lattice: &Lattice, components: &[usize]) -> Option<Self> {
        if lattice.i_ysym != 0 {
            return None;
        }
        let size = lattice.reference.b_ref.abs().max(f64::MIN_POSITIVE);
        let tolerance = 1e-9 * size;
        let key = |p: &V3| p.map(|v| (v / (1e3 * tolerance)).round() as i64);
        let mut at: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (k, v) in lattice.vortices.iter().enumerate() {
            at.entry(key(&v.control_point).into()).or_default().push(k);
        }
        let near = |p: &V3| {
            // A point may round to the next cell.
            let centre = key(p);
            let mut found = Vec::new();
            for dx in -1..=1 {
                for dy in -1..=1 {
                    for dz in -1..=1 {
                        let cell = [
                            centre.x.saturating_add(dx),
                            centre.y.saturating_add(dy),
                            centre.z.saturating_add(dz),
                        ];
                        found.extend(at.get(&cell).into_iter().flatten().copied());
                    }
                }
            }
            found
        };
        let image_of = |k: usize| {
            let v = &lattice.vortices[k];
            let close = |p: &V3, q: &V3| (mirrored(p) - q).amax() <= tolerance;
            near(&mirrored(&v.control_point)).into_iter().find_map(|m| {
                let other = &lattice.vortices[m];
                let sign = if close(&v.ends[0], &other.ends[1]) && close(&v.ends[1], &other.ends[0]) {
                    1.0
                } else if close(&v.ends[0], &other.ends[0]) && close(&v.ends[1], &other.ends[1]) {
                    -1.0
                } else {
                    return None;
                };
                let turned = (mirrored(&v.normal) - other.normal * sign).amax() <= 1e-9;
                // Widths are equal, so the cores are equal where the chords are.
                let (s, t) = (&lattice.strips[v.strip], &lattice.strips[other.strip]);
                let (a, b) = (lattice.surface_of(v), lattice.surface_of(other));
                let flags = (a.no_wake, a.no_albe) == (b.no_wake, b.no_albe);
                (turned
                    && flags
                    && close(&v.control_point, &other.control_point)
                    && close(&v.force_point, &other.force_point)
                    && (s.chord - t.chord).abs() <= tolerance)
                    .then_some((m, sign))
            })
        };
        let (mut pairs, mut middle) = (Vec::new(), Vec::new());
        let mut taken = vec![false; lattice.vortices.len()];
        // Components must map onto components, one to one.
        let mut partner: HashMap<usize, usize> = HashMap::new();
        for own in 0..taken.len() {
            if taken[own] {
                continue;
            }
            let (image, sign) = image_of(own)?;
            if taken[image] {
                return None;
            }
            for (a, b) in [
                (components[own], components[image]),
                (components[image], components[own]),
            ] {
                if *partner.entry(a).or_insert(b) != b {
                    return None;
                }
            }
            (taken[own], taken[image]) = (true, true);
            if image == own {
                middle.push((own, sign));
            } else {
                pairs.push(Pair { own, image, sign });
            }
        }
        Some(Self { pairs, middle })
    }

    /// Unknowns of the symmetric and of the antisymmetric part.
    pub(crate) fn unknowns(&self) -> [Unknowns; 2] {
        [Part::Symmetric, Part::Antisymmetric].map(|part| Unknowns {
            part,
            members: self
                .pairs
                .iter()
                .map(|p| (p.own, Some((p.image, p.sign * part.sign()))))
                .chain(
                    self.middle
                        .iter()
                        .filter(|(_, sign)| *sign == part.sign())
                        .map(|&(k, _)| (k, None)),
                )
                .collect(),
        })
    }
}

/// Mirrored in the plane y = 0.
fn mirrored(p: &V3) -> V3 {
    V3::new(p.x, -p.y, p.z)
}
