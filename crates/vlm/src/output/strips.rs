//! Forces of strips (`.fs`) and of vortices (`.fe`).

use albatross_avl::results::{
    AxisOrientation, Element, ElementForces, ElementStrip, ElementSurface, Strip, StripForces, StripSurface,
    SurfaceCoefficients,
};

use super::Solution;
use crate::coefficients::Coefficients;
use crate::flow::onset_velocity;
use crate::lattice::{LatticeStrip, LatticeSurface, V3};

/// Line along which a strip is swept for `cl_norm`, between its first and last bound vortex.
const SWEEP_LINE: f64 = 0.25;

/// Range of the centre of pressure that AVL prints.
const CENTRE_OF_PRESSURE: std::ops::Range<f64> = -1.0..2.0;

impl Solution<'_> {
    /// Forces of each strip: the `.fs` file.
    pub fn strip_forces(&self) -> StripForces {
        let lattice = self.solver.lattice();
        let one = |(k, surface): (usize, &LatticeSurface)| StripSurface {
            index: k + 1,
            name: surface.name.clone(),
            n_chord: surface.n_chord,
            n_span: surface.strips.len(),
            first_strip: surface.strips.start + 1,
            area: surface.area,
            average_chord: surface.average_chord,
            coefficients: self.surface_coefficients(surface),
            strips: surface.strips.clone().map(|k| self.strip(k)).collect(),
        };
        StripForces {
            axes: AxisOrientation::Standard,
            reference: Some(lattice.reference),
            surfaces: lattice.surfaces.iter().enumerate().map(one).collect(),
        }
    }

    fn surface_coefficients(&self, surface: &LatticeSurface) -> SurfaceCoefficients {
        let lattice = self.solver.lattice();
        let s_ref = lattice.reference.s_ref;
        let (load, viscous) = self.surface_load(surface);
        let c = Coefficients::of(&load, lattice);
        let (s, (_, m)) = (c.stability(self.flow.condition.alpha_rad), c.body());
        let viscous = viscous / s_ref;
        SurfaceCoefficients {
            c_lift: s.lift,
            c_roll: m.x,
            c_y: s.side,
            c_m: m.y,
            c_drag: s.drag,
            c_n: m.z,
            c_drag_induced: s.drag - viscous,
            c_drag_viscous: viscous,
            cl_local: self.local_lift(surface, &load),
            cd_local: self.local_drag(surface, &load),
        }
    }

    /// One strip, as the `.fs` file has it.
    pub(super) fn strip(&self, k: usize) -> Strip {
        let lattice = self.solver.lattice();
        let (strip, own) = (&lattice.strips[k], &self.loads.strips[k]);
        let (area, chord) = (strip.area(), strip.chord);
        let force = own.load.force / area;
        let moment = own.load.moment / (area * chord);
        let cl = force.dot(&self.solver.lift_axis(&self.flow, &strip.normal));
        let cm_c4 = strip.normal.z * moment.y - strip.normal.y * moment.z;
        let xcp = 0.25 - cm_c4 / cl;
        Strip {
            index: k + 1,
            x_le: Some(strip.leading_edge.x),
            y_le: strip.leading_edge.y,
            z_le: Some(strip.leading_edge.z),
            chord,
            area,
            c_cl: chord * strip.normal.dot(&force),
            ai: self.wake.downwash[k],
            cl_norm: cl / self.normal_speed_squared(strip),
            cl,
            cd: force.dot(&self.solver.drag_axis(&self.flow)),
            cdv: own.cdv,
            cm_c4,
            cm_le: Some(self.leading_edge_moment(strip, k)),
            xcp: (cl != 0.0 && CENTRE_OF_PRESSURE.contains(&xcp)).then_some(xcp),
        }
    }

    /// Square of the speed normal to the strip's swept line over V squared.
    fn normal_speed_squared(&self, strip: &LatticeStrip) -> f64 {
        let lattice = self.solver.lattice();
        let bound = &lattice.vortices[strip.vortices.clone()];
        let (Some(first), Some(last)) = (bound.first(), bound.last()) else {
            return 1.0;
        };
        let line = first.bound() * (1.0 - SWEEP_LINE) + last.bound() * SWEEP_LINE;
        let axis = line.normalize();
        let wind = self.flow.condition.onset(lattice);
        let (velocity, _) = onset_velocity(lattice, &wind, &strip.quarter_chord());
        (velocity - axis * velocity.dot(&axis)).norm_squared()
    }

    /// Moment coefficient about the middle of the leading edge, along the swept leading edge. On mirror images AVL
    /// takes the edge in the other direction, so the sign changes.
    fn leading_edge_moment(&self, strip: &LatticeStrip, k: usize) -> f64 {
        let middle = (strip.edges[0] + strip.edges[1]) * 0.5;
        let load = self.loads.strips[k].load.moved(&(strip.quarter_chord() - middle));
        let edge: V3 = strip.edges[1] - strip.edges[0];
        let sign = if self.solver.lattice().surfaces[strip.surface].is_image {
            -1.0
        } else {
            1.0
        };
        sign * load.moment.dot(&edge.normalize()) / (strip.area() * strip.chord)
    }

    /// Loads of each vortex: the `.fe` file.
    pub fn element_forces(&self) -> ElementForces {
        let lattice = self.solver.lattice();
        let one = |(k, surface): (usize, &LatticeSurface)| ElementSurface {
            index: k + 1,
            name: surface.name.clone(),
            n_chord: surface.n_chord,
            n_span: surface.strips.len(),
            first_strip: surface.strips.start + 1,
            area: surface.area,
            average_chord: surface.average_chord,
            coefficients: self.surface_coefficients(surface),
            strips: surface.strips.clone().map(|k| self.element_strip(k)).collect(),
        };
        ElementForces {
            axes: AxisOrientation::Standard,
            reference: Some(lattice.reference),
            surfaces: lattice.surfaces.iter().enumerate().map(one).collect(),
        }
    }

    fn element_strip(&self, k: usize) -> ElementStrip {
        let lattice = self.solver.lattice();
        let strip = &lattice.strips[k];
        let row = self.strip(k);
        let force = self.loads.strips[k].load.force / strip.area();
        let (s, c) = strip.incidence_rad.sin_cos();
        let lift_normal = strip.normal.dot(&force);
        let element = |k: usize| {
            let v = &lattice.vortices[k];
            Element {
                index: k + 1,
                position: ((v.ends[0] + v.ends[1]) * 0.5).into(),
                dx: v.dx,
                slope: v.slope,
                delta_cp: v.normal.dot(&self.loads.vortices[k]) / (v.dx * strip.width),
            }
        };
        ElementStrip {
            index: k + 1,
            first_vortex: strip.vortices.start + 1,
            leading_edge: strip.leading_edge.into(),
            chord: strip.chord,
            width: strip.width,
            area: strip.area(),
            incidence_deg: strip.incidence_rad.to_degrees(),
            dihedral_deg: (-strip.normal.y).atan2(strip.normal.z).to_degrees(),
            cl: row.cl,
            cd: row.cd,
            cdv: row.cdv,
            cn: lift_normal * c + force.x * s,
            ca: force.x * c - lift_normal * s,
            cnc: row.c_cl,
            wake_downwash: row.ai,
            cm_le: row.cm_le.unwrap_or(0.0),
            cm_c4: row.cm_c4,
            elements: strip.vortices.clone().map(element).collect(),
        }
    }
}
