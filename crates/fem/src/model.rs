//! The finite element model of a deck: K and M on free freedoms.

use albatross_nastran::Deck;
use albatross_nastran::GridPointWeight;
use albatross_nastran::deck::{Id, ScalarMassValue};
use albatross_nastran::frames::Frames;
use albatross_numerics::ShortNumber;
use nalgebra::{Matrix6, Vector3};
use std::collections::BTreeSet;

use crate::context::Context;
use crate::dofs::Freedoms;
use crate::error::Error;
use crate::mass::{BarMass, DeckMass};
use crate::mass_model::MassModel;
use crate::mass_properties::MassProperties;
use crate::multipoint;
use crate::rigid::rotation_blocks;
use crate::sparse::{Symmetric, Triplets};
use crate::stiffness::{GridPair, ScalarPair, Stiffness, scalar_end};
use crate::supports::{constrained, selected_sets};
use crate::unknown;

/// Stiffness of a component against the stiffest one of its triple (translations or rotations of a grid) below which
/// it is singular: EPZERO of Nastran.
const SINGULAR: f64 = 1e-8;

/// How a deck is made into a model.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelOptions {
    /// Mass of bars and beams; `None` follows PARAM,COUPMASS (lumped when absent, as Nastran).
    pub bar_mass: Option<BarMass>,
    /// Go on without elements that are not modelled; they are then remarked.
    pub leave_out_unknown: bool,
    /// Hold freedoms without stiffness; `None` follows PARAM,AUTOSPC (yes when absent).
    pub auto_spc: Option<bool>,
    /// Subcase whose SPC and MPC sets hold; `None` takes the first.
    pub subcase: Option<u32>,
}

/// What happens to a freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is free; the number is its row of the matrices.
    Free(usize),
    /// It is held: by PS, SPC, or because nothing resists it.
    Held,
    /// It depends on free ones.
    Dependent,
}

/// A model: elements, constraints, and the matrices on the free freedoms.
#[derive(Debug, Clone)]
pub struct FemModel {
    pub(crate) freedoms: Freedoms,
    pub(crate) frames: Frames,
    pub(crate) weight_to_mass: f64,
    /// GRDPNT when it names a grid.
    reference_point: Id,
    elements: Elements,
    relations: Vec<multipoint::Relation>,
    held: BTreeSet<usize>,
    pub(crate) constraints: Transform,
    pub(crate) stiffness: Symmetric,
    pub(crate) mass: Symmetric,
    /// M before constraints, in CD systems.
    pub(crate) full_mass: Symmetric,
    /// Mass by grid, after PARAM,WTMASS; scalar masses are not in it.
    pub mass_model: MassModel,
    /// What was assumed, left out or removed.
    pub remarks: Vec<String>,
}

#[derive(Debug, Clone)]
struct Elements {
    pairs: Vec<GridPair>,
    springs: Vec<ScalarPair>,
    masses: Vec<ScalarPair>,
}

/// `u_g = T u_f` by rows of T.
#[derive(Debug, Clone, Default)]
pub(crate) struct Transform {
    start: Vec<usize>,
    terms: Vec<(usize, f64)>,
    pub(crate) fates: Vec<Fate>,
    /// The g-freedom of each free one.
    pub(crate) free: Vec<usize>,
}

impl Transform {
    fn new(count: usize, held: &BTreeSet<usize>, relations: &[multipoint::Relation]) -> Self {
        let mut fates = vec![Fate::Held; count];
        let mut of = vec![None; count];
        for r in relations {
            fates[r.dependent] = Fate::Dependent;
            of[r.dependent] = Some(&r.terms);
        }
        let mut free = Vec::new();
        for (i, fate) in fates.iter_mut().enumerate() {
            if *fate == Fate::Held && !held.contains(&i) {
                *fate = Fate::Free(free.len());
                free.push(i);
            }
        }
        let mut transform = Self {
            start: vec![0],
            terms: Vec::with_capacity(count),
            free,
            fates,
        };
        for (i, relation) in of.into_iter().enumerate() {
            match transform.fates[i] {
                Fate::Free(k) => transform.terms.push((k, 1.0)),
                Fate::Held => {}
                Fate::Dependent => {
                    for &(j, c) in relation.into_iter().flatten() {
                        if let Fate::Free(k) = transform.fates[j] {
                            transform.terms.push((k, c));
                        }
                    }
                }
            }
            transform.start.push(transform.terms.len());
        }
        transform
    }

