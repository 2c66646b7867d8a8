//! What the tests share: the fixtures, a case that may be damaged, and the command itself.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub(crate) fn fixtures() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures"))
}

/// A page of the documentation.
pub(crate) fn page(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).join(name)
}

pub(crate) fn albatross(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_albatross"))
        .args(arguments)
        .output()
        .unwrap()
}

/// The F25-like case.
pub(crate) fn case() -> String {
    fixtures().join("f25-like/case.toml").display().to_string()
}

pub(crate) fn json(arguments: &[&str]) -> Value {
    let output = albatross(arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Standard error of a command that must fail.
pub(crate) fn failure(arguments: &[&str]) -> String {
    let output = albatross(arguments);
    assert_eq!(
        output.status.code(),
        Some(1),
        "{arguments:?} must fail: {}",
        String::from_utf8_lossy(&output.stdout)
    );
    assert!(output.stdout.is_empty(), "a failing command prints no result");
    String::from_utf8(output.stderr).unwrap()
}

/// A copy of the F25-like case that a test may change.
pub(crate) struct CaseCopy(tempfile::TempDir);

impl CaseCopy {
    pub(crate) fn new() -> Self {
        let copy = Self(tempfile::tempdir().unwrap());
        let from = fixtures().join("f25-like");
        for folder in ["", "avl_out", "airfoils", "reference"] {
            std::fs::create_dir_all(copy.at(folder)).unwrap();
            for entry in std::fs::read_dir(from.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path.is_file() {
                    std::fs::copy(&path, copy.at(folder).join(path.file_name().unwrap())).unwrap();
                }
            }
        }
        copy
    }

    pub(crate) fn directory(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Path of a file as an argument.
    pub(crate) fn arg(&self, name: &str) -> String {
        self.at(name).display().to_string()
    }

    pub(crate) fn read(&self, name: &str) -> String {
        String::from_utf8_lossy(&std::fs::read(self.at(name)).unwrap()).into_owned()
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.at(name), text).unwrap();
    }

    /// Replaces the first occurrence of `from`, which must be there.
    pub(crate) fn replace(&self, name: &str, from: &str, to: &str) {
        let text = self.read(name);
        assert!(text.contains(from), "{name} has no `{from}`");
        self.write(name, &text.replacen(from, to, 1));
    }

    /// Cuts the file just before `marker`, which must be there.
    pub(crate) fn cut_before(&self, name: &str, marker: &str) {
        let text = self.read(name);
        let end = text
            .find(marker)
            .unwrap_or_else(|| panic!("{name} has no `{marker}`"));
        self.write(name, &text[..end]);
    }

    /// Puts the fixture's own file back.
    pub(crate) fn restore(&self, name: &str) {
        std::fs::copy(fixtures().join("f25-like").join(name), self.at(name)).unwrap();
    }

    /// The text with this copy's directory written as `CASE/`.
    pub(crate) fn normalise(&self, text: &str) -> String {
        text.replace(&format!("{}/", self.0.path().display()), "CASE/")
    }
}
