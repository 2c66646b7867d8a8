//! Mode shapes on strips: the normal displacement and the nose-up rotation at the load reference axis.
//!
//! Equations: THEORY (5), (6), (7), (13).

use crate::Error;
use crate::check::{ensure_finite_entries, ensure_shape};
use crate::strip::Strip;
use albatross_numerics::Mat;

/// Shapes on the strips, one column a shape.
///
/// At chordwise position x the chord moves by `phi - (x - x_lra) gamma` along the strip's normal.
#[derive(Debug, Clone)]
pub struct StripShapes {
    /// Displacement of the LRA along the strip's normal (up for a wing), strips x shapes \[m per unit\].
    pub phi: Mat<f64>,
    /// Nose-up rotation about the strip's span axis, strips x shapes \[rad per unit\].
    pub gamma: Mat<f64>,
}

/// How displacements of the structure become those of a strip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DihedralForm {
    /// T3 and R2 alone, as the paper does: dihedral is neglected, and surfaces steeper than 45 deg take no part.
    #[default]
    Paper,
    /// The true normal: `phi_n = phi_z cos G - phi_y sin G`, `gamma_s = R2 cos G + R3 sin G`.
    General,
}

impl DihedralForm {
    /// Cosine and sine by which a strip's vertical and lateral components enter.
    pub fn components(self, strip: &Strip) -> (f64, f64) {
        let (sin, cos) = strip.dihedral_rad.sin_cos();
        match self {
            Self::General => (cos, sin),
            Self::Paper if cos.abs() < std::f64::consts::FRAC_1_SQRT_2 => (0.0, 0.0),
            Self::Paper => (1.0, 0.0),
        }
    }
}

impl StripShapes {
    /// Shapes from matrices, strips x shapes.
    ///
    /// # Errors
    /// [`Error::Shape`] if the two differ in size, [`Error::NotFinite`] for a NaN or infinite entry.
    pub fn try_new(phi: Mat<f64>, gamma: Mat<f64>) -> Result<Self, Error> {
        let shapes = Self { phi, gamma };
        shapes.check()?;
        Ok(shapes)
    }

    /// Checks that both matrices are of one size and finite.
    ///
    /// # Errors
    /// As [`StripShapes::try_new`].
    pub fn check(&self) -> Result<(), Error> {
        let (phi, gamma) = (&self.phi, &self.gamma);
        ensure_shape("gamma", gamma, (phi.nrows(), phi.ncols()))?;
        ensure_finite_entries("phi", phi)?;
        ensure_finite_entries("gamma", gamma)
    }

    /// Shapes from the translations (y, z) and rotations (y, z) of the LRA at each strip, strips x modes each.
    ///
    /// # Errors
    /// As [`StripShapes::try_new`]; the rows of all four must be as many as there are strips, their columns as many as
    /// those of the first.
    pub fn from_components(
        strips: &[Strip],
        form: DihedralForm,
        translation_yz: [&Mat<f64>; 2],
        rotation_yz: [&Mat<f64>; 2],
    ) -> Result<Self, Error> {
        for (what, matrix) in [
            ("translation y", translation_yz[0]),
            ("translation z", translation_yz[1]),
            ("rotation y", rotation_yz[0]),
            ("rotation z", rotation_yz[1]),
        ] {
            ensure_shape(what, matrix, (strips.len(), translation_yz[0].ncols()))?;
        }
        let modes = translation_yz[0].ncols();
        let blend = |vertical: &Mat<f64>, lateral: &Mat<f64>, sign: f64| {
            Mat::from_fn(strips.len(), modes, |j, k| {
                let (cos, sin) = form.components(&strips[j]);
                vertical[(j, k)] * cos + sign * lateral[(j, k)] * sin
            })
        };
        Self::try_new(
            blend(translation_yz[1], translation_yz[0], -1.0),
            blend(rotation_yz[0], rotation_yz[1], 1.0),
        )
    }

    /// The six rigid-body shapes about a point, in the order and the senses of body axes (x forward, y right,
    /// z down): unit translations along and unit rotations about x, y, z.
    ///
    /// The generalised force on such a shape is the body-axis force or moment: `F_z = Q[heave down]`, and so on.
    /// The first column is zero: forces are normal to the chord and body-fixed (theory: constant rows of Eq. 7).
    pub fn rigid_body(strips: &[Strip], form: DihedralForm, x_cg: f64, z_cg: f64) -> Self {
        let shape = |j: usize, column: usize| -> (f64, f64) {
            let strip = &strips[j];
            let (cos, sin) = form.components(strip);
            let (x, y, z) = (strip.x_lra - x_cg, strip.y, strip.z - z_cg);
            match column {
                1 => (-sin, 0.0),
                2 => (-cos, 0.0),
                3 => (-(y * cos + z * sin), 0.0),
                4 => (-x * cos, cos),
                5 => (x * sin, -sin),
                _ => (0.0, 0.0),
            }
        };
        Self {
            phi: Mat::from_fn(strips.len(), 6, |j, column| shape(j, column).0),
            gamma: Mat::from_fn(strips.len(), 6, |j, column| shape(j, column).1),
        }
    }

    /// Number of strips.
    pub fn n_strips(&self) -> usize {
        self.phi.nrows()
    }

    /// Number of shapes.
    pub fn n_shapes(&self) -> usize {
        self.phi.ncols()
    }

    /// Displacement at a chordwise point of each strip: `phi - (x - x_lra) gamma`, strips x shapes. Rows without a strip,
    /// and what only one of phi and gamma has, are left out.
    pub fn at(&self, strips: &[Strip], x: impl Fn(&Strip) -> f64) -> Mat<f64> {
        let rows = self.n_strips().min(self.gamma.nrows()).min(strips.len());
        let columns = self.n_shapes().min(self.gamma.ncols());
        Mat::from_fn(rows, columns, |j, k| {
            self.phi[(j, k)] - (x(&strips[j]) - strips[j].x_lra) * self.gamma[(j, k)]
        })
    }
}
