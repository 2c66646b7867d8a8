//! The cards, each in the field order of its reader.

use crate::deck::{
    BarProperty, BeamProperty, Cbar, Cbeam, Cbush, Celas, Cmass, Components, Conm1, Conm2, Conm2Frame,
    CoordinateDefinition, CoordinateKind, CoordinateSystem, Deck, DofSet, Eigr, Eigrl, Grid, Id, Mat1, Mpc,
    Orientation, Pbar, Pbarl, Pbeam, Pbeaml, Pbush, RawCard, Rbar, Rbe2, Rbe3, ScalarMassValue,
    ScalarSpringValue, Set1, Spc1, Suport,
};
use crate::error::Error;

use super::format::CardText;

type Written = Result<(), Error>;

/// All bulk data cards.
pub(super) fn bulk(deck: &Deck, out: &mut String) -> Written {
    for param in deck.params.values() {
        CardText::new("PARAM")
            .text(&param.name)
            .text(&param.value)
            .text(&param.imaginary)
            .write(out)?;
    }
    deck.eigr.values().try_for_each(|c| eigr(c).write(out))?;
    deck.eigrl.values().try_for_each(|c| eigrl(c).write(out))?;
    points(deck, out)?;
    elements(deck, out)?;
    properties(deck, out)?;
    deck.materials.values().try_for_each(|c| mat1(c).write(out))?;
    deck.rbe2.values().try_for_each(|c| rbe2(c).write(out))?;
    deck.rbe3.values().try_for_each(|c| rbe3(c).write(out))?;
    deck.rbars.values().try_for_each(|c| rbar(c).write(out))?;
    deck.mpcs.iter().try_for_each(|c| mpc(c).write(out))?;
    for c in &deck.spcs {
        CardText::new("SPC")
            .number(c.sid)
            .number(c.point)
            .number(c.components)
            .real(c.enforced)
            .write(out)?;
    }
    deck.spc1s.iter().try_for_each(|c| spc1(c).write(out))?;
    deck.suports.iter().try_for_each(|c| suport(c).write(out))?;
    deck.asets
        .iter()
        .try_for_each(|c| dof_set("ASET1", c).write(out))?;
    deck.omits
        .iter()
        .try_for_each(|c| dof_set("OMIT1", c).write(out))?;
    deck.sets.values().try_for_each(|c| set1(c).write(out))?;
    deck.raw.iter().try_for_each(|c| raw(c).write(out))
}

fn points(deck: &Deck, out: &mut String) -> Written {
    if let Some(d) = &deck.grdset {
        let card = CardText::new("GRDSET")
            .blank()
            .number(d.cp)
            .blanks(3)
            .number(d.cd)
            .number(d.ps);
        card.number(d.seid).write(out)?;
    }
    deck.coordinate_systems
        .values()
        .try_for_each(|c| coordinate_system(c).write(out))?;
    // With GRDSET a blank would take its value, so that zeros must be written.
    let zeros = deck.grdset.is_some();
    deck.grids.values().try_for_each(|c| grid(c, zeros).write(out))?;
    deck.scalar_points
        .iter()
        .try_for_each(|id| CardText::new("SPOINT").number(id).write(out))
}

fn grid(c: &Grid, zeros: bool) -> CardText {
    let shown = |id: Id| Some(id).filter(|&id| zeros || id != 0);
    let card = CardText::new("GRID")
        .number(c.id)
        .optional(shown(c.cp))
        .reals(&c.position);
    let card = if c.fluid {
        card.number(-1)
    } else {
        card.optional(shown(c.cd))
    };
    card.optional(Some(c.ps).filter(|ps| zeros || !ps.is_empty()))
        .optional(shown(c.seid))
}

fn coordinate_system(c: &CoordinateSystem) -> CardText {
    let letter = match c.kind {
        CoordinateKind::Rectangular => 'R',
        CoordinateKind::Cylindrical => 'C',
        CoordinateKind::Spherical => 'S',
    };
    match &c.definition {
        CoordinateDefinition::Grids { grids } => CardText::new(&format!("CORD1{letter}"))
            .number(c.id)
            .numbers(grids),
        CoordinateDefinition::Points {
            reference,
            a,
            b,
            c: point_c,
        } => CardText::new(&format!("CORD2{letter}"))
            .number(c.id)
            .number(reference)
            .reals(a)
            .reals(b)
            .reals(point_c),
    }
}

