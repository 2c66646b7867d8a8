//! Draws one plot of each kind, with data as they occur, into a directory:
//! `cargo run -p albatross-report --example gallery -- DIR`.

use std::error::Error;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use albatross_report::plot::{
    Axis, BodeChannel, BodeCurve, BodePlot, LinePlot, Marker, Panel, PhaseDisplay, ScatterPlot, Series,
    Style, Svg,
};

fn main() -> Result<(), Box<dyn Error>> {
    let directory = PathBuf::from(std::env::args().nth(1).ok_or("usage: gallery DIR")?);
    std::fs::create_dir_all(&directory)?;
    for (name, svg) in [
        ("time_histories", time_histories()?),
        ("accelerations", accelerations()?),
        ("bode_grid", bode_grid()?),
        ("bode_single", bode_single()?),
        ("span", span()?),
        ("poles", poles()?),
        ("flutter", flutter()?),
        ("edge_cases", edge_cases()?),
    ] {
        std::fs::write(directory.join(name).with_extension("svg"), svg.markup)?;
    }
    Ok(())
}

/// Columns of a comma-separated file of numbers with `#` comments and a header line.
fn columns(file: &str, names: &[&str]) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/f25-like/reference")
        .join(file);
    let text = std::fs::read_to_string(path)?;
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().ok_or("no header")?.split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    names
        .iter()
        .map(|name| {
            let column = header
                .iter()
                .position(|field| field == name)
                .ok_or("no such column")?;
            let values = rows
                .iter()
                .map(|row| row.get(column).and_then(|field| field.parse().ok()));
            Ok(values.map(|value| value.unwrap_or(f64::NAN)).collect())
        })
        .collect()
}

fn time_histories() -> Result<Svg, Box<dyn Error>> {
    let data = columns(
        "doublet_0p5Hz.csv",
        &["t_s", "elevator_deg", "alpha_deg", "q_deg_s", "nz"],
    )?;
    let [t, elevator, alpha, q, nz] = data.as_slice() else {
        return Err("five columns".into());
    };
    let reference = |y: &[f64]| Series::new("Reference (DLM-based simulation)", Style::reference(), &**t, y);
    let model = |i: usize, name: &str, y: &[f64]| {
        let mean = y.first().copied().unwrap_or(0.0);
        let gain = 1.0 + 0.08 * (i + 1) as f64;
        let y: Vec<f64> = y.iter().map(|y| mean + gain * (y - mean)).collect();
        Series::new(name, Style::model(i), &**t, y)
    };
    let panel = |label: &str, unit: &str, y: &[f64]| {
        Panel::new(label, unit)
            .with(reference(y))
            .with(model(0, "Albatross, AVL data only", y))
            .with(model(1, "Albatross, corrected", y))
            .with(model(2, "Albatross, corrected, lagged elevator", y))
    };
    let plot = LinePlot::new("Response to a 0.5 Hz elevator doublet", Axis::new("Time", "s"))
        .with(Panel::new("Elevator δ_{e}", "deg").with(reference(elevator)))
        .with(panel("Angle of attack α", "deg", alpha))
        .with(panel("Pitch rate q", "deg/s", q))
        .with(panel("Load factor n_{z}", "", nz));
    Ok(plot.render()?)
}

fn accelerations() -> Result<Svg, Box<dyn Error>> {
    let data = columns(
        "doublet_10Hz.csv",
        &["t_s", "az_cockpit", "az_last_pax", "az_right_wing_tip"],
    )?;
    let [t, cockpit, last, tip] = data.as_slice() else {
        return Err("four columns".into());
    };
    let panel = |place: &str, y: &[f64]| {
        let model: Vec<f64> = y.iter().map(|y| 0.85 * y).collect();
        Panel::new(format!("Acceleration a_{{z}}, {place}"), "m/s^{2}")
            .with(Series::new("Reference", Style::reference(), &**t, y))
            .with(Series::new("Albatross", Style::model(0), &**t, model))
    };
    let plot = LinePlot::new(
        "Accelerations after a 10 Hz doublet",
        Axis::new("Time", "s").with_limits(0.0, 3.0),
    )
    .without_heading()
    .with(panel("cockpit", cockpit))
    .with(panel("last passenger", last))
    .with(panel("right wing tip", tip));
    Ok(plot.render()?)
}

