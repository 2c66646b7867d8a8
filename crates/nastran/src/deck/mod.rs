//! A deck as plain data: one struct for each card that is understood, named after it.
//!
//! Elements, points, properties and so on are kept by number; constraints that may repeat a number are kept in the
//! order of the file. Blank fields with a fixed default hold the default; where a blank has a meaning of its own
//! ("interpolate", "rigid in shear") the field is an `Option`.

mod components;
mod constraints;
mod elements;
mod origin;
mod points;
mod properties;
mod section;

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

pub use components::Components;
pub use constraints::{
    DofSet, Eigr, Eigrl, Mpc, MpcTerm, Param, Rbar, Rbe2, Rbe3, Rbe3Group, Set1, Spc, Spc1, Suport,
};
pub use elements::{
    Cbar, Cbeam, Cbush, Celas, Cmass, Conm1, Conm2, Conm2Frame, Conrod, Crod, Orientation, ScalarEnd,
    ScalarMassValue, ScalarSpringValue,
};
pub use origin::{Origin, Origins};
pub use points::{CoordinateDefinition, CoordinateKind, CoordinateSystem, Grdset, Grid};
pub use properties::{
    BarProperty, BeamEndData, BeamProperty, BeamSectionStation, BeamStation, BushLine, Mat1, Pbar, Pbarl,
    Pbeam, Pbeaml, Pbush, Pelas, Prod,
};
pub use section::{Section, SectionShape};

/// Number of a point, element, property, system or set.
pub type Id = u32;

/// A card that this crate does not interpret.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RawCard {
    /// Card name, upper case, without the `*` of large field.
    pub name: String,
    /// Fields after the name, continuations joined, trimmed, blank fields empty, trailing blanks dropped. Line
    /// ends of the original are kept as multiples of eight fields.
    pub fields: Vec<String>,
    /// Where it was read. Not part of equality, nor of the serialised form.
    #[serde(skip)]
    pub origin: Option<Origin>,
}

impl PartialEq for RawCard {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.fields == other.fields
    }
}

/// A Nastran input deck.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Deck {
    /// Lines before CEND: file management, NASTRAN statement and executive control, without comments.
    pub executive: Vec<String>,
    /// Lines between CEND and BEGIN BULK, without comments.
    pub case_control: Vec<String>,
    /// GRDSET; already applied to `grids`.
    pub grdset: Option<Grdset>,
    /// GRID.
    pub grids: BTreeMap<Id, Grid>,
    /// SPOINT.
    pub scalar_points: BTreeSet<Id>,
    /// CORD1R, CORD1C, CORD1S, CORD2R, CORD2C, CORD2S.
    pub coordinate_systems: BTreeMap<Id, CoordinateSystem>,
    /// CBAR.
    pub bars: BTreeMap<Id, Cbar>,
    /// CBEAM.
    pub beams: BTreeMap<Id, Cbeam>,
    /// CROD.
    pub rods: BTreeMap<Id, Crod>,
    /// CONROD.
    pub conrods: BTreeMap<Id, Conrod>,
    /// CONM1.
    pub conm1: BTreeMap<Id, Conm1>,
    /// CONM2.
    pub conm2: BTreeMap<Id, Conm2>,
    /// CMASS1, CMASS2, CMASS3, CMASS4.
    pub scalar_masses: BTreeMap<Id, Cmass>,
    /// PMASS: mass by property number, kg or kg m^2.
    pub mass_properties: BTreeMap<Id, f64>,
    /// CELAS1, CELAS2.
    pub springs: BTreeMap<Id, Celas>,
    /// CBUSH.
    pub bushes: BTreeMap<Id, Cbush>,
    /// PBAR, PBARL.
    pub bar_properties: BTreeMap<Id, BarProperty>,
    /// PBEAM, PBEAML.
    pub beam_properties: BTreeMap<Id, BeamProperty>,
    /// PROD.
    pub rod_properties: BTreeMap<Id, Prod>,
    /// PELAS.
    pub spring_properties: BTreeMap<Id, Pelas>,
    /// PBUSH.
    pub bush_properties: BTreeMap<Id, Pbush>,
    /// MAT1.
    pub materials: BTreeMap<Id, Mat1>,
    /// RBE2.
    pub rbe2: BTreeMap<Id, Rbe2>,
    /// RBE3.
    pub rbe3: BTreeMap<Id, Rbe3>,
    /// RBAR.
    pub rbars: BTreeMap<Id, Rbar>,
    /// MPC, in file order.
    pub mpcs: Vec<Mpc>,
    /// SPC, in file order, one entry for each point.
    pub spcs: Vec<Spc>,
    /// SPC1, in file order.
    pub spc1s: Vec<Spc1>,
    /// SUPORT and SUPORT1, one entry for each point.
    pub suports: Vec<Suport>,
    /// ASET and ASET1.
    pub asets: Vec<DofSet>,
    /// OMIT and OMIT1.
    pub omits: Vec<DofSet>,
    /// SET1.
    pub sets: BTreeMap<Id, Set1>,
    /// EIGR.
    pub eigr: BTreeMap<Id, Eigr>,
    /// EIGRL.
    pub eigrl: BTreeMap<Id, Eigrl>,
    /// PARAM of the bulk data, by upper-case name.
    pub params: BTreeMap<String, Param>,
    /// Every other card, in file order.
    pub raw: Vec<RawCard>,
    /// Where cards were read. Not part of equality, nor of the serialised form.
    #[serde(skip)]
    pub origins: Origins,
}

impl Deck {
    /// A parameter by upper-case name: of the bulk data, else of case control (`PARAM,name,value`).
    #[must_use]
    pub fn param(&self, name: &str) -> Option<Param> {
        self.params.get(name).cloned().or_else(|| {
            self.case_control.iter().find_map(|line| {
                let line = line.to_uppercase();
                let mut words = line.split([',', ' ', '\t', '=']).filter(|w| !w.is_empty());
                let is_wanted = words.next() == Some("PARAM") && words.next() == Some(name);
                let mut value = || words.next().unwrap_or_default().to_owned();
                is_wanted.then(|| Param {
                    name: name.to_owned(),
                    value: value(),
                    imaginary: value(),
                })
            })
        })
    }

    /// PARAM,WTMASS: the factor from the deck's mass data to mass (1 when absent). The grid point weight
    /// generator prints before it is applied.
    #[must_use]
    pub fn weight_to_mass(&self) -> f64 {
        self.param("WTMASS")
            .as_ref()
            .and_then(Param::as_real)
            .unwrap_or(1.0)
    }

    /// Names of uninterpreted cards with their counts, for reports of what was not understood.
    #[must_use]
    pub fn raw_card_counts(&self) -> BTreeMap<&str, usize> {
        let mut counts = BTreeMap::new();
        for card in &self.raw {
            *counts.entry(card.name.as_str()).or_insert(0) += 1;
        }
        counts
    }
}
