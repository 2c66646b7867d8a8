//! Rigid elements, constraints, sets, eigenvalue methods and parameters.

use crate::deck::{
    Components, DofSet, Eigr, Eigrl, Id, Mpc, MpcTerm, Param, Rbar, Rbe2, Rbe3, Rbe3Group, Set1, Spc, Spc1,
    Suport,
};
use crate::error::Severity;
use crate::number;

use super::fields::Fields;
use super::lists::NeedsPoints;

/// RBE2: the list of dependents may end with a real, the thermal expansion coefficient.
pub(super) fn rbe2(f: &mut Fields<'_>, points: Option<&[Id]>) -> Result<(Id, Rbe2), NeedsPoints> {
    let id = f.id(1, "EID");
    let mut last = f.card.last();
    let mut expansion = None;
    if last > 4 && number::looks_real(f.text(last)) {
        expansion = f.real(last, "ALPHA");
        last -= 1;
    }
    let element = Rbe2 {
        id,
        independent: f.id(2, "GN"),
        components: f.components(3, "CM"),
        dependents: f.list(4, last, points)?,
        expansion,
    };
    if element.dependents.is_empty() && !f.failed {
        f.wrong(4, "GM1", "at least one dependent grid");
    }
    Ok((id, element))
}

/// RBE3: groups of weight, components and grids in one run of fields, then UM pairs and ALPHA. A weight is told from
/// a grid by its point.
pub(super) fn rbe3(f: &mut Fields<'_>, points: Option<&[Id]>) -> Result<(Id, Rbe3), NeedsPoints> {
    let id = f.id(1, "EID");
    let mut element = Rbe3 {
        id,
        reference: f.id(3, "REFGRID"),
        components: f.components(4, "REFC"),
        groups: Vec::new(),
        um: Vec::new(),
        expansion: None,
    };
    let last = f.card.last();
    let is_word = |f: &Fields<'_>, n: usize| f.text(n).first().is_some_and(u8::is_ascii_alphabetic);
    let mut n = 5;
    while n <= last && !f.failed {
        if f.is_blank(n) {
            n += 1;
            continue;
        }
        match f.word(n).as_str() {
            "UM" => {
                n += 1;
                while n < last && !is_word(f, n) && !f.failed {
                    if f.is_blank(n) {
                        n += 1;
                        continue;
                    }
                    element.um.push((f.id(n, "GM"), f.components(n + 1, "CM")));
                    n += 2;
                }
            }
            "ALPHA" => {
                element.expansion = f.real(n + 1, "ALPHA");
                n += 2;
            }
            _ => {
                let weight = f.required_real(n, "WT");
                let components = f.components(n + 1, "C");
                // The group's grids end at the next weight or keyword; THRU is part of the list.
                let begins_other = |f: &Fields<'_>, n: usize| {
                    number::looks_real(f.text(n)) || matches!(f.word(n).as_str(), "UM" | "ALPHA")
                };
                let first = n + 2;
                n = first;
                while n <= last && !begins_other(f, n) {
                    n += 1;
                }
                let grids = f.list(first, n - 1, points)?;
                element.groups.push(Rbe3Group {
                    weight,
                    components,
                    grids,
                });
            }
        }
    }
    Ok((id, element))
}

pub(super) fn rbar(f: &mut Fields<'_>) -> (Id, Rbar) {
    let id = f.id(1, "EID");
    let element = Rbar {
        id,
        grids: [f.id(2, "GA"), f.id(3, "GB")],
        independent: [f.components(4, "CNA"), f.components(5, "CNB")],
        dependent: [f.components(6, "CMA"), f.components(7, "CMB")],
        expansion: f.real(8, "ALPHA"),
    };
    f.ends_at(8);
    (id, element)
}

/// MPC: two terms on a line, in fields 2 to 4 and 5 to 7.
pub(super) fn mpc(f: &mut Fields<'_>) -> Mpc {
    let sid = f.id(1, "SID");
    let mut terms = Vec::new();
    for line in (0..f.card.len()).step_by(8) {
        for n in [line + 2, line + 5] {
            if (n..n + 3).all(|k| f.is_blank(k)) {
                continue;
            }
            terms.push(MpcTerm {
                point: f.id(n, "G"),
                component: f.component(n + 1, "C"),
                coefficient: f.required_real(n + 2, "A"),
            });
        }
    }
    Mpc { sid, terms }
}