    pub(crate) fn row(&self, freedom: usize) -> &[(usize, f64)] {
        &self.terms[self.start[freedom]..self.start[freedom + 1]]
    }

    /// T x.
    pub(crate) fn expand(&self, x: &[f64]) -> Vec<f64> {
        let row = |i| self.row(i).iter().map(|&(k, c)| c * x[k]).sum();
        (0..self.fates.len()).map(row).collect()
    }

    /// T^T p.
    pub(crate) fn reduce(&self, p: &[f64]) -> Vec<f64> {
        let mut reduced = vec![0.0; self.free.len()];
        for (i, p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for &(k, c) in self.row(i) {
                reduced[k] += c * p;
            }
        }
        reduced
    }
}

impl FemModel {
    /// Assembles a deck.
    ///
    /// # Errors
    /// [`Error::UnknownElements`] unless asked to go on without; [`Error::MissingCard`], [`Error::BadElement`],
    /// [`Error::BadMass`], [`Error::BadConstraint`] that name the card; [`Error::EmptyModel`] without free freedoms.
    pub fn assemble(deck: &Deck, options: &ModelOptions) -> Result<Self, Error> {
        let mut remarks = Vec::new();
        let mut found = unknown::elements(deck);
        let frames = Frames::resolve(deck)?;
        let coupled = || {
            let asked = deck.param("COUPMASS").and_then(|p| p.as_integer());
            if asked.is_some_and(|n| n > 0) {
                BarMass::Coupled
            } else {
                BarMass::Lumped
            }
        };
        let bar_mass = options.bar_mass.unwrap_or_else(coupled);
        let deck_mass = DeckMass::assemble(deck, &frames, bar_mass)?;
        found.extend(deck_mass.left_out_by_elements.iter().cloned());
        if !found.is_empty() && !options.leave_out_unknown {
            return Err(Error::UnknownElements { found });
        }
        if !found.is_empty() {
            remarks.push(format!("left out, as asked: {}", found.join(", ")));
        }
        remarks.extend(deck_mass.notes.iter().cloned());

        let context = Context {
            deck,
            frames: &frames,
        };
        let freedoms = Freedoms::of(deck)?;
        let stiffness = Stiffness::assemble(&context, &freedoms)?;
        remarks.extend(stiffness.remarks);
        let relations = multipoint::relations(&context, &freedoms, options.subcase)?;
        let held = supports(&context, &freedoms, &relations, options.subcase, &mut remarks)?;
        let elements = Elements {
            pairs: stiffness.pairs,
            springs: stiffness.scalars,
            masses: scalar_masses(&context, &freedoms)?,
        };
        note_ignored(deck, &mut remarks);
        let mut model = Self {
            weight_to_mass: deck.weight_to_mass(),
            reference_point: reference_point(deck, &frames),
            freedoms,
            elements,
            relations,
            held,
            constraints: Transform::default(),
            stiffness: Symmetric::default(),
            mass: Symmetric::default(),
            full_mass: Symmetric::default(),
            mass_model: deck_mass.model,
            remarks,
            frames,
        };
        model.full_mass = model.assemble_full_mass();
        model.reassemble();
        let auto_spc = options.auto_spc.unwrap_or_else(|| {
            let param = deck.param("AUTOSPC");
            param.is_none_or(|p| p.value != "NO")
        });
        if auto_spc {
            model.hold_singular();
        }
        if model.constraints.free.is_empty() {
            return Err(Error::EmptyModel {
                problem: "no freedom of the model is free and has stiffness; check GRID, elements, SPC, E and G of MAT1, and areas (A of PBAR)"
                    .into(),
            });
        }
        Ok(model)
    }

