//! Markdown: pipe tables that line up as plain text.

use super::{Footnotes, Table, body, display_width, pad};

impl Table {
    /// The table as GitHub-flavoured Markdown: title, aligned pipes, caption, footnotes.
    pub fn to_markdown(&self) -> String {
        let footnotes = Footnotes::of(self);
        let header: Vec<String> = self
            .columns
            .iter()
            .map(|column| escape(&column.heading()))
            .collect();
        let rows = body(self, &footnotes, escape);
        let right: Vec<bool> = (0..header.len()).map(|j| self.is_right_aligned(j)).collect();
        let widths: Vec<usize> = header
            .iter()
            .enumerate()
            .map(|(j, name)| {
                let cells = rows.iter().filter_map(|row| row.get(j));
                // Three is the narrowest rule that every Markdown reader takes.
                cells
                    .chain([name])
                    .map(|text| display_width(text))
                    .max()
                    .unwrap_or(0)
                    .max(3)
            })
            .collect();

        let mut out = String::new();
        if !self.title.is_empty() {
            out += &format!("**{}**\n\n", escape(&self.title));
        }
        let line = |cells: &[String]| {
            let padded: Vec<String> = cells
                .iter()
                .zip(&widths)
                .zip(&right)
                .map(|((c, w), r)| pad(c, *w, *r))
                .collect();
            format!("| {} |\n", padded.join(" | "))
        };
        if !header.is_empty() {
            out += &line(&header);
            let rules: Vec<String> = widths
                .iter()
                .zip(&right)
                .map(|(w, r)| {
                    if *r {
                        format!("{}:", "-".repeat(w - 1))
                    } else {
                        "-".repeat(*w)
                    }
                })
                .collect();
            out += &format!("| {} |\n", rules.join(" | "));
            for row in &rows {
                out += &line(row);
            }
        }
        if !self.caption.is_empty() {
            out += &format!("\n{}\n", escape(&self.caption));
        }
        if !footnotes.notes.is_empty() {
            out.push('\n');
            for (mark, note) in footnotes.marked() {
                out += &format!("- ({mark}) {}\n", escape(note));
            }
        }
        out
    }
}

/// Makes text literal in Markdown: nothing in it starts emphasis, a cell, a tag or a formula.
///
/// An underscore inside a word is literal in GitHub-flavoured Markdown and stays readable (`n_z`).
pub(crate) fn escape(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let in_word = |i: Option<usize>| {
        i.and_then(|i| characters.get(i))
            .is_some_and(|c| c.is_alphanumeric())
    };
    let mut out = String::with_capacity(text.len());
    for (i, c) in characters.iter().enumerate() {
        match c {
            '\\' | '|' | '*' | '`' | '~' | '$' => {
                out.push('\\');
                out.push(*c);
            }
            '_' if !(in_word(i.checked_sub(1)) && in_word(Some(i + 1))) => out.push_str("\\_"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '\n' => out.push(' '),
            c if c.is_control() => {}
            c => out.push(*c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Column};
    use super::*;
    use crate::number::Format;

    #[test]
    fn golden_table_with_groups_flags_and_gaps() {
        let mut table = Table::new(
            "Table 3: first peak",
            [
                Column::text("model"),
                Column::new("n_z", "–", Format::Fixed(2)).in_group("first peak"),
                Column::new("q", "°/s", Format::Fixed(2)).in_group("first peak"),
            ],
        )
        .with_caption("Peaks after the 0.5 Hz doublet.");
        table.push(["CFD".into(), 0.73.into(), (-1.51).into()]).unwrap();
        table
            .push([
                "rel. diff. [%]".into(),
                Cell::from(3.02).flagged("recomputed: 2.74"),
                Cell::missing("not printed"),
            ])
            .unwrap();
        table
            .push(["bad | pipe".into(), f64::NAN.into(), Cell::EMPTY])
            .unwrap();
        let expected = "\
**Table 3: first peak**

| model          | first peak: n_z [–] | first peak: q [°/s] |
| -------------- | ------------------: | ------------------: |
| CFD            |            0.73     |           -1.51     |
| rel. diff. [%] |            3.02 (a) |               – (b) |
| bad \\| pipe    |             NaN     |               –     |

Peaks after the 0.5 Hz doublet.

- (a) recomputed: 2.74
- (b) not printed
";
        assert_eq!(table.to_markdown(), expected);
    }

    #[test]
    fn words_stay_words() {
        assert_eq!(
            escape("a*b|c_d _e_ <i> 5 & $x$"),
            "a\\*b\\|c_d \\_e\\_ &lt;i&gt; 5 &amp; \\$x\\$"
        );
        assert_eq!(escape("two\nlines"), "two lines");
    }

    #[test]
    fn a_table_without_rows_still_has_its_header() {
        let table = Table::new("", [Column::text("a")]);
        assert_eq!(table.to_markdown(), "| a   |\n| --- |\n");
        assert_eq!(Table::new("empty", []).to_markdown(), "**empty**\n\n");
    }
}
