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
use super::merge::{Merge, Row, Rows, keep, keep_all};
use super::points::{self, GridBlanks};
use super::{constraints, properties};

/// What has been read so far.
#[derive(Default)]
struct Tables {
    grids: Rows<(Grid, GridBlanks)>,
    coordinate_systems: Rows<crate::deck::CoordinateSystem>,
    bars: Rows<(Cbar, BarBlanks)>,
    beams: Rows<(Cbeam, BarBlanks)>,
    rods: Rows<crate::deck::Crod>,
    conrods: Rows<crate::deck::Conrod>,
    conm1: Rows<crate::deck::Conm1>,
    conm2: Rows<crate::deck::Conm2>,
    scalar_masses: Rows<crate::deck::Cmass>,
    mass_properties: Rows<f64>,
    springs: Rows<crate::deck::Celas>,
    bushes: Rows<crate::deck::Cbush>,
    bar_properties: Rows<BarProperty>,
    beam_properties: Rows<BeamProperty>,
    rod_properties: Rows<crate::deck::Prod>,
    spring_properties: Rows<crate::deck::Pelas>,
    bush_properties: Rows<crate::deck::Pbush>,
    materials: Rows<crate::deck::Mat1>,
    rbe2: Rows<crate::deck::Rbe2>,
    rbe3: Rows<crate::deck::Rbe3>,
    rbars: Rows<crate::deck::Rbar>,
    sets: Rows<crate::deck::Set1>,
    eigr: Rows<crate::deck::Eigr>,
    eigrl: Rows<crate::deck::Eigrl>,
}

pub(super) struct Builder {
    files: Vec<Arc<str>>,
    remarks: Remarks,
    tables: Tables,
    /// Unnumbered cards go straight into the deck.
    deck: Deck,
    bar_defaults: BarDefaults,
    beam_defaults: BarDefaults,
    /// Cards with long ranges, which wait until all points are known.
    deferred: Vec<Card>,
}

