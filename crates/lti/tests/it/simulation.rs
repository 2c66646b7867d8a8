use albatross_lti::simulation::{Discrete, discretise};
use albatross_lti::{Error, Hold, OutputSimulator, StateSpace, simulate, simulate_rk4};
use albatross_numerics::Mat;
use albatross_numerics::integrate::Stage;
use proptest::prelude::*;

use crate::models::{aeroelastic, double_integrator, mat, noise, oscillator};

/// 1 - exp(-zeta w t)(cos wd t + zeta/sqrt(1 - zeta^2) sin wd t).
fn step_response(omega: f64, zeta: f64, t: f64) -> f64 {
    let root = (1.0 - zeta * zeta).sqrt();
    1.0 - (-zeta * omega * t).exp() * ((omega * root * t).cos() + zeta / root * (omega * root * t).sin())
}

#[test]
fn val_step_response_is_exact_at_any_step() {
    let (omega, zeta) = (5.0, 0.07);
    for dt in [0.01, 0.3, 1.7] {
        let inputs = vec![vec![1.0]; 20];
        let history = simulate(&oscillator(omega, zeta), dt, &inputs, None, Hold::Zero).unwrap();
        for (y, t) in history.output("y").unwrap().iter().zip(&history.time_s) {
            assert!((y - step_response(omega, zeta, *t)).abs() < 2e-13, "{dt} {t}");
        }
    }
}

#[test]
fn val_ramp_response_is_exact_with_the_first_order_hold() {
    // Double integrator under u = t: x = t^3/6.
    let dt = 0.37;
    let inputs: Vec<Vec<f64>> = (0..12).map(|k| vec![f64::from(k) * dt]).collect();
    let history = simulate(&double_integrator(), dt, &inputs, None, Hold::First).unwrap();
    for (y, t) in history.output("y1").unwrap().iter().zip(&history.time_s) {
        assert!((y - t.powi(3) / 6.0).abs() < 1e-13 * (1.0 + y));
    }
    // Free fall with initial state.
    let fall = simulate(
        &double_integrator(),
        dt,
        &vec![vec![-9.81]; 5],
        Some(&[3.0, 2.0]),
        Hold::Zero,
    )
    .unwrap();
    let t = 4.0 * dt;
    assert!((fall.state("x1").unwrap()[4] - (3.0 + 2.0 * t - 0.5 * 9.81 * t * t)).abs() < 1e-13);
}

