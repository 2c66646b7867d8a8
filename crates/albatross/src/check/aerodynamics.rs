//! The files of AVL against each other, the reference shape, and the controls.

use super::files::Files;
use super::{Findings, Subject, names};
use crate::case::{SOLVE, ThrustLine};
use albatross_avl::geometry::Geometry;
use albatross_avl::results::{Coefficient, Reference, StabilityDerivatives, StripForces};
use albatross_strip::slopes::base_name;
use std::collections::BTreeMap;

/// Printed digits of the text layout.
const DIGITS: f64 = 1e-4;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    surfaces(subject, files, found);
    if let Some(geometry) = &files.geometry {
        symmetry(subject, files, geometry, found);
        aerofoils(subject, files, geometry, found);
        if let Some(derivatives) = &files.derivatives {
            same_run(subject, files, geometry, derivatives, found);
        }
    }
    if let (Some(geometry), Some(strips)) = (&files.geometry, &files.strips[0]) {
        reference(subject, files, geometry, strips, found);
    }
    controls(subject, files, found);
}

fn derivatives_file(subject: &Subject, files: &Files) -> String {
    let name = subject.case.aerodynamics.derivatives.as_ref();
    name.map_or_else(|| subject.at("aerodynamics.results"), |name| files.path(name))
}

/// Surfaces of the case against those of the geometry and of the strip files.
fn surfaces(subject: &Subject, files: &Files, found: &mut Findings) {
    let aerodynamics = &subject.case.aerodynamics;
    if aerodynamics.surfaces.is_empty() {
        found.warning(
            &subject.at("aerodynamics.surface"),
            "no surface carries strips: the structure feels no unsteady aerodynamics",
            "add an [[aerodynamics.surface]] for each lifting surface",
        );
    }
    let same = |a: &str, b: &str| a.trim().eq_ignore_ascii_case(b.trim());
    if let Some(geometry) = &files.geometry {
        let known: Vec<&str> = geometry.surfaces.iter().map(|s| s.name.trim()).collect();
        for (i, surface) in aerodynamics.surfaces.iter().enumerate() {
            let place = subject.at(&format!("aerodynamics.surface.{i}.name"));
            let Some(own) = geometry.surfaces.iter().find(|s| same(&s.name, &surface.name)) else {
                let what = format!("`{}` is no surface of {}", surface.name, aerodynamics.geometry);
                found.error(&place, what, names::choose(&surface.name, &known));
                continue;
            };
            match (own.y_duplicate, &surface.image_lra) {
                (Some(_), None) => found.error(
                    &place,
                    format!(
                        "`{}` has a mirror image (YDUPLICATE), but no axis for it",
                        surface.name
                    ),
                    "add `image_lra`: the load reference axis of the other side",
                ),
                (None, Some(axis)) => found.warning(
                    &place,
                    format!(
                        "`{}` has no mirror image, but image_lra = \"{axis}\"",
                        surface.name
                    ),
                    "remove image_lra, or add YDUPLICATE to the geometry",
                ),
                _ => {}
            }
            if surface.downwash_gradient < 0.0 || surface.downwash_gradient > 0.7 {
                found.warning(
                    &subject.at(&format!("aerodynamics.surface.{i}.downwash_gradient")),
                    format!("a downwash gradient of {}", surface.downwash_gradient),
                    "tails see 0.2 to 0.6, wings and fins 0",
                );
            }
        }
        let left: Vec<&str> = known
            .iter()
            .copied()
            .filter(|k| !aerodynamics.surfaces.iter().any(|s| same(&s.name, k)))
            .collect();
        if !left.is_empty() {
            found.note(
                &subject.at("aerodynamics.surface"),
                format!(
                    "without strips, in the rigid derivatives alone: {}",
                    left.join(", ")
                ),
                "",
            );
        }
    }
    if let (Some(geometry), [Some(low), _]) = (&files.geometry, &files.strips) {
        let missing = low.surfaces.iter().find(|s| {
            !geometry
                .surfaces
                .iter()
                .any(|g| same(&g.name, base_name(&s.name)))
        });
        if let Some(surface) = missing {
            found.warning(
                &strip_file(subject, files, 0),
                format!(
                    "surface `{}` is not in {}",
                    surface.name.trim(),
                    aerodynamics.geometry
                ),
                "run AVL with this geometry: the controls' lift is spread by it",
            );
        }
    }
}

