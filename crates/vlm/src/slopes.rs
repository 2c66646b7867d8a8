//! Lift slopes between strips: what a strip's own incidence does to the lift of every strip.
//!
//! A strip correction scales or turns the local incidence of strips; the change of all lifts follows from
//! `d gamma = -A^-1 (d n_k . V)`, the boundary conditions of strip k turned by a unit angle.
//!
//! Equations: THEORY (51).

use albatross_numerics::Mat;

use crate::condition::Condition;
use crate::error::{Error, Result};
use crate::flow::{Flow, Solver, onset_velocity};
use crate::influence::sums_to_zero;
use crate::lattice::V3;
use crate::units::ONSETS;

impl Solver<'_> {
    /// d (chord times normal force coefficient) / d (local incidence): one row for each strip of the lattice, one
    /// column for each of `strips` (indices from 0), a length per rad at unit dynamic pressure of the flow.
    ///
    /// The normal force is that of the `.fs` file's `c_cl`: normal to the strip in the y-z plane, over `q` and the
    /// strip's width. The incidence turns nose up about the strip's own span; wakes and bound vortices stay. The
    /// derivative is exact at the flight condition: it holds the change of circulation and that of the velocity at
    /// the bound vortices.
    ///
    /// # Errors
    /// [`Error::Value`] for a strip that is not there, [`Error::Length`] for more indices than there are strips; else as
    /// [`Solver::flow`].
    pub fn strip_slopes(&self, condition: &Condition, strips: &[usize]) -> Result<Mat<f64>> {
        // Every index costs a solution, repeated ones too.
        let n_strips = self.lattice().strips.len();
        if strips.len() > n_strips {
            return Err(Error::Length {
                what: "indices of strips, each once",
                found: strips.len(),
                expected: n_strips,
            });
        }
        let flow = self.flow(condition)?;
        let rhs: Vec<Vec<f64>> = strips
            .iter()
            .map(|&strip| self.incidence_rhs(&flow, strip))
            .collect::<Result<_>>()?;
        let lattice = self.lattice();
        let wind = condition.onset(lattice);
        let columns = self.factorised().solve_columns(&rhs);
        let mut slopes = Mat::zeros(lattice.strips.len(), strips.len());
        for (row, strip) in lattice.strips.iter().enumerate() {
            for k in strip.vortices.clone() {
                let vortex = &lattice.vortices[k];
                let leg = vortex.bound();
                let (onset, _) = onset_velocity(lattice, &wind, &vortex.force_point);
                let across = strip.normal.dot(&(onset + flow.induced[k]).cross(&leg)) * 2.0 / strip.width;
                // n . (dV x l) = dV . (l x n)
                let turned = leg.cross(&strip.normal) * (2.0 * flow.circulation[k] / strip.width);
                for (column, change) in columns.iter().enumerate() {
                    slopes[(row, column)] += across * change.circulation[k] + turned.dot(&change.velocity[k]);
                }
            }
        }
        Ok(slopes)
    }

    /// Right-hand side for a unit turn of a strip's normals.
    fn incidence_rhs(&self, flow: &Flow, strip: usize) -> Result<Vec<f64>> {
        let lattice = self.lattice();
        let Some(own) = lattice.strips.get(strip) else {
            return Err(Error::Value {
                what: format!(
                    "strip index {strip} (from 0), with {} strips in the lattice,",
                    lattice.strips.len()
                ),
                value: strip as f64,
                expected: "name a strip of the lattice",
            });
        };
        let wind = flow.condition.onset(lattice);
        let mut rhs = vec![0.0; lattice.vortices.len()];
        for k in own.vortices.clone() {
            if !sums_to_zero(lattice, k) {
                let passing: V3 = (0..ONSETS)
                    .map(|u| self.factorised().onset_at_control(u, k) * wind[u])
                    .sum();
                rhs[k] = -lattice.vortices[k].normal_incidence.dot(&passing);
            }
        }
        Ok(rhs)
    }
}
