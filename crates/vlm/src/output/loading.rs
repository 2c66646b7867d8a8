//! Spanwise loading: shear and bending moment (`.vm`), strip loads (`.cnc`).

use albatross_avl::results::{ShearMoments, ShearStation, ShearSurface, StripLoad, StripLoads};

use super::Solution;
use crate::lattice::{LatticeSurface, V3};

impl Solution<'_> {
    /// Shear and bending moment of each surface by itself, from the tip inwards: the `.vm` file.
    ///
    /// AVL's trapezoidal rule between the strips' stations, with half the sum of two widths as their distance and no
    /// load at the tip; the last step, to the root, is half as long as the one before it. On mirror images the moment
    /// is negative.
    pub fn shear_moments(&self) -> ShearMoments {
        let lattice = self.solver.lattice();
        let r = &lattice.reference;
        let state = self.run_state("");
        let surfaces = lattice.surfaces.iter().enumerate();
        ShearMoments {
            title: state.title,
            mach: state.mach,
            alpha_deg: state.alpha_deg,
            c_lift: state.c_lift,
            beta_deg: state.beta_deg,
            s_ref: r.s_ref,
            b_ref: r.b_ref,
            surfaces: surfaces.map(|(k, s)| self.shear_surface(k, s)).collect(),
        }
    }

    fn shear_surface(&self, index: usize, surface: &LatticeSurface) -> ShearSurface {
        let lattice = self.solver.lattice();
        let r = &lattice.reference;
        let strips = &lattice.strips[surface.strips.clone()];
        // Bound vortices run from left to right, on an image from the tip.
        let (inner, outer) = if surface.is_image { (1, 0) } else { (0, 1) };
        let eta = |y: f64| 2.0 * y / r.b_ref;
        let root = strips.first().map_or(0.0, |s| eta(s.edges[inner].y));
        let tip = strips.last().map_or(0.0, |s| eta(s.edges[outer].y));
        let station = |eta: f64, shear: f64, moment: f64| ShearStation {
            eta,
            shear: shear / r.s_ref,
            moment: moment / (r.s_ref * r.b_ref),
        };
        let sign = if surface.is_image { -1.0 } else { 1.0 };
        let (mut shear, mut moment) = (0.0, 0.0);
        let mut stations = vec![station(tip, 0.0, 0.0)];
        let (mut load, mut width, mut distance) = (0.0, 0.0, 0.0);
        for k in surface.strips.clone().rev() {
            let strip = &lattice.strips[k];
            let (own, before) = (self.strip(k).c_cl, shear);
            distance = 0.5 * (width + strip.width);
            shear += 0.5 * (load + own) * distance;
            moment += 0.5 * (before + shear) * distance;
            stations.push(station(eta(strip.leading_edge.y), shear, sign * moment));
            (load, width) = (own, strip.width);
        }
        let before = shear;
        shear += load * 0.5 * distance;
        moment += 0.5 * (before + shear) * 0.5 * distance;
        stations.push(station(root, shear, sign * moment));
        stations.reverse();
        let ends = strips.iter().flat_map(|s| s.edges.map(|e| eta(e.y)));
        let (eta_min, eta_max) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        ShearSurface {
            index: index + 1,
            name: surface.name.clone(),
            eta_min,
            eta_max,
            stations,
        }
    }

    /// Loads of all strips: the `.cnc` file.
    pub fn strip_loads(&self) -> StripLoads {
        let lattice = self.solver.lattice();
        let one = |(k, strip): (usize, &crate::lattice::LatticeStrip)| {
            let row = self.strip(k);
            let first = lattice.vortices.get(strip.vortices.start);
            StripLoad {
                position: first
                    .map_or(V3::zeros(), |v| (v.ends[0] + v.ends[1]) * 0.5)
                    .into(),
                cnc: row.c_cl,
                cl: row.cl,
                chord: strip.chord,
                width: strip.width,
                area: strip.area(),
            }
        };
        StripLoads {
            strips: lattice.strips.iter().enumerate().map(one).collect(),
        }
    }
}
