//! `cargo xtask book`: the documents and examples as a book.
//!
//! The pages are written to be read as they are, where they are: `docs/`, `examples/` and the root link to each other and
//! to sources and fixtures. mdBook takes one folder. So the chapters that `docs/SUMMARY.md` names are gathered in
//! `target/book-src` at the same places relative to each other, with the pictures and files that they link to, and links
//! need no rewriting. mdBook then makes `target/book` of them by `book.toml`.

use crate::error::Error;
use crate::{markdown, workspace};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

/// The table of contents.
const SUMMARY: &str = "docs/SUMMARY.md";
/// Where the chapters are gathered, as `book.toml` says.
const GATHERED: &str = "target/book-src";

/// Gathers the chapters and builds the book.
pub(crate) fn run() -> Result<(), Error> {
    let root = workspace::root();
    let chapters = gather(&root, &root.join(GATHERED))?;
    println!("{} chapters in {GATHERED}", chapters.len());
    let outcome = Command::new("mdbook").arg("build").current_dir(&root).status();
    let failed = |outcome: String| Error::Command {
        command: "mdbook build".into(),
        outcome,
    };
    match outcome {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(failed(format!("ended with {status}"))),
        Err(e) => Err(failed(format!(
            "cannot be started: {e}; install mdBook (`cargo install mdbook --locked`)"
        ))),
    }
}

/// Copies the chapters and what they link to, and writes the table of contents for mdBook.
fn gather(root: &Path, to: &Path) -> Result<BTreeSet<String>, Error> {
    if to.is_dir() {
        std::fs::remove_dir_all(to).map_err(Error::file(to))?;
    }
    let summary = workspace::read(&root.join(SUMMARY))?;
    let chapters: BTreeSet<String> = markdown::links(&summary)
        .iter()
        .filter_map(|link| joined(SUMMARY, &link.file))
        .collect();
    let mut linked = BTreeSet::new();
    for chapter in &chapters {
        let text = workspace::read(&root.join(chapter))?;
        for link in markdown::links(&text).iter().filter(|link| !link.file.is_empty()) {
            let Some(target) = joined(chapter, &link.file) else {
                return Err(refused(chapter, link, "leaves the folder of the project"));
            };
            // mdBook takes every link to a page for one to a chapter.
            if target.ends_with(".md") && !chapters.contains(&target) {
                return Err(refused(chapter, link, &format!("is no chapter of {SUMMARY}")));
            }
            if root.join(&target).is_dir() {
                return Err(refused(chapter, link, "is a folder; link to a file in it"));
            }
            linked.insert(target);
        }
    }
    for file in chapters.union(&linked) {
        copy(&root.join(file), &to.join(file))?;
    }
    workspace::write_whole(&to.join("SUMMARY.md"), from_root(&summary))?;
    Ok(chapters)
}

fn refused(chapter: &str, link: &markdown::Link, why: &str) -> Error {
    Error::Failed(format!(
        "{chapter}:{}: the link to {} {why}",
        link.line, link.file
    ))
}

/// The table of contents with paths from the root.
fn from_root(summary: &str) -> String {
    let mut out = String::new();
    for line in summary.lines() {
        let rewritten = line
            .split_once("](")
            .and_then(|(title, rest)| Some((title, joined(SUMMARY, rest.strip_suffix(')')?)?)));
        match rewritten {
            Some((title, path)) => out.push_str(&format!("{title}]({path})")),
            None => out.push_str(line),
        }
        out.push('\n');
    }
    out
}

/// A path relative to a page as one from the root; none if it leaves it.
fn joined(page: &str, relative: &str) -> Option<String> {
    let directory = Path::new(page).parent().unwrap_or(Path::new(""));
    let mut parts: Vec<String> = Vec::new();
    for part in directory.join(relative).components() {
        match part {
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            Component::CurDir => {}
            Component::ParentDir => {
                parts.pop()?;
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(parts.join("/"))
}

fn copy(from: &Path, to: &Path) -> Result<(), Error> {
    let directory = to.parent().map_or_else(PathBuf::new, Path::to_owned);
    std::fs::create_dir_all(&directory).map_err(Error::file(&directory))?;
    std::fs::copy(from, to).map(|_| ()).map_err(Error::file(from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_taken_from_the_root() {
        assert_eq!(joined("docs/A.md", "B.md").as_deref(), Some("docs/B.md"));
        assert_eq!(
            joined("docs/A.md", "../examples/x/README.md").as_deref(),
            Some("examples/x/README.md")
        );
        assert_eq!(joined("docs/A.md", "../../x"), None);
        let summary = "# Summary\n\n- [A](A.md)\n  - [B](../b/B.md)\n";
        assert_eq!(
            from_root(summary),
            "# Summary\n\n- [A](docs/A.md)\n  - [B](b/B.md)\n"
        );
    }

    /// Every page that a chapter links to is a chapter, every other file is copied.
    #[test]
    fn val_the_shipped_book_is_complete() {
        let to = tempfile::tempdir().unwrap();
        let chapters = gather(&workspace::root(), to.path()).unwrap();
        assert!(chapters.contains("docs/THEORY.md") && chapters.contains("examples/README.md"));
        for chapter in &chapters {
            let text = workspace::read(&to.path().join(chapter)).unwrap();
            for link in markdown::links(&text) {
                let file = joined(chapter, &link.file).unwrap();
                assert!(
                    link.file.is_empty() || to.path().join(&file).is_file(),
                    "{chapter}: {file}"
                );
            }
        }
    }

    #[test]
    fn a_page_outside_of_the_contents_is_refused() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = root.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        write("docs/SUMMARY.md", "- [A](A.md)\n");
        write("docs/A.md", "[b](B.md)\n");
        write("docs/B.md", "b\n");
        let error = gather(root.path(), &root.path().join("out")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "docs/A.md:1: the link to B.md is no chapter of docs/SUMMARY.md"
        );
    }
}
