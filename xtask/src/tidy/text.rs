//! Text: blanks, line ends, paths of one machine, links.

use crate::markdown;
use std::path::Path;

/// Beginnings of paths that exist on one machine only. Written in pieces, so that this file does not hold them.
const MACHINE_PATHS: [&str; 6] = [
    concat!("/", "work/"),
    concat!("/", "home/"),
    concat!("/", "root/"),
    concat!("/", "Users/"),
    concat!("/", "tmp/"),
    concat!("C:", "\\"),
];

/// Checks one file; `path` is relative to `root`.
pub(super) fn check(root: &Path, path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    // Lists of dependencies and results are written by programs.
    let written = path.ends_with(".lock") || path.ends_with(".svg") || path.ends_with(".csv");
    for (number, line) in text.lines().enumerate() {
        let mut report = |what: String| found.push(format!("{path}:{}: {what}", number + 1));
        if line.contains('\t') && !written {
            report("holds a tab".into());
        }
        if line.ends_with([' ', '\r']) {
            report("ends in a blank or carriage return".into());
        }
        for machine in MACHINE_PATHS {
            if line.contains(machine) {
                report(format!("names a path of one machine ({machine})"));
            }
        }
    }
    if path.ends_with(".md") {
        found.extend(dead_links(root, path, text));
    }
    if !text.is_empty() && (!text.ends_with('\n') || text.ends_with("\n\n")) {
        found.push(format!("{path}: does not end in one line feed"));
    }
    found
}

/// Links of a page to files and places that are not there.
fn dead_links(root: &Path, path: &str, text: &str) -> Vec<String> {
    let page = root.join(path);
    let directory = page.parent().unwrap_or(root);
    let dead = |link: &markdown::Link| {
        let target = if link.file.is_empty() {
            page.clone()
        } else {
            directory.join(&link.file)
        };
        if !link.file.is_empty() && !target.exists() {
            return Some(format!("links to {}, which is not there", link.file));
        }
        if link.anchor.is_empty() || target.extension().is_none_or(|e| e != "md") {
            return None;
        }
        let there = if link.file.is_empty() {
            markdown::anchors(text)
        } else {
            markdown::anchors(&std::fs::read_to_string(&target).ok()?)
        };
        (!there.contains(&link.anchor)).then(|| {
            format!(
                "links to {}#{}, which has no such heading",
                link.file, link.anchor
            )
        })
    };
    let found = markdown::links(text).into_iter();
    found
        .filter_map(|link| Some(format!("{path}:{}: {}", link.line, dead(&link)?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blemishes_are_found_with_their_line() {
        let root = tempfile::tempdir().unwrap();
        let text = format!("fine\na\tb\nblank \n{}x\nend", MACHINE_PATHS[0]);
        let found = check(root.path(), "a.rs", &text);
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(
            found[0].starts_with("a.rs:2:") && found[1].starts_with("a.rs:3:"),
            "{found:?}"
        );
        assert!(check(root.path(), "a.rs", "fine\n").is_empty());
    }

    #[test]
    fn links_must_lead_somewhere() {
        let root = tempfile::tempdir().unwrap();
        std::fs::write(root.path().join("b.md"), "# Part\n").unwrap();
        let text = "# Here\n[b](b.md#part) [c](c.md) ![d](https://example.org/d.svg) [e](#here) [f](b.md#g) [h](#i)\n";
        assert_eq!(
            check(root.path(), "a.md", text),
            [
                "a.md:2: links to c.md, which is not there",
                "a.md:2: links to b.md#g, which has no such heading",
                "a.md:2: links to #i, which has no such heading",
            ]
        );
    }
}
