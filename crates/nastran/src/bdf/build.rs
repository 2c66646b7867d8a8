//! Gathers interpreted cards and makes the deck of them.

use std::sync::Arc;

use crate::deck::{
    BarProperty, BeamProperty, Cbar, Cbeam, CoordinateKind, Deck, Grid, Id, Origin, Origins, RawCard,
};
use crate::error::{Diagnostic, Severity};
use crate::remarks::Remarks;

use super::card::Card;
use super::elements::{self, BarBlanks, BarDefaults};
use super::fields::Fields;
use super::lists::NeedsPoints;
use super::merge::Table;
use super::points::{self, GridBlanks};
use super::{constraints, properties};

/// What has been read so far.
#[derive(Default)]
struct Tables {
    grids: Table<Grid>,
    coordinate_systems: Table<crate::deck::CoordinateSystem>,
    bars: Table<Cbar>,
    beams: Table<Cbeam>,
    rods: Table<crate::deck::Crod>,
    conrods: Table<crate::deck::Conrod>,
    conm1: Table<crate::deck::Conm1>,
    conm2: Table<crate::deck::Conm2>,
    scalar_masses: Table<crate::deck::Cmass>,
    mass_properties: Table<f64>,
    springs: Table<crate::deck::Celas>,
    bushes: Table<crate::deck::Cbush>,
    bar_properties: Table<BarProperty>,
    beam_properties: Table<BeamProperty>,
    rod_properties: Table<crate::deck::Prod>,
    spring_properties: Table<crate::deck::Pelas>,
    bush_properties: Table<crate::deck::Pbush>,
    materials: Table<crate::deck::Mat1>,
    rbe2: Table<crate::deck::Rbe2>,
    rbe3: Table<crate::deck::Rbe3>,
    rbars: Table<crate::deck::Rbar>,
    sets: Table<crate::deck::Set1>,
    eigr: Table<crate::deck::Eigr>,
    eigrl: Table<crate::deck::Eigrl>,
}

/// Members that the ranges of a deck may have in all, and one more for each byte of the deck: a range of a few bytes would
/// else stand for ten thousand numbers, and a small file fill the memory.
const RANGE_MEMBERS: usize = 1_000_000;

pub(super) struct Builder {
    files: Vec<Arc<str>>,
    remarks: Remarks,
    tables: Tables,
    /// What was left blank, for defaults that may come later.
    grid_blanks: Vec<(Id, GridBlanks)>,
    bar_blanks: Vec<(Id, BarBlanks)>,
    beam_blanks: Vec<(Id, BarBlanks)>,
    /// Unnumbered cards go straight into the deck.
    deck: Deck,
    bar_defaults: BarDefaults,
    beam_defaults: BarDefaults,
    /// Cards with long ranges, which wait until all points are known.
    deferred: Vec<Card>,
    /// How many members ranges may still have.
    ranges_left: usize,
}

impl Builder {
    pub(super) fn new(name: &str) -> Self {
        Self {
            files: vec![Arc::from(name)],
            remarks: Remarks::default(),
            tables: Tables::default(),
            grid_blanks: Vec::new(),
            bar_blanks: Vec::new(),
            beam_blanks: Vec::new(),
            deck: Deck::default(),
            bar_defaults: BarDefaults::default(),
            beam_defaults: BarDefaults::default(),
            deferred: Vec::new(),
            ranges_left: RANGE_MEMBERS,
        }
    }

    /// The more a deck holds, the more its ranges may mean.
    pub(super) fn allow_for(&mut self, text: &[u8]) {
        self.ranges_left = self.ranges_left.saturating_add(text.len());
    }

    pub(super) fn file(&self, index: u32) -> &str {
        self.files.get(index as usize).map_or("", |f| f)
    }

    pub(super) fn add_file(&mut self, name: &str) -> u32 {
        self.files.push(Arc::from(name));
        u32::try_from(self.files.len() - 1).unwrap_or(u32::MAX)
    }

