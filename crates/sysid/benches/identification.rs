//! Identification at order 20 from doublets of 5 s at 1 kHz with noise at 40 dB.
//!
//! `one start` is one estimation from one record and one start; `qr` a factorisation of its matrix of sensitivities, the
//! baseline of the same run. `search` is a search of the order, np 4 to 26 with nz = np - 1, three records each alone and
//! together, six starts, on one thread: it runs once and prints what it took, since a sample of it lasts minutes; set
//! `ALBATROSS_BENCH_SEARCH` to run it.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a bench stops where it fails and prints what it measures"
)]

#[path = "../tests/it/systems.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod systems;

use std::hint::black_box;
use std::time::{Duration, Instant};

use albatross_numerics::Mat;
use albatross_numerics::solve::triangle;
use albatross_sysid::{Options, SearchOptions, estimate, search};
use criterion::{Criterion, criterion_group, criterion_main};
use systems::{FREQUENCIES, doublets, ten_pairs};

fn one_record(c: &mut Criterion) {
    let data = doublets(&ten_pairs(FREQUENCIES, 18).state_space(), Some(40.0), 18);
    let record = data.select(&[2]).unwrap();
    let mut options = Options::new(20, 19);
    options.starts = 1;
    options.refined = 1;
    let mut group = c.benchmark_group("identification, order 20, 5001 samples");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    let sensitivities = Mat::from_fn(5001, 41, |i, j| ((i * (j + 1)) as f64 * 0.01).sin());
    group.bench_function("qr", |b| b.iter(|| triangle(black_box(&sensitivities).clone())));
    group.bench_function("one start", |b| {
        b.iter(|| estimate(black_box(&record), &options).unwrap())
    });
    group.finish();
}

fn order_search(_: &mut Criterion) {
    if std::env::var_os("ALBATROSS_BENCH_SEARCH").is_none() {
        return;
    }
    let data = doublets(&ten_pairs(FREQUENCIES, 18).state_space(), Some(40.0), 18);
    let since = Instant::now();
    let found = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap()
        .install(|| search(&data, &SearchOptions::new(4, 26), &|_, _| ()).unwrap());
    println!(
        "search of np 4 to 26, {} estimations, one thread: {:.1} s; {}",
        found.candidates.len(),
        since.elapsed().as_secs_f64(),
        found.reason
    );
}

criterion_group!(benches, one_record, order_search);
criterion_main!(benches);
