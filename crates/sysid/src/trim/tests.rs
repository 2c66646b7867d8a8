use super::*;

fn gauss(rng: &mut fastrand::Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}

/// Response of y' = 2 (u - y) to a held input, from rest, at 100 Hz.
fn response(input: &[f64]) -> Vec<f64> {
    let decay = (-0.02_f64).exp();
    let mut y = 0.0;
    input
        .iter()
        .map(|u| {
            let now = y;
            y = decay * y + (1.0 - decay) * u;
            now
        })
        .collect()
}

/// A square doublet of 2 x 100 samples after `lead` samples, `samples` in all.
fn doublet(lead: usize, samples: usize) -> Vec<f64> {
    (0..samples)
        .map(|k| match k.checked_sub(lead) {
            Some(0..100) => 1.0,
            Some(100..200) => -1.0,
            _ => 0.0,
        })
        .collect()
}

/// A record about the trim u = 3, y = -5.
fn record(input: &[f64]) -> Experiment {
    let y = response(input).iter().map(|y| y - 5.0).collect();
    Experiment::new("r", 0.01, input.iter().map(|u| u + 3.0).collect(), vec![y])
}

fn bits(clock: usize) -> Vec<f64> {
    let mut rng = fastrand::Rng::with_seed(11);
    let mut bit = 1.0;
    (0..2000)
        .map(|k| {
            if k % clock == 0 {
                bit = if rng.bool() { 1.0 } else { -1.0 };
            }
            bit
        })
        .collect()
}

#[test]
fn val_doublet_after_a_lead_in() {
    let mut experiment = record(&doublet(300, 2000));
    let removed = remove_trim(&mut experiment, Detrend::Auto);
    assert_eq!((removed.lead_in, removed.basis), (300, TrimBasis::LeadIn));
    assert!(!removed.estimate_offset && !experiment.estimate_offset);
    assert!((removed.input - 3.0).abs() < 1e-12 && (removed.outputs[0] + 5.0).abs() < 1e-12);
    for (found, exact) in experiment.outputs[0].iter().zip(response(&doublet(300, 2000))) {
        assert!((found - exact).abs() < 1e-12);
    }
}

#[test]
fn val_short_lead_ins_want_a_constant() {
    // Shorter than 200 samples; longer, but less than 2 % of the record.
    for (lead, samples) in [(50, 2000), (250, 20_000)] {
        let mut experiment = record(&doublet(lead, samples));
        let removed = remove_trim(&mut experiment, Detrend::Auto);
        assert_eq!((removed.lead_in, removed.estimate_offset), (lead, true));
        let removed = remove_trim(&mut record(&doublet(lead, samples)), Detrend::Trim);
        assert_eq!((removed.lead_in, removed.estimate_offset), (lead, false));
    }
}

#[test]
fn val_doublet_from_the_first_samples() {
    // From sample 0 (the first value is no trim) and 1 (a single sample of lead-in).
    for lead in [0, 1] {
        let mut experiment = record(&doublet(lead, 1000));
        let removed = remove_trim(&mut experiment, Detrend::Auto);
        assert_eq!((removed.lead_in, removed.basis), (0, TrimBasis::Rest), "{lead}");
        assert!((removed.input - 3.0).abs() < 1e-12 && (removed.outputs[0] + 5.0).abs() < 1e-12);
        assert!(removed.estimate_offset);
    }
    // Its first half is the longest stretch at rest: the output gives it away, and so it is at least marked.
    let mut experiment = record(&doublet(0, 240));
    let removed = remove_trim(&mut experiment, Detrend::Auto);
    assert_eq!((removed.lead_in, removed.estimate_offset), (0, true));
}

#[test]
fn val_inputs_that_move_throughout() {
    for input in [bits(1), bits(7), bits(20)] {
        let mut experiment = record(&input);
        let removed = remove_trim(&mut experiment, Detrend::Auto);
        assert_eq!(
            (removed.lead_in, removed.basis, removed.estimate_offset),
            (0, TrimBasis::Mean, true)
        );
        assert!(mean(&experiment.input).abs() < 1e-12 && mean(&experiment.outputs[0]).abs() < 1e-12);
    }
    // The same after a lead-in.
    let late = [vec![0.0; 250], bits(7)].concat();
    let removed = remove_trim(&mut record(&late), Detrend::Auto);
    assert_eq!((removed.lead_in, removed.basis), (250, TrimBasis::LeadIn));
    assert!((removed.input - 3.0).abs() < 1e-12 && !removed.estimate_offset);
}