/// A sum of resonances g w_n² / (w_n² - w² + 2 i ζ w_n w), as magnitude in dB and unwrapped phase in deg.
fn resonances(frequency: &[f64], modes: &[(f64, f64, f64)]) -> (Vec<f64>, Vec<f64>) {
    let (mut db, mut deg) = (Vec::new(), Vec::new());
    let mut turns = 0.0;
    for w in frequency {
        let (mut re, mut im) = (0.0, 0.0);
        for (wn, zeta, gain) in modes {
            let (a, b) = (wn * wn - w * w, 2.0 * zeta * wn * w);
            let scale = gain * wn * wn / (a * a + b * b);
            re += a * scale;
            im -= b * scale;
        }
        let mut phase = f64::atan2(im, re).to_degrees() + turns;
        if let Some(last) = deg.last() {
            let jump = 360.0 * ((phase - last) / 360.0_f64).round();
            turns -= jump;
            phase -= jump;
        }
        db.push(20.0 * f64::hypot(re, im).log10());
        deg.push(phase);
    }
    (db, deg)
}

fn decades(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..=count)
        .map(|i| 10f64.powf(from + (to - from) * f64::from(i) / f64::from(count)))
        .collect()
}

/// Phugoid, short period and fifteen elastic modes.
fn modes(seed: f64) -> Vec<(f64, f64, f64)> {
    let mut modes = vec![(0.065, 0.05, 1.0), (1.7, 0.45, 8.0)];
    for i in 0..15 {
        let i = f64::from(i);
        modes.push((
            18.0 * 1.13_f64.powf(i),
            0.015 + 0.002 * i,
            0.4 * (seed + 2.3 * i).sin(),
        ));
    }
    modes
}

fn channel(title: &str, unit: &str, seed: f64) -> BodeChannel {
    let w = decades(-2.0, 3.0, 3000);
    let (db, deg) = resonances(&w, &modes(seed));
    let (db2, deg2) = resonances(&w, &modes(seed + 0.15));
    let (db3, deg3) = resonances(&w[1500..], &modes(seed - 0.1)[1..]);
    let deg3: Vec<f64> = deg3.iter().map(|deg| deg + 360.0).collect();
    BodeChannel::new(title)
        .with_reference(unit)
        .with(BodeCurve::new(
            "Identified from reference",
            Style::reference(),
            &w[1500..],
            db3,
            deg3,
        ))
        .with(BodeCurve::new(
            "Albatross, AVL data only",
            Style::model(0),
            &*w,
            db,
            deg,
        ))
        .with(BodeCurve::new(
            "Albatross, corrected",
            Style::model(1),
            w,
            db2,
            deg2,
        ))
}

fn bode_grid() -> Result<Svg, Box<dyn Error>> {
    let plot = BodePlot::new(
        "Elevator to accelerations and pitch rate",
        Axis::log("Frequency ω", "rad/s"),
    )
    .with(channel("δ_{e} to a_{z}, cockpit", "(m/s^{2})/rad", 0.2))
    .with(channel("δ_{e} to a_{z}, last passenger", "(m/s^{2})/rad", 1.0))
    .with(channel("δ_{e} to a_{z}, right wing tip", "(m/s^{2})/rad", 2.2))
    .with(channel("δ_{e} to q, centre of gravity", "(rad/s)/rad", 2.9));
    Ok(plot.render()?)
}

fn bode_single() -> Result<Svg, Box<dyn Error>> {
    let mut plot = BodePlot::new("Six decades", Axis::log("Frequency", "Hz"))
        .without_heading()
        .with(channel("", "", 0.7));
    plot.phase = PhaseDisplay::Wrapped;
    Ok(plot.render()?)
}

fn span() -> Result<Svg, Box<dyn Error>> {
    let y: Vec<f64> = (0..45).map(|i| 0.5 * f64::from(i) + 0.25).collect();
    let lift = |scale: f64| -> Vec<f64> {
        y.iter()
            .map(|y| scale * 6000.0 * (1.0 - (y / 22.6).powi(2)).sqrt() * (1.0 + 0.1 * (y / 5.0).cos()))
            .collect()
    };
    let plot = LinePlot::new(
        "Wing lift distribution at α = 0",
        Axis::new("Spanwise position y", "m"),
    )
    .with(
        Panel::new("Lift per unit span", "N/m")
            .with(Series::new(
                "Reference",
                Style::reference().with_marker(Marker::Disc),
                &*y,
                lift(1.1),
            ))
            .with(Series::new(
                "AVL",
                Style::model(0).with_marker(Marker::Circle),
                &*y,
                lift(9.0),
            ))
            .with(Series::new(
                "Corrected",
                Style::model(1).with_marker(Marker::Square),
                &*y,
                lift(17.05),
            )),
    );
    Ok(plot.render()?)
}

