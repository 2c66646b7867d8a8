#![no_main]

albatross_fuzz::target!(f06);
