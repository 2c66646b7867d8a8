//! Elements: CBAR, CBEAM, CROD, CONROD, CONM1, CONM2, CMASSi, CELASi, CBUSH.

use std::borrow::Cow;

use crate::deck::{
    Cbar, Cbeam, Cbush, Celas, Cmass, Conm1, Conm2, Conm2Frame, Conrod, Crod, Id, Orientation, ScalarEnd,
    ScalarMassValue, ScalarSpringValue,
};
use crate::number;

use super::fields::Fields;

/// Defaults for blank fields of CBAR or CBEAM (BAROR, BEAMOR).
#[derive(Debug, Clone, Default)]
pub(super) struct BarDefaults {
    pub(super) pid: Option<Id>,
    pub(super) orientation: Option<Orientation>,
    pub(super) offset_frames: Option<Cow<'static, str>>,
}

impl BarDefaults {
    pub(super) fn is_empty(&self) -> bool {
        self.pid.is_none() && self.orientation.is_none() && self.offset_frames.is_none()
    }

    /// Fills what the card left blank.
    pub(super) fn apply(
        &self,
        blanks: BarBlanks,
        pid: &mut Id,
        orientation: &mut Option<Orientation>,
        offset_frames: &mut Cow<'static, str>,
    ) {
        if let Some(default) = self.pid.filter(|_| blanks.pid) {
            *pid = default;
        }
        if orientation.is_none() {
            orientation.clone_from(&self.orientation);
        }
        if let Some(frames) = self.offset_frames.as_ref().filter(|_| blanks.offset_frames) {
            offset_frames.clone_from(frames);
        }
    }
}

/// Which fields of a bar were blank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BarBlanks {
    pub(super) pid: bool,
    pub(super) offset_frames: bool,
}

pub(super) fn bar_defaults(f: &mut Fields<'_>) -> BarDefaults {
    let (orientation, frames) = bar_orientation(f);
    BarDefaults {
        pid: f.optional_id(2, "PID"),
        orientation,
        offset_frames: frames,
    }
}

/// A vector in three fields or a grid in the first. A grid is an integer alone.
fn orientation(f: &mut Fields<'_>, n: usize) -> Option<Orientation> {
    if (n..n + 3).all(|k| f.is_blank(k)) {
        return None;
    }
    let grid_alone = f.is_blank(n + 1) && f.is_blank(n + 2) && number::integer(f.text(n)).is_some();
    Some(if grid_alone {
        Orientation::Grid(f.id(n, "G0"))
    } else {
        Orientation::Vector(f.vector(n, "X"))
    })
}

/// Orientation and OFFT of a CBAR. NASTRAN-95 has a flag in place of OFFT: 1 for a vector, 2 for a grid.
fn bar_orientation(f: &mut Fields<'_>) -> (Option<Orientation>, Option<Cow<'static, str>>) {
    match f.text(8) {
        b"1" => (Some(Orientation::Vector(f.vector(5, "X"))), None),
        b"2" => (Some(Orientation::Grid(f.id(5, "G0"))), None),
        b"" => (orientation(f, 5), None),
        _ => (orientation(f, 5), Some(Cow::Owned(f.word(8)))),
    }
}

pub(super) fn cbar(f: &mut Fields<'_>) -> (Id, (Cbar, BarBlanks)) {
    let id = f.id(1, "EID");
    let (orientation, frames) = bar_orientation(f);
    let blanks = BarBlanks {
        pid: f.is_blank(2),
        offset_frames: frames.is_none(),
    };
    let bar = Cbar {
        id,
        pid: f.optional_id(2, "PID").unwrap_or(id),
        grids: [f.id(3, "GA"), f.id(4, "GB")],
        orientation,
        offset_frames: frames.unwrap_or(Cow::Borrowed("GGG")),
        pins: [f.components(9, "PA"), f.components(10, "PB")],
        wa: f.vector(11, "WA"),
        wb: f.vector(14, "WB"),
    };
    f.ends_at(16);
    (id, (bar, blanks))
}

pub(super) fn cbeam(f: &mut Fields<'_>) -> (Id, (Cbeam, BarBlanks)) {
    let id = f.id(1, "EID");
    // OFFT is a word, BIT a number.
    let bit = number::real(f.text(8));
    let frames = if f.is_blank(8) || bit.is_some() {
        None
    } else {
        Some(Cow::Owned(f.word(8)))
    };
    let blanks = BarBlanks {
        pid: f.is_blank(2),
        offset_frames: frames.is_none(),
    };
    let beam = Cbeam {
        id,
        pid: f.optional_id(2, "PID").unwrap_or(id),
        grids: [f.id(3, "GA"), f.id(4, "GB")],
        orientation: orientation(f, 5),
        offset_frames: frames.unwrap_or(Cow::Borrowed("GGG")),
        bit,
        pins: [f.components(9, "PA"), f.components(10, "PB")],
        wa: f.vector(11, "WA"),
        wb: f.vector(14, "WB"),
        warping: [
            f.id_or_zero(17, "SA").unwrap_or(0),
            f.id_or_zero(18, "SB").unwrap_or(0),
        ],
    };
    f.ends_at(18);
    (id, (beam, blanks))
}

