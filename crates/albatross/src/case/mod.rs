//! The case file: one TOML document that names inputs, corrections, flight point, sensors and manoeuvres.
//!
//! Every key is described in `docs/CASE.md`; unknown keys are errors. Structural damping has no default.

mod aerodynamics;
mod grids;
pub mod manoeuvre;
mod numbers;

pub use aerodynamics::{AerodynamicsCase, AvlVersion, LatticeCase, LiftSlopes, StripFileCase, SurfaceCase};
pub use grids::{GridEntry, grid_list};
pub use manoeuvre::{ManoeuvreCase, SignalCase};

use crate::Error;
use albatross_flight::{Attitude, ControlAerodynamics, Fidelity, Method, Quantity, atmosphere};
use albatross_modal::{BasisOptions, ModalBasis, Selection};
use albatross_nastran::{Deck, ModalResults};
use albatross_numerics::interp;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A whole case.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Title.
    pub title: String,
    /// Structural inputs.
    pub structure: StructureCase,
    /// Aerodynamic inputs.
    pub aerodynamics: AerodynamicsCase,
    /// Data of higher fidelity that variants may use.
    pub corrections: Option<CorrectionsCase>,
    /// Reference shape where it is not that of the AVL run.
    pub reference: Option<ReferenceCase>,
    /// Flight point.
    pub flight: FlightCase,
    /// Engines; without them the thrust acts through the centre of gravity.
    #[serde(default, rename = "engine")]
    pub engines: Vec<EngineCase>,
    /// Variants; the first is the default.
    #[serde(default, rename = "variant")]
    pub variants: Vec<VariantCase>,
    /// Outputs.
    #[serde(default, rename = "sensor")]
    pub sensors: Vec<SensorCase>,
    /// Simulations.
    #[serde(default, rename = "manoeuvre")]
    pub manoeuvres: Vec<ManoeuvreCase>,
    /// Frequencies of the frequency response.
    #[serde(default)]
    pub bode: BodeCase,
}

/// Structural inputs.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StructureCase {
    /// Nastran deck.
    pub deck: String,
    /// Printed results of SOL 103; or [`SOLVE`], which computes them from the deck.
    pub results: String,
    /// Options of that computation.
    pub solve: Option<ModalSolveCase>,
    /// Elastic modes that are kept: how many from the lowest, or their numbers in the file.
    pub modes: ModeChoice,
    /// Structural damping ratio of all modes, or one each.
    pub damping_ratio: Damping,
    /// Largest share of rigid motion in a mode.
    #[serde(default = "default_tolerance")]
    pub mean_axes_tolerance: f64,
    /// What to do with a mode beyond it.
    #[serde(default)]
    pub on_violation: OnViolation,
    /// Interpolation along the load reference axes.
    #[serde(default = "default_interpolation")]
    pub interpolation: interp::Method,
    /// Subcase of the results, where there are several.
    pub subcase: Option<u32>,
    /// Load reference axes: grids from one end to the other.
    pub lra: BTreeMap<String, Vec<GridEntry>>,
}

fn default_tolerance() -> f64 {
    1e-6
}

fn default_interpolation() -> interp::Method {
    interp::Method::Cubic
}

/// In the place of a results file: computed from the deck or the geometry.
pub const SOLVE: &str = "solve";

/// Options of the modal solution.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModalSolveCase {
    /// How the mass of elements is spread; as `PARAM,COUPMASS` of the deck says by default.
    pub mass: Option<ElementMass>,
}

/// How the mass of elements is spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ElementMass {
    /// Half of it at each end.
    Lumped,
    /// Consistent with the displacements within the element.
    Coupled,
}

/// What to do with a mode that holds rigid motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OnViolation {
    /// Stop with the figures.
    #[default]
    Refuse,
    /// Remove the rigid motion.
    Orthogonalise,
    /// Go on with the modes as they are.
    Accept,
}

