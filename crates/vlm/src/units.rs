//! Unit solutions: circulations, and velocities at the bound vortices, for each onset flow and control.
//!
//! The flow is bilinear in the onset (velocity and rotation) on one side and one plus the controls on the other, so
//! circulations and velocities at any flight condition are sums of a few solutions that are found once.

use albatross_numerics::Mat;
use albatross_numerics::faer::linalg::matmul::matmul;
use albatross_numerics::faer::{Accum, Par};

use crate::influence::{Factorised, joined, sums_to_zero};
use crate::kernel::Velocities;
use crate::lattice::{Lattice, V3};
use crate::symmetry::Part;

/// Onset flows: unit velocity along x, y, z and unit rotation about x, y, z.
pub(crate) const ONSETS: usize = 6;

/// Right-hand sides below this fraction of the largest are rounding.
const NOISE: f64 = 1e-13;

/// Force points in one block of products.
const BLOCK: usize = 16;

/// Circulations and induced velocities of one unit solution.
#[derive(Clone, Debug)]
pub(crate) struct Unit {
    pub(crate) circulation: Vec<f64>,
    pub(crate) velocity: Vec<V3>,
}

/// Onset velocity at a point by unit onset `u`: relative wind of a rotation `w` is r x w.
pub(crate) fn onset(lattice: &Lattice, u: usize, point: &V3) -> V3 {
    let reference = &lattice.reference;
    let r = point - V3::new(reference.x_ref, reference.y_ref, reference.z_ref);
    match u {
        0 => V3::x(),
        1 => V3::y(),
        2 => V3::z(),
        3 => r.cross(&V3::x()),
        4 => r.cross(&V3::y()),
        _ => r.cross(&V3::z()),
    }
}

