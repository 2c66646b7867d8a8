//! Lift, side force and induced drag from the wake far downstream (Trefftz plane).
//!
//! Each strip leaves a vortex pair of its whole circulation; the downwash is found at the strip's station
//! (Katz and Plotkin, sec. 8.4): `CD = -sum Gamma_j (n_j . V_j) width_j / Sref`.
//!
//! Equations: THEORY (50).

use std::f64::consts::PI;

use crate::lattice::{Lattice, V3};

/// Totals in the Trefftz plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trefftz {
    /// `CLff`.
    pub c_lift: f64,
    /// `CYff`.
    pub c_y: f64,
    /// `CDff`.
    pub c_drag: f64,
    /// Span efficiency `(CL^2 + CY^2)/(pi A CD)`; zero without drag.
    pub span_efficiency: f64,
}

/// Downwash at each strip by the unit circulation of each: square, row after row.
#[derive(Clone, Debug)]
pub(crate) struct Plane {
    rows: Vec<f64>,
}

impl Plane {
    /// `core(strip, emitting strip)` is the square of the core radius.
    pub(crate) fn new(lattice: &Lattice, core: impl Fn(usize, usize) -> f64) -> Self {
        let (sy, sz) = (f64::from(lattice.i_ysym), f64::from(lattice.i_zsym));
        let mut rows = Vec::with_capacity(lattice.strips.len() * lattice.strips.len());
        for (i, strip) in lattice.strips.iter().enumerate() {
            let p = strip.leading_edge;
            let z_image = 2.0 * lattice.z_sym - p.z;
            let places = [
                (1.0, p.y, p.z, 1.0, 1.0),
                (sy, -p.y, p.z, -1.0, 1.0),
                (sz, p.y, z_image, 1.0, -1.0),
                (sy * sz, -p.y, z_image, -1.0, -1.0),
            ];
            for (j, other) in lattice.strips.iter().enumerate() {
                let mut sum = 0.0;
                for (sign, y, z, turn_y, turn_z) in places {
                    if sign != 0.0 {
                        let [v, w] = pair_velocity(y, z, &other.edges, core(i, j));
                        sum += sign * (strip.normal.y * turn_y * v + strip.normal.z * turn_z * w);
                    }
                }
                rows.push(-sum / (2.0 * PI));
            }
        }
        Self { rows }
    }
}

/// The strips' wakes.
pub(crate) struct Wake<'l> {
    lattice: &'l Lattice,
    circulation: Vec<f64>,
    /// Downwash `-n . V` at each strip.
    pub(crate) downwash: Vec<f64>,
}

impl<'l> Wake<'l> {
    /// The wake of circulations over all vortices.
    pub(crate) fn new(lattice: &'l Lattice, plane: &Plane, vortices: &[f64]) -> Self {
        let strip_sum = |s: &crate::lattice::LatticeStrip| vortices[s.vortices.clone()].iter().sum();
        let circulation: Vec<f64> = lattice.strips.iter().map(strip_sum).collect();
        let n = circulation.len().max(1);
        let product = |row: &[f64]| row.iter().zip(&circulation).map(|(a, g)| a * g).sum();
        let downwash = plane.rows.chunks(n).map(product).collect();
        Self {
            lattice,
            circulation,
            downwash,
        }
    }

    /// Totals of this wake's circulation in another's downwash (its own, or a derivative's).
    fn sums(&self, downwash: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for ((strip, gamma), w) in self.lattice.strips.iter().zip(&self.circulation).zip(downwash) {
            if self.lattice.surfaces[strip.surface].no_load {
                continue;
            }
            let along = strip.edges[1] - strip.edges[0];
            sums[0] += 2.0 * gamma * along.y;
            sums[1] -= 2.0 * gamma * along.z;
            sums[2] += gamma * w * along.y.hypot(along.z);
        }
        let s_ref = self.lattice.reference.s_ref;
        let [lift, side, drag] = sums.map(|s| s / s_ref);
        if self.lattice.i_ysym == 1 {
            [2.0 * lift, 0.0, 2.0 * drag]
        } else {
            [lift, side, drag]
        }
    }

    /// Totals.
    pub(crate) fn totals(&self) -> Trefftz {
        let [c_lift, c_y, c_drag] = self.sums(&self.downwash);
        let r = &self.lattice.reference;
        let aspect = r.b_ref * r.b_ref / r.s_ref;
        let span_efficiency = if c_drag == 0.0 {
            0.0
        } else {
            (c_lift * c_lift + c_y * c_y) / (PI * aspect * c_drag)
        };
        Trefftz {
            c_lift,
            c_y,
            c_drag,
            span_efficiency,
        }
    }

    /// Derivatives of the totals by a variable whose derivative of the circulations is this wake.
    pub(crate) fn derivatives(&self, base: &Self, totals: &Trefftz) -> Trefftz {
        let [c_lift, c_y, own] = self.sums(&base.downwash);
        let c_drag = own + base.sums(&self.downwash)[2];
        let r = &self.lattice.reference;
        let aspect = r.b_ref * r.b_ref / r.s_ref;
        let span_efficiency = if totals.c_drag == 0.0 {
            0.0
        } else {
            let top = 2.0 * (totals.c_lift * c_lift + totals.c_y * c_y);
            top / (PI * aspect * totals.c_drag) - totals.span_efficiency * c_drag / totals.c_drag
        };
        Trefftz {
            c_lift,
            c_y,
            c_drag,
            span_efficiency,
        }
    }
}

/// 2 pi (v, w) at a point of the plane by a pair of unit vortices along +x, incoming at the first edge.
fn pair_velocity(y: f64, z: f64, edges: &[V3; 2], core: f64) -> [f64; 2] {
    let one = |edge: &V3| {
        let (dy, dz) = (y - edge.y, z - edge.z);
        let r = dy * dy + dz * dz;
        let smooth = (r * r + core * core).sqrt();
        [dz / smooth, -dy / smooth]
    };
    let (a, b) = (one(&edges[0]), one(&edges[1]));
    [a[0] - b[0], a[1] - b[1]]
}
