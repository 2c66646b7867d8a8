//! The files of AVL against each other.

use super::files::Files;
use super::{Findings, Subject, controls, names, reference};
use crate::case::SOLVE;
use albatross_avl::geometry::Geometry;
use albatross_avl::results::StabilityDerivatives;
use albatross_strip::slopes::base_name;

/// Printed digits of the text layout.
pub(super) const DIGITS: f64 = 1e-4;

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
        reference::check(subject, files, geometry, strips, found);
    }
    controls::check(subject, files, found);
}

/// Path of the file of derivatives.
pub(super) fn derivatives_file(subject: &Subject, files: &Files) -> String {
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
