//! Other analyses: a stick aircraft in two programs, a free and a clamped beam, and third-party files.

use albatross_modal::{
    BarMass, BasisOptions, DeckMass, MeanAxes, ModalBasis, OnViolation, Selection, Symmetry, mac, pair_modes,
};
use albatross_nastran::frames::Frames;
use albatross_nastran::{bdf, f06};
use std::f64::consts::PI;
use std::path::PathBuf;

use crate::support::{deck, results};

fn options(modes: Selection) -> BasisOptions {
    BasisOptions {
        modes,
        ..BasisOptions::default()
    }
}

fn checked(basis: &ModalBasis) -> &albatross_modal::MeanAxesCheck {
    match &basis.mean_axes {
        MeanAxes::Checked(check) => check,
        MeanAxes::Refused { reason } => panic!("{reason}"),
    }
}

/// The stick aircraft has rigid stubs whose dependents appear in the output with no mass of their own.
#[test]
fn val_stick_aircraft_in_two_programs() {
    let deck = deck("nastran/stick.bdf");
    let of = |name| ModalBasis::from_nastran(&deck, &results(name), &options(Selection::FirstElastic(18)));
    let (a, b) = (
        of("nastran/stick.f06").expect("MYSTRAN"),
        of("nastran/stick95.out").expect("NASTRAN-95"),
    );
    assert_eq!(a.modes[0].number, 7);
    assert!((a.mass.expect("known").mass / 62_109.99 - 1.0).abs() < 1e-6);
    for basis in [&a, &b] {
        assert!(checked(basis).worst < 1e-7, "{}", basis.mean_axes_summary());
    }
    let mac = mac(&a, &b).expect("same grids");
    for (k, pair) in pair_modes(mac.as_ref(), 0.99).iter().enumerate() {
        assert_eq!((pair.first, pair.second), (k, k));
        assert!(1.0 - pair.mac < 1e-10);
        assert!((a.modes[k].frequency_hz / b.modes[k].frequency_hz - 1.0).abs() < 1e-6);
        assert!(a.modes[k].symmetry_measure.abs() > 0.999);
    }
}

/// A free uniform beam: bar mass alone. Frequencies of Euler's beam, (beta L)^2 sqrt(EI / (mu L^4)), to the error of
/// lumping 40 elements; the mean-axes check to the printed digits.
#[test]
fn val_free_beam_of_bars() {
    let basis = ModalBasis::from_nastran(
        &deck("nastran/free.bdf"),
        &results("nastran/free.f06"),
        &options(Selection::All),
    )
    .expect("a free beam");
    assert!(checked(&basis).worst < 1e-7, "{}", basis.mean_axes_summary());
    let mass = basis.mass.expect("known");
    assert!((mass.mass - 27.0).abs() < 1e-12);
    assert!((mass.cg[0] - 1.0).abs() < 1e-12);
    let first = |i: f64| 4.730_040_745_f64.powi(2) / (2.0 * PI * 4.0) * (7e10 * i / 13.5).sqrt();
    let weak = basis.modes[0].frequency_hz;
    assert!((weak / first(1.041_666_667e-6) - 1.0).abs() < 3e-3, "{weak}");
    assert_eq!(basis.modes[0].symmetry, Symmetry::Mixed);
}

/// A clamped beam has no rigid freedom: nothing to check, nothing refused, and mode 1 is elastic.
#[test]
fn val_clamped_beam_has_no_mean_axes() {
    let basis = ModalBasis::from_nastran(
        &deck("nastran/cant.bdf"),
        &results("nastran/cant.f06"),
        &options(Selection::All),
    )
    .expect("a clamped beam");
    assert_eq!(basis.modes[0].number, 1);
    assert_eq!(checked(&basis).free_directions, [false; 6]);
    assert!(
        basis.notes.iter().any(|n| n.contains("no mean axes to check")),
        "{:?}",
        basis.notes
    );
}

