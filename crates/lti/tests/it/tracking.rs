use albatross_lti::{Error, TrackOptions, Tracker, modes_carried_by, track};
use albatross_numerics::{C64, Mat, eigen};
use proptest::prelude::*;

use crate::models::{aeroelastic, mat};

fn blend(a0: &Mat<f64>, a1: &Mat<f64>, t: f64) -> Mat<f64> {
    Mat::from_fn(a0.nrows(), a0.ncols(), |i, j| {
        a0[(i, j)] + t * (a1[(i, j)] - a0[(i, j)])
    })
}

/// Uncoupled oscillators [[0, 1], [-omega^2, -2 zeta omega]] along the diagonal.
fn oscillators(figures: &[(f64, f64)]) -> Mat<f64> {
    Mat::from_fn(2 * figures.len(), 2 * figures.len(), |i, j| {
        let (omega, zeta) = figures[i / 2];
        match (i / 2 == j / 2, i % 2, j % 2) {
            (true, 0, 1) => 1.0,
            (true, 1, 0) => -omega * omega,
            (true, 1, 1) => -2.0 * zeta * omega,
            _ => 0.0,
        }
    })
}

fn pole(omega: f64, zeta: f64) -> C64 {
    C64::new(-zeta * omega, omega * (1.0 - zeta * zeta).sqrt())
}

/// Frequencies cross on the way: sorting would swap them, tracking must not.
#[test]
fn val_uncoupled_modes_cross() {
    let a0 = oscillators(&[(2.0, 0.01), (3.0, 0.02), (7.0, 0.03)]);
    let a1 = oscillators(&[(9.0, 0.05), (3.1, 0.02), (1.0, 0.1)]);
    let chosen = [pole(7.0, 0.03), pole(2.0, 0.01).conj()];
    let followed = track(a0.as_ref(), a1.as_ref(), &chosen, TrackOptions::default()).unwrap();
    assert!((followed.values()[0] - pole(1.0, 0.1)).norm() < 1e-12);
    assert!((followed.values()[1] - pole(9.0, 0.05)).norm() < 1e-12);
    assert!(followed.confidence > 0.75 && followed.modes[0].values.len() == 1);
}

/// Reference: continuity of the eigenvalues in steps of 1/20000.
fn brute_force(a0: &Mat<f64>, a1: &Mat<f64>, start: &[C64]) -> Vec<C64> {
    let mut values = start.to_vec();
    for k in 1..=20_000 {
        let next = eigen::eigenvalues(blend(a0, a1, f64::from(k) / 20_000.0).as_ref()).unwrap();
        for value in &mut values {
            *value = *next
                .iter()
                .min_by(|p, q| (*p - *value).norm().total_cmp(&(*q - *value).norm()))
                .unwrap();
        }
    }
    values
}

#[test]
fn val_coupled_modes_agree_with_tiny_steps() {
    let system = aeroelastic(3, 6, 12);
    let n = system.states.len() - 1;
    let a1 = Mat::from_fn(n, n, |i, j| system.a[(i, j)]);
    // Without the coupling of lags and modes, and with other frequencies.
    let a0 = Mat::from_fn(n, n, |i, j| match (i < 6, j < 6) {
        (true, true) => a1[(i, j)] * if i >= 3 && j == i - 3 { 0.6 } else { 1.0 },
        (false, false) => a1[(i, j)],
        _ => 0.0,
    });
    let chosen = modes_carried_by(a0.as_ref(), &[0, 1, 2, 3, 4, 5]).unwrap();
    assert_eq!(chosen.len(), 3);
    let followed = track(a0.as_ref(), a1.as_ref(), &chosen, TrackOptions::default()).unwrap();
    for (found, expected) in followed.values().iter().zip(brute_force(&a0, &a1, &chosen)) {
        assert!((found - expected).norm() < 1e-9, "{found} {expected}");
    }
}

