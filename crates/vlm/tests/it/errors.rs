//! Geometries and requests that cannot be solved are typed errors that name the place.

use albatross_avl::geometry::Geometry;
use albatross_avl::run::{RunTarget, RunVariable};
use albatross_vlm::{Condition, Error, Lattice, Method, Solver, Trim};

use crate::models::{aircraft, header, lattice, surface};

fn refused(body: &str) -> Error {
    let text = header("0 0 0", 6.0, 1.0, 6.0, 0.25) + body;
    let (geometry, _) = Geometry::parse(&text, "model.avl").unwrap();
    Lattice::new(&geometry, &|_| None).unwrap_err()
}

#[test]
fn regress_degenerate_sections_are_named() {
    let cases: [(&str, &[&str], usize, &str); 4] = [
        ("4 1 8 1", &["0 0 0 1 0", "0 3 0 0 0"], 2, "chord"),
        ("4 1 8 1", &["0 0 0 1 0", "1 0 0 1 0"], 1, "distance"),
        ("4 1 1 1", &["0 0 0 1 0", "0 1 0 1 0", "0 3 0 1 0"], 1, "Nspan"),
        ("4 1", &["0 0 0 1 0", "0 3 0 1 0"], 1, "Nspan"),
    ];
    for (mesh, sections, number, word) in cases {
        match refused(&surface("w", mesh, "", sections)) {
            Error::Surface {
                surface,
                section,
                problem,
            } => {
                assert_eq!((surface.as_str(), section), ("w", number), "{problem}");
                assert!(problem.contains(word), "{problem}");
            }
            other => panic!("{other}"),
        }
    }
}

#[test]
fn regress_coincident_surfaces_are_singular() {
    let sections = ["0 0 0 1 0", "0 3 0 1 0"];
    let text = header("0 0 0", 6.0, 1.0, 6.0, 0.25)
        + &surface("a", "4 1 8 1", "YDUPLICATE\n0\nCOMPONENT\n1", &sections)
        + &surface("b", "4 1 8 1", "YDUPLICATE\n0\nCOMPONENT\n1", &sections);
    let lattice = lattice(&text);
    let error = Solver::new(&lattice, &Method::AVL_352, 0.0).unwrap_err();
    assert!(matches!(error, Error::Singular { .. }), "{error}");
}

#[test]
fn regress_bad_requests() {
    let lattice = lattice(&aircraft());
    for mach in [1.0, -0.1, f64::NAN] {
        assert!(matches!(
            Solver::new(&lattice, &Method::AVL_352, mach).unwrap_err(),
            Error::Value { .. }
        ));
    }
    let solver = Solver::new(&lattice, &Method::AVL_352, 0.0).unwrap();
    let mut condition = Condition::at_alpha_deg(1.0, &lattice);
    assert!(matches!(
        condition.set_control(&lattice, "spoiler", 1.0).unwrap_err(),
        Error::UnknownControl { .. }
    ));
    condition.controls.pop();
    assert!(matches!(
        solver.solve(&condition).err(),
        Some(Error::Length { .. })
    ));
    assert!(
        solver
            .strip_slopes(&Condition::at_alpha_deg(1.0, &lattice), &[9999])
            .is_err()
    );

    let mut trim = Trim::new(&lattice);
    trim.set(&lattice, &RunVariable::Beta, RunTarget::Alpha, 0.0)
        .unwrap();
    assert!(matches!(
        solver.trim(&trim).err(),
        Some(Error::TargetTwice { .. })
    ));
    // Sideslip does not change the lift of a symmetric aircraft.
    let mut trim = Trim::new(&lattice);
    trim.set(&lattice, &RunVariable::Beta, RunTarget::Lift, 0.5)
        .unwrap();
    assert!(solver.trim(&trim).is_err());
    let mut trim = Trim::new(&lattice);
    trim.set(&lattice, &RunVariable::Alpha, RunTarget::Lift, 40.0)
        .unwrap();
    let error = solver.trim(&trim).err();
    assert!(
        matches!(
            error,
            Some(Error::TrimOutOfRange { .. } | Error::TrimNotConverged { .. })
        ),
        "{error:?}"
    );
}
