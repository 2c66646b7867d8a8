//! Rigid elements and multipoint constraints: dependent freedoms as sums of independent ones.
//!
//! | card | relation |
//! |---|---|
//! | RBE2 | dependents follow the rigid motion of the independent grid |
//! | RBAR | rigid motion from six independent components spread over two grids |
//! | RBE3 | the reference grid has the weighted mean motion, `(S^T W S)^-1 S^T W u`, S the rigid motions of the grids |
//! | MPC | the first term, of the set that case control selects |
//!
//! Equations: THEORY (42), (43).

use albatross_nastran::deck::{Components, Id, Mpc, Rbar, Rbe2, Rbe3};
use albatross_nastran::frames::ResolvedGrid;
use nalgebra::{DMatrix, Matrix6, RowVector6, Vector3};
use std::collections::BTreeMap;

use crate::context::Context;
use crate::dofs::Freedoms;
use crate::error::Error;
use crate::rigid::{rigid_transfer, rotation_blocks};
use crate::supports::selected_sets;

/// `u_dependent = sum(coefficient u_j)`.
#[derive(Debug, Clone)]
pub(crate) struct Relation {
    pub(crate) dependent: usize,
    pub(crate) terms: Vec<(usize, f64)>,
    /// The card, for messages.
    name: &'static str,
    id: Id,
}

/// Freedoms with their coefficients.
type Terms = Vec<(usize, f64)>;

struct Collector<'a> {
    context: &'a Context<'a>,
    freedoms: &'a Freedoms,
    relations: Vec<Relation>,
}

/// All relations of a deck, in terms of independent freedoms only.
pub(crate) fn relations(
    context: &Context<'_>,
    freedoms: &Freedoms,
    subcase: Option<u32>,
) -> Result<Vec<Relation>, Error> {
    let mut all = Collector {
        context,
        freedoms,
        relations: Vec::new(),
    };
    for element in context.deck.rbe2.values() {
        all.rbe2(element)?;
    }
    for element in context.deck.rbars.values() {
        all.rbar(element)?;
    }
    for element in context.deck.rbe3.values() {
        all.rbe3(element)?;
    }
    let sets = selected_sets(context.deck, "MPC", subcase);
    for mpc in context.deck.mpcs.iter().filter(|m| sets.contains(&m.sid)) {
        all.mpc(mpc)?;
    }
    resolved(context, freedoms, all.relations)
}

