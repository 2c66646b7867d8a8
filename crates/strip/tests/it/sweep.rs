//! Sweeps over speed.

use crate::models::{UniformWing, invented};
use albatross_numerics::{C64, eigen};
use albatross_strip::elastic::{compact_state_matrix, state_matrix};
use albatross_strip::flutter::{divergence_speed, exact_flutter, harmonic_operator, lag_flutter};
use albatross_strip::kernels::JONES;
use albatross_strip::sweep::{Crossing, CrossingKind, Method, SpeedSweep, sweep};
use albatross_strip::{AeroelasticModel, Error, Flow};

fn speeds(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| from + (to - from) * i as f64 / (n - 1) as f64)
        .collect()
}

fn of_kind(found: &SpeedSweep, kind: CrossingKind) -> Vec<Crossing> {
    found
        .crossings
        .iter()
        .copied()
        .filter(|c| c.kind == kind)
        .collect()
}

/// Goland's wing: one flutter, one divergence, at the speeds that the single searches find.
#[test]
fn val_goland_by_both_methods() {
    let wing = UniformWing::goland();
    let model = wing.model(&wing.equal_strips(20), 7, 6, &JONES);
    let rho = 1.225;
    let at = speeds(0.0, 300.0, 13);
    for (method, point) in [
        (Method::StateSpace, lag_flutter(&model, rho)),
        (Method::PK, exact_flutter(&model, rho)),
    ] {
        let point = point.unwrap().unwrap();
        let found = sweep(&model, rho, &at, method).unwrap();
        let flutter = of_kind(&found, CrossingKind::Flutter);
        assert_eq!(flutter.len(), 1);
        assert!((flutter[0].speed / point.speed - 1.0).abs() < 1e-10);
        assert!((flutter[0].omega_rad_s / point.omega_rad_s - 1.0).abs() < 1e-10);
        // The wing flutters in torsion: the second mode of still air.
        assert!(
            flutter[0].unstable_above && flutter[0].mode == Some(1),
            "{flutter:?}"
        );
        let divergence = of_kind(&found, CrossingKind::Divergence);
        let expected = divergence_speed(&model, rho).unwrap().unwrap();
        assert!(divergence.len() == 1 && (divergence[0].speed / expected - 1.0).abs() < 1e-12);
        assert_eq!(found.modes.len(), 6);
        for mode in &found.modes {
            assert_eq!(mode.eigenvalues.len(), 13);
            assert!(mode.confidence.iter().all(|c| *c > 0.7), "{:?}", mode.confidence);
        }
        assert_eq!(found.notes, Vec::<String>::new());
    }
}

/// The two methods agree in eigenvalues to the error of Jones's lags where damping is small.
#[test]
fn val_methods_agree_at_small_damping() {
    let wing = UniformWing::goland();
    let model = wing.model(&wing.equal_strips(10), 7, 4, &JONES);
    let at = speeds(10.0, 60.0, 4);
    let [a, b] = [Method::StateSpace, Method::PK].map(|m| sweep(&model, 1.225, &at, m).unwrap());
    for (p, q) in a.modes.iter().zip(&b.modes) {
        for (x, y) in p.eigenvalues.iter().zip(&q.eigenvalues) {
            assert!((x - y).norm() < 0.01 * x.norm(), "{x} {y}");
        }
    }
}

/// The compact state matrix has the eigenvalues of the full one, and lag rates in place of what it leaves out.
#[test]
fn val_compact_state_matrix() {
    let wing = UniformWing::goland();
    let flow = Flow {
        rho: 1.1,
        speed: 90.0,
    };
    for (strips, modes, states) in [(12, 3, 2 * 3 + 2 * 3), (2, 3, 2 * 3 + 2 * 2)] {
        let model = wing.model(&wing.equal_strips(strips), 7, modes, &JONES);
        let compact = compact_state_matrix(&model, flow).unwrap();
        assert_eq!(compact.nrows(), states);
        contains_all(
            &eigen::eigenvalues(state_matrix(&model, flow).unwrap().as_ref()).unwrap(),
            &eigen::eigenvalues(compact.as_ref()).unwrap(),
            1e-9,
        );
    }
    let tapered = invented(4, 5, 3, 0.01);
    let compact = compact_state_matrix(&tapered, flow).unwrap();
    contains_all(
        &eigen::eigenvalues(state_matrix(&tapered, flow).unwrap().as_ref()).unwrap(),
        &eigen::eigenvalues(compact.as_ref()).unwrap(),
        1e-9,
    );
}

