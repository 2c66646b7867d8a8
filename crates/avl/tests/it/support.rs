//! Where the test files are.

use std::path::PathBuf;

/// A file of `fixtures/`.
pub(crate) fn fixture(path: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures")).join(path)
}

/// Text of a file of `fixtures/`.
pub(crate) fn fixture_text(path: &str) -> String {
    albatross_avl::read_text(fixture(path)).unwrap()
}

/// A file that others made, if the environment says where these are; else the test says that it skips.
pub(crate) fn third_party(path: &str) -> Option<String> {
    let Some(root) = std::env::var_os("ALBATROSS_THIRD_PARTY") else {
        eprintln!("ALBATROSS_THIRD_PARTY is not set: skipping {path}");
        return None;
    };
    Some(albatross_avl::read_text(PathBuf::from(root).join(path)).unwrap())
}
