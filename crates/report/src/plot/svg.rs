//! Writing SVG: the few elements the plots need, with short coordinates and escaped text.

use super::text::{Run, Shift, runs};

/// Decimals of a coordinate. A hundredth of a pixel is far below what is seen or printed.
const DECIMALS: f64 = 100.0;

/// A coordinate with at most two decimals; never a sign on zero, never anything but digits.
pub(crate) fn coordinate(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let rounded = (value * DECIMALS).round() / DECIMALS;
    if rounded == 0.0 {
        "0".to_owned()
    } else {
        format!("{rounded}")
    }
}

/// Escapes what XML reserves and replaces what XML 1.0 forbids.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\r' | '\t' => out.push(' '),
            '\u{0}'..='\u{1F}' | '\u{FFFE}' | '\u{FFFF}' => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stroke<'a> {
    pub(crate) colour: &'a str,
    pub(crate) width: f64,
    /// Lengths of dashes and gaps in pixels; empty for a solid line.
    pub(crate) dashes: &'a [f64],
}

impl<'a> Stroke<'a> {
    pub(crate) fn solid(colour: &'a str, width: f64) -> Self {
        Self {
            colour,
            width,
            dashes: &[],
        }
    }

    fn attributes(&self) -> String {
        let dashes = if self.dashes.is_empty() {
            String::new()
        } else {
            let lengths: Vec<String> = self.dashes.iter().map(|length| coordinate(*length)).collect();
            format!(" stroke-dasharray=\"{}\"", lengths.join(" "))
        };
        format!(
            "stroke=\"{}\" stroke-width=\"{}\"{dashes}",
            self.colour,
            coordinate(self.width)
        )
    }
}

/// A text and how it is set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Label<'a> {
    pub(crate) text: &'a str,
    /// Anchor point: horizontally as `anchor` says, vertically the middle of the line.
    pub(crate) at: (f64, f64),
    pub(crate) size: f64,
    pub(crate) anchor: Anchor,
    pub(crate) colour: &'a str,
    pub(crate) bold: bool,
    /// Turned by a quarter, to read from below.
    pub(crate) upright: bool,
    /// With a white rim that keeps it readable on top of lines.
    pub(crate) rimmed: bool,
}

impl<'a> Label<'a> {
    pub(crate) fn new(text: &'a str, at: (f64, f64), size: f64, anchor: Anchor, colour: &'a str) -> Self {
        Self {
            text,
            at,
            size,
            anchor,
            colour,
            bold: false,
            upright: false,
            rimmed: false,
        }
    }
}

/// A picture being drawn, from back to front.
#[derive(Debug, Default)]
pub(crate) struct Canvas {
    body: String,
}

impl Canvas {
    pub(crate) fn open_group(&mut self, class: &str) {
        self.body += &format!("<g class=\"{class}\">\n");
    }

