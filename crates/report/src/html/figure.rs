//! Plots as plotly.js takes them: one figure for each stack of panels, in the look of the SVG.

use super::escape::marked;
use crate::plot::axis::{Axis, LARGEST, Scale};
use crate::plot::curve::{Point, extremes, simplify};
use crate::plot::palette::{Dash, Marker, Style};
use crate::plot::panel::{Guide, Panel, Series};
use crate::plot::sheet::{LegendPlace, Sheet, Stack};
use crate::plot::theme::{FRAME, GRID, GUIDE, INK, MINOR_GRID, ZERO};
use crate::plot::ticks;
use serde_json::{Map, Value, json};

/// Heights in pixels: above a panel for its label, below all panels for ticks and abscissa, a row of the legend.
const LABEL_ROOM: f64 = 26.0;
const AXIS_ROOM: f64 = 52.0;
const LEGEND_ROW: f64 = 22.0;
const TITLE_ROOM: f64 = 24.0;

/// Points from which on a line is thinned, and the size in pixels of the picture that must stay the same: several times
/// that of the screen, for those who zoom.
const LONG: usize = 1000;
const MAGNIFIED: (f64, f64) = (5000.0, 1500.0);

/// Part of a curve's range that its values are rounded to: a tenth of what the finest screen shows.
const RESOLUTION: f64 = 1e-5;

/// Smallest height of a panel.
const LEAST_PANEL: f64 = 110.0;

/// One figure for each stack of the sheet.
pub(super) fn plots(sheet: &Sheet<'_>) -> Vec<Value> {
    let legend = sheet.legend != LegendPlace::Hidden;
    sheet
        .stacks
        .iter()
        .map(|stack| figure(stack, sheet.panel_height, legend))
        .collect()
}

fn figure(stack: &Stack, panel_height: f64, legend: bool) -> Value {
    let names = legend_names(stack);
    let legend = legend && names.len() > 1;
    let heights: Vec<f64> = stack
        .panels
        .iter()
        .map(|panel| panel.height.unwrap_or(panel_height).max(LEAST_PANEL))
        .collect();
    let plot_height = heights.iter().sum::<f64>() + LABEL_ROOM * (heights.len().saturating_sub(1)) as f64;
    let title_room = if stack.title.is_empty() { 0.0 } else { TITLE_ROOM };
    let below = AXIS_ROOM
        + if legend {
            LEGEND_ROW * names.len().div_ceil(3) as f64
        } else {
            0.0
        };
    let top = LABEL_ROOM + title_room;

    let mut layout = Map::new();
    layout.insert("height".into(), json!(plot_height + top + below));
    layout.insert(
        "margin".into(),
        json!({ "l": 58, "r": 14, "t": top, "b": below, "pad": 0 }),
    );
    layout.insert(
        "font".into(),
        json!({ "family": "sans-serif", "size": 12, "color": INK }),
    );
    let one_curve = stack.panels.iter().all(|panel| panel.damping_rays.is_empty());
    layout.insert(
        "hovermode".into(),
        json!(if one_curve { "x unified" } else { "closest" }),
    );
    layout.insert("hoversubplots".into(), json!("axis"));
    layout.insert("showlegend".into(), json!(legend));
    layout.insert(
        "legend".into(),
        json!({ "orientation": "h", "x": 0, "xanchor": "left", "y": -AXIS_ROOM / plot_height, "yanchor": "top" }),
    );

    let mut traces = Vec::new();
    let mut annotations = Vec::new();
    let mut lines = Vec::new();
    if !stack.title.is_empty() {
        let title = format!("<b>{}</b>", marked(&stack.title));
        annotations.push(label(&title, 1.0 + LABEL_ROOM / plot_height));
    }
    let mut high = 1.0;
    let mut shown: Vec<&str> = Vec::new();
    for (i, (panel, height)) in stack.panels.iter().zip(&heights).enumerate() {
        let low = (high - height / plot_height).max(0.0);
        let suffix = if i == 0 {
            String::new()
        } else {
            (i + 1).to_string()
        };
        let mut axis = axis(&panel.y, false, extent(panel.series.iter().map(|s| &s.y)));
        axis.insert("domain".into(), json!([low, high]));
        axis.insert("anchor".into(), json!("x"));
        layout.insert(format!("yaxis{suffix}"), axis.into());
        annotations.push(label(&marked(&panel.y.title(0)), high));
        let y = format!("y{suffix}");
        for series in &panel.series {
            traces.extend(band(series, &y));
            let first = !series.name.is_empty() && !shown.contains(&series.name.as_str());
            if first {
                shown.push(&series.name);
            }
            traces.push(curve(series, &y, first));
        }
        lines.extend(panel.guides.iter().map(|guide| line_of_guide(guide, &y)));
        for ratio in &panel.damping_rays {
            rays(panel, *ratio, stack.x.limits, &y, &mut lines, &mut annotations);
        }
        high = low - LABEL_ROOM / plot_height;
    }
    let last = stack.panels.len();
    let mut x = axis(
        &stack.x,
        true,
        extent(stack.panels.iter().flat_map(|p| &p.series).map(|s| &s.x)),
    );
    let anchor = if last > 1 { format!("y{last}") } else { "y".into() };
    x.insert("anchor".into(), json!(anchor));
    x.insert(
        "title".into(),
        json!({ "text": marked(&stack.x.title(0)), "standoff": 6 }),
    );
    layout.insert("xaxis".into(), x.into());
    layout.insert("annotations".into(), annotations.into());
    layout.insert("shapes".into(), lines.into());
    json!({ "data": traces, "layout": layout })
}

