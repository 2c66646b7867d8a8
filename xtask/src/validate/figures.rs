//! The figures of the report.

use super::identification::{Identification, Output};
use super::reference::{MANOEUVRES, QUANTITIES, Quantity};
use super::study::{AVL, CORRECTED, Study, Variant};
use crate::error::Error;
use albatross::lti::frequency::unwrap_deg;
use albatross::report::html;
use albatross::report::plot::{Axis, BodeChannel, BodeCurve, BodePlot, Dash, LinePlot, Panel, Series, Style};
use albatross::strip::slopes::base_name;
use albatross::sysid::Band;

/// A drawn figure.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    /// File name.
    pub(crate) file: String,
    /// For those who do not see it.
    pub(crate) alternative: String,
    /// Below it, Markdown.
    pub(crate) caption: String,
    /// What is drawn.
    pub(crate) plot: Drawing,
}

/// The plot of a figure.
#[derive(Debug, Clone)]
pub(crate) enum Drawing {
    /// Curves over one abscissa.
    Lines(LinePlot),
    /// Bode diagrams.
    Bode(BodePlot),
}

impl Figure {
    /// The SVG document.
    pub(crate) fn svg(&self) -> Result<String, Error> {
        let drawn = match &self.plot {
            Drawing::Lines(plot) => plot.render()?,
            Drawing::Bode(plot) => plot.render()?,
        };
        Ok(drawn.markup)
    }
}

impl<'a> From<&'a Drawing> for html::Figure<'a> {
    fn from(drawing: &'a Drawing) -> Self {
        match drawing {
            Drawing::Lines(plot) => plot.into(),
            Drawing::Bode(plot) => plot.into(),
        }
    }
}

/// Figures 4 and 7 to 13 of the paper, of the surrogate, and the elastic range of Figure 8.
pub(crate) fn all(study: &Study, identification: &Identification) -> Result<Vec<Figure>, Error> {
    let mut figures = vec![strip_lift(study)?, longitudinal(study)?];
    let limits = study.inputs.case.bode;
    figures.push(Figure {
        file: "figure08_bode.svg".into(),
        alternative: "Bode diagrams from the elevator to the vertical acceleration at cockpit, last passenger and right \
                      wing tip, and to the pitch rate"
            .into(),
        caption: "**Figure 8.** Frequency responses from the elevator: the linearised models, and the transfer functions \
                  identified from the reference's histories at the searched orders, over the paper's band."
            .into(),
        plot: bode(study, identification, [limits.from_rad_s, limits.to_rad_s])?,
    });
    figures.push(Figure {
        file: "figure08b_bode_elastic.svg".into(),
        alternative: "The same Bode diagrams from 10 to 100 rad/s".into(),
        caption: "**Figure 8, elastic range.** The same over the elastic modes.".into(),
        plot: bode(study, identification, ELASTIC)?,
    });
    for (index, number) in [(0, 9), (1, 10), (2, 11)] {
        figures.push(accelerations(study, identification, index, number)?);
    }
    figures.push(claim(study, 12, 0, 0, (0.0, 10.0))?);
    figures.push(claim(study, 13, 4, 2, (0.4, 2.0))?);
    Ok(figures)
}

/// Style of a variant in every figure.
fn style(variant: usize) -> Style {
    Style::model(variant)
}

/// Figure 4: lift coefficient of the wing's strips at zero incidence, and its slope.
fn strip_lift(study: &Study) -> Result<Figure, Error> {
    let mut lift = Panel::new("c_{l} at α = 0", "");
    let mut slope = Panel::new("c_{lα}", "1/rad");
    for (index, name) in [(AVL, "AVL only"), (CORRECTED, "corrected")] {
        let mut strips: Vec<[f64; 3]> = study
            .variant(index)?
            .model
            .strips
            .records
            .iter()
            .filter(|r| base_name(&r.surface).eq_ignore_ascii_case("wing") && r.leading_edge[1] > 0.0)
            .map(|r| [r.leading_edge[1], r.cl0, r.cl_alpha])
            .collect();
        strips.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let column = |i: usize| -> Vec<f64> { strips.iter().map(|s| s[i]).collect() };
        lift.series
            .push(Series::new(name, style(index), column(0), column(1)));
        slope
            .series
            .push(Series::new(name, style(index), column(0), column(2)));
    }
    let plot = LinePlot::new(
        "Strip lift of the right wing",
        Axis::new("y", "m").with_limits(0.0, 22.5),
    )
    .with(lift.with_height(190.0))
    .with(slope.with_height(150.0));
    Ok(Figure {
        file: "figure04_strip_lift.svg".into(),
        alternative: "Lift coefficient of the right wing's strips at zero incidence and its slope over the span, with AVL \
                      data and with the correction"
            .into(),
        caption: "**Figure 4.** Lift coefficient of the right wing's strips at zero incidence, and its slope with \
                  incidence: AVL (Prandtl-Glauert at M cos Λ = 0.6925) and the data of the correction. The paper shows \
                  AVL against CFD; here the correction is the reference's own strip table, which is synthetic."
            .into(),
        plot: Drawing::Lines(plot.without_heading()),
    })
}

