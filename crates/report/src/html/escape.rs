//! Text that stays text.

use crate::plot::text::{Shift, runs};
use serde_json::Value;

/// Text between tags or in quoted attributes; line breaks are kept.
pub(super) fn text(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            // HTML has no way to write control characters.
            c if c.is_control() => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// Text with `_{…}` and `^{…}` as elements: for the page, and for plotly.js, which reads the same few elements.
pub(super) fn marked(marked: &str) -> String {
    runs(marked)
        .into_iter()
        .map(|run| match run.shift {
            Shift::None => text(&run.text),
            Shift::Raised => format!("<sup>{}</sup>", text(&run.text)),
            Shift::Lowered => format!("<sub>{}</sub>", text(&run.text)),
        })
        .collect()
}

/// JSON inside a script element: nothing in it can end the element or open a comment.
pub(super) fn data(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn text_cannot_become_an_element_or_leave_its_attribute() {
        assert_eq!(
            text("<b a=\"1\" c='2'> & \u{7}\n"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt; &amp; \u{FFFD}\n"
        );
        assert_eq!(marked("n_{<z>} m/s^{2}"), "n<sub>&lt;z&gt;</sub> m/s<sup>2</sup>");
    }

    #[test]
    fn data_cannot_end_its_script() {
        let written = data(&json!({ "a": "</script><!--" }));
        assert!(!written.contains('<'), "{written}");
        let read: Value = serde_json::from_str(&written).unwrap();
        assert_eq!(read["a"], "</script><!--");
    }
}
