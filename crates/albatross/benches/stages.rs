//! The stages of the F25-like surrogate, each with its count of operations or bytes, beside the two floors of the machine
//! in the same run: the rate of a matrix product and the bandwidth of a copy, both on one core.
//!
//! Counts are of the method's arithmetic, not of what the compiler made of it: a product of two numbers and a sum are two
//! operations, a complex product eight. `docs/PERFORMANCE.md` says how each is counted.

#![allow(missing_docs, clippy::unwrap_used, reason = "a bench stops where it fails")]

use albatross::analysis::{self, Trimmed};
use albatross::flight::lag_form::diagonal_lag_form;
use albatross::lti::{FrequencySolver, LagForm};
use albatross::numerics::faer::linalg::matmul::matmul;
use albatross::numerics::faer::{Accum, Par};
use albatross::numerics::{C64, Mat, eigen};
use albatross::{Inputs, Model, root_locus};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::PathBuf;

/// Order of the matrix product.
const ORDER: usize = 512;
/// Bytes of the copy: beyond any cache.
const COPIED: usize = 128 << 20;
/// Points of the frequency response.
const POINTS: usize = 2000;

fn fixture(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like")).join(name)
}

fn floors(c: &mut Criterion) {
    let mut group = c.benchmark_group("floor");
    group.sample_size(20);
    let a = Mat::from_fn(ORDER, ORDER, |i, j| ((i * 37 + j * 101) % 97) as f64 / 97.0 - 0.5);
    let mut product = Mat::zeros(ORDER, ORDER);
    group.throughput(Throughput::Elements(2 * (ORDER as u64).pow(3)));
    group.bench_function("matrix product", |b| {
        b.iter(|| {
            matmul(
                product.as_mut(),
                Accum::Replace,
                black_box(a.as_ref()),
                a.as_ref(),
                1.0,
                Par::Seq,
            );
        });
    });
    let from = vec![1_u8; COPIED];
    let mut to = vec![0_u8; COPIED];
    group.throughput(Throughput::Bytes(COPIED as u64));
    group.bench_function("copy", |b| b.iter(|| to.copy_from_slice(black_box(&from))));
    group.finish();
}

fn reading(c: &mut Criterion) {
    let mut group = c.benchmark_group("stages");
    let f06 = std::fs::read(fixture("f25.f06")).unwrap();
    group.throughput(Throughput::Bytes(f06.len() as u64));
    group.bench_function("results of the modes (.f06)", |b| {
        b.iter(|| albatross::inputs::read_results(&fixture("f25.f06")).unwrap());
    });
    let deck = std::fs::read(fixture("f25.bdf")).unwrap();
    group.throughput(Throughput::Bytes(deck.len() as u64));
    group.bench_function("deck (.bdf)", |b| {
        b.iter(|| albatross::nastran::bdf::read_strict(fixture("f25.bdf")).unwrap());
    });
    group.finish();
}

/// Operations of one evaluation of the derivative: its products of matrices with vectors.
fn evaluation(trimmed: &Trimmed) -> u64 {
    let layout = trimmed.equations.layout();
    let (n, strips, lags) = (layout.n_modes, layout.n_strips, layout.n_lags);
    let entries =
        (n + 6) * 2 * n + (n + 6) * strips + n * 2 * n + 6 * n + 2 * n * n + strips * 2 * n + 2 * lags;
    2 * entries as u64
}

