//! Geometries and requests that cannot be solved are typed errors that name the place.

use albatross_avl::geometry::Geometry;
use albatross_avl::run::{RunTarget, RunVariable};
use albatross_vlm::{Condition, Error, Lattice, Method, Solver, Trim};

use proptest::prelude::*;

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

/// Numbers that make geometries degenerate.
fn hostile() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        Just(-1.0),
        Just(1e-30),
        Just(1e30),
        Just(1e300),
        -3.0..3.0_f64
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any geometry is solved to finite numbers or refused.
    #[test]
    fn prop_hostile_geometry_never_panics(
        v in prop::collection::vec(hostile(), 12), n_chord in 0_usize..4, n_span in 0_usize..5,
        spacing in -4.0..4.0_f64, duplicate in any::<bool>(), symmetry in -1..2_i32,
    ) {
        let keywords = if duplicate { "YDUPLICATE\n0" } else { "" };
        let section = |k: usize| format!(
            "{} {} {} {} {}\nCONTROL\nflap {} {} 0 0 0 1\nCLAF\n{}", v[k], v[k + 1], v[k + 2], v[k + 3], v[k + 4],
            v[k + 5], v[(k + 6) % 12], v[(k + 7) % 12],
        );
        let text = header(&format!("{symmetry} 0 0"), 6.0, 1.0, 6.0, 0.25)
            + &surface("w", &format!("{n_chord} {spacing} {n_span} {spacing}"), keywords, &[&section(0), &section(6)]);
        let Ok((geometry, _)) = Geometry::parse(&text, "hostile.avl") else { return Ok(()) };
        let Ok((lattice, _)) = Lattice::new(&geometry, &|_| None) else { return Ok(()) };
        let Ok(solver) = Solver::new(&lattice, &Method::AVL_332, 0.3) else { return Ok(()) };
        let mut condition = Condition::at_alpha_deg(3.0, &lattice);
        condition.beta_rad = 0.1;
        let Ok(solution) = solver.solve(&condition) else { return Ok(()) };
        let _ = (solution.stability_derivatives(""), solution.strip_forces(), solution.element_forces());
        let _ = solver.trim(&Trim::new(&lattice));
    }
}
