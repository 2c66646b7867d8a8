//! `cargo xtask tidy`: the invariants of docs/ARCHITECTURE.md that the compiler does not enforce.
//!
//! - **Pipeline.** A crate depends only on crates before it in [`PIPELINE`]; readers and the report crate on none.
//! - **Purity.** Crates of physics and the report crate touch no files, clocks, streams or environment.
//! - **Manifests.** Every crate has a description and inherits the workspace's lints, which ask for documentation.
//! - **Size.** Source files stay below [`LONGEST`] lines.
//! - **Text.** No tabs, carriage returns, trailing blanks or paths of one machine; files end in one line feed; links
//!   between documents lead to files and headings that are there.
//! - **Equations.** Each `THEORY (12)` in a source is a numbered equation of `docs/THEORY.md`.

mod equations;
mod manifests;
mod sources;
mod text;

use crate::ci::TEST;
use crate::error::Error;
use crate::workspace;
use std::path::{Path, PathBuf};

/// Crates in pipeline order: directory, package, and what it is.
pub(crate) const PIPELINE: [(&str, &str, Kind); 15] = [
    ("crates/nastran", "albatross-nastran", Kind::Reader),
    ("crates/avl", "albatross-avl", Kind::Reader),
    ("crates/numerics", "albatross-numerics", Kind::Physics),
    ("crates/lti", "albatross-lti", Kind::Physics),
    ("crates/sysid", "albatross-sysid", Kind::Physics),
    ("crates/fem", "albatross-fem", Kind::Physics),
    ("crates/vlm", "albatross-vlm", Kind::Physics),
    ("crates/modal", "albatross-modal", Kind::Physics),
    ("crates/strip", "albatross-strip", Kind::Physics),
    ("crates/flight", "albatross-flight", Kind::Physics),
    ("crates/export", "albatross-export", Kind::Physics),
    ("crates/report", "albatross-report", Kind::Report),
    ("crates/albatross", "albatross", Kind::Facade),
    ("crates/cli", "albatross-cli", Kind::Tool),
    ("xtask", "xtask", Kind::Tool),
];

/// What a crate is for, which decides what it may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Reads and writes files to plain structs; no physics.
    Reader,
    /// Computes; no files, streams, clocks or environment.
    Physics,
    /// Tables and plots as text; computes nothing, writes nothing.
    Report,
    /// Joins the stages.
    Facade,
    /// Programs.
    Tool,
}

/// Lines that a source file must stay below.
pub(crate) const LONGEST: usize = 700;

/// Runs all checks and prints what they find.
pub(crate) fn run() -> Result<(), Error> {
    let findings = findings(&workspace::root())?;
    for finding in &findings {
        println!("{finding}");
    }
    match findings.len() {
        0 => {
            println!("tidy");
            Ok(())
        }
        n => Err(Error::Failed(format!("{n} findings"))),
    }
}

/// All findings, a line each.
fn findings(root: &Path) -> Result<Vec<String>, Error> {
    let mut found = manifests::check(root)?;
    let theory = workspace::read(&root.join(equations::PAGE))?;
    let numbered = equations::numbered(&theory);
    found.extend(equations::check_page(&theory, &numbered));
    for (directory, _, kind) in PIPELINE {
        for file in files(&root.join(directory), &["rs"])? {
            let (path, source) = (relative(root, &file), workspace::read(&file)?);
            found.extend(sources::check(&path, &source, kind));
            found.extend(equations::check_source(&path, &source, &numbered));
        }
    }
    for file in own_text(root)? {
        found.extend(text::check(
            root,
            &relative(root, &file),
            &workspace::read(&file)?,
        ));
    }
    found.extend(documents(root)?);
    Ok(found)
}

/// The documents say what the checks assume.
fn documents(root: &Path) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    let mut demand = |file: &str, wanted: &[String]| -> Result<(), Error> {
        let path = root.join(file);
        if !path.is_file() {
            found.push(format!("{file}: is missing"));
            return Ok(());
        }
        let text = workspace::read(&path)?;
        let absent = wanted.iter().filter(|words| !text.contains(words.as_str()));
        found.extend(absent.map(|words| format!("{file}: does not mention `{words}`")));
        Ok(())
    };
    demand("README.md", &[format!("cargo {}", TEST.join(" "))])?;
    let names: Vec<String> = PIPELINE
        .iter()
        .filter_map(|(directory, ..)| Some(directory.rsplit('/').next()?.to_owned()))
        .collect();
    demand("docs/ARCHITECTURE.md", &names)?;
    Ok(found)
}

/// Text that this project wrote: everything but what is built, and but fixtures, which are as their programs wrote
/// them.
fn own_text(root: &Path) -> Result<Vec<PathBuf>, Error> {
    let kinds = ["rs", "toml", "md", "json", "csv", "svg", "yml", "yaml", "lock"];
    let mut own = files(&root.join("fixtures/paper"), &kinds)?;
    for directory in ["crates", "xtask", "docs", "examples", ".cargo"] {
        own.extend(files(&root.join(directory), &kinds)?);
    }
    for entry in std::fs::read_dir(root).map_err(Error::file(root))? {
        let path = entry.map_err(Error::file(root))?.path();
        if path.is_file() && has_extension(&path, &kinds) {
            own.push(path);
        }
    }
    own.sort();
    Ok(own)
}

/// Files below a directory with one of the extensions, in order; none if there is no such directory.
fn files(directory: &Path, extensions: &[&str]) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    let mut open = vec![directory.to_owned()];
    while let Some(directory) = open.pop() {
        if !directory.is_dir() {
            continue;
        }
        for entry in std::fs::read_dir(&directory).map_err(Error::file(&directory))? {
            let path = entry.map_err(Error::file(&directory))?.path();
            let built = path
                .file_name()
                .is_some_and(|name| name == "target" || name == "out");
            if path.is_dir() && !built {
                open.push(path);
            } else if has_extension(&path, extensions) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension()
        .and_then(|e| e.to_str())
        .is_some_and(|e| extensions.contains(&e))
}

/// Path from the root with forward slashes.
fn relative(root: &Path, path: &Path) -> String {
    let parts = path.strip_prefix(root).unwrap_or(path).components();
    let parts: Vec<_> = parts.map(|part| part.as_os_str().to_string_lossy()).collect();
    parts.join("/")
}
