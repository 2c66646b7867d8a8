//! Cost of the dense kernels: products with small matrices in a time loop, eigenvalues of a full aircraft.

use std::hint::black_box;

use albatross_numerics::faer::linalg::matmul::matmul;
use albatross_numerics::faer::{Accum, Col, Par};
use albatross_numerics::matrix::{PreparedMatrix, RowMatrix};
use albatross_numerics::{Mat, eigen, nalgebra};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn entry(i: usize, j: usize) -> f64 {
    ((i * 37 + j * 101) % 97) as f64 / 97.0 - 0.5
}

/// y = A x as the time loop needs it, against the libraries underneath.
fn products(c: &mut Criterion) {
    let mut group = c.benchmark_group("y = A x");
    for (rows, cols) in [(200, 20), (20, 200), (52, 52), (392, 26), (26, 392)] {
        let shape = format!("{rows}x{cols}");
        let a = RowMatrix::from_fn(rows, cols, entry);
        let transposed = RowMatrix::from_fn(cols, rows, |i, j| entry(j, i));
        let x: Vec<f64> = (0..cols).map(|j| entry(j, 3)).collect();
        let mut y = vec![0.0; rows];
        group.bench_function(BenchmarkId::new("rows", &shape), |b| {
            b.iter(|| a.mul_into(black_box(&x), black_box(&mut y)));
        });
        group.bench_function(BenchmarkId::new("columns", &shape), |b| {
            b.iter(|| transposed.mul_transposed_into(black_box(&x), black_box(&mut y)));
        });

        let prepared = PreparedMatrix::new(Mat::from_fn(rows, cols, entry).as_ref());
        group.bench_function(BenchmarkId::new("prepared", &shape), |b| {
            b.iter(|| prepared.mul_into(black_box(&x), black_box(&mut y)));
        });

        let (m, v) = (Mat::from_fn(rows, cols, entry), Col::from_fn(cols, |j| x[j]));
        let mut w = Col::<f64>::zeros(rows);
        group.bench_function(BenchmarkId::new("faer", &shape), |b| {
            b.iter(|| {
                matmul(
                    w.as_mut(),
                    Accum::Replace,
                    m.as_ref(),
                    black_box(v.as_ref()),
                    1.0,
                    Par::Seq,
                )
            });
        });

        let m = nalgebra::DMatrix::from_fn(rows, cols, entry);
        let v = nalgebra::DVector::from_column_slice(&x);
        let mut w = nalgebra::DVector::zeros(rows);
        group.bench_function(BenchmarkId::new("nalgebra", &shape), |b| {
            b.iter(|| w.gemv(1.0, &m, black_box(&v), 0.0));
        });
    }
    group.finish();
}

/// 20 modes, 12 rigid-body and 392 lag states.
fn aircraft_like(n: usize) -> Mat<f64> {
    let core = 52.min(n);
    Mat::from_fn(n, n, |i, j| match (i < core, j < core) {
        (true, true) if i == j => -0.5 - 0.1 * i as f64,
        (true, true) => 4.0 * entry(i, j),
        (false, false) if i == j => -2.0 - 0.05 * i as f64,
        (false, false) => 0.0,
        _ => 0.4 * entry(i, j),
    })
}

fn eigenvalues(c: &mut Criterion) {
    let mut group = c.benchmark_group("eigenvalues");
    group.sample_size(10);
    for n in [60, 444] {
        let a = aircraft_like(n);
        group.bench_function(BenchmarkId::new("values", n), |b| {
            b.iter(|| eigen::eigenvalues(a.as_ref()))
        });
        group.bench_function(BenchmarkId::new("both sides", n), |b| {
            b.iter(|| eigen::eigen_both(a.as_ref()))
        });
    }
    group.finish();
}

criterion_group!(benches, products, eigenvalues);
criterion_main!(benches);
