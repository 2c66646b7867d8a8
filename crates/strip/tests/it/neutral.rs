//! Neutral points against eigenvalues of the full state matrix, which know nothing of wave numbers.

use crate::models::invented;
use albatross_numerics::{C64, eigen};
use albatross_strip::elastic::state_matrix;
use albatross_strip::kernels::{JONES, Kernel};
use albatross_strip::neutral::{divergence_points, neutral_points};
use albatross_strip::{AeroelasticModel, Flow};

/// Number of growing roots of the state matrix.
fn growing(model: &AeroelasticModel, rho: f64, speed: f64) -> i64 {
    let a = state_matrix(model, Flow { rho, speed }).unwrap();
    let values = eigen::eigenvalues(a.as_ref()).unwrap();
    values.iter().filter(|v| v.re > 1e-9 * v.norm()).count() as i64
}

/// Between neutral points the number of growing roots must be what the points' directions add up to: two for each
/// oscillatory mode, one for each divergence.
#[test]
fn val_count_of_unstable_roots() {
    let (mut flutters, mut recoveries, mut divergences) = (0, 0, 0);
    for seed in 0..100 {
        let (strips, modes) = (1 + seed as usize % 7, 1 + seed as usize % 5);
        let model = invented(seed, strips, modes, if seed % 3 == 0 { 0.01 } else { 0.0 });
        let rho = 1.0;
        let oscillatory = neutral_points(&model, rho, Kernel::Lags(&JONES)).unwrap();
        let diverging = divergence_points(&model, rho, Kernel::Lags(&JONES)).unwrap();
        let mut changes: Vec<(f64, i64)> = oscillatory
            .points
            .iter()
            .map(|p| (p.speed, 2 * p.growth.signum() as i64))
            .chain(diverging.iter().map(|p| (p.speed, p.growth.signum() as i64)))
            .collect();
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        flutters += oscillatory.points.iter().filter(|p| p.growth > 0.0).count();
        recoveries += oscillatory.points.iter().filter(|p| p.growth < 0.0).count();
        divergences += diverging.len();

        let mut expected = 2 * oscillatory.unstable_at_rest.len() as i64;
        let mut from = 0.0;
        let end = 3.0 * changes.last().map_or(50.0, |c| c.0);
        for (to, change) in changes.into_iter().chain([(end, 0)]) {
            for share in [0.01, 0.3, 0.6, 0.99] {
                let speed = from + share * (to - from);
                assert_eq!(
                    growing(&model, rho, speed),
                    expected,
                    "seed {seed} at {speed}: {oscillatory:?} {diverging:?}"
                );
            }
            (from, expected) = (to, expected + change);
        }
        // Each point is an eigenvalue of the state matrix.
        for point in &oscillatory.points {
            let speed = point.speed;
            let a = state_matrix(&model, Flow { rho, speed }).unwrap();
            let nearest = eigen::eigenvalues(a.as_ref())
                .unwrap()
                .iter()
                .map(|v| (v - C64::new(0.0, point.omega_rad_s)).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 1e-9 * point.omega_rad_s,
                "seed {seed}: {nearest:e} {point:?}"
            );
        }
    }
    println!("{flutters} flutter points, {recoveries} recoveries, {divergences} divergences");
    assert!(flutters > 20 && recoveries > 5 && divergences > 20);
}