impl From<OnViolation> for albatross_modal::OnViolation {
    fn from(choice: OnViolation) -> Self {
        match choice {
            OnViolation::Refuse => Self::Refuse,
            OnViolation::Orthogonalise => Self::Orthogonalise,
            OnViolation::Accept => Self::Accept,
        }
    }
}

/// Which modes.
#[derive(Debug, Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "modes is neither a whole number nor a list of mode numbers"
)]
pub enum ModeChoice {
    /// The lowest elastic modes.
    Lowest(usize),
    /// Numbers in the results file.
    Numbers(Vec<usize>),
}

/// Damping of the modes.
#[derive(Debug, Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "damping_ratio is neither a number nor a list of numbers"
)]
pub enum Damping {
    /// The same ratio for all.
    Uniform(f64),
    /// One ratio per mode.
    PerMode(Vec<f64>),
}

/// Data of higher fidelity.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrectionsCase {
    /// Where the data come from; kept with every result.
    pub provenance: String,
    /// CSV of lift slopes by surface and y.
    pub lift_slopes: Option<String>,
    /// JSON of the eight longitudinal derivatives.
    pub derivatives: Option<String>,
    /// Control that the elevator derivatives belong to; the trim control by default.
    pub elevator: Option<String>,
}

/// Reference shape.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceCase {
    /// Area \[m²\].
    pub area: f64,
    /// Chord \[m\].
    pub chord: f64,
    /// Span \[m\].
    pub span: f64,
}

/// Flight point.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightCase {
    /// Mach number; or give `speed`.
    pub mach: Option<f64>,
    /// True airspeed \[m/s\].
    pub speed: Option<f64>,
    /// Geopotential altitude \[m\].
    pub altitude: f64,
    /// Flight-path angle \[deg\].
    #[serde(default)]
    pub path_angle_deg: f64,
    /// Control that trims pitch.
    pub trim_control: String,
    /// Gravity \[m/s²\].
    #[serde(default = "default_gravity")]
    pub gravity: f64,
    /// How simulations keep attitude; linear analyses use Euler angles.
    #[serde(default)]
    pub attitude: Attitude,
}

impl FlightCase {
    /// Mach number.
    pub fn mach(&self) -> f64 {
        self.mach
            .or(self.speed.map(|v| v / self.speed_of_sound()))
            .unwrap_or(0.0)
    }

    /// True airspeed \[m/s\].
    pub fn speed(&self) -> f64 {
        self.speed
            .or(self.mach.map(|m| m * self.speed_of_sound()))
            .unwrap_or(0.0)
    }

    fn speed_of_sound(&self) -> f64 {
        atmosphere::standard(self.altitude).speed_of_sound
    }
}

fn default_gravity() -> f64 {
    albatross_flight::atmosphere::STANDARD_GRAVITY
}

/// An engine.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EngineCase {
    /// Name.
    pub name: String,
    /// Grid where the thrust acts and whose motion it works on.
    pub grid: u32,
    /// Share of the total thrust.
    pub share: f64,
    /// Thrust direction above body x \[deg\].
    #[serde(default)]
    pub incidence_deg: f64,
    /// Thrust direction to the right of body x \[deg\].
    #[serde(default)]
    pub toe_deg: f64,
}

/// Line of the thrust.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThrustLine {
    /// Through the centre of gravity along body x, no work on the modes.
    #[default]
    ThroughCg,
    /// At the engines.
    Engines,
}

/// A variant of the model.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VariantCase {
    /// Name.
    pub name: String,
    /// What it is.
    #[serde(default)]
    pub description: String,
    /// Whether the corrections are applied.
    #[serde(default)]
    pub corrections: bool,
    /// Line of the thrust.
    #[serde(default)]
    pub thrust_line: ThrustLine,
    /// Overrides the case's choice.
    pub control_aerodynamics: Option<ControlAerodynamics>,
    /// How the air follows the elastic motion.
    #[serde(default)]
    pub fidelity: Fidelity,
}

/// An output.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorCase {
    /// Name.
    pub name: String,
    /// What is measured.
    pub quantity: Quantity,
    /// Grid; none for the mean axes at the centre of gravity.
    pub grid: Option<u32>,
}