/// Damping ratio from 0.2 to 3: the pair splits at 1 into -omega (zeta -+ sqrt(zeta^2 - 1)).
#[test]
fn val_pair_splits_and_merges_again() {
    let (soft, stiff) = (
        oscillators(&[(2.0, 0.2), (5.0, 0.1)]),
        oscillators(&[(2.0, 3.0), (5.0, 0.1)]),
    );
    let chosen = [pole(2.0, 0.2), pole(5.0, 0.1)];
    let mut tracker = Tracker::new(soft.as_ref(), &chosen, TrackOptions::default()).unwrap();
    let split = tracker.follow(stiff.as_ref()).unwrap();
    let root = 8.0_f64.sqrt();
    assert_eq!(split.modes[0].values.len(), 2);
    assert!((split.modes[0].values[0] - C64::new(-2.0 * (3.0 - root), 0.0)).norm() < 1e-12);
    assert!((split.modes[0].values[1] - C64::new(-2.0 * (3.0 + root), 0.0)).norm() < 1e-12);
    assert!((split.modes[1].values[0] - chosen[1]).norm() < 1e-12);
    let merged = tracker.follow(soft.as_ref()).unwrap();
    assert_eq!(merged.modes[0].values.len(), 1);
    assert!(
        (merged.modes[0].values[0] - chosen[0]).norm() < 1e-12,
        "{merged:?}"
    );
    assert!(merged.decompositions < 20);
}

/// Two real modes -1 and -3 of [[-1, 0], [0, -3]] merge under skew coupling k: -2 +- sqrt(1 - k^2).
#[test]
fn val_two_real_modes_merge_and_part() {
    let a = |k: f64| mat(&[&[-1.0, k, 0.0], &[-k, -3.0, 0.0], &[0.0, 0.0, -2.5]]);
    let chosen = [C64::new(-1.0, 0.0), C64::new(-3.0, 0.0)];
    let mut tracker = Tracker::new(a(0.0).as_ref(), &chosen, TrackOptions::default()).unwrap();
    let merged = tracker.follow(a(2.0).as_ref()).unwrap();
    for mode in 0..2 {
        assert!((merged.modes[mode].values[0] - C64::new(-2.0, 3.0_f64.sqrt())).norm() < 1e-13);
        assert_eq!(merged.modes[mode].merged_with, Some(1 - mode));
    }
    let parted = tracker.follow(a(0.1).as_ref()).unwrap();
    let root = 0.99_f64.sqrt();
    assert!(
        (parted.modes[0].values[0] - (root - 2.0)).norm() < 1e-13,
        "{parted:?}"
    );
    assert!((parted.modes[1].values[0] - (-root - 2.0)).norm() < 1e-13);
    assert_eq!(parted.modes[0].merged_with, None);

    // Only one of the two is followed: it takes the other along.
    let alone = track(
        a(0.0).as_ref(),
        a(2.0).as_ref(),
        &chosen[..1],
        TrackOptions::default(),
    )
    .unwrap();
    assert!((alone.modes[0].values[0] - C64::new(-2.0, 3.0_f64.sqrt())).norm() < 1e-13);
    assert_eq!(alone.modes[0].merged_with, None);
}

/// Left and right wings alone have equal modes; the carry-through spring parts them.
#[test]
fn val_equal_modes_are_followed_together() {
    let a0 = oscillators(&[(4.0, 0.05), (4.0, 0.05), (1.0, 0.3)]);
    let mut a1 = a0.clone();
    for (i, j, k) in [(1, 0, -3.0), (1, 2, 3.0), (3, 0, 3.0), (3, 2, -3.0)] {
        a1[(i, j)] += k;
    }
    let chosen = [pole(4.0, 0.05), pole(4.0, 0.05)];
    let followed = track(a0.as_ref(), a1.as_ref(), &chosen, TrackOptions::default()).unwrap();
    let mut squares: Vec<f64> = followed.values().iter().map(|v| v.norm_sqr()).collect();
    squares.sort_by(f64::total_cmp);
    // Symmetric: omega^2 = 16; antisymmetric: 16 + 6.
    assert!(
        (squares[0] - 16.0).abs() < 1e-11 && (squares[1] - 22.0).abs() < 1e-11,
        "{squares:?}"
    );
}

