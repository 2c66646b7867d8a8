//! Results as plots.

use super::identify::{Identified, differences};
use crate::output::Failure;
use albatross::lti::{Signal, frequency::unwrap_deg};
use albatross::numerics::C64;
use albatross::report::ReportError;
use albatross::report::plot::{
    Axis, BodeChannel, BodeCurve, BodePlot, Dash, Diagram, GridPlot, Marker, Panel, ScatterPlot, Series,
    Style,
};
use albatross::sysid::residuals::Correlation;
use albatross::sysid::{DataSet, PoleEstimate, ResidualCheck, Simulated};
use std::path::Path;

/// Normal quantile of 99 %, two-sided.
const QUANTILE: f64 = 2.576;
/// Half axes of the 99 % ellipse of two normal variables, in standard deviations: the root of -2 ln 0.01.
const ELLIPSE: f64 = 3.035;
/// Points of a response.
const POINTS: usize = 1200;

/// Unit as a plot shows it; empty for none.
pub(crate) fn unit(signal: &Signal) -> String {
    match signal.unit.as_str() {
        "1" | "-" => String::new(),
        "m/s2" => "m/s^{2}".to_owned(),
        other => other.to_owned(),
    }
}

/// Unit of output over input.
pub(crate) fn ratio(output: &Signal, input: &Signal) -> String {
    match (unit(output).as_str(), unit(input).as_str()) {
        (out, per) if out == per => String::new(),
        (out, "") => out.to_owned(),
        ("", per) => format!("1/{per}"),
        (out, per) => format!("({out})/{per}"),
    }
}

/// File names of records where they tell them apart.
pub(crate) fn short_names<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let short: Vec<&'a str> = names.iter().map(|name| file_name(name)).collect();
    let mut sorted = short.clone();
    sorted.sort_unstable();
    let unique = sorted.iter().zip(sorted.iter().skip(1)).all(|(a, b)| a != b);
    if unique { short } else { names.to_vec() }
}

/// The same of two models.
pub(crate) fn short_pair(names: [&str; 2]) -> [&str; 2] {
    let short = names.map(file_name);
    if short[0] == short[1] { names } else { short }
}

fn file_name(path: &str) -> &str {
    let name = Path::new(path).file_name().and_then(|f| f.to_str());
    name.unwrap_or(path)
}

fn panel_of(signal: &Signal) -> Panel {
    Panel::new(&signal.name, unit(signal))
}

/// Measured and simulated outputs of every record below the input, with the fits in the titles.
pub(crate) fn fits(title: &str, data: &DataSet, simulated: &[Simulated]) -> Result<String, ReportError> {
    let names: Vec<&str> = data.experiments.iter().map(|e| e.name.as_str()).collect();
    let columns = if names.len() * data.outputs.len() > 4 {
        2
    } else {
        1
    };
    let mut plot = GridPlot::new(title, columns);
    for ((experiment, model), name) in data.experiments.iter().zip(simulated).zip(short_names(&names)) {
        let time: Vec<f64> = (0..experiment.len()).map(|k| k as f64 * experiment.dt).collect();
        let fits: Vec<String> = data
            .outputs
            .iter()
            .zip(&model.fits)
            .map(|(output, fit)| {
                let fit = fit.map_or("constant".to_owned(), |f| format!("{f:.2}\u{a0}%"));
                if data.outputs.len() == 1 {
                    format!("fit {fit}")
                } else {
                    format!("{}\u{a0}{fit}", output.name)
                }
            })
            .collect();
        let input = Series::new(
            "input",
            Style::background(),
            time.clone(),
            experiment.input.clone(),
        );
        let mut diagram = Diagram::new(format!("{name}: {}", fits.join(", ")), Axis::new("Time", "s"))
            .with(panel_of(&data.input).with(input).with_height(70.0));
        for ((output, measured), simulated) in
            data.outputs.iter().zip(&experiment.outputs).zip(&model.outputs)
        {
            diagram = diagram.with(
                panel_of(output)
                    .with(Series::new(
                        "measured",
                        // Noise drawn wide would hide the model.
                        Style::reference().with_width(1.6),
                        time.clone(),
                        measured.clone(),
                    ))
                    .with(Series::new(
                        "model",
                        Style::model(0).with_dash(Dash::Dashed),
                        time.clone(),
                        simulated.clone(),
                    )),
            );
        }
        plot = plot.with(diagram);
    }
    Ok(plot.render()?.markup)
}

