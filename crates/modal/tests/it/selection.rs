//! Which modes are taken, and what is said when they are not there.

use albatross_modal::{BasisOptions, Error, MeanAxes, ModalBasis, Normalisation, Selection};
use albatross_nastran::deck::{Components, Spc1};
use albatross_nastran::{Deck, ModalResults};

use crate::support::{f25_mystran, largest_difference};

fn options(modes: Selection) -> BasisOptions {
    BasisOptions {
        modes,
        ..BasisOptions::default()
    }
}

fn refuse(input: &(Deck, ModalResults), options: &BasisOptions) -> Error {
    match ModalBasis::from_nastran(&input.0, &input.1, options) {
        Err(error) => error,
        Ok(_) => panic!("the input was accepted"),
    }
}

#[test]
fn val_numbers_are_taken_in_the_order_asked() {
    let (deck, results) = f25_mystran();
    let basis = ModalBasis::from_nastran(&deck, &results, &options(Selection::Numbers(vec![10, 7, 26])))
        .expect("there");
    assert_eq!(
        basis.modes.iter().map(|m| m.number).collect::<Vec<_>>(),
        [10, 7, 26]
    );
    let all = ModalBasis::from_nastran(&deck, &results, &options(Selection::All)).expect("there");
    assert_eq!(all.modes.len(), 24);
    assert_eq!(all.modes[0].shape, basis.modes[1].shape);
}

#[test]
fn missing_modes_are_named() {
    let input = f25_mystran();
    let too_few = refuse(&input, &options(Selection::FirstElastic(40))).to_string();
    assert!(
        too_few.contains("40 elastic modes are asked for, but the file has only 24 (6 rigid"),
        "{too_few}"
    );
    let absent = refuse(&input, &options(Selection::Numbers(vec![7, 31]))).to_string();
    assert!(
        absent.contains("mode 31 has no eigenvector; the file has eigenvectors of modes 1-30"),
        "{absent}"
    );
    let twice = refuse(&input, &options(Selection::Numbers(vec![7, 7]))).to_string();
    assert!(twice.contains("mode 7 is asked for twice"), "{twice}");
    // A rigid mode couples fully with itself.
    let rigid = refuse(&input, &options(Selection::Numbers(vec![2, 7])));
    assert!(matches!(rigid, Error::NotMeanAxes { mode: 2, .. }), "{rigid}");
    let mut wrong = options(Selection::All);
    wrong.mean_axes_tolerance = f64::NAN;
    assert!(
        refuse(&input, &wrong)
            .to_string()
            .contains("mean_axes_tolerance is NaN")
    );
    wrong = options(Selection::Numbers(Vec::new()));
    assert!(matches!(refuse(&input, &wrong), Error::NoModes));
}

/// MYSTRAN prints no subcase for a single one; other programs number them in the page header.
#[test]
fn subcases_are_chosen_by_number() {
    let (deck, mut results) = f25_mystran();
    let mut second = results.eigenvectors.clone();
    for vector in &mut second {
        vector.subcase = Some(2);
        vector
            .rows
            .iter_mut()
            .flat_map(|r| &mut r.values)
            .for_each(|v| *v *= -1.0);
    }
    let mut table = results.eigenvalues[0].clone();
    table.subcase = Some(2);
    results.eigenvalues[0].subcase = Some(1);
    results.eigenvalues.push(table);
    results.eigenvectors.iter_mut().for_each(|v| v.subcase = Some(1));
    results.eigenvectors.extend(second);
    let input = (deck, results);
    let of = |subcase| {
        let options = BasisOptions {
            subcase,
            ..options(Selection::FirstElastic(1))
        };
        ModalBasis::from_nastran(&input.0, &input.1, &options)
    };
    let (first, second) = (of(None).expect("the first"), of(Some(2)).expect("the second"));
    assert_eq!(first.modes[0].shape[0][2], -second.modes[0].shape[0][2]);
    assert!(
        first
            .notes
            .iter()
            .any(|n| n.contains("2 subcases are printed; subcase 1 is taken")),
        "{:?}",
        first.notes
    );
    let mut absent = options(Selection::All);
    absent.subcase = Some(5);
    let error = refuse(&input, &absent).to_string();
    assert!(
        error.contains("no eigenvectors for subcase 5; the file has subcase 1, 2"),
        "{error}"
    );
}

/// The frequency limit does not decide alone: with a limit above the first bending frequency the shape tells that it
/// is elastic, and with a limit below the noise of the rigid modes these are still rigid.
#[test]
fn val_shape_decides_between_rigid_and_elastic() {
    let (deck, results) = f25_mystran();
    for threshold in [1e-9, 4.0] {
        let mut options = options(Selection::FirstElastic(3));
        options.rigid_threshold_hz = threshold;
        let basis = ModalBasis::from_nastran(&deck, &results, &options).expect("there");
        assert_eq!(
            basis.modes.iter().map(|m| m.number).collect::<Vec<_>>(),
            [7, 8, 9],
            "{threshold}"
        );
        assert!(!basis.notes.is_empty());
    }
}

