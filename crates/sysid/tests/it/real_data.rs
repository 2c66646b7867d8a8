//! Measured data: the hair dryer and the robot arm of the SLICOT examples, where they are present.

use albatross_lti::Signal;
use albatross_sysid::{
    DataSet, Detrend, Experiment, Intersample, Options, estimate, remove_trim, simulate_records,
};

/// Values after the header of a SLICOT data file: inputs, then outputs.
fn slicot(name: &str, header_lines: usize, samples: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let root = std::env::var_os("ALBATROSS_THIRD_PARTY")?;
    let path = std::path::Path::new(&root)
        .join("system-identification")
        .join(name);
    let text = std::fs::read_to_string(path).ok()?;
    let values: Vec<f64> = text
        .lines()
        .skip(header_lines)
        .flat_map(|l| {
            l.split_whitespace()
                .map(|v| v.parse().unwrap())
                .collect::<Vec<f64>>()
        })
        .collect();
    Some((values[..samples].to_vec(), values[samples..2 * samples].to_vec()))
}

/// Fits on the first 70 % and on the rest after identifying from the first part.
fn fits((u, y): (Vec<f64>, Vec<f64>), poles: usize, zeros: usize, dt: f64, detrend: Detrend) -> [f64; 2] {
    let split = u.len() * 7 / 10;
    let mut whole = Experiment::new("record", dt, u, vec![y]);
    remove_trim(&mut whole, detrend);
    let part = |from: usize, to: usize| {
        let mut part = Experiment::new(
            "part",
            dt,
            whole.input[from..to].to_vec(),
            vec![whole.outputs[0][from..to].to_vec()],
        );
        part.estimate_offset = whole.estimate_offset;
        part
    };
    let data = DataSet::try_new(
        Signal::new("u", "1"),
        vec![Signal::new("y", "1")],
        vec![part(0, split), part(split, whole.len())],
        Intersample::Zoh,
    )
    .unwrap();
    let found = estimate(&data.select(&[0]).unwrap(), &Options::new(poles, zeros)).unwrap();
    println!(
        "initial estimated {} cost {:.3e} {:?} its {}",
        found.initial_estimated,
        found.cost,
        found.stop,
        found.iterations.len()
    );

    println!("{:?}", found.warnings);
    if found.cost == 0.0 {
        for i in &found.iterations {
            println!("{i:?}");
        }
        println!("{:?}", found.model);
        println!("{:?}", found.initial);
    }
    // The second part begins in motion.
    let scored = simulate_records(&found.model, &data, true).unwrap();
    [scored[0].fits[0].unwrap(), scored[1].fits[0].unwrap()]
}

#[test]
fn val_hair_dryer() {
    let Some(data) = slicot("IB01BD.dat", 3, 1000) else {
        println!("skipped: ALBATROSS_THIRD_PARTY does not lead to the hair dryer's data");
        return;
    };
    for zeros in [4, 3, 2] {
        for d in [Detrend::Mean, Detrend::Auto] {
            let [first, second] = fits(data.clone(), 5, zeros, 0.08, d);
            println!("hair dryer {zeros} {d:?}: {first:.2} %, {second:.2} %");
        }
    }
}

#[test]
fn val_robot_arm() {
    let Some(data) = slicot("IB03BD.dat", 2, 1024) else {
        println!("skipped: ALBATROSS_THIRD_PARTY does not lead to the robot arm's data");
        return;
    };
    for dt in [1.0, 0.01] {
        for d in [Detrend::Mean, Detrend::Auto] {
            let [first, second] = fits(data.clone(), 4, 4, dt, d);
            println!("robot arm {dt} {d:?}: {first:.2} %, {second:.2} %");
        }
    }
}