    pub(crate) fn close_group(&mut self) {
        self.body += "</g>\n";
    }

    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: &Stroke<'_>) {
        self.body += &format!(
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n",
            coordinate(from.0),
            coordinate(from.1),
            coordinate(to.0),
            coordinate(to.1),
            stroke.attributes()
        );
    }

    pub(crate) fn rectangle(
        &mut self,
        corner: (f64, f64),
        size: (f64, f64),
        fill: &str,
        stroke: Option<&Stroke<'_>>,
    ) {
        let stroke = stroke.map_or(String::new(), |stroke| format!(" {}", stroke.attributes()));
        self.body += &format!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\"{stroke}/>\n",
            coordinate(corner.0),
            coordinate(corner.1),
            coordinate(size.0),
            coordinate(size.1),
        );
    }

    /// An open path. Nothing is written for empty path data.
    pub(crate) fn stroked(&mut self, path: &str, stroke: &Stroke<'_>) {
        if !path.is_empty() {
            self.body += &format!(
                "<path d=\"{path}\" fill=\"none\" {} stroke-linejoin=\"round\"/>\n",
                stroke.attributes()
            );
        }
    }

    /// A closed path, filled and, if a stroke is given, outlined.
    pub(crate) fn filled(&mut self, path: &str, fill: &str, stroke: Option<&Stroke<'_>>) {
        if !path.is_empty() {
            let stroke = stroke.map_or(String::new(), |stroke| format!(" {}", stroke.attributes()));
            self.body += &format!("<path d=\"{path}\" fill=\"{fill}\"{stroke}/>\n");
        }
    }

    /// The inside of closed paths, faint enough to see the grid through it.
    pub(crate) fn shaded(&mut self, path: &str, colour: &str) {
        if !path.is_empty() {
            self.body += &format!("<path d=\"{path}\" fill=\"{colour}\" fill-opacity=\"0.22\"/>\n");
        }
    }

    pub(crate) fn label(&mut self, label: &Label<'_>) {
        if label.text.is_empty() {
            return;
        }
        // Half the height of a capital: puts the middle of the letters on the anchor point.
        let drop = 0.36 * label.size;
        let (x, y) = label.at;
        let place = if label.upright {
            format!(
                "transform=\"translate({} {}) rotate(-90)\"",
                coordinate(x + drop),
                coordinate(y)
            )
        } else {
            format!("x=\"{}\" y=\"{}\"", coordinate(x), coordinate(y + drop))
        };
        let anchor = match label.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let bold = if label.bold { " font-weight=\"bold\"" } else { "" };
        let rim = if label.rimmed {
            " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\""
        } else {
            ""
        };
        let runs = runs(label.text);
        // Without this, viewers drop blanks at the ends of spans.
        let blanks = if runs.len() > 1 {
            " xml:space=\"preserve\""
        } else {
            ""
        };
        self.body += &format!(
            "<text {place}{blanks} font-size=\"{}\" fill=\"{}\"{anchor}{bold}{rim}>{}</text>\n",
            coordinate(label.size),
            label.colour,
            spans(&runs, label.size)
        );
    }

    /// The whole document. `title` and `description` are read by screen readers and shown as hints.
    pub(crate) fn finish(self, width: f64, height: f64, title: &str, description: &str) -> String {
        let (width, height) = (coordinate(width), coordinate(height));
        let description = if description.is_empty() {
            String::new()
        } else {
            format!("<desc>{}</desc>\n", escape(description))
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"sans-serif\">\n\
             <title>{}</title>\n{description}\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// Share of the font size of raised and lowered text, and by how much of it the baseline moves.
pub(crate) const SCRIPT_SIZE: f64 = 0.72;
const RAISE: f64 = 0.38;
const LOWER: f64 = 0.2;

/// Raised and lowered text as spans. `dy` is used because `baseline-shift` is not drawn by every viewer; each
/// span undoes the shift of the one before.
fn spans(runs: &[Run], size: f64) -> String {
    let mut out = String::new();
    let mut level = 0.0;
    for run in runs {
        let target = match run.shift {
            Shift::None => 0.0,
            Shift::Raised => -RAISE * size,
            Shift::Lowered => LOWER * size,
        };
        let text = escape(&run.text);
        if run.shift == Shift::None && level == 0.0 {
            out += &text;
        } else {
            let script = if run.shift == Shift::None {
                size
            } else {
                SCRIPT_SIZE * size
            };
            out += &format!(
                "<tspan dy=\"{}\" font-size=\"{}\">{text}</tspan>",
                coordinate(target - level),
                coordinate(script)
            );
        }
        level = target;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_always_numbers() {
        assert_eq!(coordinate(1.0), "1");
        assert_eq!(coordinate(-0.001), "0");
        assert_eq!(coordinate(12.345_678), "12.35");
        assert_eq!(coordinate(f64::NAN), "0");
    }

    #[test]
    fn reserved_and_forbidden_characters_are_replaced() {
        assert_eq!(
            escape("a<b>&\"c\"\u{7}\n"),
            "a&lt;b&gt;&amp;&quot;c&quot;\u{FFFD} "
        );
    }

    #[test]
    fn scripts_return_to_the_baseline() {
        assert_eq!(
            spans(&runs("n_{z} x"), 10.0),
            "n<tspan dy=\"2\" font-size=\"7.2\">z</tspan><tspan dy=\"-2\" font-size=\"10\"> x</tspan>"
        );
    }
}
