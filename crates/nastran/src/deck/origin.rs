//! Where a card stood: file and line, kept beside the deck so that later stages can name it in their errors.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Id;

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Origin {
    /// File as it was named to the reader or in the INCLUDE statement.
    pub file: Arc<str>,
    /// Line, from 1.
    pub line: u32,
}

impl std::fmt::Display for Origin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

/// Places of all numbered cards of a deck. Two decks that say the same from different places are equal, so this
/// type compares equal to any other.
#[derive(Debug, Clone, Default)]
pub struct Origins {
    files: Vec<Arc<str>>,
    /// For each card name: number, file index and line, sorted by number.
    places: BTreeMap<&'static str, Vec<(Id, u32, u32)>>,
}

impl PartialEq for Origins {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Origins {
    pub(crate) fn new(files: Vec<Arc<str>>) -> Self {
        Self {
            files,
            places: BTreeMap::new(),
        }
    }

    /// Names of the files that the deck was read from: the main file, then included ones as they were met.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(AsRef::as_ref)
    }

    /// Sets the places of a card name, in ascending order of number.
    pub(crate) fn insert(&mut self, name: &'static str, places: Vec<(Id, u32, u32)>) {
        self.places.insert(name, places);
    }

    /// All places of the card `name` with number `id`, in file order.
    pub fn all(&self, name: &str, id: Id) -> impl Iterator<Item = Origin> {
        let places = self.places.get(name).map_or(&[][..], Vec::as_slice);
        let from = places.partition_point(|p| p.0 < id);
        let upto = places.partition_point(|p| p.0 <= id);
        places
            .get(from..upto)
            .unwrap_or_default()
            .iter()
            .filter_map(|&(_, file, line)| {
                Some(Origin {
                    file: Arc::clone(self.files.get(usize::try_from(file).ok()?)?),
                    line,
                })
            })
    }

    /// Where the card `name` (such as `"CBAR"`) with number `id` stands.
    #[must_use]
    pub fn of(&self, name: &str, id: Id) -> Option<Origin> {
        self.all(name, id).next()
    }
}