impl Collector<'_> {
    /// First freedom of a grid and its place.
    fn grid(&self, name: &'static str, id: Id, grid: Id) -> Result<(usize, &ResolvedGrid), Error> {
        let point = self.freedoms.point(grid).filter(|p| !p.is_scalar);
        let point = point.ok_or_else(|| self.context.missing(name, id, format!("GRID {grid}")))?;
        Ok((point.first, self.context.grid(name, id, grid)?))
    }

    fn push(&mut self, name: &'static str, id: Id, dependent: usize, terms: Vec<(usize, f64)>) {
        let terms = terms.into_iter().filter(|t| t.1 != 0.0).collect();
        self.relations.push(Relation {
            dependent,
            terms,
            name,
            id,
        });
    }

    fn rbe2(&mut self, element: &Rbe2) -> Result<(), Error> {
        let (name, id) = ("RBE2", element.id);
        let (master, from) = self.grid(name, id, element.independent)?;
        let (origin, axes) = (from.position, from.axes);
        for &dependent in &element.dependents {
            let (slave, to) = self.grid(name, id, dependent)?;
            let motion = cd_motion(to, origin) * rotation_blocks(&axes);
            for c in element.components.iter() {
                let row = usize::from(c) - 1;
                let terms = (0..6).map(|j| (master + j, motion[(row, j)])).collect();
                self.push(name, id, slave + row, terms);
            }
        }
        Ok(())
    }

    fn rbar(&mut self, element: &Rbar) -> Result<(), Error> {
        let (name, id) = ("RBAR", element.id);
        let bad = |problem: &str| self.context.bad_constraint(name, id, problem);
        let mut motions = Vec::new();
        let origin = self.grid(name, id, element.grids[0])?.1.position;
        for &g in &element.grids {
            let (first, grid) = self.grid(name, id, g)?;
            motions.push((first, cd_motion(grid, origin)));
        }
        let independent: Vec<(usize, RowVector6<f64>)> = rows(&motions, element.independent);
        if independent.len() != 6 {
            return Err(bad("CNA and CNB must name six components in all"));
        }
        let given = Matrix6::from_fn(|i, j| independent[i].1[j]);
        let inverse = given
            .try_inverse()
            .filter(|m| (m * given - Matrix6::identity()).amax() < 1e-6)
            .ok_or_else(|| {
                bad("the independent components CNA and CNB do not determine a rigid motion; choose others")
            })?;
        let everything_else = element.dependent == [Components::NONE; 2];
        let dependent = if everything_else {
            let taken: Vec<usize> = independent.iter().map(|r| r.0).collect();
            let mut all = rows(&motions, [Components::ALL; 2]);
            all.retain(|r| !taken.contains(&r.0));
            all
        } else {
            rows(&motions, element.dependent)
        };
        for (freedom, row) in dependent {
            let coefficients = row * inverse;
            let terms = independent
                .iter()
                .zip(coefficients.iter())
                .map(|(r, &c)| (r.0, c))
                .collect();
            self.push(name, id, freedom, terms);
        }
        Ok(())
    }

    fn rbe3(&mut self, element: &Rbe3) -> Result<(), Error> {
        let (name, id) = ("RBE3", element.id);
        let (reference, to) = self.grid(name, id, element.reference)?;
        let (origin, axes) = (to.position, to.axes);
        // Rotations count with the square of the mean distance, so that weights do not depend on the unit of length.
        let grids = element.groups.iter().flat_map(|g| &g.grids);
        let mut distances = Vec::new();
        for &g in grids {
            distances.push((self.grid(name, id, g)?.1.position - origin).norm());
        }
        let mean = distances.iter().sum::<f64>() / distances.len().max(1) as f64;
        let rotation_weight = if mean > 0.0 { mean * mean } else { 1.0 };

        let mut normal = Matrix6::zeros();
        let mut weighted: Vec<(usize, RowVector6<f64>)> = Vec::new();
        for group in &element.groups {
            for &g in &group.grids {
                let (first, grid) = self.grid(name, id, g)?;
                let motion = cd_motion(grid, origin);
                for c in group.components.iter() {
                    let row = motion.row(usize::from(c) - 1).into_owned();
                    let weight = group.weight * if c > 3 { rotation_weight } else { 1.0 };
                    normal += row.transpose() * row * weight;
                    weighted.push((first + usize::from(c) - 1, row * weight));
                }
            }
        }
        let bad = |problem: &str| self.context.bad_constraint(name, id, problem);
        let inverse = scaled_inverse(&normal, mean).ok_or_else(|| {
            bad("the averaged components do not determine the motion of the reference grid; add grids off one line, or \
                 rotations")
        })?;
        // Motion of the reference grid in its CD system.
        let to_reference = rotation_blocks(&axes).transpose() * inverse;
        let mut equations = Vec::new();
        for c in element.components.iter() {
            let row = to_reference.row(usize::from(c) - 1);
            let mut terms: BTreeMap<usize, f64> = BTreeMap::new();
            for (freedom, w) in &weighted {
                *terms.entry(*freedom).or_insert(0.0) += row.dot(w);
            }
            equations.push((reference + usize::from(c) - 1, terms));
        }
        if element.um.is_empty() {
            for (dependent, terms) in equations {
                self.push(name, id, dependent, terms.into_iter().collect());
            }
            return Ok(());
        }
        let mut um = Vec::new();
        for &(g, components) in &element.um {
            let (first, _) = self.grid(name, id, g)?;
            um.extend(components.iter().map(|c| first + usize::from(c) - 1));
        }
        let solved = exchanged(equations, &um).ok_or_else(|| {
            bad("the components of UM must be as many as those of REFC, and determined by them")
        })?;
        for (dependent, terms) in solved {
            self.push(name, id, dependent, terms);
        }
        Ok(())
    }

    fn mpc(&mut self, mpc: &Mpc) -> Result<(), Error> {
        let bad = |problem: String| self.context.bad_constraint("MPC", mpc.sid, problem);
        let mut terms = Vec::new();
        for term in &mpc.terms {
            let freedom = self.freedoms.index(term.point, term.component).ok_or_else(|| {
                bad(format!(
                    "component {} of point {} does not exist; correct the term",
                    term.component, term.point
                ))
            })?;
            terms.push((freedom, term.coefficient));
        }
        let Some((&(dependent, lead), others)) = terms.split_first() else {
            return Ok(());
        };
        if lead == 0.0 || !terms.iter().all(|t| t.1.is_finite()) {
            return Err(bad(
                "its first coefficient is zero, or one is not finite; the first term is the dependent one"
                    .into(),
            ));
        }
        let terms = others.iter().map(|&(j, c)| (j, -c / lead)).collect();
        self.push("MPC", mpc.sid, dependent, terms);
        Ok(())
    }
}

/// Motion of a grid in its CD system for a rigid motion about `origin` in basic axes.
fn cd_motion(grid: &ResolvedGrid, origin: Vector3<f64>) -> Matrix6<f64> {
    rotation_blocks(&grid.axes).transpose() * rigid_transfer(grid.position - origin)
}

fn rows(motions: &[(usize, Matrix6<f64>)], components: [Components; 2]) -> Vec<(usize, RowVector6<f64>)> {
    let mut rows = Vec::new();
    for ((first, motion), components) in motions.iter().zip(components) {
        for c in components.iter() {
            let i = usize::from(c) - 1;
            rows.push((first + i, motion.row(i).into_owned()));
        }
    }
    rows
}

