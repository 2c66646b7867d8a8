//! Order 20: the size at which polynomial methods fail.

use crate::systems::{FREQUENCIES, Modal, UP_TO_92, doublets, ten_pairs};
use albatross_sysid::{DataSet, Estimate, Options, PoleEstimate, estimate, simulate_records};

fn fits(found: &Estimate, data: &DataSet) -> Vec<f64> {
    let simulated = simulate_records(&found.model, data, found.initial_estimated).unwrap();
    simulated.iter().map(|record| record.fits[0].unwrap()).collect()
}

/// The identified pole nearest to each true one.
fn nearest<'a>(found: &'a Estimate, truth: &Modal) -> Vec<&'a PoleEstimate> {
    let modes = &found.uncertainty.as_ref().unwrap().modes;
    truth
        .poles
        .iter()
        .map(|p| {
            let distance = |m: &PoleEstimate| (m.re - p.re).hypot(m.im - p.im);
            modes
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .unwrap()
        })
        .collect()
}

/// Without noise the data determine the model: any one record gives all poles, and predicts the others.
#[test]
fn val_exact_data_give_the_exact_model() {
    for (set, seed, record) in [
        (FREQUENCIES, 0, 0),
        (FREQUENCIES, 1, 1),
        (UP_TO_92, 0, 2),
        (UP_TO_92, 1, 0),
    ] {
        let truth = ten_pairs(set, seed);
        let data = doublets(&truth.state_space(), None, 0);
        let mut options = Options::new(20, 19);
        options.uncertainty = false;
        let found = estimate(&data.select(&[record]).unwrap(), &options).unwrap();
        assert!(fits(&found, &data).iter().all(|f| *f > 99.999_99));
        let poles = found.model.poles();
        for p in &truth.poles {
            let error = poles.iter().map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min);
            assert!(error < 1e-9 * p.norm(), "{p}: {error:e}");
        }
    }
}

/// At 40 dB the fits reach what the noise allows, 100 - 1 %, and poles whose residue is told from zero are within 0.2 %.
#[test]
fn val_forty_decibels_merged() {
    for (set, seed) in [(FREQUENCIES, 18), (UP_TO_92, 10)] {
        let truth = ten_pairs(set, seed);
        let data = doublets(&truth.state_space(), Some(40.0), seed);
        let found = estimate(&data, &Options::new(20, 19)).unwrap();
        for fit in fits(&found, &data) {
            assert!((fit - 99.0).abs() < 0.1, "{fit}");
        }
        for (mode, p) in nearest(&found, &truth).into_iter().zip(&truth.poles) {
            let residue = &mode.residues[0];
            let error = (mode.re - p.re).hypot(mode.im - p.im);
            let sd = (mode.covariance[0] + mode.covariance[2]).sqrt();
            // Four standard deviations of a plane error are passed once in three thousand.
            assert!(error < 4.0 * sd, "{p}: {error} against {sd}");
            if residue.modulus > 2.0 * residue.sd_modulus {
                assert!(error < 2e-3 * p.norm(), "{p}: {error}");
            }
        }
    }
}

/// At 20 dB, whatever the record: stable, finite, and no worse on the training record than the noise.
#[test]
fn val_twenty_decibels_never_diverge() {
    let truth = ten_pairs(FREQUENCIES, 3);
    let data = doublets(&truth.state_space(), Some(20.0), 3);
    for train in [vec![0], vec![2], vec![0, 1, 2]] {
        let found = estimate(&data.select(&train).unwrap(), &Options::new(20, 19)).unwrap();
        assert!(found.model.is_stable());
        let all = fits(&found, &data);
        assert!(all.iter().all(|f| f.is_finite()));
        for record in train {
            assert!((all[record] - 90.0).abs() < 0.5, "{record}: {}", all[record]);
        }
    }
}
