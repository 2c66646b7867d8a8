#![no_main]

use albatross_fuzz::{bounded, modal_strip};
use arbitrary::{Arbitrary, Unstructured};

libfuzzer_sys::fuzz_target!(|data: &[u8]| bounded(data, |data| {
    if let Ok(case) = modal_strip::Case::arbitrary(&mut Unstructured::new(data)) {
        modal_strip::run(&case);
    }
}));
