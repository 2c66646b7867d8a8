//! Lists of numbers for messages.

use albatross_nastran::deck::Id;

/// Ascending numbers as ranges, `1-20, 25`, cut after ten ranges.
#[must_use]
pub fn ranges(ids: &[Id]) -> String {
    const SHOWN: usize = 10;
    let mut spans: Vec<(Id, Id)> = Vec::new();
    for &id in ids {
        match spans.last_mut() {
            Some(span) if id == span.1.saturating_add(1) => span.1 = id,
            _ => spans.push((id, id)),
        }
    }
    let mut text: Vec<String> = spans
        .iter()
        .take(SHOWN)
        .map(|&(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") })
        .collect();
    if spans.len() > SHOWN {
        text.push(format!("... ({} in all)", ids.len()));
    }
    text.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_join_neighbours() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1-3, 7, 9-10");
        assert_eq!(ranges(&[]), "");
        let many: Vec<Id> = (0..30).map(|i| 2 * i).collect();
        assert!(ranges(&many).ends_with("18, ... (30 in all)"));
    }
}
