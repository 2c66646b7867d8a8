//! The mass matrix as blocks: one 6x6 block for each grid, and blocks between grids where elements couple them.

use albatross_nastran::deck::Id;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use std::collections::BTreeMap;

use crate::error::Error;
use crate::mass_properties::MassProperties;
use crate::rigid::rigid_transfer;

/// A grid that carries mass.
#[derive(Debug, Clone, PartialEq)]
pub struct GridMass {
    /// Position in basic axes, m.
    pub position: Vector3<f64>,
    /// Mass about the grid for T1 to T3, R1 to R3 in basic axes: kg, kg m, kg m^2. Symmetric.
    pub matrix: Matrix6<f64>,
}

/// Mass by grid number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MassModel {
    /// Grids with mass.
    pub grids: BTreeMap<Id, GridMass>,
    /// Blocks of different grids: M(a, b) with a < b; M(b, a) is the transpose. Empty for lumped mass.
    pub couplings: BTreeMap<(Id, Id), Matrix6<f64>>,
}

impl MassModel {
    /// Adds a block at a grid.
    pub fn add(&mut self, id: Id, position: Vector3<f64>, matrix: &Matrix6<f64>) {
        let entry = self.grids.entry(id).or_insert(GridMass {
            position,
            matrix: Matrix6::zeros(),
        });
        entry.matrix += matrix;
    }

    /// Adds the block M(a, b) and, by symmetry, M(b, a).
    pub fn couple(&mut self, a: Id, b: Id, matrix: &Matrix6<f64>) {
        let (key, block) = match a.cmp(&b) {
            std::cmp::Ordering::Less => ((a, b), *matrix),
            std::cmp::Ordering::Greater => ((b, a), matrix.transpose()),
            // An element from a grid to itself: both blocks fall on the diagonal.
            std::cmp::Ordering::Equal => {
                if let Some(grid) = self.grids.get_mut(&a) {
                    grid.matrix += matrix + matrix.transpose();
                }
                return;
            }
        };
        *self.couplings.entry(key).or_insert_with(Matrix6::zeros) += block;
    }

    /// Rigid-body mass matrix about `center`, R^T M R with the six rigid shapes R: kg, kg m, kg m^2.
    #[must_use]
    pub fn rigid_mass(&self, center: [f64; 3]) -> [[f64; 6]; 6] {
        let center = Vector3::from(center);
        let shape = |g: &GridMass| rigid_transfer(g.position - center);
        let mut total = Matrix6::zeros();
        for grid in self.grids.values() {
            let r = shape(grid);
            total += r.transpose() * grid.matrix * r;
        }
        for ((a, b), block) in &self.couplings {
            if let (Some(a), Some(b)) = (self.grids.get(a), self.grids.get(b)) {
                let product = shape(a).transpose() * block * shape(b);
                total += product + product.transpose();
            }
        }
        std::array::from_fn(|i| std::array::from_fn(|j| total[(i, j)]))
    }

    /// Mass, centre of gravity and inertia. `None` without mass.
    #[must_use]
    pub fn properties(&self) -> Option<MassProperties> {
        MassProperties::from_rigid_mass(&self.rigid_mass([0.0; 3]), [0.0; 3])
    }

    /// Grids with mass that are not in `present`.
    pub(crate) fn grids_outside(&self, present: impl Fn(Id) -> bool) -> Vec<Id> {
        let massive = |g: &GridMass| g.matrix.iter().any(|&m| m != 0.0);
        self.grids
            .iter()
            .filter(|(id, g)| massive(g) && !present(**id))
            .map(|(&id, _)| id)
            .collect()
    }
}

/// The mass matrix on an ordered list of grids, with products for shapes on that list.
#[derive(Debug, Clone, PartialEq)]
pub struct MassMatrix {
    blocks: Vec<Matrix6<f64>>,
    couplings: Vec<(usize, usize, Matrix6<f64>)>,
}

