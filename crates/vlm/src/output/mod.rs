//! Results in the structs of AVL's output files.

mod loading;
mod strips;

use albatross_avl::results::{
    AxisOrientation, BodyColumn, BodyDerivatives, BodyForce, BodyForces, HingeMoment, HingeMoments,
    NamedColumn, NamedValue, RunState, StabilityColumn, StabilityDerivatives, SurfaceForce, SurfaceForces,
};

use crate::coefficients::{Coefficients, Stability, Table};
use crate::condition::Condition;
use crate::error::Result;
use crate::flow::{Flow, Solver};
use crate::forces::{Load, Loads};
use crate::lattice::{LatticeSurface, NormalChange, V3};
use crate::trefftz::{Trefftz, Wake};
use crate::units::ONSETS;

/// `Clb Cnr / Clr Cnb` is printed where the denominator is above this.
const SPIRAL_LIMIT: f64 = 1e-4;

/// Below this fraction of the area the normals of a surface cancel.
const CLOSED: f64 = 1e-9;

/// The flow at a flight condition with all its forces.
pub struct Solution<'s> {
    solver: &'s Solver<'s>,
    flow: Flow,
    loads: Loads,
    table: Table,
    wake: Wake<'s>,
    /// Totals in the Trefftz plane.
    pub trefftz: Trefftz,
}

impl<'l> Solver<'l> {
    /// Flow and forces at a flight condition.
    ///
    /// # Errors
    /// As [`Solver::flow`].
    pub fn solve(&self, condition: &Condition) -> Result<Solution<'_>> {
        let flow = self.flow(condition)?;
        let loads = self.loads(&flow);
        let table = Table::new(self, &flow, &loads);
        let wake = Wake::new(self.lattice(), self.plane(), &flow.circulation);
        let trefftz = wake.totals();
        Ok(Solution {
            solver: self,
            flow,
            loads,
            table,
            wake,
            trefftz,
        })
    }
}

