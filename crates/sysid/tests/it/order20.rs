//! Order 20: the size at which polynomial methods fail.

use crate::systems::{FREQUENCIES, UP_TO_92, doublets, ten_pairs};
use albatross_sysid::{Block, Initialisation, Options, estimate, simulate_records};

#[test]
fn explore() {
    let mut counts = [0usize; 4];
    for (name, set) in [("a", FREQUENCIES), ("b", UP_TO_92)] {
        for seed in 10..20 {
            let truth = ten_pairs(set, seed);
            let system = truth.state_space();
            for snr in [Some(40.0), Some(20.0)] {
                let data = doublets(&system, snr, seed);
                for train in if std::env::var("MERGED").is_ok() {
                    vec![vec![0, 1, 2]]
                } else {
                    vec![vec![0], vec![1], vec![2], vec![0, 1, 2]]
                } {
                    let training = data.select(&train).unwrap();
                    let since = std::time::Instant::now();
                    let found = estimate(&training, &Options::new(20, 19)).unwrap();
                    let seconds = since.elapsed().as_secs_f64();
                    let mut from_truth = Options::new(20, 19);
                    from_truth.initialisation = Initialisation::Given(Block::from_poles(&truth.poles));
                    let ideal = estimate(&training, &from_truth).unwrap();
                    let fits: Vec<f64> = simulate_records(&found.model, &data, false)
                        .unwrap()
                        .iter()
                        .map(|s| s.fits[0].unwrap())
                        .collect();
                    let modes = &found.uncertainty.as_ref().unwrap().modes;
                    // Errors of identified poles: relative, and in standard deviations.
                    let mut worst = (0.0f64, 0.0f64);
                    for p in &truth.poles {
                        let m = modes
                            .iter()
                            .min_by(|a, b| {
                                let d = |m: &albatross_sysid::PoleEstimate| (m.re - p.re).hypot(m.im - p.im);
                                d(a).total_cmp(&d(b))
                            })
                            .unwrap();
                        if m.residues[0].modulus > 2.0 * m.residues[0].sd_modulus {
                            let e = (m.re - p.re).hypot(m.im - p.im);
                            let s = (m.covariance[0] + m.covariance[2]).sqrt();
                            worst.0 = worst.0.max(e / p.norm());
                            worst.1 = worst.1.max(e / s);
                        }
                    }
                    let excess = found.cost / ideal.cost - 1.0;
                    counts[0] += 1;
                    if excess > 1e-4 {
                        counts[1] += 1;
                        if train.len() == 3 {
                            counts[2] += 1;
                        }
                    }
                    println!(
                        "{name} {seed} {snr:?} {train:?}: fits {:.3?} excess {excess:.1e} identified {} worst {:.1e} = {:.1} sd its {} {:?} {seconds:.2} s",
                        fits,
                        modes.iter().filter(|m| m.identified).count(),
                        worst.0,
                        worst.1,
                        found.iterations.len(),
                        found.stop
                    );
                }
            }
        }
    }
    println!("{counts:?}");
}
