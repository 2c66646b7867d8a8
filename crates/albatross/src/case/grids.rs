//! Lists of grids: numbers and Nastran-like ranges.

use crate::Error;
use serde::Deserialize;

/// A grid, or a range such as `"1001 THRU 1025"` or `"1001 THRU 1025 BY 2"`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    untagged,
    expecting = "an entry of a list of grids is neither a number nor a range such as `1001 THRU 1025`"
)]
pub enum GridEntry {
    /// One grid.
    Id(u32),
    /// A range.
    Range(String),
}

/// The grids of a list in its order.
///
/// # Errors
/// [`Error::UnknownName`] for a range that cannot be read.
pub fn grid_list(entries: &[GridEntry]) -> Result<Vec<u32>, Error> {
    let mut grids = Vec::new();
    for entry in entries {
        match entry {
            GridEntry::Id(id) => grids.push(*id),
            GridEntry::Range(text) => grids.extend(range(text).ok_or_else(|| Error::UnknownName {
                kind: "grid range",
                name: text.clone(),
                known: "a form such as 1001, \"1001 THRU 1025\" or \"1001 THRU 1025 BY 2\" (at most 100000 grids)".into(),
            })?),
        }
    }
    Ok(grids)
}

fn range(text: &str) -> Option<Vec<u32>> {
    const MOST: u32 = 100_000;
    let words: Vec<String> = text.split_whitespace().map(str::to_ascii_uppercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (from, to, by) = match words.as_slice() {
        [one] => (one.parse().ok()?, one.parse().ok()?, 1),
        [from, "THRU", to] => (from.parse().ok()?, to.parse().ok()?, 1),
        [from, "THRU", to, "BY", by] => (from.parse().ok()?, to.parse().ok()?, by.parse::<u32>().ok()?),
        _ => return None,
    };
    let (from, to): (u32, u32) = (from, to);
    if by == 0 || from > to || (to - from) / by >= MOST {
        return None;
    }
    Some((from..=to).step_by(by as usize).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_ranges() {
        let list = [
            GridEntry::Id(7),
            GridEntry::Range("1 thru 3".into()),
            GridEntry::Range("10 THRU 20 BY 5".into()),
        ];
        assert_eq!(grid_list(&list).unwrap(), [7, 1, 2, 3, 10, 15, 20]);
        for bad in ["3 THRU 1", "1 THRU", "a", "1 THRU 9 BY 0", "0 THRU 4000000000"] {
            assert!(grid_list(&[GridEntry::Range(bad.into())]).is_err(), "{bad}");
        }
    }
}
