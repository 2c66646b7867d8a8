//! Modal results as plain data: eigenvalue tables, eigenvectors and grid point weight.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::deck::Id;
use crate::error::{Diagnostic, Error};
use crate::frames::Frames;

/// Who printed the file. Layouts differ in headings and columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Dialect {
    /// MSC Nastran.
    Msc,
    /// NX Nastran.
    Nx,
    /// Simcenter Nastran.
    Simcenter,
    /// NASTRAN-95 (COSMIC).
    Nastran95,
    /// MYSTRAN.
    Mystran,
    /// The tables are of the MSC layout; no banner or page header tells the program.
    Unknown,
}

/// One row of the real eigenvalue table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RealMode {
    /// Mode number, in ascending order of eigenvalue.
    pub mode: u32,
    /// Order in which the mode was found.
    pub extraction_order: u32,
    /// Eigenvalue, (rad/s)^2. May be slightly negative for rigid modes.
    pub eigenvalue: f64,
    /// Circular frequency as printed, rad/s: the root of the absolute eigenvalue.
    pub omega_rad_s: f64,
    /// Frequency as printed, Hz.
    pub frequency_hz: f64,
    /// Generalised mass; 0 for an eigenvalue without vector.
    pub generalized_mass: f64,
    /// Generalised stiffness.
    pub generalized_stiffness: f64,
}

impl RealMode {
    /// Whether a vector was computed: solvers print generalised mass 0 for those that were not.
    #[must_use]
    pub fn has_vector(&self) -> bool {
        self.generalized_mass != 0.0
    }
}

/// A real eigenvalue table. With residual vectors two are printed for a subcase; the last one stands here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EigenvalueTable {
    /// Subcase from the page header; `None` when none is printed.
    pub subcase: Option<u32>,
    /// Rows in file order.
    pub modes: Vec<RealMode>,
    /// Line of the heading.
    pub line: u32,
}

impl EigenvalueTable {
    /// The row of a mode.
    #[must_use]
    pub fn mode(&self, mode: u32) -> Option<&RealMode> {
        self.modes.iter().find(|m| m.mode == mode)
    }
}

/// What kind of point a row is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum PointKind {
    /// G: a grid with six components.
    Grid,
    /// S: a scalar or extra point with one component.
    Scalar,
    /// Any other letter (H, L, E, M, ...), as printed.
    Other(char),
}

/// Displacements of one point in one mode. A component that the file leaves blank is NaN.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EigenvectorRow {
    /// Point number.
    pub id: Id,
    /// Grid, scalar point or other.
    pub kind: PointKind,
    /// Displacement system when the file prints it (MYSTRAN); otherwise the deck has it.
    pub cd: Option<Id>,
    /// T1, T2, T3 (m for unit generalised coordinate) and R1, R2, R3 (rad) in the point's CD system. A scalar
    /// point has only the first. NaN where nothing is printed.
    pub values: [f64; 6],
}

impl EigenvectorRow {
    /// T1, T2, T3; `None` when one is not printed.
    #[must_use]
    pub fn translation(&self) -> Option<Vector3<f64>> {
        let [x, y, z, ..] = self.values;
        printed(Vector3::new(x, y, z))
    }

    /// R1, R2, R3; `None` when one is not printed.
    #[must_use]
    pub fn rotation(&self) -> Option<Vector3<f64>> {
        let [.., x, y, z] = self.values;
        printed(Vector3::new(x, y, z))
    }
}

fn printed(v: Vector3<f64>) -> Option<Vector3<f64>> {
    (!v.iter().any(|x| x.is_nan())).then_some(v)
}

/// One eigenvector, merged over pages.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Eigenvector {
    /// Subcase from the page header; `None` when none is printed.
    pub subcase: Option<u32>,
    /// Counts vectors of the same mode and subcase, from 0: a file may print a mode twice, for example on the
    /// structure's grids and then on an aerodynamic mesh.
    pub block: u32,
    /// Mode number.
    pub mode: u32,
    /// Eigenvalue in the header, (rad/s)^2. It can differ from the table in the last digit.
    pub eigenvalue: Option<f64>,
    /// Frequency in the header, Hz.
    pub frequency_hz: Option<f64>,
    /// Rows in file order.
    pub rows: Vec<EigenvectorRow>,
    /// Line of the first header.
    pub line: u32,
}

