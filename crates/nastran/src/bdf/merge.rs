//! Numbered cards by number, with a remark on every number that is given twice.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use crate::deck::{Id, Origins};
use crate::error::Severity;
use crate::remarks::Remarks;

use super::fields::Fields;

/// Number, file and line.
type Place = (Id, u32, u32);

/// Cards of one kind. They go straight into the map: for large decks most time is spent on fresh memory, so there is
/// no list between.
#[derive(Debug)]
pub(super) struct Table<T> {
    map: BTreeMap<Id, T>,
    /// For each card name: number, file and line.
    places: Vec<(&'static str, Vec<Place>)>,
    /// Numbers given again: card name, and whether the card is the same.
    twice: Vec<(&'static str, Id, bool)>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self {
            map: BTreeMap::new(),
            places: Vec::new(),
            twice: Vec::new(),
        }
    }
}

impl<T: PartialEq> Table<T> {
    /// Adds a card unless one of its fields could not be read. The first card of a number counts: solvers take
    /// identical copies, and refuse others.
    pub(super) fn keep(&mut self, name: &'static str, card: (Id, T), f: &Fields<'_>) {
        self.is_kept(name, card, f);
    }

    /// Like [`keep`](Self::keep); true if the card was added.
    pub(super) fn is_kept(&mut self, name: &'static str, (id, value): (Id, T), f: &Fields<'_>) -> bool {
        if f.failed {
            return false;
        }
        let place = (id, f.card.file, f.card.line);
        match self.places.iter_mut().find(|(n, _)| *n == name) {
            Some((_, places)) => places.push(place),
            None => self.places.push((name, vec![place])),
        }
        match self.map.entry(id) {
            Entry::Vacant(entry) => {
                entry.insert(value);
                true
            }
            Entry::Occupied(first) => {
                self.twice.push((name, id, *first.get() == value));
                false
            }
        }
    }

    /// Adds what a card with several numbers holds.
    pub(super) fn keep_all(&mut self, name: &'static str, values: Vec<(Id, T)>, f: &Fields<'_>) {
        for value in values {
            self.keep(name, value, f);
        }
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = Id> {
        self.map.keys().copied()
    }

    /// Access to a card that was kept.
    pub(super) fn get_mut(&mut self, id: Id) -> Option<&mut T> {
        self.map.get_mut(&id)
    }

    /// The map; places go to `origins`, remarks on numbers given twice to `remarks`.
    pub(super) fn finish(self, origins: &mut Origins, remarks: &mut Remarks) -> BTreeMap<Id, T> {
        let names: Vec<&'static str> = self.places.iter().map(|(name, _)| *name).collect();
        for (name, mut places) in self.places {
            places.sort_by_key(|place| place.0);
            origins.insert(name, places);
        }
        let mut twice = self.twice;
        twice.dedup_by_key(|t| t.1);
        for (name, id, same) in twice {
            let all: Vec<_> = names.iter().flat_map(|n| origins.all(n, id)).collect();
            let places: Vec<String> = all.iter().map(ToString::to_string).collect();
            let Some(origin) = origins.all(name, id).last() else {
                continue;
            };
            let (severity, how) = if same {
                (Severity::Warning, "identical; one is kept")
            } else {
                (Severity::Error, "different; renumber or remove one")
            };
            remarks.push(
                severity,
                &origin.file,
                origin.line,
                format!("{name} {id}"),
                format!(
                    "the number is given {} times, {how} ({})",
                    places.len(),
                    places.join(", ")
                ),
            );
        }
        self.map
    }
}