fn elements(deck: &Deck, out: &mut String) -> Written {
    let has = |name: &str| deck.raw.iter().any(|c| c.name == name);
    // Defaults for blank fields stand among the uninterpreted cards.
    let (bar_defaults, beam_defaults) = (has("BAROR"), has("BEAMOR"));
    deck.bars
        .values()
        .try_for_each(|c| cbar(c, bar_defaults).write(out))?;
    deck.beams
        .values()
        .try_for_each(|c| cbeam(c, beam_defaults).write(out))?;
    for c in deck.rods.values() {
        CardText::new("CROD")
            .number(c.id)
            .number(c.pid)
            .numbers(&c.grids)
            .write(out)?;
    }
    for c in deck.conrods.values() {
        let card = CardText::new("CONROD")
            .number(c.id)
            .numbers(&c.grids)
            .number(c.mid);
        card.real(c.area)
            .real(c.torsion_constant)
            .real(c.stress_coefficient)
            .real(c.nsm)
            .write(out)?;
    }
    deck.conm1.values().try_for_each(|c| conm1(c).write(out))?;
    deck.conm2.values().try_for_each(|c| conm2(c).write(out))?;
    deck.scalar_masses
        .values()
        .try_for_each(|c| cmass(c).write(out))?;
    deck.springs.values().try_for_each(|c| celas(c).write(out))?;
    deck.bushes.values().try_for_each(|c| cbush(c).write(out))
}

fn orientation(card: CardText, orientation: Option<&Orientation>) -> CardText {
    match orientation {
        Some(Orientation::Vector(v)) => card.reals(v),
        Some(Orientation::Grid(grid)) => card.number(grid).blanks(2),
        None => card.blanks(3),
    }
}

fn components(card: CardText, values: &[Components]) -> CardText {
    values
        .iter()
        .fold(card, |card, c| card.optional(Some(c).filter(|c| !c.is_empty())))
}

/// Offsets; blank if they are all zero.
fn offsets(card: CardText, wa: &[f64; 3], wb: &[f64; 3]) -> CardText {
    let all = wa.iter().chain(wb);
    if all.clone().all(|&w| w == 0.0) {
        card.blanks(6)
    } else {
        card.reals(all)
    }
}

fn cbar(c: &Cbar, with_defaults: bool) -> CardText {
    let card = CardText::new("CBAR").number(c.id).number(c.pid).numbers(&c.grids);
    let card = orientation(card, c.orientation.as_ref());
    let frames = Some(&c.offset_frames).filter(|f| with_defaults || *f != "GGG");
    offsets(components(card.optional(frames), &c.pins), &c.wa, &c.wb)
}

fn cbeam(c: &Cbeam, with_defaults: bool) -> CardText {
    let card = CardText::new("CBEAM")
        .number(c.id)
        .number(c.pid)
        .numbers(&c.grids);
    let card = orientation(card, c.orientation.as_ref());
    let frames = Some(&c.offset_frames).filter(|f| with_defaults || *f != "GGG");
    let card = match c.bit {
        Some(bit) => card.real(bit),
        None => card.optional(frames),
    };
    let card = offsets(components(card, &c.pins), &c.wa, &c.wb);
    if c.warping == [0, 0] {
        card
    } else {
        card.numbers(&c.warping)
    }
}

fn conm1(c: &Conm1) -> CardText {
    let card = CardText::new("CONM1").number(c.id).number(c.grid).number(c.cid);
    c.mass
        .iter()
        .enumerate()
        .fold(card, |card, (i, row)| card.reals(row.iter().take(i + 1)))
}

fn conm2(c: &Conm2) -> CardText {
    let card = CardText::new("CONM2").number(c.id).number(c.grid);
    let card = match c.frame {
        Conm2Frame::System(cid) => card.number(cid),
        Conm2Frame::BasicPosition => card.number(-1),
    };
    let card = card.real(c.mass).reals(&c.offset).blank();
    if c.inertia.iter().all(|&i| i == 0.0) {
        card
    } else {
        card.reals(&c.inertia)
    }
}

fn cmass(c: &Cmass) -> CardText {
    let card = CardText::new(c.card_name()).number(c.id);
    let card = match c.value {
        ScalarMassValue::Property(pid) => card.number(pid),
        ScalarMassValue::Value(m) => card.real(m),
    };
    c.ends.iter().fold(card, |card, end| {
        let card = card.number(end.point);
        if c.scalar_points_only {
            card
        } else {
            card.number(end.component)
        }
    })
}

