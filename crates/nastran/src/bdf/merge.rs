//! From lists of numbered cards to maps, with a remark on every number that is given twice.

use std::collections::BTreeMap;

use crate::deck::{Id, Origins};
use crate::error::Severity;
use crate::remarks::Remarks;

use super::fields::Fields;

/// A numbered card and where it stands.
pub(super) struct Row<T> {
    id: Id,
    name: &'static str,
    file: u32,
    line: u32,
    value: T,
}

/// Numbered cards in the order of the file. They are sorted once at the end: decks are nearly sorted, and maps grow
/// slowly.
pub(super) type Rows<T> = Vec<Row<T>>;

/// Adds a card unless one of its fields could not be read.
pub(super) fn keep<T>(rows: &mut Rows<T>, name: &'static str, (id, value): (Id, T), f: &Fields<'_>) {
    if !f.failed {
        rows.push(Row {
            id,
            name,
            file: f.card.file,
            line: f.card.line,
            value,
        });
    }
}

/// Adds what a card with several numbers holds.
pub(super) fn keep_all<T>(rows: &mut Rows<T>, name: &'static str, values: Vec<(Id, T)>, f: &Fields<'_>) {
    for value in values {
        keep(rows, name, value, f);
    }
}

impl<T> Row<T> {
    pub(super) fn id(&self) -> Id {
        self.id
    }
}

pub(super) struct Merge<'a> {
    pub(super) origins: Origins,
    pub(super) remarks: &'a mut Remarks,
}

impl Merge<'_> {
    pub(super) fn map<T: PartialEq>(&mut self, rows: Rows<T>) -> BTreeMap<Id, T> {
        self.map_with(rows, |value| value)
    }

    /// The map of the finished values. The first card of a number counts: solvers take identical copies, and refuse
    /// others.
    pub(super) fn map_with<T: PartialEq, U>(
        &mut self,
        mut rows: Rows<T>,
        finish: impl Fn(T) -> U,
    ) -> BTreeMap<Id, U> {
        rows.sort_by_key(|row| row.id);
        for run in rows.chunk_by(|a, b| a.name == b.name) {
            if let Some(first) = run.first() {
                self.origins
                    .extend(first.name, run.iter().map(|row| (row.id, row.file, row.line)));
            }
        }
        rows.dedup_by(|later, first| {
            let twice = later.id == first.id;
            if twice {
                self.twice(first.id, first.name, later.name, later.value == first.value);
            }
            twice
        });
        rows.into_iter().map(|row| (row.id, finish(row.value))).collect()
    }

    #[cold]
    fn twice(&mut self, id: Id, first: &str, later: &str, same: bool) {
        let mut origins: Vec<_> = self.origins.all(first, id).collect();
        if later != first {
            origins.extend(self.origins.all(later, id));
        }
        let places: Vec<String> = origins.iter().map(ToString::to_string).collect();
        let Some(origin) = origins.last() else { return };
        let (severity, how) = if same {
            (Severity::Warning, "identical; one is kept")
        } else {
            (Severity::Error, "different; renumber or remove one")
        };
        self.remarks.push(
            severity,
            &origin.file,
            origin.line,
            format!("{later} {id}"),
            format!(
                "the number is given {} times, {how} ({})",
                places.len(),
                places.join(", ")
            ),
        );
    }
}
