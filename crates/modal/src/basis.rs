//! The modal basis: elastic modes on grids, checked and classified.

use albatross_nastran::deck::Id;
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::error::Error;
use crate::mass_matrix::MassMatrix;
use crate::mean_axes::{Checked, MeanAxes, OnViolation, RigidBody, check};
use crate::options::{BasisOptions, Normalisation};
use crate::symmetry::{MirrorPairs, Symmetry, symmetry_measure};
use albatross_fem::MassProperties;

/// A grid of the basis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BasisGrid {
    /// Grid number.
    pub id: Id,
    /// Position in structural axes (Nastran's basic system), m.
    pub position: [f64; 3],
}

/// An elastic mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BasisMode {
    /// Number of the mode as in the file.
    pub number: usize,
    /// Circular frequency in vacuo, rad/s.
    pub omega_rad_s: f64,
    /// Frequency in vacuo, Hz.
    pub frequency_hz: f64,
    /// Generalised mass, kg m^2 for a dimensionless generalised coordinate (kg for one in metres).
    pub generalized_mass: f64,
    /// T1, T2, T3 (m) and R1, R2, R3 (rad) for a unit generalised coordinate in structural axes, one row for each
    /// grid of the basis.
    pub shape: Vec<[f64; 6]>,
    /// Class about the plane y = 0.
    pub symmetry: Symmetry,
    /// 1 for a symmetric, -1 for an antisymmetric mode, see [`symmetry_measure`].
    pub symmetry_measure: f64,
}

impl BasisMode {
    /// Generalised stiffness, omega^2 times the generalised mass.
    #[must_use]
    pub fn generalized_stiffness(&self) -> f64 {
        self.omega_rad_s * self.omega_rad_s * self.generalized_mass
    }
}

/// A mode as given to [`ModalBasis::try_new`].
#[derive(Debug, Clone, PartialEq)]
pub struct ModeInput {
    /// Number of the mode.
    pub number: usize,
    /// Circular frequency, rad/s.
    pub omega_rad_s: f64,
    /// Generalised mass that belongs to the shape's normalisation.
    pub generalized_mass: f64,
    /// Shape in structural axes, one row for each grid.
    pub shape: Vec<[f64; 6]>,
}

/// The mass that belongs to a basis.
#[derive(Debug, Clone, PartialEq)]
pub struct BasisMass {
    /// Mass properties of the whole aircraft.
    pub properties: Option<MassProperties>,
    /// The mass matrix on the grids of the basis, or why there is none.
    pub matrix: Result<MassMatrix, String>,
    /// Rigid motions (translations, then rotations about the centre of gravity) that the supports leave free.
    pub free_directions: [bool; 6],
}

impl BasisMass {
    /// No mass is known: the mean-axes check is refused.
    #[must_use]
    pub fn unknown() -> Self {
        Self {
            properties: None,
            matrix: Err("no mass is given".into()),
            free_directions: [true; 6],
        }
    }
}

/// Elastic modes of an aircraft with what is known of their mass.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalBasis {
    /// Grids, in the order of every mode's shape.
    pub grids: Vec<BasisGrid>,
    /// Elastic modes, in the order asked for (ascending frequency unless numbers are given).
    pub modes: Vec<BasisMode>,
    /// Mass, centre of gravity and inertia of the whole aircraft, when known.
    pub mass: Option<MassProperties>,
    /// The mass matrix on the grids, when it is complete.
    pub mass_matrix: Option<MassMatrix>,
    /// The mean-axes check.
    pub mean_axes: MeanAxes,
    /// Remarks on what was assumed, left out or changed.
    pub notes: Vec<String>,
    index: BTreeMap<Id, usize>,
}