/// Frequencies from half a turn in the longest record to beyond the fastest mode, below the Nyquist frequency.
fn frequencies(found: &Identified) -> Vec<f64> {
    let data = &found.records.data;
    let longest = data.experiments.iter().map(|e| e.duration()).fold(0.0, f64::max);
    let nyquist = std::f64::consts::PI / data.dt();
    let low = std::f64::consts::PI / longest;
    let fastest = found
        .estimate
        .model
        .poles()
        .iter()
        .filter(|p| p.im > 0.0 && p.norm() < nyquist)
        .map(|p| p.norm())
        .fold(10.0 * low, f64::max);
    grid(low, (2.0 * fastest).min(nyquist), POINTS)
}

/// Equal steps of log frequency.
pub(crate) fn grid(low: f64, high: f64, points: usize) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    (0..points)
        .map(|i| low * (high / low).powf(i as f64 / last))
        .collect()
}

pub(crate) fn magnitude_db(response: &[C64]) -> Vec<f64> {
    response.iter().map(|h| 20.0 * h.norm().log10()).collect()
}

pub(crate) fn phase_deg(response: &[C64]) -> Vec<f64> {
    unwrap_deg(&response.iter().map(|h| h.arg().to_degrees()).collect::<Vec<_>>())
}

/// Response of every output with its 99 % band, residuals taken as coloured as they are.
pub(crate) fn bode(found: &Identified) -> Result<String, Failure> {
    let model = &found.estimate.model;
    let omega = frequencies(found);
    let mut plot = BodePlot::new(
        format!("Response to {}", model.input.name),
        Axis::log("Frequency", "rad/s"),
    );
    for (o, output) in model.outputs.iter().enumerate() {
        let band = match &found.estimate.uncertainty {
            Some(uncertainty) => Some(uncertainty.band(model, o, &omega, true)?),
            None => None,
        };
        let response = model.frequency_response(o, &omega)?;
        let name = if band.is_some() {
            "model with 99 % band"
        } else {
            "model"
        };
        let mut curve = BodeCurve::new(
            name,
            Style::model(0),
            omega.clone(),
            magnitude_db(&response),
            phase_deg(&response),
        );
        if let Some(band) = band {
            let widths: Vec<(f64, f64)> = band
                .sd_magnitude_db
                .iter()
                .zip(&band.sd_phase_deg)
                .map(|(db, deg)| (QUANTILE * db, QUANTILE * deg))
                .collect();
            curve = curve.with_band(widths);
        }
        plot = plot.with(
            BodeChannel::new(&output.name)
                .with_reference(ratio(output, &model.input))
                .with(curve),
        );
    }
    Ok(plot.render()?.markup)
}