pub(super) fn crod(f: &mut Fields<'_>) -> (Id, Crod) {
    let id = f.id(1, "EID");
    let pid = f.optional_id(2, "PID").unwrap_or(id);
    let rod = Crod {
        id,
        pid,
        grids: [f.id(3, "G1"), f.id(4, "G2")],
    };
    f.ends_at(4);
    (id, rod)
}

pub(super) fn conrod(f: &mut Fields<'_>) -> (Id, Conrod) {
    let id = f.id(1, "EID");
    let rod = Conrod {
        id,
        grids: [f.id(2, "G1"), f.id(3, "G2")],
        mid: f.id(4, "MID"),
        area: f.real_or(5, "A", 0.0),
        torsion_constant: f.real_or(6, "J", 0.0),
        stress_coefficient: f.real_or(7, "C", 0.0),
        nsm: f.real_or(8, "NSM", 0.0),
    };
    f.ends_at(8);
    (id, rod)
}

/// The card holds the lower triangle row by row.
pub(super) fn conm1(f: &mut Fields<'_>) -> (Id, Conm1) {
    let id = f.id(1, "EID");
    let (grid, cid) = (f.id(2, "G"), f.id_or_zero(3, "CID").unwrap_or(0));
    let lower: [f64; 21] = std::array::from_fn(|k| f.real_or(4 + k, "M", 0.0));
    let term = |i: usize, j: usize| {
        let k = i.max(j) * (i.max(j) + 1) / 2 + i.min(j);
        lower.get(k).copied().unwrap_or(0.0)
    };
    let mass = std::array::from_fn(|i| std::array::from_fn(|j| term(i, j)));
    f.ends_at(24);
    (id, Conm1 { id, grid, cid, mass })
}

pub(super) fn conm2(f: &mut Fields<'_>) -> (Id, Conm2) {
    let id = f.id(1, "EID");
    let frame = if f.text(3) == b"-1" {
        Conm2Frame::BasicPosition
    } else {
        Conm2Frame::System(f.id_or_zero(3, "CID").unwrap_or(0))
    };
    let mass = Conm2 {
        id,
        grid: f.id(2, "G"),
        frame,
        mass: f.real_or(4, "M", 0.0),
        offset: f.vector(5, "X"),
        inertia: [9, 10, 11, 12, 13, 14].map(|n| f.real_or(n, "I", 0.0)),
    };
    f.ends_at(14);
    (id, mass)
}

/// CMASS1 to CMASS4: `by_property` for 1 and 3, `points_only` for 3 and 4.
pub(super) fn cmass(f: &mut Fields<'_>, by_property: bool, points_only: bool) -> (Id, Cmass) {
    let id = f.id(1, "EID");
    let value = if by_property {
        ScalarMassValue::Property(f.optional_id(2, "PID").unwrap_or(id))
    } else {
        ScalarMassValue::Value(f.required_real(2, "M"))
    };
    let ends = if points_only {
        [3, 4].map(|n| ScalarEnd {
            point: f.id_or_zero(n, "S").unwrap_or(0),
            component: 0,
        })
    } else {
        [f.scalar_end(3), f.scalar_end(5)]
    };
    f.ends_at(if points_only { 4 } else { 6 });
    (
        id,
        Cmass {
            id,
            value,
            ends,
            scalar_points_only: points_only,
        },
    )
}

/// PMASS: up to four properties on a card.
pub(super) fn pmass(f: &mut Fields<'_>) -> Vec<(Id, f64)> {
    let given = |f: &Fields<'_>, n: usize| !(f.is_blank(n) && f.is_blank(n + 1));
    let mut properties = Vec::with_capacity(4);
    for n in [1, 3, 5, 7] {
        if n == 1 || given(f, n) {
            properties.push((f.id(n, "PID"), f.required_real(n + 1, "M")));
        }
    }
    properties
}

pub(super) fn celas1(f: &mut Fields<'_>) -> (Id, Celas) {
    let id = f.id(1, "EID");
    let value = ScalarSpringValue::Property(f.optional_id(2, "PID").unwrap_or(id));
    let spring = Celas {
        id,
        value,
        ends: [f.scalar_end(3), f.scalar_end(5)],
    };
    f.ends_at(6);
    (id, spring)
}

pub(super) fn celas2(f: &mut Fields<'_>) -> (Id, Celas) {
    let id = f.id(1, "EID");
    let value = ScalarSpringValue::Value {
        k: f.required_real(2, "K"),
        ge: f.real_or(7, "GE", 0.0),
        s: f.real_or(8, "S", 0.0),
    };
    let spring = Celas {
        id,
        value,
        ends: [f.scalar_end(3), f.scalar_end(5)],
    };
    f.ends_at(8);
    (id, spring)
}

pub(super) fn cbush(f: &mut Fields<'_>) -> (Id, Cbush) {
    let id = f.id(1, "EID");
    let bush = Cbush {
        id,
        pid: f.optional_id(2, "PID").unwrap_or(id),
        grids: [f.id(3, "GA"), f.id_or_zero(4, "GB").unwrap_or(0)],
        orientation: orientation(f, 5),
        cid: f.id_or_zero(8, "CID"),
        location: f.real_or(9, "S", 0.5),
        offset_cid: if f.text(10) == b"-1" {
            None
        } else {
            f.id_or_zero(10, "OCID")
        },
        offset: f.vector(11, "S1"),
    };
    f.ends_at(13);
    (id, bush)
}