#[test]
fn cut_results_are_refused() {
    let (deck, mut results) = f25_mystran();
    results.eigenvectors[11].rows.truncate(100);
    let error = refuse(&(deck, results), &options(Selection::All));
    let Error::GridsDiffer {
        mode: 12,
        reference: 1,
        found: 100,
        expected: 114,
        ..
    } = error
    else {
        panic!("{error}")
    };
}

/// Grids left out of the output carry mass: the check is refused and says which, the modes are there.
#[test]
fn missing_grids_with_mass_refuse_the_check() {
    let (deck, mut results) = f25_mystran();
    for vector in &mut results.eigenvectors {
        vector.rows.retain(|r| !(4005..=4008).contains(&r.id));
    }
    let basis =
        ModalBasis::from_nastran(&deck, &results, &options(Selection::FirstElastic(5))).expect("there");
    let MeanAxes::Refused { reason } = &basis.mean_axes else {
        panic!("mass is missing")
    };
    assert!(
        reason.contains("grids 4005-4008 carry mass but have no eigenvector"),
        "{reason}"
    );
    assert!(reason.contains("DISPLACEMENT(PRINT) = ALL"), "{reason}");
    assert!((basis.mass.expect("the deck has it all").mass - 81_018.49).abs() < 0.01);
    assert!(
        basis.notes.iter().any(|n| n.contains("rigid by frequency alone")),
        "{:?}",
        basis.notes
    );
    assert_eq!(basis.modes[0].number, 7);
}

#[test]
fn results_without_vectors_say_what_to_request() {
    let (deck, mut results) = f25_mystran();
    results.eigenvectors.clear();
    let error = refuse(&(deck, results), &options(Selection::All)).to_string();
    assert!(error.contains("add DISPLACEMENT(PRINT) = ALL"), "{error}");
}

/// Blank rotations (a data recovery that drops them) take a grid out of the basis, with a note.
#[test]
fn blank_rotations_leave_a_grid_out() {
    let (deck, mut results) = f25_mystran();
    for row in results
        .eigenvectors
        .iter_mut()
        .flat_map(|v| &mut v.rows)
        .filter(|r| r.id == 3092)
    {
        row.values[3..].fill(f64::NAN);
    }
    let basis =
        ModalBasis::from_nastran(&deck, &results, &options(Selection::FirstElastic(2))).expect("there");
    assert!(basis.grid_index(3092).is_none());
    assert!(
        basis
            .notes
            .iter()
            .any(|n| n.contains("grids 3092 are printed without rotations")),
        "{:?}",
        basis.notes
    );
}

#[test]
fn val_unit_mass_scales_shape_and_mass_together() {
    let (deck, mut results) = f25_mystran();
    let plain =
        ModalBasis::from_nastran(&deck, &results, &options(Selection::FirstElastic(4))).expect("there");
    // The same modes as a file with largest component 1 would have them.
    for vector in &mut results.eigenvectors {
        vector
            .rows
            .iter_mut()
            .flat_map(|r| &mut r.values)
            .for_each(|v| *v *= 20.0);
    }
    for row in results.eigenvalues.iter_mut().flat_map(|t| &mut t.modes) {
        row.generalized_mass *= 400.0;
        row.generalized_stiffness *= 400.0;
    }
    let mut unit = options(Selection::FirstElastic(4));
    unit.normalisation = Normalisation::UnitMass;
    let basis = ModalBasis::from_nastran(&deck, &results, &unit).expect("there");
    for (a, b) in plain.modes.iter().zip(&basis.modes) {
        assert_eq!(b.generalized_mass, 1.0);
        assert!(largest_difference(&a.shape, &b.shape) < 1e-15);
        assert!((b.generalized_stiffness() - a.omega_rad_s.powi(2)).abs() < 1e-9);
    }
}

/// Supports on the plane of symmetry leave x, z and pitch free when the file has no rigid modes to say otherwise.
#[test]
fn val_half_model_supports() {
    let (mut deck, mut results) = f25_mystran();
    results.eigenvectors.retain(|v| v.mode > 6);
    let components = Components::parse(b"246").expect("digits");
    deck.spc1s.push(Spc1 {
        sid: 3,
        components,
        points: vec![3001, 3010, 3020, 1000],
    });
    deck.case_control.push("SPC = 3".into());
    let basis =
        ModalBasis::from_nastran(&deck, &results, &options(Selection::FirstElastic(1))).expect("there");
    let MeanAxes::Checked(check) = &basis.mean_axes else {
        panic!("complete mass")
    };
    assert_eq!(check.free_directions, [true, false, true, false, true, false]);
}
