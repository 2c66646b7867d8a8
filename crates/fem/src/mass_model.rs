//! The mass matrix as blocks: one 6x6 block for each grid, and blocks between grids where elements couple them.

use albatross_nastran::deck::Id;
use nalgebra::{Matrix3, Matrix6, Vector3};
use std::collections::BTreeMap;

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

    /// Grids with mass that are not `present`, ascending.
    #[must_use]
    pub fn grids_outside(&self, present: impl Fn(Id) -> bool) -> Vec<Id> {
        let massive = |g: &GridMass| g.matrix.iter().any(|&m| m != 0.0);
        self.grids
            .iter()
            .filter(|(id, g)| massive(g) && !present(**id))
            .map(|(&id, _)| id)
            .collect()
    }
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
