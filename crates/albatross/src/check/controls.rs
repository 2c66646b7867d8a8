//! The controls: names, and whether the trim control trims.

use super::aerodynamics::derivatives_file;
use super::files::Files;
use super::{Findings, Subject, names};
use crate::case::ThrustLine;
use albatross_avl::results::Coefficient;

/// Names of the controls.
pub(super) fn names_of(files: &Files) -> Option<Vec<&str>> {
    match (&files.derivatives, &files.geometry) {
        (Some(derivatives), _) => Some(derivatives.controls.iter().map(|c| c.name.trim()).collect()),
        (None, Some(geometry)) => Some(geometry.control_names()),
        _ => None,
    }
}

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    let Some(known) = names_of(files) else { return };
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
