//! The line of a file that a message names, with a mark under what is meant.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::ops::Range;
use std::path::Path;

/// Longest line that is shown.
const LONGEST: usize = 400;

/// The excerpt for a message that begins with `file:line: ` or `file:line:column: `; none if the file cannot be read.
pub(crate) fn of_message(message: &str, colour: bool) -> Option<String> {
    let (place, rest) = message.split_once(": ")?;
    of_place(place, rest, colour)
}

/// The excerpt for `file:line` or `file:line:column`; `what` may quote what stands there.
pub(crate) fn of_place(place: &str, what: &str, colour: bool) -> Option<String> {
    let (file, line, column) = split(place)?;
    let text = std::fs::read(Path::new(file)).ok()?;
    let text = String::from_utf8_lossy(&text);
    let source = text.lines().nth(line.checked_sub(1)?)?;
    if source.trim().is_empty() || source.len() > LONGEST {
        return None;
    }
    let span = quoted_span(source, what)
        .or_else(|| column.and_then(|c| word_at(source, c)))
        .or_else(|| last_number(source, what))
        .unwrap_or_else(|| trimmed(source));
    let snippet = Snippet::source(source)
        .line_start(line)
        .annotation(AnnotationKind::Primary.span(span));
    let renderer = if colour {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let group = Level::ERROR.no_name().primary_title("").element(snippet);
    let drawn = renderer.render(&[group]).to_string();
    // The title is printed by the caller, as the one line that scripts read.
    let kept: Vec<&str> = drawn.lines().skip(1).filter(|l| !l.trim().is_empty()).collect();
    Some(kept.join("\n"))
}

/// File, line and column of a place.
fn split(place: &str) -> Option<(&str, usize, Option<usize>)> {
    let (head, last) = place.rsplit_once(':')?;
    let last: usize = last.parse().ok()?;
    match head.rsplit_once(':') {
        Some((file, line)) if line.parse::<usize>().is_ok() => Some((file, line.parse().ok()?, Some(last))),
        _ => Some((head, last, None)),
    }
}

/// Where the longest text in quotes of the message stands in the line.
fn quoted_span(source: &str, what: &str) -> Option<Range<usize>> {
    ['`', '"']
        .iter()
        .flat_map(|q| what.split(*q).skip(1).step_by(2))
        .filter(|text| !text.trim().is_empty())
        .filter_map(|text| source.find(text).map(|at| at..at + text.len()))
        .max_by_key(Range::len)
}

/// Where the last whole number of the message, such as that of a grid, stands in the line as a word.
fn last_number(source: &str, what: &str) -> Option<Range<usize>> {
    let is_number = |word: &&str| word.len() > 1 && word.bytes().all(|b| b.is_ascii_digit());
    let words = |text: &'_ str| -> Vec<String> {
        text.split(|c: char| !c.is_ascii_alphanumeric())
            .filter(is_number)
            .map(str::to_owned)
            .collect()
    };
    let number = words(what).pop()?;
    source
        .rmatch_indices(number.as_str())
        .map(|(at, _)| at..at + number.len())
        .find(|span| {
            let beside = |c: Option<char>| c.is_none_or(|c| !c.is_ascii_alphanumeric());
            beside(source.get(..span.start).and_then(|t| t.chars().next_back()))
                && beside(source.get(span.end..).and_then(|t| t.chars().next()))
        })
}

/// The word that holds a column, from 1.
fn word_at(source: &str, column: usize) -> Option<Range<usize>> {
    let (at, _) = source.char_indices().nth(column.checked_sub(1)?)?;
    let end = source
        .get(at..)?
        .find(char::is_whitespace)
        .map_or(source.trim_end().len(), |n| at + n);
    (end > at).then_some(at..end)
}

fn trimmed(source: &str) -> Range<usize> {
    source.len() - source.trim_start().len()..source.trim_end().len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_places() {
        assert_eq!(split("a/b.avl:4:1"), Some(("a/b.avl", 4, Some(1))));
        assert_eq!(split("a/b.bdf:22"), Some(("a/b.bdf", 22, None)));
        assert_eq!(split("a/b.bdf"), None);
    }

    #[test]
    fn val_what_is_marked() {
        let bar = "CBAR       11003   11003    1002    1003      0.";
        let span = last_number(bar, "CBAR 11003: GB is grid 1003, which is not in the deck");
        assert_eq!(span, Some(36..40));
        let line = "    CLa =   7.29x941    CLb =   0.000000";
        let span = quoted_span(line, "field `CLa`: `7.29x941` is not a number");
        assert_eq!(span, Some(12..20));
    }

    #[test]
    fn val_line_and_mark() {
        let directory = tempfile::tempdir().unwrap_or_else(|e| std::panic::panic_any(e));
        let file = directory.path().join("a.toml");
        let _ = std::fs::write(&file, "x = 1\nmode = 20\n");
        let message = format!("{}:2: unknown field `mode`; expected `modes`", file.display());
        let excerpt = of_message(&message, false).unwrap_or_default();
        assert!(excerpt.contains("2 | mode = 20"), "{excerpt}");
        assert!(excerpt.contains("| ^^^^"), "{excerpt}");
    }
}
