//! Elements of a deck that are not modelled.

use albatross_nastran::Deck;

/// Cards that begin with C and are no elements, and elements without stiffness or mass in normal modes: plots,
/// dampers, aerodynamics.
const HARMLESS: [&str; 21] = [
    "CORD1R", "CORD2R", "CORD1C", "CORD2C", "CORD1S", "CORD2S", "CORD3G", "CDAMP1", "CDAMP2", "CDAMP3",
    "CDAMP4", "CDAMP5", "CVISC", "CAERO1", "CAERO2", "CAERO3", "CAERO4", "CAERO5", "CSET", "CSET1", "CSUPER",
];
/// Cards of other names that add stiffness, mass or constraints.
const STRUCTURAL: [&str; 17] = [
    "GENEL", "RBE1", "RROD", "RSPLINE", "RSSCON", "RTRPLT", "RTRPLT1", "RJOINT", "RSPINR", "NSM", "NSM1",
    "NSML", "NSML1", "NSMADD", "MFLUID", "DMIG", "SPCD",
];

/// One line for each kind: count and name.
pub(crate) fn elements(deck: &Deck) -> Vec<String> {
    let is_element =
        |name: &str| (name.starts_with('C') && !HARMLESS.contains(&name)) || STRUCTURAL.contains(&name);
    let counts = deck.raw_card_counts();
    let mut found: Vec<String> = counts
        .iter()
        .filter(|(name, _)| is_element(name))
        .map(|(name, n)| format!("{n} {name}"))
        .collect();
    for (command, what) in [("K2GG", "stiffness"), ("M2GG", "mass")] {
        let named = |line: &&String| line.trim_start().to_ascii_uppercase().starts_with(command);
        if deck.case_control.iter().any(|line| named(&line)) {
            found.push(format!("a direct {what} matrix ({command} in case control)"));
        }
    }
    found
}