fn analyses(c: &mut Criterion) {
    let inputs = Inputs::read(&fixture("case.toml")).unwrap();
    let variant = inputs.case.variant(None).unwrap();
    let model = Model::build(&inputs, &variant).unwrap();
    let trimmed = analysis::trimmed(&model).unwrap();
    let flying = analysis::trimmed_for_simulation(&model).unwrap();
    let layout = trimmed.equations.layout();
    let states = layout.n_states() as u64;
    let mut group = c.benchmark_group("stages");
    group.sample_size(10);

    group.bench_function("model of the case", |b| {
        b.iter(|| Model::build(&inputs, &variant).unwrap())
    });

    // One evaluation a state and input, of dual numbers: each product is two products and a sum.
    let columns = states + trimmed.equations.n_inputs() as u64;
    group.throughput(Throughput::Elements(2 * columns * evaluation(&trimmed)));
    group.bench_function("trim and linearisation", |b| {
        b.iter(|| analysis::trimmed(&model).unwrap())
    });

    let mut manoeuvre = inputs.case.manoeuvres.first().unwrap().clone();
    manoeuvre.end = 5.0;
    let flown = analysis::simulate_case(&inputs, &flying, &manoeuvre).unwrap();
    group.throughput(Throughput::Elements(
        flown.evaluations as u64 * evaluation(&flying),
    ));
    group.bench_function("5 s of flight at 1 kHz", |b| {
        b.iter(|| analysis::simulate_case(&inputs, &flying, &manoeuvre).unwrap());
    });

    let diagonal = diagonal_lag_form(&trimmed.system, &trimmed.equations, trimmed.trim.speed()).unwrap();
    let lag_names: Vec<&str> = diagonal.states[layout.lags()]
        .iter()
        .map(|s| s.name.as_str())
        .collect();
    let outputs: Vec<&str> = diagonal.outputs.iter().take(8).map(|o| o.name.as_str()).collect();
    let channel = diagonal.select(&[&model.point.control], &outputs).unwrap();
    let omega: Vec<f64> = (0..POINTS)
        .map(|i| 0.05 * 4000_f64.powf(i as f64 / POINTS as f64))
        .collect();
    // What a dense resolvent would need is no floor; counted is the elimination: the lags' matrix of 34 x 41 from a group
    // for each pair of strips, and complex factors of half the core.
    let core = states as usize - layout.n_lags;
    let group_count = layout.n_strips.div_ceil(2);
    let order = core - layout.n_modes;
    let rows = layout.n_modes + 6 + outputs.len();
    let point = 4 * group_count * rows * (2 * layout.n_modes + 1) + 8 * order.pow(3) / 3;
    group.throughput(Throughput::Elements((POINTS * point) as u64));
    group.bench_function("frequency response, 2000 points, 8 outputs", |b| {
        b.iter(|| {
            FrequencySolver::with_lags(&channel, &lag_names)
                .unwrap()
                .response(&omega)
                .unwrap()
        });
    });

    let modes = analysis::mode_table_without_lags(&model, &trimmed).unwrap();
    let moving: Vec<usize> = (0..diagonal.states.len())
        .filter(|&i| !["psi", "north", "east"].contains(&diagonal.states[i].name.as_str()))
        .collect();
    let a = Mat::from_fn(moving.len(), moving.len(), |i, j| {
        diagonal.a[(moving[i], moving[j])]
    });
    let lags: Vec<usize> = (moving.len() - layout.n_lags..moving.len()).collect();
    let flexible = modes.rigid_body.iter().filter_map(|m| m.flexible.as_ref());
    let wanted: Vec<C64> = modes
        .elastic
        .iter()
        .map(|m| C64::new(m.re, m.im))
        .chain(flexible.map(|m| m.eigenvalue()))
        .collect();
    let n = core - (states as usize - moving.len());
    // A root: the matrix of the order of the core from all lags, twice factorised.
    let root = 2 * (4 * layout.n_lags * (layout.n_modes + 6) * 2 * layout.n_modes + 8 * n.pow(3) / 3);
    group.throughput(Throughput::Elements((wanted.len() * root) as u64));
    group.bench_function("eigenvalues of interest, lags eliminated", |b| {
        b.iter(|| {
            let form = LagForm::new(black_box(a.as_ref()), &lags).unwrap();
            wanted
                .iter()
                .map(|value| form.root(*value).unwrap().value)
                .collect::<Vec<_>>()
        });
    });
    group.throughput(Throughput::Elements(10 * (moving.len() as u64).pow(3)));
    group.bench_function("all eigenvalues, dense", |b| {
        b.iter(|| eigen::eigenvalues(black_box(a.as_ref())).unwrap());
    });
    group.throughput(Throughput::Elements((wanted.len() * 10 * root / 2) as u64));
    group.bench_function("modes followed through the lags", |b| {
        b.iter(|| analysis::mode_table_without_lags(&model, &trimmed).unwrap());
    });
    let speeds = root_locus::speeds_around(model.point.speed, 0.6, 1.3, 13);
    group.throughput(Throughput::Elements(13 * 10 * (moving.len() as u64).pow(3)));
    group.bench_function("root locus of 13 speeds", |b| {
        b.iter(|| root_locus::root_locus(&model, &modes, &speeds).unwrap());
    });
    group.finish();
}

criterion_group!(benches, floors, reading, analyses);
criterion_main!(benches);
