//! Equations: what sources cite of `docs/THEORY.md` is there, under that number.

use std::collections::BTreeMap;

/// The page of the equations.
pub(super) const PAGE: &str = "docs/THEORY.md";
/// Sources cite an equation as this word and its number in brackets, several with commas between.
const WORD: &str = concat!("THEO", "RY (");

/// Numbers at the ends of lines in the page's blocks, with the lines.
pub(super) fn numbered(page: &str) -> BTreeMap<String, Vec<usize>> {
    let mut found: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let mut fenced = false;
    for (number, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            // Two blanks set the number apart from the equation, and from what may follow it.
            let last = line.rfind("  (").and_then(|at| bracketed(&line[at + 2..]));
            if let Some((equation, _)) = last.filter(|(_, rest)| rest.is_empty() || rest.starts_with("  ")) {
                found.entry(equation.to_owned()).or_default().push(number + 1);
            }
        }
    }
    found
}

/// `12` of `(12)`, and what stands behind it.
fn bracketed(text: &str) -> Option<(&str, &str)> {
    let (number, rest) = text.strip_prefix('(')?.split_once(')')?;
    is_number(number).then_some((number, rest))
}

/// One to three digits, perhaps a letter: years have four.
fn is_number(text: &str) -> bool {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_lowercase());
    (1..=3).contains(&digits.len())
        && digits.bytes().all(|b| b.is_ascii_digit())
        && text.len() - digits.len() <= 1
}

/// No number is given twice, and the page's own references lead somewhere.
pub(super) fn check_page(page: &str, numbered: &BTreeMap<String, Vec<usize>>) -> Vec<String> {
    let mut found: Vec<String> = numbered
        .iter()
        .filter(|(_, lines)| lines.len() > 1)
        .map(|(number, lines)| format!("{PAGE}: equation ({number}) stands on lines {lines:?}"))
        .collect();
    for (line, text) in page.lines().enumerate() {
        let mut rest = text;
        while let Some(at) = rest.find('(') {
            let apart = rest[..at].chars().last().is_none_or(|c| c.is_whitespace());
            rest = &rest[at..];
            if let Some((number, _)) = bracketed(rest).filter(|(n, _)| apart && !numbered.contains_key(*n)) {
                found.push(format!("{PAGE}:{}: equation ({number}) is not there", line + 1));
            }
            rest = &rest[1..];
        }
    }
    found
}

/// Citations of a source that lead nowhere.
pub(super) fn check_source(path: &str, text: &str, numbered: &BTreeMap<String, Vec<usize>>) -> Vec<String> {
    let mut found = Vec::new();
    for (line, text) in text.lines().enumerate() {
        for mut rest in text.split(WORD).skip(1) {
            loop {
                let (number, behind) = rest.split_once(')').unwrap_or((rest, ""));
                if !numbered.contains_key(number) {
                    found.push(format!("{path}:{}: {PAGE} has no equation ({number})", line + 1));
                }
                match behind.strip_prefix(", (") {
                    Some(next) => rest = next,
                    None => break,
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const THEORY: &str =
        "# T\n(1940) and (1) but f(7)\n```text\na = b        (1)\nc = f(3)\nd    (9a)  Eq. 2\n```\n";

    #[test]
    fn numbers_stand_at_the_ends_of_lines_in_blocks() {
        let numbered = numbered(THEORY);
        assert_eq!(numbered.keys().collect::<Vec<_>>(), ["1", "9a"]);
        assert!(check_page(THEORY, &numbered).is_empty());
        let page = "from (4)\n```text\na  (1)\nb  (1)\n```\n";
        assert_eq!(
            check_page(page, &super::numbered(page)),
            [
                "docs/THEORY.md: equation (1) stands on lines [3, 4]",
                "docs/THEORY.md:1: equation (4) is not there"
            ]
        );
    }

    #[test]
    fn citations_lead_to_equations() {
        let source = format!("//! {WORD}1), (9a)\n//! {WORD}1), (8) and {WORD}12)\n");
        assert_eq!(
            check_source("a.rs", &source, &numbered(THEORY)),
            [
                "a.rs:2: docs/THEORY.md has no equation (8)",
                "a.rs:2: docs/THEORY.md has no equation (12)"
            ]
        );
    }
}
