//! Eigenvalues over speed, and the branches of the modes among them.

use crate::Error;
use crate::analysis::{ModeTable, Trimmed};
use crate::mode_table::{lags_of, moving_matrix};
use crate::model::Model;
use albatross_flight::{Attitude, FlightPoint, ModelOptions, linearize, trim};
use albatross_lti::{LagForm, Root, TrackOptions, lags};
use albatross_numerics::C64;
use albatross_numerics::eigen::eigenvalues;
use rayon::prelude::*;
use serde::Serialize;

/// The eigenvalues of a model at one speed.
#[derive(Debug, Clone, Serialize)]
pub struct Roots {
    /// True airspeed \[m/s\].
    pub speed: f64,
    /// Incidence in trim \[rad\].
    pub alpha_rad: f64,
    /// Real and imaginary parts \[1/s, rad/s\] of all eigenvalues with an imaginary part of at least zero, lag roots
    /// included; without those of heading and position, which are zero.
    pub values: Vec<(f64, f64)>,
}

/// What kind of mode a branch is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BranchKind {
    /// Of the structure in the flow.
    Elastic,
    /// Of the aircraft as a whole.
    RigidBody,
}

/// An oscillatory mode over speed.
#[derive(Debug, Clone, Serialize)]
pub struct Branch {
    /// Number of an elastic mode in the mode table, name of a rigid-body mode.
    pub name: String,
    /// Kind of mode.
    pub kind: BranchKind,
    /// Real and imaginary part \[1/s, rad/s\] at the speed of each point; none where the mode was not followed to.
    pub values: Vec<Option<(f64, f64)>>,
    /// Least certainty of the steps by which it was followed, 1 is best.
    pub confidence: f64,
}

/// Eigenvalues over speed, and what was left out.
#[derive(Debug, Clone, Serialize)]
pub struct RootLocus {
    /// By ascending speed.
    pub points: Vec<Roots>,
    /// The oscillatory modes of the mode table, followed up and down in speed.
    pub branches: Vec<Branch>,
    /// Speeds at which the aircraft could not be trimmed, and branches that end, with the reason.
    pub notes: Vec<String>,
}

/// Most speeds of [`speeds_around`].
const MOST_SPEEDS: usize = 10_000;

/// Speeds around that of the flight point, which is one of them: `count` (2 to 10 000) from `low` to `high` times it.
pub fn speeds_around(speed: f64, low: f64, high: f64, count: usize) -> Vec<f64> {
    let steps = count.clamp(2, MOST_SPEEDS) - 1;
    let step = (high - low) / steps as f64;
    let mut factors: Vec<f64> = (0..=steps).map(|i| low + step * i as f64).collect();
    if low < 1.0 && high > 1.0 {
        // The nearest one gives way to the flight point itself.
        let nearest = ((1.0 - low) / step).round() as usize;
        if let Some(factor) = factors.get_mut(nearest) {
            *factor = 1.0;
        }
    }
    factors.into_iter().map(|factor| factor * speed).collect()
}

/// Eigenvalues of the linearised model at each speed, trimmed anew at the altitude and path angle of its flight point, and
/// the modes of the flight point followed from there.
///
/// Only the speed changes: the aerodynamic data stay those of the flight point's Mach number. A speed without a trim is
/// left out with a note. Speeds are taken side by side. There are branches only if the speed of the flight point is among
/// those given.
///
/// # Errors
/// [`Error::Numerics`] where eigenvalues cannot be computed, those of [`linearize()`].
pub fn root_locus(model: &Model, modes: &ModeTable, speeds: &[f64]) -> Result<RootLocus, Error> {
    let found: Vec<Result<Result<Place, String>, Error>> =
        speeds.par_iter().map(|speed| place(model, *speed)).collect();
    let (mut places, mut notes) = (Vec::new(), Vec::new());
    for place in found {
        match place? {
            Ok(place) => places.push(place),
            Err(note) => notes.push(note),
        }
    }
    let at_flight_point = |place: &Place| (place.roots.speed / model.point.speed - 1.0).abs() < 1e-9;
    let branches = match places.iter().position(at_flight_point) {
        Some(start) => branches(&places, start, modes, &mut notes),
        None => Vec::new(),
    };
    Ok(RootLocus {
        points: places.into_iter().map(|place| place.roots).collect(),
        branches,
        notes,
    })
}

/// The aircraft at one speed.
struct Place {
    roots: Roots,
    form: LagForm,
}

