//! Tables (Markdown, CSV, JSON) and SVG plots from result structs.
mod error;
mod markdown;
mod number;
pub mod plot;
mod table;
pub use error::ReportError;
pub use markdown::Page;
pub use number::Format;
pub use table::{Cell, Column, Table};
