use albatross_lti::polynomial::{TransferFunction, from_roots, roots};
use albatross_lti::{Error, FrequencySolver, Method, Signal, StateSpace, Zpk};
use albatross_numerics::{C64, Mat};
use proptest::prelude::*;

use crate::models::{aeroelastic, double_integrator, mat, noise, oscillator};

fn c(re: f64, im: f64) -> C64 {
    C64::new(re, im)
}

fn channel(zpk: &Zpk) -> StateSpace {
    zpk.to_state_space(Signal::new("u", "1"), Signal::new("y", "1"))
        .unwrap()
}

fn response(system: &StateSpace, s: C64) -> C64 {
    FrequencySolver::new(system, Method::Lu)
        .unwrap()
        .evaluate(s)
        .unwrap()[(0, 0)]
}

/// Elliptic low-pass, order 5, 1 dB ripple, 40 dB stop band, 10 rad/s:
/// scipy 1.17.1, signal.ellip(5, 1, 40, 10, analog=True, output="zpk"); responses by signal.freqs_zpk.
fn elliptic() -> Zpk {
    let pair = |re, im| [c(re, im), c(re, -im)];
    let zeros = [
        pair(0.0, 17.642_884_409_085_89),
        pair(0.0, 12.538_075_689_795_843),
    ]
    .concat();
    let mut poles = [
        pair(-2.191_067_293_462_112, 7.410_339_611_506_354),
        pair(-0.499_207_088_871_602_9, 9.981_980_505_781_458),
    ]
    .concat();
    poles.push(c(-3.853_443_402_756_087, 0.0));
    Zpk::try_new(zeros, poles, 0.469_722_993_575_067_97).unwrap()
}

const ELLIPTIC_RESPONSE: [(f64, f64, f64); 5] = [
    (0.5, 0.980_783_894_219_502, -0.169_240_458_459_066_55),
    (9.0, -0.772_857_425_351_477_5, 0.457_407_557_863_169_7),
    (10.5, 0.374_643_289_758_371_63, 0.120_335_216_444_666_31),
    (13.0, -0.005_473_993_752_209_636, 0.003_878_799_463_757_719_8),
    (40.0, 0.002_184_171_036_053_606_2, -0.009_083_742_026_466_946),
];

#[test]
fn val_elliptic_filter_against_scipy() {
    let zpk = elliptic();
    let (tf, system) = (zpk.to_transfer_function().unwrap(), channel(&zpk));
    for (w, re, im) in ELLIPTIC_RESPONSE {
        let (s, expected) = (c(0.0, w), c(re, im));
        for found in [zpk.evaluate(s), tf.evaluate(s), response(&system, s)] {
            assert!((found - expected).norm() < 1e-13, "{w}: {found} {expected}");
        }
    }
    // signal.zpk2tf of the same filter.
    let denominator = [
        1.0,
        9.233_992_167_423_516,
        184.711_876_877_018_5,
        1_129.227_734_852_264,
        7_881.269_224_363_021,
        22_984.908_120_440_774,
    ];
    assert_eq!(tf.denominator.len(), 6);
    assert!((tf.denominator[3] / denominator[3] - 1.0).abs() < 1e-14);
    assert!((tf.denominator[5] / denominator[5] - 1.0).abs() < 1e-14);
    assert!((tf.numerator[2] / 220.053_344_264_226_8 - 1.0).abs() < 1e-14);
    for back in [Zpk::from_state_space(&system).unwrap(), tf.to_zpk().unwrap()] {
        assert_same(&back, &zpk, 1e-11);
    }
}