fn celas(c: &Celas) -> CardText {
    let ends = |card| {
        c.ends
            .iter()
            .fold(card, |card: CardText, e| card.number(e.point).number(e.component))
    };
    match c.value {
        ScalarSpringValue::Property(pid) => ends(CardText::new("CELAS1").number(c.id).number(pid)),
        ScalarSpringValue::Value { k, ge, s } => ends(CardText::new("CELAS2").number(c.id).real(k))
            .real(ge)
            .real(s),
    }
}

fn cbush(c: &Cbush) -> CardText {
    let card = CardText::new("CBUSH")
        .number(c.id)
        .number(c.pid)
        .numbers(&c.grids);
    let card = orientation(card, c.orientation.as_ref()).optional(c.cid);
    card.real(c.location).optional(c.offset_cid).reals(&c.offset)
}

fn properties(deck: &Deck, out: &mut String) -> Written {
    for c in deck.bar_properties.values() {
        match c {
            BarProperty::Pbar(c) => pbar(c).write(out)?,
            BarProperty::Pbarl(c) => pbarl(c).write(out)?,
        }
    }
    for c in deck.beam_properties.values() {
        match c {
            BeamProperty::Pbeam(c) => pbeam(c).write(out)?,
            BeamProperty::Pbeaml(c) => pbeaml(c).write(out)?,
        }
    }
    for c in deck.rod_properties.values() {
        let card = CardText::new("PROD")
            .number(c.id)
            .number(c.mid)
            .real(c.area)
            .real(c.torsion_constant);
        card.real(c.stress_coefficient).real(c.nsm).write(out)?;
    }
    for c in deck.spring_properties.values() {
        CardText::new("PELAS")
            .number(c.id)
            .real(c.k)
            .real(c.ge)
            .real(c.s)
            .write(out)?;
    }
    for (id, mass) in &deck.mass_properties {
        CardText::new("PMASS").number(id).real(*mass).write(out)?;
    }
    deck.bush_properties
        .values()
        .try_for_each(|c| pbush(c).write(out))
}

fn pbar(c: &Pbar) -> CardText {
    let card = CardText::new("PBAR")
        .number(c.id)
        .number(c.mid)
        .real(c.area)
        .real(c.i1)
        .real(c.i2);
    let card = card.real(c.torsion_constant).real(c.nsm).blank();
    let points = c.stress_points.as_flattened();
    let no_tail = c.k1.is_none() && c.k2.is_none() && c.i12 == 0.0;
    if no_tail && points.iter().all(|&p| p == 0.0) {
        return card;
    }
    let card = card.reals(points);
    if no_tail {
        card
    } else {
        card.optional_real(c.k1).optional_real(c.k2).real(c.i12)
    }
}

fn pbarl(c: &Pbarl) -> CardText {
    let card = CardText::new("PBARL")
        .number(c.id)
        .number(c.mid)
        .text(&c.group)
        .number(c.section.shape);
    card.end_line().reals(&c.section.dims).real(c.nsm)
}

fn pbeam(c: &Pbeam) -> CardText {
    let mut card = CardText::new("PBEAM").number(c.id).number(c.mid);
    let tail = [
        &c.ends.shear_factors,
        &c.ends.shear_relief,
        &c.ends.nsi,
        &c.ends.warping,
    ];
    let centers = [&c.ends.nsm_center, &c.ends.neutral_axis];
    let has_tail = tail.iter().any(|p| p.iter().any(Option::is_some))
        || centers.iter().any(|p| p.iter().any(Option::is_some));
    for (k, s) in c.stations.iter().enumerate() {
        if k > 0 {
            card = card.text(&s.stress_output).real(s.x);
        }
        card = card.optional_reals(&[s.area, s.i1, s.i2, s.i12, s.torsion_constant, s.nsm]);
        // A line for stress points, blank if need be, wherever the next line could be taken for it.
        let last = k + 1 == c.stations.len();
        match &s.stress_points {
            Some(points) => card = card.optional_reals(points),
            None if s.stress_output == "YES" || k == 0 && last && has_tail => card = card.blanks(8),
            None => {}
        }
    }
    if has_tail {
        card = tail
            .into_iter()
            .fold(card, |card, pair| card.optional_reals(pair));
        card = centers
            .into_iter()
            .fold(card, |card, four| card.optional_reals(four));
    }
    card
}

fn pbeaml(c: &Pbeaml) -> CardText {
    let card = CardText::new("PBEAML").number(c.id).number(c.mid).text(&c.group);
    let card = card
        .optional(c.stations.first().map(|s| s.section.shape))
        .end_line();
    c.stations.iter().enumerate().fold(card, |card, (k, s)| {
        let card = if k == 0 {
            card
        } else {
            card.text(&s.stress_output).real(s.x)
        };
        card.reals(&s.section.dims).real(s.nsm)
    })
}

