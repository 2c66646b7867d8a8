//! Exact linearisation against central differences of the derivative and of the outputs.

use crate::test_models::{all_options, cruise, flexible, two_modes};
use albatross_flight::{Attitude, EquationsOfMotion, linearize, trim};
use albatross_lti::StateSpace;

/// Derivative and outputs at a state and input.
fn evaluate(equations: &EquationsOfMotion, x: &[f64], u: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; x.len()];
    let mut y = vec![0.0; equations.aircraft().sensors.len()];
    equations
        .derivative(x, u, &mut equations.workspace(), &mut all)
        .unwrap();
    equations.outputs(x, &all, &mut y).unwrap();
    all.extend(y);
    all
}

/// Size of a variation of each state and input: what it may move by in flight.
fn scale(name: &str) -> f64 {
    match name {
        "u" | "v" | "w" => 10.0,
        "h" | "north" | "east" => 1_000.0,
        "thrust" => 1e4,
        n if n.starts_with("lambda") => 1.0,
        _ => 0.1,
    }
}

/// Largest difference to fourth-order central differences: of each row, relative to what the row changes by when every
/// state and input varies by its scale.
fn worst_difference(equations: &EquationsOfMotion, system: &StateSpace, x: &[f64], u: &[f64]) -> f64 {
    const H: f64 = 2e-3;
    let n = x.len();
    let names = system.states.iter().chain(&system.inputs);
    let columns: Vec<(f64, Vec<f64>)> = names
        .enumerate()
        .map(|(j, signal)| {
            let step = H * scale(&signal.name);
            let at = |steps: f64| {
                let (mut x, mut u) = (x.to_vec(), u.to_vec());
                if j < n {
                    x[j] += steps * step
                } else {
                    u[j - n] += steps * step
                }
                evaluate(equations, &x, &u)
            };
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(at);
            let slope = (0..a.len())
                .map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step))
                .collect();
            (scale(&signal.name), slope)
        })
        .collect();
    let exact = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => system.a[(i, j)],
        (true, false) => system.b[(i, j - n)],
        (false, true) => system.c[(i - n, j)],
        (false, false) => system.d[(i - n, j - n)],
    };
    let mut worst = 0.0_f64;
    for i in 0..n + system.outputs.len() {
        let size = columns
            .iter()
            .enumerate()
            .fold(0.0_f64, |m, (j, (s, _))| m.max((exact(i, j) * s).abs()));
        for (j, (s, slope)) in columns.iter().enumerate() {
            let difference = (exact(i, j) - slope[i]).abs() * s;
            worst = worst.max(if size > 0.0 { difference / size } else { difference });
        }
    }
    worst
}

/// All columns in all options, in trim and in a turning, banking, vibrating state. Differences of fourth order at steps of
/// 2e-3 of the scale err by 1e-11 of truncation and 1e-13 / 2e-3 of rounding.
#[test]
fn val_exact_linearisation() {
    let aircraft = flexible(&two_modes());
    for options in all_options() {
        let (equations, trimmed) = trim(&aircraft, options, &cruise()).unwrap();
        let system = linearize(&equations, &trimmed.state, &trimmed.input).unwrap();
        let d = worst_difference(&equations, &system, &trimmed.state, &trimmed.input);
        assert!(d < 1e-9, "trim, {options:?}: {d:e}");

        let mut x = trimmed.state.clone();
        for (i, x) in x.iter_mut().enumerate() {
            let wave = (1.7 * i as f64 + 0.4).sin();
            *x += match i {
                0..3 => 8.0 * wave,
                i if i == equations.layout().altitude() => 300.0,
                _ => 0.15 * wave,
            };
        }
        if options.attitude == Attitude::Quaternion {
            let norm = x[6..10].iter().map(|q| q * q).sum::<f64>().sqrt();
            x[6..10].iter_mut().for_each(|q| *q /= norm);
        }
        let system = linearize(&equations, &x, &trimmed.input).unwrap();
        let d = worst_difference(&equations, &system, &x, &trimmed.input);
        assert!(d < 1e-9, "away from trim, {options:?}: {d:e}");
    }
}

/// Attitude as angles or as a quaternion: the same eigenvalues but for the quaternion's norm, which returns at
/// `2 k = 2 /s`, and the heading, which stays.
#[test]
fn val_attitudes_have_the_same_eigenvalues() {
    let aircraft = flexible(&two_modes());
    let values = |attitude| {
        let options = albatross_flight::ModelOptions {
            attitude,
            ..Default::default()
        };
        let (equations, trimmed) = trim(&aircraft, options, &cruise()).unwrap();
        let system = linearize(&equations, &trimmed.state, &trimmed.input).unwrap();
        albatross_numerics::eigen::eigenvalues(system.a.as_ref()).unwrap()
    };
    let euler = values(Attitude::Euler);
    let mut quaternion = values(Attitude::Quaternion);
    assert_eq!(quaternion.len(), euler.len() + 1);
    for value in &euler {
        let (nearest, d) = quaternion
            .iter()
            .enumerate()
            .map(|(i, v)| (i, (v - value).norm()))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(d < 1e-9 * value.norm().max(1.0), "{value}: {d:e}");
        quaternion.swap_remove(nearest);
    }
    assert!((quaternion[0].re + 2.0).abs() < 1e-9, "{}", quaternion[0]);
}