impl Solution<'_> {
    /// The flight condition.
    pub fn condition(&self) -> &Condition {
        &self.flow.condition
    }

    /// Circulations and induced velocities.
    pub fn flow(&self) -> &Flow {
        &self.flow
    }

    pub(crate) fn table(&self) -> &Table {
        &self.table
    }

    /// Lift coefficient `CLtot`.
    pub fn c_lift(&self) -> f64 {
        self.table.stability().lift
    }

    /// Drag coefficient `CDtot`.
    pub fn c_drag(&self) -> f64 {
        self.table.stability().drag
    }

    /// Pitching moment coefficient `Cmtot`.
    pub fn c_m(&self) -> f64 {
        self.table.total().moment.y
    }

    /// Flight condition and totals: the `.ft` file.
    pub fn run_state(&self, run_case: &str) -> RunState {
        let lattice = self.solver.lattice();
        let c = &self.flow.condition;
        let (s, k) = c.alpha_rad.sin_cos();
        let (force, moment) = self.table.total().body();
        let stability = self.table.stability();
        let viscous = self.loads.viscous / lattice.reference.s_ref + lattice.cd_p;
        let named = |changes: &[NormalChange], values: &[f64]| {
            let pairs = changes.iter().zip(values);
            pairs
                .map(|(c, &value)| NamedValue {
                    name: c.name.clone(),
                    value,
                })
                .collect()
        };
        RunState {
            title: lattice.title.clone(),
            n_surfaces: lattice.surfaces.len(),
            n_strips: lattice.strips.len(),
            n_vortices: lattice.vortices.len(),
            reference: lattice.reference,
            axes: AxisOrientation::Standard,
            run_case: run_case.to_owned(),
            alpha_deg: c.alpha_rad.to_degrees(),
            beta_deg: c.beta_rad.to_degrees(),
            mach: self.solver.mach(),
            pb_2v: c.pb_2v,
            qc_2v: c.qc_2v,
            rb_2v: c.rb_2v,
            pb_2v_stability: c.pb_2v * k + c.rb_2v * s,
            rb_2v_stability: c.rb_2v * k - c.pb_2v * s,
            c_x: force.x,
            c_y: force.y,
            c_z: force.z,
            c_roll: moment.x,
            c_m: moment.y,
            c_n: moment.z,
            c_roll_stability: stability.moment.x,
            c_n_stability: stability.moment.z,
            c_lift: stability.lift,
            c_drag: stability.drag,
            c_drag_viscous: viscous,
            c_drag_induced: stability.drag - viscous,
            c_lift_trefftz: self.trefftz.c_lift,
            c_drag_trefftz: self.trefftz.c_drag,
            c_y_trefftz: self.trefftz.c_y,
            span_efficiency: self.trefftz.span_efficiency,
            controls: named(&lattice.controls, &c.controls),
            designs: named(&lattice.designs, &c.designs),
        }
    }

    /// Derivatives in stability axes, with the rates in stability axes held: the `.st` file. What
    /// [`Method::printed_derivatives`](crate::Method::printed_derivatives) says holds here.
    pub fn stability_derivatives(&self, run_case: &str) -> StabilityDerivatives {
        let lattice = self.solver.lattice();
        let table = &self.table;
        let printed = self.solver.method().printed_derivatives;
        let alpha = table.stability_alpha(printed);
        let mut beta = table.resolved(&table.beta());
        if !printed {
            beta.side += table.profile_side_force_beta();
        }
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis| table.stability_rate(axis));
        let named = |changes: &[NormalChange], first: usize| {
            let columns = changes.iter().enumerate();
            columns
                .map(|(k, change)| NamedColumn {
                    name: change.name.clone(),
                    column: self.setting_column(first + k),
                })
                .collect()
        };
        let r = &lattice.reference;
        let neutral = r.x_ref - r.c_ref * alpha.moment.y / alpha.lift;
        let bottom = yaw.moment.x * beta.moment.z;
        StabilityDerivatives {
            run: self.run_state(run_case),
            alpha: column(&alpha),
            beta: column(&beta),
            roll_rate: column(&roll),
            pitch_rate: column(&pitch),
            yaw_rate: column(&yaw),
            controls: named(&lattice.controls, 0),
            designs: named(&lattice.designs, lattice.controls.len()),
            neutral_point_x: (alpha.lift != 0.0).then_some(neutral),
            spiral_ratio: (bottom.abs() > SPIRAL_LIMIT).then(|| beta.moment.x * yaw.moment.z / bottom),
        }
    }

    fn setting_column(&self, k: usize) -> StabilityColumn {
        let resolved = self.table.resolved(&self.table.setting(k));
        let lattice = self.solver.lattice();
        let far = self.flow.changes.get(ONSETS + k).map(|change| {
            let wake = Wake::new(lattice, self.solver.plane(), &change.circulation);
            wake.derivatives(&self.wake, &self.trefftz)
        });
        StabilityColumn {
            trefftz_drag: far.map(|f| f.c_drag),
            span_efficiency: far.map(|f| f.span_efficiency),
            ..column(&resolved)
        }
    }

    /// Derivatives in body axes: the `.sb` file.
    pub fn body_derivatives(&self, run_case: &str) -> BodyDerivatives {
        let lattice = self.solver.lattice();
        let [u, v, w] = [0, 1, 2].map(|axis| body_column(&self.table.body_wind(axis)));
        let [p, q, r] = [0, 1, 2].map(|axis| body_column(&self.table.body_rate(axis)));
        let named = |changes: &[NormalChange], first: usize| {
            let columns = changes.iter().enumerate();
            columns
                .map(|(k, change)| NamedColumn {
                    name: change.name.clone(),
                    column: body_column(&self.table.setting(first + k)),
                })
                .collect()
        };
        BodyDerivatives {
            run: self.run_state(run_case),
            u,
            v,
            w,
            p,
            q,
            r,
            controls: named(&lattice.controls, 0),
            designs: named(&lattice.designs, lattice.controls.len()),
        }
    }

    /// Sum of the loads of a surface's strips, about the reference point, and profile drag over q.
    fn surface_load(&self, surface: &LatticeSurface) -> (Load, f64) {
        let lattice = self.solver.lattice();
        let r = &lattice.reference;
        let reference = V3::new(r.x_ref, r.y_ref, r.z_ref);
        let mut sum = Load::default();
        let mut viscous = 0.0;
        for k in surface.strips.clone() {
            let (strip, own) = (&lattice.strips[k], &self.loads.strips[k]);
            sum.add(&own.load.moved(&(strip.quarter_chord() - reference)));
            viscous += own.cdv * strip.area();
        }
        (sum, viscous)
    }

    /// Lift coefficient of a surface's own area, normal to its mean spanwise direction. A closed ring has none: its
    /// normals cancel, and the lift is that of the aircraft.
    fn local_lift(&self, surface: &LatticeSurface, load: &Load) -> f64 {
        let strips = &self.solver.lattice().strips[surface.strips.clone()];
        let mean: V3 = strips.iter().map(|s| s.normal * s.area()).sum();
        let length = mean.norm();
        let normal = if length > CLOSED * surface.area {
            mean / length
        } else {
            V3::z()
        };
        load.force.dot(&self.solver.lift_axis(&self.flow, &normal)) / surface.area
    }

    /// Drag coefficient of a surface's own area, along the strips' drag axis.
    fn local_drag(&self, surface: &LatticeSurface, load: &Load) -> f64 {
        load.force.dot(&self.solver.drag_axis(&self.flow)) / surface.area
    }

    /// Forces of each surface: the `.fn` file.
    pub fn surface_forces(&self) -> SurfaceForces {
        let lattice = self.solver.lattice();
        let s_ref = lattice.reference.s_ref;
        let alpha = self.flow.condition.alpha_rad;
        let one = |(k, surface): (usize, &LatticeSurface)| {
            let (load, viscous) = self.surface_load(surface);
            let c = Coefficients::of(&load, lattice);
            let (stability, (_, moment)) = (c.stability(alpha), c.body());
            let cdv_local = viscous / surface.area;
            let viscous = viscous / s_ref;
            SurfaceForce {
                index: k + 1,
                name: surface.name.clone(),
                area: surface.area,
                c_lift: stability.lift,
                c_drag: stability.drag,
                c_m: moment.y,
                c_y: stability.side,
                c_n: moment.z,
                c_roll: moment.x,
                c_drag_induced: stability.drag - viscous,
                c_drag_viscous: viscous,
                average_chord: surface.average_chord,
                cl_local: self.local_lift(surface, &load),
                cd_local: self.local_drag(surface, &load),
                cdv_local,
                cm_le_local: None,
            }
        };
        SurfaceForces {
            axes: AxisOrientation::Standard,
            reference: lattice.reference,
            surfaces: lattice.surfaces.iter().enumerate().map(one).collect(),
        }
    }

    /// Forces of each body: the `.fb` file.
    pub fn body_forces(&self) -> BodyForces {
        let lattice = self.solver.lattice();
        let alpha = self.flow.condition.alpha_rad;
        let bodies = lattice.bodies.iter().zip(&self.loads.bodies).enumerate();
        let one = |(k, (body, load)): (usize, (&crate::body::LatticeBody, &Load))| {
            let c = Coefficients::of(load, lattice);
            let (stability, (_, moment)) = (c.stability(alpha), c.body());
            let [length, area, volume] = body.sizes();
            BodyForce {
                index: k + 1,
                name: body.name.clone(),
                length,
                area,
                volume,
                c_lift: stability.lift,
                c_drag: stability.drag,
                c_m: moment.y,
                c_y: stability.side,
                c_n: moment.z,
                c_roll: moment.x,
            }
        };
        BodyForces {
            axes: AxisOrientation::Standard,
            reference: lattice.reference,
            bodies: bodies.map(one).collect(),
        }
    }

    /// Hinge moments: the `.hm` file. `q_pa`, where known, gives moments in N m of a geometry in metres.
    ///
    /// A control's moment is that of its panels' forces about the hinge lines, weighted by what moves of each panel
    /// and by its gain: the work of the air on a unit deflection.
    pub fn hinge_moments(&self, q_pa: Option<f64>) -> HingeMoments {
        let lattice = self.solver.lattice();
        let r = &lattice.reference;
        let volume = r.s_ref * r.c_ref;
        let one = |(control, deflection): (&NormalChange, &f64)| {
            let panels = control.panels.iter();
            let work = |p: &crate::lattice::PanelChange| {
                let arm = lattice.vortices[p.vortex].force_point - p.hinge_point;
                arm.cross(&self.loads.vortices[p.vortex]).dot(&p.hinge_axis) * p.fraction
            };
            let c_hinge = panels.map(work).sum::<f64>() / volume;
            HingeMoment {
                name: control.name.clone(),
                c_hinge,
                deflection_deg: Some(*deflection),
                moment_n_m: q_pa.map(|q| q * volume * c_hinge),
            }
        };
        HingeMoments {
            axes: None,
            s_ref: r.s_ref,
            c_ref: r.c_ref,
            controls: lattice
                .controls
                .iter()
                .zip(&self.flow.condition.controls)
                .map(one)
                .collect(),
        }
    }
}

fn column(s: &Stability) -> StabilityColumn {
    StabilityColumn {
        lift: s.lift,
        side_force: s.side,
        drag: Some(s.drag),
        roll: s.moment.x,
        pitch: s.moment.y,
        yaw: s.moment.z,
        trefftz_drag: None,
        span_efficiency: None,
    }
}

fn body_column(c: &Coefficients) -> BodyColumn {
    let (f, m) = c.body();
    BodyColumn {
        x: f.x,
        y: f.y,
        z: f.z,
        roll: m.x,
        pitch: m.y,
        yaw: m.z,
    }
}
