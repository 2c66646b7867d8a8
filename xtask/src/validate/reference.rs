//! The reference: time histories, trim, eigenvalues and derivatives of the same surrogate from an independent
//! simulation.

use super::paper::read_json;
use crate::error::Error;
use crate::workspace;
use albatross::tables::Columns;
use serde::Deserialize;
use std::path::Path;

/// A quantity that is compared: its sensor in the case, its column in the reference's files, and how it is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quantity {
    /// Name of the sensor, an output of the model.
    pub(crate) sensor: &'static str,
    /// Column of the reference's CSV files.
    pub(crate) column: &'static str,
    /// Symbol for plots.
    pub(crate) symbol: &'static str,
    /// Plain name for tables.
    pub(crate) name: &'static str,
    /// Unit shown.
    pub(crate) unit: &'static str,
    /// Value of one model unit (SI) in the unit shown.
    pub(crate) scale: f64,
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// The quantities whose fit is reported, in the order of its columns.
pub(crate) const QUANTITIES: [Quantity; 6] = [
    Quantity {
        sensor: "alpha",
        column: "alpha_deg",
        symbol: "α",
        name: "alpha",
        unit: "deg",
        scale: DEGREES,
    },
    Quantity {
        sensor: "q",
        column: "q_deg_s",
        symbol: "q",
        name: "q",
        unit: "deg/s",
        scale: DEGREES,
    },
    Quantity {
        sensor: "nz",
        column: "nz",
        symbol: "n_{z}",
        name: "n_z",
        unit: "",
        scale: 1.0,
    },
    Quantity {
        sensor: "az_cockpit",
        column: "az_cockpit",
        symbol: "a_{z}, cockpit",
        name: "a_z cockpit",
        unit: "m/s^{2}",
        scale: 1.0,
    },
    Quantity {
        sensor: "az_last_pax",
        column: "az_last_pax",
        symbol: "a_{z}, last passenger",
        name: "a_z last passenger",
        unit: "m/s^{2}",
        scale: 1.0,
    },
    Quantity {
        sensor: "az_right_wing_tip",
        column: "az_right_wing_tip",
        symbol: "a_{z}, right wing tip",
        name: "a_z right wing tip",
        unit: "m/s^{2}",
        scale: 1.0,
    },
];

/// The manoeuvres: name in the case (and of the reference's file), name shown.
pub(crate) const MANOEUVRES: [(&str, &str); 3] = [
    ("doublet_0p5Hz", "0.5 Hz"),
    ("doublet_3Hz", "3 Hz"),
    ("doublet_10Hz", "10 Hz"),
];

/// Fits that reduced variants of the reference itself reach against it, printed in its README (caveat 3): range over
/// alpha, q, `n_z` and the four `a_z` outputs, in percent, for the 0.5 Hz and the 10 Hz doublet.
pub(crate) const OWN_VARIANTS: [(&str, [f64; 2], [f64; 2]); 3] = [
    (
        "quasi-steady throughout, no hinge rate",
        [86.0, 90.0],
        [51.0, 88.0],
    ),
    ("no hinge rate, all else unsteady", [98.0, 99.5], [83.0, 98.0]),
    (
        "20 modes instead of 50, all else unsteady",
        [95.0, 97.0],
        [77.0, 99.0],
    ),
];

/// Cost of the reference, printed in its README (caveat 7): seconds of CPU for one simulated second.
pub(crate) const COST_PER_SECOND: [(&str, usize, [f64; 2]); 2] = [
    (
        "reference, fine (DOP853 1e-10, 1 ms; 2 shared vCPU)",
        976,
        [2.6, 2.8],
    ),
    (
        "reference, coarse (RK45 1e-6, 2 ms; 2 shared vCPU)",
        976,
        [1.0, 1.0],
    ),
];

/// A frequency between the reference's rigid-body modes (up to 1.7 rad/s) and its elastic modes (from 18 rad/s)
/// \[rad/s\].
const BETWEEN: f64 = 5.0;

/// All that is read of the reference.
#[derive(Debug, Clone)]
pub(crate) struct Reference {
    /// Histories in the order of [`MANOEUVRES`].
    pub(crate) histories: Vec<History>,
    /// Trim and eigenvalues.
    pub(crate) modes: Modes,
    /// Derivatives that the correction does not use.
    pub(crate) derivatives: Derivatives,
}

