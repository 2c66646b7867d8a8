//! Tables as HTML.

use super::escape::text;
use crate::table::{Footnotes, Table};

/// Words longer than this (hashes, paths) may be broken anywhere in print.
const LONG_WORD: usize = 30;

/// The table in a frame that scrolls sideways where the screen is narrow, with its caption and footnotes.
pub(super) fn element(table: &Table) -> String {
    let right: Vec<bool> = (0..table.columns().len())
        .map(|j| table.is_right_aligned(j))
        .collect();
    let class = |j: usize| {
        if right.get(j).copied().unwrap_or(false) {
            " class=\"n\""
        } else {
            ""
        }
    };
    let footnotes = Footnotes::of(table);
    let mut rows = String::new();
    for row in table.rows() {
        let cells: String = row
            .iter()
            .zip(table.columns())
            .enumerate()
            .map(|(j, (cell, column))| {
                let mark = match footnotes.marks(cell) {
                    mark if mark.is_empty() => mark,
                    mark => format!("<sup>{}</sup>", text(mark.trim())),
                };
                let shown = cell.shown(column.format);
                let class = if shown.split_whitespace().any(|word| word.len() > LONG_WORD) {
                    " class=\"long\""
                } else {
                    class(j)
                };
                format!("<td{class}>{}{mark}</td>", text(&shown))
            })
            .collect();
        rows += &format!("<tr>{cells}</tr>\n");
    }
    let heads: String = table
        .columns()
        .iter()
        .enumerate()
        .map(|(j, column)| {
            let unit = match column.unit.as_str() {
                "" => String::new(),
                unit => format!("<br><span class=\"unit\">{}</span>", text(unit)),
            };
            format!("<th scope=\"col\"{}>{}{unit}</th>", class(j), text(&column.name))
        })
        .collect();
    let title = match table.title.as_str() {
        "" => String::new(),
        title => format!("<caption>{}</caption>\n", text(title)),
    };
    let mut out = format!(
        "<div class=\"wide\" tabindex=\"0\">\n<table>\n{title}<thead>\n{}<tr>{heads}</tr>\n</thead>\n<tbody>\n{rows}</tbody>\n\
         </table>\n</div>\n",
        groups(table)
    );
    if !table.caption.is_empty() {
        out += &format!("<p class=\"note\">{}</p>\n", text(&table.caption));
    }
    for (mark, note) in footnotes.marked() {
        out += &format!("<p class=\"note\"><sup>({mark})</sup> {}</p>\n", text(note));
    }
    out
}

/// A row of headings that neighbouring columns share; empty if there are none.
fn groups(table: &Table) -> String {
    let names: Vec<&str> = table.columns().iter().map(|c| c.group.as_str()).collect();
    if names.iter().all(|name| name.is_empty()) {
        return String::new();
    }
    let cells: String = names
        .chunk_by(|a, b| a == b)
        .map(|run| match run {
            [name, ..] if !name.is_empty() => {
                format!(
                    "<th scope=\"colgroup\" colspan=\"{}\" class=\"g\">{}</th>",
                    run.len(),
                    text(name)
                )
            }
            _ => format!("<td colspan=\"{}\"></td>", run.len()),
        })
        .collect();
    format!("<tr>{cells}</tr>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cell, Column, Format};

    #[test]
    fn units_groups_and_notes_are_shown() {
        let mut table = Table::new(
            "T <1>",
            [
                Column::text("mode"),
                Column::new("frequency", "rad/s", Format::Fixed(1)).in_group("rigid"),
                Column::new("damping", "-", Format::Fixed(1)).in_group("rigid"),
            ],
        );
        table
            .push([Cell::from("a & b"), 1.25.into(), Cell::missing("not followed")])
            .unwrap();
        let html = element(&table);
        for part in [
            "<caption>T &lt;1&gt;</caption>",
            "<th scope=\"colgroup\" colspan=\"2\" class=\"g\">rigid</th>",
            "<th scope=\"col\" class=\"n\">frequency<br><span class=\"unit\">rad/s</span></th>",
            "<td>a &amp; b</td><td class=\"n\">1.2</td><td class=\"n\">–<sup>(a)</sup></td>",
            "<sup>(a)</sup> not followed",
        ] {
            assert!(html.contains(part), "{part} in {html}");
        }
    }
}
