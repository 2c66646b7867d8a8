//! Modes of a deck, lattice of a geometry, and a case from both alone.

use crate::support::{CaseCopy, albatross, case, failure, fixtures, json};
use serde_json::Value;

fn fixture(name: &str) -> String {
    fixtures().join(name).display().to_string()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect()
}

/// Frequencies as MYSTRAN prints them, and the listing as a results file that the other commands take.
#[test]
fn val_modes_of_the_deck_and_their_listing() {
    let deck = fixture("f25-like/f25.bdf");
    let folder = tempfile::tempdir().unwrap();
    let listing = folder.path().join("own.f06").display().to_string();
    let arguments = [
        "solve-modes",
        &deck,
        "--modes",
        "26",
        "--json",
        "--quiet",
        "--f06",
        &listing,
    ];
    let found = json(&arguments);
    let f = numbers(&found["frequencies_hz"]);
    assert_eq!(f.len(), 26);
    assert!(f[..6].iter().all(|f| *f < 1e-4) && (f[6] / 2.430880 - 1.0).abs() < 1e-6);
    assert!((found["mass"].as_f64().unwrap() - 81018.49).abs() < 1e-3);
    let of = |results: &str| {
        json(&[
            "modes",
            "--deck",
            &deck,
            "--results",
            results,
            "--json",
            "--quiet",
        ])
    };
    let (own, mystran) = (of(&listing), of(&fixture("f25-like/f25.f06")));
    for k in 0..20 {
        let at = |v: &Value| v["modes"][k]["frequency_hz"].as_f64().unwrap();
        assert!((at(&own) / at(&mystran) - 1.0).abs() < 1e-6);
    }
}

#[test]
fn val_lumped_and_coupled_mass_differ() {
    let deck = fixture("nastran/cant.bdf");
    let first = |mass: &str| {
        numbers(
            &json(&[
                "solve-modes",
                &deck,
                "--mass",
                mass,
                "--modes",
                "3",
                "--json",
                "--quiet",
            ])["frequencies_hz"],
        )[0]
    };
    let (lumped, coupled) = (first("lumped"), first("coupled"));
    assert!(lumped < coupled && coupled / lumped < 1.01, "{lumped} {coupled}");
}

/// The trimmed run of AVL 3.52, and files that AVL's own readers take.
#[test]
fn val_lattice_trimmed_as_avl() {
    let folder = tempfile::tempdir().unwrap();
    let prefix = folder.path().join("own").display().to_string();
    let found = json(&[
        "vlm",
        &fixture("f25-like/f25.avl"),
        "--cl",
        "0.5644",
        "--trim",
        "elevator=Cm",
        "--json",
        "--quiet",
        "--write",
        &prefix,
    ]);
    let avl = std::fs::read_to_string(fixture("f25-like/avl_out/trim.st")).unwrap();
    let avl = albatross::avl::results::StabilityDerivatives::parse(&avl, "trim.st").unwrap();
    for (key, expected, places) in [
        ("CLtot", avl.run.c_lift, 5e-6),
        ("CDind", avl.run.c_drag_induced, 5e-7),
        ("Alpha", avl.run.alpha_deg, 5e-6),
        ("CLa", avl.alpha.lift, 5e-7),
        ("Cnb", avl.beta.yaw, 5e-7),
        ("CLd03", avl.controls[2].column.lift, 5e-7),
    ] {
        let own = found[key].as_f64().unwrap();
        assert!(
            (own - expected).abs() <= 1.01 * places,
            "{key}: {own} against {expected}"
        );
    }
    assert_eq!(found["strips"].as_array().unwrap().len(), 220);
    for ending in ["st", "ft", "fs"] {
        let text = std::fs::read_to_string(format!("{prefix}.{ending}")).unwrap();
        assert!(
            albatross::avl::results::parse_any(&text, ending).is_ok(),
            "{ending}"
        );
    }
}

