//! Mass, centre of gravity and inertia of a rigid aircraft.

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use crate::rigid::skew;

/// Where mass properties come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum MassSource {
    /// Sum over the mass cards of the deck, R^T M R.
    Deck,
    /// The grid point weight generator's table in the results: as many digits as it prints.
    GridPointWeight,
    /// Given by the caller.
    Given,
}

/// Mass properties in structural axes (x aft, y right, z up).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of gravity, m.
    pub cg: [f64; 3],
    /// Inertia tensor about the centre of gravity, kg m^2; products with the tensor's sign,
    /// J_xz = -int(x z dm).
    pub inertia: [[f64; 3]; 3],
    /// Where the numbers come from.
    pub source: MassSource,
}

impl MassProperties {
    /// From the rigid-body mass matrix `[m 1, -m c~; m c~, J_o]` about `reference`. `None` without mass.
    ///
    /// The centre is read from the antisymmetric blocks and J = J_o + m c~ c~ (parallel axes).
    #[must_use]
    pub fn from_rigid_mass(mo: &[[f64; 6]; 6], reference: [f64; 3]) -> Option<Self> {
        let mass = (mo[0][0] + mo[1][1] + mo[2][2]) / 3.0;
        if mass.is_nan() || mass <= 0.0 {
            return None;
        }
        // m c~ stands in the lower left block: rows are moments, columns translations.
        let c = Vector3::new(mo[5][1] - mo[4][2], mo[3][2] - mo[5][0], mo[4][0] - mo[3][1]) / (2.0 * mass);
        let about_reference = Matrix3::from_fn(|i, j| mo[i + 3][j + 3]);
        let inertia = about_reference + skew(c) * skew(c) * mass;
        let cg = Vector3::from(reference) + c;
        Some(Self {
            mass,
            cg: cg.into(),
            inertia: std::array::from_fn(|i| {
                std::array::from_fn(|j| 0.5 * (inertia[(i, j)] + inertia[(j, i)]))
            }),
            source: MassSource::Deck,
        })
    }

    /// Inertia tensor about the centre of gravity in body axes (x forward, y right, z down), kg m^2. Body axes are
    /// the structural axes turned by 180 degrees about y, so J_xy and J_yz change sign and J_xz does not.
    #[must_use]
    pub fn inertia_body_axes(&self) -> [[f64; 3]; 3] {
        let sign = [-1.0, 1.0, -1.0];
        std::array::from_fn(|i| std::array::from_fn(|j| sign[i] * sign[j] * self.inertia[i][j]))
    }

    /// Position of a point of the structure in body axes from the centre of gravity, m:
    /// x_b = -(x - x_cg), y_b = y - y_cg, z_b = -(z - z_cg).
    #[must_use]
    pub fn to_body_axes(&self, position: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = position;
        let [cx, cy, cz] = self.cg;
        [-(x - cx), y - cy, -(z - cz)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass_model::{MassModel, rigid_block};

    /// Two point masses: centre and inertia by the definition sums.
    #[test]
    fn val_two_point_masses() {
        let points = [
            (3.0, Vector3::new(1.0, 2.0, -1.0)),
            (1.0, Vector3::new(5.0, -2.0, 3.0)),
        ];
        let mut model = MassModel::default();
        for (k, (m, p)) in points.iter().enumerate() {
            model.add(
                k as u32 + 1,
                *p,
                &rigid_block(*m, Vector3::zeros(), &Matrix3::zeros()),
            );
        }
        let got = model.properties().expect("has mass");
        let mass = 4.0;
        let c = (points[0].1 * 3.0 + points[1].1) / mass;
        let mut j = Matrix3::zeros();
        for (m, p) in points {
            let r = p - c;
            j += (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * m;
        }
        assert_eq!(got.mass, mass);
        for i in 0..3 {
            assert!((got.cg[i] - c[i]).abs() < 1e-14);
            for k in 0..3 {
                assert!((got.inertia[i][k] - j[(i, k)]).abs() < 1e-12);
            }
        }
        let body = got.inertia_body_axes();
        assert_eq!(body[0][2], got.inertia[0][2]);
        assert_eq!(body[0][1], -got.inertia[0][1]);
        assert_eq!(body[1][2], -got.inertia[1][2]);
        assert_eq!(got.to_body_axes([0.0; 3]), [c.x, -c.y, c.z]);
    }

    #[test]
    fn no_mass_no_properties() {
        assert_eq!(MassModel::default().properties(), None);
    }
}
