//! Numbering of freedoms: six for each grid, one for each scalar point, in ascending point number.

use crate::error::Error;
use albatross_nastran::Deck;
use albatross_nastran::deck::Id;
use std::collections::BTreeMap;

/// A point and its freedoms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Point {
    /// Number.
    pub id: Id,
    /// Index of the first freedom.
    pub first: usize,
    /// A scalar point has one freedom, a grid six.
    pub is_scalar: bool,
}

/// The freedoms of a model before constraints (the g-set).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Freedoms {
    points: Vec<Point>,
    index: BTreeMap<Id, usize>,
    count: usize,
}

impl Freedoms {
    /// Numbers the freedoms of a deck.
    ///
    /// # Errors
    /// [`Error::BadElement`] for a number that a grid and a scalar point share.
    pub(crate) fn of(deck: &Deck) -> Result<Self, Error> {
        // By the numbers of the grids, not the keys of the map: a deck made by hand may differ in them.
        let twice = deck.grids.values().find(|g| deck.scalar_points.contains(&g.id));
        if let Some(id) = twice.map(|g| g.id) {
            return Err(Error::BadElement {
                card: format!("SPOINT {id}"),
                problem: "is a GRID of the deck too; give one of them another number".into(),
            });
        }
        let structural = deck.grids.values().filter(|g| !g.fluid).map(|g| (g.id, false));
        let all: BTreeMap<Id, bool> = structural
            .chain(deck.scalar_points.iter().map(|&id| (id, true)))
            .collect();
        let mut freedoms = Self::default();
        for (id, is_scalar) in all {
            freedoms.index.insert(id, freedoms.points.len());
            freedoms.points.push(Point {
                id,
                first: freedoms.count,
                is_scalar,
            });
            freedoms.count += if is_scalar { 1 } else { 6 };
        }
        Ok(freedoms)
    }

    /// Points in ascending number.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Number of freedoms.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// A point by number.
    #[must_use]
    pub fn point(&self, id: Id) -> Option<Point> {
        self.points.get(*self.index.get(&id)?).copied()
    }

    /// Index of a freedom: component 1 to 6 of a grid, 0 or 1 of a scalar point.
    #[must_use]
    pub fn index(&self, id: Id, component: u8) -> Option<usize> {
        let point = self.point(id)?;
        match (point.is_scalar, component) {
            (true, 0 | 1) => Some(point.first),
            (false, 1..=6) => Some(point.first + usize::from(component) - 1),
            _ => None,
        }
    }

    /// The point of a freedom and its component, 0 for a scalar point.
    #[must_use]
    pub fn of_index(&self, freedom: usize) -> Option<(Id, u8)> {
        let after = self.points.partition_point(|p| p.first <= freedom);
        let point = self.points.get(after.checked_sub(1)?)?;
        match (freedom - point.first, point.is_scalar) {
            (0, true) => Some((point.id, 0)),
            (k @ 0..=5, false) => Some((point.id, k as u8 + 1)),
            _ => None,
        }
    }

    /// A freedom for messages: `grid 12 R1`, `scalar point 7`.
    #[must_use]
    pub fn name(&self, freedom: usize) -> String {
        const NAMES: [&str; 6] = ["T1", "T2", "T3", "R1", "R2", "R3"];
        match self.of_index(freedom) {
            Some((id, 0)) => format!("scalar point {id}"),
            Some((id, k)) => format!("grid {id} {}", NAMES.get(usize::from(k) - 1).unwrap_or(&"?")),
            None => format!("freedom {freedom}"),
        }
    }
}