impl ModalBasis {
    /// Checks and classifies modes that any tool produced.
    ///
    /// # Errors
    /// [`Error::NoModes`], [`Error::DuplicateGrid`], [`Error::BadPosition`], [`Error::ShapeLength`], [`Error::BadMode`] for a number that is
    /// not finite or a frequency or generalised mass that is not positive, [`Error::BadMassMatrix`];
    /// [`Error::NotMeanAxes`] beyond the tolerance of `options` unless they say otherwise;
    /// [`Error::BadOption`].
    pub fn try_new(
        grids: Vec<BasisGrid>,
        modes: Vec<ModeInput>,
        mass: BasisMass,
        options: &BasisOptions,
    ) -> Result<Self, Error> {
        options.check()?;
        let index = index_of(&grids)?;
        let mut modes = checked_modes(&grids, modes)?;
        let mut notes = Vec::new();
        let (mean_axes, mass_matrix) = match mass.matrix {
            Err(reason) => (MeanAxes::Refused { reason }, None),
            Ok(matrix) => {
                let report = check_mean_axes(
                    &grids,
                    &mut modes,
                    &matrix,
                    mass.properties,
                    mass.free_directions,
                    options,
                    &mut notes,
                )?;
                (report, Some(matrix))
            }
        };
        let pairs = MirrorPairs::find(&grids, mirror_tolerance(&grids));
        if pairs.any_pair() && pairs.unpaired() > 0 {
            notes.push(format!(
                "{} of {} grids have no mirror image about y = 0 and do not count in the symmetry of modes",
                pairs.unpaired(),
                grids.len()
            ));
        }
        let modes = modes
            .into_iter()
            .map(|mode| {
                let measure = symmetry_measure(&mode.shape, &pairs, mass_matrix.as_ref());
                BasisMode {
                    number: mode.number,
                    omega_rad_s: mode.omega_rad_s,
                    frequency_hz: mode.omega_rad_s / TAU,
                    generalized_mass: mode.generalized_mass,
                    shape: mode.shape,
                    symmetry: Symmetry::from_measure(measure),
                    symmetry_measure: measure,
                }
            })
            .collect();
        let mut basis = Self {
            grids,
            modes,
            mass: mass.properties,
            mass_matrix,
            mean_axes,
            notes,
            index,
        };
        if options.normalisation == Normalisation::UnitMass {
            basis.normalise_mass();
        }
        Ok(basis)
    }

    /// Position of a grid in the list of grids.
    #[must_use]
    pub fn grid_index(&self, id: Id) -> Option<usize> {
        self.index.get(&id).copied()
    }

    /// Motion of a grid in every mode: T1 to T3 (m), R1 to R3 (rad), structural axes.
    ///
    /// # Errors
    /// [`Error::UnknownGrid`] with the nearest numbers.
    pub fn shape_at(&self, id: Id) -> Result<Vec<[f64; 6]>, Error> {
        let index = self.require_grid(id, || "a sensor or monitor point".into())?;
        Ok(self
            .modes
            .iter()
            .filter_map(|m| m.shape.get(index).copied())
            .collect())
    }

    /// Generalised masses in the order of the modes.
    #[must_use]
    pub fn generalized_masses(&self) -> Vec<f64> {
        self.modes.iter().map(|m| m.generalized_mass).collect()
    }

    /// Circular frequencies in the order of the modes, rad/s.
    #[must_use]
    pub fn omegas_rad_s(&self) -> Vec<f64> {
        self.modes.iter().map(|m| m.omega_rad_s).collect()
    }

    /// Largest couplings and the like, as one line for reports.
    #[must_use]
    pub fn mean_axes_summary(&self) -> String {
        match &self.mean_axes {
            MeanAxes::Refused { reason } => format!("mean axes not checked: {reason}"),
            MeanAxes::Checked(c) if c.orthogonalised.is_empty() => {
                format!(
                    "mean axes: largest coupling {:.1e}, tolerance {:.1e}",
                    c.worst, c.tolerance
                )
            }
            MeanAxes::Checked(c) => format!(
                "mean axes: largest coupling {:.1e}, tolerance {:.1e}; rigid part removed from {} modes",
                c.worst,
                c.tolerance,
                c.orthogonalised.len()
            ),
        }
    }

    pub(crate) fn require_grid(&self, id: Id, wanted_by: impl FnOnce() -> String) -> Result<usize, Error> {
        self.grid_index(id).ok_or_else(|| Error::UnknownGrid {
            id,
            wanted_by: wanted_by(),
            nearest: crate::text::nearest(id, self.grids.iter().map(|g| g.id)),
        })
    }

    pub(crate) fn require_mass_matrix(&self, operation: &'static str) -> Result<&MassMatrix, Error> {
        self.mass_matrix.as_ref().ok_or_else(|| Error::NoMassMatrix {
            operation,
            reason: match &self.mean_axes {
                MeanAxes::Refused { reason } => reason.clone(),
                MeanAxes::Checked(_) => "it was removed from the basis".into(),
            },
        })
    }

    fn normalise_mass(&mut self) {
        for mode in &mut self.modes {
            let scale = 1.0 / mode.generalized_mass.sqrt();
            mode.shape.iter_mut().flatten().for_each(|v| *v *= scale);
            mode.generalized_mass = 1.0;
        }
        if let (MeanAxes::Checked(check), Some(mass)) = (&mut self.mean_axes, &self.mass_matrix) {
            check.shape_generalized_mass = self
                .modes
                .iter()
                .map(|m| mass.inner(&m.shape, &m.shape))
                .collect();
        }
    }
}