/// SPC: two points on a card.
pub(super) fn spc(f: &mut Fields<'_>) -> Vec<Spc> {
    let sid = f.id(1, "SID");
    let mut constraints = Vec::with_capacity(2);
    for n in [2, 5] {
        if n == 5 && (5..=7).all(|k| f.is_blank(k)) {
            break;
        }
        constraints.push(Spc {
            sid,
            point: f.id(n, "G"),
            components: f.components(n + 1, "C"),
            enforced: f.real_or(n + 2, "D", 0.0),
        });
    }
    f.ends_at(7);
    constraints
}

pub(super) fn spc1(f: &mut Fields<'_>, points: Option<&[Id]>) -> Result<Spc1, NeedsPoints> {
    let last = f.card.last();
    Ok(Spc1 {
        sid: f.id(1, "SID"),
        components: f.components(2, "C"),
        points: f.list(3, last, points)?,
    })
}

/// Pairs of point and components from field `n` to the end.
fn pairs(f: &mut Fields<'_>, n: usize) -> Vec<(Id, Components)> {
    let mut pairs = Vec::new();
    for at in (n..=f.card.last()).step_by(2) {
        if !(f.is_blank(at) && f.is_blank(at + 1)) {
            pairs.push((f.id(at, "ID"), f.components(at + 1, "C")));
        }
    }
    pairs
}

pub(super) fn suport(f: &mut Fields<'_>) -> Vec<Suport> {
    pairs(f, 1)
        .into_iter()
        .map(|(point, components)| Suport {
            sid: None,
            point,
            components,
        })
        .collect()
}

pub(super) fn suport1(f: &mut Fields<'_>) -> Vec<Suport> {
    let sid = Some(f.id(1, "SID"));
    pairs(f, 2)
        .into_iter()
        .map(|(point, components)| Suport {
            sid,
            point,
            components,
        })
        .collect()
}

/// ASET, OMIT.
pub(super) fn dof_pairs(f: &mut Fields<'_>) -> Vec<DofSet> {
    pairs(f, 1)
        .into_iter()
        .map(|(point, components)| DofSet {
            components,
            points: vec![point],
        })
        .collect()
}

/// ASET1, OMIT1.
pub(super) fn dof_list(f: &mut Fields<'_>, points: Option<&[Id]>) -> Result<DofSet, NeedsPoints> {
    let last = f.card.last();
    Ok(DofSet {
        components: f.components(1, "C"),
        points: f.list(2, last, points)?,
    })
}

pub(super) fn set1(f: &mut Fields<'_>, points: Option<&[Id]>) -> Result<(Id, Set1), NeedsPoints> {
    let id = f.id(1, "SID");
    let skin = f.word(2) == "SKIN";
    let last = f.card.last();
    let members = f.list(if skin { 3 } else { 2 }, last, points)?;
    Ok((id, Set1 { id, skin, members }))
}

pub(super) fn eigr(f: &mut Fields<'_>) -> (Id, Eigr) {
    let id = f.id(1, "SID");
    let method = Eigr {
        id,
        method: f.word(2),
        lower_hz: f.real(3, "F1"),
        upper_hz: f.real(4, "F2"),
        estimated: f.integer(5, "NE"),
        desired: f.integer(6, "ND"),
        zero_roots: f.integer(7, "NZ"),
        criterion: f.real(8, "E"),
        normalization: f.word(9),
        point: f.id_or_zero(10, "G").filter(|&g| g > 0),
        component: Some(f.component(11, "C")).filter(|&c| c > 0),
    };
    f.ends_at(11);
    (id, method)
}

pub(super) fn eigrl(f: &mut Fields<'_>) -> (Id, Eigrl) {
    let id = f.id(1, "SID");
    let method = Eigrl {
        id,
        lower_hz: f.real(2, "V1"),
        upper_hz: f.real(3, "V2"),
        desired: f.integer(4, "ND"),
        message_level: f.integer(5, "MSGLVL"),
        block_size: f.integer(6, "MAXSET"),
        shift_hz: f.real(7, "SHFSCL"),
        normalization: f.word(8),
        options: (9..=f.card.last()).map(|n| f.word(n)).collect(),
    };
    (id, method)
}

pub(super) fn param(f: &mut Fields<'_>) -> Param {
    if f.is_blank(1) {
        f.remark(Severity::Error, "has no name; expected PARAM,name,value");
    }
    Param {
        name: f.word(1),
        value: f.word(2),
        imaginary: f.word(3),
    }
}
