//! Lines of a byte buffer with their numbers.

use std::io::BufRead;

/// Iterates over the lines of `rest` without line ends. LF and CR LF end a line; a lone CR does not.
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: u32,
    ended: bool,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(text: &'a [u8]) -> Self {
        let rest = text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text);
        Self {
            rest,
            number: 0,
            ended: true,
        }
    }

    /// Number of the line returned last, from 1.
    pub(crate) fn number(&self) -> u32 {
        self.number
    }

    /// Whether the line returned last had a line end: if not, the file may have been cut.
    pub(crate) fn last_was_ended(&self) -> bool {
        self.ended
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let whole = self.rest;
        // The standard library's search for a byte is the platform's memchr, reached by `skip_until`.
        let length = self.rest.skip_until(b'\n').ok().filter(|&n| n > 0)?;
        self.number = self.number.saturating_add(1);
        let line = whole.get(..length)?;
        let body = line.strip_suffix(b"\n");
        self.ended = body.is_some();
        let body = body.unwrap_or(line);
        Some(body.strip_suffix(b"\r").unwrap_or(body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_of_both_kinds_and_none() {
        let mut lines = Lines::new(b"\xEF\xBB\xBFa\r\n\nb c\rd\nlast");
        let mut seen = Vec::new();
        while let Some(line) = lines.next() {
            seen.push((lines.number(), line, lines.last_was_ended()));
        }
        assert_eq!(
            seen,
            [
                (1, &b"a"[..], true),
                (2, &b""[..], true),
                (3, &b"b c\rd"[..], true),
                (4, &b"last"[..], false)
            ]
        );
        assert_eq!(Lines::new(b"").next(), None);
    }
}
