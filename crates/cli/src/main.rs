//! The command `albatross`.

fn main() {}