/// One time history.
#[derive(Debug, Clone)]
pub(crate) struct History {
    /// Times \[s\].
    pub(crate) time: Vec<f64>,
    /// Elevator, trim included \[deg\].
    pub(crate) elevator_deg: Vec<f64>,
    /// Series in the order of [`QUANTITIES`], in the unit shown, trim included.
    pub(crate) series: Vec<Vec<f64>>,
}

/// Trim and eigenvalues of the linearised reference.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Modes {
    pub(crate) trim: Trim,
    pub(crate) eigenvalues: Vec<Eigenvalue>,
    pub(crate) slow_real_eigenvalues: Vec<f64>,
}

/// Trim of the reference.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Trim {
    pub(crate) alpha_deg: f64,
    pub(crate) elevator_deg: f64,
    #[serde(rename = "thrust_N")]
    pub(crate) thrust: f64,
}

/// An oscillatory eigenvalue of the reference.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Eigenvalue {
    pub(crate) omega_rad_s: f64,
    pub(crate) zeta: f64,
    pub(crate) dominant_elastic_mode: usize,
    pub(crate) symmetric: bool,
}

/// Derivatives of the reference: per rad, per `q c/2V` and per `d(alpha)/dt c/2V`.
#[derive(Debug, Clone, Deserialize)]
#[allow(non_snake_case)]
pub(crate) struct Derivatives {
    pub(crate) CLadot_low_frequency: f64,
    pub(crate) Cmadot_low_frequency: f64,
    pub(crate) CLde_dot_low_frequency: f64,
    pub(crate) Cmde_dot_low_frequency: f64,
    pub(crate) static_aeroelastic: StaticAeroelastic,
}

/// Static derivatives of the rigid and the flexible reference.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct StaticAeroelastic {
    pub(crate) alpha: RigidFlexible,
    pub(crate) q: RigidFlexible,
    pub(crate) de: RigidFlexible,
}

/// One derivative of lift and pitching moment, rigid and with the elastic deformation in equilibrium.
#[derive(Debug, Clone, Copy, Deserialize)]
#[allow(non_snake_case)]
pub(crate) struct RigidFlexible {
    pub(crate) rigid_CL: f64,
    pub(crate) rigid_Cm: f64,
    pub(crate) flex_CL: f64,
    pub(crate) flex_Cm: f64,
}

impl Reference {
    /// Reads the reference's directory.
    pub(crate) fn read(directory: &Path) -> Result<Self, Error> {
        let histories = MANOEUVRES
            .iter()
            .map(|(name, _)| History::read(&directory.join(format!("{name}.csv"))))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            histories,
            modes: read_json(&directory.join("eigenvalues.json"))?,
            derivatives: read_json(&directory.join("derivatives_reference.json"))?,
        })
    }
}

impl History {
    fn read(path: &Path) -> Result<Self, Error> {
        let columns = Columns::parse(&workspace::read(path)?, &path.display().to_string())?;
        Ok(Self {
            time: columns.numbers("t_s")?,
            elevator_deg: columns.numbers("elevator_deg")?,
            series: QUANTITIES
                .iter()
                .map(|quantity| columns.numbers(quantity.column))
                .collect::<Result<_, _>>()?,
        })
    }
}

impl Modes {
    /// The elastic modes of one symmetry, slowest first.
    pub(crate) fn elastic(&self, symmetric: bool) -> impl Iterator<Item = &Eigenvalue> {
        self.family(symmetric).filter(|e| e.omega_rad_s >= BETWEEN)
    }

    /// The oscillatory rigid-body modes of one symmetry, slowest first.
    fn rigid_body(&self, symmetric: bool) -> impl Iterator<Item = &Eigenvalue> {
        self.family(symmetric).filter(|e| e.omega_rad_s < BETWEEN)
    }

    /// The file lists eigenvalues in ascending order.
    fn family(&self, symmetric: bool) -> impl Iterator<Item = &Eigenvalue> {
        self.eigenvalues.iter().filter(move |e| e.symmetric == symmetric)
    }

    /// The phugoid.
    pub(crate) fn phugoid(&self) -> Option<&Eigenvalue> {
        self.rigid_body(true).next()
    }

    /// The short period.
    pub(crate) fn short_period(&self) -> Option<&Eigenvalue> {
        self.rigid_body(true).nth(1)
    }

    /// The Dutch roll.
    pub(crate) fn dutch_roll(&self) -> Option<&Eigenvalue> {
        self.rigid_body(false).next()
    }
}
