//! Diagrams with abscissae of their own, side by side and below each other.

use super::Svg;
use super::axis::{Axis, Margin};
use super::panel::Panel;
use super::sheet::{LegendPlace, Sheet, Stack};
use crate::error::ReportError;

/// One diagram of a [`GridPlot`]: panels over an abscissa, below a title.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// Title above the panels; may be empty.
    pub title: String,
    /// The abscissa.
    pub x: Axis,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
}

impl Diagram {
    /// A diagram without panels.
    pub fn new(title: impl Into<String>, x: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            panels: Vec::new(),
        }
    }

    /// This diagram with another panel below the others.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }
}

/// Curves over abscissae that differ: records of different length, correlations over different lags.
///
/// ```
/// use albatross_report::plot::{Axis, Diagram, GridPlot, Panel, Series, Style};
/// # fn main() -> Result<(), albatross_report::ReportError> {
/// let record = |name: &str, t: Vec<f64>, y: Vec<f64>| {
///     Diagram::new(name, Axis::new("Time", "s")).with(Panel::new("q", "deg/s").with(Series::new(
///         "measured",
///         Style::reference(),
///         t,
///         y,
///     )))
/// };
/// let svg = GridPlot::new("Two records", 2)
///     .with(record("short", vec![0.0, 1.0], vec![0.0, 2.0]))
///     .with(record("long", vec![0.0, 10.0], vec![0.0, 1.0]))
///     .render()?;
/// assert!(svg.markup.contains("short"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GridPlot {
    /// Title: the heading, and what a screen reader says.
    pub title: String,
    /// Description for those who do not see the plot.
    pub description: String,
    /// Diagrams, row by row.
    pub diagrams: Vec<Diagram>,
    /// Diagrams side by side.
    pub columns: usize,
    /// Height of panels that do not set their own, in pixels.
    pub panel_height: f64,
    /// Width of the whole plot in pixels.
    pub width: f64,
    /// Whether the title is drawn as a heading.
    pub with_heading: bool,
    /// Where the legend stands.
    pub legend: LegendPlace,
}

impl GridPlot {
    /// A plot without diagrams, 800 px wide, panels 140 px high.
    pub fn new(title: impl Into<String>, columns: usize) -> Self {
        Self {
            title: title.into(),
            description: String::new(),
            diagrams: Vec::new(),
            columns,
            panel_height: 140.0,
            width: 800.0,
            with_heading: true,
            legend: LegendPlace::default(),
        }
    }

    /// This plot with another diagram.
    #[must_use]
    pub fn with(mut self, diagram: Diagram) -> Self {
        self.diagrams.push(diagram);
        self
    }

    /// Draws the plot.
    ///
    /// # Errors
    /// [`ReportError`] if there is no panel, a series has lists of different lengths, or limits or sizes cannot be
    /// drawn.
    pub fn render(&self) -> Result<Svg, ReportError> {
        self.sheet()?.render()
    }

    pub(crate) fn sheet(&self) -> Result<Sheet<'_>, ReportError> {
        let stacks = self.diagrams.iter().map(|diagram| Stack {
            title: diagram.title.clone(),
            x: diagram.x.clone(),
            panels: diagram.panels.clone(),
            margin: Margin::Snug,
        });
        Ok(Sheet {
            title: &self.title,
            description: &self.description,
            with_heading: self.with_heading,
            legend: self.legend,
            width: self.width,
            panel_height: self.panel_height,
            columns: self.columns,
            stacks: stacks.collect(),
            notes: Vec::new(),
        })
    }
}
