#![no_main]

albatross_fuzz::target!(modal_basis);
