//! Slender bodies: lines of sources and doublets.
//!
//! A segment of a body with cross-section area A, in a flow u_s along and u_n across it, is a line source of strength
//! u_s dA and a line doublet of 2 A u_n per length (Munk, NACA TR 184, 1924; Katz and Plotkin, sec. 8.3). Bodies
//! disturb the flow on surfaces; surfaces do not act on bodies. Body forces are those of slender-body theory,
//! dF = 2 u_n u_s dA over Sref.

use std::f64::consts::PI;

use albatross_avl::geometry::{Body, CoreRadii};
use albatross_numerics::interp::{Interpolant, Method};

use crate::airfoil::{outline_stations, read_points};
use crate::error::{Error, Result};
use crate::lattice::{Files, Lattice, V3};
use crate::spacing::points;
use crate::units::onset;

/// Core radius of a source line over its mean radius, where the geometry file does not set it.
const CORE: f64 = 1.0;

/// A body as a chain of nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeBody {
    /// Name; mirror images end in ` (YDUP)`.
    pub name: String,
    /// Nodes of the axis, geometry axes.
    pub nodes: Vec<V3>,
    /// Radius of the circle of equal area at each node.
    pub radii: Vec<f64>,
    /// Core radius of the source lines over their mean radius; negative: over their length.
    pub core_fraction: f64,
}

/// One segment between two nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    ends: [V3; 2],
    pub(crate) middle: V3,
    /// Change of the cross-section area.
    area_change: f64,
    mean_area: f64,
    core: f64,
}

impl LatticeBody {
    /// The nodes of a body; `None`, with a remark, where its file is not there.
    pub(crate) fn new(
        body: &Body,
        core: Option<CoreRadii>,
        files: &Files<'_>,
        remarks: &mut Vec<String>,
    ) -> Result<Option<Self>> {
        let name = body.name.trim().to_owned();
        let refuse = |problem: String| Error::Body {
            body: name.clone(),
            problem,
        };
        let count = body.spacing.count;
        if count < 2 {
            return Err(refuse(format!("it has {count} nodes: give Nbody of 2 or more")));
        }
        let fractions = points(count, body.spacing.distribution);
        let shape = match &body.file {
            Some(path) => match files(path) {
                Some(text) => {
                    let outline = read_points(&text).map_err(|e| refuse(e.0))?;
                    outline_stations(&outline).map_err(|e| refuse(e.0))?
                }
                None => {
                    remarks.push(format!(
                        "body \"{name}\": there is no file {path}: the body is left out"
                    ));
                    return Ok(None);
                }
            },
            None if body.sections.len() >= 2 => {
                let rows = body.sections.iter();
                rows.map(|s| (s.centre, (s.radius_y * s.radius_z).abs().sqrt()))
                    .collect()
            }
            None => return Err(refuse("it has neither BFILE nor two BSECTIONs".to_owned())),
        };
        let x: Vec<f64> = shape.iter().map(|s| s.0[0]).collect();
        let table = |values: Vec<f64>| {
            Interpolant::new(Method::Akima, &x, &values)
                .map_err(|e| refuse(format!("its sections cannot be interpolated along x ({e})")))
        };
        let y = table(shape.iter().map(|s| s.0[1]).collect())?;
        let z = table(shape.iter().map(|s| s.0[2]).collect())?;
        let radius = table(shape.iter().map(|s| s.1).collect())?;
        let (from, to) = (x[0], x[x.len() - 1]);
        let [sx, sy, sz] = body.scale;
        let translate = V3::from(body.translate);
        let at = |f: &f64| {
            let x = from + (to - from) * f;
            let place = V3::new(x * sx, y.eval(x) * sy, z.eval(x) * sz) + translate;
            (place, (sy * sz).abs().sqrt() * radius.eval(x))
        };
        let (nodes, radii): (Vec<V3>, Vec<f64>) = fractions.iter().map(at).unzip();
        let apart = |w: &[V3]| (w[1] - w[0]).norm() > 0.0 && w[1].iter().all(|v| v.is_finite());
        if !nodes.windows(2).all(apart) || !radii.iter().all(|r| r.is_finite()) {
            return Err(refuse(
                "two of its nodes coincide: give scales that are not zero".to_owned(),
            ));
        }
        Ok(Some(Self {
            name,
            nodes,
            radii,
            core_fraction: core.map_or(CORE, |c| c.source_fraction),
        }))
    }

    /// Mirrored in the plane y = `y_plane`.
    pub(crate) fn mirrored(&self, y_plane: f64) -> Self {
        Self {
            name: format!("{} (YDUP)", self.name),
            nodes: self
                .nodes
                .iter()
                .map(|p| V3::new(p.x, 2.0 * y_plane - p.y, p.z))
                .collect(),
            radii: self.radii.clone(),
            core_fraction: self.core_fraction,
        }
    }

