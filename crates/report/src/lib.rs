//! Tables, plots and pages of results.
//!
//! # The problem
//!
//! An analysis ends in numbers that somebody must read, compare and print: eigenvalues beside those of a paper,
//! a time history beside a reference, a frequency response beside an identified one. This crate gives them a
//! form. It computes nothing physical, knows no aircraft, and reads and writes no files: structs go in, text
//! comes out, and the same structs give the same bytes.
//!
//! # Tables
//!
//! A [`Table`] has columns with units and number formats, and cells that may be missing or carry a remark. It is
//! written down once and rendered four ways: Markdown for documents, aligned text for terminals, CSV and JSON
//! with every digit for programs. A [`Page`] joins tables and pictures to a Markdown document.
//!
//! ```
//! use albatross_report::{Cell, Column, Format, Table};
//! # fn main() -> Result<(), albatross_report::ReportError> {
//! let mut modes = Table::new(
//!     "Structural modes",
//!     [
//!         Column::new("mode", "", Format::Fixed(0)),
//!         Column::new("frequency", "Hz", Format::Fixed(2)),
//!         Column::new("paper", "Hz", Format::Fixed(2)),
//!     ],
//! );
//! modes.push([1_i64.into(), 2.4312.into(), 2.43.into()])?;
//! modes.push([2_i64.into(), 3.1398.into(), Cell::from(3.14).flagged("read off a figure")])?;
//! assert_eq!(
//!     modes.to_text(),
//!     "\
//! Structural modes
//! mode  frequency     paper
//!              Hz        Hz
//! ─────────────────────────
//!    1       2.43  2.43
//!    2       3.14  3.14 (a)
//! (a) read off a figure
//! "
//! );
//! # Ok(())
//! # }
//! ```
//!
//! # Plots
//!
//! [`plot`] draws curves in stacked panels, Bode diagrams and pole maps as SVG: text stays text, colours are safe
//! for colour-blind readers and told apart in grey print by lightness and dash, and curves are thinned to what
//! can be seen without losing a peak.
//!
//! # Reports
//!
//! [`html`] puts tables, plots and shapes in space into one file for a browser. On a screen its plots can be zoomed and
//! read off, drawn by plotly.js, which is part of the file; in print they are the SVG.
//!
//! # Limits
//!
//! - Data cannot make a plot fail: values that are not finite are gaps, and those that a logarithmic axis has no
//!   place for are left out with a note. [`ReportError`] means that the request contradicts itself.
//! - Widths of text are estimated with the metrics of a wide sans-serif font; in a wider one labels may touch.
//! - A table is text in memory, meant for pages rather than for millions of rows.

mod error;
pub mod html;
mod markdown;
mod number;
pub mod plot;
mod table;

pub use error::ReportError;
pub use html::HtmlReport;
pub use markdown::Page;
pub use number::Format;
pub use table::{Cell, Column, Table};
