//! Points in a plane: poles, zeros, root loci, parameter against parameter.

use super::Svg;
use super::axis::{Axis, Margin};
use super::panel::{Panel, Series};
use super::sheet::{LegendPlace, Sheet, Stack};
use crate::error::ReportError;

/// Points or loci in a plane, with rays of constant damping if asked for.
///
/// ```
/// use albatross_report::plot::{ScatterPlot, Series, Style};
/// # fn main() -> Result<(), albatross_report::ReportError> {
/// let poles = Series::new("poles", Style::points(0), [-0.9, -1.2], [1.65, 18.95]).with_labels(["SP", "1"]);
/// let svg = ScatterPlot::pole_map("Aeroelastic modes", "rad/s").with(poles).with_damping_rays([0.05, 0.1]).render()?;
/// assert!(svg.markup.contains("ζ = 0.05"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ScatterPlot {
    /// Title: the heading, and what a screen reader says.
    pub title: String,
    /// Description for those who do not see the plot.
    pub description: String,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// Sets of points, or loci, from back to front.
    pub series: Vec<Series>,
    /// Damping ratios whose rays from the origin are drawn, on linear axes.
    pub damping_rays: Vec<f64>,
    /// Width of the whole plot in pixels.
    pub width: f64,
    /// Height of the frame in pixels.
    pub height: f64,
    /// Whether the title is drawn as a heading.
    pub with_heading: bool,
    /// Where the legend stands.
    pub legend: LegendPlace,
}

impl ScatterPlot {
    /// A plot without points, 800 px wide.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            description: String::new(),
            x,
            y,
            series: Vec::new(),
            damping_rays: Vec::new(),
            width: 800.0,
            height: 420.0,
            with_heading: true,
            legend: LegendPlace::default(),
        }
    }

    /// The complex plane of eigenvalues in the unit given.
    pub fn pole_map(title: impl Into<String>, unit: &str) -> Self {
        Self::new(
            title,
            Axis::new("Real part", unit),
            Axis::new("Imaginary part", unit),
        )
    }

    /// This plot with another set of points in front.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// This plot with rays of constant damping ratio from the origin.
    #[must_use]
    pub fn with_damping_rays(mut self, ratios: impl IntoIterator<Item = f64>) -> Self {
        self.damping_rays.extend(ratios);
        self
    }

    /// Draws the plot.
    ///
    /// # Errors
    /// [`ReportError`] if a series has lists of different lengths, or limits or sizes cannot be drawn.
    pub fn render(&self) -> Result<Svg, ReportError> {
        self.sheet()?.render()
    }

    pub(crate) fn sheet(&self) -> Result<Sheet<'_>, ReportError> {
        let mut panel = Panel::over(self.y.clone()).with_height(self.height);
        panel.series.clone_from(&self.series);
        panel.damping_rays.clone_from(&self.damping_rays);
        Ok(Sheet {
            title: &self.title,
            description: &self.description,
            with_heading: self.with_heading,
            legend: self.legend,
            width: self.width,
            panel_height: self.height,
            columns: 1,
            stacks: vec![Stack {
                title: String::new(),
                x: self.x.clone(),
                panels: vec![panel],
                margin: Margin::Airy,
            }],
            notes: Vec::new(),
        })
    }
}