impl Factorised<'_> {
    /// Unit solutions in the order [onset][none, controls, design variables].
    pub(crate) fn unit_solutions(&self) -> Vec<Vec<Unit>> {
        let rhs = self.right_hand_sides();
        let flat: Vec<Vec<f64>> = rhs.into_iter().flatten().collect();
        let mut units = self.solve_columns(&flat).into_iter();
        let width = 1 + self.lattice.controls.len() + self.lattice.designs.len();
        (0..ONSETS)
            .map(|_| units.by_ref().take(width).collect())
            .collect()
    }

    /// Velocity that passes the control points in each unit onset.
    pub(crate) fn onset_at_control(&self, u: usize, vortex: usize) -> V3 {
        let lattice = self.lattice;
        let v = &lattice.vortices[vortex];
        let mut velocity = V3::zeros();
        if !lattice.surface_of(v).no_albe {
            velocity += onset(lattice, u, &v.control_point);
        }
        for body in &lattice.bodies {
            velocity += body.velocity(lattice, self.mach, u, &v.control_point);
        }
        velocity
    }

    fn right_hand_sides(&self) -> Vec<Vec<Vec<f64>>> {
        let lattice = self.lattice;
        let n = lattice.vortices.len();
        let changes: Vec<_> = lattice.controls.iter().chain(&lattice.designs).collect();
        (0..ONSETS)
            .map(|u| {
                let mut columns = vec![vec![0.0; n]; 1 + changes.len()];
                let passing: Vec<V3> = (0..n).map(|k| self.onset_at_control(u, k)).collect();
                for (k, velocity) in passing.iter().enumerate() {
                    if !sums_to_zero(lattice, k) {
                        columns[0][k] = -lattice.vortices[k].normal.dot(velocity);
                    }
                }
                for (column, change) in columns[1..].iter_mut().zip(&changes) {
                    for panel in &change.panels {
                        if !sums_to_zero(lattice, panel.vortex) {
                            column[panel.vortex] -= panel.normal.dot(&passing[panel.vortex]);
                        }
                    }
                }
                columns
            })
            .collect()
    }

    /// Circulations, and velocities at the force points, for right-hand sides over all vortices.
    pub(crate) fn solve_columns(&self, rhs: &[Vec<f64>]) -> Vec<Unit> {
        let n = self.lattice.vortices.len();
        let mut units: Vec<Unit> = rhs
            .iter()
            .map(|_| Unit {
                circulation: vec![0.0; n],
                velocity: vec![V3::zeros(); n],
            })
            .collect();
        // Columns that do not vanish in each part, and their solutions.
        let mut parts = Vec::new();
        for factors in &self.systems {
            let unknowns = &factors.unknowns;
            let order = unknowns.members.len();
            let mut projected = vec![0.0; order];
            let mut active = Vec::new();
            let mut columns: Vec<Vec<f64>> = Vec::new();
            for (index, b) in rhs.iter().enumerate() {
                unknowns.project(b, &mut projected);
                let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let size = largest(b);
                if size > 0.0 && largest(&projected) > NOISE * size {
                    active.push(index);
                    columns.push(projected.clone());
                }
            }
            let mut solution = Mat::from_fn(order, columns.len(), |i, j| columns[j][i]);
            factors.solve(solution.as_mut());
            for (j, &index) in active.iter().enumerate() {
                let column = (0..order).map(|i| solution[(i, j)]);
                unknowns.spread(column, &mut units[index].circulation);
            }
            parts.push((active, solution));
        }
        self.add_velocities(&parts, &mut units);
        units
    }

    /// Velocities at the force points by the solutions of each part; the influence there is never stored whole.
    fn add_velocities(&self, parts: &[(Vec<usize>, Mat<f64>)], units: &mut [Unit]) {
        // Force points of the right half and the middle: what either part has.
        let mut targets: Vec<(usize, Option<usize>)> = Vec::new();
        for factors in &self.systems {
            for &(own, image) in &factors.unknowns.members {
                targets.push((own, image.map(|i| i.0)));
            }
        }
        targets.sort_unstable();
        targets.dedup();
        let chunk = targets.len().div_ceil(self.method.threads).max(1);
        let results: Vec<(usize, usize, Part, V3, Option<usize>)> = std::thread::scope(|scope| {
            let mut jobs = targets.chunks(chunk);
            let own = jobs.next().unwrap_or(&[]);
            let handles: Vec<_> = jobs
                .map(|job| scope.spawn(move || self.velocities(parts, job)))
                .collect();
            let mut out = self.velocities(parts, own);
            for handle in handles {
                out.extend(joined(handle));
            }
            out
        });
        for (index, own, part, v, image) in results {
            units[index].velocity[own] += v;
            if let Some(image) = image {
                units[index].velocity[image] += V3::new(v.x, -v.y, v.z) * part.sign();
            }
        }
    }

    fn velocities(
        &self,
        parts: &[(Vec<usize>, Mat<f64>)],
        targets: &[(usize, Option<usize>)],
    ) -> Vec<(usize, usize, Part, V3, Option<usize>)> {
        let n = self.horseshoes.len();
        let (mut row, mut scratch) = (Velocities::new(n), Velocities::new(n));
        let mut folded: Vec<Mat<f64>> = parts
            .iter()
            .map(|(_, s)| Mat::zeros(s.nrows(), 3 * BLOCK))
            .collect();
        let mut products: Vec<Mat<f64>> = parts
            .iter()
            .map(|(_, s)| Mat::zeros(3 * BLOCK, s.ncols()))
            .collect();
        let mut out = Vec::new();
        for block in targets.chunks(BLOCK) {
            for (t, &(own, _)) in block.iter().enumerate() {
                let component = self.components[own];
                let point = self.lattice.vortices[own].force_point;
                self.horseshoes.at(&point, component, &mut row, &mut scratch);
                let itself = self.horseshoes.bound_leg(own, &point, component);
                row.u[own] -= itself.x;
                row.v[own] -= itself.y;
                row.w[own] -= itself.z;
                for (factors, to) in self.systems.iter().zip(&mut folded) {
                    for (axis, values) in [&row.u, &row.v, &row.w].into_iter().enumerate() {
                        if let Some(column) = to.as_mut().col_mut(3 * t + axis).try_as_col_major_mut() {
                            factors.unknowns.fold(values, column.as_slice_mut());
                        }
                    }
                }
            }
            for (((factors, (active, solution)), from), product) in
                self.systems.iter().zip(parts).zip(&folded).zip(&mut products)
            {
                let rows = from.as_ref().transpose();
                matmul(
                    product.as_mut(),
                    Accum::Replace,
                    rows,
                    solution.as_ref(),
                    1.0,
                    Par::Seq,
                );
                for (j, &index) in active.iter().enumerate() {
                    for (t, &(own, image)) in block.iter().enumerate() {
                        let v = V3::from_fn(|axis, _| product[(3 * t + axis, j)]);
                        out.push((index, own, factors.unknowns.part, v, image));
                    }
                }
            }
        }
        out
    }
}
