//! Measured data: the hair dryer and the robot arm of the SLICOT examples (BSD-3), where they are present.

use albatross_lti::Signal;
use albatross_sysid::{
    DataSet, Detrend, Experiment, Intersample, Options, estimate, remove_trim, simulate_records,
};

/// Inputs and outputs of a SLICOT data file; none, said aloud, where it is not.
fn slicot(name: &str, header_lines: usize, samples: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let found = std::env::var_os("ALBATROSS_THIRD_PARTY").and_then(|root| {
        let path = std::path::Path::new(&root)
            .join("system-identification")
            .join(name);
        std::fs::read_to_string(path).ok()
    });
    let Some(text) = found else {
        println!("skipped: ALBATROSS_THIRD_PARTY does not lead to system-identification/{name}");
        return None;
    };
    let values: Vec<f64> = text
        .lines()
        .skip(header_lines)
        .flat_map(str::split_whitespace)
        .map(|v| v.parse().unwrap())
        .collect();
    Some((values[..samples].to_vec(), values[samples..2 * samples].to_vec()))
}

/// Fits on the first 70 % and on the rest after identifying from the first part.
fn fits((u, y): (Vec<f64>, Vec<f64>), poles: usize, zeros: usize, dt: f64) -> [f64; 2] {
    let split = u.len() * 7 / 10;
    let mut whole = Experiment::new("record", dt, u, vec![y]);
    remove_trim(&mut whole, Detrend::Mean);
    let part = |from: usize, to: usize| {
        let output = whole.outputs[0][from..to].to_vec();
        Experiment::new("part", dt, whole.input[from..to].to_vec(), vec![output])
    };
    let data = DataSet::try_new(
        Signal::new("u", "1"),
        vec![Signal::new("y", "1")],
        vec![part(0, split), part(split, whole.len())],
        Intersample::Zoh,
    )
    .unwrap();
    let found = estimate(&data.select(&[0]).unwrap(), &Options::new(poles, zeros)).unwrap();
    // The second part begins in motion.
    let scored = simulate_records(&found.model, &data, true).unwrap();
    [scored[0].fits[0].unwrap(), scored[1].fits[0].unwrap()]
}

#[test]
fn val_hair_dryer() {
    let Some(data) = slicot("IB01BD.dat", 3, 1000) else {
        return;
    };
    let found = fits(data, 5, 4, 0.08);
    assert!(found.iter().all(|f| *f > 91.0), "{found:?}");
}

#[test]
fn val_robot_arm() {
    let Some(data) = slicot("IB03BD.dat", 2, 1024) else {
        return;
    };
    let found = fits(data, 4, 4, 1.0);
    assert!(found.iter().all(|f| *f > 96.5), "{found:?}");
}