#[test]
fn val_rk4_converges_to_the_exact_answer_with_order_four() {
    let system = aeroelastic(3, 8, 2);
    let input = |t: f64| (3.0 * t).sin();
    let run = |steps: usize| {
        let history = simulate_rk4(&system, 2.0 / steps as f64, steps, None, |t, _, u| {
            u.fill(input(t))
        });
        history.unwrap().output("y2").unwrap()
    };
    let reference = run(6400);
    let error = |steps: usize| {
        let differences = run(steps)
            .into_iter()
            .zip(reference.iter().step_by(6400 / steps))
            .map(|(p, q)| (p - q).abs());
        differences.fold(0.0, f64::max)
    };
    let order = (error(200) / error(400)).log2();
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

#[test]
fn val_stages_of_a_jump_reach_the_input() {
    // u jumps from 0 to 1 at t = 1, a grid point: with one-sided limits the answer is the exact ramp.
    let integrator =
        StateSpace::unnamed(mat(&[&[0.0]]), mat(&[&[1.0]]), mat(&[&[1.0]]), mat(&[&[0.0]])).unwrap();
    let history = simulate_rk4(&integrator, 0.25, 8, None, |t, stage, u| {
        let from_left = stage == Stage::End;
        u[0] = if t > 1.0 || (t == 1.0 && !from_left) {
            1.0
        } else {
            0.0
        };
    })
    .unwrap();
    let y = history.output("y1").unwrap();
    assert_eq!(y, [0.0, 0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn val_direct_path_and_errors() {
    let gain = StateSpace::unnamed(
        Mat::zeros(0, 0),
        Mat::zeros(0, 1),
        Mat::zeros(1, 0),
        mat(&[&[3.0]]),
    )
    .unwrap();
    let history = simulate(&gain, 0.1, &[vec![1.0], vec![-2.0]], None, Hold::First).unwrap();
    assert_eq!(history.output("y1").unwrap(), [3.0, -6.0]);
    let system = oscillator(1.0, 0.1);
    let run =
        |dt: f64, inputs: &[Vec<f64>], x0: Option<&[f64]>| simulate(&system, dt, inputs, x0, Hold::Zero);
    assert!(matches!(run(0.0, &[], None), Err(Error::Domain { .. })));
    assert!(matches!(
        run(0.1, &[vec![1.0], vec![]], None),
        Err(Error::InputWidth {
            sample: 1,
            expected: 1,
            found: 0
        })
    ));
    assert!(matches!(run(0.1, &[], Some(&[1.0])), Err(Error::Numerics(_))));
    assert!(matches!(history.output("y"), Err(Error::UnknownSignal { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Two steps of dt are one of 2 dt, and a superposition of inputs superposes the outputs.
    #[test]
    fn prop_semigroup_and_superposition(seed in 0_u64..500, dt in 0.005..0.3_f64) {
        let system = aeroelastic(2, 5, seed);
        let Discrete { phi, gamma0, .. } = discretise(&system, dt, Hold::Zero).unwrap();
        let double = discretise(&system, 2.0 * dt, Hold::Zero).unwrap();
        let (phi2, gamma2) = (&phi * &phi, &phi * &gamma0 + &gamma0);
        let largest = |m: &Mat<f64>| albatross_numerics::matrix::max_abs(m.as_ref());
        prop_assert!(largest(&(&phi2 - &double.phi)) < 1e-11 * largest(&double.phi));
        prop_assert!(largest(&(&gamma2 - &double.gamma0)) < 1e-11 * largest(&double.gamma0));

        let mut random = noise(seed + 9);
        let mut signal = || (0..30).map(|_| vec![random(), random()]).collect::<Vec<_>>();
        let (p, q) = (signal(), signal());
        let both: Vec<Vec<f64>> = p.iter().zip(&q).map(|(p, q)| vec![p[0] - 2.0 * q[0], p[1] - 2.0 * q[1]]).collect();
        let [p, q, both] = [p, q, both].map(|u| simulate(&system, dt, &u, None, Hold::First).unwrap().output("y1").unwrap());
        let size = p.iter().chain(&q).fold(1.0_f64, |m, v| m.max(v.abs()));
        for k in 0..30 {
            prop_assert!((both[k] - p[k] + 2.0 * q[k]).abs() < 1e-12 * size);
        }
    }
}

/// scipy 1.17.1, signal.lsim with interp = True (linear between samples) and False (held).
#[test]
fn val_two_inputs_against_scipy() {
    let system = StateSpace::unnamed(
        mat(&[&[-0.6, 1.1, 0.2], &[-2.0, -0.4, 0.5], &[0.3, -0.7, -1.5]]),
        mat(&[&[0.5, 0.0], &[1.0, -0.2], &[0.0, 2.0]]),
        mat(&[&[1.0, 0.0, 0.3], &[0.0, 2.0, -1.0]]),
        mat(&[&[0.0, 0.1], &[0.0, 0.0]]),
    )
    .unwrap();
    let inputs: Vec<Vec<f64>> = (0..9)
        .map(|k| 0.25 * f64::from(k))
        .map(|t| vec![(2.0 * t).sin(), (3.0 * t).cos()])
        .collect();
    let run = |hold| simulate(&system, 0.25, &inputs, Some(&[0.1, -0.2, 0.3]), hold).unwrap();
    let first = run(Hold::First);
    let expected_y1 = [
        0.29,
        0.340_606_892_601_303_67,
        0.347_632_210_692_182_64,
        0.318_328_254_814_233_66,
    ];
    let expected_y2 = [
        -0.7,
        -0.894_705_351_010_296,
        -0.544_833_441_553_811_6,
        0.115_062_929_736_851_28,
    ];
    for k in 0..4 {
        assert!((first.output("y1").unwrap()[k] - expected_y1[k]).abs() < 1e-14);
        assert!((first.output("y2").unwrap()[k] - expected_y2[k]).abs() < 1e-14);
    }
    assert!((first.output("y1").unwrap()[8] - 0.282_014_503_630_468).abs() < 1e-14);
    let held = run(Hold::Zero).output("y1").unwrap();
    assert!((held[4] - 0.325_362_338_846_781_6).abs() < 1e-14);
    assert!((held[8] - 0.351_536_870_781_019_1).abs() < 1e-14);
}

/// Strides of 32 steps against step by step: for both holds, records shorter than a stride, of whole strides and not,
/// several inputs and outputs, in mixed units.
#[test]
fn val_strides_are_the_steps() {
    let system = aeroelastic(3, 8, 5);
    for hold in [Hold::Zero, Hold::First] {
        let simulator = OutputSimulator::new(&system, 0.01, hold).unwrap();
        for samples in [1, 20, 64, 107] {
            let inputs: Vec<Vec<f64>> = (0..samples)
                .map(|k| vec![(0.3 * k as f64).sin(), if k % 17 < 8 { 1.0 } else { -0.5 }])
                .collect();
            let steps = simulate(&system, 0.01, &inputs, None, hold).unwrap();
            let strides = simulator.outputs(&inputs).unwrap();
            assert_eq!(strides.len(), 3);
            for (j, series) in strides.iter().enumerate() {
                assert_eq!(series.len(), samples);
                let expected: Vec<f64> = (0..samples).map(|k| steps.outputs.row(k)[j]).collect();
                let largest = expected.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (value, expected) in series.iter().zip(&expected) {
                    assert!((value - expected).abs() <= 1e-11 * largest);
                }
            }
        }
    }
    let simulator = OutputSimulator::new(&system, 0.01, Hold::First).unwrap();
    assert!(matches!(
        simulator.outputs(&[vec![0.0, 0.0], vec![0.0]]),
        Err(Error::InputWidth {
            sample: 1,
            expected: 2,
            found: 1
        })
    ));
    assert!(OutputSimulator::new(&system, 0.0, Hold::First).is_err());
}
