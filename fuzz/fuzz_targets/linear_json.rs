#![no_main]

albatross_fuzz::target!(linear_json);
