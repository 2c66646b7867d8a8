//! Displacement systems: the basis does not depend on the axes in which the program printed its vectors.

use albatross_modal::{BasisOptions, ModalBasis, Selection};
use albatross_nastran::deck::{CoordinateDefinition, CoordinateKind, CoordinateSystem};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::support::{f25_mystran, largest, largest_difference};

/// Unit vectors, as columns, of the displacement components at a position in each of the three systems below; by
/// geometry, not by the reader's code.
fn axes(cd: u32, position: Vector3<f64>, skewed: &Matrix3<f64>) -> Matrix3<f64> {
    match cd {
        90 => *skewed,
        // Cylinder about the line x = 2, z = -3 along basic y: radial, tangential (y x r), axial.
        91 => {
            let radial = Vector3::new(position.x - 2.0, 0.0, position.z + 3.0).normalize();
            Matrix3::from_columns(&[radial, Vector3::y().cross(&radial), Vector3::y()])
        }
        _ => Matrix3::identity(),
    }
}

#[test]
fn val_turned_displacement_systems_give_the_same_basis() {
    let (mut deck, mut results) = f25_mystran();
    let options = BasisOptions {
        modes: Selection::FirstElastic(20),
        ..BasisOptions::default()
    };
    let plain = ModalBasis::from_nastran(&deck, &results, &options).expect("a free aircraft");

    let skewed = Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner();
    let origin = Vector3::new(5.0, 1.0, 2.0);
    let skewed_points = [origin, origin + skewed.column(2), origin + skewed.column(0)].map(Into::into);
    // z along basic y through (2, 0, -3); the half plane of theta = 0 towards basic x.
    let cylinder_points = [[2.0, 0.0, -3.0], [2.0, 1.0, -3.0], [3.0, 0.0, -3.0]];
    for (id, kind, [a, b, c]) in [
        (90, CoordinateKind::Rectangular, skewed_points),
        (91, CoordinateKind::Cylindrical, cylinder_points),
    ] {
        let definition = CoordinateDefinition::Points {
            reference: 0,
            a,
            b,
            c,
        };
        deck.coordinate_systems
            .insert(id, CoordinateSystem { id, kind, definition });
    }
    let cd_of = |id: u32| [0, 90, 91][id as usize % 3];
    deck.grids.values_mut().for_each(|g| g.cd = cd_of(g.id));
    for row in results.eigenvectors.iter_mut().flat_map(|v| &mut v.rows) {
        let cd = cd_of(row.id);
        let local = axes(cd, Vector3::from(deck.grids[&row.id].position), &skewed).transpose();
        let (t, r) = (
            row.translation().expect("printed"),
            row.rotation().expect("printed"),
        );
        let (t, r) = (local * t, local * r);
        row.values = [t.x, t.y, t.z, r.x, r.y, r.z];
        row.cd = Some(cd);
    }

    let turned = ModalBasis::from_nastran(&deck, &results, &options).expect("the same aircraft");
    assert_eq!(turned.grids, plain.grids);
    for (a, b) in plain.modes.iter().zip(&turned.modes) {
        assert!(largest_difference(&a.shape, &b.shape) < 1e-14 * largest(&a.shape).max(1.0));
        assert_eq!(a.symmetry, b.symmetry);
    }
    assert_eq!(turned.mass, plain.mass);
    assert!(turned.notes.is_empty(), "{:?}", turned.notes);

    // A deck whose CD is not that of the results is refused.
    deck.grids.values_mut().for_each(|g| g.cd = 0);
    let error = ModalBasis::from_nastran(&deck, &results, &options)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("is printed in system 90, but has CD = 0 in the deck"),
        "{error}"
    );
}