    /// The freedoms before constraints.
    #[must_use]
    pub fn freedoms(&self) -> &Freedoms {
        &self.freedoms
    }

    /// Positions and displacement systems of the grids.
    #[must_use]
    pub fn frames(&self) -> &Frames {
        &self.frames
    }

    /// What happens to each freedom.
    #[must_use]
    pub fn fates(&self) -> &[Fate] {
        &self.constraints.fates
    }

    /// The stiffness matrix on the free freedoms, in their CD systems: N/m, N, N m.
    #[must_use]
    pub fn stiffness(&self) -> &Symmetric {
        &self.stiffness
    }

    /// The mass matrix on the free freedoms, after PARAM,WTMASS: kg, kg m, kg m^2.
    #[must_use]
    pub fn mass(&self) -> &Symmetric {
        &self.mass
    }

    /// Displacements of all freedoms for those of the free ones.
    ///
    /// # Errors
    /// [`Error::BadOption`] for a vector whose length is not the order of the matrices.
    pub fn expand(&self, free: &[f64]) -> Result<Vec<f64>, Error> {
        Error::refuse_length(free.len(), self.constraints.free.len())?;
        Ok(self.constraints.expand(free))
    }

    /// Mass, centre of gravity and inertia, after PARAM,WTMASS. `None` without mass.
    #[must_use]
    pub fn properties(&self) -> Option<MassProperties> {
        self.mass_model.properties()
    }

    /// The grid point weight generator's block about the grid of PARAM,GRDPNT, or the basic origin; before WTMASS.
    #[must_use]
    pub fn weight(&self) -> GridPointWeight {
        let reference = self.frames.grid(self.reference_point);
        let center = reference.map_or_else(Vector3::zeros, |g| g.position);
        let mo = self.mass_model.rigid_mass(center.into());
        crate::listing::weight(
            self.reference_point,
            mo.map(|row| row.map(|m| m / self.weight_to_mass)),
        )
    }

    /// The six rigid motions about a point on all freedoms, in CD systems; scalar points do not move.
    pub(crate) fn rigid_motions(&self, center: Vector3<f64>) -> Vec<[f64; 6]> {
        let mut motions = vec![[0.0; 6]; self.freedoms.count()];
        for point in self.freedoms.points().iter().filter(|p| !p.is_scalar) {
            let Some(grid) = self.frames.grid(point.id) else {
                continue;
            };
            let e = rotation_blocks(&grid.axes).transpose()
                * crate::rigid::rigid_transfer(grid.position - center);
            for i in 0..6 {
                motions[point.first + i] = std::array::from_fn(|j| e[(i, j)]);
            }
        }
        motions
    }

    /// Holds further freedoms and builds the matrices again.
    pub(crate) fn hold(&mut self, freedoms: impl IntoIterator<Item = usize>) {
        self.held.extend(freedoms);
        self.reassemble();
    }

    fn reassemble(&mut self) {
        self.constraints = Transform::new(self.freedoms.count(), &self.held, &self.relations);
        let n = self.constraints.free.len();
        let mut k = Triplets::default();
        for pair in &self.elements.pairs {
            self.add_pair(pair, &mut k);
        }
        for spring in &self.elements.springs {
            let ends = spring
                .ends
                .map(|e| e.map(|e| self.constraints.row(e)).unwrap_or_default());
            for (p, &a) in ends.iter().enumerate() {
                for (q, &b) in ends.iter().enumerate() {
                    let value = if p == q { spring.value } else { -spring.value };
                    add_product(&mut k, a, b, value);
                }
            }
        }
        self.stiffness = Symmetric::new(n, k);
        let mut m = Triplets::default();
        for (i, j, value) in self.full_mass.entries() {
            let (a, b) = (self.constraints.row(i), self.constraints.row(j));
            add_product(&mut m, a, b, value);
            if i != j {
                add_product(&mut m, b, a, value);
            }
        }
        self.mass = Symmetric::new(n, m);
    }

