//! The influence matrix: assembly and factorisation.
//!
//! Row i states that no air passes control point i, `sum_j n_i . V_ij gamma_j = -n_i . V_onset`; on strips without
//! wake the last row states that the strip's circulations sum to zero. The matrices are stored transposed, so a
//! boundary condition is one contiguous column.
//!
//! Equations: THEORY (48).

use albatross_numerics::Mat;
use albatross_numerics::faer::dyn_stack::{MemBuffer, MemStack};
use albatross_numerics::faer::linalg::lu::partial_pivoting::{factor, solve};
use albatross_numerics::faer::perm::PermRef;
use albatross_numerics::faer::prelude::ReborrowMut;
use albatross_numerics::faer::{MatMut, Par};

use crate::error::{Error, Result};
use crate::kernel::{Horseshoes, Velocities};
use crate::lattice::Lattice;
use crate::method::Method;
use crate::symmetry::{Pairing, Unknowns};

/// Pivots below this fraction of the largest one make a system singular.
const SINGULAR: f64 = 1e-13;

/// The assembled systems of a lattice at a Mach number.
#[derive(Debug)]
pub struct Influence<'l> {
    pub(crate) lattice: &'l Lattice,
    pub(crate) method: Method,
    pub(crate) mach: f64,
    pub(crate) horseshoes: Horseshoes,
    /// Number of each vortex' component.
    pub(crate) components: Vec<usize>,
    systems: Vec<(Unknowns, Mat<f64>)>,
}

/// A system with its factors.
#[derive(Debug)]
pub(crate) struct Factors {
    pub(crate) unknowns: Unknowns,
    lu: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

/// The factorised systems.
#[derive(Debug)]
pub struct Factorised<'l> {
    pub(crate) lattice: &'l Lattice,
    pub(crate) method: Method,
    pub(crate) mach: f64,
    pub(crate) horseshoes: Horseshoes,
    pub(crate) components: Vec<usize>,
    pub(crate) systems: Vec<Factors>,
}

impl<'l> Influence<'l> {
    /// Assembles the boundary conditions; two half systems where the lattice is symmetric.
    ///
    /// # Errors
    /// [`Error::Value`] for a Mach number outside 0 to 1; what [`Lattice::check`] returns.
    pub fn assemble(lattice: &'l Lattice, method: &Method, mach: f64) -> Result<Self> {
        Self::new(lattice, method, mach, true)
    }

    /// As [`Self::assemble`], without looking for symmetry.
    ///
    /// # Errors
    /// As [`Self::assemble`].
    pub fn assemble_whole(lattice: &'l Lattice, method: &Method, mach: f64) -> Result<Self> {
        Self::new(lattice, method, mach, false)
    }

    fn new(lattice: &'l Lattice, method: &Method, mach: f64, symmetry: bool) -> Result<Self> {
        if !(0.0..1.0).contains(&mach) {
            return Err(Error::Value {
                what: "the Mach number".to_owned(),
                value: mach,
                expected: "Prandtl and Glauert's rule holds from 0 to below 1",
            });
        }
        // All that follows indexes by what the lattice says of itself.
        lattice.check()?;
        let components = components(lattice);
        let horseshoes = Horseshoes::new(lattice, mach, &method.core, &components);
        let n = horseshoes.len();
        let pairing = if symmetry {
            Pairing::find(lattice, &components)
        } else {
            None
        };
        let unknowns = match pairing {
            Some(pairing) => pairing
                .unknowns()
                .into_iter()
                .filter(|u| !u.members.is_empty())
                .collect(),
            None => vec![Unknowns::whole(n)],
        };
        let systems = unknowns
            .into_iter()
            .map(|u| {
                let order = u.members.len();
                (u, Mat::zeros(order, order))
            })
            .collect();
        let mut influence = Self {
            lattice,
            method: method.bounded(),
            mach,
            horseshoes,
            components,
            systems,
        };
        influence.fill();
        Ok(influence)
    }

    /// Numbers of unknowns of the systems.
    pub fn orders(&self) -> Vec<usize> {
        self.systems.iter().map(|(u, _)| u.members.len()).collect()
    }

    fn fill(&mut self) {
        let Self {
            lattice,
            horseshoes,
            components,
            systems,
            method,
            ..
        } = self;
        // Pairs stand first and in the same order in both halves: one row serves both.
        let longest = systems.iter().map(|(u, _)| u.members.len()).max().unwrap_or(0);
        let chunk = longest.div_ceil(method.threads).max(1);
        let mut parts: Vec<(&Unknowns, MatMut<'_, f64>)> =
            systems.iter_mut().map(|(u, a)| (&*u, a.as_mut())).collect();
        let mut jobs = Vec::new();
        let mut start = 0;
        while start < longest {
            let mut job = Vec::new();
            parts = parts
                .into_iter()
                .map(|(u, a)| {
                    let (head, tail) = a.split_at_col_mut(chunk.min(u.members.len().saturating_sub(start)));
                    job.push((u, head));
                    (u, tail)
                })
                .collect();
            jobs.push((start, job));
            start += chunk;
        }
        let (lattice, horseshoes, components) = (&**lattice, &*horseshoes, &*components);
        std::thread::scope(|scope| {
            let last = jobs.pop();
            for (start, job) in jobs {
                scope.spawn(move || rows(lattice, horseshoes, components, start, job));
            }
            if let Some((start, job)) = last {
                rows(lattice, horseshoes, components, start, job);
            }
        });
    }

    /// Factorises the systems in place.
    ///
    /// # Errors
    /// [`Error::Singular`] with the vortex at which elimination stops.
    pub fn factorise(self) -> Result<Factorised<'l>> {
        let Self {
            lattice,
            method,
            mach,
            horseshoes,
            components,
            systems,
        } = self;
        let systems: Vec<Factors> = if method.threads > 1 {
            std::thread::scope(|scope| {
                let handles: Vec<_> = systems
                    .into_iter()
                    .map(|(u, a)| scope.spawn(move || Factors::new(u, a)))
                    .collect();
                handles.into_iter().map(joined).collect()
            })
        } else {
            systems.into_iter().map(|(u, a)| Factors::new(u, a)).collect()
        };
        for factors in &systems {
            factors.check(lattice)?;
        }
        Ok(Factorised {
            lattice,
            method,
            mach,
            horseshoes,
            components,
            systems,
        })
    }
}

