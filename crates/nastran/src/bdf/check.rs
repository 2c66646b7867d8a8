//! References between cards: grids, properties, materials and coordinate systems that others name must be there.

use std::collections::BTreeSet;

use crate::deck::{Conm2Frame, Deck, Id, Orientation, ScalarMassValue, ScalarSpringValue};
use crate::error::Severity;
use crate::remarks::Remarks;

/// Numbers in ascending order. References mostly go to neighbours of the one before, so these are tried first.
struct Numbers {
    sorted: Vec<Id>,
    last: usize,
}

impl Numbers {
    fn new(sorted: impl Iterator<Item = Id>) -> Self {
        Self {
            sorted: sorted.collect(),
            last: 0,
        }
    }

    fn contains(&mut self, id: Id) -> bool {
        for near in self.last..self.last + 2 {
            if self.sorted.get(near) == Some(&id) {
                self.last = near;
                return true;
            }
        }
        let found = self.sorted.binary_search(&id);
        self.last = found.unwrap_or(self.last);
        found.is_ok()
    }
}

struct Checker<'a> {
    deck: &'a Deck,
    grids: Numbers,
    bar_properties: Numbers,
    main_file: &'a str,
    /// Uninterpreted materials (as `MAT`) and properties, which count as present.
    others: BTreeSet<(&'a str, Id)>,
    remarks: &'a mut Remarks,
}

/// Remarks on every reference that leads nowhere.
pub(super) fn references(deck: &Deck, main_file: &str, remarks: &mut Remarks) {
    let mut check = Checker {
        deck,
        grids: Numbers::new(deck.grids.keys().copied()),
        bar_properties: Numbers::new(deck.bar_properties.keys().copied()),
        main_file,
        others: uninterpreted(deck),
        remarks,
    };
    check.points();
    check.systems();
    check.bars();
    check.masses();
    check.springs();
    check.rigid_elements();
    check.constraints();
}

fn uninterpreted(deck: &Deck) -> BTreeSet<(&str, Id)> {
    let kind = |name: &'_ str| match name {
        "PBARL" => Some("PBARL"),
        "PBEAML" | "PBCOMP" => Some("PBEAML"),
        _ if name.starts_with("MAT") => Some("MAT"),
        _ => None,
    };
    let number = |field: &String| crate::number::integer(field.as_bytes()).and_then(|i| Id::try_from(i).ok());
    deck.raw
        .iter()
        .filter_map(|card| Some((kind(&card.name)?, number(card.fields.first()?)?)))
        .collect()
}