/// Path of a strip file.
pub(super) fn strip_file(subject: &Subject, files: &Files, index: usize) -> String {
    let strips = subject.case.aerodynamics.strips.as_ref();
    strips.and_then(|s| s.get(index)).map_or_else(
        || subject.at("aerodynamics.results"),
        |strip| files.path(&strip.file),
    )
}

fn symmetry(subject: &Subject, files: &Files, geometry: &Geometry, found: &mut Findings) {
    if geometry.i_ysym != 0 {
        found.error(
            &files.path(&subject.case.aerodynamics.geometry),
            format!("iYsym = {}: AVL models one half of the aircraft", geometry.i_ysym),
            "set iYsym to 0 and use YDUPLICATE, so that lateral derivatives are there too",
        );
    }
    if geometry.i_zsym != 0 {
        found.warning(
            &files.path(&subject.case.aerodynamics.geometry),
            format!(
                "iZsym = {}: a ground or free-surface image acts on the aircraft",
                geometry.i_zsym
            ),
            "set iZsym to 0 for free flight",
        );
    }
}

/// Aerofoil files that the lattice would miss.
fn aerofoils(subject: &Subject, files: &Files, geometry: &Geometry, found: &mut Findings) {
    use albatross_avl::geometry::Airfoil;
    if subject.case.aerodynamics.results.as_deref() != Some(SOLVE) {
        return;
    }
    let geometry_file = files.directory.join(&subject.case.aerodynamics.geometry);
    let beside = geometry_file.parent().unwrap_or(std::path::Path::new(""));
    let mut seen = std::collections::BTreeSet::new();
    for section in geometry.surfaces.iter().flat_map(|s| &s.sections) {
        if let Airfoil::File { path: file, .. } = &section.airfoil
            && seen.insert(file)
            && !beside.join(file).is_file()
        {
            found.warning(
                &geometry_file.display().to_string(),
                format!("the aerofoil file `{file}` is not there: its sections are taken as flat"),
                "put it beside the geometry file",
            );
        }
    }
}

/// Whether geometry and derivatives are of one run, and about the right point.
fn same_run(
    subject: &Subject,
    files: &Files,
    geometry: &Geometry,
    derivatives: &StabilityDerivatives,
    found: &mut Findings,
) {
    let aerodynamics = &subject.case.aerodynamics;
    if aerodynamics.derivatives.is_none() {
        return;
    }
    let place = derivatives_file(subject, files);
    let differ = |a: f64, b: f64| (a - b).abs() > DIGITS * b.abs().max(1.0);
    let printed = &derivatives.run.reference;
    for (name, run, file) in [
        ("Sref", printed.s_ref, geometry.s_ref),
        ("Cref", printed.c_ref, geometry.c_ref),
        ("Bref", printed.b_ref, geometry.b_ref),
    ] {
        if differ(run, file) {
            found.error(
                &place,
                format!("{name} is {run} here and {file} in {}", aerodynamics.geometry),
                "run AVL again with this geometry, so that both refer to one shape",
            );
        }
    }
    for (name, run, file) in [
        ("Xref", printed.x_ref, geometry.x_ref),
        ("Yref", printed.y_ref, geometry.y_ref),
        ("Zref", printed.z_ref, geometry.z_ref),
    ] {
        if differ(run, file) {
            found.note(
                &place,
                format!(
                    "{name} is {run} here and {file} in {}; moments are taken about the run's",
                    aerodynamics.geometry
                ),
                "check that a .run file moved it on purpose",
            );
        }
    }
    let count: usize = files.strips[0]
        .iter()
        .flat_map(|s| &s.surfaces)
        .map(|s| s.strips.len())
        .sum();
    if files.strips[0].is_some() && derivatives.run.n_strips != 0 && derivatives.run.n_strips != count {
        found.warning(
            &place,
            format!(
                "the run has {} strips, the strip files {count}",
                derivatives.run.n_strips
            ),
            "write derivatives and strips in one session of AVL, with one geometry",
        );
    }
}