fn poles() -> Result<Svg, Box<dyn Error>> {
    let locus = |seed: f64| -> (Vec<f64>, Vec<f64>) {
        modes(seed)
            .iter()
            .map(|(w, zeta, _)| (-2.0 * zeta * w - seed, w * (1.0 - zeta * zeta).sqrt()))
            .unzip()
    };
    let (re, im) = locus(0.3);
    let names = (0..re.len()).map(|i| match i {
        0 => "PH".to_owned(),
        1 => "SP".to_owned(),
        i => (i - 1).to_string(),
    });
    let (re2, im2) = locus(0.9);
    let track: Vec<f64> = (0..200).map(|i| 0.02 * f64::from(i) - 3.0).collect();
    let rise: Vec<f64> = track.iter().map(|x| 60.0 + 4.0 * x * x).collect();
    let plot = ScatterPlot::pole_map("Aeroelastic modes", "rad/s")
        .with(Series::new("locus over airspeed", Style::model(2), track, rise))
        .with(Series::new("Reference", Style::points(4), re2, im2))
        .with(Series::new("Albatross", Style::points(0), re, im).with_labels(names))
        .with_damping_rays([0.02, 0.05, 0.1, 0.2, 0.5]);
    Ok(plot.render()?)
}

fn flutter() -> Result<Svg, Box<dyn Error>> {
    let v: Vec<f64> = (0..120).map(|i| 50.0 + f64::from(i)).collect();
    let mut damping = Panel::new("Damping g", "")
        .with_guide_x(136.0, "V_{F} = 136 m/s")
        .with_guide_y(0.03, "g = 0.03");
    let mut frequency = Panel::new("Frequency", "Hz").with_guide_x(136.0, "");
    for i in 0..8 {
        let k = i as f64;
        let g: Vec<f64> = v
            .iter()
            .map(|v| 0.02 * (v / 136.0 - 1.0) * (3.0 - k) - 0.01 * k * v / 100.0)
            .collect();
        let f: Vec<f64> = v
            .iter()
            .map(|v| 2.0 + 1.5 * k + 0.3 * (v / 40.0 + k).sin())
            .collect();
        damping = damping.with(Series::new(format!("Mode {}", i + 1), Style::model(i), &*v, g));
        frequency = frequency.with(Series::new(format!("Mode {}", i + 1), Style::model(i), &*v, f));
    }
    Ok(
        LinePlot::new("V-g and V-f diagram", Axis::new("True airspeed", "m/s"))
            .with(damping)
            .with(frequency)
            .render()?,
    )
}

fn edge_cases() -> Result<Svg, Box<dyn Error>> {
    let x: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
    let sine = |scale: f64| -> Vec<f64> { x.iter().map(|x| scale * (2.0 * PI * 0.4 * x).sin()).collect() };
    let gaps: Vec<f64> = x
        .iter()
        .map(|x| if x.fract() < 0.3 { f64::NAN } else { x.sin() })
        .collect();
    let plot = LinePlot::new("Gaps, constants, <markup> & \"quotes\"", Axis::new("Time", "s"))
        .with(Panel::new("Gaps", "").with(Series::new("gaps", Style::model(0), &*x, gaps)))
        .with(Panel::new("Nothing", "").with(Series::new("empty", Style::model(1), [], [])))
        .with(Panel::new("Constant airspeed", "m/s").with(Series::new(
            "V",
            Style::model(2),
            &*x,
            vec![232.70201; 1000],
        )))
        .with(
            Panel::new("A bending moment with a rather long name", "N m").with(Series::new(
                "M",
                Style::model(3),
                &*x,
                sine(3.4e6),
            )),
        )
        .with(Panel::new("Rounding", "rad").with(Series::new("rounding", Style::model(4), &*x, sine(2e-17))))
        .with(Panel::over(Axis::log("Level", "")).with(Series::new(
            "level",
            Style::model(5),
            &*x,
            sine(10.0),
        )))
        .with(Panel::new("One point", "").with(Series::new("point", Style::model(0), [5.0], [3.0])));
    Ok(plot.render()?)
}
