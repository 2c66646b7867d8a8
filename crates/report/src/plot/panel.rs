//! One pair of axes with its curves: what is to be drawn.

use super::axis::{Axis, Extent};
use super::palette::Style;
use crate::error::ReportError;

/// A curve or a set of points.
///
/// A point with a coordinate that is not finite is a gap in the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; empty to leave it out. Series of one name and style share one entry.
    pub name: String,
    /// Abscissae.
    pub x: Vec<f64>,
    /// Ordinates, as many as abscissae.
    pub y: Vec<f64>,
    /// How it is drawn.
    pub style: Style,
    /// A text beside each point; empty for none.
    pub labels: Vec<String>,
    /// Lower and upper end of a shaded band at each abscissa, such as a confidence band; empty for none. The axis is
    /// fitted to the curve alone: the band is cut off at the frame.
    pub band: Vec<(f64, f64)>,
}

impl Series {
    /// A series without texts at its points.
    pub fn new(
        name: impl Into<String>,
        style: Style,
        x: impl Into<Vec<f64>>,
        y: impl Into<Vec<f64>>,
    ) -> Self {
        Self {
            name: name.into(),
            x: x.into(),
            y: y.into(),
            style,
            labels: Vec::new(),
            band: Vec::new(),
        }
    }

    /// This series with a shaded band: lower and upper end at each abscissa, in ascending order of abscissae.
    #[must_use]
    pub fn with_band(mut self, ends: impl Into<Vec<(f64, f64)>>) -> Self {
        self.band = ends.into();
        self
    }

    /// This series with a text beside each point, such as a mode number.
    #[must_use]
    pub fn with_labels(mut self, labels: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.labels = labels.into_iter().map(Into::into).collect();
        self
    }

    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.y.iter().copied())
    }

    fn check(&self) -> Result<(), ReportError> {
        let differs = |what, y| ReportError::SeriesLength {
            series: self.name.clone(),
            what,
            x: self.x.len(),
            y,
        };
        if self.x.len() != self.y.len() {
            return Err(differs("y", self.y.len()));
        }
        if !self.labels.is_empty() && self.labels.len() != self.x.len() {
            return Err(differs("point labels", self.labels.len()));
        }
        if !self.band.is_empty() && self.band.len() != self.x.len() {
            return Err(differs("band", self.band.len()));
        }
        Ok(())
    }
}

/// A straight line across a panel that marks a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    /// Text beside the line; may be empty.
    pub label: String,
    /// The value marked.
    pub value: f64,
    /// Whether the value is an abscissa (an upright line) or an ordinate.
    pub on_x: bool,
}

/// One ordinate with the series drawn over it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The ordinate.
    pub y: Axis,
    /// Curves, from back to front.
    pub series: Vec<Series>,
    /// Values marked by straight lines.
    pub guides: Vec<Guide>,
    /// Height of the frame in pixels; chosen by the plot if `None`.
    pub height: Option<f64>,
    /// Damping ratios whose rays from the origin are drawn (pole maps).
    pub(crate) damping_rays: Vec<f64>,
}

impl Panel {
    /// An empty panel with a linear ordinate.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self::over(Axis::new(label, unit))
    }

    /// An empty panel with the given ordinate.
    pub fn over(y: Axis) -> Self {
        Self {
            y,
            series: Vec::new(),
            guides: Vec::new(),
            height: None,
            damping_rays: Vec::new(),
        }
    }

    /// This panel with another series in front.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// This panel with an upright line at an abscissa.
    #[must_use]
    pub fn with_guide_x(mut self, value: f64, label: impl Into<String>) -> Self {
        self.guides.push(Guide {
            label: label.into(),
            value,
            on_x: true,
        });
        self
    }

    /// This panel with a level line at an ordinate.
    #[must_use]
    pub fn with_guide_y(mut self, value: f64, label: impl Into<String>) -> Self {
        self.guides.push(Guide {
            label: label.into(),
            value,
            on_x: false,
        });
        self
    }

    /// This panel with a frame of the given height in pixels.
    #[must_use]
    pub fn with_height(mut self, pixels: f64) -> Self {
        self.height = Some(pixels);
        self
    }

    pub(crate) fn check(&self) -> Result<(), ReportError> {
        self.y.check()?;
        self.series.iter().try_for_each(Series::check)
    }

    /// Adds what is drawn to the extents of both axes. Points outside prescribed abscissae do not count.
    pub(crate) fn extend(&self, x_axis: &Axis, x: &mut Extent, y: &mut Extent) {
        let shown = |value: f64| {
            x_axis
                .limits
                .is_none_or(|(low, high)| (low..=high).contains(&value))
        };
        for (u, v) in self.series.iter().flat_map(Series::points) {
            if let (true, Some(u), Some(v)) = (shown(u), x_axis.place(u), self.y.place(v)) {
                x.add(u);
                y.add(v);
            }
        }
        for guide in &self.guides {
            let (axis, extent) = if guide.on_x {
                (x_axis, &mut *x)
            } else {
                (&self.y, &mut *y)
            };
            if let Some(place) = axis.place(guide.value) {
                extent.add(place);
            }
        }
    }

    /// What had to be left out, for a note below the plot.
    pub(crate) fn omissions(&self, x: &Axis) -> Vec<String> {
        let note = |series: &Series| {
            let left_out = series
                .points()
                .filter(|(u, v)| x.rejects(*u) || self.y.rejects(*v))
                .count();
            (left_out > 0).then(|| {
                let points = if left_out == 1 {
                    "1 point".to_owned()
                } else {
                    format!("{left_out} points")
                };
                let name = if series.name.is_empty() {
                    "a series".to_owned()
                } else {
                    format!("\u{201C}{}\u{201D}", series.name)
                };
                format!("{points} of {name} not shown: no place on a logarithmic axis.")
            })
        };
        self.series.iter().filter_map(note).collect()
    }
}
