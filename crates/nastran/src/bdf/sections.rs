//! The sections of a deck, comments and included files: what stands between the file and its cards.

use crate::deck::Deck;
use crate::error::{Diagnostic, Severity};
use crate::lines::Lines;

use super::assemble::Assembler;
use super::build::Builder;
use super::card::BulkLine;
use super::include::{self, IncludeStatement, Included, Progress};

/// Files within files; deeper nesting than this is taken for a mistake.
const DEEPEST_INCLUDE: usize = 32;
/// Files that may be included in all. Files that include others twice would double at every level.
const MOST_INCLUDES: usize = 10_000;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Executive,
    CaseControl,
    Bulk,
    Ended,
}

type Resolver<'r> = dyn FnMut(&str, &str) -> Result<Included, String> + 'r;

pub(super) struct DeckReader<'r> {
    resolve: &'r mut Resolver<'r>,
    section: Section,
    executive: Vec<String>,
    case_control: Vec<String>,
    /// Files being read, the main file first.
    open: Vec<u32>,
    /// How many files were included so far.
    included: usize,
    assembler: Assembler,
    builder: Builder,
    /// Buffer for a line with tabs expanded.
    expanded: Vec<u8>,
}

impl<'r> DeckReader<'r> {
    pub(super) fn new(name: &str, resolve: &'r mut Resolver<'r>) -> Self {
        Self {
            resolve,
            section: Section::Executive,
            executive: Vec::new(),
            case_control: Vec::new(),
            open: vec![0],
            included: 0,
            assembler: Assembler::default(),
            builder: Builder::new(name),
            expanded: Vec::with_capacity(128),
        }
    }

    pub(super) fn read(mut self, text: &[u8]) -> (Deck, Vec<Diagnostic>) {
        self.section = first_section(text);
        self.file(text, 0);
        if matches!(self.section, Section::Executive | Section::CaseControl) {
            self.remark(
                Severity::Error,
                0,
                0,
                "BEGIN BULK",
                "is missing, so that no bulk data was read; put it between case control and the first card",
            );
        }
        self.assembler.finish(&mut self.builder);
        let (mut deck, diagnostics) = self.builder.finish();
        deck.executive = self.executive;
        deck.case_control = self.case_control;
        (deck, diagnostics)
    }

    fn remark(&mut self, severity: Severity, file: u32, line: u32, card: &str, message: impl Into<String>) {
        self.builder.remark(severity, file, line, card, message);
    }

    fn file(&mut self, text: &[u8], file: u32) {
        self.builder.allow_for(text);
        let mut lines = Lines::new(text);
        let mut statement: Option<(IncludeStatement, u32)> = None;
        while let Some(line) = lines.next() {
            if self.section == Section::Ended {
                return;
            }
            let number = lines.number();
            // Ctrl-Z ended text files on old systems.
            let line = line.strip_suffix(&[0x1A]).unwrap_or(line);
            if let Some((open, at)) = statement.take() {
                match open.take(line, false) {
                    Progress::Open(open) => statement = Some((open, at)),
                    Progress::Done(path) => self.include(&path, file, at),
                }
                continue;
            }
            if matches!(line.first(), Some(b' ' | b'I' | b'i'))
                && let Some(rest) = include::after_keyword(line)
            {
                match IncludeStatement::default().take(rest, true) {
                    Progress::Open(open) => statement = Some((open, number)),
                    Progress::Done(path) => self.include(&path, file, number),
                }
                continue;
            }
            if self.section == Section::Bulk {
                self.bulk_line(line, file, number);
            } else {
                self.control_line(line, file, number);
            }
        }
        if let Some((open, at)) = statement {
            self.remark(
                Severity::Error,
                file,
                at,
                "INCLUDE",
                format!(
                    "the path {:?} has no closing quote before the end of the file",
                    open.so_far()
                ),
            );
        }
    }

    fn include(&mut self, path: &str, file: u32, line: u32) {
        if path.is_empty() {
            return self.remark(
                Severity::Error,
                file,
                line,
                "INCLUDE",
                "names no file; expected INCLUDE 'path'",
            );
        }
        if self.included >= MOST_INCLUDES {
            // Said once: what is not followed may be more yet.
            if self.included == MOST_INCLUDES {
                self.included += 1;
                self.remark(
                    Severity::Error,
                    file,
                    line,
                    "INCLUDE",
                    format!(
                        "{path:?} is more than {MOST_INCLUDES} included files; no further one is followed"
                    ),
                );
            }
            return;
        }
        self.included += 1;
        let included = match (self.resolve)(path, self.builder.file(file)) {
            Ok(included) => included,
            Err(reason) => {
                return self.remark(
                    Severity::Error,
                    file,
                    line,
                    "INCLUDE",
                    format!("{path:?}: {reason}"),
                );
            }
        };
        let is_open = self.open.iter().any(|&f| self.builder.file(f) == included.name)
            // The main file may have been named otherwise.
            || self.is_main(&included.name);
        if is_open {
            return self.remark(
                Severity::Error,
                file,
                line,
                "INCLUDE",
                format!("{path:?} includes itself through a circle of files; it is not followed"),
            );
        }
        if self.open.len() >= DEEPEST_INCLUDE {
            return self.remark(
                Severity::Error,
                file,
                line,
                "INCLUDE",
                format!("{path:?} is nested more than {DEEPEST_INCLUDE} files deep; it is not followed"),
            );
        }
        let index = self.builder.add_file(&included.name);
        self.open.push(index);
        self.file(&included.text, index);
        self.open.pop();
    }

