//! Integration tests of the facade.

mod oracle;
