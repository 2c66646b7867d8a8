//! Units, told by size: lengths in mm or ft, masses in tonnes, moduli in MPa, gravity in mm/s².

use super::files::Files;
use super::{Findings, Severity, Subject};
use crate::case::SOLVE;
use albatross_flight::atmosphere::STANDARD_GRAVITY;

/// Length units by their number in a metre.
const LENGTHS: [(f64, &str); 4] = [(1000.0, "mm"), (100.0, "cm"), (39.370_08, "in"), (3.280_84, "ft")];
/// No aircraft is longer \[m\].
const LONGEST: f64 = 150.0;
/// Two models of one aircraft agree in size by this factor.
const SAME_SIZE: f64 = 1.4;
/// Moduli of structural materials \[Pa\]; below `EQUIVALENT` a number stands for a stiffness given by the section.
const MODULI: std::ops::RangeInclusive<f64> = 1e8..=1e12;
const EQUIVALENT: f64 = 100.0;
/// Weight over wing area of aircraft, from models to transports \[N/m²\].
const WING_LOADINGS: std::ops::RangeInclusive<f64> = 15.0..=15_000.0;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    lengths(subject, files, found);
    moduli(subject, files, found);
    gravity(subject, found);
}

/// Extent of points along each axis.
fn extent(points: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        for ((low, high), at) in low.iter_mut().zip(&mut high).zip(point) {
            *low = low.min(at);
            *high = high.max(at);
        }
    }
    [high[0] - low[0], high[1] - low[1], high[2] - low[2]].map(|length| length.max(0.0))
}

/// Span of a geometry, mirror images included \[its unit\].
fn span(geometry: &albatross_avl::geometry::Geometry) -> f64 {
    let mut points = Vec::new();
    for surface in &geometry.surfaces {
        for section in &surface.sections {
            let y = section.y_le * surface.scale[1] + surface.translate[1];
            points.push([0.0, y, 0.0]);
            points.extend(surface.y_duplicate.map(|plane| [0.0, 2.0 * plane - y, 0.0]));
        }
    }
    extent(points.into_iter())[1]
}

fn lengths(subject: &Subject, files: &Files, found: &mut Findings) {
    let size = extent(files.grids.values().copied());
    let longest = size.iter().fold(0.0_f64, |m, v| m.max(*v));
    let place = files.path(&subject.case.structure.deck);
    let deck_cure = |unit: &str| {
        format!(
            "give the deck in m, kg, N and Pa: {unit} become m in GRID, offsets, sections and CONM2; PARAM,WTMASS does \
             not change lengths"
        )
    };
    let of_geometry = files.geometry.as_ref().map(span).filter(|s| *s > 0.0);
    let [_, of_deck, _] = size;
    if let Some(of_geometry) = of_geometry.filter(|_| of_deck > 0.0) {
        let ratio = of_deck / of_geometry;
        let near = |factor: f64| (ratio / factor).max(factor / ratio) < 1.15;
        if ratio.max(1.0 / ratio) < SAME_SIZE {
            return;
        }
        let spans =
            format!("the deck spans {of_deck:.6} from left to right, the AVL geometry {of_geometry:.6}");
        if let Some((_, unit)) = LENGTHS.iter().find(|(factor, _)| near(*factor)) {
            return found.error(
                &place,
                format!("{spans}: the deck looks like {unit}"),
                deck_cure(unit),
            );
        }
        if let Some((_, unit)) = LENGTHS.iter().find(|(factor, _)| near(1.0 / factor)) {
            let geometry = files.path(&subject.case.aerodynamics.geometry);
            let cure = format!(
                "give the geometry in m: SCALE of each surface, Sref, Cref, Bref and Xref, and run AVL again ({unit} to m)"
            );
            return found.error(
                &geometry,
                format!("{spans}: the geometry looks like {unit}"),
                cure,
            );
        }
        found.warning(
            &place,
            spans,
            "check that both describe the same aircraft in m; a deck of one half needs its mirror image",
        );
    } else if longest > LONGEST {
        let what = format!("the grids extend over {longest:.6}: lengths look like mm");
        found.error(&place, what, deck_cure("mm"));
    }
}

fn moduli(subject: &Subject, files: &Files, found: &mut Findings) {
    let Some(deck) = &files.deck else { return };
    let computed = subject.case.structure.results == SOLVE;
    for material in deck.materials.values() {
        let Some(e) = material.e.filter(|e| *e >= EQUIVALENT && !MODULI.contains(e)) else {
            continue;
        };
        let file = files.path(&subject.case.structure.deck);
        let place = deck
            .origins
            .of("MAT1", material.id)
            .map_or(file, |o| format!("{}:{}", files.path(&o.file), o.line));
        let severity = if computed {
            Severity::Error
        } else {
            Severity::Warning
        };
        let what = format!("MAT1 {}: E = {e:e}", material.id);
        if MODULI.contains(&(e * 1e6)) && e < 1e6 {
            found.push(
                severity,
                &place,
                format!("{what} looks like MPa"),
                "give Pa: E and G times 1e6, and lengths in m",
            );
        } else if MODULI.contains(&(e * 6894.757)) {
            found.push(
                severity,
                &place,
                format!("{what} looks like psi"),
                "give Pa: E and G times 6894.757, and lengths in m",
            );
        } else {
            found.warning(
                &place,
                format!("{what} is no modulus of a structural material in Pa"),
                "check the units of the deck",
            );
        }
    }
}

fn gravity(subject: &Subject, found: &mut Findings) {
    let g = subject.case.flight.gravity;
    if (9.7..=9.9).contains(&g) {
        return;
    }
    let place = subject.at("flight.gravity");
    let (what, severity) = if (9_700.0..=9_900.0).contains(&g) {
        (format!("gravity is {g}, which looks like mm/s2"), Severity::Error)
    } else if (32.0..=32.4).contains(&g) {
        (format!("gravity is {g}, which looks like ft/s2"), Severity::Error)
    } else if (385.0..=388.0).contains(&g) {
        (format!("gravity is {g}, which looks like in/s2"), Severity::Error)
    } else {
        (format!("gravity is {g} m/s2"), Severity::Warning)
    };
    let cure = format!("give m/s2, or leave the key out for {STANDARD_GRAVITY}");
    found.push(severity, &place, what, cure);
}

/// The mass against the wing area.
pub(super) fn mass(subject: &Subject, files: &Files, mass: f64, area: f64, found: &mut Findings) {
    let loading = mass * subject.case.flight.gravity.min(10.0) / area;
    if WING_LOADINGS.contains(&loading) {
        return;
    }
    let place = files.path(&subject.case.structure.deck);
    let what = format!("a mass of {mass:.6} kg on {area:.5} m2 of wing: {loading:.3} N/m2");
    if loading < *WING_LOADINGS.start() {
        found.warning(
            &place,
            format!("{what}, less than any aircraft; masses look like tonnes, or one half is missing"),
            "give masses in kg: CONM2, NSM and density; or PARAM,WTMASS,1000. for tonnes with lengths in m",
        );
    } else {
        found.warning(
            &place,
            format!("{what}, more than any aircraft; masses look like weights or grams"),
            "give masses in kg; PARAM,WTMASS turns weights in N into masses (0.10197)",
        );
    }
}
