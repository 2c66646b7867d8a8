//! Cost of non-linear flight: the full F25-like model (20 modes, all strips, 12 rigid-body states) for 5 s at 1 kHz,
//! beside a dense state matrix of the same size under the same Runge-Kutta method.

#![allow(
    missing_docs,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a bench stops where it fails and prints what it measures"
)]

use albatross::flight::signal::{Edges, Side, Signal};
use albatross::flight::{EquationsOfMotion, Manoeuvre, Method, Trim, linearize, simulate};
use albatross::lti::{StateSpace, simulate_rk4};
use albatross::{Inputs, Model};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

const STEP: f64 = 1e-3;
const STEPS: usize = 5000;

fn full_model() -> (EquationsOfMotion, Trim) {
    let case = Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/f25-like/case.toml"
    ));
    let inputs = Inputs::read(case).expect("the F25-like case");
    let variant = inputs.case.variant(None).expect("a variant");
    let model = Model::build(&inputs, &variant).expect("the model");
    model.trim().expect("a trim")
}

/// A 3 Hz doublet of 1 deg.
const DOUBLET: Signal = Signal::Doublet {
    amplitude: 0.0175,
    start: 0.5,
    period: 1.0 / 3.0,
    edges: Edges::Smooth,
};

fn manoeuvre(elevator: usize, method: Method) -> Manoeuvre {
    Manoeuvre {
        dt: STEP,
        end: STEPS as f64 * STEP,
        output_every: 1,
        method,
        inputs: vec![(elevator, DOUBLET)],
    }
}

fn dense(system: &StateSpace, elevator: usize) {
    let history = simulate_rk4(system, STEP, STEPS, None, |t, _, u| {
        u.fill(0.0);
        u[elevator] = DOUBLET.at(t, Side::Right);
    });
    black_box(history.expect("a linear history"));
}

/// Shortest of `n` runs: the other work of the machine only lengthens them.
fn shortest(n: usize, mut run: impl FnMut()) -> Duration {
    let timed = (0..n).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed()
    });
    timed.min().unwrap_or_default()
}

fn simulation(c: &mut Criterion) {
    let (equations, trim) = full_model();
    let elevator = equations
        .aircraft()
        .control_index("elevator")
        .expect("an elevator");
    let system = linearize(&equations, &trim.state, &trim.input).expect("a linear model");
    let n = equations.layout().n_states();
    let [rk4, exact] = [Method::Rk4, Method::ExactLags].map(|method| manoeuvre(elevator, method));
    let fly = |m: &Manoeuvre| drop(black_box(simulate(&equations, &trim, m).expect("a history")));

    let mut group = c.benchmark_group(format!("5 s at 1 kHz, {n} states"));
    group.sample_size(10);
    group.bench_function("non-linear, RK4", |b| b.iter(|| fly(&rk4)));
    group.bench_function("non-linear, exact lags", |b| b.iter(|| fly(&exact)));
    group.bench_function("dense state matrix, RK4", |b| b.iter(|| dense(&system, elevator)));
    group.finish();

    let mut work = equations.workspace();
    let mut xdot = vec![0.0; n];
    c.bench_function("one evaluation of the derivative", |b| {
        b.iter(|| equations.derivative(black_box(&trim.state), &trim.input, &mut work, &mut xdot));
    });

    let (non_linear, matrix) = (
        shortest(10, || fly(&rk4)),
        shortest(5, || dense(&system, elevator)),
    );
    println!(
        "{n} states, 5 s at 1 kHz: non-linear {:.4} s ({:.0} ns for each of 20 000 evaluations with its share of the step), dense state matrix {:.4} s; ratio {:.1}",
        non_linear.as_secs_f64(),
        non_linear.as_secs_f64() * 1e9 / (4 * STEPS) as f64,
        matrix.as_secs_f64(),
        matrix.as_secs_f64() / non_linear.as_secs_f64(),
    );
}

criterion_group!(benches, simulation);
criterion_main!(benches);
