#![no_main]

albatross_fuzz::target!(longitudinal_json);
