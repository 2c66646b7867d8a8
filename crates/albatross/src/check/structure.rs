//! Deck, modes, damping and load reference axes.

use super::files::Files;
use super::{Findings, Subject, flight, names, units};
use crate::case::{Damping, OnViolation, SOLVE, grid_list};
use albatross_fem::{BarMass, DeckMass, MassProperties, free_directions};
use albatross_nastran::frames::Frames;
use albatross_nastran::{Deck, Dialect, ModalResults, PointKind};
use std::collections::BTreeSet;

/// Below this frequency a mode is a rigid-body mode \[Hz\].
const RIGID_HZ: f64 = 0.05;
/// More structural damping than any airframe has, as a ratio of critical.
const MUCH_DAMPING: f64 = 0.2;

/// Returns the mass that flies.
pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) -> Option<MassProperties> {
    damping(subject, found);
    tolerance(subject, found);
    axes(subject, files, found);
    let deck = files.deck.as_ref()?;
    let mass = masses(subject, files, deck, found);
    if let (Some(mass), Some(geometry)) = (&mass, &files.geometry)
        && geometry.s_ref > 0.0
    {
        units::mass(subject, files, mass.mass, geometry.s_ref, found);
        flight::lift(subject, files, mass.mass, geometry.s_ref, found);
        mass_file(files, mass, found);
    }
    free(subject, files, deck, mass.as_ref(), found);
    if let Some(results) = &files.results {
        modes(subject, files, deck, results, found);
    }
    mass
}

fn damping(subject: &Subject, found: &mut Findings) {
    let place = subject.at("structure.damping_ratio");
    let ratios: &[f64] = match &subject.case.structure.damping_ratio {
        Damping::Uniform(ratio) => std::slice::from_ref(ratio),
        Damping::PerMode(list) => list,
    };
    let most = ratios.iter().fold(0.0_f64, |m, r| m.max(*r));
    if most > MUCH_DAMPING {
        found.warning(
            &place,
            format!("a structural damping ratio of {most}"),
            "give the ratio of critical damping: 1 % is 0.01, and a coefficient g (twice the ratio) must be halved",
        );
    } else if most == 0.0 && !ratios.is_empty() {
        found.warning(
            &place,
            "no structural damping at all",
            "measured airframes have 0.005 to 0.03; keep 0 only to study undamped modes",
        );
    }
}

fn tolerance(subject: &Subject, found: &mut Findings) {
    let structure = &subject.case.structure;
    if structure.mean_axes_tolerance > 1e-3 {
        found.warning(
            &subject.at("structure.mean_axes_tolerance"),
            format!("modes with a share of {:e} of rigid motion pass", structure.mean_axes_tolerance),
            "free modes of one deck come out below 1e-6; find the cause, or use on_violation = \"orthogonalise\"",
        );
    }
    if structure.on_violation == OnViolation::Accept {
        found.warning(
            &subject.at("structure.on_violation"),
            "modes with rigid motion are accepted, which counts it twice",
            "use \"orthogonalise\" to remove the rigid motion",
        );
    }
}

/// Load reference axes against deck and results.
fn axes(subject: &Subject, files: &Files, found: &mut Findings) {
    let printed: Option<BTreeSet<u32>> = files.results.as_ref().and_then(|r| {
        let rows = &r.eigenvectors.first()?.rows;
        Some(
            rows.iter()
                .filter(|r| r.kind == PointKind::Grid)
                .map(|r| r.id)
                .collect(),
        )
    });
    for (name, entries) in &subject.case.structure.lra {
        let place = subject.at(&format!("structure.lra.{name}"));
        let grids = match grid_list(entries) {
            Ok(grids) => grids,
            Err(error) => {
                found.of_error(&error.to_string(), &place);
                continue;
            }
        };
        let mut missing = |known: &dyn Fn(&u32) -> bool, what: &str, cure: String| {
            let absent: Vec<u32> = grids.iter().copied().filter(|g| !known(g)).collect();
            let ids = ranges(&absent);
            if !absent.is_empty() {
                found.error(
                    &place,
                    format!("axis `{name}` has grids that {what}: {ids}"),
                    cure,
                );
            }
            absent.is_empty()
        };
        let in_deck = files.deck.is_none()
            || missing(
                &|g| files.grids.contains_key(g),
                "the deck lacks",
                format!(
                    "use grids of the deck; near them are {}",
                    near(&files.grids, &grids)
                ),
            );
        if in_deck && let Some(printed) = &printed {
            let cure = "print their displacements: DISPLACEMENT(PRINT) = ALL, or a SET that holds them, and run again";
            missing(&|g| printed.contains(g), "the results do not print", cure.into());
        }
    }
}