fn legend_names(stack: &Stack) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for series in stack.panels.iter().flat_map(|panel| &panel.series) {
        if !series.name.is_empty() && !names.contains(&series.name.as_str()) {
            names.push(&series.name);
        }
    }
    names
}

/// A text above the left end of a panel: upright labels would not fit panels of a phone.
fn label(html: &str, y: f64) -> Value {
    json!({
        "text": html, "showarrow": false, "xref": "paper", "yref": "paper", "x": 0, "xanchor": "left", "align": "left",
        "y": y, "yanchor": "bottom", "font": { "size": 13 },
    })
}

/// Whether a value has a place on a drawing.
fn has_place(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Least and greatest value that has a place.
fn extent<'a>(lists: impl Iterator<Item = &'a Vec<f64>>) -> Option<(f64, f64)> {
    let placed = lists.flatten().copied().filter(|v| has_place(*v));
    placed.fold(None, |range, v| match range {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}

fn axis(axis: &Axis, horizontal: bool, extent: Option<(f64, f64)>) -> Map<String, Value> {
    let common = json!({
        "showline": true, "mirror": "all", "linecolor": FRAME, "linewidth": 1, "ticks": "outside", "ticklen": 4,
        "tickcolor": FRAME, "gridcolor": GRID, "zerolinecolor": ZERO, "zerolinewidth": 1,
        "exponentformat": "power", "hoverformat": ".5~g", "automargin": false,
    });
    let mut out = match common {
        Value::Object(map) => map,
        _ => Map::new(),
    };
    let (low, high) = axis.limits.or(extent).unwrap_or((0.0, 1.0));
    match axis.scale {
        Scale::Log => {
            out.insert("type".into(), json!("log"));
            // Left to itself plotly.js writes 1 and 10 between 10⁻¹ and 10².
            if low > 0.0 && high.is_finite() {
                let decades: Vec<i32> = (low.log10().floor() as i32..=high.log10().ceil() as i32).collect();
                let labels: Vec<String> = decades.iter().map(|e| marked(&ticks::power_label(*e))).collect();
                let places: Vec<f64> = decades.iter().map(|e| 10f64.powi(*e)).collect();
                out.insert("tickmode".into(), json!("array"));
                out.insert("tickvals".into(), json!(places));
                out.insert("ticktext".into(), json!(labels));
            }
            out.insert(
                "minor".into(),
                json!({ "showgrid": true, "gridcolor": MINOR_GRID, "dtick": "D1" }),
            );
        }
        Scale::Degrees => {
            let step = ticks::degrees(low.min(high - 90.0), high.max(low + 90.0), 5).step;
            // Values so large that 90 deg are lost in them have no step.
            if let Some(step) = step.filter(|step| step.value().is_normal()) {
                out.insert("dtick".into(), json!(step.value()));
                out.insert("tick0".into(), json!(0));
            }
        }
        Scale::Decibels | Scale::Linear => {
            out.insert("nticks".into(), json!(if horizontal { 9 } else { 6 }));
        }
    }
    if let Some((low, high)) = axis.limits {
        let (low, high) = match axis.scale {
            Scale::Log => (low.log10(), high.log10()),
            _ => (low, high),
        };
        out.insert("range".into(), json!([low, high]));
    } else if horizontal && axis.scale == Scale::Log && low > 0.0 {
        out.insert("range".into(), json!([low.log10(), high.log10()]));
    }
    out
}

fn curve(series: &Series, y_axis: &str, in_legend: bool) -> Value {
    let style = &series.style;
    let (x, y) = points(series);
    let mode = match (
        style.line.is_some(),
        style.marker.is_some(),
        series.labels.is_empty(),
    ) {
        (true, true, true) => "lines+markers",
        (true, true, false) => "lines+markers+text",
        (true, false, true) => "lines",
        (true, false, false) => "lines+text",
        (false, _, true) => "markers",
        (false, _, false) => "markers+text",
    };
    let name = marked(&series.name);
    let mut trace = Map::new();
    trace.insert("type".into(), json!("scatter"));
    trace.insert("mode".into(), json!(mode));
    trace.insert("name".into(), json!(name));
    trace.insert("legendgroup".into(), json!(name));
    trace.insert("showlegend".into(), json!(in_legend));
    trace.insert("yaxis".into(), json!(y_axis));
    trace.insert("x".into(), json!(x));
    trace.insert("y".into(), json!(y));
    if let Some(dash) = style.line {
        trace.insert("line".into(), line(style, dash));
    }
    if let Some(marker) = style.marker {
        trace.insert("marker".into(), self::marker(marker, style));
    }
    if !series.labels.is_empty() {
        let labels: Vec<String> = series.labels.iter().map(|l| marked(l)).collect();
        trace.insert("text".into(), json!(labels));
        trace.insert("textposition".into(), json!("middle right"));
        trace.insert("textfont".into(), json!({ "size": 11, "color": GUIDE }));
        trace.insert("cliponaxis".into(), json!(true));
    }
    trace.into()
}

fn line(style: &Style, dash: Dash) -> Value {
    let lengths: Vec<String> = dash
        .lengths(style.drawn_width())
        .iter()
        .map(|length| format!("{length:.1}px"))
        .collect();
    let dash = if lengths.is_empty() {
        "solid".to_owned()
    } else {
        lengths.join(",")
    };
    json!({ "color": style.colour.hex(), "width": style.drawn_width(), "dash": dash, "simplify": false })
}

fn marker(marker: Marker, style: &Style) -> Value {
    let symbol = match marker {
        Marker::Disc => "circle",
        Marker::Circle => "circle-open",
        Marker::Square => "square-open",
        Marker::Triangle => "triangle-up-open",
        Marker::Diamond => "diamond-open",
        Marker::Cross => "x-thin-open",
        Marker::Plus => "cross-thin-open",
    };
    let (size, outline) = if marker == Marker::Disc {
        (5, 0.0)
    } else {
        (9, style.drawn_width())
    };
    json!({ "symbol": symbol, "size": size, "color": style.colour.hex(), "line": { "width": outline } })
}

/// The coordinates to be sent. Of long lines only the points remain that change the picture, and digits that cannot be seen
/// are cut off.
fn points(series: &Series) -> (Vec<f64>, Vec<f64>) {
    let (x_range, y_range) = (extent([&series.x].into_iter()), extent([&series.y].into_iter()));
    let (round_x, round_y) = (rounding(x_range), rounding(y_range));
    let all: Vec<Point> = series.points().collect();
    let line_alone = series.style.line.is_some() && series.style.marker.is_none() && series.labels.is_empty();
    // A gap would be lost.
    let whole = all.iter().all(|(x, y)| has_place(*x) && has_place(*y));
    let kept = match (x_range, y_range) {
        (Some(x), Some(y)) if line_alone && whole && x.1 > x.0 && all.len() > LONG => thinned(&all, x, y),
        _ => all,
    };
    kept.into_iter().map(|(x, y)| (round_x(x), round_y(y))).unzip()
}

/// The points that make a magnified picture of a line.
fn thinned(line: &[Point], (x_low, x_high): (f64, f64), (y_low, y_high): (f64, f64)) -> Vec<Point> {
    let (width, height) = MAGNIFIED;
    let across = width / (x_high - x_low);
    let up = if y_high > y_low {
        height / (y_high - y_low)
    } else {
        1.0
    };
    let drawn: Vec<Point> = line
        .iter()
        .map(|(x, y)| (across * (x - x_low), up * (y - y_low)))
        .collect();
    simplify(&extremes(&drawn, f64::floor))
        .into_iter()
        .map(|(x, y)| (x_low + x / across, y_low + y / up))
        .collect()
}

/// Rounds to a decimal that resolves the range; values over several decades (frequencies) keep six digits each.
fn rounding(range: Option<(f64, f64)>) -> impl Fn(f64) -> f64 {
    let decades = range.is_some_and(|(low, high)| low > 0.0 && high > 30.0 * low);
    let decimals = range
        .map(|(low, high)| -(RESOLUTION * (high - low)).log10().floor())
        .filter(|d| d.is_finite() && d.abs() < 300.0);
    move |value: f64| {
        let decimals = match decimals {
            _ if !value.is_finite() || value == 0.0 => return value,
            Some(_) if decades => 5.0 - value.abs().log10().floor(),
            Some(decimals) => decimals,
            None => return value,
        };
        // The decimal text is parsed so that the nearest double is sent: 0.3, not 0.30000000000000004.
        if decimals >= 0.0 {
            let decimals = decimals.min(300.0) as usize;
            format!("{value:.decimals$}").parse().unwrap_or(value)
        } else {
            let unit = 10f64.powf(-decimals);
            (value / unit).round() * unit
        }
    }
}

/// A shaded band behind a curve: one outline, lower side forth and upper side back.
fn band(series: &Series, y_axis: &str) -> Option<Value> {
    let sides: Vec<(f64, f64, f64)> = series
        .x
        .iter()
        .zip(&series.band)
        .map(|(x, (low, high))| (*x, *low, *high))
        .filter(|(x, low, high)| x.is_finite() && low.is_finite() && high.is_finite())
        .collect();
    if sides.len() < 2 {
        return None;
    }
    let forth = sides.iter().map(|(x, low, _)| (*x, *low));
    let back = sides.iter().rev().map(|(x, _, high)| (*x, *high));
    let (x, y): (Vec<f64>, Vec<f64>) = forth.chain(back).unzip();
    let (round_x, round_y) = (
        rounding(extent([&x].into_iter())),
        rounding(extent([&y].into_iter())),
    );
    let (x, y): (Vec<f64>, Vec<f64>) = (
        x.into_iter().map(round_x).collect(),
        y.into_iter().map(round_y).collect(),
    );
    Some(json!({
        "type": "scatter", "mode": "lines", "x": x, "y": y, "yaxis": y_axis, "fill": "toself", "opacity": 0.22,
        "fillcolor": series.style.colour.hex(), "line": { "width": 0 }, "hoverinfo": "skip", "showlegend": false,
        "legendgroup": marked(&series.name),
    }))
}

fn line_of_guide(guide: &Guide, y_axis: &str) -> Value {
    let mut shape = json!({
        "type": "line", "line": { "color": GUIDE, "width": 1, "dash": "4px,3px" },
    });
    if !guide.label.is_empty() {
        // Beside the upper end of an upright line, above the right end of a level one.
        let (x_anchor, y_anchor) = if guide.on_x {
            ("left", "top")
        } else {
            ("right", "bottom")
        };
        shape["label"] = json!({
            "text": marked(&guide.label), "textposition": "end", "textangle": 0, "xanchor": x_anchor,
            "yanchor": y_anchor, "font": { "size": 11, "color": GUIDE },
        });
    }
    let (x, y, x_ref, y_ref) = if guide.on_x {
        (
            json!([guide.value, guide.value]),
            json!([0, 1]),
            "x".into(),
            format!("{y_axis} domain"),
        )
    } else {
        (
            json!([0, 1]),
            json!([guide.value, guide.value]),
            "x domain".to_owned(),
            y_axis.to_owned(),
        )
    };
    for (key, value) in [
        ("x0", x[0].clone()),
        ("x1", x[1].clone()),
        ("y0", y[0].clone()),
        ("y1", y[1].clone()),
        ("xref", json!(x_ref)),
        ("yref", json!(y_ref)),
    ] {
        shape[key] = value;
    }
    shape
}

/// Lines of constant damping from the origin, as far as the points or the limits go.
fn rays(
    panel: &Panel,
    ratio: f64,
    x_limits: Option<(f64, f64)>,
    y_axis: &str,
    lines: &mut Vec<Value>,
    annotations: &mut Vec<Value>,
) {
    let points = || extent(panel.series.iter().map(|s| &s.y));
    let top = panel.y.limits.or_else(points).map_or(0.0, |(_, high)| high);
    if top <= 0.0 || !(0.0..1.0).contains(&ratio) {
        return;
    }
    let slope = ratio / (1.0 - ratio * ratio).sqrt();
    // The line must not widen an axis that is fitted to the points.
    let leftmost = || extent(panel.series.iter().map(|s| &s.x)).map(|(low, _)| low);
    let left = x_limits.map(|(low, _)| low).or_else(leftmost).unwrap_or(0.0);
    if left >= 0.0 {
        return;
    }
    let (x, y) = if -top * slope >= left {
        (-top * slope, top)
    } else {
        (left, -left / slope)
    };
    lines.push(json!({
        "type": "line", "xref": "x", "yref": y_axis, "x0": 0, "y0": 0, "x1": x, "y1": y, "layer": "below",
        "line": { "color": GUIDE, "width": 0.8, "dash": "3px,3px" },
    }));
    annotations.push(json!({
        "text": format!("ζ = {ratio}"), "showarrow": false, "xref": "x", "yref": y_axis, "x": x, "y": y,
        "xanchor": "left", "yanchor": "top", "xshift": 4, "bgcolor": "rgba(255,255,255,0.7)",
        "font": { "size": 11, "color": GUIDE },
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, BodeChannel, BodeCurve, BodePlot, LinePlot, ScatterPlot};

    #[test]
    fn panels_share_their_abscissa_and_fill_the_height() {
        let plot = LinePlot::new("P", Axis::new("t", "s"))
            .with(Panel::new("α", "deg").with(Series::new("a", Style::model(0), [0.0, 1.0], [1.0, 2.0])))
            .with(Panel::new("n_{z}", "").with(Series::new(
                "a",
                Style::model(0),
                [0.0, 1.0],
                [1.0, f64::NAN],
            )));
        let figures = plots(&plot.sheet().unwrap());
        let [figure] = figures.as_slice() else {
            panic!("{figures:?}")
        };
        let layout = &figure["layout"];
        assert_eq!(layout["xaxis"]["anchor"], "y2");
        assert_eq!(layout["yaxis"]["domain"][1], 1.0);
        assert!(layout["yaxis2"]["domain"][0].as_f64().unwrap().abs() < 1e-12);
        assert_eq!(layout["annotations"][1]["text"], "n<sub>z</sub>");
        // A gap stays a gap; one name needs no legend.
        assert!(figure["data"][1]["y"][1].is_null());
        assert_eq!(layout["showlegend"], false);
    }

    #[test]
    fn bode_diagrams_have_decades_and_multiples_of_45_deg() {
        let curve = |name: &str, i| {
            BodeCurve::new(
                name,
                Style::model(i),
                [0.01, 1.0, 100.0],
                [0.0, -3.0, -40.0],
                [0.0, -45.0, -90.0],
            )
        };
        let channel = BodeChannel::new("c").with(curve("a", 0)).with(curve("b", 1));
        let plot = BodePlot::new("B", Axis::log("ω", "rad/s")).with(channel);
        let figures = plots(&plot.sheet().unwrap());
        let layout = &figures[0]["layout"];
        assert_eq!(layout["xaxis"]["type"], "log");
        assert_eq!(layout["xaxis"]["ticktext"][2], "10<sup>0</sup>");
        assert_eq!(layout["xaxis"]["range"], json!([-2.0, 2.0]));
        assert_eq!(layout["yaxis2"]["dtick"].as_f64().unwrap() % 45.0, 0.0);
        assert_eq!(layout["showlegend"], true);
        // Each name once, in the palette of the SVG.
        let shown: Vec<bool> = figures[0]["data"]
            .as_array()
            .unwrap()
            .iter()
            .map(|t| t["showlegend"] == true)
            .collect();
        assert_eq!(shown, [true, true, false, false]);
        assert_eq!(
            figures[0]["data"][1]["line"]["color"],
            Style::model(1).colour.hex()
        );
    }

    #[test]
    fn long_curves_keep_their_shape_and_peaks() {
        let x: Vec<f64> = (0..100_000).map(|i| f64::from(i) * 1e-3).collect();
        let y: Vec<f64> = x
            .iter()
            .map(|t| t.sin() + if (*t - 54.321).abs() < 1e-6 { 5.0 } else { 0.0 })
            .collect();
        let (kept_x, kept_y) = points(&Series::new("s", Style::model(0), x, y));
        assert!(kept_x.len() < 4000, "{}", kept_x.len());
        let highest = kept_x
            .iter()
            .zip(&kept_y)
            .max_by(|a, b| a.1.total_cmp(b.1))
            .unwrap();
        assert!((highest.0 - 54.321).abs() < 2e-3, "{highest:?}");
        // Straight lines between the points kept stay within a thousandth of the range of the curve.
        for (ends, values) in kept_x.windows(2).zip(kept_y.windows(2)) {
            let middle = 0.5 * (ends[0] + ends[1]);
            if (middle - 54.321).abs() > 0.1 {
                assert!(
                    (0.5 * (values[0] + values[1]) - middle.sin()).abs() < 2e-3,
                    "{middle}"
                );
            }
        }
        // Points are never thinned.
        let many = vec![0.0; 3000];
        let (x, _) = points(&Series::new("p", Style::points(0), many.clone(), many));
        assert_eq!(x.len(), 3000);
    }

    #[test]
    fn values_are_rounded_below_what_is_seen() {
        let fine = rounding(Some((10_258.0, 10_258.5)));
        assert_eq!(fine(10_258.123_456_789), 10_258.123_457);
        let decades = rounding(Some((1e-3, 1e3)));
        assert_eq!(decades(1.234_567_89e-3), 1.234_57e-3);
        assert_eq!(rounding(Some((5.0, 5.0)))(5.0), 5.0);
        assert!(fine(f64::NAN).is_nan());
        assert_eq!(rounding(Some((0.0, 1e9)))(123_456_789.0), 123_460_000.0);
    }

    /// A constant phase in which 90 deg are lost, and one beyond what is drawn.
    #[test]
    fn regress_huge_values_have_a_figure() {
        for value in [1e200, -1e300, 1e305, f64::MAX] {
            let mut panel = Panel::new("phase", "deg");
            panel.y.scale = Scale::Degrees;
            let series = Series::new("a", Style::model(0), [0.0, 1.0], [value; 2]);
            let plot = LinePlot::new("P", Axis::new("t", "s")).with(panel.with(series));
            let figures = plots(&plot.sheet().unwrap());
            let step = &figures[0]["layout"]["yaxis"]["dtick"];
            assert!(
                step.is_null() || step.as_f64().unwrap() > 0.0,
                "{value:e}: {step}"
            );
        }
    }

    #[test]
    fn a_pole_map_has_rays() {
        let plot = ScatterPlot::pole_map("P", "rad/s")
            .with(Series::new("p", Style::points(0), [-0.5], [10.0]).with_labels(["1"]))
            .with_damping_rays([0.1]);
        let figures = plots(&plot.sheet().unwrap());
        let ray = &figures[0]["layout"]["shapes"][0];
        let (x, y) = (ray["x1"].as_f64().unwrap(), ray["y1"].as_f64().unwrap());
        assert_eq!(x, -0.5);
        assert!((-x / x.hypot(y) - 0.1).abs() < 1e-12);
        assert_eq!(figures[0]["data"][0]["mode"], "markers+text");
    }
}
