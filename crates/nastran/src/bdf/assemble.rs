//! Joins lines to cards: continuations that follow their card, and those that stand elsewhere and name it by the mark
//! in field 10.

use std::collections::HashMap;

use crate::error::Severity;

use super::build::Builder;
use super::card::{BulkLine, Card};
use super::replicate;

#[derive(Default)]
pub(super) struct Assembler {
    current: Card,
    has_current: bool,
    /// The card before, for replication, and the last replication line.
    previous: Card,
    pattern: Option<Card>,
    /// What replication has made so far, in bytes.
    replicated: usize,
    /// Cards whose field 10 has a mark that the next line does not answer, by mark.
    waiting: HashMap<Vec<u8>, Card>,
    /// Continuations that no card has asked for yet, by their own mark.
    orphans: HashMap<Vec<u8>, Orphan>,
}

/// A continuation line without its card.
struct Orphan {
    text: Vec<u8>,
    free: bool,
    file: u32,
    line: u32,
}

impl Assembler {
    pub(super) fn line(&mut self, line: &BulkLine<'_>, file: u32, number: u32, builder: &mut Builder) {
        if line.is_continuation() {
            return self.continuation(line, file, number, builder);
        }
        self.flush(builder);
        if line.head.first() == Some(&b'=') {
            let Self {
                previous,
                pattern,
                replicated,
                ..
            } = self;
            match replicate::expand(line, file, number, previous, pattern, replicated) {
                Ok(cards) => {
                    for card in cards {
                        builder.card(&card);
                        self.previous = card;
                    }
                }
                Err(problem) => builder.remark(Severity::Error, file, number, "replication", problem),
            }
            return;
        }
        self.current.start(line, file, number);
        self.has_current = true;
    }

    /// A continuation belongs to the card with its mark: the one before it, one that waits, or one to come. Without
    /// marks it belongs to the card before it.
    fn continuation(&mut self, line: &BulkLine<'_>, file: u32, number: u32, builder: &mut Builder) {
        let mark = line.mark();
        let answers = self
            .current
            .label()
            .is_some_and(|label| label.eq_ignore_ascii_case(mark));
        if self.has_current && (mark.is_empty() || answers) {
            self.current.join(line);
        } else if let Some(card) = self.waiting.remove(mark) {
            self.flush(builder);
            self.current = card;
            self.has_current = true;
            self.current.join(line);
        } else if self.has_current && !self.current.has_mark() {
            self.current.join(line);
        } else if mark.is_empty() {
            let head = String::from_utf8_lossy(line.text()).trim().to_owned();
            builder.remark(
                Severity::Error,
                file,
                number,
                "continuation",
                format!("{head:?} continues no card"),
            );
        } else {
            let orphan = Orphan {
                text: line.text().to_vec(),
                free: line.is_free(),
                file,
                line: number,
            };
            self.orphans.insert(mark.to_vec(), orphan);
        }
    }

    /// Hands over the current card, unless its mark still waits for a continuation. Columns 73 to 80 often hold
    /// sequence numbers: only what is written as a mark is waited for.
    fn flush(&mut self, builder: &mut Builder) {
        if !self.has_current {
            return;
        }
        self.has_current = false;
        join_orphans(&mut self.current, &mut self.orphans);
        if self.current.has_mark() {
            let label = self.current.label().unwrap_or_default().to_vec();
            if let Some(earlier) = self.waiting.insert(label, self.current.clone()) {
                builder.card(&earlier);
            }
        } else {
            builder.card(&self.current);
        }
        std::mem::swap(&mut self.current, &mut self.previous);
    }

    /// Hands over what is left at the end of the deck.
    pub(super) fn finish(&mut self, builder: &mut Builder) {
        self.flush(builder);
        let mut cards: Vec<Card> = self.waiting.drain().map(|(_, card)| card).collect();
        cards.sort_by_key(|card| (card.file, card.line));
        for mut card in cards {
            join_orphans(&mut card, &mut self.orphans);
            builder.card(&card);
        }
        let mut orphans: Vec<_> = self.orphans.drain().collect();
        orphans.sort_by_key(|(_, orphan)| (orphan.file, orphan.line));
        for (mark, orphan) in orphans {
            let mark = String::from_utf8_lossy(&mark).into_owned();
            builder.remark(
                Severity::Error,
                orphan.file,
                orphan.line,
                "continuation",
                format!("no card has the mark {mark:?} in field 10; it is not read"),
            );
        }
    }
}

/// Joins the continuations that stood before their card.
fn join_orphans(card: &mut Card, orphans: &mut HashMap<Vec<u8>, Orphan>) {
    while !orphans.is_empty()
        && let Some(orphan) = card.label().and_then(|label| orphans.remove(label))
    {
        card.join(&BulkLine::new(&orphan.text, orphan.free));
    }
}
