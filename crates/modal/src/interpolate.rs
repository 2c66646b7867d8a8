//! Modes at the strips: along the load reference axis, then across to the aerodynamic centre.
//!
//! The axis is a line of grids. Its running coordinate s is the distance along the direction from its first to its
//! last grid in the y-z plane, so a wing (along y), a fin (along z) and a V-tail need no distinction. The three
//! translations and three rotations of each mode, and the position of the axis itself, are interpolated at the s of
//! the station. The station then follows its point of the axis rigidly in the y-z plane,
//! `T = T_axis + R x (0, y - y_axis, z - z_axis)`. The streamwise arm is left to the strip, which needs the motion
//! at several points of its chord: `phi(x) = T3 - (x - x_axis) R2`.
//!
//! Motion and axis go through the same linear operator (cubic, linear), so a rigid motion of the aircraft is
//! reproduced exactly at every station. PCHIP limits slopes and is not linear in its data: there, a rigid motion is
//! exact for each of the six directions alone, and combined ones deviate near kinks of the axis.
//!
//! Equations: THEORY (5), (5a).

use albatross_nastran::deck::Id;
use albatross_numerics::Mat;
use albatross_numerics::interp::{Interpolant, Method};
use nalgebra::Vector3;

use crate::basis::ModalBasis;
use crate::error::Error;

/// Stations beyond an end of the axis are extrapolated up to this share of its length.
pub const LARGEST_EXTRAPOLATION: f64 = 0.05;

/// A load reference axis: the grids that carry a lifting surface, from one end to the other. A single grid stands
/// for a rigid body, such as a nacelle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LoadReferenceAxis {
    /// Name for messages.
    pub name: String,
    /// Grid numbers in order.
    pub grids: Vec<Id>,
}

/// A point that follows the axis: a strip's aerodynamic centre, in structural axes, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Aft.
    pub x: f64,
    /// To the right.
    pub y: f64,
    /// Up.
    pub z: f64,
}

/// Modes at stations.
#[derive(Debug, Clone)]
pub struct StationShapes {
    /// T1, T2, T3 (m per unit generalised coordinate), stations x modes, structural axes, at the station's y and z
    /// and at the x of the axis.
    pub translation: [Mat<f64>; 3],
    /// R1, R2, R3 (rad), stations x modes, structural axes; R2 > 0 is nose up.
    pub rotation: [Mat<f64>; 3],
    /// x of the axis at each station, m.
    pub x_lra: Vec<f64>,
    /// Remarks, such as stations beyond the ends.
    pub notes: Vec<String>,
}

impl StationShapes {
    /// Plunge phi = T3 on the axis, stations x modes, positive up.
    #[must_use]
    pub fn phi_z(&self) -> &Mat<f64> {
        &self.translation[2]
    }

    /// Twist gamma = R2, stations x modes, positive nose up.
    #[must_use]
    pub fn gamma_y(&self) -> &Mat<f64> {
        &self.rotation[1]
    }
}

/// Interpolates every mode of the basis to the stations of one axis.
///
/// Stations up to 5 % of the axis beyond an end continue the end slopes linearly, with a note.
///
/// # Errors
/// [`Error::UnknownGrid`]; [`Error::BadAxis`] for an axis without grids or without extent in the y-z plane;
/// [`Error::AxisNotMonotonic`]; [`Error::StationBeyondAxis`]; [`Error::Numerics`].
pub fn interpolate(
    basis: &ModalBasis,
    lra: &LoadReferenceAxis,
    stations: &[Station],
    method: Method,
) -> Result<StationShapes, Error> {
    let axis = Axis::new(basis, lra)?;
    let mut notes = Vec::new();
    let s = axis.station_coordinates(stations, &mut notes)?;
    let line = |d: usize| -> Result<Vec<f64>, Error> {
        axis.at(&s, method, axis.positions.iter().map(|p| p[d]), || {
            format!("the axis \"{}\"", lra.name)
        })
    };
    let (x_lra, y_lra, z_lra) = (line(0)?, line(1)?, line(2)?);

    let mut translation: [Mat<f64>; 3] =
        std::array::from_fn(|_| Mat::zeros(stations.len(), basis.modes.len()));
    let mut rotation = translation.clone();
    for (k, mode) in basis.modes.iter().enumerate() {
        let component = |d: usize| -> Result<Vec<f64>, Error> {
            let values = axis
                .indices
                .iter()
                .map(|&i| mode.shape.get(i).map_or(f64::NAN, |m| m[d]));
            axis.at(&s, method, values, || {
                format!("mode {} on axis \"{}\"", mode.number, lra.name)
            })
        };
        let t = [component(0)?, component(1)?, component(2)?];
        let r = [component(3)?, component(4)?, component(5)?];
        for (j, station) in stations.iter().enumerate() {
            let arm = Vector3::new(0.0, station.y - y_lra[j], station.z - z_lra[j]);
            let turn = Vector3::new(r[0][j], r[1][j], r[2][j]);
            let moved = Vector3::new(t[0][j], t[1][j], t[2][j]) + turn.cross(&arm);
            for d in 0..3 {
                translation[d][(j, k)] = moved[d];
                rotation[d][(j, k)] = turn[d];
            }
        }
    }
    Ok(StationShapes {
        translation,
        rotation,
        x_lra,
        notes,
    })
}

