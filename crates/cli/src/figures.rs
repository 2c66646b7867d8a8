//! Results as plots.

use albatross::analysis::ModeTable;
use albatross::flight::TimeHistory;
use albatross::lti::Response;
use albatross::report::plot::{
    Axis, BodeChannel, BodeCurve, BodePlot, Colour, LinePlot, Marker, Panel, ScatterPlot, Series, Style,
};
use albatross::root_locus::RootLocus;

/// Unit in which a channel is drawn, and the factor to it.
fn shown(unit: &str) -> (&str, f64) {
    let degrees = 1.0_f64.to_degrees();
    match unit {
        "rad" => ("deg", degrees),
        "rad/s" => ("deg/s", degrees),
        "m/s2" => ("m/s^{2}", 1.0),
        other => (other, 1.0),
    }
}

/// One panel a channel; channels that stand still are left out.
pub(crate) fn history(name: &str, history: &TimeHistory) -> LinePlot {
    let mut plot = LinePlot::new(name, Axis::new("Time", "s"));
    for (channel, series) in history.channels.iter().zip(&history.series) {
        let moves = series
            .first()
            .is_some_and(|first| series.iter().any(|v| v != first));
        if !moves {
            continue;
        }
        let (unit, factor) = shown(&channel.unit);
        let values: Vec<f64> = series.iter().map(|v| factor * v).collect();
        plot = plot.with(
            Panel::new(&channel.name, unit)
                .with(Series::new(
                    &channel.name,
                    Style::model(0),
                    history.time.clone(),
                    values,
                ))
                .with_height(110.0),
        );
    }
    plot.legend = albatross::report::plot::LegendPlace::Hidden;
    plot
}

/// What 0 dB of a response stands for, output over input; nothing where they share their unit.
fn ratio(output: &str, input: &str) -> String {
    if output == input {
        return String::new();
    }
    let output = match output {
        "-" => "1".to_owned(),
        unit if unit.contains('/') => format!("({})", unit.replace("s2", "s^{2}")),
        unit => unit.to_owned(),
    };
    format!("{output}/{input}")
}

/// Magnitude and phase of every output, one curve named after the variant.
pub(crate) fn bode(variant: &str, response: &Response) -> Result<BodePlot, albatross::lti::Error> {
    let (input, per) = response
        .inputs
        .first()
        .map_or(("", "-"), |s| (s.name.as_str(), s.unit.as_str()));
    let mut plot = BodePlot::new(format!("Response to {input}"), Axis::log("Frequency", "rad/s"));
    for output in &response.outputs {
        let channel = response.get(&output.name, input)?;
        let curve = BodeCurve::new(
            variant,
            Style::model(0),
            response.omega_rad_s.clone(),
            channel.magnitude_db(),
            channel.phase_deg(),
        );
        plot = plot.with(
            BodeChannel::new(&output.name)
                .with_reference(ratio(&output.unit, per))
                .with(curve),
        );
    }
    Ok(plot)
}

/// Damping ratios drawn as rays.
const RAYS: [f64; 3] = [0.02, 0.05, 0.1];

/// Modes of the rigid and of the flexible aircraft in the complex plane.
pub(crate) fn poles(modes: &ModeTable) -> ScatterPlot {
    let upper = |(re, im): (f64, f64)| (re, im.abs());
    let rigid: Vec<(f64, f64)> = modes
        .rigid_body
        .iter()
        .map(|m| upper((m.rigid.re, m.rigid.im)))
        .collect();
    let named: Vec<(&str, (f64, f64))> = modes
        .rigid_body
        .iter()
        .filter_map(|m| m.flexible.as_ref().map(|f| (m.name, upper((f.re, f.im)))))
        .collect();
    let elastic: Vec<(f64, f64)> = modes.elastic.iter().map(|m| upper((m.re, m.im))).collect();
    let series = |name: &str, i: usize, points: &[(f64, f64)]| {
        let (re, im): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        Series::new(name, Style::points(i), re, im)
    };
    let flexible: Vec<(f64, f64)> = named.iter().map(|(_, at)| *at).collect();
    ScatterPlot::pole_map("Modes in the complex plane", "rad/s")
        .with(
            series("elastic modes", 0, &elastic)
                .with_labels(modes.elastic.iter().map(|m| m.mode.to_string())),
        )
        .with(series("rigid-body modes, rigid aircraft", 1, &rigid))
        .with(series("rigid-body modes, flexible aircraft", 4, &flexible))
        .with_damping_rays(RAYS)
}