/// The wing: the surface of the case with the largest area.
pub(super) struct Wing {
    pub(super) name: String,
    /// Area of both halves \[m²\].
    pub(super) area: f64,
    /// Span \[m\].
    pub(super) span: f64,
    /// Sweep of the quarter chord, mean by area \[rad\].
    pub(super) sweep_rad: f64,
}

impl Wing {
    pub(super) fn find(subject: &Subject, strips: &StripForces) -> Option<Self> {
        let mut areas: BTreeMap<String, f64> = BTreeMap::new();
        for surface in &strips.surfaces {
            let area: f64 = surface.strips.iter().map(|s| s.area).sum();
            *areas
                .entry(base_name(&surface.name).trim().to_lowercase())
                .or_default() += area;
        }
        let named = |name: &str| {
            let surfaces = &subject.case.aerodynamics.surfaces;
            surfaces.iter().any(|s| s.name.trim().eq_ignore_ascii_case(name))
        };
        let (name, area) = areas
            .into_iter()
            .filter(|(name, _)| named(name))
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        let of_wing = || {
            let own = strips.surfaces.iter();
            own.filter(|s| base_name(&s.name).trim().eq_ignore_ascii_case(&name))
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut tangent, mut weight) = (0.0, 0.0);
        for surface in of_wing() {
            for strip in &surface.strips {
                let half = if strip.chord > 0.0 {
                    0.5 * strip.area / strip.chord
                } else {
                    0.0
                };
                low = low.min(strip.y_le - half);
                high = high.max(strip.y_le + half);
            }
            for pair in surface.strips.windows(2) {
                let [a, b] = pair else { continue };
                let quarter = |s: &albatross_avl::results::Strip| s.x_le.unwrap_or(0.0) + 0.25 * s.chord;
                let (dx, dy) = (quarter(b) - quarter(a), (b.y_le.abs() - a.y_le.abs()).abs());
                if dy > 1e-9 {
                    tangent += dx / dy * a.area;
                    weight += a.area;
                }
            }
        }
        let display = of_wing()
            .next()
            .map_or(name.clone(), |s| base_name(&s.name).trim().to_owned());
        Some(Self {
            name: display,
            area,
            span: (high - low).max(0.0),
            sweep_rad: if weight > 0.0 {
                (tangent / weight).atan().abs()
            } else {
                0.0
            },
        })
    }
}

/// The reference shape against the strips of the wing.
fn reference(
    subject: &Subject,
    files: &Files,
    geometry: &Geometry,
    strips: &StripForces,
    found: &mut Findings,
) {
    let Some(wing) = Wing::find(subject, strips).filter(|w| w.area > 0.0 && w.span > 0.0) else {
        return;
    };
    let own = subject.case.reference;
    let run = files.derivatives.as_ref().map(|d| &d.run.reference);
    let (area, chord, span, place) = match (own, run) {
        (Some(r), _) => (r.area, r.chord, r.span, subject.at("reference")),
        (None, Some(r)) if subject.case.aerodynamics.derivatives.is_some() => {
            (r.s_ref, r.c_ref, r.b_ref, derivatives_file(subject, files))
        }
        _ => {
            let file = files.path(&subject.case.aerodynamics.geometry);
            (geometry.s_ref, geometry.c_ref, geometry.b_ref, file)
        }
    };
    let mut compare = |what: &str,
                       given: f64,
                       measured: f64,
                       unit: &str,
                       range: std::ops::RangeInclusive<f64>| {
        if given <= 0.0 || !given.is_finite() {
            found.error(
                &place,
                format!("{what} is {given}"),
                "give a positive number in the header of the geometry",
            );
            return;
        }
        let ratio = given / measured;
        if range.contains(&ratio) {
            return;
        }
        let near = |factor: f64| (ratio / factor - 1.0).abs() < 0.15;
        let hint = if near(0.5) {
            "half of it: the reference of one side?"
        } else if near(2.0) {
            "twice as much"
        } else if ratio > 300.0 {
            "in mm?"
        } else if near(10.7639) || near(3.28084) {
            "in feet?"
        } else {
            "another shape?"
        };
        found.warning(
            &place,
            format!("{what} is {given} {unit}, the strips of `{}` make {measured:.4} {unit} ({hint})", wing.name),
            "correct Sref, Cref, Bref in the geometry and run AVL again; or give the shape that the coefficients refer \
             to as [reference]",
        );
    };
    compare("the reference area", area, wing.area, "m2", 0.7..=1.4);
    compare("the reference span", span, wing.span, "m", 0.8..=1.25);
    compare(
        "the reference chord",
        chord,
        wing.area / wing.span,
        "m",
        0.7..=1.7,
    );
    let printed = |r: &Reference| (r.s_ref - geometry.s_ref).abs() > DIGITS * geometry.s_ref.abs();
    if let Some(other) = strips.reference.as_ref().filter(|r| printed(r)) {
        found.warning(
            &strip_file(subject, files, 0),
            format!(
                "Sref is {} here and {} in the geometry",
                other.s_ref, geometry.s_ref
            ),
            "write the strip files with this geometry",
        );
    }
}

