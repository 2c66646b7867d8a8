//! One card: its name and fields, gathered over continuation lines.
//!
//! Fields are numbered from 1 after the name and counted as in small field: a line has eight. A large-field line has
//! four, so two of them make a line.

/// A card with the text of its fields. The buffers are reused from card to card.
#[derive(Debug, Clone, Default)]
pub(super) struct Card {
    name: Vec<u8>,
    text: Vec<u8>,
    /// Where the fields are in `text`.
    fields: Vec<(u32, u32)>,
    /// Field 10 of the last line: columns 73 to 80, trimmed.
    label: Vec<u8>,
    pub(super) file: u32,
    pub(super) line: u32,
}

/// The parts of one line, before they are joined to a card.
#[derive(Debug, Clone, Copy)]
pub(super) struct BulkLine<'a> {
    /// The line without comment and line end, tabs expanded in fixed field.
    text: &'a [u8],
    /// First field, trimmed: card name with `*`, continuation mark, or empty.
    pub(super) head: &'a [u8],
    free: bool,
    large: bool,
}

impl<'a> BulkLine<'a> {
    pub(super) fn new(text: &'a [u8], free: bool) -> Self {
        let head = if free {
            text.split(|&b| b == b',').next().unwrap_or_default()
        } else {
            text.get(..8).unwrap_or(text)
        };
        let head = head.trim_ascii();
        let large = head.last() == Some(&b'*') || head.first() == Some(&b'*');
        Self {
            text,
            head,
            free,
            large,
        }
    }

    /// Whether the line continues a card: `+...`, `*...` or a blank first field.
    pub(super) fn is_continuation(&self) -> bool {
        matches!(self.head.first(), None | Some(b'+' | b'*'))
    }

    pub(super) fn text(&self) -> &'a [u8] {
        self.text
    }

    pub(super) fn is_free(&self) -> bool {
        self.free
    }

    /// The mark by which a continuation names its parent; the first character is not compared.
    pub(super) fn mark(&self) -> &'a [u8] {
        self.head.get(1..).unwrap_or_default().trim_ascii()
    }
}

impl Card {
    /// Starts a new card with its first line.
    pub(super) fn start(&mut self, line: &BulkLine<'_>, file: u32, number: u32) {
        self.name.clear();
        let name = line.head.strip_suffix(b"*").unwrap_or(line.head).trim_ascii_end();
        self.name.extend(name.iter().map(u8::to_ascii_uppercase));
        self.text.clear();
        self.fields.clear();
        self.file = file;
        self.line = number;
        self.join(line);
    }

    /// Adds the fields of a line.
    pub(super) fn join(&mut self, line: &BulkLine<'_>) {
        self.label.clear();
        // A small-field line begins a new line of eight fields.
        if !line.large {
            while !self.fields.len().is_multiple_of(8) {
                self.push(b"");
            }
        }
        if line.free {
            self.join_free(line)
        } else {
            self.join_fixed(line)
        }
    }

    fn join_fixed(&mut self, line: &BulkLine<'_>) {
        let width = if line.large { 16 } else { 8 };
        let data = line.text.get(8..line.text.len().min(72)).unwrap_or_default();
        let start = self.text.len();
        self.text.extend_from_slice(data);
        for k in 0..64 / width {
            let from = (k * width).min(data.len());
            let upto = (from + width).min(data.len());
            let (blanks, field) = trimmed(data.get(from..upto).unwrap_or_default());
            self.fields.push(range(start + from + blanks, field.len()));
        }
        let label = line.text.get(72..line.text.len().min(80)).unwrap_or_default();
        self.label.extend_from_slice(label.trim_ascii());
    }

    /// Free field: data beyond the eighth (fourth in large field) go on as on a continuation line, so that a list may
    /// be written on one long line.
    fn join_free(&mut self, line: &BulkLine<'_>) {
        let count = if line.large { 4 } else { 8 };
        let before = self.fields.len();
        let mut fields = line
            .text
            .split(|&b| b == b',')
            .skip(1)
            .map(<[u8]>::trim_ascii)
            .enumerate()
            .peekable();
        while let Some((at, field)) = fields.next() {
            let is_last = fields.peek().is_none();
            let is_mark = match field.first() {
                Some(b'+' | b'*') if at == count => true,
                Some(b'+') => is_last && crate::number::real(field).is_none(),
                Some(b'*') => is_last && field.len() == 1,
                _ => false,
            };
            if is_mark {
                self.label.clear();
                self.label.extend_from_slice(field);
            } else if !(at == count && is_last && field.is_empty()) {
                self.push(field);
            }
        }
        while !(self.fields.len() - before).is_multiple_of(count) || self.fields.len() == before {
            self.push(b"");
        }
    }

