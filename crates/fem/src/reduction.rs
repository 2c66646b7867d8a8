//! Reduction to an analysis set: Guyan's static condensation and the method of Craig and Bampton.
//!
//! With boundary freedoms a and interior freedoms o,
//!
//! ```text
//! u_o = G u_a + Phi q,    G = -K_oo^-1 K_oa,    K_oo Phi = M_oo Phi Lambda
//! ```
//!
//! Guyan (AIAA J. 3, 1965) leaves out Phi; Craig and Bampton (AIAA J. 6, 1968) keep the lowest modes with the boundary
//! held. Static deflections under boundary loads are exact in both.
//!
//! Equations: THEORY (45).

use albatross_nastran::Deck;
use albatross_nastran::deck::{Components, Id};
use albatross_numerics::Mat;
use albatross_numerics::faer::Side;

use crate::error::Error;
use crate::factor::Analysis;
use crate::lanczos::{Pairs, Wanted};
use crate::model::{Fate, FemModel};
use crate::modes::{ModeScale, Modes};
use crate::pencil::Pencil;
use crate::sparse::Symmetric;

/// A reduced model: matrices on boundary freedoms, then interior modes.
#[derive(Debug, Clone)]
pub struct ReducedModel {
    /// Boundary freedoms: point and component (0 for a scalar point), in the order of the matrices.
    pub boundary: Vec<(Id, u8)>,
    /// Eigenvalues of the interior modes that follow, (rad/s)^2.
    pub interior: Vec<f64>,
    /// Reduced stiffness, symmetric.
    pub stiffness: Mat<f64>,
    /// Reduced mass, symmetric.
    pub mass: Mat<f64>,
    /// Displacements of the free freedoms for unit reduced coordinates.
    pub recovery: Mat<f64>,
}

/// The freedoms of ASET and ASET1 cards.
#[must_use]
pub fn analysis_set(deck: &Deck) -> Vec<(Id, Components)> {
    let sets = deck.asets.iter();
    sets.flat_map(|s| s.points.iter().map(|&p| (p, s.components)))
        .collect()
}

/// All six components of a list of grids, such as a load reference axis.
#[must_use]
pub fn all_components(grids: &[Id]) -> Vec<(Id, Components)> {
    grids.iter().map(|&g| (g, Components::ALL)).collect()
}

/// Free freedoms split in boundary and interior.
struct Split {
    boundary: Vec<usize>,
    interior: Vec<usize>,
    /// Place of each free freedom in `interior`.
    position: Vec<Option<usize>>,
}

impl FemModel {
    /// Guyan reduction to `set`; components that are held are left out of it.
    ///
    /// # Errors
    /// [`Error::NoSuchFreedom`] for a freedom that the model lacks or that is dependent in a rigid element;
    /// [`Error::Mechanism`] when the interior can move with the boundary held.
    pub fn guyan(&self, set: &[(Id, Components)]) -> Result<ReducedModel, Error> {
        self.craig_bampton(set, 0)
    }

