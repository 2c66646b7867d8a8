//! Writer of decks: everything that the reader understands, and uninterpreted cards as they were.
//!
//! Cards are in small field where all values fit exactly into eight columns, else in large field. A real that needs
//! more than 16 characters is rounded to what fits (nine digits or more). Reading the text again gives an equal deck
//! up to that rounding; comments and the order of cards of different kinds are not kept.

mod cards;
mod format;

use crate::deck::Deck;
use crate::error::Error;

/// The deck as text.
///
/// # Errors
/// [`Error::Unwritable`] for a value that is not finite or a field that no format holds.
pub fn to_text(deck: &Deck) -> Result<String, Error> {
    let mut out = String::new();
    let lines = |out: &mut String, lines: &[String]| {
        for line in lines {
            out.push_str(line);
            out.push('\n');
        }
    };
    lines(&mut out, &deck.executive);
    if !deck.executive.is_empty() {
        out.push_str("CEND\n");
    }
    lines(&mut out, &deck.case_control);
    out.push_str("BEGIN BULK\n");
    cards::bulk(deck, &mut out)?;
    out.push_str("ENDDATA\n");
    Ok(out)
}
