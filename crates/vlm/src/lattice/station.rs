//! What a strip inherits from the two sections beside it.

use albatross_avl::geometry::{Control, DragPolar, Section};

use super::V3;
use crate::airfoil::CamberSlope;

/// A section with scale, translation and incidence of its surface applied.
pub(super) struct Rib<'g> {
    pub(super) section: &'g Section,
    pub(super) leading_edge: V3,
    pub(super) chord: f64,
    pub(super) incidence_rad: f64,
    pub(super) camber: CamberSlope,
    pub(super) polar: Option<DragPolar>,
}

/// The strip between two ribs at a fraction of their distance.
pub(super) struct Bay<'r, 'g> {
    pub(super) left: &'r Rib<'g>,
    pub(super) right: &'r Rib<'g>,
}

/// A control on a strip: hinge in x/c, gain, hinge line.
pub(super) struct Flap<'g> {
    pub(super) control: &'g Control,
    pub(super) gain: f64,
    pub(super) x_hinge: f64,
    pub(super) hinge_point: V3,
    pub(super) hinge_axis: V3,
}

/// (1 - f) a + f b.
fn between(f: f64, a: f64, b: f64) -> f64 {
    (1.0 - f) * a + f * b
}

impl<'r, 'g> Bay<'r, 'g> {
    pub(super) fn leading_edge(&self, f: f64) -> V3 {
        self.left.leading_edge * (1.0 - f) + self.right.leading_edge * f
    }

    pub(super) fn chord(&self, f: f64) -> f64 {
        between(f, self.left.chord, self.right.chord)
    }

    /// Chord-weighted mean: what is linear along the surface is chord times the quantity.
    fn weighted(&self, f: f64, left: f64, right: f64) -> f64 {
        between(f, self.left.chord * left, self.right.chord * right) / self.chord(f)
    }

    /// The chord vectors of the ribs, not their angles, are interpolated.
    pub(super) fn incidence(&self, f: f64) -> f64 {
        let ([sl, cl], [sr, cr]) = (self.left.sin_cos(), self.right.sin_cos());
        self.weighted(f, sl, sr).atan2(self.weighted(f, cl, cr))
    }

    /// d incidence / d design variable, in rad per degree of weight.
    pub(super) fn incidence_of_design(&self, f: f64, name: &str) -> f64 {
        let weight = |rib: &Rib<'_>| {
            let designs = rib.section.designs.iter().filter(|d| d.name == name);
            designs.map(|d| d.weight).sum::<f64>().to_radians()
        };
        let (wl, wr) = (weight(self.left), weight(self.right));
        if wl == 0.0 && wr == 0.0 {
            return 0.0;
        }
        let ([sl, cl], [sr, cr]) = (self.left.sin_cos(), self.right.sin_cos());
        let (s, c) = (self.weighted(f, sl, sr), self.weighted(f, cl, cr));
        let (ds, dc) = (
            self.weighted(f, wl * cl, wr * cr),
            self.weighted(f, -wl * sl, -wr * sr),
        );
        (c * ds - s * dc) / (s * s + c * c)
    }

    pub(super) fn claf(&self, f: f64) -> f64 {
        self.weighted(f, self.left.section.claf, self.right.section.claf)
    }

    pub(super) fn slope(&self, f: f64, x: f64) -> f64 {
        self.weighted(f, self.left.camber.at(x), self.right.camber.at(x))
    }

    /// Drag polar, where both ribs have one.
    pub(super) fn polar(&self, f: f64) -> Option<DragPolar> {
        let (left, right) = (self.left.polar?, self.right.polar?);
        let mix = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| self.weighted(f, a[k], b[k]));
        Some(DragPolar {
            cl: mix(left.cl, right.cl),
            cd: mix(left.cd, right.cd),
        })
    }

    /// Controls that both ribs declare.
    pub(super) fn flaps(&self, f: f64) -> Vec<Flap<'g>> {
        let mut out = Vec::new();
        for left in &self.left.section.controls {
            let Some(right) = self.right.section.controls.iter().find(|c| c.name == left.name) else {
                continue;
            };
            let hinge = |rib: &Rib<'_>, c: &Control| {
                rib.leading_edge + V3::new(rib.chord * c.x_hinge.abs(), 0.0, 0.0)
            };
            let (from, to) = (hinge(self.left, left), hinge(self.right, right));
            let given = V3::from(left.hinge_axis);
            let axis = if given.norm() > 0.0 { given } else { to - from };
            out.push(Flap {
                control: left,
                gain: between(f, left.gain, right.gain),
                x_hinge: self.weighted(f, left.x_hinge, right.x_hinge),
                hinge_point: from * (1.0 - f) + to * f,
                hinge_axis: axis.normalize(),
            });
        }
        out
    }
}

impl Rib<'_> {
    fn sin_cos(&self) -> [f64; 2] {
        let (s, c) = self.incidence_rad.sin_cos();
        [s, c]
    }
}

/// Part of an element from `front` to `rear` (x/c) that a control with this hinge moves.
pub(super) fn moved_fraction(x_hinge: f64, front: f64, rear: f64) -> f64 {
    let (from, to) = if x_hinge >= 0.0 {
        (x_hinge, 1.0)
    } else {
        (0.0, -x_hinge)
    };
    let within = |x: f64| ((x - front) / (rear - front)).clamp(0.0, 1.0);
    within(to) - within(from)
}