    /// Craig-Bampton reduction to `set` and `count` modes of the interior (fewer if it has fewer).
    ///
    /// # Errors
    /// As [`guyan`](Self::guyan), and those of [`modes`](Self::modes).
    pub fn craig_bampton(&self, set: &[(Id, Components)], count: usize) -> Result<ReducedModel, Error> {
        let split = self.split(set)?;
        let (n, n_a, n_o) = (
            self.constraints.free.len(),
            split.boundary.len(),
            split.interior.len(),
        );
        let nodes = self.nodes();
        let stiffness = self.stiffness.part(n_o, &split.position);
        let mass = self.mass.part(n_o, &split.position);
        let nodes: Vec<usize> = split.interior.iter().map(|&k| nodes[k]).collect();

        let mut place = vec![None; n];
        for (q, &k) in split.boundary.iter().enumerate() {
            place[k] = Some(q);
        }
        let mut coupling = Mat::zeros(n_o, n_a);
        for (i, j, v) in self.stiffness.entries() {
            for (i, j) in [(i, j), (j, i)] {
                if let (Some(p), Some(q)) = (split.position[i], place[j]) {
                    coupling[(p, q)] = -v;
                }
            }
        }
        let mut modes = None;
        if n_o > 0 {
            let analysis = Analysis::new(&stiffness, &nodes)?;
            let factor = analysis.factorise(&stiffness)?;
            let mut loose = factor.singular.clone();
            if loose.is_empty() {
                loose.extend(factor.null_motion(&stiffness));
            }
            if !loose.is_empty() {
                let name = |&k: &usize| self.freedoms.name(self.constraints.free[split.interior[k]]);
                return Err(Error::Mechanism {
                    freedoms: loose.iter().map(name).collect(),
                    with_mass: true,
                });
            }
            factor.solve_in_place(&mut coupling);
            drop(factor);
            let massive = mass.diagonal().iter().any(|&m| m > 0.0);
            if count > 0 && massive {
                let pencil = Pencil {
                    stiffness: &stiffness,
                    mass: &mass,
                    nodes,
                };
                let analysis = pencil.analysis()?;
                modes = Some(pencil.shifted(&analysis)?.lowest(Wanted::Count(count))?);
            }
        }
        let interior = modes.as_ref().map(|m| m.eigenvalues.clone()).unwrap_or_default();
        let mut recovery = Mat::zeros(n, n_a + interior.len());
        for (q, &k) in split.boundary.iter().enumerate() {
            recovery[(k, q)] = 1.0;
        }
        for (p, &k) in split.interior.iter().enumerate() {
            for q in 0..n_a {
                recovery[(k, q)] = coupling[(p, q)];
            }
            for (q, column) in (n_a..).zip(0..interior.len()) {
                recovery[(k, q)] = modes.as_ref().map_or(0.0, |m| m.vectors[(p, column)]);
            }
        }
        let boundary = split.boundary.iter().filter_map(|&k| {
            let freedom = *self.constraints.free.get(k)?;
            self.freedoms.of_index(freedom)
        });
        Ok(ReducedModel {
            boundary: boundary.collect(),
            stiffness: projected(&self.stiffness, &recovery),
            mass: projected(&self.mass, &recovery),
            interior,
            recovery,
        })
    }

    /// Modes of a reduced model, with shapes on all freedoms of this one.
    ///
    /// # Errors
    /// [`Error::BadOption`] for matrices that do not fit each other and this model, or are not finite;
    /// [`Error::EmptyModel`] without mass, [`Error::Factorisation`] when the reduced matrices are not positive
    /// semidefinite.
    pub fn modes_of_reduced(&self, reduced: &ReducedModel, count: usize) -> Result<Modes, Error> {
        self.refuse_unfit(reduced)?;
        let pairs = dense_modes(&reduced.stiffness, &reduced.mass, count)?;
        let vectors = &reduced.recovery * &pairs.vectors;
        let pairs = Pairs { vectors, ..pairs };
        Ok(self.finish(pairs, ModeScale::Mass, Vec::new(), 0))
    }

    /// Refuses matrices altered since, or reduced from another model.
    fn refuse_unfit(&self, reduced: &ReducedModel) -> Result<(), Error> {
        let ReducedModel {
            stiffness,
            mass,
            recovery,
            ..
        } = reduced;
        let (n, free) = (stiffness.nrows(), self.constraints.free.len());
        let finite = |m: &Mat<f64>| (0..m.ncols()).all(|j| (0..m.nrows()).all(|i| m[(i, j)].is_finite()));
        let bad = |value: String| {
            Err(Error::BadOption {
                option: "the reduced model",
                value,
                expected: "square matrices of one order, with a row of `recovery` for each free freedom of this model, \
                           all finite: reduce this model",
            })
        };
        for (name, matrix, rows) in [
            ("stiffness", stiffness, n),
            ("mass", mass, n),
            ("recovery", recovery, free),
        ] {
            let (found_rows, found_columns) = (matrix.nrows(), matrix.ncols());
            if (found_rows, found_columns) != (rows, n) {
                return bad(format!(
                    "one whose `{name}` has {found_rows} rows and {found_columns} columns instead of {rows} and {n}"
                ));
            }
            if !finite(matrix) {
                return bad(format!("one whose `{name}` has a number that is not finite"));
            }
        }
        Ok(())
    }

