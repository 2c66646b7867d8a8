//! Results as plots.

use albatross::flight::TimeHistory;
use albatross::lti::Response;
use albatross::report::ReportError;
use albatross::report::plot::{Axis, BodeChannel, BodeCurve, BodePlot, LinePlot, Panel, Series, Style};

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
pub(crate) fn history(name: &str, history: &TimeHistory) -> Result<String, ReportError> {
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
    Ok(plot.render()?.markup)
}

/// Unit of a response, output over input.
fn ratio(output: &str, input: &str) -> String {
    let output = if output == "-" { "1" } else { output };
    if output == input {
        "-".into()
    } else {
        format!("({})/{input}", output.replace("s2", "s^{2}"))
    }
}

/// Magnitude and phase of every output, one curve named after the variant.
pub(crate) fn bode(variant: &str, response: &Response) -> Result<String, Box<dyn std::error::Error>> {
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
    Ok(plot.render()?.markup)
}
