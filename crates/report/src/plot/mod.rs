//! Plots as SVG text.
//!
//! | plot | shows |
//! |---|---|
//! | [`LinePlot`] | curves over one abscissa, in stacked panels: time histories, distributions over span |
//! | [`GridPlot`] | diagrams with abscissae of their own in a grid: records of different length |
//! | [`BodePlot`] | magnitude over phase; systems overlaid, channels in a grid |
//! | [`ScatterPlot`] | points and loci in a plane, with rays of constant damping |
//!
//! All share one look: [`Style::reference`] for what is measured against, [`Style::model`] for models in order,
//! the legend outside the frames, powers of ten in the unit rather than at every tick. Text stays text, in the
//! viewer's sans-serif font; room for it is measured with the widest common one. Equal input gives equal bytes.
//!
//! The SVG is written directly. A plotting library with integer pixels would make smooth curves ragged.

pub(crate) mod axis;
mod bode;
pub(crate) mod curve;
mod drawing;
mod grid;
mod legend;
mod line;
pub(crate) mod palette;
pub(crate) mod panel;
mod scatter;
pub(crate) mod sheet;
pub(crate) mod svg;
pub(crate) mod text;
pub(crate) mod theme;
pub(crate) mod ticks;

pub use axis::{Axis, Scale};
pub use bode::{BodeChannel, BodeCurve, BodePlot, PhaseDisplay};
pub use grid::{Diagram, GridPlot};
pub use line::LinePlot;
pub use palette::{Colour, Dash, Marker, Style};
pub use panel::{Guide, Panel, Series};
pub use scatter::ScatterPlot;
pub use sheet::LegendPlace;

/// A drawn plot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg {
    /// The SVG document.
    pub markup: String,
    /// What had to be left out of the drawing; also written below it.
    pub notes: Vec<String>,
}