    /// The first of the six freedoms of a grid; a scalar point has only one.
    fn first_of_grid(&self, id: Id) -> Option<usize> {
        let point = self.freedoms.point(id).filter(|p| !p.is_scalar)?;
        Some(point.first)
    }

    /// T^T K T of an element between grids, K turned to the CD systems.
    fn add_pair(&self, pair: &GridPair, k: &mut Triplets) {
        let at = |id: Id| Some((self.first_of_grid(id)?, self.frames.grid(id)?));
        let Some((a, grid_a)) = at(pair.a) else { return };
        let turn = |block: &Matrix6<f64>, left: Id, right: Id, la, ra| -> Matrix6<f64> {
            let mut turned = *block;
            if left != 0 {
                turned = rotation_blocks(la).transpose() * turned;
            }
            if right != 0 {
                turned *= rotation_blocks(ra);
            }
            turned
        };
        let [aa, ab, bb] = &pair.blocks;
        let (ca, axes_a) = (grid_a.cd, &grid_a.axes);
        self.add_block(a, a, &turn(aa, ca, ca, axes_a, axes_a), k);
        if let Some((b, grid_b)) = pair.b.and_then(at) {
            let (cb, axes_b) = (grid_b.cd, &grid_b.axes);
            let off = turn(ab, ca, cb, axes_a, axes_b);
            self.add_block(a, b, &off, k);
            self.add_block(b, a, &off.transpose(), k);
            self.add_block(b, b, &turn(bb, cb, cb, axes_b, axes_b), k);
        }
    }