/// Names of the controls.
pub(super) fn control_names(files: &Files) -> Option<Vec<&str>> {
    match (&files.derivatives, &files.geometry) {
        (Some(derivatives), _) => Some(derivatives.controls.iter().map(|c| c.name.trim()).collect()),
        (None, Some(geometry)) => Some(geometry.control_names()),
        _ => None,
    }
}

fn controls(subject: &Subject, files: &Files, found: &mut Findings) {
    let Some(known) = control_names(files) else { return };
    let trim = &subject.case.flight.trim_control;
    let place = subject.at("flight.trim_control");
    let is_known = known.iter().any(|k| k == trim);
    if !is_known {
        found.error(
            &place,
            format!("`{trim}` is no control of the AVL files"),
            names::choose(trim, &known),
        );
    }
    if let (Some(geometry), Some(derivatives)) = (&files.geometry, &files.derivatives) {
        let drawn = geometry.control_names();
        let computed: Vec<&str> = derivatives.controls.iter().map(|c| c.name.trim()).collect();
        let lacks = |list: &[&str], others: &[&str]| -> Vec<String> {
            let absent = others.iter().filter(|o| !list.contains(o));
            absent.map(ToString::to_string).collect()
        };
        for (absent, where_not) in [
            (
                lacks(&drawn, &computed),
                subject.case.aerodynamics.geometry.clone(),
            ),
            (lacks(&computed, &drawn), derivatives_file(subject, files)),
        ] {
            if !absent.is_empty() {
                found.warning(
                    &derivatives_file(subject, files),
                    format!("controls that {where_not} lacks: {}", absent.join(", ")),
                    "run AVL again with this geometry; names must agree to the letter",
                );
            }
        }
        if is_known && let Some(column) = derivatives.control(trim) {
            let pitch = column.get(Coefficient::Pitch).unwrap_or(0.0);
            let lateral = column.roll.abs().max(column.yaw.abs());
            let able: Vec<&str> = derivatives
                .controls
                .iter()
                .filter(|c| c.column.pitch.abs() > 1e-5)
                .map(|c| c.name.trim())
                .collect();
            if pitch.abs() < 1e-5 || lateral > 10.0 * pitch.abs() {
                found.error(
                    &place,
                    format!("`{trim}` hardly changes the pitching moment: {pitch:.2e} a degree"),
                    format!("trim with a control that does: {}", able.join(", ")),
                );
            } else if pitch > 0.0 {
                found.note(
                    &place,
                    format!("`{trim}` raises the nose when positive ({pitch:.2e} a degree)"),
                    "usual for a canard; else check the sign of its gain in the geometry",
                );
            }
        }
    }
    let engines_used = subject
        .case
        .variants
        .iter()
        .any(|v| v.thrust_line == ThrustLine::Engines);
    if known.contains(&"thrust") && engines_used {
        found.warning(
            &place,
            "a control is named `thrust`, as the engines' input",
            "rename the control",
        );
    }
}