/// The aircraft at one speed, or why there is no trim.
fn place(model: &Model, speed: f64) -> Result<Result<Place, String>, Error> {
    let options = ModelOptions {
        attitude: Attitude::Euler,
        position: false,
        ..model.options
    };
    let point = FlightPoint {
        speed,
        ..model.point.clone()
    };
    let (equations, trim) = match trim(&model.aircraft, options, &point) {
        Ok(found) => found,
        Err(error) => return Ok(Err(format!("no root locus at {speed:.1} m/s: {error}"))),
    };
    let system = linearize(&equations, &trim.state, &trim.input)?;
    let trimmed = Trimmed {
        equations,
        trim,
        system,
    };
    let a = moving_matrix(&trimmed.system, &trimmed)?;
    let values = eigenvalues(a.as_ref())?
        .into_iter()
        .filter(|value: &C64| value.im >= 0.0)
        .map(|value| (value.re, value.im))
        .collect();
    Ok(Ok(Place {
        form: LagForm::new(a.as_ref(), &lags_of(&trimmed))?,
        roots: Roots {
            speed,
            alpha_rad: trimmed.trim.alpha_rad,
            values,
        },
    }))
}

/// How branches are followed from one speed to the next.
const STEPS: TrackOptions = TrackOptions {
    largest_step: 0.5,
    least_step: 1.0 / 1024.0,
    tolerance: 0.2,
    most_decompositions: 200,
};

/// Roots of two branches nearer than this, relative, are one.
const SAME: f64 = 1e-6;

/// The oscillatory modes of the mode table from the flight point, `places[start]`, to each speed.
fn branches(places: &[Place], start: usize, modes: &ModeTable, notes: &mut Vec<String>) -> Vec<Branch> {
    let elastic = modes
        .elastic
        .iter()
        .map(|m| (m.mode.to_string(), BranchKind::Elastic, C64::new(m.re, m.im)));
    let rigid_body = modes.rigid_body.iter().filter_map(|m| {
        let flexible = m.flexible.as_ref()?;
        Some((m.name.to_owned(), BranchKind::RigidBody, flexible.eigenvalue()))
    });
    let (mut branches, mut roots): (Vec<Branch>, Vec<Root>) = (Vec::new(), Vec::new());
    for (name, kind, value) in elastic.chain(rigid_body).filter(|mode| mode.2.im != 0.0) {
        match places[start].form.root(value) {
            Ok(root) => {
                let mut values = vec![None; places.len()];
                values[start] = Some((root.value.re, root.value.im));
                branches.push(Branch {
                    name,
                    kind,
                    values,
                    confidence: 1.0,
                });
                roots.push(root);
            }
            Err(error) => notes.push(format!("no branch of mode {name}: {error}")),
        }
    }
    let upwards: Vec<usize> = (start..places.len()).collect();
    let downwards: Vec<usize> = (0..=start).rev().collect();
    for way in [upwards, downwards] {
        let mut open: Vec<Option<(Root, f64)>> = roots.iter().map(|root| Some((root.clone(), 1.0))).collect();
        for pair in way.windows(2) {
            let (from, to) = (&places[pair[0]], &places[pair[1]]);
            advance(from, to, &mut open, &branches, notes);
            for (branch, follower) in branches.iter_mut().zip(&open) {
                if let Some((root, confidence)) = follower {
                    branch.values[pair[1]] = Some((root.value.re, root.value.im));
                    branch.confidence = branch.confidence.min(*confidence);
                }
            }
        }
    }
    branches
}

