//! Flutter of the Goland wing: a sweep over speed, its crossings, and a plot.

#![allow(clippy::print_stdout, reason = "an example prints its findings")]

use albatross::neutral::wing;
use albatross::report::plot::{Axis, LinePlot, Panel, Series, Style};
use albatross::strip::sweep::{Method, sweep};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let file = format!("{root}/fixtures/oracle/goland_wing.json");
    let wing = wing::read(&std::fs::read_to_string(&file)?, &file)?;
    let model = wing::model(&wing, &file)?;

    let speeds: Vec<f64> = (0..=40).map(|k| 5.0 * f64::from(k)).collect();
    let found = sweep(&model, wing.rho, &speeds, Method::PK)?;
    for c in &found.crossings {
        let onset = if c.unstable_above { "begins" } else { "ends" };
        let kind = format!("{:?}", c.kind);
        println!("{kind} {onset} at {:.2} m/s, {:.2} rad/s", c.speed, c.omega_rad_s);
    }

    let mut frequency = Panel::new("Frequency", "Hz");
    let mut damping = Panel::new("Damping ratio", "-");
    for (k, mode) in found.modes.iter().take(3).enumerate() {
        let name = format!("mode {}", k + 1);
        let curve = |values: &[f64]| Series::new(&name, Style::model(k), speeds.clone(), values.to_vec());
        frequency = frequency.with(curve(&mode.frequency_hz));
        damping = damping.with(curve(&mode.damping_ratio));
    }
    let plot = LinePlot::new("Goland wing", Axis::new("True airspeed", "m/s"))
        .with(frequency)
        .with(damping);
    std::fs::create_dir_all(format!("{root}/examples/02-strip-flutter/out"))?;
    std::fs::write(
        format!("{root}/examples/02-strip-flutter/out/flutter.svg"),
        plot.render()?.markup,
    )?;
    Ok(())
}
