//! Eigenvalues over speed.

use crate::Error;
use crate::model::Model;
use albatross_flight::{Attitude, FlightPoint, ModelOptions, linearize, trim};
use albatross_numerics::eigen::eigenvalues;
use albatross_numerics::{C64, Mat};
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

/// Eigenvalues over speed, and what was left out.
#[derive(Debug, Clone, Serialize)]
pub struct RootLocus {
    /// By ascending speed.
    pub points: Vec<Roots>,
    /// Speeds at which the aircraft could not be trimmed, with the reason.
    pub notes: Vec<String>,
}

/// Speeds around that of the flight point, which is one of them: `count` or one more, from `low` to `high` times it.
pub fn speeds_around(speed: f64, low: f64, high: f64, count: usize) -> Vec<f64> {
    let steps = count.max(2) - 1;
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

/// Eigenvalues of the linearised model at each speed, trimmed anew at the altitude and path angle of its flight point.
///
/// Only the speed changes: the aerodynamic data stay those of the flight point's Mach number. A speed without a trim is
/// left out with a note. Speeds are taken side by side.
///
/// # Errors
/// [`Error::Numerics`] where eigenvalues cannot be computed, those of [`linearize()`].
pub fn root_locus(model: &Model, speeds: &[f64]) -> Result<RootLocus, Error> {
    let found: Vec<Result<Result<Roots, String>, Error>> =
        speeds.par_iter().map(|speed| roots(model, *speed)).collect();
    let mut locus = RootLocus {
        points: Vec::new(),
        notes: Vec::new(),
    };
    for point in found {
        match point? {
            Ok(roots) => locus.points.push(roots),
            Err(note) => locus.notes.push(note),
        }
    }
    Ok(locus)
}

/// The eigenvalues at one speed, or why there is no trim.
fn roots(model: &Model, speed: f64) -> Result<Result<Roots, String>, Error> {
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
    // Heading moves nothing: its eigenvalue is zero.
    let kept: Vec<usize> = (0..system.states.len())
        .filter(|&i| !["psi", "north", "east"].contains(&system.states[i].name.as_str()))
        .collect();
    let a = Mat::from_fn(kept.len(), kept.len(), |i, j| system.a[(kept[i], kept[j])]);
    let values = eigenvalues(a.as_ref())?
        .into_iter()
        .filter(|value: &C64| value.im >= 0.0)
        .map(|value| (value.re, value.im))
        .collect();
    Ok(Ok(Roots {
        speed,
        alpha_rad: trim.alpha_rad,
        values,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Inputs, analysis};
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
        let locus = root_locus(&model, &[0.7 * speed, speed]).unwrap();
        assert!(locus.notes.is_empty(), "{:?}", locus.notes);
        let modes = analysis::mode_table_without_lags(&model, &analysis::trimmed(&model).unwrap()).unwrap();
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
}
