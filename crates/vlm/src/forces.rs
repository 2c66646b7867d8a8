//! Forces on vortices, strips, surfaces and bodies, with derivatives by every variable.
//!
//! Kutta and Joukowski: F = rho Gamma V x l on the bound leg, with the velocity that wind, rotation and all other
//! vortices make at it. In units of `q` and V that is 2 Gamma V x l, an area.
//!
//! Equations: THEORY (49).

use crate::flow::{Flow, Solver, onset_velocity};
use crate::lattice::{LatticeStrip, V3, Vortex};
use crate::polar::drag_of_lift;
use crate::units::ONSETS;

/// Force over q, and moment over q about a point: an area and a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Load {
    pub(crate) force: V3,
    pub(crate) moment: V3,
}

impl Load {
    pub(crate) fn at(force: V3, arm: &V3) -> Self {
        Self {
            force,
            moment: arm.cross(&force),
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }

    /// The same load, its moment about a point that lies `arm` before the present one.
    pub(crate) fn moved(&self, arm: &V3) -> Self {
        Self {
            force: self.force,
            moment: self.moment + arm.cross(&self.force),
        }
    }
}

/// Load of a strip, its moment about the quarter chord of its station.
#[derive(Clone, Debug)]
pub(crate) struct StripLoad {
    pub(crate) load: Load,
    /// Profile drag coefficient.
    pub(crate) cdv: f64,
    /// Derivatives by the variables of [`Flow::changes`].
    pub(crate) changes: Vec<Load>,
}

/// Loads of the whole lattice.
#[derive(Clone, Debug)]
pub(crate) struct Loads {
    pub(crate) strips: Vec<StripLoad>,
    pub(crate) bodies: Vec<Load>,
    /// Sum without the header's profile drag, moment about the reference point, and its derivatives.
    pub(crate) total: Load,
    pub(crate) changes: Vec<Load>,
    /// Force on each bound leg.
    pub(crate) vortices: Vec<V3>,
    /// Profile drag of the strips' polars in the total.
    pub(crate) viscous: f64,
}

impl Solver<'_> {
    /// All loads of a flow.
    pub(crate) fn loads(&self, flow: &Flow) -> Loads {
        let lattice = self.lattice();
        let wind = flow.condition.onset(lattice);
        let n_variables = flow.changes.len();
        let mut vortices = vec![V3::zeros(); lattice.vortices.len()];
        let mut strips: Vec<StripLoad> = Vec::with_capacity(lattice.strips.len());
        for strip in &lattice.strips {
            let mut load = Load::default();
            let mut changes = vec![Load::default(); n_variables];
            let origin = strip.quarter_chord();
            for k in strip.vortices.clone() {
                let v = &lattice.vortices[k];
                vortices[k] = self.bound_force(flow, &wind, k, v, &origin, &mut load, &mut changes);
                if self.method().leg_forces {
                    self.leg_forces(flow, &wind, k, strip, &origin, &mut load, &mut changes);
                }
            }
            let cdv = self.add_profile_drag(flow, &wind, strip, &mut load, &mut changes);
            strips.push(StripLoad { load, cdv, changes });
        }
        self.sum(flow, &wind, strips, vortices)
    }

    #[allow(clippy::too_many_arguments)]
    fn bound_force(
        &self,
        flow: &Flow,
        wind: &[f64; 6],
        k: usize,
        vortex: &Vortex,
        origin: &V3,
        load: &mut Load,
        changes: &mut [Load],
    ) -> V3 {
        let lattice = self.lattice();
        let (onset, units) = onset_velocity(lattice, wind, &vortex.force_point);
        let mut velocity = onset + flow.induced[k];
        let mut body = [V3::zeros(); ONSETS];
        if self.method().body_velocity_in_forces {
            for b in &lattice.bodies {
                for (u, (to, w)) in body.iter_mut().zip(wind).enumerate() {
                    let v = b.velocity(lattice, self.mach(), u, &vortex.force_point);
                    *to += v;
                    velocity += v * *w;
                }
            }
        }
        let (arm, leg) = (vortex.force_point - origin, vortex.bound());
        let across = velocity.cross(&leg) * 2.0;
        let force = across * flow.circulation[k];
        load.add(&Load::at(force, &arm));
        for (m, (to, change)) in changes.iter_mut().zip(&flow.changes).enumerate() {
            let mut d = across * change.circulation[k];
            if m < ONSETS {
                let dv = units[m] + body[m] + change.induced[k];
                d += dv.cross(&leg) * (2.0 * flow.circulation[k]);
            } else if !self.method().frozen_velocity {
                d += change.induced[k].cross(&leg) * (2.0 * flow.circulation[k]);
            }
            to.add(&Load::at(d, &arm));
        }
        force
    }

