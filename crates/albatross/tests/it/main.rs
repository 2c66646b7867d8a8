//! Integration tests of the facade.

mod f25;
mod flight_f25;
mod oracle;
