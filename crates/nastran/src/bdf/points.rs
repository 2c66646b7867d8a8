//! GRID, GRDSET, SPOINT and coordinate systems.

use crate::deck::{CoordinateDefinition, CoordinateKind, CoordinateSystem, Grdset, Grid, Id};
use crate::error::Severity;

use super::fields::Fields;

/// Which fields of a GRID were blank and take GRDSET's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GridBlanks {
    cp: bool,
    cd: bool,
    ps: bool,
    seid: bool,
}

impl GridBlanks {
    pub(super) fn apply(self, defaults: &Grdset, grid: &mut Grid) {
        if self.cp {
            grid.cp = defaults.cp;
        }
        if self.cd {
            grid.cd = defaults.cd;
        }
        if self.ps {
            grid.ps = defaults.ps;
        }
        if self.seid {
            grid.seid = defaults.seid;
        }
    }
}

pub(super) fn grid(f: &mut Fields<'_>) -> (Id, (Grid, GridBlanks)) {
    let blanks = GridBlanks {
        cp: f.is_blank(2),
        cd: f.is_blank(6),
        ps: f.is_blank(7),
        seid: f.is_blank(8),
    };
    let fluid = f.text(6) == b"-1";
    let grid = Grid {
        id: f.id(1, "ID"),
        cp: f.id_or_zero(2, "CP").unwrap_or(0),
        position: [
            f.real_or(3, "X1", 0.0),
            f.real_or(4, "X2", 0.0),
            f.real_or(5, "X3", 0.0),
        ],
        cd: if fluid {
            0
        } else {
            f.id_or_zero(6, "CD").unwrap_or(0)
        },
        fluid,
        ps: f.components(7, "PS"),
        seid: f.id_or_zero(8, "SEID").unwrap_or(0),
    };
    f.ends_at(8);
    (grid.id, (grid, blanks))
}

pub(super) fn grdset(f: &mut Fields<'_>) -> Grdset {
    Grdset {
        cp: f.id_or_zero(2, "CP").unwrap_or(0),
        cd: f.id_or_zero(6, "CD").unwrap_or(0),
        ps: f.components(7, "PS"),
        seid: f.id_or_zero(8, "SEID").unwrap_or(0),
    }
}

/// CORD1R, CORD1C, CORD1S: two systems on a card.
pub(super) fn cord1(f: &mut Fields<'_>, kind: CoordinateKind) -> Vec<(Id, CoordinateSystem)> {
    let mut systems = Vec::with_capacity(2);
    for n in [1, 5] {
        if n == 5 && (5..=8).all(|k| f.is_blank(k)) {
            break;
        }
        let id = f.id(n, "CID");
        let grids = [f.id(n + 1, "G1"), f.id(n + 2, "G2"), f.id(n + 3, "G3")];
        systems.push((
            id,
            CoordinateSystem {
                id,
                kind,
                definition: CoordinateDefinition::Grids { grids },
            },
        ));
    }
    f.ends_at(8);
    systems
}

/// CORD2R, CORD2C, CORD2S.
pub(super) fn cord2(f: &mut Fields<'_>, kind: CoordinateKind) -> (Id, CoordinateSystem) {
    let id = f.id(1, "CID");
    let definition = CoordinateDefinition::Points {
        reference: f.id_or_zero(2, "RID").unwrap_or(0),
        a: f.vector(3, "A"),
        b: f.vector(6, "B"),
        c: f.vector(9, "C"),
    };
    if f.card.last() < 9 {
        f.remark(
            Severity::Warning,
            "has no point C (its continuation may be missing); read as 0, 0, 0",
        );
    }
    f.ends_at(11);
    (id, CoordinateSystem { id, kind, definition })
}