fn contains_all(values: &[C64], sought: &[C64], tolerance: f64) {
    let scale = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
    for p in sought {
        let nearest = values
            .iter()
            .map(|v| (v - p).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(nearest <= tolerance * scale, "{p} is off by {nearest:e}");
    }
}

/// Smallest singular value of the harmonic operator over its largest entry.
fn singularity(model: &AeroelasticModel, rho: f64, p: C64, speed: f64) -> f64 {
    let f = harmonic_operator(model, rho, p, speed).unwrap();
    let values = f.singular_values().unwrap();
    values.iter().copied().fold(f64::INFINITY, f64::min) / f.norm_max()
}

/// What the checks below add up.
#[derive(Debug, Default)]
struct Tally {
    values: usize,
    lost: usize,
    flutter: usize,
    unnamed: usize,
    /// Modes that change sides between two speeds without as many crossings, to parity.
    unexplained: usize,
}

/// Sweeps of many invented wings: every value must be a root of its own equation.
fn tally(method: Method, seeds: std::ops::Range<u64>, to: f64) -> Tally {
    let rho = 1.0;
    let at = speeds(5.0, to, 12);
    let mut tally = Tally::default();
    for seed in seeds {
        let (strips, modes) = (2 + seed as usize % 5, 2 + seed as usize % 6);
        let model = invented(seed, strips, modes, if seed % 2 == 0 { 0.02 } else { 0.0 });
        let found = sweep(&model, rho, &at, method).unwrap();
        assert_eq!(found.modes.len(), modes);
        let flutter = of_kind(&found, CrossingKind::Flutter);
        tally.flutter += flutter.len();
        tally.unnamed += flutter.iter().filter(|c| c.mode.is_none()).count();
        for (i, &speed) in at.iter().enumerate() {
            let known: Vec<C64> = found
                .modes
                .iter()
                .map(|m| m.eigenvalues[i])
                .filter(|p| p.is_finite())
                .collect();
            tally.values += modes;
            tally.lost += modes - known.len();
            match method {
                Method::StateSpace => {
                    let a = state_matrix(&model, Flow { rho, speed }).unwrap();
                    contains_all(&eigen::eigenvalues(a.as_ref()).unwrap(), &known, 1e-9);
                }
                Method::PK => {
                    for p in known {
                        let s = singularity(&model, rho, p, speed);
                        assert!(s < 1e-11, "seed {seed} {speed} {p}: {s:e}");
                    }
                }
            }
        }
        for (m, mode) in found.modes.iter().enumerate() {
            for (i, pair) in at.windows(2).enumerate() {
                let (a, b) = (mode.eigenvalues[i], mode.eigenvalues[i + 1]);
                let crossings = found
                    .crossings
                    .iter()
                    .filter(|c| c.mode == Some(m) && c.speed > pair[0] && c.speed <= pair[1])
                    .count();
                let changes = (a.re > 0.0) != (b.re > 0.0);
                // Real roots of the p-k method are a branch of their own.
                let one_branch = method == Method::StateSpace || (a.im > 0.0 && b.im > 0.0);
                if a.is_finite() && b.is_finite() && one_branch && changes != (crossings % 2 == 1) {
                    tally.unexplained += 1;
                }
            }
        }
    }
    println!("{method:?} to {to} m/s: {tally:?}");
    tally
}

/// Speeds far beyond any sense: no mode is lost, no crossing without its mode.
#[test]
fn prop_state_space_sweeps() {
    let found = tally(Method::StateSpace, 0..60, 2000.0);
    assert!(found.flutter > 60);
    assert_eq!((found.lost, found.unnamed, found.unexplained), (0, 0, 0));
}

/// The p-k method's roots need not continue where they come to the real axis; elsewhere the same holds.
#[test]
fn prop_p_k_sweeps() {
    let found = tally(Method::PK, 0..60, 300.0);
    assert!(found.flutter > 15);
    assert_eq!((found.unnamed, found.unexplained), (0, 0));
    assert!(found.lost * 200 < found.values);
    let found = tally(Method::PK, 0..60, 2000.0);
    assert!(found.lost * 20 < found.values && found.unnamed * 20 < found.flutter);
}

#[test]
fn prop_bad_speeds_are_errors() {
    let model = invented(1, 3, 2, 0.0);
    let run = |rho: f64, at: &[f64]| sweep(&model, rho, at, Method::StateSpace);
    assert_eq!(run(1.0, &[]), Err(Error::Empty { what: "speeds" }));
    assert!(matches!(run(1.0, &[1.0, f64::NAN]), Err(Error::BadFlow { .. })));
    assert!(matches!(run(-1.0, &[1.0]), Err(Error::BadFlow { .. })));
    assert_eq!(
        run(1.0, &[2.0, 1.0]),
        Err(Error::NotIncreasing {
            index: 1,
            previous: 2.0,
            found: 1.0
        })
    );
}
