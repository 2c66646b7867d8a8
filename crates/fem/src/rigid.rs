//! The six rigid motions of a point, and the frame they live in.

use nalgebra::{Matrix3, Matrix6, Vector3};

/// Names of the six rigid motions, in the order of every 6-vector of this crate.
pub const RIGID_DIRECTIONS: [&str; 6] = [
    "translation x",
    "translation y",
    "translation z",
    "rotation x",
    "rotation y",
    "rotation z",
];

/// Cross-product matrix: `skew(a) b = a x b`.
pub(crate) fn skew(a: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// Motion of a point at `arm` from a rigidly connected reference: `[T; R] = E [T_ref; R_ref]`, that is
/// `T = T_ref + R_ref x arm`, `R = R_ref`.
pub(crate) fn rigid_transfer(arm: Vector3<f64>) -> Matrix6<f64> {
    let mut e = Matrix6::identity();
    e.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(arm));
    e
}

/// Both triples of a 6-vector turned from a local frame, whose unit vectors are the columns of `axes`, to basic.
pub(crate) fn rotation_blocks(axes: &Matrix3<f64>) -> Matrix6<f64> {
    let mut a = Matrix6::zeros();
    a.fixed_view_mut::<3, 3>(0, 0).copy_from(axes);
    a.fixed_view_mut::<3, 3>(3, 3).copy_from(axes);
    a
}

/// Shape of unit rigid motion `direction` (0 to 5, see [`RIGID_DIRECTIONS`]) about `center` on points at
/// `positions`: T1 to T3 in m, R1 to R3 in rad, structural axes.
#[must_use]
pub fn rigid_shape(direction: usize, center: [f64; 3], positions: &[[f64; 3]]) -> Vec<[f64; 6]> {
    let center = Vector3::from(center);
    positions
        .iter()
        .map(|&p| {
            let e = rigid_transfer(Vector3::from(p) - center);
            std::array::from_fn(|i| e.get((i, direction)).copied().unwrap_or(0.0))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_nose_up_rotation_moves_the_tail_down() {
        // x aft, z up: a point 2 m behind the centre goes down for R2 > 0, and a point 3 m above it goes aft.
        let shape = rigid_shape(4, [1.0, 0.0, 0.0], &[[3.0, 0.0, 0.0], [1.0, 0.0, 3.0]]);
        assert_eq!(shape[0], [0.0, 0.0, -2.0, 0.0, 1.0, 0.0]);
        assert_eq!(shape[1], [3.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    }
}
