//! Every strip of the F25-like surrogate on its load reference axis.

use albatross_modal::{BasisOptions, LoadReferenceAxis, ModalBasis, Selection, Station, interpolate};
use albatross_numerics::interp::Method;

use crate::support::{f25_mystran, fixture};

fn basis() -> ModalBasis {
    let (deck, results) = f25_mystran();
    let options = BasisOptions {
        modes: Selection::FirstElastic(20),
        ..BasisOptions::default()
    };
    ModalBasis::from_nastran(&deck, &results, &options).expect("a free aircraft")
}

fn axis(name: &str, center: Option<u32>, first: u32, last: u32) -> LoadReferenceAxis {
    LoadReferenceAxis {
        name: name.into(),
        grids: center.into_iter().chain(first..=last).collect(),
    }
}

/// Aerodynamic centres of a surface from the strip table.
fn stations(surface: &str) -> Vec<Station> {
    let table = std::fs::read_to_string(fixture("f25-like/strips_avl.csv")).expect("the strip table");
    let mut rows = table.lines().filter(|l| !l.starts_with('#'));
    let header: Vec<&str> = rows.next().expect("a heading").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("a column");
    let (x, y, z) = (column("x_ac"), column("y"), column("z_le"));
    let number = |row: &[&str], i: usize| row[i].parse::<f64>().expect("a number");
    rows.map(|l| l.split(',').collect::<Vec<_>>())
        .filter(|r| r[0] == surface)
        .map(|r| Station {
            x: number(&r, x),
            y: number(&r, y),
            z: number(&r, z),
        })
        .collect()
}

#[test]
fn val_all_surfaces_find_their_axes() {
    let basis = basis();
    for (surface, axis, count) in [
        ("Wing", axis("right wing", Some(1000), 1001, 1025), 73),
        ("Wing (YDUP)", axis("left wing", Some(1000), 2001, 2025), 73),
        ("HTP", axis("right tail", Some(4000), 4001, 4008), 15),
        ("HTP (YDUP)", axis("left tail", Some(4000), 5001, 5008), 15),
        ("VTP", axis("fin", None, 6000, 6007), 20),
        ("Nacelle", axis("right engine", None, 7002, 7002), 12),
    ] {
        let stations = stations(surface);
        assert_eq!(stations.len(), count, "{surface}");
        for method in [Method::Cubic, Method::Pchip, Method::Linear] {
            let shapes = interpolate(&basis, &axis, &stations, method).expect(surface);
            assert_eq!((shapes.phi_z().nrows(), shapes.phi_z().ncols()), (count, 20));
            assert!(shapes.notes.is_empty(), "{surface}: {:?}", shapes.notes);
        }
    }
}

/// A station on a grid has the grid's printed motion, with every method.
#[test]
fn val_stations_at_grids_have_the_printed_motion() {
    let basis = basis();
    let axis = axis("right wing", Some(1000), 1001, 1025);
    let stations: Vec<Station> = axis
        .grids
        .iter()
        .map(|&id| basis.grids[basis.grid_index(id).expect("in the basis")].position)
        .map(|[x, y, z]| Station { x, y, z })
        .collect();
    for method in [Method::Cubic, Method::Pchip, Method::Linear] {
        let shapes = interpolate(&basis, &axis, &stations, method).expect("on the axis");
        for (j, (&id, station)) in axis.grids.iter().zip(&stations).enumerate() {
            assert!((shapes.x_lra[j] - station.x).abs() < 1e-12);
            for (k, printed) in basis.shape_at(id).expect("in the basis").iter().enumerate() {
                for d in 0..3 {
                    assert!((shapes.translation[d][(j, k)] - printed[d]).abs() < 1e-14);
                    assert!((shapes.rotation[d][(j, k)] - printed[d + 3]).abs() < 1e-14);
                }
            }
        }
    }
}

/// Left and right strips of a symmetric mode move alike, of an antisymmetric mode oppositely.
#[test]
fn val_mirrored_strips_move_by_the_class_of_the_mode() {
    let basis = basis();
    let right = interpolate(
        &basis,
        &axis("r", Some(1000), 1001, 1025),
        &stations("Wing"),
        Method::Cubic,
    )
    .expect("right");
    let left = interpolate(
        &basis,
        &axis("l", Some(1000), 2001, 2025),
        &stations("Wing (YDUP)"),
        Method::Cubic,
    )
    .expect("left");
    for (k, mode) in basis.modes.iter().enumerate() {
        let sign = mode.symmetry_measure.signum();
        let tip = right.phi_z()[(72, k)].abs();
        for j in 0..73 {
            // Seven printed digits of the largest entry, which the fitted spline may double.
            assert!(
                (right.phi_z()[(j, k)] - sign * left.phi_z()[(j, k)]).abs() < 2e-6 * tip.max(0.01),
                "mode {}",
                mode.number
            );
            assert!((right.gamma_y()[(j, k)] - sign * left.gamma_y()[(j, k)]).abs() < 2e-6 * tip.max(0.01));
        }
    }
}

/// The three methods agree where the grids resolve the mode: the first wing bending within 1 % of the tip.
#[test]
fn val_methods_agree_on_a_resolved_mode() {
    let basis = basis();
    let axis = axis("right wing", Some(1000), 1001, 1025);
    let at = |method| interpolate(&basis, &axis, &stations("Wing"), method).expect("on the axis");
    let (cubic, pchip, linear) = (at(Method::Cubic), at(Method::Pchip), at(Method::Linear));
    let tip = cubic.phi_z()[(72, 0)].abs();
    for j in 0..73 {
        assert!((cubic.phi_z()[(j, 0)] - pchip.phi_z()[(j, 0)]).abs() < 1e-3 * tip);
        assert!((cubic.phi_z()[(j, 0)] - linear.phi_z()[(j, 0)]).abs() < 1e-2 * tip);
    }
}
