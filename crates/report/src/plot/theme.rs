//! Sizes and colours that all plots share.
//!
//! Sizes are in pixels of a plot 800 px wide. Printed 16 cm wide, text of 12 px is 6.8 pt high.

/// Size of tick labels.
pub(crate) const TICK: f64 = 12.0;
/// Size of axis labels and titles of single frames.
pub(crate) const LABEL: f64 = 13.0;
/// Size of legend entries.
pub(crate) const LEGEND: f64 = 12.5;
/// Size of the heading.
pub(crate) const HEADING: f64 = 15.0;
/// Size of notes and of labels inside the frame.
pub(crate) const NOTE: f64 = 11.0;
/// Distance between base lines, in sizes of the text.
pub(crate) const LINE: f64 = 1.3;
/// Empty rim around everything.
pub(crate) const RIM: f64 = 10.0;
/// Length of a tick mark.
pub(crate) const TICK_MARK: f64 = 4.0;

/// Colour of text.
pub(crate) const INK: &str = "#1a1a1a";
/// Colour of text of little weight.
pub(crate) const FAINT_INK: &str = "#8a8a8a";
/// Colour of frames and tick marks.
pub(crate) const FRAME: &str = "#3c3c3c";
/// Colour of grid lines at labelled ticks.
pub(crate) const GRID: &str = "#dcdcdc";
/// Colour of grid lines between labelled ticks.
pub(crate) const MINOR_GRID: &str = "#eeeeee";
/// Colour of the line through zero.
pub(crate) const ZERO: &str = "#a8a8a8";
/// Colour of guides and their labels.
pub(crate) const GUIDE: &str = "#6a6a6a";