/// Poles with positive imaginary part and on the real axis, zeros of every output, ellipses of 99 %.
pub(crate) fn poles(found: &Identified) -> Result<String, Failure> {
    let estimate = &found.estimate;
    let model = &estimate.model;
    let upper: Vec<C64> = model.poles().into_iter().filter(|p| p.im >= 0.0).collect();
    let largest = upper
        .iter()
        .filter(|p| p.im > 0.0)
        .map(|p| p.norm())
        .fold(0.0, f64::max);
    // Real poles and zeros far out would press everything else into a corner.
    let reach = if largest > 0.0 {
        1.15 * largest
    } else {
        1.15 * upper.iter().map(|p| p.norm()).fold(0.0, f64::max)
    };
    let deepest = upper
        .iter()
        .filter(|p| p.im > 0.0)
        .map(|p| p.re)
        .fold(-0.05 * reach, f64::min);
    let rightmost = upper
        .iter()
        .filter(|p| p.norm() <= reach)
        .map(|p| p.re)
        .fold(0.0, f64::max);
    let left = (1.6 * deepest).max(-reach).min(-0.1 * reach);
    let right = (0.1 * left.abs()).max(1.3 * rightmost);
    let shown = |p: &C64| (left..=right).contains(&p.re) && p.im <= reach;

    let outside = upper.iter().filter(|p| !shown(p)).count();
    let mut plot =
        ScatterPlot::pole_map("Poles and zeros", "rad/s").with_damping_rays([0.02, 0.05, 0.1, 0.2, 0.4, 0.7]);
    plot.x = Axis::new("Real part", "1/s").with_limits(left, right);
    plot.y = Axis::new("Imaginary part", "rad/s").with_limits(-0.04 * reach, reach);
    plot.height = 520.0;
    let modes: Vec<&PoleEstimate> = estimate.uncertainty.iter().flat_map(|u| &u.modes).collect();
    let factor = magnification(&modes, &shown, right - left, 1.04 * reach);
    let name = if factor == 1.0 {
        "99 % ellipse".to_owned()
    } else {
        format!("99 % ellipse, {factor} times as large")
    };
    for mode in &modes {
        let centre = C64::new(mode.re, mode.im);
        if !shown(&centre) {
            continue;
        }
        let outline = ellipse(mode, factor);
        let style = Style::model(0).with_dash(Dash::Solid).with_width(1.2);
        plot = plot.with(Series::new(
            &name,
            style,
            outline.iter().map(|p| p.re).collect::<Vec<_>>(),
            outline.iter().map(|p| p.im).collect::<Vec<_>>(),
        ));
    }
    for (o, output) in model.outputs.iter().enumerate() {
        let zeros: Vec<C64> = model
            .zpk(o)?
            .zeros
            .into_iter()
            .filter(|z| z.im >= 0.0 && shown(z))
            .collect();
        let style = Style {
            marker: Some(Marker::Circle),
            ..Style::points(if o == 0 { 4 } else { o })
        };
        plot = plot.with(points(&format!("zeros of {}", output.name), style, &zeros));
    }
    let inside: Vec<C64> = upper.into_iter().filter(|p| shown(p)).collect();
    let labels: Vec<String> = inside
        .iter()
        .map(|p| format!("{:.4}", Significant(p.norm())))
        .collect();
    let style = Style::points(0).with_marker(Marker::Cross);
    plot = plot.with(points("poles, with their frequency in rad/s", style, &inside).with_labels(labels));
    if outside > 0 {
        let poles = if outside == 1 { "pole" } else { "poles" };
        plot.title = format!("Poles and zeros ({outside} {poles} further out)");
    }
    Ok(plot.render()?.markup)
}

/// Four significant digits, at most two decimals.
struct Significant(f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let decimals = (2.0 - self.0.abs().max(1e-3).log10().floor()).clamp(0.0, 2.0) as usize;
        write!(f, "{:.decimals$}", self.0)
    }
}

fn points(name: &str, style: Style, values: &[C64]) -> Series {
    Series::new(
        name,
        style,
        values.iter().map(|p| p.re).collect::<Vec<_>>(),
        values.iter().map(|p| p.im).collect::<Vec<_>>(),
    )
}

/// Power of ten by which ellipses are drawn larger, so that the largest one shown is seen: 1 where it is.
fn magnification(modes: &[&PoleEstimate], shown: &dyn Fn(&C64) -> bool, width: f64, height: f64) -> f64 {
    let mut sizes: Vec<f64> = modes
        .iter()
        .filter(|m| m.im > 0.0 && shown(&C64::new(m.re, m.im)))
        .map(|m| {
            let outline = ellipse(m, 1.0);
            outline
                .iter()
                .map(|p| ((p.re - m.re) / width).abs().max(((p.im - m.im) / height).abs()))
                .fold(0.0, f64::max)
        })
        .filter(|s| s.is_finite() && *s > 0.0)
        .collect();
    sizes.sort_by(f64::total_cmp);
    let Some(median) = sizes.get(sizes.len() / 2) else {
        return 1.0;
    };
    let mut factor = 1.0;
    while median * factor < 0.004 && factor < 1e6 {
        factor *= 10.0;
    }
    factor
}

