//! A Markdown page put together from headings, paragraphs, tables and pictures.

use crate::table::{Table, escape_markdown};

/// A Markdown document in the making. Blocks are separated by one blank line.
///
/// ```
/// use albatross_report::Page;
/// let mut page = Page::new();
/// page.heading(1, "Validation").paragraph("All numbers are *measured*.").image("fig7.svg", "Figure 7", "");
/// assert_eq!(page.finish(), "# Validation\n\nAll numbers are *measured*.\n\n![Figure 7](fig7.svg)\n");
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Page {
    blocks: Vec<String>,
}

impl Page {
    /// An empty page.
    pub fn new() -> Self {
        Self::default()
    }

    /// A heading of level 1 to 6; the text is literal.
    pub fn heading(&mut self, level: usize, text: &str) -> &mut Self {
        self.block(format!(
            "{} {}",
            "#".repeat(level.clamp(1, 6)),
            escape_markdown(text)
        ))
    }

    /// A paragraph of Markdown, taken as it is.
    pub fn paragraph(&mut self, markdown: &str) -> &mut Self {
        self.block(markdown.trim().to_owned())
    }

    /// A bulleted list, one item of Markdown each.
    pub fn bullets<'a>(&mut self, items: impl IntoIterator<Item = &'a str>) -> &mut Self {
        let lines: Vec<String> = items
            .into_iter()
            .map(|item| format!("- {}", item.trim()))
            .collect();
        self.block(lines.join("\n"))
    }

    /// Text as a program printed it, fenced so that nothing in it is read as Markdown.
    pub fn code(&mut self, language: &str, text: &str) -> &mut Self {
        let longest = text
            .lines()
            .map(|line| line.chars().take_while(|c| *c == '`').count())
            .max()
            .unwrap_or(0);
        let fence = "`".repeat(3.max(longest + 1));
        self.block(format!(
            "{fence}{language}\n{}\n{fence}",
            text.trim_end_matches('\n')
        ))
    }

    /// A table with its title, caption and notes.
    pub fn table(&mut self, table: &Table) -> &mut Self {
        self.block(table.to_markdown().trim_end().to_owned())
    }

    /// A picture by its path relative to the page, with a text for those who do not see it, and a caption of
    /// Markdown below (none if empty).
    pub fn image(&mut self, path: &str, alternative: &str, caption: &str) -> &mut Self {
        let alternative = escape_markdown(alternative)
            .replace('[', "\\[")
            .replace(']', "\\]");
        let path = path.replace(' ', "%20").replace('(', "%28").replace(')', "%29");
        self.block(format!("![{alternative}]({path})"));
        if caption.is_empty() {
            self
        } else {
            self.paragraph(caption)
        }
    }

    fn block(&mut self, text: String) -> &mut Self {
        if !text.is_empty() {
            self.blocks.push(text);
        }
        self
    }

    /// The whole page, ending in one line feed; empty if nothing was added.
    pub fn finish(&self) -> String {
        let mut out = self.blocks.join("\n\n");
        if !out.is_empty() {
            out.push('\n');
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cell, Column};

    #[test]
    fn blocks_are_separated_by_one_blank_line() {
        let mut table = Table::new("T", [Column::text("a")]);
        table.push([Cell::from("x")]).unwrap();
        let mut page = Page::new();
        page.heading(2, "Bode *plots*")
            .bullets(["one", "two"])
            .table(&table)
            .code("text", "a\n```\nb\n");
        assert_eq!(
            page.finish(),
            "## Bode \\*plots\\*\n\n- one\n- two\n\n**T**\n\n| a   |\n| --- |\n| x   |\n\n````text\na\n```\nb\n````\n"
        );
    }

    #[test]
    fn image_paths_and_texts_cannot_break_the_link() {
        let mut page = Page::new();
        page.image("a (1).svg", "n_z [–]", "*Caption.*");
        assert_eq!(page.finish(), "![n_z \\[–\\]](a%20%281%29.svg)\n\n*Caption.*\n");
        assert_eq!(Page::new().finish(), "");
    }
}
