//! Lists of numbers for messages.

use albatross_nastran::deck::Id;

pub(crate) use albatross_fem::text::ranges;

/// The four numbers of `ids` nearest to `wanted`, ascending.
pub(crate) fn nearest(wanted: Id, ids: impl Iterator<Item = Id>) -> String {
    let mut ids: Vec<Id> = ids.collect();
    ids.sort_by_key(|&id| id.abs_diff(wanted));
    ids.truncate(4);
    ids.sort_unstable();
    if ids.is_empty() {
        return "none: the basis has no grids".into();
    }
    ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_numbers_stand_in_order() {
        assert_eq!(
            nearest(1026, [1, 1024, 1025, 2001, 1000].into_iter()),
            "1000, 1024, 1025, 2001"
        );
    }
}
