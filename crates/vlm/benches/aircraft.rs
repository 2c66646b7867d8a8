//! The surrogate aircraft of 5274 vortices: each stage, and its rate against that of this machine's matrix product.

#![allow(clippy::unwrap_used, reason = "a bench stops where it fails")]
#![allow(clippy::print_stdout, reason = "rates beside the times")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use albatross_avl::geometry::Geometry;
use albatross_avl::run::{RunTarget, RunVariable};
use albatross_numerics::Mat;
use albatross_numerics::faer::linalg::matmul::matmul;
use albatross_numerics::faer::{Accum, Par};
use albatross_vlm::{Influence, Lattice, Method, Solver, Trim};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/");

/// Time of AVL 3.52 for trim and all derivatives of this model on one core, and its memory.
const AVL_SECONDS: f64 = 54.0;

fn lattice() -> (Lattice, f64) {
    let read = |name: &str| std::fs::read_to_string(format!("{CASE}{name}"));
    let (geometry, _) = Geometry::parse(&read("f25.avl").unwrap(), "f25.avl").unwrap();
    let (lattice, _) = Lattice::new(&geometry, &|p| read(p).ok()).unwrap();
    (lattice, geometry.mach)
}

/// Floating-point operations per second of a matrix product of this order on one core.
fn product_rate(n: usize) -> f64 {
    let a = Mat::from_fn(n, n, |i, j| (i + 2 * j) as f64 * 1e-3);
    let mut c = Mat::zeros(n, n);
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        matmul(c.as_mut(), Accum::Replace, a.as_ref(), a.as_ref(), 1.0, Par::Seq);
        best = best.min(start.elapsed().as_secs_f64());
    }
    black_box(&c);
    2.0 * (n as f64).powi(3) / best
}

fn trim(solver: &Solver<'_>) -> f64 {
    let lattice = solver.lattice();
    let mut trim = Trim::new(lattice);
    trim.set(lattice, &RunVariable::Alpha, RunTarget::Lift, 0.5644)
        .unwrap();
    trim.set(
        lattice,
        &RunVariable::Control("elevator".to_owned()),
        RunTarget::PitchMoment,
        0.0,
    )
    .unwrap();
    let solution = solver.trim(&trim).unwrap();
    solution.stability_derivatives("").alpha.lift + solution.body_derivatives("").w.z
}

fn stages(c: &mut Criterion) {
    let (lattice, mach) = lattice();
    let method = Method::AVL_352;

    // One run of each stage, with rates.
    let rate = product_rate(2048);
    let start = Instant::now();
    let influence = Influence::assemble(&lattice, &method, mach).unwrap();
    let assembly = start.elapsed().as_secs_f64();
    let orders = influence.orders();
    let start = Instant::now();
    let factorised = influence.factorise().unwrap();
    let factorisation = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let solver = Solver::from_factorised(factorised);
    let units = start.elapsed().as_secs_f64();
    let start = Instant::now();
    black_box(trim(&solver));
    let trimmed = start.elapsed().as_secs_f64();
    let operations: f64 = orders.iter().map(|&n| 2.0 / 3.0 * (n as f64).powi(3)).sum();
    let pairs = orders.iter().max().map_or(0.0, |&n| n as f64) * lattice.vortices.len() as f64;
    let total = assembly + factorisation + units + trimmed;
    println!("matrix product        {:8.2} Gflop/s", rate * 1e-9);
    println!(
        "assembly              {assembly:8.3} s  {:.1} ns per horseshoe and point",
        assembly / pairs * 1e9
    );
    println!(
        "factorisation {orders:?} {factorisation:8.3} s  {:.2} Gflop/s, {:.0} % of the product's rate",
        operations / factorisation * 1e-9,
        100.0 * operations / factorisation / rate
    );
    println!("unit solutions        {units:8.3} s  30 right-hand sides, velocities at all force points");
    println!("trim and derivatives  {trimmed:8.3} s");
    println!(
        "total                 {total:8.3} s  AVL 3.52 takes {:.0} times as long",
        AVL_SECONDS / total
    );

    let mut group = c.benchmark_group("f25");
    group
        .sample_size(10)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3));
    group.bench_function("assembly", |b| {
        b.iter(|| Influence::assemble(black_box(&lattice), &method, mach).unwrap());
    });
    group.bench_function("factorisation", |b| {
        b.iter_batched(
            || Influence::assemble(&lattice, &method, mach).unwrap(),
            |influence| influence.factorise().unwrap(),
            BatchSize::PerIteration,
        );
    });
    group.bench_function("unit solutions", |b| {
        b.iter_batched(
            || {
                Influence::assemble(&lattice, &method, mach)
                    .unwrap()
                    .factorise()
                    .unwrap()
            },
            Solver::from_factorised,
            BatchSize::PerIteration,
        );
    });
    group.bench_function("trim and derivatives", |b| b.iter(|| trim(black_box(&solver))));
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