    pub(super) fn push(&mut self, field: &[u8]) {
        self.fields.push(range(self.text.len(), field.len()));
        self.text.extend_from_slice(field);
    }

    /// Card name, upper case, without `*`.
    pub(super) fn name(&self) -> &[u8] {
        &self.name
    }

    pub(super) fn set_name(&mut self, name: &[u8]) {
        self.name.clear();
        self.name.extend_from_slice(name);
    }

    /// Field 10 of the last line without its first character, which is not compared; `None` when blank.
    pub(super) fn label(&self) -> Option<&[u8]> {
        self.label
            .get(1..)
            .map(<[u8]>::trim_ascii)
            .filter(|l| !l.is_empty())
    }

    /// Whether field 10 is written as a mark (`+...` or `*...`) and not, say, as a sequence number.
    pub(super) fn has_mark(&self) -> bool {
        matches!(self.label.first(), Some(b'+' | b'*')) && self.label().is_some()
    }

    /// Number of fields up to the last line's end, blank ones included.
    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }

    /// Field `n` from 1, trimmed; empty if the card ends before.
    pub(super) fn field(&self, n: usize) -> &[u8] {
        let Some(&(start, end)) = n.checked_sub(1).and_then(|i| self.fields.get(i)) else {
            return b"";
        };
        self.text.get(start as usize..end as usize).unwrap_or_default()
    }

    /// Number of the last field that is not blank.
    pub(super) fn last(&self) -> usize {
        (1..=self.len())
            .rev()
            .find(|&n| !self.field(n).is_empty())
            .unwrap_or(0)
    }

    pub(super) fn clear_fields(&mut self) {
        self.text.clear();
        self.fields.clear();
        self.label.clear();
    }
}

/// Blanks before the text, and the text without blanks around it.
fn trimmed(field: &[u8]) -> (usize, &[u8]) {
    let text = field.trim_ascii_start();
    (field.len() - text.len(), text.trim_ascii_end())
}

fn range(start: usize, length: usize) -> (u32, u32) {
    let start = u32::try_from(start).unwrap_or(u32::MAX);
    (
        start,
        start.saturating_add(u32::try_from(length).unwrap_or(u32::MAX)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(lines: &[&str]) -> Card {
        let mut card = Card::default();
        for (i, line) in lines.iter().enumerate() {
            let line = BulkLine::new(line.as_bytes(), line.contains(','));
            if i == 0 {
                card.start(&line, 0, 1)
            } else {
                card.join(&line)
            }
        }
        card
    }

    fn fields(card: &Card) -> Vec<String> {
        (1..=card.last())
            .map(|n| String::from_utf8_lossy(card.field(n)).into_owned())
            .collect()
    }

    #[test]
    fn small_large_and_free_agree() {
        let expected = ["7", "", "1.5", "-2.5", "3.5", "", "", "", "9"];
        for lines in [
            &[
                "GRID           7             1.5    -2.5     3.5                        +A",
                "+A             9",
            ][..],
            &[
                "GRID*                  7                             1.5            -2.5*",
                "*                    3.5",
                "*                      9",
            ],
            &["grid,7,,1.5,-2.5,3.5,,,,+", "+,9"],
            &["GRID*,7,,1.5,-2.5,*A", "*A,3.5", "*,9"],
            &["GRID,7,,1.5,-2.5,3.5,,,,9"],
        ] {
            let card = card(lines);
            assert_eq!(card.name(), b"GRID", "{lines:?}");
            assert_eq!(fields(&card), expected, "{lines:?}");
        }
    }

    #[test]
    fn free_field_marks_are_not_data() {
        assert_eq!(
            fields(&card(&["CBAR,1,2,3,4,0.,1.,0.,+"])),
            ["1", "2", "3", "4", "0.", "1.", "0."]
        );
        assert_eq!(fields(&card(&["SPC1,1,123,+5"])), ["1", "123", "+5"]);
    }

    #[test]
    fn small_line_after_half_a_large_one_starts_a_new_line() {
        let card = card(&["RBE2*                  1               2", "               9"]);
        assert_eq!((card.field(2), card.field(9)), (&b"2"[..], &b"9"[..]));
    }
}
