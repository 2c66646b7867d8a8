#![no_main]

albatross_fuzz::target!(slopes);
