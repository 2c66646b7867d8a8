//! What can be wrong with a table or a plot that was asked for.

use thiserror::Error;

/// A table or plot that cannot be drawn as given.
///
/// Data never cause an error: gaps, infinities, empty and constant series are drawn for what they are.
/// Only a contradiction in the request does.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A row has more or fewer cells than the table has columns.
    #[error(
        "table `{table}`, row {row}: {found} cells for {expected} columns; \
         give one cell per column (Cell::Missing where there is no value)"
    )]
    RowLength {
        /// Title of the table.
        table: String,
        /// One-based number the row would have had.
        row: usize,
        /// Cells in the row.
        found: usize,
        /// Columns of the table.
        expected: usize,
    },

    /// The coordinate lists of a series differ in length.
    #[error("series `{series}`: {x} abscissae but {y} ordinates ({what}); the lists must have one length")]
    SeriesLength {
        /// Name of the series.
        series: String,
        /// Which list is meant by the second length: `y`, `magnitude`, `phase`, `band` or `point labels`.
        what: &'static str,
        /// Length of the list of abscissae.
        x: usize,
        /// Length of the other list.
        y: usize,
    },

    /// A plot without a single panel or channel.
    #[error("plot `{plot}` has nothing to draw on; add at least one panel or channel")]
    NoPanels {
        /// Title of the plot.
        plot: String,
    },

    /// Limits prescribed for an axis do not span an interval on its scale.
    #[error(
        "axis `{axis}`: limits {low} to {high} do not span an interval; \
         they must be finite and increasing, and positive on a logarithmic axis"
    )]
    AxisLimits {
        /// Label of the axis.
        axis: String,
        /// Prescribed lower limit.
        low: f64,
        /// Prescribed upper limit.
        high: f64,
    },

    /// A size that leaves no room for the plot.
    #[error("plot `{plot}`: {what} of {value} px; at least {least} px and at most {most} px can be drawn")]
    Size {
        /// Title of the plot.
        plot: String,
        /// Which size is meant.
        what: &'static str,
        /// The size asked for, in pixels.
        value: f64,
        /// Smallest size, in pixels.
        least: f64,
        /// Largest size, in pixels.
        most: f64,
    },

    /// A shape does not have one displacement for each point.
    #[error("shape `{shape}`: {found} displacements for {expected} points; give one for each")]
    ShapePoints {
        /// Name of the shape.
        shape: String,
        /// Displacements of the shape.
        found: usize,
        /// Points.
        expected: usize,
    },

    /// A line or face between points that are not there.
    #[error("a {what} of `{shapes}` joins point {index}; there are {points} points, counted from 0")]
    ShapeIndex {
        /// Title of the shapes.
        shapes: String,
        /// `line` or `face`.
        what: &'static str,
        /// Point named.
        index: usize,
        /// Points.
        points: usize,
    },
}