    fn is_main(&self, name: &str) -> bool {
        let canonical = |name: &str| std::path::Path::new(name).canonicalize().ok();
        canonical(self.builder.file(0)).is_some_and(|main| Some(main) == canonical(name))
    }

    /// A line of executive or case control.
    fn control_line(&mut self, line: &[u8], file: u32, number: u32) {
        let text = String::from_utf8_lossy(without_comment(line)).trim().to_owned();
        if text.is_empty() {
            return;
        }
        let upper = text.to_ascii_uppercase();
        let mut words = upper.split([' ', '\t', '=', ',']).filter(|w| !w.is_empty());
        match (self.section, words.next(), words.next()) {
            (Section::Executive, Some("CEND"), _) => self.section = Section::CaseControl,
            // CEND after what was taken for case control.
            (Section::CaseControl, Some("CEND"), _) => self.executive.append(&mut self.case_control),
            (_, Some("BEGIN"), what) => self.begin_bulk(what, &upper, file, number),
            (_, Some("ENDDATA"), _) => self.section = Section::Ended,
            (Section::Executive, ..) => self.executive.push(text),
            _ => self.case_control.push(text),
        }
    }

    fn begin_bulk(&mut self, what: Option<&str>, statement: &str, file: u32, line: u32) {
        if self.section == Section::Bulk {
            self.remark(
                Severity::Note,
                file,
                line,
                "BEGIN BULK",
                "is repeated; the first one counts",
            );
        }
        // Superelements and other parts have numbers of their own.
        if what != Some("BULK") || statement.contains("SUPER") || statement.contains("AUX") {
            self.remark(
                Severity::Warning,
                file,
                line,
                "BEGIN",
                format!("the part that {statement:?} begins is read into the same deck; its numbers must not collide"),
            );
        }
        self.section = Section::Bulk;
    }

    fn bulk_line(&mut self, line: &[u8], file: u32, number: u32) {
        // Most lines have none of these bytes, which one pass without branches finds out.
        let special = line
            .iter()
            .fold(false, |any, &b| any | (b == b'$') | (b == b',') | (b == b'\t'));
        let text = if special {
            line.split(|&b| b == b'$').next().unwrap_or_default()
        } else {
            line
        };
        let (free, tab) = if special {
            (text.contains(&b','), text.contains(&b'\t'))
        } else {
            (false, false)
        };
        let text = text.trim_ascii_end();
        if text.is_empty() {
            return;
        }
        let mut expanded = std::mem::take(&mut self.expanded);
        let text = if tab && !free {
            expand_tabs(text, &mut expanded)
        } else {
            text
        };
        let line = BulkLine::new(text, free);
        if matches!(line.head.first(), Some(b'B' | b'b' | b'E' | b'e'))
            && self.is_statement(text, file, number)
        {
            self.expanded = expanded;
            return;
        }
        self.assembler.line(&line, file, number, &mut self.builder);
        self.expanded = expanded;
    }

    /// BEGIN and ENDDATA, which are no cards.
    fn is_statement(&mut self, text: &[u8], file: u32, line: u32) -> bool {
        let starts = |word: &[u8]| {
            text.trim_ascii_start()
                .get(..word.len())
                .is_some_and(|t| t.eq_ignore_ascii_case(word))
        };
        if starts(b"ENDDATA") {
            self.section = Section::Ended;
            return true;
        }
        if !starts(b"BEGIN") {
            return false;
        }
        let upper = String::from_utf8_lossy(text).trim().to_ascii_uppercase();
        let what = upper
            .split([' ', '\t', '=', ','])
            .filter(|w| !w.is_empty())
            .nth(1)
            .map(str::to_owned);
        self.begin_bulk(what.as_deref(), &upper, file, line);
        true
    }
}

/// A deck with neither CEND nor BEGIN is bulk data alone; one without CEND has no executive control.
fn first_section(text: &[u8]) -> Section {
    let mut has_begin = false;
    for line in Lines::new(text) {
        let word = without_comment(line).trim_ascii();
        if word.eq_ignore_ascii_case(b"CEND") {
            return Section::Executive;
        }
        if word.get(..5).is_some_and(|w| w.eq_ignore_ascii_case(b"BEGIN")) {
            has_begin = true;
            break;
        }
    }
    if has_begin {
        Section::CaseControl
    } else {
        Section::Bulk
    }
}

/// The line up to a `$` outside quotes.
fn without_comment(line: &[u8]) -> &[u8] {
    let mut quote = None;
    for (at, &byte) in line.iter().enumerate() {
        match (quote, byte) {
            (None, b'$') => return line.get(..at).unwrap_or_default(),
            (None, b'\'' | b'"') => quote = Some(byte),
            (Some(open), close) if open == close => quote = None,
            _ => {}
        }
    }
    line
}

/// Tabs go to the next multiple of eight columns.
fn expand_tabs<'b>(text: &[u8], buffer: &'b mut Vec<u8>) -> &'b [u8] {
    buffer.clear();
    for &byte in text {
        if byte == b'\t' {
            let target = (buffer.len() / 8 + 1) * 8;
            buffer.resize(target, b' ');
        } else {
            buffer.push(byte);
        }
    }
    buffer
}
