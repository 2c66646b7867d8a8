//! Text in plots: raised and lowered characters, estimated width, line breaks.
//!
//! `n_{z}` lowers and `10^{-1}` raises what stands in braces. A bare `_` or `^` is an ordinary character, so
//! names of signals and files (`az_cockpit`) come out as they are.

use super::svg::SCRIPT_SIZE;

/// Position of a run of characters relative to the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shift {
    None,
    Raised,
    Lowered,
}

/// Characters that share one baseline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) text: String,
    pub(crate) shift: Shift,
}

/// Splits marked-up text into runs. Markup that is not closed is ordinary text.
pub(crate) fn runs(text: &str) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let after = rest.get(c.len_utf8()..).unwrap_or("");
        let shift = match c {
            '_' => Shift::Lowered,
            '^' => Shift::Raised,
            _ => Shift::None,
        };
        let script = (shift != Shift::None).then(|| after.strip_prefix('{')).flatten();
        if let Some((inside, behind)) = script.and_then(|script| script.split_once('}')) {
            if !plain.is_empty() {
                runs.push(Run {
                    text: std::mem::take(&mut plain),
                    shift: Shift::None,
                });
            }
            runs.push(Run {
                text: inside.to_owned(),
                shift,
            });
            rest = behind;
        } else {
            plain.push(c);
            rest = after;
        }
    }
    if !plain.is_empty() {
        runs.push(Run {
            text: plain,
            shift: Shift::None,
        });
    }
    runs
}

/// The text without markup, for titles and descriptions: `n_z`, `10^-1`.
pub(crate) fn plain(text: &str) -> String {
    runs(text)
        .into_iter()
        .map(|run| match run.shift {
            Shift::None => run.text,
            Shift::Raised => format!("^{}", run.text),
            Shift::Lowered => format!("_{}", run.text),
        })
        .collect()
}

/// Advance widths of the characters from space to tilde in hundredths of the font size, taken from DejaVu Sans:
/// the widest of the fonts that stand behind `sans-serif`, so that what fits here fits with the others.
#[rustfmt::skip]
const ASCII_WIDTHS: [u8; 95] = [
    32, 40, 46, 84, 64, 95, 78, 27, 39, 39, 50, 84, 32, 36, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64, 64, 64, 34, 34,
    84, 84, 84, 53, 100, 68, 69, 70, 77, 63, 58, 77, 75, 29, 29, 66, 56, 86, 75, 79, 60, 79, 69, 63, 61, 73, 68, 99,
    69, 61, 69, 39, 34, 39, 84, 50, 50, 61, 63, 55, 63, 62, 35, 63, 63, 28, 28, 58, 28, 97, 63, 61, 63, 63, 41, 52,
    39, 63, 59, 82, 59, 59, 52, 64, 34, 64, 84,
];

/// Estimated width of marked-up text in pixels.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let of = |run: &Run| {
        let scale = if run.shift == Shift::None {
            1.0
        } else {
            SCRIPT_SIZE
        };
        scale * run.text.chars().map(advance).sum::<f64>()
    };
    size * runs(text).iter().map(of).sum::<f64>()
}

/// Width of one character in font sizes.
fn advance(c: char) -> f64 {
    let code = u32::from(c);
    let ascii = code
        .checked_sub(32)
        .and_then(|i| usize::try_from(i).ok())
        .and_then(|i| ASCII_WIDTHS.get(i));
    match (ascii, code) {
        (Some(hundredths), _) => f64::from(*hundredths) / 100.0,
        (None, 0x0300..=0x036F) => 0.0,
        // Thin spaces of grouped digits.
        (None, 0x2009 | 0x202F) => 0.2,
        // Superscript digits, degree sign, middle dot.
        (None, 0xB0..=0xB9 | 0x2070..=0x2094) => 0.5,
        (None, 0x0370..=0x03FF) => 0.7,
        (None, 0x1100..=0x115F | 0x2E80..=0xA4CF | 0xAC00..=0xD7A3 | 0xFF00..=0xFF60) => 1.05,
        (None, 0x2012..=0x2013) => 0.5,
        (None, 0x2014..=0x2FFF) => 0.9,
        (None, _) => 0.7,
    }
}

/// Breaks text into lines no wider than `most` pixels: between words, at a no-break space of a word that is
/// too wide, and inside a word where nothing else helps. Markup is never broken.
pub(crate) fn wrap(text: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    let too_wide = |word: &String| width(word, size) > most;
    let loosened = words(text).into_iter().flat_map(|word| {
        if too_wide(&word) {
            words(&word.replace('\u{A0}', " "))
        } else {
            vec![word]
        }
    });
    for word in loosened {
        let joined = if line.is_empty() {
            word.clone()
        } else {
            format!("{line} {word}")
        };
        if width(&joined, size) <= most {
            line = joined;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for piece in pieces(&word) {
            let longer = format!("{line}{piece}");
            if line.is_empty() || width(&longer, size) <= most {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, piece));
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Words between blanks outside braces.
fn words(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut depth = 0_i32;
    for c in text.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth = (depth - 1).max(0),
            _ => {}
        }
        if c.is_whitespace() && c != '\u{A0}' && c != '\u{202F}' && depth == 0 {
            if !word.is_empty() {
                words.push(std::mem::take(&mut word));
            }
        } else {
            word.push(c);
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

/// The smallest parts of a word that may stand on different lines: single characters and whole scripts.
fn pieces(word: &str) -> Vec<String> {
    runs(word)
        .into_iter()
        .flat_map(|run| match run.shift {
            Shift::None => run.text.chars().map(String::from).collect(),
            Shift::Raised => vec![format!("^{{{}}}", run.text)],
            Shift::Lowered => vec![format!("_{{{}}}", run.text)],
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn only_braces_raise_and_lower() {
        assert_eq!(
            plain("C_{Lα} of az_cp, 10^{-1}, x^2, a_{open"),
            "C_Lα of az_cp, 10^-1, x^2, a_{open"
        );
        assert_eq!(runs("az_cp").len(), 1);
        assert_eq!(
            runs("q_{CG}")[1],
            Run {
                text: "CG".into(),
                shift: Shift::Lowered
            }
        );
    }

    #[test]
    fn val_widths_of_a_known_font() {
        // DejaVu Sans at 100 px: "0" advances 64 px, "Hz" 75 + 52 px.
        assert!((width("0", 100.0) - 64.0).abs() < 1e-9);
        assert!((width("Hz", 100.0) - 127.0).abs() < 1e-9);
        assert!(width("n_{z}", 10.0) < width("nz", 10.0));
    }

    #[test]
    fn lines_break_between_words_and_inside_long_ones() {
        assert_eq!(wrap("Angle of attack", 10.0, 50.0), ["Angle of", "attack"]);
        assert_eq!(wrap("Load (a\u{A0}b)", 10.0, 50.0), ["Load", "(a\u{A0}b)"]);
        assert_eq!(wrap("(dB\u{A0}re\u{A0}m)", 10.0, 35.0), ["(dB re", "m)"]);
        assert_eq!(wrap("abcdefgh", 10.0, 25.0), ["abcd", "efgh"]);
        assert!(wrap("", 10.0, 50.0).is_empty());
    }

    proptest! {
        #[test]
        fn prop_lines_keep_all_characters(text in "[a-zA-Z_{}^ ]{0,60}", most in 1.0..200.0f64) {
            let joined: String = wrap(&text, 12.0, most).concat();
            let strip = |s: &str| s.chars().filter(|c| !c.is_whitespace()).collect::<String>();
            prop_assert_eq!(strip(&joined), strip(&text));
        }
    }
}
