//! Engines, variants and sensors.

use super::files::Files;
use super::{Findings, Subject, names};
use crate::case::ThrustLine;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    engines(subject, files, found);
    sensors(subject, files, found);
}

/// Grids around one that is not there.
fn near(files: &Files, wanted: u32) -> String {
    let below: Vec<u32> = files
        .grids
        .range(..wanted)
        .rev()
        .take(2)
        .map(|(id, _)| *id)
        .collect();
    let above = files.grids.range(wanted..).take(2).map(|(id, _)| *id);
    let all: Vec<String> = below
        .into_iter()
        .rev()
        .chain(above)
        .map(|id| id.to_string())
        .collect();
    format!("use a grid of the deck; near it are {}", all.join(", "))
}

fn engines(subject: &Subject, files: &Files, found: &mut Findings) {
    let case = subject.case;
    let used = case
        .variants
        .iter()
        .position(|v| v.thrust_line == ThrustLine::Engines);
    if let Some(i) = used.filter(|_| case.engines.is_empty()) {
        found.error(
            &subject.at(&format!("variant.{i}.thrust_line")),
            "the thrust line is that of the engines, but the case has none",
            "add an [[engine]] with its grid, or set thrust_line = \"through_cg\"",
        );
    }
    if case.engines.is_empty() {
        return;
    }
    let place = subject.at("engine.0");
    if used.is_none() {
        found.note(
            &place,
            "engines are named, but no variant uses them: the thrust acts through the centre of gravity",
            "set thrust_line = \"engines\" in a [[variant]]",
        );
    }
    let total: f64 = case.engines.iter().map(|e| e.share).sum();
    if (total - 1.0).abs() > 1e-9 {
        found.error(
            &subject.at("engine.0.share"),
            format!("the engines' shares of the thrust add up to {total}"),
            format!(
                "make them add up to 1: {} each for {} equal engines",
                1.0 / case.engines.len() as f64,
                case.engines.len()
            ),
        );
    }
    let (mut moment, mut complete) = (0.0, true);
    for (i, engine) in case.engines.iter().enumerate() {
        if files.grids.is_empty() {
            continue;
        }
        match files.grids.get(&engine.grid) {
            Some(point) => moment += engine.share * point[1],
            None => {
                complete = false;
                found.error(
                    &subject.at(&format!("engine.{i}.grid")),
                    format!(
                        "engine `{}` is at grid {}, which the deck lacks",
                        engine.name, engine.grid
                    ),
                    near(files, engine.grid),
                );
            }
        }
        if engine.incidence_deg.abs() > 20.0 || engine.toe_deg.abs() > 20.0 {
            found.warning(
                &subject.at(&format!("engine.{i}")),
                format!(
                    "engine `{}` points {} deg up and {} deg to the right",
                    engine.name, engine.incidence_deg, engine.toe_deg
                ),
                "give the direction of the thrust in degrees from body x",
            );
        }
    }
    if complete && moment.abs() > 0.01 {
        found.warning(
            &place,
            format!("the thrust acts {moment:.3} m off the plane of symmetry, and trim has no yaw"),
            "give engines on both sides equal shares",
        );
    }
}

fn sensors(subject: &Subject, files: &Files, found: &mut Findings) {
    let sensors = &subject.case.sensors;
    let controls = super::controls::names_of(files).unwrap_or_default();
    for (i, sensor) in sensors.iter().enumerate() {
        if let Some(grid) = sensor
            .grid
            .filter(|g| !files.grids.is_empty() && !files.grids.contains_key(g))
        {
            found.error(
                &subject.at(&format!("sensor.{i}.grid")),
                format!("sensor `{}` is at grid {grid}, which the deck lacks", sensor.name),
                near(files, grid),
            );
        }
        let place = subject.at(&format!("sensor.{i}.name"));
        if sensors.iter().take(i).any(|s| s.name == sensor.name) {
            found.error(
                &place,
                format!("two sensors are named `{}`", sensor.name),
                "rename one of them",
            );
        }
        if sensor.name == "thrust" || controls.contains(&sensor.name.as_str()) {
            found.error(
                &place,
                format!("the sensor `{}` has the name of an input", sensor.name),
                "rename it: histories would have two columns of that name",
            );
        }
    }
    if sensors.is_empty() {
        found.note(
            &subject.at("flight"),
            "no sensors: the linear model has no outputs, the frequency response nothing to show",
            "add a [[sensor]] with a quantity and, for a point of the structure, its grid",
        );
    }
}

/// A cure for an unknown input of a manoeuvre.
pub(super) fn choose_input(name: &str, controls: &[&str]) -> String {
    let all: Vec<&str> = controls.iter().copied().chain(["thrust"]).collect();
    names::choose(name, &all)
}
