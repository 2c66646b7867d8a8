//! Results as plots.

use albatross::analysis::ModeTable;
use albatross::flight::TimeHistory;
use albatross::lti::Response;
use albatross::report::plot::{
    Axis, BodeChannel, BodeCurve, BodePlot, Colour, LinePlot, Marker, Panel, ScatterPlot, Series, Style,
};
use albatross::root_locus::{Branch, BranchKind, RootLocus, Roots};

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

/// One panel per channel; channels that stand still are left out.
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

/// Eigenvalues that belong to no branch, lag roots most of them.
const FAINT: Colour = Colour([0xCF, 0xCF, 0xCF]);

fn dots(colour: Colour, marker: Marker) -> Style {
    Style {
        colour,
        marker: Some(marker),
        ..Style::points(0)
    }
}

fn kind(branch: &Branch) -> (&'static str, Colour) {
    match branch.kind {
        BranchKind::Elastic => ("elastic modes", Colour::BLUE),
        BranchKind::RigidBody => ("rigid-body modes", Colour::VERMILLION),
    }
}

/// Values of a branch by speed; gaps where it was not followed to or `drawn` refuses.
fn along<'a>(
    branch: &'a Branch,
    drawn: impl Fn((f64, f64)) -> bool + 'a,
) -> impl Iterator<Item = (f64, f64)> + 'a {
    let gap = (f64::NAN, f64::NAN);
    branch
        .values
        .iter()
        .map(move |v| v.filter(|value| drawn(*value)).unwrap_or(gap))
}

/// Position of the flight point among the speeds.
fn at_flight_point(locus: &RootLocus, flight_speed: f64) -> Option<usize> {
    let here = |point: &Roots| (point.speed / flight_speed - 1.0).abs() < 1e-9;
    locus.points.iter().position(here)
}

/// The branches of the modes over speed in the complex plane, elastic modes numbered at the flight point.
pub(crate) fn locus(locus: &RootLocus, modes: &ModeTable, flight_speed: f64) -> ScatterPlot {
    let window = Window::around(modes);
    let mut plot = branches(locus, &window, flight_speed, BranchKind::Elastic);
    plot.title = "Root locus over speed".into();
    plot.height = 560.0;
    plot
}

/// The same about the rigid-body modes, which the elastic ones leave no room for; nothing if there are none.
pub(crate) fn locus_of_rigid_body(locus: &RootLocus, flight_speed: f64) -> Option<ScatterPlot> {
    let values: Vec<(f64, f64)> = locus
        .branches
        .iter()
        .filter(|b| b.kind == BranchKind::RigidBody)
        .flat_map(|b| b.values.iter().flatten().copied())
        .collect();
    let fastest = values.iter().map(|v| v.1).fold(0.0, f64::max);
    let (least, most) = values.iter().fold((0.0_f64, 0.0_f64), |(least, most), v| {
        (least.min(v.0), most.max(v.0))
    });
    if fastest <= 0.0 {
        return None;
    }
    let room = 0.15 * (most - least).max(0.1 * fastest);
    let window = Window {
        re: (least - room, most + 2.5 * room),
        im: 1.15 * fastest,
    };
    let mut plot = branches(locus, &window, flight_speed, BranchKind::RigidBody);
    plot.title = "Rigid-body modes over speed".into();
    plot.height = 320.0;
    Some(plot)
}

/// Branches within a window, those of one kind with their names at the flight point.
fn branches(locus: &RootLocus, window: &Window, flight_speed: f64, named: BranchKind) -> ScatterPlot {
    let mut plot = ScatterPlot::pole_map("", "rad/s").with_damping_rays(RAYS);
    plot.x = plot.x.with_limits(window.re.0, window.re.1);
    plot.y = plot.y.with_limits(0.0, window.im);
    let (re, im): (Vec<f64>, Vec<f64>) = locus
        .points
        .iter()
        .flat_map(|p| &p.values)
        .copied()
        .filter(|v| window.holds(*v))
        .unzip();
    plot = plot.with(Series::new("all eigenvalues", dots(FAINT, Marker::Disc), re, im));
    for branch in &locus.branches {
        let (name, colour) = kind(branch);
        let style = Style {
            colour,
            ..Style::model(0)
        };
        let (re, im): (Vec<f64>, Vec<f64>) = along(branch, |v| window.holds(v)).unzip();
        if re.iter().any(|v| v.is_finite()) {
            plot = plot.with(Series::new(name, style, re, im));
        }
    }
    let markers = |at: usize, name: String, marker: Marker, labelled: bool| {
        let mut points: Vec<((f64, f64), &str)> = Vec::new();
        for branch in &locus.branches {
            let value = branch.values.get(at).copied().flatten();
            if let Some(value) = value.filter(|v| window.holds(*v)) {
                let own = branch.kind == named;
                points.push((value, if own { &branch.name } else { "" }));
            }
        }
        let apart = (
            ONE_LABEL * (window.re.1 - window.re.0),
            0.7 * ONE_LABEL * window.im,
        );
        let (re, im): (Vec<f64>, Vec<f64>) = points.iter().map(|(value, _)| *value).unzip();
        let series = Series::new(name, dots(Colour::BLACK, marker), re, im);
        if labelled {
            series.with_labels(shared_labels(&points, apart))
        } else {
            series
        }
    };
    if let Some((last, point)) = locus.points.iter().enumerate().next_back() {
        let name = format!("at {:.0} m/s", point.speed);
        plot = plot.with(markers(last, name, Marker::Triangle, false));
    }
    if let Some(here) = at_flight_point(locus, flight_speed) {
        let name = format!("flight point, {flight_speed:.0} m/s");
        plot = plot.with(markers(here, name, Marker::Disc, true));
    }
    plot
}