/// Figure 7: elevator, incidence, pitch rate and load factor after the 0.5 Hz doublet.
fn longitudinal(study: &Study) -> Result<Figure, Error> {
    let mut plot = LinePlot::new(
        "0.5 Hz elevator doublet",
        Axis::new("Time", "s").with_limits(0.0, 10.0),
    );
    let mut elevator = Panel::new("δ_{e}", "deg").with_height(100.0);
    if let Some(history) = study.reference.histories.first() {
        let (time, deflection) = (history.time.clone(), history.elevator_deg.clone());
        elevator
            .series
            .push(Series::new("reference", Style::reference(), time, deflection));
    }
    for (index, variant) in study.variants.iter().enumerate() {
        if let Some(flight) = variant.flights.first() {
            let (time, deflection) = (flight.time.clone(), flight.elevator_deg.clone());
            elevator
                .series
                .push(Series::new(variant.name, style(index), time, deflection));
        }
    }
    plot.panels.push(elevator);
    for quantity in 0..3 {
        plot.panels
            .push(panel(study, quantity, 0, &[0, 1, 2]).with_height(150.0));
    }
    Ok(Figure {
        file: "figure07_doublet_0p5Hz.svg".into(),
        alternative: "Elevator, incidence, pitch rate and load factor after the 0.5 Hz elevator doublet: reference and three \
                      variants"
            .into(),
        caption: "**Figure 7.** The 0.5 Hz elevator doublet. All models fly the same deviation of the elevator from their \
                  own trim."
            .into(),
        plot: Drawing::Lines(plot.without_heading()),
    })
}

/// A panel with one quantity of one manoeuvre: the reference and some variants.
fn panel(study: &Study, quantity: usize, manoeuvre: usize, variants: &[usize]) -> Panel {
    let Some(shown) = QUANTITIES.get(quantity) else {
        return Panel::new("", "");
    };
    let mut panel = Panel::new(shown.symbol, shown.unit);
    if let Some(history) = study.reference.histories.get(manoeuvre)
        && let Some(series) = history.series.get(quantity)
    {
        let (time, values) = (history.time.clone(), series.clone());
        panel
            .series
            .push(Series::new("reference", Style::reference(), time, values));
    }
    for &index in variants {
        if let Some(variant) = study.variants.get(index)
            && let Some(flight) = variant.flights.get(manoeuvre)
            && let Some(series) = flight.series.get(quantity)
        {
            let (time, values) = (flight.time.clone(), series.clone());
            panel
                .series
                .push(Series::new(variant.name, style(index), time, values));
        }
    }
    panel
}

/// Range of the second half of Figure 8 [rad/s].
const ELASTIC: [f64; 2] = [10.0, 100.0];

/// Name of the identified transfer functions in every figure.
const IDENTIFIED: &str = "identified from the reference";

/// Style of the identified transfer functions: over the reference's history, which they should cover, broken.
fn identified_style() -> Style {
    Style::model(4)
}

/// Figure 8: frequency responses from the elevator between two frequencies.
fn bode(study: &Study, identification: &Identification, [from, to]: [f64; 2]) -> Result<Drawing, Error> {
    let mut plot = BodePlot::new(
        "Frequency response to the elevator",
        Axis::log("Frequency", "rad/s").with_limits(from, to),
    );
    for (quantity, reference) in [
        (3, "(m/s^{2})/rad"),
        (4, "(m/s^{2})/rad"),
        (5, "(m/s^{2})/rad"),
        (1, "(rad/s)/rad"),
    ] {
        let Some(shown) = QUANTITIES.get(quantity) else {
            continue;
        };
        let mut channel = BodeChannel::new(format!("δ_{{e}} to {}", title(shown))).with_reference(reference);
        if let Some(output) = identification.of_quantity(quantity) {
            channel = channel.with(identified_curve(output)?);
        }
        for (index, variant) in study.variants.iter().enumerate() {
            channel = channel.with(curve(variant, shown, index)?);
        }
        plot = plot.with(channel);
    }
    plot.width = 1000.0;
    Ok(Drawing::Bode(plot.without_heading()))
}