/// Inverse of the normal matrix of an RBE3, with rotations scaled by a length; `None` if it is singular.
fn scaled_inverse(normal: &Matrix6<f64>, length: f64) -> Option<Matrix6<f64>> {
    let l = if length > 0.0 { length } else { 1.0 };
    let s = Matrix6::from_diagonal(&[1.0, 1.0, 1.0, 1.0 / l, 1.0 / l, 1.0 / l].into());
    let scaled = s * normal * s;
    let eigen = scaled.symmetric_eigen();
    let (low, high) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
    if low.is_nan() || low <= 1e-10 * high {
        return None;
    }
    let inverse = Matrix6::from_diagonal(&eigen.eigenvalues.map(|v| 1.0 / v));
    Some(s * (eigen.eigenvectors * inverse * eigen.eigenvectors.transpose()) * s)
}

/// Equations `u_i = sum(c u_j)` solved for the freedoms of UM in place of the u_i.
fn exchanged(equations: Vec<(usize, BTreeMap<usize, f64>)>, um: &[usize]) -> Option<Vec<(usize, Terms)>> {
    if equations.len() != um.len() {
        return None;
    }
    let n = um.len();
    // 0 = -u_i + sum(c u_j): coefficients of UM to the left, the others to the right.
    let mut left = DMatrix::zeros(n, n);
    let mut right: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (i, (reference, terms)) in equations.into_iter().enumerate() {
        for (freedom, c) in terms.into_iter().chain([(reference, -1.0)]) {
            match um.iter().position(|&u| u == freedom) {
                Some(k) => left[(i, k)] += c,
                None => right.entry(freedom).or_insert_with(|| vec![0.0; n])[i] += c,
            }
        }
    }
    let inverse: DMatrix<f64> = left.clone().try_inverse()?;
    let error = (&inverse * &left - DMatrix::identity(n, n)).amax();
    if error.is_nan() || error >= 1e-6 {
        return None;
    }
    let columns: Vec<(usize, nalgebra::DVector<f64>)> = right
        .into_iter()
        .map(|(freedom, c)| (freedom, &inverse * nalgebra::DVector::from_vec(c) * -1.0))
        .collect();
    let solved = um.iter().enumerate();
    Some(
        solved
            .map(|(k, &u)| (u, columns.iter().map(|(freedom, c)| (*freedom, c[k])).collect()))
            .collect(),
    )
}

/// Replaces dependent freedoms on right sides by their own relations, in the order of dependence.
fn resolved(
    context: &Context<'_>,
    freedoms: &Freedoms,
    relations: Vec<Relation>,
) -> Result<Vec<Relation>, Error> {
    let mut by_dependent: BTreeMap<usize, usize> = BTreeMap::new();
    for (i, r) in relations.iter().enumerate() {
        if let Some(other) = by_dependent.insert(r.dependent, i).and_then(|k| relations.get(k)) {
            return Err(context.bad_constraint(
                r.name,
                r.id,
                format!(
                    "{} is dependent here and in {} {}; make it dependent once",
                    freedoms.name(r.dependent),
                    other.name,
                    other.id
                ),
            ));
        }
    }
    let waits: Vec<Vec<usize>> = relations
        .iter()
        .map(|r| {
            r.terms
                .iter()
                .filter_map(|t| by_dependent.get(&t.0).copied())
                .collect()
        })
        .collect();
    let mut waiters: Vec<Vec<usize>> = vec![Vec::new(); relations.len()];
    for (i, needed) in waits.iter().enumerate() {
        for &k in needed {
            waiters[k].push(i);
        }
    }
    let mut open: Vec<usize> = waits.iter().map(Vec::len).collect();
    let mut ready: Vec<usize> = (0..relations.len()).filter(|&i| open[i] == 0).collect();
    let mut done: Vec<Option<Relation>> = vec![None; relations.len()];
    while let Some(i) = ready.pop() {
        let mut terms: BTreeMap<usize, f64> = BTreeMap::new();
        for &(freedom, c) in &relations[i].terms {
            match by_dependent.get(&freedom).and_then(|&k| done[k].as_ref()) {
                Some(inner) => {
                    for &(j, d) in &inner.terms {
                        *terms.entry(j).or_insert(0.0) += c * d;
                    }
                }
                None => *terms.entry(freedom).or_insert(0.0) += c,
            }
        }
        done[i] = Some(Relation {
            terms: terms.into_iter().collect(),
            ..relations[i].clone()
        });
        for &k in &waiters[i] {
            open[k] -= 1;
            if open[k] == 0 {
                ready.push(k);
            }
        }
    }
    if let Some(r) = relations
        .iter()
        .zip(&done)
        .find(|(_, d)| d.is_none())
        .map(|(r, _)| r)
    {
        return Err(context.bad_constraint(
            r.name,
            r.id,
            format!(
                "{} depends on itself through other rigid elements; exchange independent and dependent grids of one \
                 of them",
                freedoms.name(r.dependent)
            ),
        ));
    }
    Ok(done.into_iter().flatten().collect())
}
