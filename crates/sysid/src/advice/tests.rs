use std::f64::consts::TAU;

use albatross_lti::Signal;

use super::*;
use crate::{Experiment, Intersample};

fn doublet(lead: usize, period: usize, samples: usize) -> Vec<f64> {
    (0..samples)
        .map(|k| match k.checked_sub(lead) {
            Some(i) if i < period / 2 => 1.0,
            Some(i) if i < period => -1.0,
            _ => 0.0,
        })
        .collect()
}

/// Response of two lags of 5 rad/s, from rest, with the trapezoidal rule.
fn response(input: &[f64], dt: f64) -> Vec<f64> {
    let decay = (-5.0 * dt).exp();
    let (mut p, mut q) = (0.0, 0.0);
    input
        .iter()
        .map(|u| {
            let now = q;
            q = decay * q + (1.0 - decay) * p;
            p = decay * p + (1.0 - decay) * u;
            now
        })
        .collect()
}

fn experiment(name: &str, input: Vec<f64>) -> Experiment {
    let output = response(&input, 0.001);
    Experiment::new(name, 0.001, input, vec![output])
}

fn data(experiments: Vec<Experiment>) -> DataSet {
    let signal = |name: &str| Signal::new(name, "1");
    DataSet::try_new(signal("u"), vec![signal("y")], experiments, Intersample::Zoh).unwrap()
}

fn one(input: Vec<f64>) -> DataSet {
    data(vec![experiment("a", input)])
}

fn kinds(advice: &[Advice]) -> Vec<AdviceKind> {
    advice.iter().map(|a| a.kind).collect()
}

fn find(advice: &[Advice], kind: AdviceKind) -> &str {
    let found = advice.iter().find(|a| a.kind == kind);
    &found.unwrap_or_else(|| panic!("{kind:?} in {advice:?}")).text
}

/// Only coverage: nothing to complain about.
const QUIET: [AdviceKind; 1] = [AdviceKind::Coverage];

#[test]
fn val_nulls_of_one_doublet_are_named_and_covered_by_a_second() {
    // 1 Hz doublet: null at 2 Hz; 0.3 to 3 Hz asked for.
    let (slowest, fastest) = (Some(0.3 * TAU), Some(3.0 * TAU));
    let single = advise(&one(doublet(500, 1000, 6000)), slowest, fastest);
    let text = find(&single, AdviceKind::Excitation);
    assert!(
        text.contains("(nulls at 2.00 Hz)") && text.contains("add a record"),
        "{text}"
    );
    // The closed form sin^2(x)/x, x = pi f / 2, is 1 % of its peak 0.7246 at f = 1.906 and 2.098 Hz; the grid is 0.4 %.
    let edges = ["at 1.90 to 2.10 Hz", "at 1.91 to 2.10 Hz"];
    assert!(edges.iter().any(|e| text.contains(e)), "{text}");
    let second = experiment("b", doublet(500, 700, 6000));
    let both = advise(
        &data(vec![experiment("a", doublet(500, 1000, 6000)), second]),
        slowest,
        fastest,
    );
    assert!(!kinds(&both).contains(&AdviceKind::Excitation), "{both:?}");
    let coverage = find(&both, AdviceKind::Coverage);
    assert!(
        coverage.contains("a excites") && coverage.contains("b excites"),
        "{coverage}"
    );
}

#[test]
fn val_random_bits_excite_everything_below_their_clock() {
    let mut rng = fastrand::Rng::with_seed(4);
    let mut bit = 1.0;
    let input = (0..8000)
        .map(|k| {
            if k % 20 == 0 {
                bit = if rng.bool() { 1.0 } else { -1.0 };
            }
            if k < 300 { 0.0 } else { bit }
        })
        .collect();
    // Clock 50 Hz: first null at 50 Hz.
    let advice = advise(&one(input), Some(TAU), Some(20.0 * TAU));
    assert!(!kinds(&advice).contains(&AdviceKind::Excitation), "{advice:?}");
}

#[test]
fn val_length_against_the_slowest_pole() {
    let data = one(doublet(500, 1000, 5001));
    let text = |slowest| advise(&data, Some(slowest), None);
    // 5 s: a quarter of the period of 0.314 rad/s, a period of 1.257 rad/s.
    assert!(find(&text(0.30), AdviceKind::RecordLength).contains("not identifiable"));
    assert!(find(&text(0.32), AdviceKind::RecordLength).contains("uncertain"));
    assert!(find(&text(1.25), AdviceKind::RecordLength).contains("record 5.03 s or more"));
    assert_eq!(kinds(&text(1.26)), QUIET);
}

#[test]
fn val_sampling_against_the_fastest_pole() {
    let data = one(doublet(500, 1000, 5001));
    let advice = |fastest| advise(&data, None, Some(fastest));
    assert!(find(&advice(1600.0), AdviceKind::Nyquist).contains("half the Nyquist"));
    assert_eq!(kinds(&advice(1500.0)), QUIET);
    // 200 samples a period at 31.4 rad/s.
    assert_eq!(kinds(&advice(31.5)), QUIET);
    assert!(find(&advice(31.0), AdviceKind::Oversampled).contains("decimate by 4"));
}

#[test]
fn val_energy_near_the_nyquist_frequency() {
    let mut clean = experiment("a", doublet(500, 1000, 5001));
    let mut rng = fastrand::Rng::with_seed(9);
    clean.outputs[0]
        .iter_mut()
        .for_each(|y| *y += 2.0 * (rng.f64() - 0.5));
    let advice = advise(&data(vec![clean]), None, None);
    assert!(find(&advice, AdviceKind::Nyquist).contains("(500 Hz)"));
}

