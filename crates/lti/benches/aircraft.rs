//! Linear analysis of a system of the size of a flexible transport: 12 rigid-body states, 20 modes, 98 pairs of
//! strips with two lags each.

#![allow(clippy::unwrap_used, reason = "a bench stops where it fails")]

use std::hint::black_box;

use albatross_lti::{
    FrequencySolver, Hold, Method, StateSpace, TrackOptions, mode_table, modes_carried_by, simulate, track,
};
use albatross_numerics::{C64, Mat};
use criterion::{Criterion, criterion_group, criterion_main};

const CORE: usize = 52;
const LAGS: usize = 392;

fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// `coupling` = 0 leaves the modes without lags.
fn aircraft(coupling: f64) -> StateSpace {
    let mut random = noise(7);
    let n = CORE + LAGS;
    let a = Mat::from_fn(n, n, |i, j| {
        let r = random();
        let mode = |k: usize| 15.0 + 6.0 * (k % 20) as f64;
        match (i, j) {
            (0..12, 0..12) => {
                if i == j {
                    -0.3 - 0.1 * i as f64
                } else {
                    0.2 * r
                }
            }
            (12..32, 0..CORE) => f64::from(u8::from(j == i + 20)),
            (32..CORE, 0..CORE) if j == i - 20 => -mode(i - 32).powi(2),
            (32..CORE, 0..CORE) => {
                if i == j {
                    -0.05 * mode(i - 32)
                } else {
                    0.3 * r
                }
            }
            (0..12 | 32..CORE, _) => 0.2 * coupling * r,
            (_, 0..12 | 32..CORE) => 0.2 * coupling * r,
            _ => {
                if i == j {
                    -5.0 - 0.4 * ((i - CORE) / 4) as f64 - 60.0 * (i % 2) as f64
                } else {
                    0.0
                }
            }
        }
    });
    let b = Mat::from_fn(n, 2, |i, _| if (12..32).contains(&i) { 0.0 } else { random() });
    let c = Mat::from_fn(8, n, |_, _| random());
    StateSpace::unnamed(a, b, c, Mat::zeros(8, 2)).unwrap()
}

fn frequency(criterion: &mut Criterion) {
    let system = aircraft(1.0);
    let mut group = criterion.benchmark_group("one frequency of 444 states");
    for method in [Method::LagReduced, Method::Eigen, Method::Lu] {
        let solver = FrequencySolver::new(&system, method).unwrap();
        group.bench_function(format!("{method:?}"), |b| {
            b.iter(|| solver.evaluate(black_box(C64::new(0.0, 9.0))))
        });
    }
    group.bench_function("preparing LagReduced", |b| {
        b.iter(|| FrequencySolver::new(&system, Method::LagReduced))
    });
    group.finish();
}

fn modes(criterion: &mut Criterion) {
    let (uncoupled, coupled) = (aircraft(0.0), aircraft(1.0));
    let states: Vec<usize> = (0..CORE).collect();
    let chosen = modes_carried_by(uncoupled.a.as_ref(), &states).unwrap();
    let mut group = criterion.benchmark_group("modes of 444 states");
    group.sample_size(10);
    group.bench_function("mode table", |b| b.iter(|| mode_table(&coupled)));
    group.bench_function("tracking from the uncoupled system", |b| {
        b.iter(|| {
            track(
                uncoupled.a.as_ref(),
                coupled.a.as_ref(),
                &chosen,
                TrackOptions::default(),
            )
        });
    });
    let followed = track(
        uncoupled.a.as_ref(),
        coupled.a.as_ref(),
        &chosen,
        TrackOptions::default(),
    );
    assert!(followed.is_ok(), "{followed:?}");
    let inputs = vec![vec![0.01, 0.0]; 5001];
    group.bench_function("5 s at 1 kHz, exact step", |b| {
        b.iter(|| simulate(&coupled, 1e-3, &inputs, None, Hold::First));
    });
    group.finish();
}

criterion_group!(benches, frequency, modes);
criterion_main!(benches);