fn assert_same(found: &Zpk, expected: &Zpk, tolerance: f64) {
    assert_eq!(
        (found.zeros.len(), found.poles.len()),
        (expected.zeros.len(), expected.poles.len())
    );
    let scale = expected
        .poles
        .iter()
        .chain(&expected.zeros)
        .map(|v| v.norm())
        .fold(0.0, f64::max);
    for (list, other) in [(&found.zeros, &expected.zeros), (&found.poles, &expected.poles)] {
        for value in list {
            let distance = other
                .iter()
                .map(|v| (v - value).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(distance < tolerance * scale, "{found:?} {expected:?}");
        }
    }
    assert!(
        (found.gain - expected.gain).abs() < tolerance * expected.gain.abs(),
        "{} {}",
        found.gain,
        expected.gain
    );
}

/// scipy 1.17.1, signal.ss2zpk.
#[test]
fn val_zeros_of_a_state_space_against_scipy() {
    let a = mat(&[&[-0.6, 1.1, 0.2], &[-2.0, -0.4, 0.5], &[0.3, -0.7, -1.5]]);
    let system = StateSpace::unnamed(
        a,
        mat(&[&[0.5], &[1.0], &[0.0]]),
        mat(&[&[1.0, 0.0, 0.3]]),
        mat(&[&[0.0]]),
    )
    .unwrap();
    let zpk = Zpk::from_state_space(&system).unwrap();
    assert!((zpk.zeros[1] - c(-1.885, 0.904_861_867_911_341_2)).norm() < 1e-13);
    assert!((zpk.poles[2] - c(-0.612_657_310_661_372, 1.514_186_378_096_705_3)).norm() < 1e-13);
    assert!((zpk.gain - 0.5).abs() < 1e-14);
}

#[test]
fn val_closed_forms() {
    let zpk = Zpk::from_state_space(&double_integrator()).unwrap();
    assert_eq!(
        zpk,
        Zpk {
            zeros: vec![],
            poles: vec![c(0.0, 0.0); 2],
            gain: 1.0
        }
    );

    let zpk = Zpk::from_state_space(&oscillator(3.0, 0.1)).unwrap();
    assert!(zpk.zeros.is_empty() && (zpk.gain - 9.0).abs() < 1e-14);

    // Notch at 5 rad/s: (s^2 + 25)/(s^2 + 2 s + 25), rejecting 5 rad/s altogether.
    let a = mat(&[&[0.0, 1.0], &[-25.0, -2.0]]);
    let notch = StateSpace::unnamed(a, mat(&[&[0.0], &[1.0]]), mat(&[&[0.0, -2.0]]), mat(&[&[1.0]])).unwrap();
    let zpk = Zpk::from_state_space(&notch).unwrap();
    assert!((zpk.zeros[1] - c(0.0, 5.0)).norm() < 1e-13 && (zpk.gain - 1.0).abs() < 1e-15);
    assert!(zpk.evaluate(c(0.0, 5.0)).norm() < 1e-13);
    assert!(response(&channel(&zpk), c(0.0, 5.0)).norm() < 1e-13);

    // One integrator with a direct path: (0.5 s + 1)/s.
    let pi = StateSpace::unnamed(mat(&[&[0.0]]), mat(&[&[1.0]]), mat(&[&[1.0]]), mat(&[&[0.5]])).unwrap();
    let zpk = Zpk::from_state_space(&pi).unwrap();
    assert!((zpk.zeros[0] - c(-2.0, 0.0)).norm() < 1e-14 && zpk.gain == 0.5 && zpk.poles == [c(0.0, 0.0)]);

    // Nothing from input to output.
    let none = StateSpace::unnamed(mat(&[&[-1.0]]), mat(&[&[1.0]]), mat(&[&[0.0]]), mat(&[&[0.0]])).unwrap();
    assert_eq!(
        Zpk::from_state_space(&none).unwrap(),
        Zpk {
            zeros: vec![],
            poles: vec![],
            gain: 0.0
        }
    );
    let gain = Zpk {
        zeros: vec![],
        poles: vec![],
        gain: -4.0,
    };
    assert_eq!(channel(&gain).d[(0, 0)], -4.0);
}

/// Twenty-four modes in series and their zeros: far beyond what polynomial coefficients can carry.
#[test]
fn val_high_order_survives_the_realisation() {
    let pair = |omega: f64, zeta: f64| {
        let v = c(-zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
        [v, v.conj()]
    };
    let poles: Vec<C64> = (0..24)
        .flat_map(|k| pair(2.0 + 3.1 * f64::from(k), 0.02))
        .collect();
    let zeros: Vec<C64> = (0..23)
        .flat_map(|k| pair(3.0 + 3.1 * f64::from(k), 0.01))
        .collect();
    let zpk = Zpk::try_new(zeros, poles, -250.0).unwrap();
    let system = channel(&zpk);
    assert_same(&Zpk::from_state_space(&system).unwrap(), &zpk, 1e-9);
    for w in [0.3, 2.0, 17.0, 40.0, 90.0, 500.0] {
        let (found, expected) = (response(&system, c(0.0, w)), zpk.evaluate(c(0.0, w)));
        assert!(
            (found - expected).norm() < 1e-10 * expected.norm(),
            "{w}: {found} {expected}"
        );
    }
}

#[test]
fn val_hidden_modes_cancel() {
    let pair = |re: f64, im: f64| [c(re, im), c(re, -im)];
    let zpk = Zpk::try_new(
        [pair(-0.1, 4.0 + 1e-9), pair(-0.2, 6.0)].concat(),
        [pair(-0.1, 4.0).as_slice(), &pair(-0.2, 6.5), &[c(-3.0, 0.0)]].concat(),
        2.0,
    )
    .unwrap();
    let reduced = zpk.cancelled(1e-6);
    assert_eq!((reduced.zeros.len(), reduced.poles.len()), (2, 3));
    let s = c(0.0, 2.0);
    assert!((reduced.evaluate(s) - zpk.evaluate(s)).norm() < 1e-8);
    assert_eq!(zpk.cancelled(0.0), zpk);
}

#[test]
fn val_polynomials() {
    assert_eq!(
        roots(&[0.0, 2.0, -6.0, 0.0, 0.0]).unwrap(),
        [c(0.0, 0.0), c(0.0, 0.0), c(3.0, 0.0)]
    );
    assert!(roots(&[0.0, 5.0]).unwrap().is_empty() && roots(&[]).unwrap().is_empty());
    assert_eq!(
        from_roots(&[c(1.0, 2.0), c(1.0, -2.0), c(-3.0, 0.0)]).unwrap(),
        [1.0, 1.0, -1.0, 15.0]
    );
    assert!(matches!(
        from_roots(&[c(1.0, 2.0)]),
        Err(Error::Unpaired { what: "roots", .. })
    ));
    assert!(matches!(from_roots(&[c(1.0, -2.0)]), Err(Error::Unpaired { .. })));
    assert!(matches!(
        from_roots(&[c(f64::NAN, 0.0)]),
        Err(Error::Domain { .. })
    ));
    let zero = TransferFunction {
        numerator: vec![1.0],
        denominator: vec![0.0],
    };
    assert!(matches!(
        zero.to_zpk(),
        Err(Error::ZeroPolynomial { what: "denominator" })
    ));
    let silent = TransferFunction {
        numerator: vec![],
        denominator: vec![2.0, 4.0],
    };
    assert_eq!(
        silent.to_zpk().unwrap(),
        Zpk {
            zeros: vec![],
            poles: vec![c(-2.0, 0.0)],
            gain: 0.0
        }
    );
}

#[test]
fn val_what_has_no_answer_is_refused() {
    let improper = Zpk {
        zeros: vec![c(1.0, 0.0)],
        poles: vec![],
        gain: 1.0,
    };
    let signal = || Signal::new("u", "1");
    assert_eq!(
        improper.to_state_space(signal(), signal()),
        Err(Error::Improper { zeros: 1, poles: 0 })
    );
    assert!(matches!(
        Zpk::from_state_space(&aeroelastic(1, 1, 1)),
        Err(Error::NotSiso {
            inputs: 2,
            outputs: 3,
            ..
        })
    ));
    assert!(Zpk::try_new(vec![], vec![c(0.0, 1.0)], 1.0).is_err());
    assert!(Zpk::try_new(vec![], vec![], f64::INFINITY).is_err());
    let zpk = elliptic();
    let text = serde_json::to_string(&zpk).unwrap();
    assert_eq!(serde_json::from_str::<Zpk>(&text).unwrap(), zpk);
    assert!(serde_json::from_str::<Zpk>(&text.replacen("17.64288440908589", "17.0", 1)).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Zeros, poles and gain of any channel of a random aircraft-like system reproduce its response.
    #[test]
    fn prop_zpk_reproduces_the_response(seed in 0_u64..2000, modes in 1_usize..4, lags in 0_usize..6, output in 0_usize..3, input in 0_usize..2) {
        let whole = aeroelastic(modes, lags, seed);
        let system = whole.select(&[&whole.inputs[input].name], &[&whole.outputs[output].name]).unwrap();
        let zpk = Zpk::from_state_space(&system).unwrap();
        for w in [0.1, 1.0, 7.0, 50.0] {
            let s = c(0.0, w);
            let (found, expected) = (zpk.evaluate(s), response(&system, s));
            prop_assert!((found - expected).norm() < 1e-8 * expected.norm().max(1e-3), "{} {}", found, expected);
        }
    }

    /// Chains of relative degree up to six: every infinite zero is removed, none invented.
    #[test]
    fn prop_relative_degree_is_exact(seed in 0_u64..2000, degree in 1_usize..7, extra in 0_usize..5) {
        let n = degree + extra;
        let mut random = noise(seed);
        let mut draw = |count: usize| -> Vec<C64> { (0..count).map(|_| c(4.0 * random() - 5.0, 0.0)).collect() };
        let zpk = Zpk::try_new(draw(extra), draw(n), 3.0).unwrap();
        let mut system = channel(&zpk);
        // Coordinates turned by a reflection, so that no zero entry gives the structure away.
        let v: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
        let square: f64 = v.iter().map(|v| v * v).sum();
        let h = Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j] / square);
        system.a = &h * &system.a * &h;
        system.b = &h * &system.b;
        system.c = &system.c * &h;
        let found = Zpk::from_state_space(&system).unwrap();
        prop_assert_eq!(found.zeros.len(), extra);
        prop_assert!((found.gain / 3.0 - 1.0).abs() < 1e-7, "{}", found.gain);
    }
}