impl Eigenvector {
    /// The row of a grid.
    #[must_use]
    pub fn grid(&self, id: Id) -> Option<&EigenvectorRow> {
        self.rows.iter().find(|r| r.id == id && r.kind == PointKind::Grid)
    }
}

/// Output of the grid point weight generator, before PARAM,WTMASS is applied.
///
/// The 6x6 matrix MO is in the basic axes about the reference point. Programs print I(S) with different signs of
/// the products, so [`inertia_about_cg`](Self::inertia_about_cg) is rebuilt from MO.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GridPointWeight {
    /// Reference grid; 0 is the basic origin.
    pub reference_point: Id,
    /// Rigid-body mass matrix about the reference point, basic axes: kg, kg m, kg m^2. Symmetric; a program that
    /// prints only the upper part is completed.
    pub mo: [[f64; 6]; 6],
    /// Masses in the three directions of the axes S, as printed.
    pub masses: Option<[f64; 3]>,
    /// Centre of gravity for the mass in each of the three directions, from the reference point, m, as printed;
    /// one row per direction.
    pub cg_rows: Option<[[f64; 3]; 3]>,
    /// Transformation S, as printed.
    pub s: Option<[[f64; 3]; 3]>,
    /// Inertia about the centre of gravity in axes S, as printed: the signs of the products depend on the program.
    pub inertia_s: Option<[[f64; 3]; 3]>,
    /// Principal inertias I(Q), as printed.
    pub principal_inertia: Option<[f64; 3]>,
    /// Line of the heading.
    pub line: u32,
}

impl GridPointWeight {
    /// The masses felt along x, y and z: the first three diagonal terms of MO. They are equal for a complete
    /// model; scalar masses and constraints make them differ.
    #[must_use]
    pub fn directional_masses(&self) -> [f64; 3] {
        [self.mo[0][0], self.mo[1][1], self.mo[2][2]]
    }

    /// The mass, when the three directions agree within 1 part in 10^6 (what the file prints); otherwise `None`.
    #[must_use]
    pub fn mass(&self) -> Option<f64> {
        let [x, y, z] = self.directional_masses();
        let largest = x.max(y).max(z);
        ((x - y).abs() <= 1e-6 * largest && (x - z).abs() <= 1e-6 * largest && largest > 0.0).then_some(x)
    }

    /// Centre of gravity from the reference point, basic axes, m. With rigid-body mass matrix
    /// `M = [m 1, -m c~; m c~, J]` and c~ the cross-product matrix of the centre c: x is read from the row of the
    /// mass in y, y and z from the row of the mass in x, and from the remaining row if that direction has no mass.
    /// A coordinate that no row tells is 0.
    #[must_use]
    pub fn center_of_gravity(&self) -> Vector3<f64> {
        let m = &self.mo;
        let either = |a: (f64, f64), b: (f64, f64)| {
            if a.1 != 0.0 {
                a.0 / a.1
            } else if b.1 != 0.0 {
                b.0 / b.1
            } else {
                0.0
            }
        };
        Vector3::new(
            either((m[1][5], m[1][1]), (-m[2][4], m[2][2])),
            either((-m[0][5], m[0][0]), (m[2][3], m[2][2])),
            either((m[0][4], m[0][0]), (-m[1][3], m[1][1])),
        )
    }

    /// Inertia tensor about the centre of gravity, basic axes, kg m^2; products with the tensor's minus sign,
    /// `J_xy = -int(x y dm)`. Parallel-axis theorem on MO; where directional masses differ, each moment takes the
    /// masses that its rotation moves.
    #[must_use]
    pub fn inertia_about_cg(&self) -> Matrix3<f64> {
        let m = &self.mo;
        let [mx, my, mz] = self.directional_masses();
        let c = self.center_of_gravity();
        let jxx = m[3][3] - (my * c.z * c.z + mz * c.y * c.y);
        let jyy = m[4][4] - (mx * c.z * c.z + mz * c.x * c.x);
        let jzz = m[5][5] - (mx * c.y * c.y + my * c.x * c.x);
        let jxy = m[3][4] + mz * c.x * c.y;
        let jxz = m[3][5] + my * c.x * c.z;
        let jyz = m[4][5] + mx * c.y * c.z;
        Matrix3::new(jxx, jxy, jxz, jxy, jyy, jyz, jxz, jyz, jzz)
    }
}

