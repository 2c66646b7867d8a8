//! `[aerodynamics]`: files of AVL or the computation in their place, strips, options.

use super::SOLVE;
use albatross_flight::derivatives::DragLaw;
use albatross_flight::{ControlAerodynamics, ShapeReference};
use albatross_strip::{DihedralForm, DownwashPoint, Split};
use serde::Deserialize;

/// Aerodynamic inputs.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AerodynamicsCase {
    /// AVL geometry.
    pub geometry: String,
    /// [`SOLVE`] computes derivatives and strip forces from the geometry, in the place of AVL's files.
    pub results: Option<String>,
    /// Options of that computation.
    pub lattice: Option<LatticeCase>,
    /// AVL stability derivatives (`.st`).
    pub derivatives: Option<String>,
    /// AVL strip forces (`.fs`) at two incidences.
    pub strips: Option<[StripFileCase; 2]>,
    /// Where the strips' lift slopes come from.
    #[serde(default)]
    pub lift_slopes: LiftSlopes,
    /// Drag law.
    #[serde(default)]
    pub drag: DragLaw,
    /// The shape from which modes count.
    pub shape_reference: ShapeReference,
    /// How a control's lift builds up.
    #[serde(default)]
    pub control_aerodynamics: ControlAerodynamics,
    /// Booking of the non-circulatory terms.
    #[serde(default)]
    pub split: Split,
    /// How shapes meet dihedral.
    #[serde(default)]
    pub dihedral: DihedralForm,
    /// Where downwash is taken.
    #[serde(default)]
    pub downwash_point: DownwashPoint,
    /// Factor on the apparent mass.
    #[serde(default = "one")]
    pub apparent_mass_factor: f64,
    /// Surfaces that carry strips; all others count in the rigid derivatives alone.
    #[serde(rename = "surface")]
    pub surfaces: Vec<SurfaceCase>,
}

impl AerodynamicsCase {
    /// Derivatives and strip forces where they are read from files of AVL.
    pub fn files(&self) -> Option<(&String, &[StripFileCase; 2])> {
        self.derivatives.as_ref().zip(self.strips.as_ref())
    }

    /// What is wrong with the choice between files and computation, and the cure.
    pub(super) fn check_source(&self) -> Result<(), (String, &'static str)> {
        const CURE: &str =
            "name the files of AVL, `derivatives` and `strips`, or compute both with `results = \"solve\"`";
        let named = [
            ("derivatives", self.derivatives.is_some()),
            ("strips", self.strips.is_some()),
        ];
        let name = |there: bool| named.iter().find(|(_, t)| *t == there).map(|(n, _)| *n);
        match (&self.results, name(true), name(false)) {
            (Some(results), ..) if results != SOLVE => {
                Err((format!("[aerodynamics] results is \"{results}\""), CURE))
            }
            (Some(_), Some(name), _) => Err((
                format!("[aerodynamics] has results = \"solve\" and `{name}`"),
                CURE,
            )),
            (None, _, Some(name)) => Err((format!("[aerodynamics] has no `{name}`"), CURE)),
            // The lattice's slopes between strips may come beside the files.
            (None, ..) if self.lattice.is_some() && self.lift_slopes != LiftSlopes::Lattice => Err((
                "[aerodynamics.lattice] is given, but the files of AVL are read".into(),
                CURE,
            )),
            _ => Ok(()),
        }
    }
}

fn one() -> f64 {
    1.0
}

/// Source of the strips' lift slopes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LiftSlopes {
    /// The two AVL strip files.
    #[default]
    Avl,
    /// `2 pi` with the Prandtl-Glauert rule on `M cos(sweep)`; the rigid loads stay AVL's.
    PrandtlGlauert,
    /// Between all strips, from a vortex lattice of the geometry: the incidence of one strip lifts the others too.
    Lattice,
}

/// Options of the lattice that takes AVL's place.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LatticeCase {
    /// Version of AVL whose method is followed.
    pub method: AvlVersion,
    /// Whether the trailing legs on the surface carry forces; as in that version by default.
    pub leg_forces: Option<bool>,
    /// Mach number; that of the geometry file by default, of the flight point where the file has 0.
    pub mach: Option<f64>,
    /// The two incidences of the strips \[deg\].
    pub alphas_deg: [f64; 2],
}

impl Default for LatticeCase {
    fn default() -> Self {
        Self {
            method: AvlVersion::default(),
            leg_forces: None,
            mach: None,
            alphas_deg: [1.0, 2.0],
        }
    }
}

/// A version of AVL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AvlVersion {
    /// 3.32, and the versions up to 3.40.
    Avl332,
    /// 3.52.
    #[default]
    Avl352,
}

/// A strip file and its incidence.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StripFileCase {
    /// Path.
    pub file: String,
    /// Incidence of the run \[deg\].
    pub alpha_deg: f64,
}

/// A surface that carries strips.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceCase {
    /// Name in the AVL files.
    pub name: String,
    /// Load reference axis of the surface.
    pub lra: String,
    /// Load reference axis of its mirror image.
    pub image_lra: Option<String>,
    /// `d(epsilon)/d(alpha)`: downwash contained in the surface's lift slope with the aircraft's incidence. The slope
    /// for the strips' own motion is `cl_alpha / (1 - gradient)`.
    #[serde(default)]
    pub downwash_gradient: f64,
}