/// The axis on a basis: positions and running coordinates of its grids.
struct Axis<'a> {
    lra: &'a LoadReferenceAxis,
    indices: Vec<usize>,
    positions: Vec<[f64; 3]>,
    /// Unit vector in the y-z plane.
    direction: [f64; 2],
    /// Running coordinate of each grid, strictly increasing from 0, m.
    s: Vec<f64>,
}

impl<'a> Axis<'a> {
    fn new(basis: &ModalBasis, lra: &'a LoadReferenceAxis) -> Result<Self, Error> {
        let bad = |problem: &str| Error::BadAxis {
            axis: lra.name.clone(),
            problem: problem.into(),
        };
        let mut indices = Vec::with_capacity(lra.grids.len());
        let mut positions = Vec::with_capacity(lra.grids.len());
        for &id in &lra.grids {
            let index = basis.require_grid(id, || format!("load reference axis \"{}\"", lra.name))?;
            indices.push(index);
            positions.extend(basis.grids.get(index).map(|g| g.position));
        }
        let (Some(first), Some(last)) = (positions.first(), positions.last()) else {
            return Err(bad("it has no grids; list them from one end to the other"));
        };
        let mut axis = Self {
            lra,
            indices,
            direction: [0.0; 2],
            s: vec![0.0],
            positions: Vec::new(),
        };
        if positions.len() > 1 {
            let (dy, dz) = (last[1] - first[1], last[2] - first[2]);
            let (streamwise, span) = ((last[0] - first[0]).abs(), dy.hypot(dz));
            if span.is_nan() || span <= 1e-6 * streamwise.max(1e-6) {
                return Err(bad(
                    "its first and last grid have the same y and z, so no strip can find its place along it; an \
                     axis for strips runs across the stream (for a rigid body, name one grid)",
                ));
            }
            axis.direction = [dy / span, dz / span];
            axis.s = positions
                .iter()
                .map(|p| axis.along(p[1] - first[1], p[2] - first[2]))
                .collect();
            axis.check_monotonic(span)?;
        }
        axis.positions = positions;
        Ok(axis)
    }

    fn along(&self, dy: f64, dz: f64) -> f64 {
        self.direction[0] * dy + self.direction[1] * dz
    }

    fn check_monotonic(&self, span: f64) -> Result<(), Error> {
        for (s, grids) in self.s.windows(2).zip(self.lra.grids.windows(2)) {
            if let (&[first_at, second_at], &[first, second]) = (s, grids)
                && second_at - first_at <= 1e-9 * span
            {
                return Err(Error::AxisNotMonotonic {
                    axis: self.lra.name.clone(),
                    first,
                    first_at,
                    second,
                    second_at,
                });
            }
        }
        Ok(())
    }

    fn end(&self) -> f64 {
        self.s.last().copied().unwrap_or(0.0)
    }

    /// Running coordinate of each station; too far beyond an end is an error.
    fn station_coordinates(&self, stations: &[Station], notes: &mut Vec<String>) -> Result<Vec<f64>, Error> {
        let Some(first) = self.positions.first() else {
            return Ok(Vec::new());
        };
        let end = self.end();
        let allowed = LARGEST_EXTRAPOLATION * end;
        let (mut extrapolated, mut farthest) = (0, 0.0_f64);
        let mut coordinates = Vec::with_capacity(stations.len());
        for (index, station) in stations.iter().enumerate() {
            if ![station.x, station.y, station.z].iter().all(|v| v.is_finite()) {
                return Err(Error::BadAxis {
                    axis: self.lra.name.clone(),
                    problem: format!("station {index} has a coordinate that is not finite"),
                });
            }
            let s = self.along(station.y - first[1], station.z - first[2]);
            let beyond = (-s).max(s - end);
            if beyond > allowed + 1e-9 * end {
                let at_last = s > end;
                let grid = if at_last {
                    self.lra.grids.last()
                } else {
                    self.lra.grids.first()
                };
                return Err(Error::StationBeyondAxis {
                    axis: self.lra.name.clone(),
                    index,
                    y: station.y,
                    z: station.z,
                    beyond,
                    end: if at_last { "last" } else { "first" },
                    grid: grid.copied().unwrap_or_default(),
                    allowed,
                });
            }
            if beyond > 1e-9 * end {
                extrapolated += 1;
                farthest = farthest.max(beyond);
            }
            coordinates.push(s);
        }
        if extrapolated > 0 {
            notes.push(format!(
                "{extrapolated} stations lie up to {farthest:.4} m beyond the ends of load reference axis \"{}\" and \
                 follow its end slopes",
                self.lra.name
            ));
        }
        Ok(coordinates)
    }

    /// A quantity given at the grids, at coordinates `s`; beyond the ends along the tangent.
    fn at(
        &self,
        s: &[f64],
        method: Method,
        values: impl Iterator<Item = f64>,
        what: impl Fn() -> String,
    ) -> Result<Vec<f64>, Error> {
        let values: Vec<f64> = values.collect();
        if let [only] = values[..] {
            return Ok(vec![only; s.len()]);
        }
        let table = Interpolant::new(method, &self.s, &values).map_err(|source| Error::Numerics {
            what: format!("interpolation of {}", what()),
            source,
        })?;
        let (low, high) = table.range();
        Ok(s.iter()
            .map(|&s| {
                let inside = s.clamp(low, high);
                table.eval(inside)
                    + (s - inside)
                        * if s == inside {
                            0.0
                        } else {
                            table.derivative(inside)
                        }
            })
            .collect())
    }
}