    /// K u of the elements on all freedoms, before constraints.
    pub(crate) fn internal_forces(&self, u: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; u.len()];
        let at = |id: Id| {
            let first = self.first_of_grid(id)?;
            let turn = rotation_blocks(&self.frames.grid(id)?.axes);
            let local = nalgebra::Vector6::from_fn(|i, _| u[first + i]);
            Some((first, turn, turn * local))
        };
        for pair in &self.elements.pairs {
            let Some((first_a, turn_a, ua)) = at(pair.a) else {
                continue;
            };
            let [aa, ab, bb] = &pair.blocks;
            let mut fa = aa * ua;
            if let Some((first_b, turn_b, ub)) = pair.b.and_then(at) {
                fa += ab * ub;
                let fb = turn_b.transpose() * (ab.transpose() * ua + bb * ub);
                (0..6).for_each(|i| forces[first_b + i] += fb[i]);
            }
            let fa = turn_a.transpose() * fa;
            (0..6).for_each(|i| forces[first_a + i] += fa[i]);
        }
        for spring in &self.elements.springs {
            let [a, b] = spring.ends;
            let stretch = a.map_or(0.0, |a| u[a]) - b.map_or(0.0, |b| u[b]);
            if let Some(a) = a {
                forces[a] += spring.value * stretch;
            }
            if let Some(b) = b {
                forces[b] -= spring.value * stretch;
            }
        }
        forces
    }

    /// Forces on dependent freedoms act on the independent ones.
    pub(crate) fn carry_to_independent(&self, forces: &mut [f64]) {
        for relation in &self.relations {
            let force = std::mem::take(&mut forces[relation.dependent]);
            for &(j, c) in &relation.terms {
                forces[j] += c * force;
            }
        }
    }

    fn add_block(&self, row: usize, column: usize, block: &Matrix6<f64>, triplets: &mut Triplets) {
        for j in 0..6 {
            let right = self.constraints.row(column + j);
            if right.is_empty() {
                continue;
            }
            for i in 0..6 {
                add_product(triplets, self.constraints.row(row + i), right, block[(i, j)]);
            }
        }
    }

    fn assemble_full_mass(&self) -> Symmetric {
        let mut m = Triplets::default();
        let at = |id: Id| {
            Some((
                self.first_of_grid(id)?,
                rotation_blocks(&self.frames.grid(id)?.axes),
            ))
        };
        for (&id, grid) in &self.mass_model.grids {
            let Some((first, turn)) = at(id) else { continue };
            let block = turn.transpose() * grid.matrix * turn;
            for i in 0..6 {
                for j in 0..=i {
                    m.add(first + i, first + j, block[(i, j)]);
                }
            }
        }
        for (&(a, b), block) in &self.mass_model.couplings {
            let (Some((first_a, turn_a)), Some((first_b, turn_b))) = (at(a), at(b)) else {
                continue;
            };
            // a < b, and freedoms ascend with point numbers: M(b, a) is in the lower triangle.
            let block = turn_a.transpose() * block * turn_b;
            for i in 0..6 {
                for j in 0..6 {
                    m.add(first_b + j, first_a + i, block[(i, j)]);
                }
            }
        }
        for mass in &self.elements.masses {
            for (p, &a) in mass.ends.iter().enumerate() {
                for (q, &b) in mass.ends.iter().enumerate() {
                    if let (Some(a), Some(b)) = (a, b) {
                        let value = self.weight_to_mass * if p == q { mass.value } else { -mass.value };
                        m.add(a, b, value);
                    }
                }
            }
        }
        Symmetric::new(self.freedoms.count(), m)
    }

    /// Holds components without stiffness, grid by grid: translations and rotations separately, by elimination with
    /// the largest pivot first (Nastran's grid point singularities).
    fn hold_singular(&mut self) {
        let mut triples: Vec<Triple> = Vec::new();
        let mut of_free: Vec<(usize, usize)> = vec![(usize::MAX, 0); self.constraints.free.len()];
        for point in self.freedoms.points() {
            for half in 0..if point.is_scalar { 1 } else { 2 } {
                let width = if point.is_scalar { 1 } else { 3 };
                let mut members = [None; 3];
                for (c, member) in members.iter_mut().enumerate().take(width) {
                    let freedom = point.first + 3 * half + c;
                    if let Fate::Free(k) = self.constraints.fates[freedom] {
                        *member = Some(freedom);
                        of_free[k] = (triples.len(), c);
                    }
                }
                triples.push(Triple {
                    stiffness: [[0.0; 3]; 3],
                    members,
                });
            }
        }
        for (i, j, value) in self.stiffness.entries() {
            let ((t, a), (u, b)) = (of_free[i], of_free[j]);
            if t == u {
                triples[t].stiffness[a][b] = value;
                triples[t].stiffness[b][a] = value;
            }
        }
        let singular: Vec<usize> = triples.into_iter().flat_map(singular_components).collect();
        if singular.is_empty() {
            return;
        }
        self.remarks.push(format!(
            "{} freedoms without stiffness are held (AUTOSPC): {}",
            singular.len(),
            listed(&self.freedoms, &singular)
        ));
        let mass = self.full_mass.diagonal();
        let massive = singular
            .iter()
            .filter(|&&i| mass.get(i).is_some_and(|&m| m > 0.0))
            .count();
        if massive > 0 {
            self.remarks.push(format!(
                "{massive} of the held freedoms carry mass, which takes no part in the motion; connect them, or set \
                 PARAM,AUTOSPC,NO"
            ));
        }
        self.hold(singular);
    }
}

/// Names of freedoms for messages, the first ten.
pub(crate) fn listed(freedoms: &Freedoms, which: &[usize]) -> String {
    let mut names: Vec<String> = which.iter().take(10).map(|&i| freedoms.name(i)).collect();
    if which.len() > 10 {
        names.push(format!("... ({} in all)", which.len()));
    }
    names.join(", ")
}

/// Stiffness among the translations or the rotations of a grid, and its free freedoms.
struct Triple {
    stiffness: [[f64; 3]; 3],
    members: [Option<usize>; 3],
}

fn singular_components(triple: Triple) -> Vec<usize> {
    let Triple {
        stiffness: mut k,
        members,
    } = triple;
    let mut left: Vec<usize> = (0..3).filter(|&c| members[c].is_some()).collect();
    let largest = left.iter().fold(0.0_f64, |m, &c| m.max(k[c][c]));
    while let Some(at) = (0..left.len()).max_by(|&p, &q| k[left[p]][left[p]].total_cmp(&k[left[q]][left[q]]))
    {
        let c = left[at];
        let pivot = k[c][c];
        if pivot <= SINGULAR * largest {
            break;
        }
        left.remove(at);
        for &i in &left {
            for &j in &left {
                k[i][j] -= k[i][c] * k[c][j] / pivot;
            }
        }
    }
    left.into_iter().filter_map(|c| members[c]).collect()
}

