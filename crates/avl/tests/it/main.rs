//! Integration tests: real files, damaged files, round trips.

mod support;

mod results;