/// Clamped modes on a free deck (the case control lost its SPC) are caught by the check.
#[test]
fn clamped_modes_are_refused_for_flight() {
    let mut free = deck("nastran/cant.bdf");
    free.case_control.retain(|l| !l.to_uppercase().contains("SPC"));
    let results = results("nastran/cant.f06");
    let error = ModalBasis::from_nastran(&free, &results, &options(Selection::FirstElastic(4))).unwrap_err();
    assert!(error.to_string().contains("is not a mean-axes mode"), "{error}");
    let mut orthogonalise = options(Selection::FirstElastic(4));
    orthogonalise.on_violation = OnViolation::Orthogonalise;
    let basis = ModalBasis::from_nastran(&free, &results, &orthogonalise).expect("made free");
    let worst = checked(&basis)
        .coupling
        .iter()
        .flatten()
        .fold(0.0_f64, |a, &b| a.max(b));
    assert!(worst < 1e-12, "{worst:e}");
    // First bending of a clamped beam about its mean axes is stiffer: less mass moves against the same stiffness.
    assert!(basis.modes[0].omega_rad_s > 2.0 * results.eigenvalues[0].modes[0].omega_rad_s);
}

fn third_party(name: &str) -> Option<PathBuf> {
    let found =
        std::env::var_os("ALBATROSS_THIRD_PARTY").map(|root| PathBuf::from(root).join("nastran").join(name));
    let found = found.filter(|path| path.exists());
    if found.is_none() {
        println!("skipped: set ALBATROSS_THIRD_PARTY to the folder that holds nastran/{name}");
    }
    found
}

/// Simcenter Nastran's weight generator for nine CBAR, one CBEAM (with inertia about its axis) and a CONM2. The deck
/// is recovered from the sorted echo, since an included file is not at hand.
#[test]
fn val_mass_matrix_against_simcenter() {
    let Some(path) = third_party("f1_simcenter2019_beam_modes/beam_modes.f06") else {
        return;
    };
    let text = std::fs::read_to_string(&path).expect("readable");
    // "                    1-        CBAR    1  ...": a count up to column 21, a dash, the card from column 31.
    let is_echo = |l: &&str| {
        let count = l.get(..21).is_some_and(|n| n.trim().parse::<u32>().is_ok());
        count && l.get(21..22) == Some("-")
    };
    let echo = text.lines().filter(is_echo).filter_map(|l| l.get(30..));
    let bulk: Vec<String> = echo.map(|l| l.trim_end().to_string()).collect();
    assert_eq!(bulk.len(), 39);
    let (deck, problems) = bdf::parse(
        format!("BEGIN BULK\n{}\nENDDATA\n", bulk.join("\n")).as_bytes(),
        "echo",
    );
    let frames = Frames::resolve(&deck).expect("frames");
    let mass = DeckMass::assemble(&deck, &frames, BarMass::Lumped).expect("a mass model");
    assert_eq!(mass.other, Vec::<String>::new(), "{problems:?}");
    let own = mass.model.rigid_mass([0.0; 3]);
    let results = f06::read(&path).expect("readable");
    let printed = results.require_weight().expect("GRDPNT").mo;
    for i in 0..6 {
        for j in 0..6 {
            let scale = (printed[i][i] * printed[j][j]).sqrt();
            assert!(
                (own[i][j] - printed[i][j]).abs() < 1e-6 * scale,
                "{i} {j}: {} {}",
                own[i][j],
                printed[i][j]
            );
        }
    }
}

/// Plates carry mass that the matrix does not hold: the check is refused, the basis is there.
#[test]
fn plates_refuse_the_check() {
    let Some(folder) = third_party("f4_n95_plate") else {
        return;
    };
    let (deck, _) = bdf::read(folder.join("d03012a.inp")).expect("a deck");
    let results = f06::read(folder.join("d03012a.out")).expect("results");
    let basis =
        ModalBasis::from_nastran(&deck, &results, &options(Selection::FirstElastic(3))).expect("a basis");
    let MeanAxes::Refused { reason } = &basis.mean_axes else {
        panic!("plates were taken for massless")
    };
    assert!(reason.contains("CQUAD1"), "{reason}");
    println!("{:?}", basis.notes);
}