/// The identified frequency response over the paper's band.
fn identified_curve(output: &Output) -> Result<BodeCurve, Error> {
    let grid = Band::default().grid()?;
    let response = output.searched.response(&grid)?;
    let magnitude: Vec<f64> = response.iter().map(|h| 20.0 * h.norm().log10()).collect();
    let phase: Vec<f64> = response.iter().map(|h| h.arg().to_degrees()).collect();
    Ok(BodeCurve::new(
        IDENTIFIED,
        // Behind the models.
        identified_style().with_dash(Dash::Solid).with_width(3.2),
        grid,
        magnitude,
        unwrap_deg(&phase),
    ))
}

fn title(shown: &Quantity) -> String {
    if shown.sensor == "q" {
        "q, centre of gravity".into()
    } else {
        shown.symbol.to_owned()
    }
}

fn curve(variant: &Variant, shown: &Quantity, index: usize) -> Result<BodeCurve, Error> {
    let channel = variant.response.get(shown.sensor, &variant.model.point.control)?;
    Ok(BodeCurve::new(
        variant.name,
        style(index),
        channel.omega_rad_s.clone(),
        channel.magnitude_db(),
        channel.phase_deg(),
    ))
}

/// Figures 9 to 11: accelerations along the structure and pitch rate after one doublet.
fn accelerations(
    study: &Study,
    identification: &Identification,
    manoeuvre: usize,
    number: u32,
) -> Result<Figure, Error> {
    let (name, shown) = MANOEUVRES.get(manoeuvre).copied().unwrap_or_default();
    // The shorter the doublet, the sooner all is over.
    let limits = [(0.0, 10.0), (0.4, 3.0), (0.4, 2.0)]
        .get(manoeuvre)
        .copied()
        .unwrap_or((0.0, 5.0));
    let mut plot = LinePlot::new(
        format!("{shown} elevator doublet"),
        Axis::new("Time", "s").with_limits(limits.0, limits.1),
    );
    for quantity in [3, 4, 5, 1] {
        let mut panel = panel(study, quantity, manoeuvre, &[0, 1, 2]).with_height(170.0);
        if let Some(history) = study.reference.histories.get(manoeuvre)
            && let Some(output) = identification.of_quantity(quantity)
            && let Some(values) = output.history(study, manoeuvre)?
        {
            panel.series.push(Series::new(
                IDENTIFIED,
                identified_style(),
                history.time.clone(),
                values,
            ));
        }
        plot.panels.push(panel);
    }
    Ok(Figure {
        file: format!("figure{number:02}_{name}.svg"),
        alternative: format!(
            "Vertical acceleration at cockpit, last passenger and right wing tip, and pitch rate, after the {shown} elevator \
             doublet: reference, three variants and identified transfer functions"
        ),
        caption: format!(
            "**Figure {number}.** The {shown} elevator doublet: vertical acceleration (positive down, gravity not included) \
             along the structure and pitch rate of the mean axes: reference, three variants, and the transfer functions \
             identified from the reference's histories at the searched orders. Fits are in the tables; they are taken \
             over the whole record, of which the figure shows {} to {} s.",
            limits.0, limits.1
        ),
        plot: Drawing::Lines(plot.without_heading()),
    })
}

/// Figures 12 and 13: what the correction does to one output.
fn claim(
    study: &Study,
    number: u32,
    quantity: usize,
    manoeuvre: usize,
    limits: (f64, f64),
) -> Result<Figure, Error> {
    let (name, shown) = MANOEUVRES.get(manoeuvre).copied().unwrap_or_default();
    let sensor = QUANTITIES.get(quantity).map_or("", |q| q.sensor);
    let what = QUANTITIES.get(quantity).map_or("", |q| q.name);
    let plot = LinePlot::new(
        format!("{what}, {shown} elevator doublet"),
        Axis::new("Time", "s").with_limits(limits.0, limits.1),
    )
    .with(panel(study, quantity, manoeuvre, &[AVL, CORRECTED]));
    let fit = |index: usize| {
        let flights = study.variants.get(index).map(|v| &v.flights);
        flights
            .and_then(|f| f.get(manoeuvre)?.fits.get(quantity).copied())
            .unwrap_or(f64::NAN)
    };
    Ok(Figure {
        file: format!("figure{number:02}_{sensor}_{name}.svg"),
        alternative: format!("{what} after the {shown} elevator doublet: reference, AVL only and corrected"),
        caption: format!(
            "**Figure {number}.** The paper's main claim on {what} after the {shown} doublet: fit of {:.1} % with AVL data \
             only, {:.1} % corrected.",
            fit(AVL),
            fit(CORRECTED)
        ),
        plot: Drawing::Lines(plot.without_heading()),
    })
}
