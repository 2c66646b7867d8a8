//! The reference shape against the strips of the wing.

use super::aerodynamics::{DIGITS, derivatives_file, strip_file};
use super::files::Files;
use super::{Findings, Subject};
use albatross_avl::geometry::Geometry;
use albatross_avl::results::{Reference, StripForces};
use albatross_strip::slopes::base_name;
use std::collections::BTreeMap;

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
pub(super) fn check(
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