    /// Length along x, surface area and volume.
    pub(crate) fn sizes(&self) -> [f64; 3] {
        let mut sizes = [0.0; 3];
        for (p, r) in self.nodes.windows(2).zip(self.radii.windows(2)) {
            let length = (p[1].x - p[0].x).abs();
            sizes[0] += length;
            sizes[1] += PI * (r[0] + r[1]) * length.hypot(r[1] - r[0]);
            sizes[2] += PI / 3.0 * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]) * length;
        }
        sizes
    }

    pub(crate) fn segments(&self) -> impl Iterator<Item = Segment> {
        self.nodes.windows(2).zip(self.radii.windows(2)).map(|(p, r)| {
            let (a, b) = (PI * r[0] * r[0], PI * r[1] * r[1]);
            Segment {
                ends: [p[0], p[1]],
                middle: (p[0] + p[1]) * 0.5,
                area_change: b - a,
                mean_area: 0.5 * (a + b),
                core: if self.core_fraction < 0.0 {
                    -self.core_fraction * (p[1] - p[0]).norm()
                } else {
                    self.core_fraction * 0.5 * (r[0] + r[1])
                },
            }
        })
    }

    /// Velocity at a point by the body in unit onset `u`, with the images of the planes of symmetry.
    pub(crate) fn velocity(&self, lattice: &Lattice, mach: f64, u: usize, point: &V3) -> V3 {
        let beta = (1.0 - mach * mach).sqrt();
        let (sy, sz) = (f64::from(lattice.i_ysym), f64::from(lattice.i_zsym));
        let z_image = 2.0 * lattice.z_sym - point.z;
        let places = [
            (1.0, *point, V3::new(1.0, 1.0, 1.0)),
            (sy, V3::new(point.x, -point.y, point.z), V3::new(1.0, -1.0, 1.0)),
            (sz, V3::new(point.x, point.y, z_image), V3::new(1.0, 1.0, -1.0)),
            (
                sy * sz,
                V3::new(point.x, -point.y, z_image),
                V3::new(1.0, -1.0, -1.0),
            ),
        ];
        let mut total = V3::zeros();
        for (sign, at, turn) in places {
            if sign != 0.0 {
                let sum: V3 = self
                    .segments()
                    .map(|s| s.velocity(beta, &onset(lattice, u, &s.middle), &at))
                    .sum();
                total += sum.component_mul(&turn) * sign;
            }
        }
        total
    }
}

impl Segment {
    /// Strength of the source and vector of the doublet in a flow.
    fn strengths(&self, beta: f64, flow: &V3) -> (f64, V3) {
        let along = self.stretched(beta);
        let axis = along.normalize();
        let u_s = flow.dot(&axis);
        let u_n = flow - axis * u_s;
        (
            u_s * self.area_change,
            u_n * (2.0 * self.mean_area * along.norm()),
        )
    }

    fn stretched(&self, beta: f64) -> V3 {
        let d = self.ends[1] - self.ends[0];
        V3::new(d.x / beta, d.y, d.z)
    }

    /// Force coefficient times the reference area.
    pub(crate) fn force(&self, beta: f64, flow: &V3) -> V3 {
        let axis = self.stretched(beta).normalize();
        let u_s = flow.dot(&axis);
        (flow - axis * u_s) * (2.0 * u_s * self.area_change)
    }

    /// Derivative of the force by the flow, applied to a change of the flow.
    pub(crate) fn force_change(&self, beta: f64, flow: &V3, change: &V3) -> V3 {
        let axis = self.stretched(beta).normalize();
        let (u_s, d_s) = (flow.dot(&axis), change.dot(&axis));
        let (u_n, d_n) = (flow - axis * u_s, change - axis * d_s);
        (d_n * u_s + u_n * d_s) * (2.0 * self.area_change)
    }

    /// Velocity at a point. A line source of unit strength from 1 to 2 gives
    /// `V = (R1/|R1| + R2/|R2|) / (2 pi ((|R1| + |R2|)^2 - L^2))`; a doublet D gives (D . grad) V.
    fn velocity(&self, beta: f64, flow: &V3, point: &V3) -> V3 {
        let (source, doublet) = self.strengths(beta, flow);
        let to = |end: &V3| V3::new((point.x - end.x) / beta, point.y - end.y, point.z - end.z);
        let (r1, r2) = (to(&self.ends[0]), to(&self.ends[1]));
        let core = self.core * self.core;
        let (d1, d2) = (
            (r1.norm_squared() + core).sqrt(),
            (r2.norm_squared() + core).sqrt(),
        );
        let (e1, e2) = (r1 / d1, r2 / d2);
        let sum = d1 + d2;
        let bottom = sum * sum - self.stretched(beta).norm_squared();
        if bottom <= 0.0 {
            return V3::zeros();
        }
        let scale = 1.0 / (2.0 * PI * bottom);
        let unit = e1 + e2;
        // (D . grad) of e = r/d is (D - e (e . D))/d.
        let turn = |e: &V3, d: f64| (doublet - e * e.dot(&doublet)) / d;
        let d_unit = turn(&e1, d1) + turn(&e2, d2);
        let d_bottom = 2.0 * sum * unit.dot(&doublet);
        let v = (unit * source + d_unit - unit * (d_bottom / bottom)) * scale;
        V3::new(v.x / beta, v.y, v.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_long_segment_is_a_cylinder_in_crossflow() {
        // Two-dimensional doublet: at the side of the cylinder the velocity doubles, at the top it vanishes.
        let segment = Segment {
            ends: [V3::new(-500.0, 0.0, 0.0), V3::new(500.0, 0.0, 0.0)],
            middle: V3::zeros(),
            area_change: 0.0,
            mean_area: PI,
            core: 0.0,
        };
        let side = segment.velocity(1.0, &V3::z(), &V3::new(0.0, 1.0, 0.0));
        let top = segment.velocity(1.0, &V3::z(), &V3::new(0.0, 0.0, 1.0));
        assert!(
            (side.z - 1.0).abs() < 1e-5 && (top.z + 1.0).abs() < 1e-5,
            "{side} {top}"
        );
    }
}