/// Part of the complex plane in which modes are looked for: the modes of the flight point with some room around them.
struct Window {
    re: (f64, f64),
    im: f64,
}

impl Window {
    fn around(modes: &ModeTable) -> Self {
        let least = modes.elastic.iter().map(|m| m.re).fold(-2.0, f64::min);
        let fastest = modes.elastic.iter().map(|m| m.im.abs()).fold(2.0, f64::max);
        Self {
            re: (1.6 * least, -0.2 * least),
            im: 1.12 * fastest,
        }
    }

    fn holds(&self, (re, im): (f64, f64)) -> bool {
        (self.re.0..=self.re.1).contains(&re) && im <= self.im
    }
}

/// From light to dark, so that the order of speeds is seen without colours too.
fn shade(part: f64) -> Colour {
    let mix = |from: u8, to: u8| (f64::from(from) + part * (f64::from(to) - f64::from(from))).round() as u8;
    let (Colour(light), Colour(dark)) = (Colour([0xB9, 0xDD, 0xF2]), Colour([0x00, 0x2F, 0x4F]));
    Colour([
        mix(light[0], dark[0]),
        mix(light[1], dark[1]),
        mix(light[2], dark[2]),
    ])
}

fn dots(colour: Colour, marker: Marker) -> Style {
    Style {
        colour,
        marker: Some(marker),
        ..Style::points(0)
    }
}

/// Eigenvalues over speed in the complex plane, darker with speed; the flight point stands out.
pub(crate) fn locus(locus: &RootLocus, modes: &ModeTable, flight_speed: f64) -> ScatterPlot {
    let window = Window::around(modes);
    let mut plot = ScatterPlot::pole_map("Root locus over speed", "rad/s").with_damping_rays(RAYS);
    plot.x = plot.x.with_limits(window.re.0, window.re.1);
    plot.y = plot.y.with_limits(0.0, window.im);
    plot.height = 520.0;
    let last = locus.points.len().max(2) - 1;
    for (i, point) in locus.points.iter().enumerate() {
        let at_flight_point = (point.speed / flight_speed - 1.0).abs() < 1e-9;
        let style = if at_flight_point {
            dots(Colour::VERMILLION, Marker::Cross)
        } else {
            dots(shade(i as f64 / last as f64), Marker::Disc)
        };
        let name = if at_flight_point {
            format!("{:.0} m/s, flight point", point.speed)
        } else {
            format!("{:.0} m/s", point.speed)
        };
        let (re, im): (Vec<f64>, Vec<f64>) =
            point.values.iter().filter(|v| window.holds(**v)).copied().unzip();
        plot = plot.with(Series::new(name, style, re, im));
    }
    plot
}

/// Damping ratio beyond which an oscillation is taken for a lag and left out of the diagrams over speed.
const MOST_DAMPING: f64 = 0.5;

/// Frequency and damping of the oscillatory eigenvalues over speed.
pub(crate) fn frequency_and_damping(locus: &RootLocus, modes: &ModeTable, flight_speed: f64) -> LinePlot {
    let window = Window::around(modes);
    let (mut speed, mut frequency, mut damping) = (Vec::new(), Vec::new(), Vec::new());
    for point in &locus.points {
        for &(re, im) in point.values.iter().filter(|v| window.holds(**v)) {
            let (omega, ratio) = (re.hypot(im), -re / re.hypot(im));
            if im > 0.0 && ratio < MOST_DAMPING {
                speed.push(point.speed);
                frequency.push(omega);
                damping.push(ratio);
            }
        }
    }
    let style = dots(Colour::BLUE, Marker::Disc);
    let panel = |name: &str, unit: &str, values: Vec<f64>| {
        Panel::new(name, unit)
            .with(Series::new("", style, speed.clone(), values))
            .with_guide_x(flight_speed, "flight point")
            .with_height(230.0)
    };
    LinePlot::new(
        "Frequency and damping over speed",
        Axis::new("True airspeed", "m/s"),
    )
    .with(panel("Frequency", "rad/s", frequency))
    .with(panel("Damping ratio", "", damping).with_guide_y(0.0, ""))
}
