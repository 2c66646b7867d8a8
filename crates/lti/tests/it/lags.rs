use albatross_lti::{Error, LagForm, TrackOptions, lags, modes_carried_by, track};
use albatross_numerics::{C64, Mat, eigen};

use crate::models::{aeroelastic, mat};

/// A state matrix of `modes` oscillators and `count` lags without its position integrator, and the indices of the lags.
fn coupled(modes: usize, count: usize, seed: u64) -> (Mat<f64>, Vec<usize>) {
    let system = aeroelastic(modes, count, seed);
    let n = system.states.len() - 1;
    let a = Mat::from_fn(n, n, |i, j| system.a[(i, j)]);
    (a, (2 * modes..n).collect())
}

/// The same without the coupling of lags and modes.
fn uncoupled(a: &Mat<f64>, core: usize) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| {
        if (i < core) == (j < core) { a[(i, j)] } else { 0.0 }
    })
}

/// Each oscillatory eigenvalue of the whole matrix is found again from a value that is near enough, and nothing else is.
#[test]
fn val_roots_are_eigenvalues_of_the_whole() {
    for seed in 1..6 {
        let (a, indices) = coupled(5, 40, seed);
        let form = LagForm::new(a.as_ref(), &indices).unwrap();
        assert_eq!((form.core_count(), form.lag_count()), (10, 40));
        let all = eigen::eigenvalues(a.as_ref()).unwrap();
        let mut found = 0;
        for value in all.iter().filter(|v| v.im > 0.0) {
            let root = form.root(value * (1.0 + 1e-8)).unwrap();
            assert!(
                (root.value - value).norm() < 1e-10 * value.norm(),
                "{} {value}",
                root.value
            );
            found += 1;
        }
        assert!(found >= 5, "{found}");
        let nowhere = C64::new(3.0, 7.0);
        assert!(matches!(form.root(nowhere), Err(Error::BadStart { .. })));
    }
}

/// The values of the dense tracker wherever a path is followed to its end, with the same certainties where as many steps
/// were taken; weak coupling always is.
#[test]
fn val_following_is_that_of_the_dense_tracker() {
    let core: Vec<usize> = (0..10).collect();
    let options = TrackOptions::default();
    for (seed, strength) in (1..9).flat_map(|seed| [(seed, 1.0), (seed, 3.0)]) {
        let (mut a1, indices) = coupled(5, 40, seed);
        let a0 = uncoupled(&a1, 10);
        for k in 10..50 {
            for i in 0..10 {
                a1[(i, k)] *= strength;
                a1[(k, i)] *= strength;
            }
        }
        let carried = modes_carried_by(a0.as_ref(), &core).unwrap();
        let chosen: Vec<C64> = carried.into_iter().filter(|v| v.im > 0.0).collect();
        let [from, to] = [&a0, &a1].map(|a| LagForm::new(a.as_ref(), &indices).unwrap());
        let roots: Vec<_> = chosen.iter().map(|v| from.root(*v).unwrap()).collect();
        let quick = match lags::follow(&from, &to, &roots, options) {
            Ok(quick) => quick,
            Err(Error::Unresolved { .. }) if strength > 1.0 => continue,
            Err(error) => panic!("seed {seed}: {error}"),
        };
        let dense = track(a0.as_ref(), a1.as_ref(), &chosen, options).unwrap();
        assert!(strength > 1.0 || quick.steps == dense.steps, "seed {seed}");
        for (i, mode) in dense.modes.iter().enumerate() {
            let (found, expected) = (quick.roots[i].value, mode.values[0]);
            assert!(
                (found - expected).norm() < 1e-9 * expected.norm(),
                "seed {seed}: {found} {expected}"
            );
            let apart = (quick.confidence[i] - mode.confidence).abs();
            assert!(quick.steps != dense.steps || apart < 1e-6, "seed {seed}: {apart}");
        }
        // One or two factorisations a root and a step, beside those of rejected steps.
        assert!(
            quick.effort.factorisations <= 3 * (2 * quick.steps + 4) * chosen.len(),
            "{:?}",
            quick.effort
        );
    }
}

/// A pair that comes down on the real axis is refused, not followed to one of the two roots.
#[test]
fn val_a_pair_that_splits_is_refused() {
    let a = |zeta: f64| mat(&[&[0.0, 1.0, 0.1], &[-4.0, -4.0 * zeta, 0.0], &[0.0, 0.1, -9.0]]);
    let (soft, stiff) = (a(0.2), a(3.0));
    let form = |m: &Mat<f64>| LagForm::new(m.as_ref(), &[2]).unwrap();
    let pair = eigen::eigenvalues(soft.as_ref())
        .unwrap()
        .into_iter()
        .find(|v| v.im > 0.0)
        .unwrap();
    let root = form(&soft).root(pair).unwrap();
    let refused = lags::follow(&form(&soft), &form(&stiff), &[root], TrackOptions::default());
    assert!(
        matches!(refused, Err(Error::Unresolved { mode: 0, .. })),
        "{refused:?}"
    );
}

#[test]
fn val_unusable_lags_are_refused() {
    let a = mat(&[&[-1.0, 0.5, 0.5], &[0.2, -3.0, 0.1], &[0.2, 0.0, -4.0]]);
    assert!(matches!(
        LagForm::new(a.as_ref(), &[1, 2]),
        Err(Error::Method { .. })
    ));
    assert!(matches!(
        LagForm::new(a.as_ref(), &[2, 1]),
        Err(Error::Method { .. })
    ));
    assert!(matches!(
        LagForm::new(a.as_ref(), &[7]),
        Err(Error::Method { .. })
    ));
    assert!(LagForm::new(a.as_ref(), &[2]).is_ok());
    let nan = mat(&[&[f64::NAN]]);
    assert!(matches!(LagForm::new(nan.as_ref(), &[]), Err(Error::Numerics(_))));
}