impl Builder {
    pub(super) fn new(name: &str) -> Self {
        Self {
            files: vec![Arc::from(name)],
            remarks: Remarks::default(),
            tables: Tables::default(),
            deck: Deck::default(),
            bar_defaults: BarDefaults::default(),
            beam_defaults: BarDefaults::default(),
            deferred: Vec::new(),
        }
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
        let mut fields = Fields::new(card, file, &mut self.remarks);
        let f = &mut fields;
        let t = &mut self.tables;
        let deck = &mut self.deck;
        match card.name() {
            b"GRID" => keep(&mut t.grids, "GRID", points::grid(f), f),
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
            b"CORD1R" => keep_all(
                &mut t.coordinate_systems,
                "CORD1R",
                points::cord1(f, CoordinateKind::Rectangular),
                f,
            ),
            b"CORD1C" => keep_all(
                &mut t.coordinate_systems,
                "CORD1C",
                points::cord1(f, CoordinateKind::Cylindrical),
                f,
            ),
            b"CORD1S" => keep_all(
                &mut t.coordinate_systems,
                "CORD1S",
                points::cord1(f, CoordinateKind::Spherical),
                f,
            ),
            b"CORD2R" => keep(
                &mut t.coordinate_systems,
                "CORD2R",
                points::cord2(f, CoordinateKind::Rectangular),
                f,
            ),
            b"CORD2C" => keep(
                &mut t.coordinate_systems,
                "CORD2C",
                points::cord2(f, CoordinateKind::Cylindrical),
                f,
            ),
            b"CORD2S" => keep(
                &mut t.coordinate_systems,
                "CORD2S",
                points::cord2(f, CoordinateKind::Spherical),
                f,
            ),
            b"CBAR" => keep(&mut t.bars, "CBAR", elements::cbar(f), f),
            b"CBEAM" => keep(&mut t.beams, "CBEAM", elements::cbeam(f), f),
            b"BAROR" => {
                self.bar_defaults = elements::bar_defaults(f);
                deck.raw.push(raw(card, file));
            }
            b"BEAMOR" => {
                self.beam_defaults = elements::bar_defaults(f);
                deck.raw.push(raw(card, file));
            }
            b"CROD" => keep(&mut t.rods, "CROD", elements::crod(f), f),
            b"CONROD" => keep(&mut t.conrods, "CONROD", elements::conrod(f), f),
            b"CONM1" => keep(&mut t.conm1, "CONM1", elements::conm1(f), f),
            b"CONM2" => keep(&mut t.conm2, "CONM2", elements::conm2(f), f),
            b"CMASS1" => keep(&mut t.scalar_masses, "CMASS1", elements::cmass(f, true, false), f),
            b"CMASS2" => keep(
                &mut t.scalar_masses,
                "CMASS2",
                elements::cmass(f, false, false),
                f,
            ),
            b"CMASS3" => keep(&mut t.scalar_masses, "CMASS3", elements::cmass(f, true, true), f),
            b"CMASS4" => keep(&mut t.scalar_masses, "CMASS4", elements::cmass(f, false, true), f),
            b"PMASS" => keep_all(&mut t.mass_properties, "PMASS", elements::pmass(f), f),
            b"CELAS1" => keep(&mut t.springs, "CELAS1", elements::celas1(f), f),
            b"CELAS2" => keep(&mut t.springs, "CELAS2", elements::celas2(f), f),
            b"CBUSH" => keep(&mut t.bushes, "CBUSH", elements::cbush(f), f),
            b"PBAR" => {
                let (id, property) = properties::pbar(f);
                keep(
                    &mut t.bar_properties,
                    "PBAR",
                    (id, BarProperty::Pbar(property)),
                    f,
                );
            }
            b"PBARL" => match properties::shape(f, 4) {
                Some(shape) => {
                    let (id, property) = properties::pbarl(f, shape);
                    keep(
                        &mut t.bar_properties,
                        "PBARL",
                        (id, BarProperty::Pbarl(property)),
                        f,
                    );
                }
                None => unknown_section(card, f, file, deck),
            },
            b"PBEAM" => {
                let (id, property) = properties::pbeam(f);
                keep(
                    &mut t.beam_properties,
                    "PBEAM",
                    (id, BeamProperty::Pbeam(Box::new(property))),
                    f,
                );
            }
            b"PBEAML" => match properties::shape(f, 4) {
                Some(shape) => {
                    let (id, property) = properties::pbeaml(f, shape);
                    keep(
                        &mut t.beam_properties,
                        "PBEAML",
                        (id, BeamProperty::Pbeaml(property)),
                        f,
                    );
                }
                None => unknown_section(card, f, file, deck),
            },
            b"PROD" => keep(&mut t.rod_properties, "PROD", properties::prod(f), f),
            b"PELAS" => keep_all(&mut t.spring_properties, "PELAS", properties::pelas(f), f),
            b"PBUSH" => keep(&mut t.bush_properties, "PBUSH", properties::pbush(f), f),
            b"MAT1" => keep(&mut t.materials, "MAT1", properties::mat1(f), f),
            b"RBE2" => keep(&mut t.rbe2, "RBE2", constraints::rbe2(f, known)?, f),
            b"RBE3" => keep(&mut t.rbe3, "RBE3", constraints::rbe3(f, known)?, f),
            b"RBAR" => keep(&mut t.rbars, "RBAR", constraints::rbar(f), f),
            b"MPC" => extend(&mut deck.mpcs, [constraints::mpc(f)], f),
            b"SPC" => extend(&mut deck.spcs, constraints::spc(f), f),
            b"SPC1" => extend(&mut deck.spc1s, [constraints::spc1(f, known)?], f),
            b"SUPORT" => extend(&mut deck.suports, constraints::suport(f), f),
            b"SUPORT1" => extend(&mut deck.suports, constraints::suport1(f), f),
            b"ASET" => extend(&mut deck.asets, constraints::dof_pairs(f), f),
            b"ASET1" => extend(&mut deck.asets, [constraints::dof_list(f, known)?], f),
            b"OMIT" => extend(&mut deck.omits, constraints::dof_pairs(f), f),
            b"OMIT1" => extend(&mut deck.omits, [constraints::dof_list(f, known)?], f),
            b"SET1" => keep(&mut t.sets, "SET1", constraints::set1(f, known)?, f),
            b"EIGR" => keep(&mut t.eigr, "EIGR", constraints::eigr(f), f),
            b"EIGRL" => keep(&mut t.eigrl, "EIGRL", constraints::eigrl(f), f),
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
        let mut deck = std::mem::take(&mut self.deck);
        let t = std::mem::take(&mut self.tables);
        let grdset = deck.grdset.clone().unwrap_or_default();
        let mut merge = Merge {
            origins: Origins::new(self.files.clone()),
            remarks: &mut self.remarks,
        };
        deck.grids = merge.map_with(t.grids, |(mut grid, blanks)| {
            blanks.apply(&grdset, &mut grid);
            grid
        });
        deck.coordinate_systems = merge.map(t.coordinate_systems);
        deck.bars = merge.map_with(t.bars, |(mut bar, blanks)| {
            let defaults = &self.bar_defaults;
            defaults.apply(blanks, &mut bar.pid, &mut bar.orientation, &mut bar.offset_frames);
            bar
        });
        deck.beams = merge.map_with(t.beams, |(mut beam, blanks)| {
            let defaults = &self.beam_defaults;
            defaults.apply(
                blanks,
                &mut beam.pid,
                &mut beam.orientation,
                &mut beam.offset_frames,
            );
            beam
        });
        deck.rods = merge.map(t.rods);
        deck.conrods = merge.map(t.conrods);
        deck.conm1 = merge.map(t.conm1);
        deck.conm2 = merge.map(t.conm2);
        deck.scalar_masses = merge.map(t.scalar_masses);
        deck.mass_properties = merge.map(t.mass_properties);
        deck.springs = merge.map(t.springs);
        deck.bushes = merge.map(t.bushes);
        deck.bar_properties = merge.map(t.bar_properties);
        deck.beam_properties = merge.map(t.beam_properties);
        deck.rod_properties = merge.map(t.rod_properties);
        deck.spring_properties = merge.map(t.spring_properties);
        deck.bush_properties = merge.map(t.bush_properties);
        deck.materials = merge.map(t.materials);
        deck.rbe2 = merge.map(t.rbe2);
        deck.rbe3 = merge.map(t.rbe3);
        deck.rbars = merge.map(t.rbars);
        deck.sets = merge.map(t.sets);
        deck.eigr = merge.map(t.eigr);
        deck.eigrl = merge.map(t.eigrl);
        deck.origins = merge.origins;
        let name = self.files.first().cloned().unwrap_or_default();
        super::check::references(&deck, &name, &mut self.remarks);
        (deck, self.remarks.finish(&name))
    }

    /// Cards with long ranges take the points that the deck has.
    fn read_deferred(&mut self) {
        let deferred = std::mem::take(&mut self.deferred);
        if deferred.is_empty() {
            return;
        }
        let mut known: Vec<Id> = self.tables.grids.iter().map(Row::id).collect();
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
