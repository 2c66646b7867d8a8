//! Grillages numbered at random. Without torsion stiffness and with half bars on the edges the discrete problem is
//! separable, `K = Kx (x) Wy + Wx (x) Ky`, `M = (mx + my) Wx (x) Wy`: its eigenvalues are sums of those of two free
//! beams with lumped mass, whose lowest are Euler's.

use crate::grillage_deck::{E, I_X, I_Y, MU, STEP, grillage};
use crate::support::{close, model, modes};

/// (beta L)^4 of the free beam, rigid motions first.
fn euler(k: usize) -> f64 {
    const ROOTS: [f64; 6] = [
        0.0,
        0.0,
        4.730_040_744_9,
        7.853_204_624_1,
        10.995_607_838,
        14.137_165_491_3,
    ];
    ROOTS
        .get(k)
        .copied()
        .unwrap_or((k as f64 - 0.5) * std::f64::consts::PI)
        .powi(4)
}

/// Lowest eigenvalues of the separable grillage by Euler's beams; the mass belongs to bars of both directions.
fn expected(nx: usize, ny: usize, count: usize) -> Vec<f64> {
    let of = |n: usize, i: f64, k: usize| euler(k) * E * i / (2.0 * MU) / ((n - 1) as f64 * STEP).powi(4);
    let mut all: Vec<f64> = (0..count)
        .flat_map(|a| (0..count).map(move |b| of(nx, I_X, a) + of(ny, I_Y, b)))
        .collect();
    all.sort_by(f64::total_cmp);
    all.truncate(count);
    all
}

fn check(nx: usize, ny: usize, count: usize, tolerance: f64) {
    let deck = grillage(nx, ny, 0.0, false);
    let start = std::time::Instant::now();
    let model = model(&deck);
    let assembled = start.elapsed();
    let modes = modes(&model, count);
    println!(
        "{nx} x {ny}: assembled in {assembled:.2?}, all in {:.2?}, factor {:.1e} entries",
        start.elapsed(),
        modes.factor_entries as f64
    );
    let worst = modes.residuals.iter().fold(0.0_f64, |m, &r| m.max(r));
    assert!(worst < 1e-9, "{worst:e}");
    // Four motions without strain out of plane (with the saddle x y), three in plane.
    let rigid: f64 = modes.eigenvalues[..7].iter().fold(0.0, |m, l| m.max(l.abs()));
    assert!(
        rigid < 1e-5 * modes.eigenvalues[7],
        "{rigid:e} {:e}",
        modes.eigenvalues[7]
    );
    // None is missed, by Sturm's count in the last gap between pairs.
    let f = &modes.frequencies_hz;
    let gap = (7..count - 1)
        .rev()
        .find(|&k| f[k + 1] > 1.001 * f[k])
        .expect("a gap");
    assert_eq!(
        model.count_below(0.5 * (f[gap] + f[gap + 1])).expect("a count"),
        gap + 1
    );
    let euler = expected(nx, ny, count);
    for (got, euler) in modes.eigenvalues[7..].iter().zip(&euler[4..]) {
        close(*got, *euler, tolerance);
    }
}

/// Lumped mass converges at second order: the fifth wave on 24 bars is 2 % off.
#[test]
fn val_small_separable_grillage() {
    check(16, 25, 17, 0.08);
}

/// 20,000 grids, 120,000 freedoms, 40 modes.
#[test]
#[cfg_attr(
    not(feature = "validation"),
    ignore = "tens of seconds; run with the feature validation"
)]
fn val_large_separable_grillage() {
    check(100, 200, 40, 0.01);
}

/// The same without zeros in the matrices: any direction of the plane, torsion, so that nothing decouples.
#[test]
#[cfg_attr(
    not(feature = "validation"),
    ignore = "tens of seconds; run with the feature validation"
)]
fn val_large_skew_grillage() {
    let deck = grillage(100, 200, 1e-6, true);
    let start = std::time::Instant::now();
    let model = model(&deck);
    let assembled = start.elapsed();
    let modes = modes(&model, 40);
    println!(
        "skew: assembled in {assembled:.2?}, all in {:.2?}, factor {:.1e} entries",
        start.elapsed(),
        modes.factor_entries as f64
    );
    let worst = modes.residuals.iter().fold(0.0_f64, |m, &r| m.max(r));
    assert!(worst < 1e-9, "{worst:e}");
    assert!(modes.eigenvalues[5].abs() < 1e-5 * modes.eigenvalues[6]);
}
