//! Models at the edges of what users bring.

use crate::models::{UniformWing, invented};
use albatross_numerics::{Mat, eigen};
use albatross_strip::elastic::state_matrix;
use albatross_strip::flutter::{divergence_speed, exact_flutter, lag_flutter};
use albatross_strip::kernels::{JONES, Kernel};
use albatross_strip::neutral::{NeutralPoint, neutral_points};
use albatross_strip::sweep::{Method, sweep};
use albatross_strip::{AeroelasticModel, Flow, Split, Strip, StripShapes, StripTheory, Structure};

fn goland() -> AeroelasticModel {
    let wing = UniformWing::goland();
    wing.model(&wing.equal_strips(10), 7, 4, &JONES)
}

fn rebuilt(model: &AeroelasticModel, structure: Structure, shapes: StripShapes) -> AeroelasticModel {
    AeroelasticModel::try_new(
        structure,
        model.strips.clone(),
        shapes,
        &StripTheory::default(),
        Split::default(),
        &JONES,
    )
    .unwrap()
}

/// Block diagonal of the matrix and `extra`.
fn beside(a: &Mat<f64>, extra: &Mat<f64>) -> Mat<f64> {
    let n = a.nrows();
    Mat::from_fn(n + extra.nrows(), n + extra.nrows(), |i, j| {
        if i < n && j < n {
            a[(i, j)]
        } else if i >= n && j >= n {
            extra[(i - n, j - n)]
        } else {
            0.0
        }
    })
}

/// Speeds are proportional to frequencies, at any scale: with all frequencies s times as high flutter is s times as
/// fast.
#[test]
fn val_similarity_in_frequency() {
    let model = goland();
    let base = lag_flutter(&model, 1.225).unwrap().unwrap();
    let base_exact = exact_flutter(&model, 1.225).unwrap().unwrap();
    for s in [1e-5, 0.1, 3.0, 1e5] {
        let structure = Structure {
            stiffness: s * s * &model.structure.stiffness,
            ..model.structure.clone()
        };
        let scaled = rebuilt(&model, structure, model.shapes.clone());
        for (found, base) in [
            (lag_flutter(&scaled, 1.225), base),
            (exact_flutter(&scaled, 1.225), base_exact),
        ] {
            let found = found.unwrap().unwrap();
            assert!(
                (found.speed / (s * base.speed) - 1.0).abs() < 1e-10,
                "{s}: {found:?}"
            );
            assert!((found.omega_rad_s / (s * base.omega_rad_s) - 1.0).abs() < 1e-10);
        }
    }
}

/// The basis does not matter: any invertible mixture of the modes flutters at the same speed.
#[test]
fn val_mixture_of_modes() {
    let model = goland();
    let n = model.n_modes();
    let mix = Mat::from_fn(n, n, |i, j| {
        if i == j {
            1.0
        } else {
            0.3 / (1.0 + (i + 2 * j) as f64)
        }
    });
    let both = |a: &Mat<f64>| {
        let b = mix.transpose() * a * &mix;
        Mat::from_fn(n, n, |i, j| 0.5 * (b[(i, j)] + b[(j, i)]))
    };
    let structure = Structure {
        mass: both(&model.structure.mass),
        damping: both(&model.structure.damping),
        stiffness: both(&model.structure.stiffness),
    };
    let shapes = StripShapes::try_new(&model.shapes.phi * &mix, &model.shapes.gamma * &mix).unwrap();
    let mixed = rebuilt(&model, structure, shapes);
    let (a, b) = (
        lag_flutter(&model, 1.225).unwrap().unwrap(),
        lag_flutter(&mixed, 1.225).unwrap().unwrap(),
    );
    assert!((a.speed / b.speed - 1.0).abs() < 1e-11 && (a.omega_rad_s / b.omega_rad_s - 1.0).abs() < 1e-11);
    let (a, b) = (
        divergence_speed(&model, 1.225).unwrap(),
        divergence_speed(&mixed, 1.225).unwrap(),
    );
    assert!((a.unwrap() / b.unwrap() - 1.0).abs() < 1e-11);
}