impl MassMatrix {
    /// The matrix of `model` on `grids`.
    ///
    /// # Errors
    /// [`Error::NoMassMatrix`] that names grids with mass which `grids` lacks.
    pub fn on_grids(model: &MassModel, grids: &[Id]) -> Result<Self, Error> {
        let index: BTreeMap<Id, usize> = grids.iter().enumerate().map(|(i, &id)| (id, i)).collect();
        let outside = model.grids_outside(|id| index.contains_key(&id));
        if !outside.is_empty() {
            return Err(Error::NoMassMatrix {
                operation: "the mean-axes check",
                reason: format!(
                    "grids {} carry mass but have no eigenvector in the results; print them with \
                     DISPLACEMENT(PRINT) = ALL, or a SET that holds them",
                    crate::text::ranges(&outside)
                ),
            });
        }
        let blocks = grids
            .iter()
            .map(|id| model.grids.get(id).map_or_else(Matrix6::zeros, |g| g.matrix))
            .collect();
        let couplings = model
            .couplings
            .iter()
            .filter_map(|((a, b), m)| Some((*index.get(a)?, *index.get(b)?, *m)))
            .collect();
        Ok(Self { blocks, couplings })
    }

    /// Lumped matrix from one symmetric 6x6 block for each grid.
    ///
    /// # Errors
    /// [`Error::BadMassMatrix`] for a block that is not finite or not symmetric to 1e-9 of its largest entry.
    pub fn lumped(blocks: &[[[f64; 6]; 6]]) -> Result<Self, Error> {
        let mut matrices = Vec::with_capacity(blocks.len());
        for (i, block) in blocks.iter().enumerate() {
            let m = Matrix6::from_fn(|r, c| block[r][c]);
            let bad = |problem: &str| Error::BadMassMatrix {
                problem: format!("has at grid index {i} {problem}"),
            };
            if m.iter().any(|x| !x.is_finite()) {
                return Err(bad("an entry that is not finite"));
            }
            if (m - m.transpose()).amax() > 1e-9 * m.amax() {
                return Err(bad("a block that is not symmetric"));
            }
            matrices.push(m);
        }
        Ok(Self {
            blocks: matrices,
            couplings: Vec::new(),
        })
    }

    /// Number of grids.
    #[must_use]
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Whether there are no grids.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Mass of grid `index` for translation, mean of the three directions, kg; 0 for an index out of range.
    #[must_use]
    pub fn translational_mass(&self, index: usize) -> f64 {
        self.blocks
            .get(index)
            .map_or(0.0, |m| (m[(0, 0)] + m[(1, 1)] + m[(2, 2)]) / 3.0)
    }

    /// M phi: momentum and moment of momentum at each grid for a unit rate of the shape.
    #[must_use]
    pub fn apply(&self, shape: &[[f64; 6]]) -> Vec<[f64; 6]> {
        let at = |i: usize| shape.get(i).map_or_else(Vector6::zeros, |s| Vector6::from(*s));
        let mut product: Vec<Vector6<f64>> = self.blocks.iter().enumerate().map(|(i, m)| m * at(i)).collect();
        for &(a, b, ref m) in &self.couplings {
            if let Some(p) = product.get_mut(a) {
                *p += m * at(b);
            }
            if let Some(p) = product.get_mut(b) {
                *p += m.tr_mul(&at(a));
            }
        }
        product.into_iter().map(Into::into).collect()
    }

    /// a^T M b.
    #[must_use]
    pub fn inner(&self, a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
        dot(a, &self.apply(b))
    }
}

/// Sum of products over all grids and components.
pub(crate) fn dot(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(x, y)| x * y)
        .sum()
}

/// Block of a rigid mass `m` whose centre is at `offset` from the grid, with inertia `j` about that centre, all in
/// one set of axes: kinetic energy 1/2 m |T + R x c|^2 + 1/2 R^T J R.
pub(crate) fn rigid_block(m: f64, offset: Vector3<f64>, j: &Matrix3<f64>) -> Matrix6<f64> {
    let mut at_center = Matrix6::zeros();
    at_center
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(Matrix3::identity() * m));
    at_center.fixed_view_mut::<3, 3>(3, 3).copy_from(j);
    let e = rigid_transfer(offset);
    e.transpose() * at_center * e
}