#[test]
fn val_what_cannot_be_told_is_refused() {
    // One of two equal modes: which one of the split pair follows it is undefined.
    let a0 = oscillators(&[(4.0, 0.05), (4.0, 0.05)]);
    let mut a1 = a0.clone();
    for (i, j, k) in [(1, 0, -3.0), (1, 2, 3.0), (3, 0, 3.0), (3, 2, -3.0)] {
        a1[(i, j)] += k;
    }
    let error = track(
        a0.as_ref(),
        a1.as_ref(),
        &[pole(4.0, 0.05)],
        TrackOptions::default(),
    )
    .unwrap_err();
    assert!(
        matches!(
            error,
            Error::Unresolved {
                mode: 0,
                progress: 0.0,
                ..
            }
        ),
        "{error}"
    );

    let start = |value| Tracker::new(a0.as_ref(), &[value], TrackOptions::default()).map(|_| ());
    assert!(matches!(start(C64::new(-0.2, 3.9)), Err(Error::BadStart { .. })));
    let twice = [pole(4.0, 0.05), pole(4.0, 0.05), pole(4.0, 0.05)];
    assert!(matches!(
        Tracker::new(a0.as_ref(), &twice, TrackOptions::default()),
        Err(Error::BadStart { .. })
    ));
    let options = TrackOptions {
        tolerance: 0.9,
        ..TrackOptions::default()
    };
    assert!(matches!(
        Tracker::new(a0.as_ref(), &[], options),
        Err(Error::Domain {
            what: "the tolerance",
            ..
        })
    ));
    let mut tracker = Tracker::new(a0.as_ref(), &twice[..2], TrackOptions::default()).unwrap();
    assert!(matches!(
        tracker.follow(mat(&[&[1.0]]).as_ref()),
        Err(Error::Numerics(_))
    ));
}

/// The tracker's answer does not depend on the units of the states.
#[test]
fn prop_labels_ignore_units() {
    let system = aeroelastic(4, 12, 30);
    let n = system.states.len() - 1;
    let a1 = Mat::from_fn(n, n, |i, j| system.a[(i, j)]);
    let a0 = Mat::from_fn(n, n, |i, j| if (i < 8) == (j < 8) { a1[(i, j)] } else { 0.0 });
    let scale = |a: &Mat<f64>| {
        let d = |i: usize| 10_f64.powi((i * 5 % 11) as i32 - 5);
        Mat::from_fn(n, n, |i, j| a[(i, j)] * d(j) / d(i))
    };
    let chosen = modes_carried_by(a0.as_ref(), &(0..8).collect::<Vec<_>>()).unwrap();
    let plain = track(a0.as_ref(), a1.as_ref(), &chosen, TrackOptions::default()).unwrap();
    let scaled = track(
        scale(&a0).as_ref(),
        scale(&a1).as_ref(),
        &chosen,
        TrackOptions::default(),
    )
    .unwrap();
    for (p, q) in plain.values().iter().zip(scaled.values()) {
        assert!((p - q).norm() < 1e-9 * p.norm());
    }
    assert_eq!(plain.steps, scaled.steps);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Forward and back along the same path returns every mode to its own start.
    #[test]
    fn prop_there_and_back(seed in 0_u64..500, modes in 2_usize..5) {
        let (p, q) = (aeroelastic(modes, 8, seed), aeroelastic(modes, 8, seed + 1));
        let n = p.states.len() - 1;
        let cut = |a: &Mat<f64>| Mat::from_fn(n, n, |i, j| a[(i, j)]);
        let (a0, a1) = (cut(&p.a), cut(&q.a));
        let chosen = modes_carried_by(a0.as_ref(), &(0..2 * modes).collect::<Vec<_>>()).unwrap();
        let mut tracker = Tracker::new(a0.as_ref(), &chosen, TrackOptions::default()).unwrap();
        tracker.follow(a1.as_ref()).unwrap();
        let back = tracker.follow(a0.as_ref()).unwrap();
        for (mode, start) in back.modes.iter().zip(&chosen) {
            prop_assert!(mode.values.iter().any(|v| (v - start).norm() < 1e-9 * (1.0 + start.norm())), "{:?} {}", mode, start);
        }
    }
}
