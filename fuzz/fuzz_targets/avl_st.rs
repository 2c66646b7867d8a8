#![no_main]

albatross_fuzz::target!(avl_st);
