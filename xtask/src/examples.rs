//! `cargo xtask examples`: the commands of `examples/*/README.md` are run ([`crate::console`]). `--check` compares words
//! and numbers, these to one unit of the last place, of pages and of what pictures say in words.

use crate::console::Shell;
use crate::error::Error;
use crate::validate::differences_of_pages;
use crate::workspace;
use std::path::{Path, PathBuf};

/// Options of `cargo xtask examples`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Write nothing; compare what the commands print with what is there
    #[arg(long)]
    check: bool,
    /// Only the examples whose folder begins so
    #[arg(long, value_name = "START")]
    only: Option<String>,
}

impl Options {
    /// `--check` of all.
    pub(crate) fn check() -> Self {
        Self {
            check: true,
            only: None,
        }
    }
}

/// Runs the examples.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    let program = build(&root)?;
    let mut differences = Vec::new();
    let mut pages: Vec<PathBuf> = folders(&root.join("examples"))?
        .into_iter()
        .map(|folder| folder.join("README.md"))
        .collect();
    pages.retain(|page| match &options.only {
        Some(start) => page
            .parent()
            .and_then(Path::file_name)
            .is_some_and(|name| name.to_string_lossy().starts_with(start.as_str())),
        None => true,
    });
    for page in &pages {
        let text = workspace::read(page)?;
        // What an earlier run has left would be in the way of commands that refuse to overwrite.
        let left = page.with_file_name("out");
        if left.is_dir() {
            std::fs::remove_dir_all(&left).map_err(Error::file(&left))?;
        }
        let mut shell = Shell::beside(page, program.clone(), options.check);
        let fresh = shell.rewritten(&text)?;
        if options.check {
            let found = differences_of_pages(&fresh, &text);
            differences.extend(found.into_iter().map(|d| format!("{}: {d}", page.display())));
            differences.append(&mut shell.differences);
        } else {
            workspace::write_whole(page, &fresh)?;
        }
    }
    differences.iter().for_each(|d| println!("{d}"));
    if differences.is_empty() {
        println!("{} examples run", pages.len());
        return Ok(());
    }
    Err(Error::Failed(format!(
        "{} differences in the examples; if they are meant, run `cargo xtask examples` and commit",
        differences.len()
    )))
}

/// The program as tests build it.
fn build(root: &Path) -> Result<PathBuf, Error> {
    crate::ci::cargo(&["build", "--quiet", "-p", "albatross-cli"], &[])?;
    Ok(workspace::target(root)
        .join("debug")
        .join(format!("albatross{}", std::env::consts::EXE_SUFFIX)))
}

/// Numbered folders in order.
fn folders(examples: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(examples).map_err(Error::file(examples))? {
        let path = entry.map_err(Error::file(examples))?.path();
        if path.join("README.md").is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}
