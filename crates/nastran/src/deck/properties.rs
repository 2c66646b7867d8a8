//! Properties and materials: PBAR(L), PBEAM(L), PROD, PELAS, PBUSH, MAT1.

use serde::{Deserialize, Serialize};

use super::{Id, Section};

/// A bar property with its constants on the card (PBAR).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pbar {
    /// Property number.
    pub id: Id,
    /// Material.
    pub mid: Id,
    /// Area, m^2.
    pub area: f64,
    /// Second moment for bending in plane 1 (local x-y), m^4.
    pub i1: f64,
    /// Second moment for bending in plane 2 (local x-z), m^4.
    pub i2: f64,
    /// Product `int(y z dA)`, m^4.
    pub i12: f64,
    /// Torsion constant, m^4.
    pub torsion_constant: f64,
    /// Non-structural mass per length, kg/m.
    pub nsm: f64,
    /// Stress recovery points C, D, E, F as (y, z) pairs, m.
    pub stress_points: [[f64; 2]; 4],
    /// Shear area factor K1; `None` is rigid in shear.
    pub k1: Option<f64>,
    /// Shear area factor K2; `None` is rigid in shear.
    pub k2: Option<f64>,
}

/// A bar property given by the dimensions of a standard section (PBARL).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pbarl {
    /// Property number.
    pub id: Id,
    /// Material.
    pub mid: Id,
    /// Section library, `MSCBML0` when blank.
    pub group: String,
    /// The section.
    pub section: Section,
    /// Non-structural mass per length, kg/m.
    pub nsm: f64,
}

/// A property that a CBAR can name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BarProperty {
    /// Constants on the card.
    Pbar(Pbar),
    /// Standard section.
    Pbarl(Pbarl),
}

impl BarProperty {
    /// Property number.
    #[must_use]
    pub fn id(&self) -> Id {
        match self {
            Self::Pbar(p) => p.id,
            Self::Pbarl(p) => p.id,
        }
    }

    /// Material number.
    #[must_use]
    pub fn mid(&self) -> Id {
        match self {
            Self::Pbar(p) => p.mid,
            Self::Pbarl(p) => p.mid,
        }
    }

    /// Area, m^2; `None` for a section shape whose formula is not known here, see [`Section::area`].
    #[must_use]
    pub fn area(&self) -> Option<f64> {
        match self {
            Self::Pbar(p) => Some(p.area),
            Self::Pbarl(p) => p.section.area(),
        }
    }

    /// Non-structural mass per length, kg/m.
    #[must_use]
    pub fn nsm(&self) -> f64 {
        match self {
            Self::Pbar(p) => p.nsm,
            Self::Pbarl(p) => p.nsm,
        }
    }
}

/// Section constants of a PBEAM at one station. A blank field is `None`: at an intermediate station it means
/// "interpolate", at end B "as at end A".
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BeamStation {
    /// Stress output request at the station (SO): `YES`, `YESA` or `NO`; empty at end A.
    pub stress_output: String,
    /// Location as a fraction of the length, 0 at A and 1 at B.
    pub x: f64,
    /// Area, m^2.
    pub area: Option<f64>,
    /// Second moment for bending in plane 1, m^4.
    pub i1: Option<f64>,
    /// Second moment for bending in plane 2, m^4.
    pub i2: Option<f64>,
    /// Product of inertia, m^4.
    pub i12: Option<f64>,
    /// Torsion constant, m^4.
    pub torsion_constant: Option<f64>,
    /// Non-structural mass per length, kg/m.
    pub nsm: Option<f64>,
    /// Stress points C, D, E, F as (y, z); absent when the card has no such line.
    pub stress_points: Option<[Option<f64>; 8]>,
}

/// Shear, warping and offset constants at the end of a PBEAM card, each `None` when blank.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BeamEndData {
    /// Shear factors K1, K2 (1.0 when blank).
    pub shear_factors: [Option<f64>; 2],
    /// Shear relief S1, S2.
    pub shear_relief: [Option<f64>; 2],
    /// Non-structural mass moment of inertia per length about the nsm centre at A and B, kg m.
    pub nsi: [Option<f64>; 2],
    /// Warping coefficient at A and B, m^6.
    pub warping: [Option<f64>; 2],
    /// Non-structural mass centre (y, z) at A, then at B, m.
    pub nsm_center: [Option<f64>; 4],
    /// Neutral axis (y, z) at A, then at B, m.
    pub neutral_axis: [Option<f64>; 4],
}

/// A beam property with its constants on the card (PBEAM).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pbeam {
    /// Property number.
    pub id: Id,
    /// Material.
    pub mid: Id,
    /// Stations as on the card; the first is end A (x = 0).
    pub stations: Vec<BeamStation>,
    /// Shear, warping and offsets.
    pub ends: BeamEndData,
}

/// Dimensions of a PBEAML at one station.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BeamSectionStation {
    /// Stress output request (SO); empty at end A.
    pub stress_output: String,
    /// Location as a fraction of the length.
    pub x: f64,
    /// The section; blank dimensions take the value of end A.
    pub section: Section,
    /// Non-structural mass per length, kg/m.
    pub nsm: f64,
}