fn index_of(grids: &[BasisGrid]) -> Result<BTreeMap<Id, usize>, Error> {
    let mut index = BTreeMap::new();
    for (i, grid) in grids.iter().enumerate() {
        if let Some(&value) = grid.position.iter().find(|v| !v.is_finite()) {
            return Err(Error::BadPosition { id: grid.id, value });
        }
        if index.insert(grid.id, i).is_some() {
            return Err(Error::DuplicateGrid { id: grid.id });
        }
    }
    Ok(index)
}

fn checked_modes(grids: &[BasisGrid], modes: Vec<ModeInput>) -> Result<Vec<Checked>, Error> {
    if modes.is_empty() {
        return Err(Error::NoModes);
    }
    modes
        .into_iter()
        .map(|m| {
            let bad = |what: &str, value, expected| {
                Err(Error::BadMode {
                    mode: m.number,
                    what: what.into(),
                    value,
                    expected,
                })
            };
            let positive = |v: f64| v.is_finite() && v > 0.0;
            if m.shape.len() != grids.len() {
                return Err(Error::ShapeLength {
                    mode: m.number,
                    found: m.shape.len(),
                    expected: grids.len(),
                });
            }
            if !positive(m.omega_rad_s) {
                return bad(
                    "the circular frequency in rad/s",
                    m.omega_rad_s,
                    "an elastic mode has a positive one; leave rigid modes and mechanisms out",
                );
            }
            if !positive(m.generalized_mass) {
                return bad(
                    "the generalised mass",
                    m.generalized_mass,
                    "a mode with a vector has a positive one",
                );
            }
            for (grid, motion) in grids.iter().zip(&m.shape) {
                if let Some(&value) = motion.iter().find(|v| !v.is_finite()) {
                    return bad(
                        &format!("a component of grid {}", grid.id),
                        value,
                        "six finite components; print T1 to R3 for every grid",
                    );
                }
            }
            Ok(Checked {
                number: m.number,
                omega_rad_s: m.omega_rad_s,
                generalized_mass: m.generalized_mass,
                shape: m.shape,
            })
        })
        .collect()
}

fn check_mean_axes(
    grids: &[BasisGrid],
    modes: &mut [Checked],
    matrix: &MassMatrix,
    properties: Option<MassProperties>,
    free: [bool; 6],
    options: &BasisOptions,
    notes: &mut Vec<String>,
) -> Result<MeanAxes, Error> {
    if matrix.len() != grids.len() {
        return Err(Error::BadMassMatrix {
            problem: format!("is for {} grids, the basis has {}", matrix.len(), grids.len()),
        });
    }
    let positions: Vec<[f64; 3]> = grids.iter().map(|g| g.position).collect();
    let cg = properties.map_or([0.0; 3], |p| p.cg);
    let body = RigidBody::new(matrix, &positions, cg, free)?;
    let tolerance = options.mean_axes_tolerance;
    let report = check(modes, matrix, &body, free, tolerance, options.on_violation)?;
    if !report.orthogonalised.is_empty() {
        notes.push(format!(
            "the rigid part of modes {:?} was removed (largest coupling {:.2e}); their frequencies and generalised \
             masses follow at constant strain energy",
            report.orthogonalised, report.worst
        ));
    } else if report.worst > tolerance && options.on_violation == OnViolation::Accept {
        notes.push(format!(
            "modes couple with rigid motion by {:.2e} (tolerance {tolerance:.1e}) and are kept as asked: do not fly \
             this basis",
            report.worst
        ));
    }
    if free.iter().all(|f| !f) {
        notes.push("the model is supported in all rigid directions: there are no mean axes to check".into());
    }
    Ok(MeanAxes::Checked(report))
}

/// 1e-5 of the model's largest dimension: decks give coordinates to about seven digits.
fn mirror_tolerance(grids: &[BasisGrid]) -> f64 {
    let size = (0..3).map(|i| {
        let coordinate = |g: &BasisGrid| g.position[i];
        let low = grids.iter().map(coordinate).fold(f64::INFINITY, f64::min);
        let high = grids.iter().map(coordinate).fold(f64::NEG_INFINITY, f64::max);
        high - low
    });
    (1e-5 * size.fold(0.0, f64::max)).max(1e-9)
}