/// Outline of the 99 % ellipse of a pole, as coloured as the residuals are. The covariance for coloured residuals is that
/// for white ones with the standard deviations of frequency and damping ratio replaced and their correlation kept. Of a
/// real pole the interval on the axis.
pub(crate) fn ellipse(mode: &PoleEstimate, factor: f64) -> Vec<C64> {
    let pole = C64::new(mode.re, mode.im);
    if mode.im == 0.0 {
        let half = QUANTILE * factor * mode.sd_frequency_coloured_rad_s;
        return vec![pole - half, pole + half];
    }
    // Directions of growing frequency and of growing damping ratio.
    let along = pole / pole.norm();
    let across = along * C64::new(0.0, 1.0);
    let [rr, ri, ii] = mode.covariance;
    let form = |p: C64, q: C64| p.re * q.re * rr + (p.re * q.im + p.im * q.re) * ri + p.im * q.im * ii;
    let (v, w, c) = (form(along, along), form(across, across), form(along, across));
    let correlation = if v > 0.0 && w > 0.0 {
        (c / (v * w).sqrt()).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    let larger = |coloured: f64, white: f64| if white > 0.0 { coloured / white } else { 1.0 };
    let a = v.max(0.0).sqrt() * larger(mode.sd_frequency_coloured_rad_s, mode.sd_frequency_rad_s);
    let b = w.max(0.0).sqrt() * larger(mode.sd_damping_ratio_coloured, mode.sd_damping_ratio);
    (0..=96)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / 96.0;
            let (s, t) = (angle.cos(), angle.sin());
            let second = correlation * s + (1.0 - correlation * correlation).sqrt() * t;
            pole + ELLIPSE * factor * (along * (a * s) + across * (b * second))
        })
        .collect()
}

/// Auto- and cross-correlation of the residuals of every record and output, side by side.
pub(crate) fn residuals(title: &str, dt: f64, checks: &[ResidualCheck]) -> Result<String, ReportError> {
    let names: Vec<&str> = checks.iter().map(|c| c.experiment.as_str()).collect();
    let mut distinct = names.clone();
    distinct.dedup();
    let short = short_names(&distinct);
    let mut plot = GridPlot::new(title, 2);
    plot.panel_height = 130.0;
    for (check, name) in checks.iter().zip(&names) {
        let place = distinct.iter().position(|d| d == name).unwrap_or(0);
        let name = short.get(place).copied().unwrap_or(name);
        let of = format!("{name}, {}", check.output);
        plot = plot
            .with(correlation(&format!("{of}: with itself"), dt, &check.auto))
            .with(correlation(&format!("{of}: with the input"), dt, &check.cross));
    }
    Ok(plot.render()?.markup)
}

fn correlation(title: &str, dt: f64, of: &Correlation) -> Diagram {
    let lags: Vec<f64> = of.lags.iter().map(|k| *k as f64 * dt).collect();
    let n = lags.len();
    let bound = of.bound.min(2.0);
    let band = Series::new("99 % bound", Style::background(), lags.clone(), vec![0.0; n]).with_band(vec![
        (
            -bound, bound
        );
        n
    ]);
    let values = Series::new(
        "correlation",
        Style::model(0).with_marker(Marker::Disc),
        lags,
        of.values.clone(),
    );
    Diagram::new(title, Axis::new("Lag", "s")).with(
        Panel::over(Axis::new("Correlation", "").with_limits(-1.05, 1.05))
            .with(band)
            .with(values),
    )
}

/// Residuals over time.
pub(crate) fn residual_histories(data: &DataSet, simulated: &[Simulated]) -> Vec<Vec<Vec<f64>>> {
    data.experiments
        .iter()
        .zip(simulated)
        .map(|(measured, model)| differences(&measured.outputs, &model.outputs))
        .collect()
}
