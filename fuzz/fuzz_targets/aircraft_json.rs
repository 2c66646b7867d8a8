#![no_main]

albatross_fuzz::target!(aircraft_json);
