//! Strips against the load reference axes and against the derivatives.

use super::aerodynamics::strip_file;
use super::files::Files;
use super::{Findings, Subject};
use crate::case::{GridEntry, LiftSlopes, grid_list};
use albatross_avl::results::{Strip, StripForces};
use albatross_strip::shapes::DihedralForm;
use albatross_strip::slopes::{self, StripRecord, base_name};

/// Section lift slopes that AVL gives to lifting surfaces \[1/rad\].
const SLOPES: std::ops::RangeInclusive<f64> = 0.5..=15.0;
/// How far slopes of strips and derivatives of one aircraft may differ: the runs differ in incidence.
const SAME_SLOPE: f64 = 0.1;

/// Dihedral from which on a surface is a fin \[rad\].
const FIN: f64 = 0.8;

/// An axis with less extent across the stream than this share of that along it is no axis of a surface.
const MOST_STREAMWISE: f64 = 0.2;

pub(super) fn check(subject: &Subject, files: &Files, found: &mut Findings) {
    let [Some(low), Some(high)] = &files.strips else {
        return;
    };
    incidences(subject, files, low, high, found);
    axes(subject, files, low, found);
}

/// The two strip files, and whether their incidences are those of the case.
fn incidences(subject: &Subject, files: &Files, low: &StripForces, high: &StripForces, found: &mut Findings) {
    let place = subject.at("aerodynamics.strips");
    let Some([a, b]) = &subject.case.aerodynamics.strips else {
        return;
    };
    if a.file == b.file {
        found.error(
            &place,
            format!("both strip files are `{}`", a.file),
            "name the forces at two incidences, all else equal",
        );
        return;
    }
    let records = match slopes::from_avl(low, a.alpha_deg, high, b.alpha_deg) {
        Ok(records) => records,
        Err(error) => return found.of_error(&error.to_string(), &place),
    };
    let lift = |forces: &StripForces| forces.surfaces.iter().map(|s| s.coefficients.c_lift).sum::<f64>();
    let step = (b.alpha_deg - a.alpha_deg).to_radians();
    let slope = (lift(high) - lift(low)) / step;
    if slope <= 0.0 {
        found.error(
            &place,
            format!(
                "lift falls with incidence: {:.4} at {} deg, {:.4} at {} deg",
                lift(low),
                a.alpha_deg,
                lift(high),
                b.alpha_deg
            ),
            "the two files are exchanged, or their incidences",
        );
        return;
    }
    if let Some(derivatives) = &files.derivatives {
        let ratio = slope / derivatives.alpha.lift;
        if (ratio - 1.0).abs() > SAME_SLOPE {
            let right = a.alpha_deg + (b.alpha_deg - a.alpha_deg) * ratio;
            found.warning(
                &place,
                format!(
                    "the strips' lift slope is {slope:.4} a radian, that of the derivatives {:.4}",
                    derivatives.alpha.lift
                ),
                format!(
                    "correct `alpha_deg` (with {} deg first, the second would be near {right:.2}), or run AVL again with \
                     one geometry and Mach number for all files",
                    a.alpha_deg
                ),
            );
            return;
        }
    }
    let own = |r: &&StripRecord| {
        let mut named = subject.case.aerodynamics.surfaces.iter();
        named.any(|s| s.name.trim().eq_ignore_ascii_case(base_name(&r.surface)))
    };
    fins(subject, records.iter().filter(own), found);
    let odd = records
        .iter()
        .filter(own)
        .find(|r| r.dihedral_rad.abs() < FIN && !SLOPES.contains(&r.cl_alpha));
    if let Some(strip) = odd {
        found.warning(
            &strip_file(subject, files, 0),
            format!(
                "strip {} of `{}` has a lift slope of {:.3} a radian",
                strip.index, strip.surface, strip.cl_alpha
            ),
            "look at that strip: a control deflected in one of the runs, or surfaces that cut each other",
        );
    }
}

/// A fin that is to carry loads, and does not feel the incidence that the two files differ by.
fn fins<'a>(subject: &Subject, mut own: impl Iterator<Item = &'a StripRecord>, found: &mut Findings) {
    let aerodynamics = &subject.case.aerodynamics;
    if aerodynamics.dihedral != DihedralForm::General || aerodynamics.lift_slopes != LiftSlopes::Avl {
        return;
    }
    if let Some(strip) = own.find(|r| r.dihedral_rad.abs() >= FIN && r.cl_alpha.abs() < *SLOPES.start()) {
        found.warning(
            &subject.at("aerodynamics.dihedral"),
            format!(
                "`{}` has a lift slope of {:.3} a radian from two incidences, and carries no unsteady loads",
                strip.surface.trim(),
                strip.cl_alpha
            ),
            "take lift_slopes = \"prandtl_glauert\" or \"lattice\" with dihedral = \"general\"",
        );
    }
}

