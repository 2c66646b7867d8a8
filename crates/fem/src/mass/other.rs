//! Mass in a deck that the mass matrix does not hold.

use albatross_nastran::Deck;
use albatross_nastran::deck::{Id, RawCard, ScalarMassValue};
use std::collections::BTreeMap;

/// Elements that are read as raw cards and have mass through a property: (element, the cards that can be its
/// property). An empty list: the element has no property whose mass can be judged here.
const ELEMENTS: [(&str, &[&str]); 28] = [
    ("CQUAD4", SHELL),
    ("CQUADR", SHELL),
    ("CQUAD8", SHELL),
    ("CTRIA3", SHELL),
    ("CTRIAR", SHELL),
    ("CTRIA6", SHELL),
    ("CQUAD1", &[]),
    ("CQUAD2", &[]),
    ("CTRIA1", &[]),
    ("CTRIA2", &[]),
    ("CQDMEM", &[]),
    ("CTRMEM", &[]),
    ("CSHEAR", &["PSHEAR"]),
    ("CTUBE", &["PTUBE"]),
    ("CHEXA", SOLID),
    ("CHEXA1", &[]),
    ("CHEXA2", &[]),
    ("CPENTA", SOLID),
    ("CTETRA", SOLID),
    ("CPYRAM", SOLID),
    ("CWEDGE", &[]),
    ("CTRIAX6", &[]),
    ("CQUADX", &[]),
    ("CTRIAX", &[]),
    ("CBEND", &[]),
    ("CBEAM3", &[]),
    ("CELBOW", &[]),
    ("CONM3", &[]),
];
const SHELL: &[&str] = &["PSHELL"];
const SOLID: &[&str] = &["PSOLID"];

/// Cards that add mass by themselves.
const ADDED: [&str; 7] = ["NSM", "NSM1", "NSML", "NSML1", "NSMADD", "MFLUID", "CMASS"];

/// One line of text for each kind of mass that is left out.
pub(super) fn masses(deck: &Deck) -> Vec<String> {
    let mut found = Vec::new();
    scalar_masses(deck, &mut found);
    bushes(deck, &mut found);
    raw_elements(deck, &mut found);
    let counts = deck.raw_card_counts();
    for name in ADDED {
        if let Some(n) = counts.get(name) {
            found.push(format!("{n} {name}"));
        }
    }
    let direct = |line: &&String| line.trim_start().to_ascii_uppercase().starts_with("M2GG");
    if deck.case_control.iter().any(|line| direct(&line)) {
        found.push("a direct mass matrix (M2GG in case control)".into());
    }
    found
}

fn scalar_masses(deck: &Deck, found: &mut Vec<String>) {
    let massless = |value: &ScalarMassValue| match value {
        ScalarMassValue::Value(m) => *m == 0.0,
        ScalarMassValue::Property(pid) => deck.mass_properties.get(pid) == Some(&0.0),
    };
    let massive: Vec<Id> = deck
        .scalar_masses
        .values()
        .filter(|c| !massless(&c.value))
        .map(|c| c.id)
        .collect();
    if !massive.is_empty() {
        found.push(format!(
            "{} CMASSi scalar masses ({})",
            massive.len(),
            crate::text::ranges(&massive)
        ));
    }
}

/// CBUSH with mass, as text.
pub(super) fn bush_masses(deck: &Deck) -> Vec<String> {
    let mut found = Vec::new();
    bushes(deck, &mut found);
    found
}

fn bushes(deck: &Deck, found: &mut Vec<String>) {
    let has_mass = |pid: &Id| {
        let line = deck.bush_properties.get(pid).and_then(|p| p.m);
        line.is_some_and(|m| m.iter().flatten().any(|&v| v != 0.0))
    };
    let massive: Vec<Id> = deck
        .bushes
        .values()
        .filter(|b| has_mass(&b.pid))
        .map(|b| b.id)
        .collect();
    if !massive.is_empty() {
        found.push(format!(
            "{} CBUSH with mass ({})",
            massive.len(),
            crate::text::ranges(&massive)
        ));
    }
}

fn raw_elements(deck: &Deck, found: &mut Vec<String>) {
    let mut properties: BTreeMap<(&str, &str), &RawCard> = BTreeMap::new();
    for card in &deck.raw {
        if let Some(pid) = card.fields.first() {
            properties.insert((&card.name, pid), card);
        }
    }
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for card in &deck.raw {
        let Some((name, property_names)) = ELEMENTS.iter().find(|e| e.0 == card.name) else {
            continue;
        };
        // A blank property field means the element's own number.
        let field = |i: usize| card.fields.get(i).map(String::as_str).filter(|f| !f.is_empty());
        let pid = field(1).or(field(0)).unwrap_or("");
        let property = property_names.iter().find_map(|p| properties.get(&(*p, pid)));
        if !property.is_some_and(|p| is_massless(deck, p)) {
            *counts.entry(name).or_insert(0) += 1;
        }
    }
    found.extend(counts.iter().map(|(name, n)| format!("{n} {name}")));
}

/// Whether a property is known to give no mass: its materials are MAT1 without density and its non-structural mass
/// is zero or blank.
fn is_massless(deck: &Deck, property: &RawCard) -> bool {
    let (material, nsm): (&[usize], Option<usize>) = match property.name.as_str() {
        "PSHELL" => (&[1, 3, 5], Some(7)),
        "PSHEAR" => (&[1], Some(3)),
        "PTUBE" => (&[1], Some(4)),
        "PSOLID" => (&[1], None),
        _ => return false,
    };
    let field = |i: usize| {
        property
            .fields
            .get(i)
            .map(String::as_str)
            .filter(|f| !f.is_empty())
    };
    let no_density = |mid: &str| {
        let material = mid.parse::<Id>().ok().and_then(|mid| deck.materials.get(&mid));
        material.is_some_and(|m| m.rho == 0.0)
    };
    let zero = |text: &str| albatross_nastran::number::real(text.as_bytes()) == Some(0.0);
    material.iter().filter_map(|&i| field(i)).all(no_density) && nsm.and_then(field).is_none_or(zero)
}