fn add_product(triplets: &mut Triplets, left: &[(usize, f64)], right: &[(usize, f64)], value: f64) {
    if value == 0.0 {
        return;
    }
    for &(i, a) in left {
        for &(j, b) in right {
            triplets.add(i, j, a * value * b);
        }
    }
}

/// Freedoms held by PS and the selected SPC sets.
fn supports(
    context: &Context<'_>,
    freedoms: &Freedoms,
    relations: &[multipoint::Relation],
    subcase: Option<u32>,
    remarks: &mut Vec<String>,
) -> Result<BTreeSet<usize>, Error> {
    let dependent: BTreeSet<usize> = relations.iter().map(|r| r.dependent).collect();
    let mut held = BTreeSet::new();
    for (id, components) in constrained(context.deck, subcase) {
        let Some(point) = freedoms.point(id) else { continue };
        let named: Vec<u8> = if point.is_scalar {
            vec![0]
        } else {
            components.iter().collect()
        };
        for c in named {
            let Some(freedom) = freedoms.index(id, c) else {
                continue;
            };
            if dependent.contains(&freedom) {
                return Err(context.bad_constraint(
                    "GRID",
                    id,
                    format!(
                        "{} is held by SPC or PS and dependent in a rigid element or MPC; remove one of them",
                        freedoms.name(freedom)
                    ),
                ));
            }
            held.insert(freedom);
        }
    }
    let sets = selected_sets(context.deck, "SPC", subcase);
    let enforced = context
        .deck
        .spcs
        .iter()
        .filter(|s| sets.contains(&s.sid) && s.enforced != 0.0);
    let count = enforced.count();
    if count > 0 {
        remarks.push(format!(
            "{count} enforced displacements on SPC cards are taken as zero"
        ));
    }
    if sets.is_empty() && !(context.deck.spcs.is_empty() && context.deck.spc1s.is_empty()) {
        remarks
            .push("the deck has SPC cards, but case control selects no SPC set; none of them holds".into());
    }
    Ok(held)
}

fn scalar_masses(context: &Context<'_>, freedoms: &Freedoms) -> Result<Vec<ScalarPair>, Error> {
    let mut masses = Vec::new();
    for mass in context.deck.scalar_masses.values() {
        let (name, id) = (mass.card_name(), mass.id);
        let value = match mass.value {
            ScalarMassValue::Value(m) => m,
            ScalarMassValue::Property(pid) => {
                let found = context.deck.mass_properties.get(&pid);
                *found.ok_or_else(|| context.missing(name, id, format!("PMASS {pid}")))?
            }
        };
        let mut ends = [None; 2];
        for (end, at) in ends.iter_mut().zip(&mass.ends) {
            *end = scalar_end(context, freedoms, (name, id), at)?;
        }
        if !value.is_finite() {
            return Err(Error::BadMass {
                card: context.card(name, id),
                problem: format!("its mass is {}; expected a finite number", ShortNumber(value)),
            });
        }
        masses.push(ScalarPair { ends, value });
    }
    Ok(masses)
}

fn note_ignored(deck: &Deck, remarks: &mut Vec<String>) {
    if !deck.suports.is_empty() {
        remarks.push("SUPORT is not needed and has no effect: rigid modes are found without it".into());
    }
    if !(deck.asets.is_empty() && deck.omits.is_empty()) {
        remarks.push("ASET and OMIT are not applied: the modes are of the full model".into());
    }
}

fn reference_point(deck: &Deck, frames: &Frames) -> Id {
    let asked = deck.param("GRDPNT").and_then(|p| p.as_integer());
    asked
        .and_then(|n| Id::try_from(n).ok())
        .filter(|&n| frames.grid(n).is_some())
        .unwrap_or(0)
}
