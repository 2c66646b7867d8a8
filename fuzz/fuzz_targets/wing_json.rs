#![no_main]

albatross_fuzz::target!(wing_json);