/// Grids as ranges: `1 to 4, 7`.
fn ranges(ids: &[u32]) -> String {
    let mut texts: Vec<String> = Vec::new();
    for run in ids.chunk_by(|a, b| a.checked_add(1) == Some(*b)) {
        match run {
            [only] => texts.push(only.to_string()),
            [first, .., last] => texts.push(format!("{first} to {last}")),
            [] => {}
        }
    }
    texts.join(", ")
}

/// Grids that are there around the first one that is not.
fn near(grids: &std::collections::BTreeMap<u32, [f64; 3]>, wanted: &[u32]) -> String {
    let Some(absent) = wanted.iter().find(|g| !grids.contains_key(g)) else {
        return String::new();
    };
    let below: Vec<&u32> = grids.range(..absent).rev().take(2).map(|(id, _)| id).collect();
    let above = grids.range(absent..).take(2).map(|(id, _)| id);
    let all: Vec<String> = below.into_iter().rev().chain(above).map(u32::to_string).collect();
    all.join(", ")
}

/// The deck's mass, compared with the weight generator of the results.
fn masses(subject: &Subject, files: &Files, deck: &Deck, found: &mut Findings) -> Option<MassProperties> {
    let place = files.path(&subject.case.structure.deck);
    let frames = Frames::resolve(deck).ok()?;
    // How the mass of bars is spread does not change their sum.
    let assembled = match DeckMass::assemble(deck, &frames, BarMass::Lumped) {
        Ok(mass) => mass,
        Err(error) => {
            found.of_error(&error.to_string(), &place);
            return None;
        }
    };
    let incomplete = assembled.incomplete();
    let own = assembled.model.properties();
    let weight = files.results.as_ref().and_then(|r| r.weights.first());
    let named = subject.case.structure.results != SOLVE && files.results.is_some();
    let results = files.path(&subject.case.structure.results);
    match (weight, &own, &incomplete) {
        (None, _, Some(why)) if named => found.error(
            &results,
            format!("no output of the grid point weight generator, and {why}"),
            "add PARAM,GRDPNT,0 to the deck and run again",
        ),
        (None, Some(_), None) if named => found.note(
            &results,
            "no output of the grid point weight generator: the mass is that of the deck's cards alone",
            "add PARAM,GRDPNT,0 to the deck to have it compared",
        ),
        (None, None, _) => found.error(
            &place,
            "the deck has no mass",
            "add CONM2 cards, densities or NSM",
        ),
        (Some(weight), Some(own), None) => {
            let factor = deck.weight_to_mass();
            let [x, y, z] = weight.directional_masses();
            let printed = factor * x.max(y).max(z);
            if (own.mass / printed - 1.0).abs() > 1e-5 {
                found.error(
                    &place,
                    format!(
                        "the deck's mass is {} kg, the weight generator of {} printed {} kg",
                        names::digits(own.mass, 7),
                        subject.case.structure.results,
                        names::digits(printed, 7)
                    ),
                    "deck and results are of different mass states: run SOL 103 with this deck, or give the deck that \
                     made the results",
                );
            }
        }
        _ => {}
    }
    let of_weight = || {
        let weight = weight?;
        (weight.reference_point == 0)
            .then(|| MassProperties::from_rigid_mass(&weight.mo, [0.0; 3]))
            .flatten()
    };
    match incomplete {
        None => own,
        Some(_) => of_weight(),
    }
}