#[test]
fn val_limits_lost_samples_and_resolution() {
    let base = experiment("a", doublet(500, 1000, 5001));
    let changed = |change: &dyn Fn(usize, f64) -> f64| {
        let mut e = base.clone();
        e.outputs[0] = base.outputs[0]
            .iter()
            .enumerate()
            .map(|(k, &y)| change(k, y))
            .collect();
        advise(&data(vec![e]), None, None)
    };
    assert_eq!(kinds(&changed(&|_, y| y)), QUIET);
    let limited = changed(&|_, y| y.min(0.4));
    assert!(find(&limited, AdviceKind::Saturated).contains("stays at its limit of 0.400"));
    let held = base.outputs[0][700];
    let stuck = changed(&|k, y| if (700..750).contains(&k) { held } else { y });
    assert!(find(&stuck, AdviceKind::Stuck).contains("for 50 samples from 0.700 s"));
    let coarse = changed(&|_, y| (y / 0.02).round() * 0.02);
    assert!(find(&coarse, AdviceKind::Quantised).contains("0.0200 apart"));
    assert!(!kinds(&coarse).contains(&AdviceKind::Saturated), "{coarse:?}");
    // Nine digits are no quantisation.
    assert_eq!(kinds(&changed(&|_, y| (y * 1e9).round() * 1e-9)), QUIET);
}

#[test]
fn val_offsets_and_motion_before_the_manoeuvre() {
    let base = experiment("a", doublet(500, 1000, 5001));
    let mut offset = base.clone();
    offset.outputs[0].iter_mut().for_each(|y| *y += 0.2);
    assert!(
        find(
            &advise(&data(vec![offset.clone()]), None, None),
            AdviceKind::Offset
        )
        .contains("0.200")
    );
    offset.estimate_offset = true;
    assert_eq!(kinds(&advise(&data(vec![offset]), None, None)), QUIET);
    let mut swinging = base;
    for (k, y) in swinging.outputs[0].iter_mut().enumerate() {
        *y += 0.1 * (-0.002 * k as f64).exp() * (0.02 * k as f64).cos();
    }
    let advice = advise(&data(vec![swinging]), None, None);
    assert!(find(&advice, AdviceKind::MovingBefore).contains("initial state"));
}

#[test]
fn val_inputs_that_stay_away_or_stand_still() {
    let step = [vec![0.0; 500], vec![1.0; 4500]].concat();
    assert!(find(&advise(&one(step), None, None), AdviceKind::InputEnd).contains("ends at 1.00"));
    let still = advise(&one(vec![0.0; 1000]), Some(1.0), Some(10.0));
    assert!(find(&still, AdviceKind::Excitation).contains("stands still"));
}

#[test]
fn val_reference_doublets() {
    let read = |name: &str| {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/reference/");
        let text = std::fs::read_to_string(format!("{root}doublet_{name}.csv")).unwrap();
        let asked = crate::Columns {
            input: "elevator".to_owned(),
            outputs: vec!["az_cockpit".to_owned(), "q".to_owned()],
            ..crate::Columns::default()
        };
        let (mut e, ..) = crate::table::parse(&text, name)
            .unwrap()
            .experiment(&asked)
            .unwrap();
        let removed = crate::remove_trim(&mut e, crate::Detrend::Auto);
        assert!((500..515).contains(&removed.lead_in), "{}", removed.lead_in);
        assert!((removed.input + 0.006_728_5).abs() < 1e-6 && !removed.estimate_offset);
        assert_eq!(crate::detect_intersample(&e.input), Intersample::Foh);
        e
    };
    let signal = |name: &str| Signal::new(name, "1");
    let records = ["0p5Hz", "3Hz", "10Hz"].map(read).to_vec();
    let all = DataSet::try_new(
        signal("u"),
        vec![signal("az"), signal("q")],
        records,
        Intersample::Foh,
    )
    .unwrap();
    // Short period to the fastest elastic mode of interest; a phugoid of 120 s is not in the records.
    assert_eq!(kinds(&advise(&all, Some(1.75), Some(92.0))), QUIET);
    let phugoid = advise(&all, Some(TAU / 120.0), Some(92.0));
    assert!(find(&phugoid, AdviceKind::RecordLength).contains("not identifiable"));
    let slow = all.select(&[0]).unwrap();
    let alone = advise(&slow, Some(1.75), Some(92.0));
    assert!(kinds(&alone).contains(&AdviceKind::Excitation), "{alone:?}");
}

#[test]
fn regress_odd_poles_and_tiny_records() {
    let tiny = one(vec![0.0, 1.0]);
    for pole in [
        None,
        Some(0.0),
        Some(-1.0),
        Some(f64::NAN),
        Some(f64::INFINITY),
        Some(1e9),
        Some(1e-9),
    ] {
        for other in [None, Some(1e-9), Some(1e9), Some(3.0)] {
            advise(&tiny, pole, other);
            advise(&one(vec![]), pole, other);
        }
    }
}

#[test]
fn val_three_digits() {
    let texts = [0.0, 1234.5, 123.4, 12.34, 0.01234, 1e-12].map(short);
    assert_eq!(texts, ["0", "1234", "123", "12.3", "0.0123", "1.00e-12"]);
}
