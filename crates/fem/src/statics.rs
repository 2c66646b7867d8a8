//! Static solution under nodal loads and uniform acceleration.

use albatross_nastran::deck::Id;
use albatross_numerics::Mat;
use nalgebra::Vector3;

use crate::dofs::Freedoms;
use crate::error::Error;
use crate::factor::Analysis;
use crate::model::{Fate, FemModel};
use crate::rigid::rotation_blocks;

/// A force and a moment at a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodalLoad {
    /// The grid; of a scalar point the first component acts.
    pub point: Id,
    /// Fx, Fy, Fz in N and Mx, My, Mz in N m, basic axes.
    pub load: [f64; 6],
}

/// Displacements and reactions.
#[derive(Debug, Clone)]
pub struct StaticSolution {
    /// Displacements of all freedoms in CD systems (order of [`FemModel::freedoms`]): m, rad.
    pub displacements: Vec<f64>,
    /// Forces of the supports on the structure at held freedoms, zero at others: N, N m in CD systems.
    pub reactions: Vec<f64>,
    /// Strain energy, J.
    pub strain_energy: f64,
    freedoms: Freedoms,
}

impl StaticSolution {
    /// T1 to R3 of a grid in its CD system.
    #[must_use]
    pub fn at(&self, id: Id) -> Option<[f64; 6]> {
        values_at(&self.freedoms, &self.displacements, id)
    }

    /// Reaction at a grid in its CD system.
    #[must_use]
    pub fn reaction_at(&self, id: Id) -> Option<[f64; 6]> {
        values_at(&self.freedoms, &self.reactions, id)
    }
}

fn values_at(freedoms: &Freedoms, values: &[f64], id: Id) -> Option<[f64; 6]> {
    let point = freedoms.point(id)?;
    let width = if point.is_scalar { 1 } else { 6 };
    let at = |i: usize| values.get(point.first + i).copied().unwrap_or(0.0);
    Some(std::array::from_fn(|i| if i < width { at(i) } else { 0.0 }))
}

impl FemModel {
    /// Solves K u = p for nodal loads, with the mass accelerated by `acceleration` (m/s^2, basic axes; the loads of
    /// gravity have `[0, 0, -9.81]` when z is up).
    ///
    /// # Errors
    /// [`Error::NoSuchFreedom`] for a load on a point that is not in the model; [`Error::Mechanism`] when the supports
    /// leave a motion free, with a freedom that it moves.
    pub fn static_solution(
        &self,
        loads: &[NodalLoad],
        acceleration: [f64; 3],
    ) -> Result<StaticSolution, Error> {
        let p = self.load_vector(loads, acceleration)?;
        let analysis = Analysis::new(&self.stiffness, &self.nodes())?;
        let factor = analysis.factorise(&self.stiffness)?;
        let mut mechanisms = factor.singular.clone();
        if mechanisms.is_empty() {
            mechanisms.extend(factor.null_motion(&self.stiffness));
        }
        if !mechanisms.is_empty() {
            let free = &self.constraints.free;
            let name = |&k: &usize| free.get(k).map(|&g| self.freedoms.name(g));
            return Err(Error::Mechanism {
                freedoms: mechanisms.iter().filter_map(name).collect(),
                with_mass: true,
            });
        }
        let right = self.constraints.reduce(&p);
        let mut u = Mat::from_fn(right.len(), 1, |i, _| right[i]);
        factor.solve_in_place(&mut u);
        // One step of refinement gains the digits that the condition takes.
        let free: Vec<f64> = u.col(0).iter().copied().collect();
        let product = self.stiffness.product(&free);
        let mut correction = Mat::from_fn(right.len(), 1, |i, _| right[i] - product[i]);
        factor.solve_in_place(&mut correction);
        u += &correction;
        let free: Vec<f64> = u.col(0).iter().copied().collect();
        let displacements = self.constraints.expand(&free);
        let internal = self.internal_forces(&displacements);
        let energy: f64 = internal.iter().zip(&displacements).map(|(f, u)| f * u).sum();
        let mut reactions: Vec<f64> = internal.iter().zip(&p).map(|(f, p)| f - p).collect();
        self.carry_to_independent(&mut reactions);
        for (r, fate) in reactions.iter_mut().zip(&self.constraints.fates) {
            if *fate != Fate::Held {
                *r = 0.0;
            }
        }
        Ok(StaticSolution {
            displacements,
            reactions,
            strain_energy: 0.5 * energy,
            freedoms: self.freedoms.clone(),
        })
    }

    /// Loads on all freedoms in CD systems.
    fn load_vector(&self, loads: &[NodalLoad], acceleration: [f64; 3]) -> Result<Vec<f64>, Error> {
        let mut p = vec![0.0; self.freedoms.count()];
        for load in loads {
            let point = self
                .freedoms
                .point(load.point)
                .ok_or_else(|| Error::NoSuchFreedom {
                    what: format!("point {}, which a load names,", load.point),
                    cure: "load a GRID or SPOINT of the deck",
                })?;
            match self.frames.grid(point.id) {
                Some(grid) if !point.is_scalar => {
                    let local = rotation_blocks(&grid.axes).transpose() * nalgebra::Vector6::from(load.load);
                    for i in 0..6 {
                        p[point.first + i] += local[i];
                    }
                }
                _ => p[point.first] += load.load[0],
            }
        }
        if acceleration != [0.0; 3] {
            let rigid = self.rigid_motions(Vector3::zeros());
            let field: Vec<f64> = rigid
                .iter()
                .map(|r| (0..3).map(|k| r[k] * acceleration[k]).sum())
                .collect();
            for (p, f) in p.iter_mut().zip(self.full_mass.product(&field)) {
                *p += f;
            }
        }
        Ok(p)
    }
}