    pub(super) fn remark(
        &mut self,
        severity: Severity,
        file: u32,
        line: u32,
        card: &str,
        message: impl Into<String>,
    ) {
        let name = self.files.get(file as usize).map_or("", |f| f);
        self.remarks.push(severity, name, line, card, message);
    }

    /// Interprets a complete card.
    pub(super) fn card(&mut self, card: &Card) {
        if self.interpret(card, None).is_err() {
            self.deferred.push(card.clone());
        }
    }

    fn interpret(&mut self, card: &Card, known: Option<&[Id]>) -> Result<(), NeedsPoints> {
        let file = self.files.get(card.file as usize).map_or("", |f| f);
        let mut fields = Fields::new(card, file, &mut self.remarks, &mut self.ranges_left);
        let f = &mut fields;
        let t = &mut self.tables;
        let deck = &mut self.deck;
        match card.name() {
            b"GRID" => {
                let (id, (grid, blanks)) = points::grid(f);
                if t.grids.is_kept("GRID", (id, grid), f) {
                    self.grid_blanks.push((id, blanks));
                }
            }
            b"GRDSET" => {
                let defaults = points::grdset(f);
                if !f.failed {
                    deck.grdset = Some(defaults);
                }
            }
            b"SPOINT" => {
                let members = f.list(1, card.last(), known)?;
                if !f.failed {
                    deck.scalar_points.extend(members);
                }
            }
            b"CORD1R" => {
                t.coordinate_systems
                    .keep_all("CORD1R", points::cord1(f, CoordinateKind::Rectangular), f)
            }
            b"CORD1C" => {
                t.coordinate_systems
                    .keep_all("CORD1C", points::cord1(f, CoordinateKind::Cylindrical), f)
            }
            b"CORD1S" => {
                t.coordinate_systems
                    .keep_all("CORD1S", points::cord1(f, CoordinateKind::Spherical), f)
            }
            b"CORD2R" => {
                t.coordinate_systems
                    .keep("CORD2R", points::cord2(f, CoordinateKind::Rectangular), f)
            }
            b"CORD2C" => {
                t.coordinate_systems
                    .keep("CORD2C", points::cord2(f, CoordinateKind::Cylindrical), f)
            }
            b"CORD2S" => t
                .coordinate_systems
                .keep("CORD2S", points::cord2(f, CoordinateKind::Spherical), f),
            b"CBAR" => {
                let (id, (bar, blanks)) = elements::cbar(f);
                if t.bars.is_kept("CBAR", (id, bar), f) {
                    self.bar_blanks.push((id, blanks));
                }
            }
            b"CBEAM" => {
                let (id, (beam, blanks)) = elements::cbeam(f);
                if t.beams.is_kept("CBEAM", (id, beam), f) {
                    self.beam_blanks.push((id, blanks));
                }
            }
            b"BAROR" => {
                self.bar_defaults = elements::bar_defaults(f);
                deck.raw.push(raw(card, file));
            }
            b"BEAMOR" => {
                self.beam_defaults = elements::bar_defaults(f);
                deck.raw.push(raw(card, file));
            }
            b"CROD" => t.rods.keep("CROD", elements::crod(f), f),
            b"CONROD" => t.conrods.keep("CONROD", elements::conrod(f), f),
            b"CONM1" => t.conm1.keep("CONM1", elements::conm1(f), f),
            b"CONM2" => t.conm2.keep("CONM2", elements::conm2(f), f),
            b"CMASS1" => t.scalar_masses.keep("CMASS1", elements::cmass(f, true, false), f),
            b"CMASS2" => t
                .scalar_masses
                .keep("CMASS2", elements::cmass(f, false, false), f),
            b"CMASS3" => t.scalar_masses.keep("CMASS3", elements::cmass(f, true, true), f),
            b"CMASS4" => t.scalar_masses.keep("CMASS4", elements::cmass(f, false, true), f),
            b"PMASS" => t.mass_properties.keep_all("PMASS", elements::pmass(f), f),
            b"CELAS1" => t.springs.keep("CELAS1", elements::celas1(f), f),
            b"CELAS2" => t.springs.keep("CELAS2", elements::celas2(f), f),
            b"CBUSH" => t.bushes.keep("CBUSH", elements::cbush(f), f),
            b"PBAR" => {
                let (id, property) = properties::pbar(f);
                t.bar_properties
                    .keep("PBAR", (id, BarProperty::Pbar(property)), f);
            }
            b"PBARL" => match properties::shape(f, 4) {
                Some(shape) => {
                    let (id, property) = properties::pbarl(f, shape);
                    t.bar_properties
                        .keep("PBARL", (id, BarProperty::Pbarl(property)), f);
                }
                None => unknown_section(card, f, file, deck),
            },
            b"PBEAM" => {
                let (id, property) = properties::pbeam(f);
                t.beam_properties
                    .keep("PBEAM", (id, BeamProperty::Pbeam(Box::new(property))), f);
            }
            b"PBEAML" => match properties::shape(f, 4) {
                Some(shape) => {
                    let (id, property) = properties::pbeaml(f, shape);
                    t.beam_properties
                        .keep("PBEAML", (id, BeamProperty::Pbeaml(property)), f);
                }
                None => unknown_section(card, f, file, deck),
            },
            b"PROD" => t.rod_properties.keep("PROD", properties::prod(f), f),
            b"PELAS" => t.spring_properties.keep_all("PELAS", properties::pelas(f), f),
            b"PBUSH" => t.bush_properties.keep("PBUSH", properties::pbush(f), f),
            b"MAT1" => t.materials.keep("MAT1", properties::mat1(f), f),
            b"RBE2" => t.rbe2.keep("RBE2", constraints::rbe2(f, known)?, f),
            b"RBE3" => t.rbe3.keep("RBE3", constraints::rbe3(f, known)?, f),
            b"RBAR" => t.rbars.keep("RBAR", constraints::rbar(f), f),
            b"MPC" => extend(&mut deck.mpcs, [constraints::mpc(f)], f),
            b"SPC" => extend(&mut deck.spcs, constraints::spc(f), f),
            b"SPC1" => extend(&mut deck.spc1s, [constraints::spc1(f, known)?], f),
            b"SUPORT" => extend(&mut deck.suports, constraints::suport(f), f),
            b"SUPORT1" => extend(&mut deck.suports, constraints::suport1(f), f),
            b"ASET" => extend(&mut deck.asets, constraints::dof_pairs(f), f),
            b"ASET1" => extend(&mut deck.asets, [constraints::dof_list(f, known)?], f),
            b"OMIT" => extend(&mut deck.omits, constraints::dof_pairs(f), f),
            b"OMIT1" => extend(&mut deck.omits, [constraints::dof_list(f, known)?], f),
            b"SET1" => t.sets.keep("SET1", constraints::set1(f, known)?, f),
            b"EIGR" => t.eigr.keep("EIGR", constraints::eigr(f), f),
            b"EIGRL" => t.eigrl.keep("EIGRL", constraints::eigrl(f), f),
            b"PARAM" => {
                let param = constraints::param(f);
                if !f.failed
                    && let Some(earlier) = deck.params.insert(param.name.clone(), param.clone())
                    && earlier != param
                {
                    f.remark(
                        Severity::Warning,
                        format!(
                            "{} is given twice, {} and {}; the last counts",
                            param.name, earlier.value, param.value
                        ),
                    );
                }
            }
            _ => deck.raw.push(raw(card, file)),
        }
        Ok(())
    }