/// Frequencies of the frequency response, evenly spaced on a logarithmic scale.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodeCase {
    /// Lowest \[rad/s\].
    pub from_rad_s: f64,
    /// Highest \[rad/s\].
    pub to_rad_s: f64,
    /// How many.
    pub points: usize,
}

impl Default for BodeCase {
    fn default() -> Self {
        Self {
            from_rad_s: 0.01,
            to_rad_s: 200.0,
            points: 600,
        }
    }
}

impl BodeCase {
    /// The frequencies \[rad/s\].
    pub fn frequencies(&self) -> Vec<f64> {
        let n = self.points.max(2);
        let ratio = (self.to_rad_s / self.from_rad_s).ln() / (n - 1) as f64;
        (0..n)
            .map(|i| self.from_rad_s * (ratio * i as f64).exp())
            .collect()
    }
}

/// Most frequencies of a response: each costs about 0.3 ms.
const MOST_FREQUENCIES: usize = 100_000;
/// Files that a run writes beside those of the manoeuvres.
const RESULT_FILES: [&str; 6] = [
    "modes",
    "strips",
    "bode",
    "modes_elastic",
    "modes_rigid_body",
    "mode_shapes",
];

/// Method of integration where a manoeuvre names none.
pub(crate) fn default_method() -> Method {
    Method::Rk4
}