/// Two wings alike, not coupled: all roots are double, and flutter is that of one.
#[test]
fn val_two_wings_alike() {
    let one = goland();
    let (n, strips) = (one.n_modes(), one.strips.len());
    let twice = |a: &Mat<f64>| {
        Mat::from_fn(2 * strips, 2 * n, |j, k| {
            if (j < strips) == (k < n) {
                a[(j % strips, k % n)]
            } else {
                0.0
            }
        })
    };
    let s = &one.structure;
    let two = AeroelasticModel::try_new(
        Structure {
            mass: beside(&s.mass, &s.mass),
            damping: beside(&s.damping, &s.damping),
            stiffness: beside(&s.stiffness, &s.stiffness),
        },
        [one.strips.clone(), one.strips.clone()].concat(),
        StripShapes::try_new(twice(&one.shapes.phi), twice(&one.shapes.gamma)).unwrap(),
        &StripTheory::default(),
        Split::default(),
        &JONES,
    )
    .unwrap();
    for kernel in [Kernel::Lags(&JONES), Kernel::Theodorsen] {
        let [a, b] = [&one, &two].map(|m| neutral_points(m, 1.225, kernel).unwrap());
        // Points at absurd speeds included: each is there, and no other.
        let of_one = |p: &NeutralPoint| {
            a.points
                .iter()
                .any(|q| (p.speed / q.speed - 1.0).abs() < 1e-9 && (p.growth > 0.0) == (q.growth > 0.0))
        };
        assert!(b.points.iter().all(of_one), "{kernel:?} {a:?} {b:?}");
        assert_eq!(a.points.len(), b.points.len());
    }
    for method in [Method::StateSpace, Method::PK] {
        let found = sweep(&two, 1.225, &[20.0, 80.0, 140.0, 200.0], method).unwrap();
        assert_eq!(found.modes.len(), 2 * n);
        for mode in &found.modes {
            assert!(
                mode.eigenvalues.iter().all(|p| p.is_finite()),
                "{method:?} {:?}",
                found.notes
            );
        }
        assert!(
            found
                .crossings
                .iter()
                .any(|c| c.mode.is_some() && c.unstable_above)
        );
    }
}

/// A free mode (plunge, then plunge and pitch) beside the elastic ones: the searches still answer, and with a very
/// heavy body the answer is that of the clamped wing.
#[test]
fn val_free_modes() {
    let wing = goland();
    let clamped = lag_flutter(&wing, 1.225).unwrap().unwrap();
    let strips = wing.strips.len();
    for free in [1, 2] {
        let shape = |a: &Mat<f64>, rigid: &dyn Fn(usize, usize) -> f64| {
            Mat::from_fn(strips, wing.n_modes() + free, |j, k| {
                if k < wing.n_modes() {
                    a[(j, k)]
                } else {
                    rigid(j, k - wing.n_modes())
                }
            })
        };
        // Plunge, and pitch about the elastic axis.
        let phi = shape(&wing.shapes.phi, &|_, k| if k == 0 { 1.0 } else { 0.0 });
        let gamma = shape(&wing.shapes.gamma, &|_, k| if k == 1 { 1.0 } else { 0.0 });
        let s = &wing.structure;
        let zero = Mat::<f64>::zeros(free, free);
        let heavy = Mat::from_fn(free, free, |i, j| if i == j { 1e14 } else { 0.0 });
        let model = rebuilt(
            &wing,
            Structure {
                mass: beside(&s.mass, &heavy),
                damping: beside(&s.damping, &zero),
                stiffness: beside(&s.stiffness, &zero),
            },
            StripShapes::try_new(phi, gamma).unwrap(),
        );
        let found = lag_flutter(&model, 1.225).unwrap().unwrap();
        assert!(
            (found.speed / clamped.speed - 1.0).abs() < 1e-8,
            "{free}: {found:?}"
        );
        let [a, b] = [&wing, &model].map(|m| divergence_speed(m, 1.225).unwrap().unwrap());
        assert!((a / b - 1.0).abs() < 1e-10);
        for method in [Method::StateSpace, Method::PK] {
            let found = sweep(&model, 1.225, &[0.0, 50.0, 100.0, 150.0], method).unwrap();
            assert_eq!(found.modes.len(), wing.n_modes(), "free modes are not followed");
            assert_eq!(found.crossings.len(), 1);
        }
    }
    // Nothing elastic at all.
    let free_only = Structure::modal(&[1.0; 4], &[0.0; 4], &[0.0; 4]).unwrap();
    let model = rebuilt(&wing, free_only, wing.shapes.clone());
    assert_eq!(lag_flutter(&model, 1.225).unwrap(), None);
    assert_eq!(divergence_speed(&model, 1.225).unwrap(), None);
    for method in [Method::StateSpace, Method::PK] {
        assert_eq!(
            sweep(&model, 1.225, &[10.0, 20.0], method).unwrap().modes,
            Vec::new()
        );
    }
}

/// A mode on which the air does no work, without damping: neutral at every speed, and no flutter.
#[test]
fn val_mode_out_of_the_air() {
    let wing = goland();
    let strips = wing.strips.len();
    let wider = |a: &Mat<f64>| Mat::from_fn(strips, 5, |j, k| if k < 4 { a[(j, k)] } else { 0.0 });
    let s = &wing.structure;
    let extra = |v: f64| Mat::from_fn(1, 1, |_, _| v);
    let model = rebuilt(
        &wing,
        Structure {
            mass: beside(&s.mass, &extra(2.0)),
            damping: beside(&s.damping, &extra(0.0)),
            stiffness: beside(&s.stiffness, &extra(2.0 * 60.0 * 60.0)),
        },
        StripShapes::try_new(wider(&wing.shapes.phi), wider(&wing.shapes.gamma)).unwrap(),
    );
    let (a, b) = (
        neutral_points(&wing, 1.225, Kernel::Lags(&JONES)).unwrap(),
        neutral_points(&model, 1.225, Kernel::Lags(&JONES)).unwrap(),
    );
    assert_eq!(b.unstable_at_rest, Vec::<f64>::new());
    assert_eq!(a.points.len(), b.points.len());
    assert!((a.points[0].speed / b.points[0].speed - 1.0).abs() < 1e-10);
    let found = sweep(&model, 1.225, &[10.0, 100.0], Method::StateSpace).unwrap();
    assert!((found.modes[1].eigenvalues[1].im - 60.0).abs() < 1e-9);
}

