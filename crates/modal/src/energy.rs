//! Where the kinetic energy of a mode is: by component of the aircraft and by direction.
//!
//! With momentum p = M phi, the products phi_d p_d over all freedoms d sum up to phi^T M phi. The share of a
//! freedom is its product over that sum. Shares of bodies with offset mass can be slightly negative, since products
//! of inertia couple freedoms.

use albatross_nastran::deck::Id;
use serde::Serialize;

use crate::basis::ModalBasis;
use crate::error::Error;

/// A part of the aircraft, as a set of grids.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Name, such as `wing`.
    pub name: String,
    /// Its grids. A grid that stands in several components counts in the first.
    pub grids: Vec<Id>,
}

/// Direction of a motion in structural axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Direction {
    /// Streamwise.
    X,
    /// To the right.
    Y,
    /// Up.
    Z,
    /// Rotation about any axis.
    Rotation,
}

impl std::fmt::Display for Direction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
            Self::Rotation => "r",
        })
    }
}

/// A share of the kinetic energy of a mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EnergyShare {
    /// Component; `other` for grids that are in none.
    pub component: String,
    /// Direction.
    pub direction: Direction,
    /// Share of the mode's kinetic energy; all shares of a mode sum up to 1.
    pub share: f64,
}

/// Shares of each mode, largest first: one for each component and direction, and for `other` if any grid with
/// energy is in no component.
///
/// # Errors
/// [`Error::NoMassMatrix`]; [`Error::UnknownGrid`] for a grid of a component that the basis lacks.
pub fn energy_shares(basis: &ModalBasis, components: &[Component]) -> Result<Vec<Vec<EnergyShare>>, Error> {
    let mass = basis.require_mass_matrix("the kinetic-energy table")?;
    let other = components.len();
    let mut owner = vec![other; basis.grids.len()];
    for (c, component) in components.iter().enumerate().rev() {
        for &id in &component.grids {
            let index = basis.require_grid(id, || format!("component \"{}\"", component.name))?;
            if let Some(o) = owner.get_mut(index) {
                *o = c;
            }
        }
    }
    let names: Vec<&str> = components
        .iter()
        .map(|c| c.name.as_str())
        .chain(["other"])
        .collect();
    let shares = |shape: &[[f64; 6]]| {
        let momentum = mass.apply(shape);
        let mut energy = vec![[0.0; 4]; names.len()];
        for ((phi, p), &c) in shape.iter().zip(&momentum).zip(&owner) {
            let Some(energy) = energy.get_mut(c) else { continue };
            for (d, (phi, p)) in phi.iter().zip(p).enumerate() {
                energy[d.min(3)] += phi * p;
            }
        }
        let total: f64 = energy.iter().flatten().sum();
        let directions = [Direction::X, Direction::Y, Direction::Z, Direction::Rotation];
        let mut shares: Vec<EnergyShare> = Vec::new();
        for (name, energy) in names.iter().zip(&energy) {
            for (direction, e) in directions.into_iter().zip(energy) {
                shares.push(EnergyShare {
                    component: (*name).to_string(),
                    direction,
                    share: e / total,
                });
            }
        }
        if energy.last() == Some(&[0.0; 4]) {
            shares.truncate(4 * components.len());
        }
        shares.sort_by(|a, b| b.share.total_cmp(&a.share));
        shares
    };
    Ok(basis.modes.iter().map(|m| shares(&m.shape)).collect())
}

/// The shares of at least `least`, at most five, as one line: `wing_z 0.89, fus_z 0.07`.
#[must_use]
pub fn describe(shares: &[EnergyShare], least: f64) -> String {
    let shown = shares.iter().filter(|s| s.share >= least).take(5);
    shown
        .map(|s| format!("{}_{} {:.2}", s.component, s.direction, s.share))
        .collect::<Vec<_>>()
        .join(", ")
}