    fn split(&self, set: &[(Id, Components)]) -> Result<Split, Error> {
        let mut boundary = Vec::new();
        for &(id, components) in set {
            let scalar = self.freedoms.point(id).is_some_and(|p| p.is_scalar);
            let named: Vec<u8> = if scalar {
                vec![0]
            } else {
                components.iter().collect()
            };
            for c in named {
                let missing = |cure| Error::NoSuchFreedom {
                    what: format!("component {c} of point {id}"),
                    cure,
                };
                let freedom = self.freedoms.index(id, c);
                let freedom = freedom.ok_or_else(|| missing("name points and components of the deck"))?;
                match self.constraints.fates.get(freedom) {
                    Some(Fate::Free(k)) => boundary.push(*k),
                    Some(Fate::Held) => {}
                    _ => {
                        return Err(missing(
                            "it depends on others through a rigid element; name the independent grid instead",
                        ));
                    }
                }
            }
        }
        boundary.sort_unstable();
        boundary.dedup();
        let n = self.constraints.free.len();
        let interior: Vec<usize> = (0..n).filter(|k| boundary.binary_search(k).is_err()).collect();
        let mut position = vec![None; n];
        for (p, &k) in interior.iter().enumerate() {
            position[k] = Some(p);
        }
        Ok(Split {
            boundary,
            interior,
            position,
        })
    }
}

/// R^T A R, exactly symmetric.
fn projected(a: &Symmetric, r: &Mat<f64>) -> Mat<f64> {
    let product = r.transpose() * a.apply_columns(r);
    let m = product.nrows();
    Mat::from_fn(m, m, |i, j| 0.5 * (product[(i, j)] + product[(j, i)]))
}

/// Lowest modes of a small pencil: with K - sigma M = L L^T, `L^-1 M L^-T y = theta y`. M may be singular.
fn dense_modes(k: &Mat<f64>, m: &Mat<f64>, count: usize) -> Result<Pairs, Error> {
    let n = k.nrows();
    let mut ratios: Vec<f64> = (0..n)
        .filter(|&i| m[(i, i)] > 0.0)
        .map(|i| k[(i, i)] / m[(i, i)])
        .collect();
    ratios.sort_by(f64::total_cmp);
    let size = ratios.first().copied().ok_or_else(|| Error::EmptyModel {
        problem: "the reduced model has no mass; add freedoms that carry mass to the set".into(),
    })?;
    // Shifts far above the lowest eigenvalues lose their digits: a second round with what the first found.
    let rough = shifted_dense(k, m, -size.max(f64::MIN_POSITIVE), count.max(8))?;
    let elastic = rough
        .eigenvalues
        .get(7.min(rough.eigenvalues.len().saturating_sub(1)))
        .copied();
    match elastic.filter(|&l| l > 0.0 && l < 0.5 * size) {
        Some(lambda) => shifted_dense(k, m, -0.3 * lambda, count),
        None => shifted_dense(k, m, -size.max(f64::MIN_POSITIVE), count),
    }
}

fn shifted_dense(k: &Mat<f64>, m: &Mat<f64>, sigma: f64, count: usize) -> Result<Pairs, Error> {
    let n = k.nrows();
    let failed = |reason: String| Error::Factorisation {
        what: "reduced stiffness matrix",
        reason,
    };
    let shifted = Mat::from_fn(n, n, |i, j| k[(i, j)] - sigma * m[(i, j)]);
    let factor = shifted.llt(Side::Lower).map_err(|e| failed(format!("{e:?}")))?;
    let mut c = m.to_owned();
    let l = factor.L();
    albatross_numerics::faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        l,
        c.as_mut(),
        albatross_numerics::faer::Par::Seq,
    );
    let mut c = c.transpose().to_owned();
    albatross_numerics::faer::linalg::triangular_solve::solve_lower_triangular_in_place(
        l,
        c.as_mut(),
        albatross_numerics::faer::Par::Seq,
    );
    let eigen = c
        .self_adjoint_eigen(Side::Lower)
        .map_err(|e| failed(format!("{e:?}")))?;
    let theta: Vec<f64> = (0..n).rev().map(|i| eigen.S()[i]).collect();
    let largest = theta.first().copied().unwrap_or(0.0);
    let found = theta
        .iter()
        .take(count)
        .take_while(|&&t| t > 1e-13 * largest)
        .count();
    // y scaled so that x^T M x = 1: |y|^2 theta = 1.
    let mut x = Mat::from_fn(n, found, |i, j| eigen.U()[(i, n - 1 - j)] / theta[j].sqrt());
    albatross_numerics::faer::linalg::triangular_solve::solve_upper_triangular_in_place(
        l.transpose(),
        x.as_mut(),
        albatross_numerics::faer::Par::Seq,
    );
    Ok(Pairs {
        eigenvalues: theta.iter().take(found).map(|t| sigma + 1.0 / t).collect(),
        vectors: x,
        exhausted: found < count,
    })
}
