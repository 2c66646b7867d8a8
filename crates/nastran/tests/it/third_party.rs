//! Files that other programs and people made. They are not part of this project: the tests read them from the folder
//! that the environment variable ALBATROSS_THIRD_PARTY names, and say when they skip.

use std::path::PathBuf;

use albatross_nastran::frames::Frames;
use albatross_nastran::{Dialect, ModalResults, PointKind, Severity, bdf, f06};
use approx::assert_relative_eq;

fn sample(name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("ALBATROSS_THIRD_PARTY") else {
        println!("skipped: ALBATROSS_THIRD_PARTY is not set, so {name} is not read");
        return None;
    };
    Some(PathBuf::from(folder).join("nastran").join(name))
}

fn no_errors(r: &ModalResults) {
    assert!(
        r.diagnostics.iter().all(|d| d.severity < Severity::Error),
        "{:?}",
        r.diagnostics
    );
}

#[test]
fn val_simcenter_beam() {
    let Some(path) = sample("f1_simcenter2019_beam_modes/beam_modes.f06") else {
        return;
    };
    let r = f06::read(path).unwrap();
    no_errors(&r);
    assert_eq!(r.dialect, Dialect::Simcenter);
    assert_eq!((r.eigenvalues.len(), r.eigenvalues[0].modes.len()), (1, 10));
    assert_eq!(r.eigenvectors.len(), 10);
    assert!(r.eigenvectors.iter().all(|v| v.rows.len() == 12));
    assert_eq!(r.eigenvectors[1].grid(11).unwrap().values[1], 1.0);
    // Normalised to the largest displacement, so the generalised mass is not 1.
    assert_eq!(r.eigenvalues[0].modes[0].generalized_mass, 8.801_022e-3);
    let weight = r.require_weight().unwrap();
    assert_relative_eq!(weight.mass().unwrap(), 2.610_514e-2);
    assert_relative_eq!(weight.center_of_gravity().x, 5.496_071, max_relative = 1e-6);
    // I(S) is diagonal here; the parallel-axis theorem loses a digit.
    let inertia = weight.inertia_about_cg();
    assert_relative_eq!(
        inertia[(1, 1)],
        weight.inertia_s.unwrap()[1][1],
        max_relative = 1e-5
    );
}

#[test]
fn simcenter_deck_has_an_include_that_is_not_there() {
    let Some(path) = sample("f1_simcenter2019_beam_modes/beam_modes.dat") else {
        return;
    };
    let (deck, remarks) = bdf::read(path).unwrap();
    assert_eq!(deck.executive, ["SOL SEMODES"]);
    assert_eq!(deck.params["K6ROT"].as_real(), Some(100.0));
    assert_eq!(deck.eigrl[&1].normalization, "MAX");
    assert_eq!(deck.raw_card_counts(), [("USET", 1)].into());
    let include = remarks.iter().find(|r| r.card == "INCLUDE").unwrap();
    assert!(include.message.contains("cbar_cbeam.blk"), "{include}");
}

#[test]
fn val_nx_fragments() {
    let Some(path) = sample("f2_nx_no_rotations/test_no_rotations.f06") else {
        return;
    };
    let r = f06::read(path).unwrap();
    assert_eq!(r.dialect, Dialect::Nx);
    assert_eq!(r.eigenvectors.len(), 2);
    // The last row of the first vector is of type S and holds three consecutive scalar points; that of the second is
    // of type G, so that the second vector is shorter, which is remarked upon.
    assert!(
        r.diagnostics
            .iter()
            .any(|d| d.message.starts_with("has 4 rows where others")),
        "{:?}",
        r.diagnostics
    );
    let rows = &r.eigenvectors[0].rows;
    assert_eq!(
        rows.iter().map(|row| row.id).collect::<Vec<_>>(),
        [1, 2, 3, 4, 5, 6]
    );
    assert_eq!((rows[4].kind, rows[4].values[0]), (PointKind::Scalar, 11.0));
    assert_eq!(rows[2].translation().map(|t| t.y), Some(8.0));
    assert_eq!(rows[2].rotation(), None);

    let Some(path) = sample("f3_nx_with_rotations/test_with_rotations.f06") else {
        return;
    };
    let r = f06::read(path).unwrap();
    no_errors(&r);
    assert_eq!(r.eigenvectors[0].rows[0].values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    // Its table belongs to another run than its vectors.
    assert!(
        r.diagnostics.iter().any(|d| d.message.contains("the table has")),
        "{:?}",
        r.diagnostics
    );
}

#[test]
fn val_nastran95_plate() {
    let Some(path) = sample("f4_n95_plate/d03012a.out") else {
        return;
    };
    let r = f06::read(path).unwrap();
    no_errors(&r);
    assert_eq!(r.dialect, Dialect::Nastran95);
    assert_eq!(r.eigenvalues[0].modes.len(), 12);
    // The output request names 315 of the 861 grids.
    assert!(
        r.eigenvectors.iter().all(|v| v.rows.len() == 315),
        "{:?}",
        r.eigenvectors.len()
    );
    assert_eq!(r.weights[0].reference_point, 421);
    // Simply supported plate, sin x sin y: the header's frequency against theory's 9.068997E-1 Hz.
    assert_relative_eq!(
        r.eigenvectors[0].frequency_hz.unwrap(),
        0.906_899_7,
        max_relative = 5e-4
    );

    let Some(path) = sample("f4_n95_plate/d03012a.inp") else {
        return;
    };
    let (deck, remarks) = bdf::read(path).unwrap();
    let errors: Vec<_> = remarks.iter().filter(|r| r.severity == Severity::Error).collect();
    assert!(errors.is_empty(), "{errors:?}");
    assert_eq!(deck.grids.len(), 861);
    assert_eq!(deck.raw_card_counts().get("CQUAD1"), Some(&800));
    // GRDSET constrains every grid.
    assert!(
        deck.grids.values().all(|g| g.ps.to_string() == "126"),
        "{:?}",
        deck.grdset
    );
    let frames = Frames::resolve(&deck).unwrap();
    assert_eq!(
        r.eigenvectors_in_basic(&frames).unwrap().len(),
        r.eigenvectors.len()
    );
}
