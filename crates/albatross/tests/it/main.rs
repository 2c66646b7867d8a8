//! Integration tests of the facade.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test stops where it fails"
)]

mod damage;
mod damaged_cases;
mod f25;
mod faults;
mod flight_f25;
mod oracle;
mod readers;
