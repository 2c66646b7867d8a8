#![no_main]

albatross_fuzz::target!(records);
