//! Integration tests of the facade.

mod f25;
mod oracle;