/// The `.mass` file beside the geometry, which AVL's own run used.
fn mass_file(files: &Files, mass: &MassProperties, found: &mut Findings) {
    let (Some((place, file)), Some(geometry)) = (&files.mass, &files.geometry) else {
        return;
    };
    let items: Vec<_> = file.items.iter().map(|i| i.in_named_units(file)).collect();
    let total: f64 = items.iter().map(|i| i.mass).sum();
    if total <= 0.0 {
        return;
    }
    let cure = "make both from one mass state; the deck's is the one that flies";
    if (total / mass.mass - 1.0).abs() > 5e-3 {
        let what = format!(
            "its mass is {} kg, that of the deck {} kg",
            names::digits(total, 7),
            names::digits(mass.mass, 7)
        );
        found.warning(place, what, cure);
    }
    let mut cg = [0.0; 3];
    for item in &items {
        for (cg, x) in cg.iter_mut().zip(item.position) {
            *cg += item.mass * x / total;
        }
    }
    let apart = cg
        .iter()
        .zip(&mass.cg)
        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    if apart > 0.02 * geometry.c_ref {
        let text = |c: &[f64; 3]| {
            // To 0.1 mm.
            c.map(|v| names::digits((v * 1e4).round() * 1e-4, 7)).join(", ")
        };
        let what = format!(
            "its centre of gravity is at {}, that of the deck at {}",
            text(&cg),
            text(&mass.cg)
        );
        found.warning(place, what, cure);
    }
}

/// Supports that hold the structure.
fn free(subject: &Subject, files: &Files, deck: &Deck, mass: Option<&MassProperties>, found: &mut Findings) {
    let Ok(frames) = Frames::resolve(deck) else { return };
    let center = mass.map_or([0.0; 3], |m| m.cg);
    let free = free_directions(deck, &frames, center, subject.case.structure.subcase);
    let held: Vec<&str> = albatross_fem::RIGID_DIRECTIONS
        .iter()
        .zip(free)
        .filter(|(_, free)| !free)
        .map(|(name, _)| *name)
        .collect();
    if !held.is_empty() {
        found.warning(
            &files.path(&subject.case.structure.deck),
            format!("constraints hold the aircraft: {}", held.join(", ")),
            "modes of free flight come from a free model: take the SPC out of case control, or the fixed components of \
             the GRID cards, and solve again; SUPORT does not hold",
        );
    }
}

/// The modes that the results hold.
fn modes(subject: &Subject, files: &Files, deck: &Deck, results: &ModalResults, found: &mut Findings) {
    let structure = &subject.case.structure;
    let place = if structure.results == SOLVE {
        subject.at("structure.results")
    } else {
        files.path(&structure.results)
    };
    if let Some(table) = results.eigenvalues.first() {
        let rigid = table.modes.iter().filter(|m| m.frequency_hz < RIGID_HZ).count();
        if rigid < 6 {
            found.warning(
                &place,
                format!("{rigid} modes below {RIGID_HZ} Hz where a free aircraft has six"),
                "solve the free model; if the run left its rigid-body modes out (V1 of EIGRL), ignore this",
            );
        } else if rigid > 6 {
            found.warning(
                &place,
                format!("{rigid} modes below {RIGID_HZ} Hz where a free aircraft has six: a mechanism"),
                "look for free-turning control surfaces, pins and loose grids in the deck",
            );
        }
        let first = table.modes.iter().find(|m| m.frequency_hz >= RIGID_HZ);
        if let Some(first) = first.filter(|m| m.frequency_hz > 100.0) {
            found.warning(
                &place,
                format!("the first elastic mode is at {:.1} Hz", first.frequency_hz),
                "check the units of mass and stiffness: the aircraft is as good as rigid",
            );
        }
        frequencies(subject, table.modes.last().map(|m| m.omega_rad_s), found);
    }
    if results.dialect == Dialect::Unknown && structure.results != SOLVE {
        found.note(&place, "no banner tells which program printed the file", "");
    }
    if let Err(error) = subject.case.basis(deck, results) {
        let text = error.to_string();
        let (own, _) = names::split_place(&text, "");
        let place = if own.is_empty() { &place } else { own };
        found.of_error(&text, place);
    }
}

/// The band of the frequency response against that of the modes.
fn frequencies(subject: &Subject, highest: Option<f64>, found: &mut Findings) {
    let to = subject.case.bode.to_rad_s;
    if let Some(highest) = highest.filter(|h| to > 2.0 * h && subject.document.has("bode")) {
        found.note(
            &subject.at("bode.to_rad_s"),
            format!("the response goes to {to} rad/s, the modes only to {highest:.1} rad/s"),
            "take more modes, or end the band sooner",
        );
    }
}
