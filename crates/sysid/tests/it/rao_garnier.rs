//! The benchmark of Rao and Garnier (Numerical illustrations of the relevance of direct continuous-time model
//! identification, IFAC World Congress, Barcelona 2002): G = (-6400 s + 1600)/(s^4 + 5 s^3 + 408 s^2 + 416 s + 1600),
//! non-minimum phase, modes at 2 and 20 rad/s, PRBS of ten stages held for seven samples of 10 ms, white noise at 10 dB.

use crate::systems::{Noise, data, response};
use albatross_lti::{Hold, Signal, TransferFunction};
use albatross_sysid::{Experiment, InitialCondition, Options, estimate};

/// b1, b0, a1 .. a4.
const TRUTH: [f64; 6] = [-6400.0, 1600.0, 5.0, 408.0, 416.0, 1600.0];
/// Standard deviations of the Cramer-Rao bound for this input and noise.
const BOUND: [f64; 6] = [40.4, 70.9, 0.060, 1.051, 3.47, 7.56];

/// Maximum-length sequence of +-1 of ten stages, x^10 + x^7 + 1 (Golomb, Shift Register Sequences, 1967).
fn prbs() -> Vec<f64> {
    let mut register = [true; 10];
    let mut out = Vec::new();
    for _ in 0..1023 {
        out.extend([if register[9] { 1.0 } else { -1.0 }; 7]);
        let next = register[9] ^ register[6];
        register.rotate_right(1);
        register[0] = next;
    }
    out
}

/// Estimates over noise seeds.
fn estimates(seeds: u64) -> Vec<[f64; 6]> {
    let truth = TransferFunction {
        numerator: vec![TRUTH[0], TRUTH[1]],
        denominator: vec![1.0, TRUTH[2], TRUTH[3], TRUTH[4], TRUTH[5]],
    };
    let system = truth
        .to_zpk()
        .unwrap()
        .to_state_space(Signal::new("u", "1"), Signal::new("y", "1"))
        .unwrap();
    let u = prbs();
    assert_eq!(u.len(), 7161);
    let clean = response(&system, &u, 0.01, Hold::Zero);
    let mut options = Options::new(4, 1);
    options.initial = InitialCondition::Zero;
    (0..seeds)
        .map(|seed| {
            let mut y = clean.clone();
            Noise::new(seed).add(&mut y, 10.0);
            let found = estimate(
                &data(vec![Experiment::new("prbs", 0.01, u.clone(), vec![y])]),
                &options,
            )
            .unwrap();
            let tf = found.model.transfer_function(0).unwrap();
            assert_eq!((tf.numerator.len(), tf.denominator.len()), (2, 5));
            let (b, a) = (&tf.numerator, &tf.denominator);
            [b[0], b[1], a[1], a[2], a[3], a[4]]
        })
        .collect()
}

/// Mean within three standard errors of the truth, spread between `low` and `high` of the bound, no divergent run.
fn check(seeds: u64, low: f64, high: f64) {
    let found = estimates(seeds);
    let n = found.len() as f64;
    for (k, (truth, bound)) in TRUTH.iter().zip(BOUND).enumerate() {
        let mean = found.iter().map(|f| f[k]).sum::<f64>() / n;
        let spread = (found.iter().map(|f| (f[k] - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        println!(
            "parameter {k}: mean {mean:.4}, truth {truth}, spread {:.3} of the bound",
            spread / bound
        );
        assert!(
            (mean - truth).abs() < 3.0 * bound / n.sqrt(),
            "parameter {k}: {mean} against {truth}"
        );
        assert!(
            spread > low * bound && spread < high * bound,
            "parameter {k}: {} of the bound",
            spread / bound
        );
        // A divergent run would lie far outside of the bound.
        assert!(
            found.iter().all(|f| (f[k] - truth).abs() < 6.0 * bound),
            "parameter {k}"
        );
    }
}

#[test]
fn val_rao_garnier_ten_seeds() {
    check(10, 0.5, 1.7);
}

#[cfg(feature = "validation")]
#[test]
fn val_rao_garnier_hundred_seeds() {
    check(100, 0.8, 1.25);
}
