//! Links and headings of Markdown pages, as far as the checks and the book need them.

use std::collections::{BTreeMap, BTreeSet};

/// A link within the documents.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Link {
    /// Line, from 1.
    pub(crate) line: usize,
    /// File, relative to the page; empty for a place on the page itself.
    pub(crate) file: String,
    /// Place in the file, without `#`; empty for its beginning.
    pub(crate) anchor: String,
}

/// All links of a page that lead to files or places on pages; code and other sites are passed over.
pub(crate) fn links(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (line, prose) in prose(text) {
        for rest in prose.split("](").skip(1) {
            let target = rest.split([')', ' ']).next().unwrap_or_default();
            if target.is_empty() || target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            found.push(Link {
                line,
                file: file.to_owned(),
                anchor: anchor.to_owned(),
            });
        }
    }
    found
}

/// Places that links can lead to: headings by the names that GitHub and mdBook give them, and `<a id="...">`.
pub(crate) fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    for line in outside_fences(text).map(|(_, line)| line) {
        if let Some(heading) = heading(line) {
            let name = slug(heading);
            let times = used.entry(name.clone()).or_insert(0);
            found.insert(match *times {
                0 => name,
                n => format!("{name}-{n}"),
            });
            *times += 1;
        }
        for rest in line.split("<a id=\"").skip(1) {
            found.extend(rest.split('"').next().map(str::to_owned));
        }
    }
    found
}

fn heading(line: &str) -> Option<&str> {
    let text = line.trim_start_matches('#');
    let level = line.len() - text.len();
    ((1..=6).contains(&level) && text.starts_with(' ')).then(|| text.trim())
}

/// Lower case, blanks as hyphens, punctuation gone.
fn slug(heading: &str) -> String {
    heading
        .chars()
        .filter_map(|c| match c {
            ' ' => Some('-'),
            '-' | '_' => Some(c),
            _ if c.is_alphanumeric() => Some(c),
            _ => None,
        })
        .flat_map(char::to_lowercase)
        .collect()
}

/// Lines with their numbers, without fenced blocks of code.
fn outside_fences(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fenced = false;
    text.lines().enumerate().filter_map(move |(number, line)| {
        let fence = line.trim_start().starts_with("```");
        let passed = fenced || fence;
        fenced ^= fence;
        (!passed).then_some((number + 1, line))
    })
}

/// Lines with their numbers, without code of either kind.
fn prose(text: &str) -> impl Iterator<Item = (usize, String)> {
    outside_fences(text).map(|(number, line)| {
        let parts = line.split('`').enumerate();
        (
            number,
            parts.filter(|(i, _)| i % 2 == 0).map(|(_, part)| part).collect(),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_outside_of_code_are_found() {
        let text = "[a](b.md#c) `[no](code)` [`x`](y.rs)\n```text\n[no](block)\n```\n[here](#d) [out](https://e.org)\n";
        let link = |line, file: &str, anchor: &str| Link {
            line,
            file: file.into(),
            anchor: anchor.into(),
        };
        assert_eq!(
            links(text),
            [link(1, "b.md", "c"), link(1, "y.rs", ""), link(5, "", "d")]
        );
    }

    #[test]
    fn headings_have_the_names_of_their_sites() {
        let text = "# 1. Limits, and why\n## `[[engine]]`\n<a id=\"own\"></a>\n## Sensors\n## Sensors\n```sh\n# no\n```\n#no\n";
        let found: Vec<String> = anchors(text).into_iter().collect();
        assert_eq!(
            found,
            ["1-limits-and-why", "engine", "own", "sensors", "sensors-1"]
        );
    }
}
