//! Integration tests of tables and plots.

mod plots;
mod svg_check;
mod tables;