/// A beam property given by standard sections (PBEAML).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pbeaml {
    /// Property number.
    pub id: Id,
    /// Material.
    pub mid: Id,
    /// Section library, `MSCBML0` when blank.
    pub group: String,
    /// Stations; the first is end A.
    pub stations: Vec<BeamSectionStation>,
}

/// A property that a CBEAM can name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BeamProperty {
    /// Constants on the card.
    Pbeam(Box<Pbeam>),
    /// Standard sections.
    Pbeaml(Pbeaml),
}

impl BeamProperty {
    /// Property number.
    #[must_use]
    pub fn id(&self) -> Id {
        match self {
            Self::Pbeam(p) => p.id,
            Self::Pbeaml(p) => p.id,
        }
    }

    /// Material number.
    #[must_use]
    pub fn mid(&self) -> Id {
        match self {
            Self::Pbeam(p) => p.mid,
            Self::Pbeaml(p) => p.mid,
        }
    }

    /// (x, area in m^2, non-structural mass in kg/m) along the beam in ascending x from 0 to 1, blanks resolved:
    /// linear between stations, end B as end A when absent. `None` when an area is not known, see
    /// [`Section::area`].
    #[must_use]
    pub fn mass_stations(&self) -> Option<Vec<(f64, f64, f64)>> {
        match self {
            Self::Pbeam(p) => p.mass_stations(),
            Self::Pbeaml(p) => p.mass_stations(),
        }
    }
}

impl Pbeam {
    fn mass_stations(&self) -> Option<Vec<(f64, f64, f64)>> {
        let a = self.stations.first()?;
        let at_a = (a.area?, a.nsm.unwrap_or(0.0));
        let at_b = self
            .stations
            .iter()
            .skip(1)
            .find(|s| s.x == 1.0)
            .map_or(at_a, |b| (b.area.unwrap_or(at_a.0), b.nsm.unwrap_or(at_a.1)));
        // A blank at an intermediate station means linear interpolation between the two ends.
        let between = |x: f64, a: f64, b: f64| a + x * (b - a);
        let mut stations = vec![(0.0, at_a.0, at_a.1), (1.0, at_b.0, at_b.1)];
        for s in self.stations.iter().skip(1).filter(|s| s.x > 0.0 && s.x < 1.0) {
            let area = s.area.unwrap_or_else(|| between(s.x, at_a.0, at_b.0));
            let nsm = s.nsm.unwrap_or_else(|| between(s.x, at_a.1, at_b.1));
            stations.push((s.x, area, nsm));
        }
        stations.sort_by(|p, q| p.0.total_cmp(&q.0));
        Some(stations)
    }
}

impl Pbeaml {
    fn mass_stations(&self) -> Option<Vec<(f64, f64, f64)>> {
        let mut stations = Vec::with_capacity(self.stations.len() + 1);
        for s in &self.stations {
            stations.push((s.x, s.section.area()?, s.nsm));
        }
        stations.sort_by(|p, q| p.0.total_cmp(&q.0));
        let &(_, area_a, nsm_a) = stations.first()?;
        if stations.last().is_some_and(|s| s.0 < 1.0) {
            stations.push((1.0, area_a, nsm_a));
        }
        Some(stations)
    }
}

/// A rod property (PROD).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Prod {
    /// Property number.
    pub id: Id,
    /// Material.
    pub mid: Id,
    /// Area, m^2.
    pub area: f64,
    /// Torsion constant, m^4.
    pub torsion_constant: f64,
    /// Stress coefficient, m.
    pub stress_coefficient: f64,
    /// Non-structural mass per length, kg/m.
    pub nsm: f64,
}

/// A scalar spring property (PELAS).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pelas {
    /// Property number.
    pub id: Id,
    /// Stiffness, N/m or N m/rad.
    pub k: f64,
    /// Structural damping coefficient.
    pub ge: f64,
    /// Stress coefficient.
    pub s: f64,
}

/// One line of a [`Pbush`]: six values under a keyword.
pub type BushLine = [Option<f64>; 6];

/// A bush property (PBUSH).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pbush {
    /// Property number.
    pub id: Id,
    /// K: stiffness per component, N/m and N m/rad.
    pub k: Option<BushLine>,
    /// B: viscous damping per component.
    pub b: Option<BushLine>,
    /// GE: structural damping per component.
    pub ge: Option<BushLine>,
    /// M: mass per component (newer dialects), kg and kg m^2.
    pub m: Option<BushLine>,
    /// RCV: stress and strain recovery coefficients.
    pub rcv: Option<BushLine>,
}

/// An isotropic material (MAT1).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Mat1 {
    /// Material number.
    pub id: Id,
    /// Young's modulus, Pa.
    pub e: Option<f64>,
    /// Shear modulus, Pa.
    pub g: Option<f64>,
    /// Poisson's ratio.
    pub nu: Option<f64>,
    /// Density, kg/m^3; 0 when blank.
    pub rho: f64,
    /// Thermal expansion, 1/K.
    pub expansion: Option<f64>,
    /// Reference temperature.
    pub reference_temperature: Option<f64>,
    /// Structural damping coefficient.
    pub ge: Option<f64>,
    /// Stress limits in tension, compression and shear.
    pub stress_limits: [Option<f64>; 3],
    /// Material coordinate system.
    pub mcsid: Option<Id>,
}