/// Everything that a modal analysis printed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModalResults {
    /// File name as given to the reader.
    pub source: String,
    /// Who printed it.
    pub dialect: Dialect,
    /// Real eigenvalue tables, one for each subcase.
    pub eigenvalues: Vec<EigenvalueTable>,
    /// Eigenvectors in file order.
    pub eigenvectors: Vec<Eigenvector>,
    /// Grid point weight blocks (one, unless superelements or several subcases print more).
    pub weights: Vec<GridPointWeight>,
    /// Remarks of the reader.
    pub diagnostics: Vec<Diagnostic>,
}

impl ModalResults {
    /// The eigenvalue table that belongs to a vector: of the same subcase, or the only one.
    #[must_use]
    pub fn table_for(&self, vector: &Eigenvector) -> Option<&EigenvalueTable> {
        self.eigenvalues
            .iter()
            .find(|t| t.subcase == vector.subcase)
            .or_else(|| self.eigenvalues.iter().find(|t| t.mode(vector.mode).is_some()))
    }

    /// The eigenvectors.
    ///
    /// # Errors
    /// [`Error::MissingResult`] that names the output request when the file has none.
    pub fn require_eigenvectors(&self) -> Result<&[Eigenvector], Error> {
        if self.eigenvectors.is_empty() {
            return Err(Error::MissingResult {
                file: self.source.clone(),
                missing: format!(
                    "{} eigenvalues but no eigenvectors are printed",
                    self.eigenvalues.iter().map(|t| t.modes.len()).sum::<usize>()
                ),
                cure: match self.dialect {
                    Dialect::Nastran95 => {
                        "add VECTOR = ALL under OUTPUT in case control and run again".into()
                    }
                    _ => {
                        "add DISPLACEMENT(PRINT) = ALL (or VECTOR(PRINT) = ALL) to case control and run again"
                            .into()
                    }
                },
            });
        }
        Ok(&self.eigenvectors)
    }

    /// The (first) grid point weight block.
    ///
    /// # Errors
    /// [`Error::MissingResult`] that names the parameter when the file has none.
    pub fn require_weight(&self) -> Result<&GridPointWeight, Error> {
        self.weights.first().ok_or_else(|| Error::MissingResult {
            file: self.source.clone(),
            missing: "no output of the grid point weight generator".into(),
            cure: "add PARAM,GRDPNT,0 to the bulk data and run again".into(),
        })
    }

    /// The eigenvectors with grid rows rotated from each grid's displacement system (CD) to the basic system.
    /// Scalar points and missing components stay as they are; a partly printed triple becomes missing, since it
    /// cannot be rotated.
    ///
    /// # Errors
    /// [`Error::Mismatch`] for a grid that the deck lacks, or whose printed CD differs from the deck's.
    pub fn eigenvectors_in_basic(&self, frames: &Frames) -> Result<Vec<Eigenvector>, Error> {
        self.eigenvectors
            .iter()
            .map(|v| self.vector_in_basic(v, frames))
            .collect()
    }

    fn vector_in_basic(&self, vector: &Eigenvector, frames: &Frames) -> Result<Eigenvector, Error> {
        let mut rotated = vector.clone();
        for row in rotated.rows.iter_mut().filter(|r| r.kind == PointKind::Grid) {
            let grid = frames.grid(row.id).ok_or_else(|| Error::Mismatch {
                file: self.source.clone(),
                problem: format!(
                    "eigenvector {} has grid {}, which the deck lacks; give the deck that produced this file",
                    vector.mode, row.id
                ),
            })?;
            if let Some(cd) = row.cd.filter(|&cd| cd != grid.cd) {
                return Err(Error::Mismatch {
                    file: self.source.clone(),
                    problem: format!(
                        "grid {} is printed in system {cd}, but has CD = {} in the deck; give the deck that \
                         produced this file",
                        row.id, grid.cd
                    ),
                });
            }
            if grid.cd != 0 {
                let missing = Vector3::repeat(f64::NAN);
                let t = row.translation().map_or(missing, |t| grid.axes * t);
                let r = row.rotation().map_or(missing, |r| grid.axes * r);
                row.values = [t.x, t.y, t.z, r.x, r.y, r.z];
                row.cd = row.cd.map(|_| 0);
            }
        }
        Ok(rotated)
    }
}