impl Case {
    /// Reads a case from TOML text.
    ///
    /// # Errors
    /// [`Error::Case`] with file, line and what is wrong.
    pub fn parse(text: &str, file: &str) -> Result<Self, Error> {
        let case: Self = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(0, |span| {
                1 + text.get(..span.start).map_or(0, |t| t.matches('\n').count())
            });
            Error::Case {
                file: file.to_owned(),
                line,
                message: e.message().trim().to_owned(),
                cure: "see docs/CASE.md for every key".into(),
            }
        })?;
        case.check(file)?;
        Ok(case)
    }

    pub(crate) fn check(&self, file: &str) -> Result<(), Error> {
        let refuse = |message: String, cure: &str| {
            Err(Error::Case {
                file: file.to_owned(),
                line: 0,
                message,
                cure: cure.to_owned(),
            })
        };
        match (self.flight.mach, self.flight.speed) {
            (Some(_), Some(_)) => {
                return refuse("[flight] has both `mach` and `speed`".into(), "keep one of them");
            }
            (None, None) => {
                return refuse(
                    "[flight] has neither `mach` nor `speed`".into(),
                    "add `mach = ...`",
                );
            }
            _ => {}
        }
        if let Err((message, cure)) = self.aerodynamics.check_source() {
            return refuse(message, cure);
        }
        if self.structure.solve.is_some() && self.structure.results != SOLVE {
            return refuse(
                format!(
                    "[structure.solve] is given, but `{}` is read",
                    self.structure.results
                ),
                "set results = \"solve\", or remove the table",
            );
        }
        if let Some((message, cure)) = self.number_out_of_range() {
            return refuse(message, &cure);
        }
        let mach = self.flight.mach();
        if mach >= 1.0 {
            return refuse(
                format!("[flight] is at Mach {mach:.3}: the aerodynamics are subsonic"),
                "fly below Mach 0.9; speeds are true airspeeds in m/s (1 kt is 0.5144 m/s)",
            );
        }
        for surface in &self.aerodynamics.surfaces {
            for axis in std::iter::once(&surface.lra).chain(&surface.image_lra) {
                if !self.structure.lra.contains_key(axis) {
                    let known = self.structure.lra.keys().cloned().collect::<Vec<_>>().join(", ");
                    return refuse(
                        format!(
                            "surface `{}` names the load reference axis `{axis}`",
                            surface.name
                        ),
                        &format!("use one of [structure.lra]: {known}"),
                    );
                }
            }
        }
        let mut surfaces: Vec<&str> = self.aerodynamics.surfaces.iter().map(|s| s.name.trim()).collect();
        surfaces.sort_unstable();
        let mut pairs = surfaces.iter().zip(surfaces.iter().skip(1));
        if let Some((name, _)) = pairs.find(|(a, b)| a.eq_ignore_ascii_case(b)) {
            return refuse(
                format!("surface `{name}` is listed twice"),
                "list it once: its strips would count twice",
            );
        }
        if self.bode.points > MOST_FREQUENCIES {
            return refuse(
                format!("[bode] points is {}", self.bode.points),
                "give 100000 or fewer",
            );
        }
        self.check_manoeuvre_names(file)?;
        let b = self.bode;
        if !(b.from_rad_s > 0.0 && b.to_rad_s > b.from_rad_s && b.to_rad_s.is_finite() && b.points >= 2) {
            return refuse(
                "[bode] needs 0 < from_rad_s < to_rad_s and at least 2 points".into(),
                "correct [bode]",
            );
        }
        let mut names: Vec<&str> = self.variants.iter().map(|v| v.name.as_str()).collect();
        names.sort_unstable();
        if let Some((name, _)) = names.iter().zip(names.iter().skip(1)).find(|(a, b)| a == b) {
            return refuse(format!("two variants are named `{name}`"), "rename one of them");
        }
        Ok(())
    }

    /// Names of manoeuvres become names of files.
    fn check_manoeuvre_names(&self, file: &str) -> Result<(), Error> {
        let mut names: Vec<&str> = Vec::new();
        for manoeuvre in &self.manoeuvres {
            let name = manoeuvre.name.as_str();
            let plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | ' ');
            let message = if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
                format!("the manoeuvre name `{name}` cannot be the name of a file")
            } else if RESULT_FILES.contains(&name) {
                format!("the manoeuvre name `{name}` is that of another result")
            } else if names.contains(&name) {
                format!("two manoeuvres are named `{name}`")
            } else {
                names.push(name);
                continue;
            };
            return Err(Error::Case {
                file: file.to_owned(),
                line: 0,
                message,
                cure: "use another name of letters, digits, `_`, `-` and `.`".into(),
            });
        }
        Ok(())
    }

    /// The modal basis of a deck and its results, with the options of this case.
    ///
    /// # Errors
    /// As [`ModalBasis::from_nastran`].
    pub fn basis(&self, deck: &Deck, results: &ModalResults) -> Result<ModalBasis, Error> {
        let structure = &self.structure;
        let options = BasisOptions {
            modes: match &structure.modes {
                ModeChoice::Lowest(n) => Selection::FirstElastic(*n),
                ModeChoice::Numbers(numbers) => Selection::Numbers(numbers.clone()),
            },
            subcase: structure.subcase,
            mean_axes_tolerance: structure.mean_axes_tolerance,
            on_violation: structure.on_violation.into(),
            ..BasisOptions::default()
        };
        Ok(ModalBasis::from_nastran(deck, results, &options)?)
    }

    /// A variant by name, or the first one (a plain one if the case has none).
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names there are.
    pub fn variant(&self, name: Option<&str>) -> Result<VariantCase, Error> {
        let Some(name) = name else {
            return Ok(self.variants.first().cloned().unwrap_or_else(|| VariantCase {
                name: "base".into(),
                ..VariantCase::default()
            }));
        };
        self.variants
            .iter()
            .find(|v| v.name == name)
            .cloned()
            .ok_or_else(|| Error::UnknownName {
                kind: "variant",
                name: name.to_owned(),
                known: self
                    .variants
                    .iter()
                    .map(|v| v.name.clone())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// A manoeuvre by name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names there are.
    pub fn manoeuvre(&self, name: &str) -> Result<&ManoeuvreCase, Error> {
        self.manoeuvres
            .iter()
            .find(|m| m.name == name)
            .ok_or_else(|| Error::UnknownName {
                kind: "manoeuvre",
                name: name.to_owned(),
                known: self
                    .manoeuvres
                    .iter()
                    .map(|m| m.name.clone())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }
}
