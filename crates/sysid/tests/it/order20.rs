//! Order 20: the size at which polynomial methods fail.

use crate::systems::{FREQUENCIES, UP_TO_92, doublets, ten_pairs};
use albatross_sysid::{Options, estimate, simulate_records};

#[test]
fn explore() {
    for (name, set) in [("a", FREQUENCIES), ("b", UP_TO_92)] {
        for seed in 0..3 {
            let truth = ten_pairs(set, seed);
            let system = truth.state_space();
            for snr in [None, Some(40.0), Some(20.0)] {
                let data = doublets(&system, snr, seed);
                for train in [vec![0], vec![1], vec![2], vec![0, 1, 2]] {
                    let since = std::time::Instant::now();
                    let found = match estimate(&data.select(&train).unwrap(), &Options::new(20, 19)) {
                        Ok(f) => f,
                        Err(e) => {
                            println!("{name} {seed} {snr:?} {train:?}: {e}");
                            continue;
                        }
                    };
                    let seconds = since.elapsed().as_secs_f64();
                    let fits: Vec<f64> = simulate_records(&found.model, &data, false)
                        .unwrap()
                        .iter()
                        .map(|s| s.fits[0].unwrap())
                        .collect();
                    let poles = found.model.poles();
                    let worst = truth
                        .poles
                        .iter()
                        .map(|p| {
                            poles
                                .iter()
                                .map(|q| (p - q).norm() / p.norm())
                                .fold(1e9, f64::min)
                        })
                        .collect::<Vec<_>>();
                    let w = worst.iter().copied().fold(0.0, f64::max);
                    println!(
                        "{name} {seed} {snr:?} {train:?}: fits {:.4?} worst {w:.1e} cost {:.2e} its {} {:?} chosen {} {seconds:.2} s {}",
                        fits,
                        found.cost,
                        found.iterations.len(),
                        found.stop,
                        found.chosen,
                        found.initial_estimated,
                    );
                    if std::env::var("VERBOSE").is_ok() {
                        for s in &found.starts {
                            println!("    {} {:?} {:?}", s.description, s.relocated, s.refined);
                        }
                    }
                }
            }
        }
    }
}