fn pbush(c: &Pbush) -> CardText {
    let lines = [
        ("K", &c.k),
        ("B", &c.b),
        ("GE", &c.ge),
        ("M", &c.m),
        ("RCV", &c.rcv),
    ];
    let given = lines
        .iter()
        .filter_map(|(keyword, values)| values.as_ref().map(|v| (*keyword, v)));
    let card = CardText::new("PBUSH").number(c.id);
    given.enumerate().fold(card, |card, (k, (keyword, values))| {
        let card = if k == 0 { card } else { card.blank() };
        card.text(keyword).optional_reals(values)
    })
}

fn mat1(c: &Mat1) -> CardText {
    let card = CardText::new("MAT1")
        .number(c.id)
        .optional_reals(&[c.e, c.g, c.nu])
        .real(c.rho);
    let card = card.optional_reals(&[c.expansion, c.reference_temperature, c.ge]);
    card.optional_reals(&c.stress_limits).optional(c.mcsid)
}

fn rbe2(c: &Rbe2) -> CardText {
    let card = CardText::new("RBE2")
        .number(c.id)
        .number(c.independent)
        .number(c.components);
    card.numbers(&c.dependents).optional_real(c.expansion)
}

fn rbe3(c: &Rbe3) -> CardText {
    let card = CardText::new("RBE3")
        .number(c.id)
        .blank()
        .number(c.reference)
        .number(c.components);
    let mut card = c.groups.iter().fold(card, |card, group| {
        card.real(group.weight)
            .number(group.components)
            .numbers(&group.grids)
    });
    for (k, pairs) in c.um.chunks(3).enumerate() {
        card = card.end_line();
        card = if k == 0 { card.text("UM") } else { card.blank() };
        card = pairs.iter().fold(card, |card, (grid, components)| {
            card.number(grid).number(components)
        });
    }
    match c.expansion {
        Some(alpha) => card.end_line().text("ALPHA").real(alpha),
        None => card,
    }
}

fn rbar(c: &Rbar) -> CardText {
    let card = CardText::new("RBAR").number(c.id).numbers(&c.grids);
    components(components(card, &c.independent), &c.dependent).optional_real(c.expansion)
}

fn mpc(c: &Mpc) -> CardText {
    let mut card = CardText::new("MPC").number(c.sid);
    for (k, pair) in c.terms.chunks(2).enumerate() {
        if k > 0 {
            card = card.end_line().blank();
        }
        card = pair.iter().fold(card, |card, t| {
            card.number(t.point).number(t.component).real(t.coefficient)
        });
    }
    card
}

fn spc1(c: &Spc1) -> CardText {
    CardText::new("SPC1")
        .number(c.sid)
        .number(c.components)
        .numbers(&c.points)
}

fn suport(c: &Suport) -> CardText {
    let card = match c.sid {
        Some(sid) => CardText::new("SUPORT1").number(sid),
        None => CardText::new("SUPORT"),
    };
    card.number(c.point).number(c.components)
}

fn dof_set(name: &str, c: &DofSet) -> CardText {
    CardText::new(name).number(c.components).numbers(&c.points)
}

fn set1(c: &Set1) -> CardText {
    let card = CardText::new("SET1").number(c.id);
    let card = if c.skin { card.text("SKIN") } else { card };
    card.numbers(&c.members)
}

fn eigr(c: &Eigr) -> CardText {
    let card = CardText::new("EIGR")
        .number(c.id)
        .text(&c.method)
        .optional_real(c.lower_hz);
    let card = card
        .optional_real(c.upper_hz)
        .optional(c.estimated)
        .optional(c.desired)
        .optional(c.zero_roots);
    card.optional_real(c.criterion)
        .text(&c.normalization)
        .optional(c.point)
        .optional(c.component)
}

fn eigrl(c: &Eigrl) -> CardText {
    let card = CardText::new("EIGRL")
        .number(c.id)
        .optional_real(c.lower_hz)
        .optional_real(c.upper_hz);
    let card = card
        .optional(c.desired)
        .optional(c.message_level)
        .optional(c.block_size);
    let card = card.optional_real(c.shift_hz).text(&c.normalization);
    c.options.iter().fold(card, |card, option| card.text(option))
}

fn raw(c: &RawCard) -> CardText {
    c.fields
        .iter()
        .fold(CardText::new(&c.name), |card, field| card.text(field))
}
