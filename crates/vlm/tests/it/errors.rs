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

/// What a lattice says of its own places is believed by all that follows.
#[test]
fn regress_altered_lattices_are_refused() {
    type Alter = fn(&mut Lattice);
    let alterations: [(&str, Alter); 16] = [
        ("vortex.strip", |l| l.vortices[3].strip = l.strips.len()),
        ("vortex.strip", |l| l.vortices[3].strip = usize::MAX),
        ("strip.surface", |l| l.strips[1].surface = l.surfaces.len()),
        ("strip.vortices", |l| l.strips[1].vortices.end = usize::MAX),
        ("strip.vortices", |l| l.strips[1].vortices.start = usize::MAX),
        ("surface.strips", |l| {
            l.surfaces[0].strips.end = l.strips.len() + 1
        }),
        ("surface.strips", |l| l.surfaces[0].strips.start = usize::MAX),
        ("control panel", |l| {
            l.controls[0].panels[0].vortex = l.vortices.len()
        }),
        ("design panel", |l| l.designs[0].panels[0].vortex = usize::MAX),
        ("no vortices", |l| l.vortices.clear()),
        ("no strips", |l| l.strips.clear()),
        ("no surfaces", |l| l.surfaces.clear()),
        ("s_ref", |l| l.reference.s_ref = 0.0),
        ("c_ref", |l| l.reference.c_ref = -1.0),
        ("b_ref", |l| l.reference.b_ref = f64::INFINITY),
        ("z_ref", |l| l.reference.z_ref = f64::NAN),
    ];
    let sound = lattice(&aircraft());
    assert_eq!(sound.check(), Ok(()));
    for (what, alter) in alterations {
        let mut altered = sound.clone();
        alter(&mut altered);
        let error = Solver::new(&altered, &Method::AVL_352, 0.0).unwrap_err();
        let expected = match error {
            Error::Length { .. } => !what.ends_with("ref"),
            Error::Value { .. } => what.ends_with("ref"),
            _ => false,
        };
        assert!(expected, "{what}: {error}");
    }
}

/// Numbers of nodes and lines that multiply the work without end.
#[test]
fn regress_geometries_without_bounds_are_refused() {
    let wing = surface("w", "4 1 8 1", "", &["0 0 0 1 0", "0 3 0 1 0"]);
    let body = |nodes: usize, more: &str| format!("BODY\nb\n{nodes} 1.0\n{more}BFILE\nnone.dat\n");
    let lines = |line: &str, count: usize| {
        let section = format!("0 0 0 1 0\n{}", line.repeat(count));
        surface("w", "4 1 8 1", "", &[&section, "0 3 0 1 0"])
    };
    let cases = [
        (wing.clone() + &body(9000, "").repeat(3), "number of nodes"),
        (
            wing.clone() + &body(9000, "YDUPLICATE\n0\n").repeat(2),
            "number of nodes",
        ),
        (lines("CONTROL\nflap 1.0 0.7 0 0 0 1\n", 1001), "CONTROL"),
        (lines("DESIGN\ntwist 1.0\n", 1001), "DESIGN"),
    ];
    for (text, word) in cases {
        let error = refused(&text);
        assert!(
            matches!(&error, Error::Value { what, .. } if what.contains(word)),
            "{error}"
        );
    }
    let (geometry, _) = Geometry::parse(
        &(header("0 0 0", 6.0, 1.0, 6.0, 0.25) + &wing + &body(10_000, "").repeat(2)),
        "b.avl",
    )
    .unwrap();
    assert!(Lattice::new(&geometry, &|_| None).is_ok());
}

/// A trim to nothing is not converged, threads have a bound, and each strip is asked for once.
#[test]
fn regress_requests_without_sense_are_refused() {
    let mut sound = lattice(&aircraft());
    let method = Method {
        threads: usize::MAX,
        ..Method::AVL_352
    };
    let solver = Solver::new(&sound, &method, 0.0).unwrap();
    assert_eq!(solver.method().threads, Method::MOST_THREADS);
    let condition = Condition::at_alpha_deg(1.0, &sound);
    let many = vec![0; sound.strips.len() + 1];
    assert!(matches!(
        solver.strip_slopes(&condition, &many),
        Err(Error::Length { .. })
    ));
    for value in [f64::NAN, f64::INFINITY] {
        for kind in [RunTarget::Lift, RunTarget::Alpha] {
            let mut trim = Trim::new(&sound);
            trim.set(&sound, &RunVariable::Alpha, kind, value).unwrap();
            assert!(matches!(solver.trim(&trim).err(), Some(Error::Value { .. })));
        }
    }
    // The header's drag enters the side force.
    let mut trim = Trim::new(&sound);
    trim.set(&sound, &RunVariable::Beta, RunTarget::SideForce, 0.0)
        .unwrap();
    sound.cd_p = f64::NAN;
    let solver = Solver::new(&sound, &Method::AVL_352, 0.0).unwrap();
    let error = solver.trim(&trim).err();
    assert!(
        matches!(&error, Some(Error::TrimNotConverged { iterations: 0, residual, .. }) if residual.is_nan()),
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
