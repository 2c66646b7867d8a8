//! Plain text for terminals.

use super::{Column, Footnotes, Table, body, display_width, pad};

/// Spaces between columns.
const GAP: usize = 2;

impl Table {
    /// The table as aligned text: title, header lines for groups, names and units, a rule, rows, footnotes.
    pub fn to_text(&self) -> String {
        let footnotes = Footnotes::of(self);
        let rows = body(self, &footnotes, |text| text.replace(char::is_control, " "));
        let right: Vec<bool> = (0..self.columns.len())
            .map(|j| self.is_right_aligned(j))
            .collect();
        let mut widths: Vec<usize> = self
            .columns
            .iter()
            .enumerate()
            .map(|(j, column)| {
                let cells = rows.iter().filter_map(|row| row.get(j).map(String::as_str));
                let header = [column.name.as_str(), column.unit.as_str()];
                cells.chain(header).map(display_width).max().unwrap_or(0)
            })
            .collect();
        let groups = groups(&self.columns);
        for group in &groups {
            widen(&mut widths, group);
        }

        let mut out = String::new();
        let mut put = |line: String| {
            out += line.trim_end();
            out.push('\n');
        };
        if !self.title.is_empty() {
            put(self.title.clone());
        }
        if groups.iter().any(|group| !group.name.is_empty()) {
            let titles: Vec<String> = groups.iter().map(|group| group.ruled(&widths)).collect();
            put(titles.join(&" ".repeat(GAP)));
        }
        let line = |cells: &mut dyn Iterator<Item = &str>| -> String {
            let padded: Vec<String> = cells
                .zip(&widths)
                .zip(&right)
                .map(|((c, w), r)| pad(c, *w, *r))
                .collect();
            padded.join(&" ".repeat(GAP))
        };
        if !self.columns.is_empty() {
            put(line(&mut self.columns.iter().map(|column| column.name.as_str())));
        }
        if self.columns.iter().any(|column| !column.unit.is_empty()) {
            put(line(&mut self.columns.iter().map(|column| column.unit.as_str())));
        }
        put("─".repeat(span(&widths)));
        for row in &rows {
            put(line(&mut row.iter().map(String::as_str)));
        }
        if !self.caption.is_empty() {
            put(self.caption.clone());
        }
        for (mark, note) in footnotes.marked() {
            put(format!("({mark}) {note}"));
        }
        out
    }
}

/// Width of adjacent columns with the gaps between them.
fn span(widths: &[usize]) -> usize {
    widths.iter().sum::<usize>() + GAP * widths.len().saturating_sub(1)
}

/// Neighbouring columns under one heading.
struct Group<'a> {
    name: &'a str,
    first: usize,
    count: usize,
}

impl Group<'_> {
    fn widths<'w>(&self, widths: &'w [usize]) -> &'w [usize] {
        widths
            .get(self.first..self.first + self.count)
            .unwrap_or_default()
    }

    /// The heading centred between rules over its columns: `── first peak ──`.
    fn ruled(&self, widths: &[usize]) -> String {
        let width = span(self.widths(widths));
        if self.name.is_empty() {
            return " ".repeat(width);
        }
        let room = width.saturating_sub(display_width(self.name));
        if room < 4 {
            return pad(self.name, width, false);
        }
        let left = room / 2 - 1;
        let right = room - left - 2;
        format!("{} {} {}", "─".repeat(left), self.name, "─".repeat(right))
    }
}

fn groups(columns: &[Column]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (j, column) in columns.iter().enumerate() {
        match groups.last_mut() {
            Some(last) if last.name == column.group => last.count += 1,
            _ => groups.push(Group {
                name: &column.group,
                first: j,
                count: 1,
            }),
        }
    }
    groups
}

/// Makes the last column of a group wide enough for the group's heading.
fn widen(widths: &mut [usize], group: &Group<'_>) {
    let lack = display_width(group.name).saturating_sub(span(group.widths(widths)));
    if let Some(width) = widths.get_mut(group.first + group.count - 1) {
        *width += lack;
    }
}

#[cfg(test)]
mod tests {
    use super::super::Cell;
    use super::*;
    use crate::number::Format;

    #[test]
    fn golden_text_with_units_groups_and_notes() {
        let number =
            |name: &str, unit: &str| Column::new(name, unit, Format::Fixed(2)).in_group("first peak");
        let mut table = Table::new(
            "Peaks",
            [Column::text("model"), number("n_z", "–"), number("q", "deg/s")],
        );
        table.push(["CFD".into(), 0.73.into(), (-1.51).into()]).unwrap();
        table
            .push([
                "Albatross".into(),
                Cell::from(0.714).flagged("20 modes"),
                Cell::EMPTY,
            ])
            .unwrap();
        let expected = "\
Peaks
           ─ first peak ──
model           n_z      q
                  –  deg/s
──────────────────────────
CFD        0.73      -1.51
Albatross  0.71 (a)      –
(a) 20 modes
";
        assert_eq!(table.to_text(), expected);
    }

    #[test]
    fn a_long_group_heading_widens_its_columns() {
        let mut table = Table::new(
            "",
            [Column::new("a", "", Format::Fixed(0)).in_group("a long heading")],
        );
        table.push([1.0.into()]).unwrap();
        assert_eq!(
            table.to_text(),
            "a long heading\n             a\n──────────────\n             1\n"
        );
    }
}
