//! Where a bar or beam lies: its ends, offsets and axes.
//!
//! The x axis runs from end A to end B, offsets included. The orientation vector v spans plane 1 with it:
//! `z = x cross v`, `y = z cross x`. Letters of OFFT: the first is the frame of v (G the displacement system of
//! grid A, B basic), the second and third those of the offsets at A and B (G the displacement system of the grid, O
//! the offset system: x from grid A to grid B, with the same v).

use albatross_nastran::deck::{Cbar, Cbeam, Id, Orientation};
use nalgebra::{Matrix3, Vector3};

use crate::context::Context;
use crate::error::Error;

/// What CBAR and CBEAM say of their position.
pub(crate) struct LineCard<'a> {
    pub(crate) name: &'static str,
    pub(crate) id: Id,
    pub(crate) grids: [Id; 2],
    orientation: Option<&'a Orientation>,
    offset_frames: &'a str,
    offsets: [[f64; 3]; 2],
}

impl<'a> From<&'a Cbar> for LineCard<'a> {
    fn from(bar: &'a Cbar) -> Self {
        Self {
            name: "CBAR",
            id: bar.id,
            grids: bar.grids,
            orientation: bar.orientation.as_ref(),
            offset_frames: &bar.offset_frames,
            offsets: [bar.wa, bar.wb],
        }
    }
}

impl<'a> From<&'a Cbeam> for LineCard<'a> {
    fn from(beam: &'a Cbeam) -> Self {
        Self {
            name: "CBEAM",
            id: beam.id,
            grids: beam.grids,
            orientation: beam.orientation.as_ref(),
            offset_frames: &beam.offset_frames,
            offsets: [beam.wa, beam.wb],
        }
    }
}

/// The axis of an element in basic axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineAxis {
    /// From each grid to the element's end, m.
    pub(crate) arms: [Vector3<f64>; 2],
    /// From end A to end B, m.
    pub(crate) vector: Vector3<f64>,
    /// Length, m.
    pub(crate) length: f64,
}

impl LineCard<'_> {
    /// Ends and length. The orientation is looked at only where an offset needs it.
    pub(crate) fn axis(&self, context: &Context<'_>) -> Result<LineAxis, Error> {
        let [a, b] = self.grids;
        let at_a = context.grid(self.name, self.id, a)?.position;
        let at_b = context.grid(self.name, self.id, b)?.position;
        let mut arms = [Vector3::zeros(); 2];
        for (end, (arm, offset)) in arms.iter_mut().zip(self.offsets).enumerate() {
            if offset == [0.0; 3] {
                continue;
            }
            let grid = self.grids.get(end).copied().unwrap_or_default();
            let axes = match self.offset_frames.as_bytes().get(end + 1) {
                None | Some(b'G') => context.grid(self.name, self.id, grid)?.axes,
                Some(b'O') => self.axes(context, at_b - at_a)?,
                Some(_) => return Err(self.unknown_frames(context)),
            };
            *arm = axes * Vector3::from(offset);
        }
        let vector = (at_b + arms[1]) - (at_a + arms[0]);
        let length = vector.norm();
        if !(length > 0.0 && length.is_finite()) {
            return Err(context.bad_element(
                self.name,
                self.id,
                format!("its length between grids {a} and {b} is {length} m; correct the grids or offsets"),
            ));
        }
        Ok(LineAxis { arms, vector, length })
    }

    /// Columns x, y, z of a frame with x along `vector` and the card's v in the x-y plane.
    pub(crate) fn axes(&self, context: &Context<'_>, vector: Vector3<f64>) -> Result<Matrix3<f64>, Error> {
        let bad = |problem: &str| context.bad_element(self.name, self.id, problem);
        let a = self.grids[0];
        let grid = context.grid(self.name, self.id, a)?;
        let v = match self.orientation {
            Some(Orientation::Grid(g0)) => context.grid(self.name, self.id, *g0)?.position - grid.position,
            Some(Orientation::Vector(v)) => {
                let v = Vector3::from(*v);
                match self.offset_frames.as_bytes().first() {
                    None | Some(b'G') => grid.axes * v,
                    Some(b'B') => v,
                    Some(_) => return Err(self.unknown_frames(context)),
                }
            }
            None => return Err(bad("it has no orientation vector; give X1, X2, X3 or G0")),
        };
        let x = vector
            .try_normalize(0.0)
            .ok_or_else(|| bad("its grids coincide; an offset system needs two grids"))?;
        let z = x.cross(&v);
        if z.norm() <= 1e-8 * v.norm() {
            return Err(bad(
                "its orientation vector is zero or along the element; choose one across it",
            ));
        }
        let z = z.normalize();
        Ok(Matrix3::from_columns(&[x, z.cross(&x), z]))
    }

    fn unknown_frames(&self, context: &Context<'_>) -> Error {
        context.bad_element(
            self.name,
            self.id,
            format!(
                "OFFT is {:?}; expected G or B, then G or O for each end, such as GGG or BGO",
                self.offset_frames
            ),
        )
    }
}