/// Carries the open branches from one speed to the next; those that cannot be followed with certainty, or would meet on one
/// root, end with a note.
fn advance(
    from: &Place,
    to: &Place,
    open: &mut [Option<(Root, f64)>],
    branches: &[Branch],
    notes: &mut Vec<String>,
) {
    let (here, there) = (from.roots.speed, to.roots.speed);
    let mut end = |index: usize, why: &str| {
        let name = branches.get(index).map_or("", |b| b.name.as_str());
        notes.push(format!(
            "the branch of mode {name} ends at {here:.1} m/s on the way to {there:.1} m/s: {why}"
        ));
    };
    for (index, place) in open.iter_mut().enumerate() {
        let Some((root, _)) = place.take() else { continue };
        match lags::follow(&from.form, &to.form, &[root], STEPS) {
            Ok(found) => {
                let certain = found.confidence.first().copied().unwrap_or(0.0);
                *place = found.roots.into_iter().next().map(|root| (root, certain));
            }
            Err(error) => end(index, &error.to_string()),
        }
    }
    let values: Vec<Option<C64>> = open
        .iter()
        .map(|o| o.as_ref().map(|(root, _)| root.value))
        .collect();
    for (index, value) in values.iter().enumerate() {
        let Some(value) = value else { continue };
        let other = values.iter().enumerate().find(|(other, v)| {
            *other != index && v.is_some_and(|v| (v - value).norm() <= SAME * value.norm())
        });
        if let Some((other, _)) = other {
            let name = branches.get(other).map_or("", |b| b.name.as_str());
            end(index, &format!("it would go on to the root of mode {name}"));
            open[index] = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Inputs, analysis};
    use albatross_lti::Tracker;
    use std::path::Path;

    #[test]
    fn val_speeds_hold_the_flight_point() {
        let speeds = speeds_around(200.0, 0.5, 1.3, 5);
        assert_eq!(speeds.len(), 5);
        assert!(speeds.contains(&200.0));
        assert!(speeds.is_sorted());
        assert!((speeds[0] - 100.0).abs() < 1e-9 && (speeds[4] - 260.0).abs() < 1e-9);
    }

    /// At the flight point the locus holds the modes that another way (following them from the uncoupled aircraft) finds;
    /// at others it holds the phugoid of Lanchester, `sqrt(2) g/V` for an aircraft without drag and pitch stiffness.
    #[test]
    fn val_the_locus_passes_through_the_modes_of_the_flight_point() {
        let file = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let inputs = Inputs::read(file).unwrap();
        let model = Model::build(&inputs, &inputs.case.variant(None).unwrap()).unwrap();
        let speed = model.point.speed;
        let modes = analysis::mode_table_without_lags(&model, &analysis::trimmed(&model).unwrap()).unwrap();
        let locus = root_locus(&model, &modes, &[0.7 * speed, speed]).unwrap();
        assert!(locus.notes.is_empty(), "{:?}", locus.notes);
        let nearest = |point: &Roots, re: f64, im: f64| {
            let distance = |(a, b): &(f64, f64)| (a - re).hypot(b - im);
            point.values.iter().map(distance).fold(f64::INFINITY, f64::min)
        };
        for mode in &modes.elastic {
            let distance = nearest(&locus.points[1], mode.re, mode.im.abs());
            assert!(
                distance < 1e-6 * mode.omega_rad_s,
                "mode {}: {distance}",
                mode.mode
            );
        }
        for point in &locus.points {
            let slowest = point
                .values
                .iter()
                .filter(|(_, im)| *im > 1e-3)
                .map(|(re, im)| re.hypot(*im))
                .fold(f64::INFINITY, f64::min);
            let lanchester = 2f64.sqrt() * 9.806_65 / point.speed;
            assert!(
                (slowest / lanchester - 1.0).abs() < 0.25,
                "{slowest} {lanchester}"
            );
        }
        assert!(locus.points[0].alpha_rad > locus.points[1].alpha_rad);
    }

    /// Every value of a branch is an eigenvalue of the whole matrix at its speed, no two branches share one, and at the
    /// farthest speed the branches are where the dense tracker arrives that follows all eigenvalues over the same speeds.
    #[test]
    fn val_branches_are_those_of_the_dense_tracker() {
        let file = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let inputs = Inputs::read(file).unwrap();
        let model = Model::build(&inputs, &inputs.case.variant(None).unwrap()).unwrap();
        let modes = analysis::mode_table_without_lags(&model, &analysis::trimmed(&model).unwrap()).unwrap();
        let speed = model.point.speed;
        let speeds: Vec<f64> = [0.88, 0.94, 1.0, 1.06, 1.12].map(|f| f * speed).to_vec();
        let locus = root_locus(&model, &modes, &speeds).unwrap();
        assert!(locus.notes.is_empty(), "{:?}", locus.notes);
        let oscillatory = modes
            .rigid_body
            .iter()
            .filter(|m| m.flexible.as_ref().is_some_and(|f| f.oscillatory));
        assert_eq!(locus.branches.len(), modes.elastic.len() + oscillatory.count());
        for (i, point) in locus.points.iter().enumerate() {
            let mut taken = Vec::new();
            for branch in &locus.branches {
                let (re, im) = branch.values[i].unwrap();
                let apart = |(k, (a, b)): (usize, &(f64, f64))| ((a - re).hypot(b - im), k);
                let (distance, nearest) = point
                    .values
                    .iter()
                    .enumerate()
                    .map(apart)
                    .min_by(|p, q| p.0.total_cmp(&q.0))
                    .unwrap();
                assert!(distance < 1e-7 * re.hypot(im), "{}: {distance:e}", branch.name);
                taken.push(nearest);
            }
            taken.sort_unstable();
            assert!(taken.windows(2).all(|w| w[0] != w[1]), "two branches on one root");
        }
        let matrix = |speed: f64| {
            let options = ModelOptions {
                attitude: Attitude::Euler,
                position: false,
                ..model.options
            };
            let point = FlightPoint {
                speed,
                ..model.point.clone()
            };
            let (equations, trim) = trim(&model.aircraft, options, &point).unwrap();
            let system = linearize(&equations, &trim.state, &trim.input).unwrap();
            let trimmed = Trimmed {
                equations,
                trim,
                system,
            };
            moving_matrix(&trimmed.system, &trimmed).unwrap()
        };
        let start: Vec<C64> = locus
            .branches
            .iter()
            .map(|b| b.values[2].map(|(re, im)| C64::new(re, im)).unwrap())
            .collect();
        let mut tracker = Tracker::new(matrix(speeds[2]).as_ref(), &start, STEPS).unwrap();
        tracker.follow(matrix(speeds[3]).as_ref()).unwrap();
        let far = tracker.follow(matrix(speeds[4]).as_ref()).unwrap();
        for (branch, dense) in locus.branches.iter().zip(far.values()) {
            let (re, im) = branch.values[4].unwrap();
            assert!(
                (C64::new(re, im) - dense).norm() < 1e-7 * dense.norm(),
                "{}",
                branch.name
            );
        }
    }
}
