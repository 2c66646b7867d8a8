//! Tests on whole files: the fixtures, third-party samples, and pages written here after the formats' descriptions.

mod f06_fixtures;