#[test]
fn val_step_keeps_its_lead_in() {
    let step = [vec![0.0; 250], vec![1.0; 1000]].concat();
    let removed = remove_trim(&mut record(&step), Detrend::Auto);
    assert_eq!((removed.lead_in, removed.estimate_offset), (250, false));
    assert!((removed.input - 3.0).abs() < 1e-12);
}

#[test]
fn val_measured_input_and_output() {
    let mut rng = fastrand::Rng::with_seed(2);
    for lead in [300, 60] {
        let mut experiment = record(&doublet(lead, 2000));
        let sigma = 0.005;
        experiment
            .input
            .iter_mut()
            .for_each(|u| *u += sigma * gauss(&mut rng));
        experiment.outputs[0]
            .iter_mut()
            .for_each(|y| *y += 10.0 * sigma * gauss(&mut rng));
        let removed = remove_trim(&mut experiment, Detrend::Auto);
        assert_eq!((removed.lead_in, removed.basis), (lead, TrimBasis::LeadIn));
        // Four standard deviations of the means.
        let bound = 4.0 * sigma / (lead as f64).sqrt();
        assert!((removed.input - 3.0).abs() < bound && (removed.outputs[0] + 5.0).abs() < 10.0 * bound);
        assert_eq!(removed.estimate_offset, lead < 200);
    }
    // Noise of the last bit only.
    let mut coarse = record(&doublet(300, 2000));
    coarse
        .input
        .iter_mut()
        .for_each(|u| *u += 0.001 * f64::from(u8::from(rng.u8(..) < 40)));
    assert_eq!(remove_trim(&mut coarse, Detrend::Auto).lead_in, 300);
}

#[test]
fn val_smooth_doublet() {
    // sin^4 doublet: the first samples move by less than a millionth of the range.
    let input: Vec<f64> = (0..5000)
        .map(|k| {
            let x = (f64::from(k) - 500.0) / 330.0;
            let inside = (0.0..1.0).contains(&x);
            let pi = std::f64::consts::PI;
            f64::from(u8::from(inside)) * (2.0 * pi * x).sin() * (pi * x).sin().powi(4)
        })
        .collect();
    let removed = remove_trim(&mut record(&input), Detrend::Auto);
    assert!((500..510).contains(&removed.lead_in), "{}", removed.lead_in);
    assert!(!removed.estimate_offset && (removed.input - 3.0).abs() < 1e-7);
}

#[test]
fn val_explicit_choices() {
    let original = record(&doublet(300, 2000));
    let mut first = original.clone();
    let removed = remove_trim(&mut first, Detrend::First);
    assert_eq!((removed.input, &removed.outputs[..]), (3.0, &[-5.0][..]));
    let mut whole = original.clone();
    remove_trim(&mut whole, Detrend::Mean);
    assert!(mean(&whole.outputs[0]).abs() < 1e-12);
    let mut same = original.clone();
    let removed = remove_trim(&mut same, Detrend::None);
    assert_eq!(
        (removed.basis, removed.estimate_offset),
        (TrimBasis::Nothing, false)
    );
    assert_eq!(same, original);
}

#[test]
fn regress_degenerate_records() {
    for input in [
        vec![],
        vec![1.0],
        vec![2.0; 5],
        vec![f64::NAN; 30],
        vec![1.0, f64::INFINITY, 3.0],
    ] {
        for how in [Detrend::Auto, Detrend::Trim, Detrend::First, Detrend::Mean] {
            let mut experiment = Experiment::new("r", 0.1, input.clone(), vec![input.clone(), vec![]]);
            let removed = remove_trim(&mut experiment, how);
            assert_eq!(removed.outputs.len(), 2);
        }
    }
}
