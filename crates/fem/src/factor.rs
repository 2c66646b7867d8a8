//! Sparse factors L D L^T of K - sigma M with a fill-reducing order, and the freedoms at which they break down.

use albatross_numerics::Mat;
use albatross_numerics::faer::dyn_stack::{MemBuffer, MemStack};
use albatross_numerics::faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use albatross_numerics::faer::perm::PermRef;
use albatross_numerics::faer::sparse::linalg::SupernodalThreshold;
use albatross_numerics::faer::sparse::linalg::amd;
use albatross_numerics::faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, supernodal::SupernodalLdltRef,
};
use albatross_numerics::faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use albatross_numerics::faer::{Conj, Par, Side};

use crate::error::Error;
use crate::sparse::Symmetric;

/// A pivot of the matrix scaled to unit diagonal below this is zero: rounding leaves about 1e-16 times the condition
/// of what was eliminated before, and stiffness spans less than 1e12 in a sound model.
const ZERO_PIVOT: f64 = 1e-12;
/// What a zero pivot becomes. Its freedom is then held.
const HELD_PIVOT: f64 = 1e24;

/// Elimination order and structure, for all shifts of a model.
#[derive(Debug)]
pub(crate) struct Analysis {
    symbolic: SymbolicCholesky<usize>,
}

/// The factor L D L^T of S A S, where S scales A to unit diagonal.
#[derive(Debug)]
pub(crate) struct Factor<'a> {
    analysis: &'a Analysis,
    values: Vec<f64>,
    scale: Vec<f64>,
    /// Freedoms whose pivot is zero: one for each motion without resistance.
    pub(crate) singular: Vec<usize>,
}

impl Analysis {
    /// Orders a pattern. `nodes[i]` is the point to which freedom i belongs: freedoms of a point stay together, so
    /// that the graph to be ordered is small and the factor has wide columns. Parts of the matrix that nothing
    /// couples (a plane frame's motions in and out of its plane) are ordered one after the other.
    pub(crate) fn new(pattern: &Symmetric, nodes: &[usize]) -> Result<Self, Error> {
        let n = pattern.order();
        let order = elimination_order(pattern, nodes)?;
        let mut inverse = vec![0; n];
        for (new, &old) in order.iter().enumerate() {
            inverse[old] = new;
        }
        let symbolic = factorize_symbolic_cholesky(
            structure(pattern),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &inverse, n)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|e| failed(&e))?;
        Ok(Self { symbolic })
    }

    /// Entries of the factor.
    pub(crate) fn stored(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Factorises a positive semidefinite matrix that has the pattern of the analysis; zero pivots are held.
    pub(crate) fn factorise(&self, a: &Symmetric) -> Result<Factor<'_>, Error> {
        let signs = vec![1; a.order()];
        let (values, scale) = self.numeric(
            a,
            LdltRegularization {
                dynamic_regularization_signs: Some(&signs),
                dynamic_regularization_delta: HELD_PIVOT,
                dynamic_regularization_epsilon: ZERO_PIVOT,
            },
        )?;
        let singular = self.pivots(&values, |d| d >= 0.5 * HELD_PIVOT);
        Ok(Factor {
            analysis: self,
            values,
            scale,
            singular,
        })
    }

    /// The number of negative eigenvalues of a regular matrix, by Sylvester's law: that of its negative pivots.
    pub(crate) fn negative_count(&self, a: &Symmetric) -> Result<usize, Error> {
        let (values, _) = self.numeric(a, LdltRegularization::default())?;
        Ok(self.pivots(&values, |d| d < 0.0).len())
    }

    /// Values of the factor of S A S, and the diagonal of S.
    fn numeric(
        &self,
        a: &Symmetric,
        regularization: LdltRegularization<'_, f64>,
    ) -> Result<(Vec<f64>, Vec<f64>), Error> {
        // A freedom without stiffness or mass keeps its zero and is found by its pivot.
        let scale: Vec<f64> = a
            .diagonal()
            .iter()
            .map(|&d| if d == 0.0 { 1.0 } else { 1.0 / d.abs().sqrt() })
            .collect();
        let mut scaled = Vec::with_capacity(a.stored());
        scaled.extend(a.entries().map(|(i, j, v)| v * scale[i] * scale[j]));
        if !scaled.iter().all(|v| v.is_finite()) {
            return Err(Error::Factorisation {
                what: "stiffness matrix",
                reason: "an entry is not finite".into(),
            });
        }
        let mut values = vec![0.0; self.symbolic.len_val()];
        let scratch = self
            .symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        self.symbolic
            .factorize_numeric_ldlt(
                &mut values,
                SparseColMatRef::new(structure(a), &scaled),
                Side::Lower,
                regularization,
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Default::default(),
            )
            .map_err(|e| failed(&e))?;
        Ok((values, scale))
    }

    /// Freedoms whose pivots satisfy a condition, ascending.
    fn pivots(&self, values: &[f64], condition: impl Fn(f64) -> bool) -> Vec<usize> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            return Vec::new();
        };
        let factor = SupernodalLdltRef::new(symbolic, values);
        let forward = self.symbolic.perm().map(|p| p.arrays().0);
        let mut found = Vec::new();
        for s in 0..symbolic.n_supernodes() {
            let node = factor.supernode(s);
            let block = node.val();
            for k in 0..block.ncols() {
                if condition(block[(k, k)]) {
                    let at = node.start() + k;
                    found.push(forward.map_or(at, |f| f[at]));
                }
            }
        }
        found.sort_unstable();
        found
    }
}