/// What a thread found; its panic goes on in the caller's, since an answer that lacks a part would pass for one.
pub(crate) fn joined<T>(handle: std::thread::ScopedJoinHandle<'_, T>) -> T {
    handle
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Fills columns from `start` of each part.
fn rows(
    lattice: &Lattice,
    horseshoes: &Horseshoes,
    components: &[usize],
    start: usize,
    mut job: Vec<(&Unknowns, MatMut<'_, f64>)>,
) {
    let n = horseshoes.len();
    let (mut velocities, mut scratch) = (Velocities::new(n), Velocities::new(n));
    let mut row = vec![0.0; n];
    let columns = job.iter().map(|(_, a)| a.ncols()).max().unwrap_or(0);
    for column in 0..columns {
        let mut last = usize::MAX;
        for (unknowns, a) in &mut job {
            if column >= a.ncols() {
                continue;
            }
            let own = unknowns.members[start + column].0;
            if own != last {
                boundary_condition(
                    lattice,
                    horseshoes,
                    components[own],
                    own,
                    &mut velocities,
                    &mut scratch,
                    &mut row,
                );
                last = own;
            }
            if let Ok(to) = a.rb_mut().col_mut(column).try_as_col_major_mut().ok_or(()) {
                unknowns.fold(&row, to.as_slice_mut());
            }
        }
    }
}

/// One row over all vortices.
fn boundary_condition(
    lattice: &Lattice,
    horseshoes: &Horseshoes,
    component: usize,
    own: usize,
    velocities: &mut Velocities,
    scratch: &mut Velocities,
    row: &mut [f64],
) {
    let vortex = &lattice.vortices[own];
    if sums_to_zero(lattice, own) {
        row.fill(0.0);
        row[lattice.strips[vortex.strip].vortices.clone()].fill(1.0);
        return;
    }
    horseshoes.at(&vortex.control_point, component, velocities, scratch);
    let n = vortex.normal;
    let (u, v, w) = (&velocities.u, &velocities.v, &velocities.w);
    for (((a, u), v), w) in row.iter_mut().zip(u).zip(v).zip(w) {
        *a = n.x * u + n.y * v + n.z * w;
    }
}

/// The last vortex of a strip without wake.
pub(crate) fn sums_to_zero(lattice: &Lattice, own: usize) -> bool {
    let vortex = &lattice.vortices[own];
    lattice.surface_of(vortex).no_wake && own + 1 == lattice.strips[vortex.strip].vortices.end
}

/// Components numbered from 0.
fn components(lattice: &Lattice) -> Vec<usize> {
    let mut known = Vec::new();
    let number = |c: i32, known: &mut Vec<i32>| {
        known.iter().position(|&k| k == c).unwrap_or_else(|| {
            known.push(c);
            known.len() - 1
        })
    };
    let vortices = lattice.vortices.iter();
    vortices
        .map(|v| number(lattice.surface_of(v).component, &mut known))
        .collect()
}

impl Factors {
    fn new(unknowns: Unknowns, mut lu: Mat<f64>) -> Self {
        let n = lu.nrows();
        let (mut forward, mut inverse) = (vec![0_usize; n], vec![0_usize; n]);
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        factor::lu_in_place(
            lu.as_mut(),
            &mut forward,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        );
        Self {
            unknowns,
            lu,
            forward,
            inverse,
        }
    }

    fn check(&self, lattice: &Lattice) -> Result<()> {
        let n = self.lu.nrows();
        let pivot = |k: usize| self.lu[(k, k)].abs();
        let largest = (0..n).map(pivot).fold(0.0, f64::max);
        match (0..n).find(|&k| !(pivot(k) > SINGULAR * largest && pivot(k).is_finite())) {
            None => Ok(()),
            Some(k) => {
                let vortex = self.unknowns.members[k].0;
                let v = &lattice.vortices[vortex];
                Err(Error::Singular {
                    part: self.unknowns.part.name(),
                    order: n,
                    vortex: vortex + 1,
                    surface: lattice.surface_of(v).name.clone(),
                    strip: v.strip + 1,
                })
            }
        }
    }

    /// Solves for the columns of `rhs`, in place.
    pub(crate) fn solve(&self, rhs: MatMut<'_, f64>) {
        let (n, columns) = (rhs.nrows(), rhs.ncols());
        if n == 0 || columns == 0 {
            return;
        }
        let scratch = solve::solve_transpose_in_place_scratch::<usize, f64>(n, columns, Par::Seq);
        solve::solve_transpose_in_place(
            self.lu.as_ref(),
            self.lu.as_ref(),
            PermRef::new_checked(&self.forward, &self.inverse, n),
            rhs,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }
}
