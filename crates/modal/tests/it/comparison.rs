//! MAC and pairing of modes of two bases.

use albatross_modal::{
    BasisMass, BasisOptions, Component, Error, MassModel, MassSource, MeanAxes, ModalBasis, OnViolation,
    Selection, describe, energy_shares, mac, pair_modes,
};
use albatross_nastran::deck::RawCard;
use nalgebra::{Matrix6, Vector3};

use crate::support::{basis_of, f25_mystran, inputs, mass_of, numbered, options};

/// Two orthonormal shapes turned by an angle within their plane: the MAC is cos^2 and sin^2 of it.
#[test]
fn val_mac_of_turned_modes() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0]];
    let grids = numbered(&positions);
    let mut model = MassModel::default();
    for (grid, m) in grids.iter().zip([2.0, 8.0]) {
        model.add(grid.id, Vector3::from(grid.position), &(Matrix6::identity() * m));
    }
    let unit = |grid: usize, m: f64| {
        let mut shape = vec![[0.0; 6]; 2];
        shape[grid][2] = 1.0 / m.sqrt();
        shape
    };
    let mix = |p: f64, q: f64| {
        let (a, b) = (unit(0, 2.0), unit(1, 8.0));
        a.iter()
            .zip(&b)
            .map(|(a, b)| std::array::from_fn(|i| p * a[i] + q * b[i]))
            .collect::<Vec<[f64; 6]>>()
    };
    let basis = |shapes| {
        let mass = mass_of(&model, &grids);
        ModalBasis::try_new(grids.clone(), inputs(shapes), mass, &options(OnViolation::Accept))
            .expect("valid")
    };
    let (s, c) = 0.3_f64.sin_cos();
    let first = basis(vec![mix(1.0, 0.0), mix(0.0, 1.0)]);
    // Turned, with another sign, scale and order.
    let second = basis(vec![mix(-5.0 * s, 5.0 * c), mix(-c, -s)]);
    let got = mac(&first, &second).expect("same grids");
    let exact = [[s * s, c * c], [c * c, s * s]];
    for k in 0..2 {
        for l in 0..2 {
            assert!((got[(k, l)] - exact[k][l]).abs() < 1e-15);
        }
    }
    let pairs = pair_modes(got.as_ref(), 0.5);
    assert_eq!(
        pairs.iter().map(|p| (p.first, p.second)).collect::<Vec<_>>(),
        [(0, 1), (1, 0)]
    );
    assert!(pair_modes(got.as_ref(), 0.95).is_empty());
}

/// Without mass the MAC is of translations on the common grids; rotations, in rad, do not count.
#[test]
fn val_plain_mac_on_common_grids() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let first = basis_of(
        &positions,
        vec![vec![
            [0.0, 0.0, 1.0, 9.0, 9.0, 9.0],
            [0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
            [7.0; 6],
        ]],
    );
    let second = basis_of(
        &positions[..2],
        vec![vec![
            [0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, -9.0, 9.0, 9.0],
        ]],
    );
    let got = mac(&first, &second).expect("two common grids");
    assert!((got[(0, 0)] - 16.0 / 25.0).abs() < 1e-15);
    let mut elsewhere = numbered(&positions);
    elsewhere.iter_mut().for_each(|g| g.id += 100);
    let shapes = inputs(vec![vec![[1.0; 6]; 3]]);
    let other = ModalBasis::try_new(elsewhere, shapes, BasisMass::unknown(), &BasisOptions::default())
        .expect("valid");
    assert!(matches!(mac(&first, &other), Err(Error::NoCommonGrids)));
}

/// A shell without known property is mass that is not in the matrix: the check is refused, mass properties come from
/// the weight generator's seven digits, and what needs the matrix says why it cannot be done.
#[test]
fn other_mass_refuses_the_check_and_keeps_the_basis() {
    let (mut deck, results) = f25_mystran();
    let options = BasisOptions {
        modes: Selection::FirstElastic(3),
        ..BasisOptions::default()
    };
    let complete = ModalBasis::from_nastran(&deck, &results, &options).expect("complete");
    let fields = ["1", "1", "1001", "1002", "3012", "3011"]
        .map(String::from)
        .to_vec();
    deck.raw.push(RawCard {
        name: "CQUAD4".into(),
        fields,
        origin: None,
    });
    let basis = ModalBasis::from_nastran(&deck, &results, &options).expect("still a basis");
    let MeanAxes::Refused { reason } = &basis.mean_axes else {
        panic!("a shell has mass")
    };
    assert_eq!(
        reason,
        "the deck has mass that is not in the mass matrix: 1 CQUAD4"
    );
    assert!(
        basis.notes.iter().any(|n| n.contains("mean-axes check refused")),
        "{:?}",
        basis.notes
    );
    let (printed, own) = (basis.mass.expect("GRDPNT"), complete.mass.expect("deck"));
    assert_eq!(printed.source, MassSource::GridPointWeight);
    assert!((printed.mass / own.mass - 1.0).abs() < 1e-6);
    assert!((printed.cg[0] - own.cg[0]).abs() < 1e-5);
    assert_eq!(basis.modes[0].shape, complete.modes[0].shape);
    let error = energy_shares(&basis, &[]).unwrap_err().to_string();
    assert!(
        error.contains("the kinetic-energy table needs the mass matrix") && error.contains("1 CQUAD4"),
        "{error}"
    );
}

/// A deck of another mass state than the results is noticed by the weight table, the generalised masses and the
/// mean-axes check.
#[test]
fn another_mass_state_is_noticed() {
    let (mut deck, results) = f25_mystran();
    deck.conm2
        .values_mut()
        .filter(|c| (1015..=1025).contains(&c.grid))
        .for_each(|c| c.mass *= 2.0);
    let mut options = BasisOptions {
        modes: Selection::FirstElastic(3),
        ..BasisOptions::default()
    };
    let error = ModalBasis::from_nastran(&deck, &results, &options).unwrap_err();
    assert!(matches!(error, Error::NotMeanAxes { .. }), "{error}");
    options.on_violation = OnViolation::Accept;
    let basis = ModalBasis::from_nastran(&deck, &results, &options).expect("accepted");
    for part in [
        "differs from the grid point weight generator",
        "the generalised mass of 3 modes differs",
    ] {
        assert!(
            basis.notes.iter().any(|n| n.contains(part)),
            "{part}: {:?}",
            basis.notes
        );
    }
}

#[test]
fn energy_shares_are_described_in_one_line() {
    let (deck, results) = f25_mystran();
    let options = BasisOptions {
        modes: Selection::FirstElastic(1),
        ..BasisOptions::default()
    };
    let basis = ModalBasis::from_nastran(&deck, &results, &options).expect("complete");
    let wing = Component {
        name: "wing".into(),
        grids: (1000..=1025).chain(2001..=2025).collect(),
    };
    let shares = energy_shares(&basis, std::slice::from_ref(&wing)).expect("mass is known");
    assert_eq!(describe(&shares[0], 0.02), "wing_z 0.89, other_z 0.08");
    let unknown = Component {
        name: "wing".into(),
        grids: vec![1000, 1050],
    };
    let error = energy_shares(&basis, &[unknown]).unwrap_err().to_string();
    assert!(error.contains("grid 1050 (component \"wing\")"), "{error}");
}
