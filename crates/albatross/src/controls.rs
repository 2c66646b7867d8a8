//! How the lift of each control spreads over the strips.
//!
//! AVL's derivatives give a control's total lift and moments, its strip files for incidence alone do not say where it
//! acts. On the strips between two sections that declare the control, thin-airfoil theory gives the lift as a share
//! `tau` of the strip's own slope and the moment about the quarter chord; one factor per control then scales them so that
//! lift, side force and rolling moment meet the rigid derivatives in the least-squares sense.
//!
//! Equations: THEORY (16), (16a).

use albatross_avl::geometry::{Geometry, Surface};
use albatross_flight::aerodynamics::RigidAerodynamics;
use albatross_numerics::Mat;
use albatross_strip::Strip;
use albatross_strip::quasi_steady::{ReferenceDimensions, StripLoads, flap_effectiveness};
use albatross_strip::slopes::{StripRecord, base_name};
use std::f64::consts::TAU;

/// Loads of the controls on the strips.
#[derive(Debug, Clone)]
pub struct ControlLoads {
    /// `dc_l/ddelta` and `dc_m/ddelta`, strips x controls \[1/rad\].
    pub loads: StripLoads,
    /// Incidence of equal lift, `c_l,delta / c_l,alpha`, strips x controls.
    pub incidence: Mat<f64>,
    /// What was assumed, one line per control.
    pub notes: Vec<String>,
}

/// Spreads the controls over the strips; `cg` in structural axes.
pub fn control_loads(
    geometry: &Geometry,
    controls: &[String],
    rigid: &RigidAerodynamics,
    reference: &ReferenceDimensions,
    records: &[StripRecord],
    strips: &[Strip],
    cg: [f64; 3],
) -> ControlLoads {
    let n = strips.len();
    let mut lift = Mat::zeros(n, controls.len());
    let mut moment = Mat::zeros(n, controls.len());
    let mut incidence = Mat::zeros(n, controls.len());
    let mut notes = Vec::new();
    for (c, name) in controls.iter().enumerate() {
        let hinges: Vec<Option<Hinge>> = records
            .iter()
            .map(|record| hinge(geometry, record, name))
            .collect();
        let at = |values: &[f64]| values.get(c).copied().unwrap_or(0.0);
        let target = [
            at(&rigid.lift.controls) * reference.area,
            at(&rigid.side.controls) * reference.area,
            at(&rigid.roll.controls) * reference.area * reference.span / (0.5 * reference.span),
        ];
        let mut raw = [0.0; 3];
        // The size that the loads would have at 2 pi, to tell rounding from lift.
        let mut whole = 0.0;
        for (hinge, strip) in hinges.iter().zip(strips) {
            let Some(hinge) = hinge else { continue };
            let force = hinge.gain * flap_effectiveness(hinge.x).0 * strip.cl_alpha * strip.area();
            whole += (hinge.gain * flap_effectiveness(hinge.x).0 * TAU * strip.area()).abs();
            let (sin, cos) = strip.dihedral_rad.sin_cos();
            raw[0] += force * cos;
            raw[1] -= force * sin;
            raw[2] -= force * (strip.y * cos + (strip.z - cg[2]) * sin) / (0.5 * reference.span);
        }
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let size = dot(raw, raw);
        if size.sqrt() <= 1e-9 * whole {
            notes.push(format!(
                "control `{name}` acts on no strip: it moves the rigid aircraft only"
            ));
            continue;
        }
        let factor = dot(raw, target) / size;
        notes.push(format!(
            "control `{name}`: thin-airfoil lift times {factor:.4} meets the rigid derivatives"
        ));
        for (j, (hinge, strip)) in hinges.iter().zip(strips).enumerate() {
            let Some(hinge) = hinge else { continue };
            let (tau, couple) = flap_effectiveness(hinge.x);
            incidence[(j, c)] = factor * hinge.gain * tau;
            lift[(j, c)] = factor * hinge.gain * tau * strip.cl_alpha;
            moment[(j, c)] = factor * hinge.gain * couple * strip.cl_alpha / TAU;
        }
    }
    ControlLoads {
        loads: StripLoads { lift, moment },
        incidence,
        notes,
    }
}

/// A control at one strip.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hinge {
    /// Degrees of deflection per unit of the control, with the sign of the mirror image.
    gain: f64,
    /// Fraction of the chord.
    x: f64,
}

/// The hinge of a control at a strip; none outside of the sections that declare it. Leading-edge devices (negative
/// hinge) carry no load here.
fn hinge(geometry: &Geometry, record: &StripRecord, control: &str) -> Option<Hinge> {
    let surface = geometry
        .surfaces
        .iter()
        .find(|s| s.name.trim() == base_name(&record.surface))?;
    let [_, mut y, z] = record.leading_edge;
    let image = base_name(&record.surface).len() != record.surface.trim_end().len();
    if image {
        y = 2.0 * surface.y_duplicate.unwrap_or(0.0) - y;
    }
    let (index, share) = segment(surface, y, z)?;
    let (inner, outer) = (surface.sections.get(index)?, surface.sections.get(index + 1)?);
    let find = |section: &albatross_avl::geometry::Section| {
        section
            .controls
            .iter()
            .find(|c| c.name.trim() == control)
            .cloned()
    };
    let (a, b) = (find(inner)?, find(outer)?);
    let blend = |a: f64, b: f64| a + share * (b - a);
    let x = blend(a.x_hinge, b.x_hinge);
    let sign = if image {
        blend(a.sgn_dup, b.sgn_dup).signum()
    } else {
        1.0
    };
    (x >= 0.0).then(|| Hinge {
        gain: sign * blend(a.gain, b.gain),
        x,
    })
}

/// The pair of sections whose line in the y-z plane passes nearest to a point, and the share of the way between them.
fn segment(surface: &Surface, y: f64, z: f64) -> Option<(usize, f64)> {
    let place = |i: usize| {
        surface.sections.get(i).map(|s| {
            [
                s.y_le * surface.scale[1] + surface.translate[1],
                s.z_le * surface.scale[2] + surface.translate[2],
            ]
        })
    };
    let mut best: Option<(f64, usize, f64)> = None;
    for i in 0..surface.sections.len().saturating_sub(1) {
        let (a, b) = (place(i)?, place(i + 1)?);
        let (dy, dz) = (b[0] - a[0], b[1] - a[1]);
        let length_squared = dy * dy + dz * dz;
        if length_squared == 0.0 {
            continue;
        }
        let share = (((y - a[0]) * dy + (z - a[1]) * dz) / length_squared).clamp(0.0, 1.0);
        let distance = (y - a[0] - share * dy).hypot(z - a[1] - share * dz);
        if best.is_none_or(|(d, ..)| distance < d) {
            best = Some((distance, i, share));
        }
    }
    best.map(|(_, index, share)| (index, share))
}
