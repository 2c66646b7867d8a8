//! Output of the MODE menu: eigenvalues and the rigid-body system matrix.

use serde::{Deserialize, Serialize};

/// Content of an `.eig` file. AVL does not sort: the order is its eigenvalue routine's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Eigenvalues {
    /// Title of the geometry file.
    pub title: String,
    /// Eigenvalues of all run cases.
    pub eigenvalues: Vec<Eigenvalue>,
}

/// One eigenvalue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Eigenvalue {
    /// Run case, from 1.
    pub run_case: usize,
    /// Real part, in 1/s when the mass file's time unit is the second.
    pub sigma: f64,
    /// Imaginary part, in rad/s when the mass file's time unit is the second.
    pub omega_rad_s: f64,
}

/// Content of a system matrix file: `x' = A x + B u`.
///
/// State order u w q theta v p r phi x y z psi, speeds and positions in the mass file's units, angles in rad;
/// controls in degrees (times gain). AVL up to 3.35 prints geometry axes (x aft, z up), later versions body
/// axes (x forward, z down).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SystemMatrix {
    /// Names of the states as printed.
    pub states: Vec<String>,
    /// Names of the controls as printed.
    pub controls: Vec<String>,
    /// A, one row per state.
    pub a: Vec<Vec<f64>>,
    /// B, one row per state.
    pub b: Vec<Vec<f64>>,
}