    /// The deck without control sections, and all remarks.
    pub(super) fn finish(mut self) -> (Deck, Vec<Diagnostic>) {
        self.read_deferred();
        self.apply_defaults();
        let mut deck = std::mem::take(&mut self.deck);
        let mut origins = Origins::new(self.files.clone());
        let (o, r) = (&mut origins, &mut self.remarks);
        let t = self.tables;
        deck.grids = t.grids.finish(o, r);
        deck.coordinate_systems = t.coordinate_systems.finish(o, r);
        deck.bars = t.bars.finish(o, r);
        deck.beams = t.beams.finish(o, r);
        deck.rods = t.rods.finish(o, r);
        deck.conrods = t.conrods.finish(o, r);
        deck.conm1 = t.conm1.finish(o, r);
        deck.conm2 = t.conm2.finish(o, r);
        deck.scalar_masses = t.scalar_masses.finish(o, r);
        deck.mass_properties = t.mass_properties.finish(o, r);
        deck.springs = t.springs.finish(o, r);
        deck.bushes = t.bushes.finish(o, r);
        deck.bar_properties = t.bar_properties.finish(o, r);
        deck.beam_properties = t.beam_properties.finish(o, r);
        deck.rod_properties = t.rod_properties.finish(o, r);
        deck.spring_properties = t.spring_properties.finish(o, r);
        deck.bush_properties = t.bush_properties.finish(o, r);
        deck.materials = t.materials.finish(o, r);
        deck.rbe2 = t.rbe2.finish(o, r);
        deck.rbe3 = t.rbe3.finish(o, r);
        deck.rbars = t.rbars.finish(o, r);
        deck.sets = t.sets.finish(o, r);
        deck.eigr = t.eigr.finish(o, r);
        deck.eigrl = t.eigrl.finish(o, r);
        deck.origins = origins;
        let name = self.files.first().cloned().unwrap_or_default();
        super::check::references(&deck, &name, &mut self.remarks);
        (deck, self.remarks.finish(&name))
    }

