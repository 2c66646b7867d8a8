//! Names that may be misspelt, and places in messages.

/// The name nearest to one that is not known, if it is near enough to be meant.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    known
        .into_iter()
        .map(|k| {
            let other = k.to_lowercase();
            // One letter wrong or two exchanged, or much in common.
            let likeness = match strsim::osa_distance(&lower, &other) {
                0 | 1 => 1.0,
                _ => strsim::jaro_winkler(&lower, &other),
            };
            (likeness, k)
        })
        .filter(|(likeness, _)| *likeness > 0.82)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, k)| k)
}

/// A number with so many digits at most, without zeros at its end.
pub(super) fn digits(value: f64, most: usize) -> String {
    let rounded = format!("{value:.*e}", most.saturating_sub(1)).parse::<f64>();
    // A negative zero is zero.
    (rounded.unwrap_or(value) + 0.0).to_string()
}

/// A cure for an unknown name: the one that is meant, and all there are.
pub(super) fn choose(name: &str, known: &[&str]) -> String {
    let all = if known.is_empty() {
        "There is none".to_owned()
    } else {
        format!("There is: {}", known.join(", "))
    };
    match nearest(name, known.iter().copied()) {
        Some(meant) => format!("did you mean `{meant}`? {all}"),
        None => format!("use a name that is there. {all}"),
    }
}

/// A message's own place (`file`, `file:line` or `file:line:column`) if it begins with `file`, and the rest.
pub(super) fn split_place<'a>(message: &'a str, file: &'a str) -> (&'a str, &'a str) {
    let name = |text: &str| {
        // A place has no blank before its colon.
        let end = text.find(": ")?;
        let place = text.get(..end)?;
        (!place.contains(' ') && (place.contains('.') || place.contains('/'))).then_some(end)
    };
    match name(message) {
        Some(end) => (
            message.get(..end).unwrap_or(file),
            message.get(end + 2..).unwrap_or(message),
        ),
        None => (file, message),
    }
}

/// Names in backticks after `expected` in a message of the TOML reader.
pub(super) fn expected(message: &str) -> Vec<String> {
    let list = message.split_once("expected ").map_or("", |(_, list)| list);
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_nearest_name() {
        let known = ["aileron", "elevator", "rudder"];
        assert_eq!(nearest("elevatr", known), Some("elevator"));
        assert_eq!(nearest("Elevator", known), Some("elevator"));
        assert_eq!(nearest("canard", known), None);
        assert_eq!(nearest("HPT", ["Wing", "HTP"]), Some("HTP"));
    }

    #[test]
    fn val_digits() {
        assert_eq!(digits(80_918.489_976, 7), "80918.49");
        assert_eq!(digits(-0.0, 7), "0");
        assert_eq!(digits(1e-9, 3), "0.000000001");
    }

    #[test]
    fn val_place_of_a_message() {
        let place = |text| split_place(text, "case.toml");
        assert_eq!(
            place("a/f25.bdf:12: GRID 3: bad"),
            ("a/f25.bdf:12", "GRID 3: bad")
        );
        assert_eq!(
            place("mode 24 is not free: look"),
            ("case.toml", "mode 24 is not free: look")
        );
    }
}