impl Factor<'_> {
    /// X becomes A^-1 X.
    pub(crate) fn solve_in_place(&self, x: &mut Mat<f64>) {
        self.scale_rows(x);
        let symbolic = &self.analysis.symbolic;
        let scratch = symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq);
        LdltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            x.as_mut(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        self.scale_rows(x);
    }

    /// The freedom that moves most in a motion which the matrix maps to nothing, if there is one: inverse iteration on
    /// the scaled matrix, whose smallest eigenvalue is then rounding noise.
    pub(crate) fn null_motion(&self, a: &Symmetric) -> Option<usize> {
        const NOISE: f64 = 3e-15;
        let mut x = crate::pencil::random_block(a.order(), 1, 0);
        for _ in 0..3 {
            // With y = S^-1 x the iteration on S A S is x -> A^-1 S^-2 x.
            for (v, s) in x.col_mut(0).iter_mut().zip(&self.scale) {
                *v /= s * s;
            }
            self.solve_in_place(&mut x);
            let largest = x.col(0).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            x.col_mut(0).iter_mut().for_each(|v| *v /= largest);
        }
        let x: Vec<f64> = x.col(0).iter().copied().collect();
        let scaled = || x.iter().zip(&self.scale).map(|(v, s)| v / s);
        let energy: f64 = a.product(&x).iter().zip(&x).map(|(p, x)| p * x).sum();
        let size: f64 = scaled().map(|y| y * y).sum();
        if energy.abs() > NOISE * size {
            return None;
        }
        let largest = scaled()
            .map(f64::abs)
            .enumerate()
            .max_by(|p, q| p.1.total_cmp(&q.1));
        largest.map(|(i, _)| i)
    }

    fn scale_rows(&self, x: &mut Mat<f64>) {
        for k in 0..x.ncols() {
            for (v, s) in x.col_mut(k).iter_mut().zip(&self.scale) {
                *v *= s;
            }
        }
    }
}

fn structure(a: &Symmetric) -> SymbolicSparseColMatRef<'_, usize> {
    SymbolicSparseColMatRef::new_checked(a.order(), a.order(), &a.columns, None, &a.rows)
}

fn failed(reason: &dyn std::fmt::Debug) -> Error {
    Error::Factorisation {
        what: "stiffness matrix",
        reason: format!("{reason:?}"),
    }
}

/// Freedoms in the order of elimination: approximate minimum degree on the graph of points.
fn elimination_order(pattern: &Symmetric, nodes: &[usize]) -> Result<Vec<usize>, Error> {
    let n = pattern.order();
    let parts = connected_parts(pattern);
    // Compress: point numbers to 0, 1, ... in order of appearance of the freedoms.
    let mut names: Vec<usize> = nodes.to_vec();
    names.sort_unstable();
    names.dedup();
    let node_of: Vec<usize> = nodes
        .iter()
        .map(|p| names.binary_search(p).unwrap_or_default())
        .collect();
    let mut edges: Vec<(u32, u32)> = pattern
        .entries()
        .map(|(i, j, _)| (node_of[i], node_of[j]))
        .filter(|(a, b)| a != b)
        .map(|(a, b)| (a.max(b) as u32, a.min(b) as u32))
        .collect();
    edges.sort_unstable_by_key(|&(row, column)| (column, row));
    edges.dedup();
    let m = names.len();
    let mut columns = vec![0_usize; m + 1];
    for &(_, column) in &edges {
        columns[column as usize + 1] += 1;
    }
    for k in 0..m {
        columns[k + 1] += columns[k];
    }
    let rows: Vec<usize> = edges.iter().map(|e| e.0 as usize).collect();
    let graph = SymbolicSparseColMatRef::new_checked(m, m, &columns, None, &rows);
    let (mut order, mut position) = (vec![0; m], vec![0; m]);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(m, rows.len());
    amd::order_maybe_unsorted(
        &mut order,
        &mut position,
        graph,
        amd::Control::default(),
        MemStack::new(&mut MemBuffer::new(scratch)),
    )
    .map_err(|e| failed(&e))?;
    let mut freedoms: Vec<usize> = (0..n).collect();
    freedoms.sort_by_key(|&i| (parts[i], position[node_of[i]], i));
    Ok(freedoms)
}

/// The connected part of each freedom.
fn connected_parts(pattern: &Symmetric) -> Vec<usize> {
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut parent: Vec<usize> = (0..pattern.order()).collect();
    for (i, j, _) in pattern.entries() {
        let (a, b) = (root(&mut parent, i), root(&mut parent, j));
        parent[a.max(b)] = a.min(b);
    }
    (0..pattern.order()).map(|i| root(&mut parent, i)).collect()
}