impl Checker<'_> {
    fn missing(&mut self, card: &str, id: Id, message: String) {
        let (file, line) = match self.deck.origins.of(card, id) {
            Some(origin) => (origin.file.to_string(), origin.line),
            None => (self.main_file.to_owned(), 0),
        };
        self.remarks
            .push(Severity::Error, &file, line, format!("{card} {id}"), message);
    }

    /// Grids and scalar points are numbered together.
    fn points(&mut self) {
        for &id in &self.deck.scalar_points {
            if self.grids.contains(id) {
                self.missing(
                    "SPOINT",
                    id,
                    "is a GRID of the deck too; give one of them another number".into(),
                );
            }
        }
    }

    fn grid(&mut self, card: &str, id: Id, field: &str, grid: Id) {
        if !self.grids.contains(grid) {
            self.missing(
                card,
                id,
                format!(
                    "{field} is grid {grid}, which is not in the deck; add its GRID card or correct {field}"
                ),
            );
        }
    }

    /// A grid, a scalar point, or 0 for the ground.
    fn point(&mut self, card: &str, id: Id, field: &str, point: Id) {
        if point != 0 && !self.grids.contains(point) && !self.deck.scalar_points.contains(&point) {
            self.missing(
                card,
                id,
                format!("{field} is point {point}, which is not in the deck; add its GRID or SPOINT or correct {field}"),
            );
        }
    }

    fn system(&mut self, card: &str, id: Id, field: &str, system: Id) {
        if system != 0 && !self.deck.coordinate_systems.contains_key(&system) {
            self.missing(
                card,
                id,
                format!(
                    "{field} is coordinate system {system}, which is not in the deck; add its CORD card or correct \
                     {field}"
                ),
            );
        }
    }

    fn present(&mut self, card: &str, id: Id, what: &str, number: Id, present: bool) {
        if !present {
            self.missing(
                card,
                id,
                format!("names {what} {number}, which is not in the deck; add it or correct the number"),
            );
        }
    }

    fn systems(&mut self) {
        for grid in self.deck.grids.values() {
            self.system("GRID", grid.id, "CP", grid.cp);
            self.system("GRID", grid.id, "CD", grid.cd);
        }
    }

    fn orientation(&mut self, card: &str, id: Id, orientation: Option<&Orientation>) {
        match orientation {
            Some(Orientation::Grid(grid)) => self.grid(card, id, "G0", *grid),
            Some(Orientation::Vector(v)) if v.iter().all(|&x| x == 0.0) => {
                self.missing(
                    card,
                    id,
                    "the orientation vector is zero; give X1, X2, X3 or a grid G0".into(),
                );
            }
            Some(Orientation::Vector(_)) => {}
            None => self.missing(
                card,
                id,
                "has no orientation; give X1, X2, X3 or a grid G0".into(),
            ),
        }
    }

    fn bars(&mut self) {
        let deck = self.deck;
        for (&id, bar) in &deck.bars {
            self.grid("CBAR", id, "GA", bar.grids[0]);
            self.grid("CBAR", id, "GB", bar.grids[1]);
            self.orientation("CBAR", id, bar.orientation.as_ref());
            // Sections of other libraries stay uninterpreted.
            let known = self.bar_properties.contains(bar.pid) || self.others.contains(&("PBARL", bar.pid));
            self.present("CBAR", id, "property PBAR or PBARL", bar.pid, known);
        }
        for (&id, beam) in &deck.beams {
            self.grid("CBEAM", id, "GA", beam.grids[0]);
            self.grid("CBEAM", id, "GB", beam.grids[1]);
            self.orientation("CBEAM", id, beam.orientation.as_ref());
            let known =
                deck.beam_properties.contains_key(&beam.pid) || self.others.contains(&("PBEAML", beam.pid));
            self.present("CBEAM", id, "property PBEAM or PBEAML", beam.pid, known);
        }
        for (&id, rod) in &deck.rods {
            self.grid("CROD", id, "G1", rod.grids[0]);
            self.grid("CROD", id, "G2", rod.grids[1]);
            self.present(
                "CROD",
                id,
                "property PROD",
                rod.pid,
                deck.rod_properties.contains_key(&rod.pid),
            );
        }
        for (&id, rod) in &deck.conrods {
            self.grid("CONROD", id, "G1", rod.grids[0]);
            self.grid("CONROD", id, "G2", rod.grids[1]);
            self.material("CONROD", id, rod.mid);
        }
        for (&id, property) in &deck.bar_properties {
            let card = match property {
                crate::deck::BarProperty::Pbar(_) => "PBAR",
                crate::deck::BarProperty::Pbarl(_) => "PBARL",
            };
            self.material(card, id, property.mid());
        }
        for (&id, property) in &deck.beam_properties {
            let card = match property {
                crate::deck::BeamProperty::Pbeam(_) => "PBEAM",
                crate::deck::BeamProperty::Pbeaml(_) => "PBEAML",
            };
            self.material(card, id, property.mid());
        }
        for (&id, property) in &deck.rod_properties {
            self.material("PROD", id, property.mid);
        }
    }

    fn material(&mut self, card: &str, id: Id, mid: Id) {
        let known = self.deck.materials.contains_key(&mid) || self.others.contains(&("MAT", mid));
        self.present(card, id, "material MAT1", mid, known);
    }

    fn masses(&mut self) {
        let deck = self.deck;
        for (&id, mass) in &deck.conm1 {
            self.grid("CONM1", id, "G", mass.grid);
            self.system("CONM1", id, "CID", mass.cid);
        }
        for (&id, mass) in &deck.conm2 {
            self.grid("CONM2", id, "G", mass.grid);
            if let Conm2Frame::System(cid) = mass.frame {
                self.system("CONM2", id, "CID", cid);
            }
        }
        for (&id, mass) in &deck.scalar_masses {
            let card = mass.card_name();
            for end in mass.ends {
                self.point(card, id, "G", end.point);
            }
            if let ScalarMassValue::Property(pid) = mass.value {
                self.present(
                    card,
                    id,
                    "property PMASS",
                    pid,
                    deck.mass_properties.contains_key(&pid),
                );
            }
        }
    }

    fn springs(&mut self) {
        let deck = self.deck;
        for (&id, spring) in &deck.springs {
            let card = match spring.value {
                ScalarSpringValue::Property(_) => "CELAS1",
                ScalarSpringValue::Value { .. } => "CELAS2",
            };
            for end in spring.ends {
                self.point(card, id, "G", end.point);
            }
            if let ScalarSpringValue::Property(pid) = spring.value {
                self.present(
                    card,
                    id,
                    "property PELAS",
                    pid,
                    deck.spring_properties.contains_key(&pid),
                );
            }
        }
        for (&id, bush) in &deck.bushes {
            self.grid("CBUSH", id, "GA", bush.grids[0]);
            self.point("CBUSH", id, "GB", bush.grids[1]);
            self.system("CBUSH", id, "CID", bush.cid.unwrap_or(0));
            self.present(
                "CBUSH",
                id,
                "property PBUSH",
                bush.pid,
                deck.bush_properties.contains_key(&bush.pid),
            );
        }
    }

    fn rigid_elements(&mut self) {
        let deck = self.deck;
        for (&id, element) in &deck.rbe2 {
            self.grid("RBE2", id, "GN", element.independent);
            for &grid in &element.dependents {
                self.grid("RBE2", id, "a dependent", grid);
            }
        }
        for (&id, element) in &deck.rbe3 {
            self.grid("RBE3", id, "REFGRID", element.reference);
            for &grid in element.groups.iter().flat_map(|g| &g.grids) {
                self.grid("RBE3", id, "a member", grid);
            }
        }
        for (&id, element) in &deck.rbars {
            self.grid("RBAR", id, "GA", element.grids[0]);
            self.grid("RBAR", id, "GB", element.grids[1]);
        }
    }

    /// Constraints have set numbers rather than numbers of their own, so their lines are not known.
    fn constraints(&mut self) {
        let deck = self.deck;
        for mpc in &deck.mpcs {
            for term in &mpc.terms {
                self.point("MPC", mpc.sid, "G", term.point);
            }
        }
        for spc in &deck.spcs {
            self.point("SPC", spc.sid, "G", spc.point);
        }
        for suport in &deck.suports {
            self.point("SUPORT", suport.sid.unwrap_or(0), "ID", suport.point);
        }
    }
}