    /// Forces on the trailing legs from the bound leg to the trailing edge, by wind and rotation.
    #[allow(clippy::too_many_arguments)]
    fn leg_forces(
        &self,
        flow: &Flow,
        wind: &[f64; 6],
        k: usize,
        strip: &LatticeStrip,
        origin: &V3,
        load: &mut Load,
        changes: &mut [Load],
    ) {
        let lattice = self.lattice();
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let end = lattice.vortices[k].ends[side];
            let length = strip.edges[side].x + strip.edge_chords[side] - end.x;
            let leg = V3::new(sign * length, 0.0, 0.0);
            let middle = end + V3::new(0.5 * length, 0.0, 0.0);
            let (velocity, units) = onset_velocity(lattice, wind, &middle);
            let arm = middle - origin;
            let across = velocity.cross(&leg) * 2.0;
            load.add(&Load::at(across * flow.circulation[k], &arm));
            for (m, (to, change)) in changes.iter_mut().zip(&flow.changes).enumerate() {
                let mut d = across * change.circulation[k];
                if let Some(unit) = units.get(m) {
                    d += unit.cross(&leg) * (2.0 * flow.circulation[k]);
                }
                to.add(&Load::at(d, &arm));
            }
        }
    }

    /// Adds the drag of a strip's polar at its lift, along the wind at its quarter chord.
    fn add_profile_drag(
        &self,
        flow: &Flow,
        wind: &[f64; 6],
        strip: &LatticeStrip,
        load: &mut Load,
        changes: &mut [Load],
    ) -> f64 {
        let Some(polar) = &strip.polar else {
            return 0.0;
        };
        let area = strip.area();
        let lift = self.lift_axis(flow, &strip.normal);
        let (cdv, slope) = drag_of_lift(polar, load.force.dot(&lift) / area);
        let (velocity, units) = onset_velocity(self.lattice(), wind, &strip.quarter_chord());
        let speed = velocity.norm();
        // The lift axis turns with the wind; its turn changes cl by the drag only and is left out.
        for (m, to) in changes.iter_mut().enumerate() {
            let d_cd = slope * to.force.dot(&lift) / area;
            let mut d = velocity * (speed * d_cd * area);
            if let Some(unit) = units.get(m) {
                d += (unit * speed + velocity * (velocity.dot(unit) / speed)) * (cdv * area);
            }
            to.force += d;
        }
        let force = velocity * (speed * cdv * area);
        load.force += force;
        force.dot(&flow.condition.wind()) / area
    }

    /// Unit vector of lift normal to the wind and to the spanwise direction of a sheet with this normal.
    pub(crate) fn lift_axis(&self, flow: &Flow, normal: &V3) -> V3 {
        let span = V3::new(0.0, normal.z, -normal.y);
        let lift = self.drag_axis(flow).cross(&span);
        let length = lift.norm();
        if length > 0.0 { lift / length } else { *normal }
    }

    /// Unit vector of a strip's drag.
    pub(crate) fn drag_axis(&self, flow: &Flow) -> V3 {
        if self.method().lift_axis_with_sideslip {
            flow.condition.wind()
        } else {
            let (s, c) = flow.condition.alpha_rad.sin_cos();
            V3::new(c, 0.0, s)
        }
    }

    fn sum(&self, flow: &Flow, wind: &[f64; 6], strips: Vec<StripLoad>, vortices: Vec<V3>) -> Loads {
        let lattice = self.lattice();
        let r = &lattice.reference;
        let reference = V3::new(r.x_ref, r.y_ref, r.z_ref);
        let mut total = Load::default();
        let mut changes = vec![Load::default(); flow.changes.len()];
        let mut viscous = 0.0;
        for (strip, own) in lattice.strips.iter().zip(&strips) {
            if lattice.surfaces[strip.surface].no_load {
                continue;
            }
            let arm = strip.quarter_chord() - reference;
            total.add(&own.load.moved(&arm));
            viscous += own.cdv * strip.area();
            for (to, from) in changes.iter_mut().zip(&own.changes) {
                to.add(&from.moved(&arm));
            }
        }
        let beta = (1.0 - self.mach() * self.mach()).sqrt();
        let mut bodies = Vec::new();
        for body in &lattice.bodies {
            let mut own = Load::default();
            for segment in body.segments() {
                let arm = segment.middle - reference;
                let (velocity, units) = onset_velocity(lattice, wind, &segment.middle);
                own.add(&Load::at(segment.force(beta, &velocity), &arm));
                for (to, unit) in changes.iter_mut().zip(&units) {
                    to.add(&Load::at(segment.force_change(beta, &velocity, unit), &arm));
                }
            }
            total.add(&own);
            bodies.push(own);
        }
        if lattice.i_ysym == 1 {
            double(&mut total);
            changes.iter_mut().for_each(double);
            viscous *= 2.0;
        }
        Loads {
            strips,
            bodies,
            total,
            changes,
            vortices,
            viscous,
        }
    }
}

/// Both halves of a flow with a plane of symmetry.
fn double(load: &mut Load) {
    load.force = V3::new(2.0 * load.force.x, 0.0, 2.0 * load.force.z);
    load.moment = V3::new(0.0, 2.0 * load.moment.y, 0.0);
}
