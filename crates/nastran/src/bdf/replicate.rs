//! Replication: `=` repeats a field of the card before, `==` all that follow, `*x` or `*(x)` adds to it, and `=n` or
//! `=(n)` in place of the name repeats the last replication n times. (MSC Nastran Quick Reference Guide, "Bulk Data
//! Section", field generation features.)

use crate::number;

use super::card::{BulkLine, Card};

/// What replication may make of a deck, in bytes of fields: some 80 000 grids. More is taken for a mistake, since a line
/// of a few bytes would fill the memory.
const MOST: usize = 16 << 20;
/// What a field takes beside its text.
const FIELD: usize = 24;

/// The cards that a line beginning with `=` makes from the card before it. `last_pattern` holds the last such line,
/// `made` what replication has made of the deck so far.
pub(super) fn expand(
    line: &BulkLine<'_>,
    file: u32,
    number: u32,
    previous: &Card,
    last_pattern: &mut Option<Card>,
    made: &mut usize,
) -> Result<Vec<Card>, String> {
    if previous.name().is_empty() {
        return Err("there is no card before it to repeat".into());
    }
    let mut pattern = Card::default();
    pattern.start(line, file, number);
    let head = String::from_utf8_lossy(line.head).into_owned();
    let count = head.trim_matches(|c| "=() ".contains(c));
    if count.is_empty() {
        let card = next(previous, &pattern)?;
        count_in(&card, made)?;
        *last_pattern = Some(pattern);
        return Ok(vec![card]);
    }
    let count = number::integer(count.as_bytes())
        .filter(|n| *n >= 1)
        .ok_or_else(|| format!("{head:?} is no count; expected =(n) with n of 1 or more"))?;
    if pattern.last() == 0 {
        pattern = last_pattern
            .clone()
            .ok_or("=(n) must follow a line that begins with =")?;
        pattern.file = file;
        pattern.line = number;
    }
    let mut cards: Vec<Card> = Vec::new();
    for _ in 0..count {
        let card = next(cards.last().unwrap_or(previous), &pattern)?;
        count_in(&card, made)?;
        cards.push(card);
    }
    Ok(cards)
}

/// Refuses a card beyond what replication may make.
fn count_in(card: &Card, made: &mut usize) -> Result<(), String> {
    *made += (1..=card.len())
        .map(|n| FIELD + card.field(n).len())
        .sum::<usize>();
    if *made > MOST {
        return Err(format!(
            "makes more than {} MB of cards in all; write them out if they are meant",
            MOST >> 20
        ));
    }
    Ok(())
}

/// One card from the one before and the pattern.
fn next(previous: &Card, pattern: &Card) -> Result<Card, String> {
    let mut card = pattern.clone();
    card.clear_fields();
    card.set_name(previous.name());
    let mut rest = false;
    for n in 1..=pattern.len().max(previous.len()) {
        let symbol = pattern.field(n);
        let old = previous.field(n);
        rest |= symbol == b"==";
        if rest || symbol == b"=" {
            card.push(old);
        } else if let Some(increment) = symbol.strip_prefix(b"*") {
            let increment = increment
                .strip_prefix(b"(")
                .and_then(|i| i.strip_suffix(b")"))
                .unwrap_or(increment);
            card.push(sum(old, increment)?.as_bytes());
        } else {
            card.push(symbol);
        }
    }
    Ok(card)
}

/// The sum of two fields: an integer if both are, else a real.
fn sum(old: &[u8], increment: &[u8]) -> Result<String, String> {
    if let (Some(a), Some(b)) = (number::integer(old), number::integer(increment)) {
        return Ok(a.saturating_add(b).to_string());
    }
    match (number::real(old), number::real(increment)) {
        (Some(a), Some(b)) => Ok(format!("{:e}", a + b)),
        _ => Err(format!(
            "*({}) cannot be added to {:?}; both must be numbers",
            String::from_utf8_lossy(increment),
            String::from_utf8_lossy(old)
        )),
    }
}
