//! The flight point.

use super::files::Files;
use super::reference::Wing;
use super::{Findings, Subject};
use crate::case::SOLVE;
use crate::model::HIGHEST_MACH;
use albatross_flight::atmosphere::{self, ALTITUDES};

const METRES_IN_FOOT: f64 = 0.3048;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    let flight = &subject.case.flight;
    if !ALTITUDES.contains(&flight.altitude) {
        let in_feet = flight.altitude * METRES_IN_FOOT;
        let cure = if ALTITUDES.contains(&in_feet) {
            format!("give metres: {} ft is {in_feet:.0} m", flight.altitude)
        } else {
            "give an altitude from -2000 to 32000 m".to_owned()
        };
        let what = format!(
            "an altitude of {} m, where the atmosphere is not modelled",
            flight.altitude
        );
        return found.error(&subject.at("flight.altitude"), what, cure);
    }
    if flight.path_angle_deg.abs() > 30.0 {
        found.warning(
            &subject.at("flight.path_angle_deg"),
            format!("a flight-path angle of {} deg", flight.path_angle_deg),
            "give degrees, positive climbing",
        );
    }
    mach(subject, files, found);
}

fn mach(subject: &Subject, files: &Files, found: &mut Findings) {
    let flight = &subject.case.flight;
    // Both or none: told already.
    if flight.mach.is_some() == flight.speed.is_some() {
        return;
    }
    let mach = flight.mach();
    let key = if flight.mach.is_some() {
        "flight.mach"
    } else {
        "flight.speed"
    };
    let place = subject.at(key);
    // Refused with the case.
    if mach >= 1.0 {
        return;
    }
    if mach > HIGHEST_MACH {
        found.warning(
            &place,
            format!("Mach {mach:.3} is above the range of the method, {HIGHEST_MACH}"),
            "results lack shocks and their motion; take lift slopes and derivatives of higher fidelity as [corrections]",
        );
    }
    let Some(derivatives) = &files.derivatives else {
        return;
    };
    let run = derivatives.run.mach;
    let name = subject.case.aerodynamics.derivatives.as_ref();
    let file = name.map_or_else(|| subject.at("aerodynamics.lattice.mach"), |n| files.path(n));
    let wing = files.strips[0].as_ref().and_then(|s| Wing::find(subject, s));
    let sweep = wing.as_ref().map_or(0.0, |w| w.sweep_rad);
    let normal = mach * sweep.cos();
    // Without strips the sweep is not known.
    if wing.is_none() && (0.7 * mach..mach).contains(&run) {
        return;
    }
    if (run - mach).abs() > 0.02 && run > 0.0 && (normal - 0.05..mach).contains(&run) {
        found.note(
            &file,
            format!(
                "AVL ran at Mach {run}, the flight is at {mach:.4}: Mach times the cosine of the sweep is {normal:.3} with the \
                 wing's {:.0} deg, which the method's paper takes",
                sweep.to_degrees()
            ),
            "AVL knows the sweep from the geometry: at the Mach number of the flight it gives the whole lift slope",
        );
    } else if (run - mach).abs() > 0.05 {
        let cure = if subject.case.aerodynamics.results.as_deref() == Some(SOLVE) {
            "leave `lattice.mach` and the Mach number of the geometry out (0) for that of the flight point"
        } else {
            "run AVL at the Mach number of the flight point (OPER > M): nothing rescales its files"
        };
        found.warning(
            &file,
            format!("AVL ran at Mach {run}, the flight is at {mach:.4}"),
            cure,
        );
    }
}

/// The lift coefficient that the flight needs against that of the AVL run.
pub(super) fn lift(subject: &Subject, files: &Files, mass: f64, area: f64, found: &mut Findings) {
    let flight = &subject.case.flight;
    if !ALTITUDES.contains(&flight.altitude) || flight.mach.is_some() == flight.speed.is_some() {
        return;
    }
    let pressure = 0.5 * atmosphere::standard(flight.altitude).density * flight.speed().powi(2);
    let needed = mass * flight.gravity * flight.path_angle_deg.to_radians().cos() / (pressure * area);
    let key = if flight.mach.is_some() {
        "flight.mach"
    } else {
        "flight.speed"
    };
    if needed > 1.5 {
        found.warning(
            &subject.at(key),
            format!("level flight needs a lift coefficient of {needed:.3}, beyond the stall of a clean wing"),
            "fly faster or lower; check mass, reference area and units",
        );
    } else if needed < 0.03 {
        found.warning(
            &subject.at(key),
            format!("level flight needs a lift coefficient of {needed:.4} only"),
            "check mass, reference area, speed and altitude, and their units",
        );
    } else if let (Some(derivatives), Some(name)) =
        (&files.derivatives, &subject.case.aerodynamics.derivatives)
    {
        let run = derivatives.run.c_lift;
        if (run - needed).abs() > 0.1 {
            found.warning(
                &files.path(name),
                format!("the AVL run has CL = {run:.4}, level flight needs {needed:.4}"),
                "write the derivatives at the trimmed lift (OPER > A C CL): coefficients are linear about the run",
            );
        }
    }
}