    /// GRDSET, BAROR and BEAMOR may stand after the cards whose blanks they fill.
    fn apply_defaults(&mut self) {
        let t = &mut self.tables;
        if let Some(defaults) = &self.deck.grdset {
            for (id, blanks) in self.grid_blanks.drain(..) {
                if let Some(grid) = t.grids.get_mut(id) {
                    blanks.apply(defaults, grid);
                }
            }
        }
        if !self.bar_defaults.is_empty() {
            for (id, blanks) in self.bar_blanks.drain(..) {
                if let Some(bar) = t.bars.get_mut(id) {
                    let (pid, frames) = (&mut bar.pid, &mut bar.offset_frames);
                    self.bar_defaults.apply(blanks, pid, &mut bar.orientation, frames);
                }
            }
        }
        if !self.beam_defaults.is_empty() {
            for (id, blanks) in self.beam_blanks.drain(..) {
                if let Some(beam) = t.beams.get_mut(id) {
                    let (pid, frames) = (&mut beam.pid, &mut beam.offset_frames);
                    self.beam_defaults
                        .apply(blanks, pid, &mut beam.orientation, frames);
                }
            }
        }
    }

    /// Cards with long ranges take the points that the deck has.
    fn read_deferred(&mut self) {
        let deferred = std::mem::take(&mut self.deferred);
        if deferred.is_empty() {
            return;
        }
        let mut known: Vec<Id> = self.tables.grids.ids().collect();
        known.extend(&self.deck.scalar_points);
        known.sort_unstable();
        known.dedup();
        for card in deferred {
            // SPOINT makes points: there is nothing to choose from.
            if card.name() == b"SPOINT" {
                self.remark(
                    Severity::Error,
                    card.file,
                    card.line,
                    "SPOINT",
                    "the range has more than 10000 points; split it if it is meant",
                );
            } else {
                // With the points known, no card waits.
                let _ = self.interpret(&card, Some(&known));
            }
        }
    }
}

fn extend<T>(list: &mut Vec<T>, values: impl IntoIterator<Item = T>, f: &Fields<'_>) {
    if !f.failed {
        list.extend(values);
    }
}

fn raw(card: &Card, file: &str) -> RawCard {
    RawCard {
        name: String::from_utf8_lossy(card.name()).into_owned(),
        fields: (1..=card.last())
            .map(|n| String::from_utf8_lossy(card.field(n)).into_owned())
            .collect(),
        origin: Some(Origin {
            file: Arc::from(file),
            line: card.line,
        }),
    }
}

fn unknown_section(card: &Card, f: &mut Fields<'_>, file: &str, deck: &mut Deck) {
    let shape = f.word(4);
    f.remark(
        Severity::Warning,
        format!("section {shape:?} is not known; the card is kept uninterpreted"),
    );
    deck.raw.push(raw(card, file));
}
