//! Curves over one abscissa, in one panel or several stacked ones.

use super::Svg;
use super::axis::{Axis, Margin};
use super::panel::Panel;
use super::sheet::{LegendPlace, Sheet, Stack};
use crate::error::ReportError;

/// Height of the frame of a plot with one panel, and of each of several, in pixels.
const SINGLE: f64 = 340.0;
const STACKED: f64 = 140.0;

/// Curves over a common abscissa: time histories, spanwise distributions, flutter diagrams.
///
/// ```
/// use albatross_report::plot::{Axis, LinePlot, Panel, Series, Style};
/// # fn main() -> Result<(), albatross_report::ReportError> {
/// let t: Vec<f64> = (0..=500).map(|i| 0.01 * f64::from(i)).collect();
/// let alpha: Vec<f64> = t.iter().map(|t| 1.33 + (-t).exp() * (1.7 * t).sin()).collect();
/// let svg = LinePlot::new("Short period", Axis::new("Time", "s"))
///     .with(Panel::new("α", "deg").with(Series::new("Albatross", Style::model(0), t, alpha)))
///     .render()?;
/// assert!(svg.markup.starts_with("<svg"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LinePlot {
    /// Title: the heading, and what a screen reader says.
    pub title: String,
    /// Description for those who do not see the plot, put before an account of panels and series.
    pub description: String,
    /// The common abscissa.
    pub x: Axis,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
    /// Width of the whole plot in pixels.
    pub width: f64,
    /// Whether the title is drawn as a heading; a figure with a caption does without.
    pub with_heading: bool,
    /// Where the legend stands.
    pub legend: LegendPlace,
}

impl LinePlot {
    /// A plot without panels, 800 px wide.
    pub fn new(title: impl Into<String>, x: Axis) -> Self {
        Self {
            title: title.into(),
            description: String::new(),
            x,
            panels: Vec::new(),
            width: 800.0,
            with_heading: true,
            legend: LegendPlace::default(),
        }
    }

    /// This plot with another panel below the others.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// This plot without the title drawn above it.
    #[must_use]
    pub fn without_heading(mut self) -> Self {
        self.with_heading = false;
        self
    }

    /// This plot with a description for those who do not see it.
    #[must_use]
    pub fn described(mut self, description: impl Into<String>) -> Self {
        self.description = description.into();
        self
    }

    /// Draws the plot.
    ///
    /// # Errors
    /// [`ReportError`] if there is no panel, a series has lists of different lengths, or limits or sizes
    /// cannot be drawn.
    pub fn render(&self) -> Result<Svg, ReportError> {
        self.sheet()?.render()
    }

    pub(crate) fn sheet(&self) -> Result<Sheet<'_>, ReportError> {
        Ok(Sheet {
            title: &self.title,
            description: &self.description,
            with_heading: self.with_heading,
            legend: self.legend,
            width: self.width,
            panel_height: if self.panels.len() > 1 { STACKED } else { SINGLE },
            columns: 1,
            stacks: vec![Stack {
                title: String::new(),
                x: self.x.clone(),
                panels: self.panels.clone(),
                margin: Margin::Snug,
            }],
            notes: Vec::new(),
        })
    }
}
