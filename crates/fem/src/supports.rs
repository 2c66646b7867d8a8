//! Rigid directions that the supports of a deck leave free.

use albatross_nastran::Deck;
use albatross_nastran::deck::{Components, Id};
use albatross_nastran::frames::Frames;
use nalgebra::Vector3;
use std::collections::BTreeSet;

use crate::rigid::rigid_transfer;

/// Which of the six rigid motions about `center` move no constrained freedom (PS of GRID, and the SPC set that case
/// control selects for `subcase`). A half model on its plane of symmetry keeps x, z and pitch; a clamped wing keeps
/// nothing.
#[must_use]
pub fn free_directions(deck: &Deck, frames: &Frames, center: [f64; 3], subcase: Option<u32>) -> [bool; 6] {
    let mut free = [true; 6];
    let center = Vector3::from(center);
    for (id, components) in constrained(deck, subcase) {
        let Some(grid) = frames.grid(id) else { continue };
        let arm = grid.position - center;
        let motion = rigid_transfer(arm);
        for component in components.iter() {
            let index = usize::from(component) - 1;
            let direction = grid.axes.column(index % 3);
            // Rotations are pure numbers; translations due to rotation are compared with the arm.
            let first_row = if index < 3 { 0 } else { 3 };
            for (i, is_free) in free.iter_mut().enumerate() {
                let moved = motion.fixed_view::<3, 1>(first_row, i).dot(&direction).abs();
                let size = if i >= 3 && index < 3 { arm.norm() } else { 1.0 };
                *is_free &= moved <= 1e-9 * size.max(f64::MIN_POSITIVE);
            }
        }
    }
    free
}

pub(crate) fn constrained(deck: &Deck, subcase: Option<u32>) -> Vec<(Id, Components)> {
    let mut all: Vec<(Id, Components)> = deck
        .grids
        .values()
        .filter(|g| !g.ps.is_empty())
        .map(|g| (g.id, g.ps))
        .collect();
    let sets = selected_sets(deck, "SPC", subcase);
    all.extend(
        deck.spcs
            .iter()
            .filter(|s| sets.contains(&s.sid))
            .map(|s| (s.point, s.components)),
    );
    for spc1 in deck.spc1s.iter().filter(|s| sets.contains(&s.sid)) {
        all.extend(spc1.points.iter().map(|&p| (p, spc1.components)));
    }
    all
}

/// The sets of `command` (`SPC`, `MPC`) that are active: the subcase's own, or the one above the first subcase, with
/// the sets that an SPCADD or MPCADD adds. Without a subcase, the first one named. Empty if case control names none.
pub(crate) fn selected_sets(deck: &Deck, command: &str, subcase: Option<u32>) -> BTreeSet<Id> {
    let Some(set) = selected(deck, command, subcase) else {
        return BTreeSet::new();
    };
    let mut sets = BTreeSet::from([set]);
    let adding = format!("{command}ADD");
    for card in deck.raw.iter().filter(|c| c.name == adding) {
        let mut numbers = card.fields.iter().filter_map(|f| f.parse::<Id>().ok());
        if numbers.next() == Some(set) {
            sets.extend(numbers);
        }
    }
    sets
}

/// The number that case control gives to a command, such as `SPC = 3` or `METHOD = 10`.
pub(crate) fn selected(deck: &Deck, command: &str, subcase: Option<u32>) -> Option<Id> {
    let mut current = None;
    let mut common = None;
    let mut own = None;
    for line in &deck.case_control {
        let line = line.trim().to_ascii_uppercase();
        if let Some(number) = line.strip_prefix("SUBCASE") {
            current = number.trim().parse::<u32>().ok();
        } else if let Some((name, value)) = line.split_once('=')
            && name.split('(').next().unwrap_or_default().trim() == command
            && let Ok(set) = value.trim().parse::<Id>()
        {
            if current.is_none() {
                common = Some(set);
            } else if own.is_none() && (subcase.is_none() || current == subcase) {
                own = Some(set);
            }
        }
    }
    own.or(common)
}
