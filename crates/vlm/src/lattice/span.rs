//! Where along a surface its strips lie.

use albatross_avl::geometry::Surface;

use super::V3;
use crate::error::{Error, Result};
use crate::spacing::{points, snap_to_sections};

/// One strip between two sections, by fractions of the distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// Inner section.
    pub(super) section: usize,
    /// Fraction at the first side.
    pub(super) from: f64,
    /// Fraction at the second side.
    pub(super) to: f64,
    /// Fraction at the station.
    pub(super) station: f64,
}

/// Strips of a surface whose sections' leading edges are given.
pub(super) fn intervals(surface: &Surface, leading_edges: &[V3]) -> Result<Vec<Interval>> {
    let refuse = |section: usize, problem: String| Error::Surface {
        surface: surface.name.clone(),
        section: section + 1,
        problem,
    };
    let mut arc = vec![0.0];
    for (k, w) in leading_edges.windows(2).enumerate() {
        let step = (w[1].y - w[0].y).hypot(w[1].z - w[0].z);
        if !(step > 0.0 && step.is_finite()) {
            return Err(refuse(
                k,
                format!(
                    "its distance in y and z to section {} is {step}: move one of them apart",
                    k + 2
                ),
            ));
        }
        arc.push(arc[k] + step);
    }
    match surface.spanwise {
        Some(spacing) => {
            let total = arc[arc.len() - 1];
            let all: Vec<f64> = points(2 * spacing.count + 1, spacing.distribution)
                .iter()
                .map(|f| f * total)
                .collect();
            let mut edges: Vec<f64> = all.iter().step_by(2).copied().collect();
            let mut centres: Vec<f64> = all.iter().skip(1).step_by(2).copied().collect();
            snap_to_sections(&mut edges, &mut centres, &arc).ok_or_else(|| {
                refuse(
                    0,
                    format!(
                        "{} spanwise vortices cannot have an edge at each of the {} sections: raise Nspan, or give \
                         Nspan and Sspace at each section",
                        spacing.count,
                        arc.len()
                    ),
                )
            })?;
            Ok(in_sections(&edges, &centres, &arc))
        }
        None => {
            let mut out = Vec::new();
            for (k, section) in surface.sections.iter().enumerate().take(arc.len() - 1) {
                let spacing = section.spanwise.filter(|s| s.count > 0).ok_or_else(|| {
                    refuse(
                        k,
                        "it has no Nspan and Sspace, and neither has the surface: give them at either"
                            .to_owned(),
                    )
                })?;
                let f = points(2 * spacing.count + 1, spacing.distribution);
                out.extend(f.windows(3).step_by(2).map(|w| Interval {
                    section: k,
                    from: w[0],
                    to: w[2],
                    station: w[1],
                }));
            }
            Ok(out)
        }
    }
}

/// Strips by arc length to strips by section.
fn in_sections(edges: &[f64], centres: &[f64], arc: &[f64]) -> Vec<Interval> {
    edges
        .windows(2)
        .zip(centres)
        .map(|(w, &centre)| {
            let section = arc.partition_point(|&s| s <= centre).clamp(1, arc.len() - 1) - 1;
            let fraction = |s: f64| (s - arc[section]) / (arc[section + 1] - arc[section]);
            Interval {
                section,
                from: fraction(w[0]),
                to: fraction(w[1]),
                station: fraction(centre),
            }
        })
        .collect()
}