#[test]
fn val_lattice_refuses_with_the_cure() {
    let geometry = fixture("f25-like/f25.avl");
    let unknown = failure(&["vlm", &geometry, "--set", "flap=2"]);
    assert!(
        unknown.contains("f25.avl") && unknown.contains("elevator"),
        "{unknown}"
    );
    let malformed = failure(&["vlm", &geometry, "--trim", "elevator=Cz"]);
    assert!(malformed.contains("CL, CY, Cl, Cm, Cn"), "{malformed}");
    let twice = failure(&["vlm", &geometry, "--trim", "elevator=Cm", "--trim", "rudder=Cm"]);
    assert!(twice.contains("Cm") && twice.contains("rudder"), "{twice}");
}

/// The issue of a case from deck and geometry alone: the trim and the short period of the case from files.
#[test]
fn val_case_from_deck_and_geometry() {
    let solved = fixture("f25-like/case_solve.toml");
    let trim = |case: &str| json(&["trim", case, "--json", "--quiet"]);
    let (own, files) = (trim(&solved), trim(&case()));
    let alpha = |v: &Value| v["alpha_deg"].as_f64().unwrap();
    assert!((alpha(&own) - alpha(&files)).abs() < 1e-4);
    let copy = CaseCopy::new();
    copy.replace(
        "case_solve.toml",
        "results = \"solve\"            # vortex",
        "results = \"solved\"            # vortex",
    );
    let refused = failure(&["trim", &copy.arg("case_solve.toml")]);
    assert!(
        refused.contains("results is \"solved\"") && refused.contains("results = \"solve\""),
        "{refused}"
    );
    copy.replace(
        "case.toml",
        "shape_reference",
        "results = \"solve\"\nshape_reference",
    );
    let both = failure(&["trim", &copy.arg("case.toml")]);
    assert!(both.contains("`derivatives`"), "{both}");
    // A lattice beside files is refused unless its slopes between strips are wanted.
    let copy = CaseCopy::new();
    copy.replace(
        "case.toml",
        "shape_reference",
        "lattice = { method = \"avl332\" }\nshape_reference",
    );
    let idle = failure(&["trim", &copy.arg("case.toml")]);
    assert!(idle.contains("[aerodynamics.lattice] is given"), "{idle}");
    copy.replace(
        "case.toml",
        "shape_reference",
        "lift_slopes = \"lattice\"\nshape_reference",
    );
    assert!((alpha(&trim(&copy.arg("case.toml"))) - alpha(&files)).abs() < 1e-4);
}

/// Lift between strips: no wing strip is lifted by its own incidence as much as by that of the whole aircraft less what
/// the others wash it, and the first symmetric bending loses frequency against one slope a strip.
#[test]
fn val_lift_between_strips_changes_modes() {
    let copy = CaseCopy::new();
    let modes = |copy: &CaseCopy| {
        let table = json(&["modes-table", &copy.arg("case_solve.toml"), "--json", "--quiet"]);
        let first = &table["elastic"][0];
        [
            first["omega_rad_s"].as_f64().unwrap(),
            first["damping_ratio"].as_f64().unwrap(),
        ]
    };
    let own = modes(&copy);
    copy.replace(
        "case_solve.toml",
        "shape_reference",
        "lift_slopes = \"lattice\"\nshape_reference",
    );
    let between = modes(&copy);
    // The doublet-lattice reference: 18.470 rad/s, 0.1058 (fixtures/f25-like/reference).
    assert!(
        (between[0] - 18.470).abs() < 0.05 && (own[0] - 18.470).abs() > 0.5,
        "{own:?} {between:?}"
    );
    assert!((between[1] - 0.1058).abs() < 0.006 && (own[1] - 0.1058).abs() > 0.02);
}

#[test]
fn val_unknown_elements_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plate.bdf");
    let text = std::fs::read_to_string(fixture("nastran/cant.bdf")).unwrap();
    let text = text.replace("ENDDATA", "CQUAD4,900,1,1,2,3,4\nENDDATA");
    std::fs::write(&path, text).unwrap();
    let path = path.display().to_string();
    let refused = failure(&["solve-modes", &path]);
    assert!(
        refused.contains("1 CQUAD4") && refused.contains("plate.bdf"),
        "{refused}"
    );
    let output = albatross(&["solve-modes", &path, "--leave-out-unknown"]);
    assert!(output.status.success());
}