/// Damping ratio beyond which a mode is left out of the diagram of damping: the others would be pressed together.
const MOST_DAMPING: f64 = 0.25;

/// Part of the range within which points share one label: one beside the other could not be read.
const ONE_LABEL: f64 = 0.035;

/// Labels of points in the plane: of those nearer than `apart` in both directions the first bears the names of all.
fn shared_labels(points: &[((f64, f64), &str)], apart: (f64, f64)) -> Vec<String> {
    let mut labels: Vec<String> = Vec::with_capacity(points.len());
    for ((x, y), name) in points {
        let near = |(label, ((u, v), _)): (&String, &((f64, f64), &str))| {
            !label.is_empty() && (x - u).abs() < apart.0 && (y - v).abs() < apart.1
        };
        let first = labels.iter().zip(points).position(near);
        match first.and_then(|at| labels.get_mut(at)) {
            Some(label) if !name.is_empty() => {
                label.push_str(", ");
                label.push_str(name);
                labels.push(String::new());
            }
            _ => labels.push((*name).to_owned()),
        }
    }
    labels
}

/// Frequency and damping of the modes over speed.
pub(crate) fn frequency_and_damping(locus: &RootLocus, modes: &ModeTable, flight_speed: f64) -> LinePlot {
    let window = Window::around(modes);
    let of_frequency = |(re, im): (f64, f64)| re.hypot(im);
    let of_damping = |(re, im): (f64, f64)| -re / re.hypot(im);
    let frequency = over_speed(locus, flight_speed, |v| window.holds(v).then(|| of_frequency(v)));
    let damping = over_speed(locus, flight_speed, |v| {
        (window.holds(v) && of_damping(v) < MOST_DAMPING).then(|| of_damping(v))
    });
    let panel = |name: &str, unit: &str, series: Vec<Series>, height: f64| {
        let mut panel = Panel::new(name, unit)
            .with_guide_x(flight_speed, "")
            .with_height(height);
        panel.series = series;
        panel
    };
    LinePlot::new(
        "Frequency and damping over speed",
        Axis::new("True airspeed", "m/s"),
    )
    .with(panel("Frequency", "rad/s", frequency, 380.0))
    .with(panel("Damping ratio", "", damping, 380.0).with_guide_y(0.0, ""))
}

/// A line per branch of what `shown` makes of its values, and its name at the flight point.
fn over_speed(
    locus: &RootLocus,
    flight_speed: f64,
    shown: impl Fn((f64, f64)) -> Option<f64>,
) -> Vec<Series> {
    let speeds: Vec<f64> = locus.points.iter().map(|p| p.speed).collect();
    let here = at_flight_point(locus, flight_speed);
    let mut series = Vec::new();
    let mut marked: Vec<((f64, f64), &str)> = Vec::new();
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for branch in &locus.branches {
        let (name, colour) = kind(branch);
        let style = Style {
            colour,
            ..Style::model(0)
        };
        let value = |v: &Option<(f64, f64)>| v.and_then(&shown).unwrap_or(f64::NAN);
        let values: Vec<f64> = branch.values.iter().map(value).collect();
        (least, most) = values
            .iter()
            .fold((least, most), |(l, m), v| (l.min(*v), m.max(*v)));
        if let Some(value) = here.and_then(|k| values.get(k)).filter(|v| v.is_finite()) {
            marked.push(((flight_speed, *value), &branch.name));
        }
        series.push(Series::new(name, style, speeds.clone(), values));
    }
    marked.sort_by(|a, b| b.0.1.total_cmp(&a.0.1));
    let labels = shared_labels(&marked, (f64::INFINITY, ONE_LABEL * (most - least)));
    let (at, values): (Vec<f64>, Vec<f64>) = marked.iter().map(|(place, _)| *place).unzip();
    series
        .push(Series::new("flight point", dots(Colour::BLACK, Marker::Disc), at, values).with_labels(labels));
    series
}