/// Each surface's strips against the axis that moves them.
fn axes(subject: &Subject, files: &Files, strips: &StripForces, found: &mut Findings) {
    for (i, surface) in subject.case.aerodynamics.surfaces.iter().enumerate() {
        for own in &strips.surfaces {
            let name = own.name.trim();
            if !base_name(name).eq_ignore_ascii_case(surface.name.trim()) {
                continue;
            }
            let image = base_name(name).len() != name.len();
            let (axis, key) = if image {
                (surface.image_lra.as_ref(), "image_lra")
            } else {
                (Some(&surface.lra), "lra")
            };
            let place = subject.at(&format!("aerodynamics.surface.{i}.{key}"));
            if let Some(axis) = axis
                && let Some(entries) = subject.case.structure.lra.get(axis)
            {
                one_axis(files, axis, entries, name, &own.strips, &place, found);
            }
        }
    }
}

fn one_axis(
    files: &Files,
    axis: &str,
    entries: &[GridEntry],
    surface: &str,
    strips: &[Strip],
    place: &str,
    found: &mut Findings,
) {
    let grids = grid_list(entries).unwrap_or_default();
    let points: Vec<[f64; 3]> = grids.iter().filter_map(|g| files.grids.get(g).copied()).collect();
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return;
    };
    if points.len() < 2 || points.len() < grids.len() || strips.is_empty() {
        return;
    }
    let bounds = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        })
    };
    let axis_y = bounds(&mut points.iter().map(|p| p[1]));
    let strip_y = bounds(&mut strips.iter().map(|s| s.y_le));
    let middle = |(a, b): (f64, f64)| 0.5 * (a + b);
    let width = (axis_y.1 - axis_y.0).max(strip_y.1 - strip_y.0);
    if middle(axis_y) * middle(strip_y) < 0.0 && width > 0.0 {
        found.error(
            place,
            format!(
                "axis `{axis}` lies at y from {:.2} to {:.2} m, the strips of `{surface}` from {:.2} to {:.2} m",
                axis_y.0, axis_y.1, strip_y.0, strip_y.1
            ),
            "exchange `lra` and `image_lra`: AVL's original side is that of the sections in the file",
        );
        return;
    }
    let (dy, dz) = (last[1] - first[1], last[2] - first[2]);
    let length = dy.hypot(dz);
    if length <= (MOST_STREAMWISE * (last[0] - first[0]).abs()).max(1e-6) {
        found.error(
            place,
            format!("axis `{axis}` runs along the stream, the strips of `{surface}` lie across it"),
            "name an axis along the span, or a single grid for a rigid surface",
        );
        return;
    }
    let along = |y: f64, z: f64| ((y - first[1]) * dy + (z - first[2]) * dz) / length;
    let s: Vec<f64> = points.iter().map(|p| along(p[1], p[2])).collect();
    let steps = || s.iter().zip(s.iter().skip(1));
    if let Some(i) = steps().position(|(a, b)| b - a <= 1e-9 * length) {
        let id = |k: usize| grids.get(k).copied().unwrap_or_default();
        found.error(
            place,
            format!(
                "axis `{axis}` goes back from grid {} to grid {}",
                id(i),
                id(i + 1)
            ),
            "list its grids in order from one end to the other, each once",
        );
        return;
    }
    let mut outside = 0;
    let mut example = None;
    for strip in strips {
        let (Some(x_le), Some(z_le)) = (strip.x_le, strip.z_le) else {
            return;
        };
        let at = along(strip.y_le, z_le);
        let segments = || steps().zip(points.iter().zip(points.iter().skip(1)));
        let here = segments().find(|((_, to), _)| at <= **to);
        let Some(((from, to), (a, b))) = here.or_else(|| segments().next_back()) else {
            continue;
        };
        let share = (at - from) / (to - from);
        let x = a[0] + share * (b[0] - a[0]);
        let fraction = (x - x_le) / strip.chord;
        if !(0.0..=1.0).contains(&fraction) {
            outside += 1;
            example.get_or_insert((strip.index, fraction));
        }
    }
    if let Some((strip, fraction)) = example.filter(|_| 4 * outside > strips.len()) {
        found.warning(
            place,
            format!(
                "axis `{axis}` passes outside of the chord of {outside} of {} strips of `{surface}`: at {:.0} % of the \
                 chord of strip {strip}",
                strips.len(),
                100.0 * fraction
            ),
            "check origin and units of deck and geometry: x aft, y right, z up from one point, in m",
        );
    }
}