/// Damping beyond critical, and damping that makes energy.
#[test]
fn val_heavy_and_negative_damping() {
    let wing = goland();
    let damped = |xi: f64| {
        let omega: Vec<f64> = (0..4).map(|k| wing.structure.stiffness[(k, k)].sqrt()).collect();
        rebuilt(
            &wing,
            Structure::modal(&[1.0; 4], &omega, &[xi; 4]).unwrap(),
            wing.shapes.clone(),
        )
    };
    let light = lag_flutter(&damped(0.02), 1.225).unwrap().unwrap();
    let none = lag_flutter(&wing, 1.225).unwrap().unwrap();
    assert!(light.speed > none.speed);
    let over = damped(2.0);
    let found = neutral_points(&over, 1.225, Kernel::Lags(&JONES)).unwrap();
    assert!(found.points.iter().all(|p| p.speed > none.speed), "{found:?}");
    let swept = sweep(&over, 1.225, &[10.0, 60.0, 120.0], Method::StateSpace).unwrap();
    assert!(
        swept
            .modes
            .iter()
            .all(|m| m.eigenvalues.iter().all(|p| p.re < 0.0))
    );
    let negative = lag_flutter(&damped(-0.01), 1.225).unwrap().unwrap();
    assert_eq!(negative.speed, 0.0);
}

/// The largest models that users bring: seconds, and the same answer as by halving the number of strips to the second
/// order of the strips' width.
#[test]
fn val_large_models() {
    for (strips, modes) in [(1, 1), (1, 10), (200, 1), (200, 40)] {
        let model = invented(3, strips, modes, 0.0);
        lag_flutter(&model, 1.0).unwrap();
        exact_flutter(&model, 1.0).unwrap();
        divergence_speed(&model, 1.0).unwrap();
    }
    let [coarse, fine] = [100, 200].map(|n| lag_flutter(&invented(3, n, 20, 0.01), 1.0).unwrap().unwrap());
    assert!(
        (coarse.speed / fine.speed - 1.0).abs() < 1e-3,
        "{coarse:?} {fine:?}"
    );
}

/// Goland's wing with the lift slope of a wing of small aspect ratio: the highest mode, at 1800 rad/s, takes a little
/// energy from the smallest breeze, since the slope is not 2 pi. That is reported, and does not hide the flutter.
#[test]
fn val_lift_slope_that_feeds_a_mode() {
    let wing = UniformWing::goland();
    let model = wing.model(&wing.equal_strips(20), 7, 10, &JONES);
    let strips = model
        .strips
        .iter()
        .map(|s| Strip { cl_alpha: 4.0, ..*s })
        .collect();
    let theory = StripTheory::default();
    let model = AeroelasticModel::try_new(
        model.structure,
        strips,
        model.shapes,
        &theory,
        Split::default(),
        &JONES,
    )
    .unwrap();
    let found = neutral_points(&model, 1.225, Kernel::Lags(&JONES)).unwrap();
    assert_eq!(found.unstable_at_rest.len(), 1);
    let a = state_matrix(
        &model,
        Flow {
            rho: 1.225,
            speed: 20.0,
        },
    )
    .unwrap();
    let growing: Vec<f64> = eigen::eigenvalues(a.as_ref())
        .unwrap()
        .iter()
        .filter(|p| p.im > 0.0 && p.re > 0.0)
        .map(|p| p.im)
        .collect();
    assert!(growing.len() == 1 && (growing[0] / found.unstable_at_rest[0] - 1.0).abs() < 1e-3);
    let flutter = lag_flutter(&model, 1.225).unwrap().unwrap();
    assert_eq!(flutter.speed, found.points[0].speed);
    assert!(flutter.speed > 170.0 && flutter.omega_rad_s < 70.0);
}

/// Without air the modes stay where they are, at speed zero too.
#[test]
fn val_no_air() {
    let wing = goland();
    for method in [Method::StateSpace, Method::PK] {
        let found = sweep(&wing, 0.0, &[0.0, 50.0, 400.0], method).unwrap();
        for (k, mode) in found.modes.iter().enumerate() {
            let omega = wing.structure.stiffness[(k, k)].sqrt();
            for p in &mode.eigenvalues {
                assert!(
                    p.re.abs() < 1e-9 * omega && (p.im / omega - 1.0).abs() < 1e-10,
                    "{method:?} {p}"
                );
            }
        }
        let at_rest = sweep(&wing, 1.225, &[0.0], method).unwrap();
        assert_eq!(at_rest.modes.len(), 4);
    }
}
