//! Derivatives: signs and sizes, of AVL and of the corrections.

use super::files::Files;
use super::{Findings, Subject, names};
use albatross_avl::results::StabilityDerivatives;
use albatross_strip::slopes::base_name;

/// Slopes below are a degree's, not a radian's.
const PER_DEGREE: f64 = 0.3;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    if let Some(derivatives) = &files.derivatives {
        signs(subject, files, derivatives, found);
    }
    corrections(subject, files, found);
}

fn signs(subject: &Subject, files: &Files, derivatives: &StabilityDerivatives, found: &mut Findings) {
    let name = subject.case.aerodynamics.derivatives.as_ref();
    let place = name.map_or_else(|| subject.at("aerodynamics.results"), |n| files.path(n));
    let lift = derivatives.alpha.lift;
    if lift <= 0.0 {
        found.error(
            &place,
            format!("CLa is {lift}: lift falls with incidence"),
            "run AVL again; look at the geometry",
        );
        return;
    }
    if !(1.0..=15.0).contains(&lift) {
        found.warning(
            &place,
            format!("CLa is {lift} a radian"),
            "check Sref and the units of the geometry: aircraft have 3 to 9",
        );
    }
    stability(files, derivatives, &place, found);
    for (name, value, sign, meaning) in [
        (
            "Cmq",
            derivatives.pitch_rate.pitch,
            -1.0,
            "pitching is not damped",
        ),
        ("Clp", derivatives.roll_rate.roll, -1.0, "rolling is not damped"),
        ("Cnr", derivatives.yaw_rate.yaw, -1.0, "yawing is not damped"),
        (
            "Cnb",
            derivatives.beta.yaw,
            1.0,
            "the aircraft is not stable in yaw",
        ),
    ] {
        if value * sign < 0.0 {
            found.warning(
                &place,
                format!("{name} is {value}: {meaning}"),
                "check surfaces, signs and the moment reference point of the AVL run",
            );
        }
    }
}

/// Static stability: the neutral point against the centre of gravity that flies.
fn stability(files: &Files, derivatives: &StabilityDerivatives, place: &str, found: &mut Findings) {
    let Some(mass) = &files.flying else { return };
    let reference = &derivatives.run.reference;
    let neutral = reference.x_ref - reference.c_ref * derivatives.alpha.pitch / derivatives.alpha.lift;
    let margin = (neutral - mass.cg[0]) / reference.c_ref;
    let what = format!(
        "the neutral point is at x = {neutral:.3} m, the centre of gravity at {:.3} m: a static margin of {:.0} %",
        mass.cg[0],
        100.0 * margin
    );
    let cure = "check the mass state, Xref of the AVL run, and the tail";
    if margin < 0.0 {
        found.warning(place, format!("{what}; the rigid aircraft is unstable"), cure);
    } else if margin > 1.0 {
        found.warning(place, format!("{what}; more than any aircraft"), cure);
    }
}

fn corrections(subject: &Subject, files: &Files, found: &mut Findings) {
    let variants = &subject.case.variants;
    let used = variants.iter().any(|v| v.corrections);
    let Some(corrections) = &subject.case.corrections else {
        for (i, variant) in variants.iter().enumerate().filter(|(_, v)| v.corrections) {
            found.error(
                &subject.at(&format!("variant.{i}.corrections")),
                format!(
                    "variant `{}` asks for corrections that the case does not have",
                    variant.name
                ),
                "add [corrections] with lift_slopes or derivatives, or remove `corrections = true`",
            );
        }
        return;
    };
    if !used {
        found.warning(
            &subject.at("corrections"),
            "[corrections] are named, but no variant uses them",
            "add `corrections = true` to a [[variant]]",
        );
    }
    if corrections.lift_slopes.is_none() && corrections.derivatives.is_none() {
        found.warning(
            &subject.at("corrections"),
            "[corrections] name no data",
            "name lift_slopes or derivatives",
        );
    }
    if let (Some(elevator), Some(known)) = (&corrections.elevator, super::controls::names_of(files))
        && !known.contains(&elevator.as_str())
    {
        found.error(
            &subject.at("corrections.elevator"),
            format!("`{elevator}` is no control of the AVL files"),
            names::choose(elevator, &known),
        );
    }
    slopes(subject, files, found);
    longitudinal(subject, files, found);
}

fn slopes(subject: &Subject, files: &Files, found: &mut Findings) {
    let Some(table) = &files.slope_table else { return };
    let place = subject.at("corrections.lift_slopes");
    let known: Vec<&str> = subject
        .case
        .aerodynamics
        .surfaces
        .iter()
        .map(|s| s.name.trim())
        .collect();
    let is_known = |name: &str| known.iter().any(|k| k.eq_ignore_ascii_case(base_name(name)));
    if !table.rows.iter().any(|r| is_known(&r.surface)) {
        let other = table.rows.first().map_or("", |r| r.surface.as_str());
        let what = format!("no row is for a surface of the case; the table has `{other}`");
        return found.error(&place, what, names::choose(other, &known));
    }
    let own = table.rows.iter().filter(|r| is_known(&r.surface));
    let small = own.filter(|r| r.cl_alpha.abs() < PER_DEGREE);
    if small.clone().count() * 2 > table.rows.len() {
        found.warning(
            &place,
            format!("lift slopes below {PER_DEGREE}: they look like those of a degree"),
            "give them a radian: times 57.2958",
        );
    }
}

fn longitudinal(subject: &Subject, files: &Files, found: &mut Findings) {
    let (Some(given), Some(avl)) = (&files.longitudinal, &files.derivatives) else {
        return;
    };
    let place = subject.at("corrections.derivatives");
    for (name, value, of_avl) in [
        ("CLa", given.CLa, avl.alpha.lift),
        ("Cma", given.Cma, avl.alpha.pitch),
        ("CLq", given.CLq, avl.pitch_rate.lift),
        ("Cmq", given.Cmq, avl.pitch_rate.pitch),
    ] {
        let Some(value) = value else { continue };
        let ratio = value / of_avl;
        if (ratio * 57.295_78 - 1.0).abs() < 0.5 {
            found.warning(
                &place,
                format!("{name} is {value}, that of AVL {of_avl}: a degree's and a radian's"),
                "give derivatives a radian: times 57.2958",
            );
        } else if !(0.4..=2.5).contains(&ratio) {
            found.warning(
                &place,
                format!("{name} is {value}, that of AVL {of_avl}"),
                "check reference shape, centre of gravity and units of the data",
            );
        }
    }
}
