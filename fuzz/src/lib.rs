//! What the targets share: the readers, the bound on memory, the chain from modes to strips.
//!
//! The readers are those of the mutation test of `albatross`, so that both read alike.

#[path = "../../crates/albatross/tests/it/readers.rs"]
pub mod readers;

pub mod modal_strip;

use cap::Cap;
use std::alloc::System;

/// Memory in use at one time beyond [`bounded`]'s limit ends the target.
#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// What an input may take whatever its size \[bytes\].
const ALLOWANCE: usize = 64 << 20;
/// What it may take for each of its bytes.
const PER_BYTE: usize = 10;

/// Reads an input with at most ten times its size and 64 MB of memory at one time.
pub fn bounded(data: &[u8], read: impl FnOnce(&[u8])) {
    let limit = ALLOCATOR.allocated() + ALLOWANCE + PER_BYTE * data.len();
    // A limit below what is in use already cannot occur.
    ALLOCATOR.set_limit(limit).unwrap_or_default();
    read(data);
    ALLOCATOR.set_limit(usize::MAX).unwrap_or_default();
}

/// The target of a reader.
#[macro_export]
macro_rules! target {
    ($reader:ident) => {
        libfuzzer_sys::fuzz_target!(|data: &[u8]| $crate::bounded(data, |data| {
            $crate::readers::$reader(data);
        }));
    };
}
