//! Cost of matrices, flutter searches and sweeps of a tapered wing, beside dense algebra of the same size in the same
//! run.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark"
)]

use std::hint::black_box;
use std::time::Instant;

use albatross_numerics::{Mat, eigen};
use albatross_strip::elastic::state_matrix;
use albatross_strip::flutter::{exact_flutter, lag_flutter};
use albatross_strip::forces::generalized_forces;
use albatross_strip::sweep::{Method, sweep};
use albatross_strip::{AeroelasticModel, Flow, Split, StripTheory};
use criterion::{Criterion, criterion_group, criterion_main};

#[path = "../tests/it/models.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests")]
mod models;

/// As many strips and modes as a large transport has: 432 states.
const STRIPS: usize = 196;
const MODES: usize = 20;
const FLOW: Flow = Flow {
    rho: 1.0,
    speed: 100.0,
};

fn assemble(model: &AeroelasticModel) -> f64 {
    let theory = StripTheory::default();
    let q = generalized_forces(
        &model.strips,
        &model.shapes,
        &model.shapes,
        &theory,
        Split::default(),
    );
    q.unwrap().eta_eta_c[(0, 0)]
}

fn single(c: &mut Criterion) {
    let model = models::invented(3, STRIPS, MODES, 0.01);
    let tall = Mat::from_fn(STRIPS, MODES, |i, j| ((i * 37 + j * 101) % 97) as f64);
    let a = state_matrix(&model, FLOW).unwrap();
    let mut group = c.benchmark_group("matrices");
    group.bench_function("generalised forces", |b| b.iter(|| assemble(black_box(&model))));
    group.bench_function("dense: five products of 20 x 196 by 196 x 20", |b| {
        b.iter(|| {
            (0..5)
                .map(|_| (black_box(&tall).transpose() * &tall)[(0, 0)])
                .sum::<f64>()
        });
    });
    group.bench_function("state matrix", |b| {
        b.iter(|| state_matrix(black_box(&model), FLOW))
    });
    group.bench_function("dense: copy of the state matrix", |b| {
        b.iter(|| black_box(&a).clone())
    });
    group.finish();
}

/// Median seconds of three runs.
fn seconds<T>(mut run: impl FnMut() -> T) -> f64 {
    let mut times: Vec<f64> = (0..3)
        .map(|_| {
            let start = Instant::now();
            black_box(run());
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[1]
}

/// Searches and sweeps in units of one dense eigenvalue problem of the state matrix.
fn ratios(_: &mut Criterion) {
    for (strips, modes) in [(40, 6), (STRIPS, MODES)] {
        let model = models::invented(3, strips, modes, 0.01);
        let a = state_matrix(&model, FLOW).unwrap();
        let at: Vec<f64> = (1..=20).map(|i| 10.0 * f64::from(i)).collect();
        let values = seconds(|| eigen::eigenvalues(a.as_ref()).unwrap());
        println!(
            "\n{strips} strips, {modes} modes: eigenvalues of {} states {:.4} s",
            a.nrows(),
            values
        );
        let row = |what: &str, time: f64| println!("  {what:<44}{time:>9.4} s{:>9.2} x", time / values);
        row(
            "both eigenvectors",
            seconds(|| eigen::eigen_both(a.as_ref()).unwrap()),
        );
        row("state matrix", seconds(|| state_matrix(&model, FLOW).unwrap()));
        row("lowest flutter speed, lags", seconds(|| lag_flutter(&model, 1.0)));
        row(
            "lowest flutter speed, Theodorsen",
            seconds(|| exact_flutter(&model, 1.0)),
        );
        row(
            "sweep of 20 speeds, state space",
            seconds(|| sweep(&model, 1.0, &at, Method::StateSpace)),
        );
        row(
            "sweep of 20 speeds, p-k",
            seconds(|| sweep(&model, 1.0, &at, Method::PK)),
        );
    }
}

criterion_group!(benches, single, ratios);
criterion_main!(benches);
