//! The flow at a flight condition, and its exact derivatives.

use crate::condition::Condition;
use crate::error::Result;
use crate::influence::{Factorised, Influence};
use crate::kernel::CoreRadii;
use crate::lattice::{Lattice, V3};
use crate::method::Method;
use crate::trefftz::Plane;
use crate::units::{ONSETS, Unit, onset};

/// A lattice solved for all unit onsets and controls at a Mach number: any flight condition costs little more.
#[derive(Debug)]
pub struct Solver<'l> {
    factorised: Factorised<'l>,
    units: Vec<Vec<Unit>>,
    plane: Plane,
}

/// Circulation and induced velocity at the bound vortices, and their derivatives.
#[derive(Clone, Debug)]
pub struct Flow {
    /// Flight condition.
    pub condition: Condition,
    /// Circulation of each vortex over V, a length.
    pub circulation: Vec<f64>,
    /// Velocity over V that all vortices induce at each force point.
    pub induced: Vec<V3>,
    /// Derivatives by the six onsets (wind x, y, z; rotation x, y, z in geometry axes), controls, design variables.
    pub(crate) changes: Vec<Change>,
}

/// Derivative of circulation and induced velocity by one variable.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    pub(crate) circulation: Vec<f64>,
    pub(crate) induced: Vec<V3>,
}

impl<'l> Solver<'l> {
    /// Assembles, factorises and finds the unit solutions.
    ///
    /// # Errors
    /// As [`Influence::assemble`] and [`Influence::factorise`].
    pub fn new(lattice: &'l Lattice, method: &Method, mach: f64) -> Result<Self> {
        Ok(Self::from_factorised(
            Influence::assemble(lattice, method, mach)?.factorise()?,
        ))
    }

    /// Finds the unit solutions of factorised systems.
    pub fn from_factorised(factorised: Factorised<'l>) -> Self {
        let units = factorised.unit_solutions();
        let plane = trefftz_plane(&factorised);
        Self {
            factorised,
            units,
            plane,
        }
    }

    pub(crate) fn plane(&self) -> &Plane {
        &self.plane
    }

    /// The lattice.
    pub fn lattice(&self) -> &'l Lattice {
        self.factorised.lattice
    }

    /// The method.
    pub fn method(&self) -> &Method {
        &self.factorised.method
    }

    /// The Mach number.
    pub fn mach(&self) -> f64 {
        self.factorised.mach
    }

    pub(crate) fn factorised(&self) -> &Factorised<'l> {
        &self.factorised
    }

    /// The flow at a flight condition.
    ///
    /// # Errors
    /// [`Error::Length`](crate::Error::Length) or [`Error::Value`](crate::Error::Value) for a condition that does
    /// not fit the lattice.
    pub fn flow(&self, condition: &Condition) -> Result<Flow> {
        let lattice = self.lattice();
        condition.check(lattice)?;
        let n = lattice.vortices.len();
        let wind = condition.onset(lattice);
        let settings: Vec<f64> = condition.settings().collect();
        let zero = Change {
            circulation: vec![0.0; n],
            induced: vec![V3::zeros(); n],
        };
        let mut changes = vec![zero.clone(); ONSETS + settings.len()];
        let mut total = zero;
        for (u, units) in self.units.iter().enumerate() {
            let (plain, by_setting) = units.split_at(1.min(units.len()));
            for unit in plain {
                changes[u].add(1.0, unit);
            }
            for (k, (unit, setting)) in by_setting.iter().zip(&settings).enumerate() {
                changes[u].add(*setting, unit);
                changes[ONSETS + k].add(wind[u], unit);
            }
            let change = &changes[u];
            total
                .circulation
                .iter_mut()
                .zip(&change.circulation)
                .for_each(|(t, c)| *t += wind[u] * c);
            total
                .induced
                .iter_mut()
                .zip(&change.induced)
                .for_each(|(t, c)| *t += c * wind[u]);
        }
        Ok(Flow {
            condition: condition.clone(),
            circulation: total.circulation,
            induced: total.induced,
            changes,
        })
    }
}

impl Change {
    fn add(&mut self, factor: f64, unit: &Unit) {
        if factor != 0.0 {
            self.circulation
                .iter_mut()
                .zip(&unit.circulation)
                .for_each(|(t, c)| *t += factor * c);
            self.induced
                .iter_mut()
                .zip(&unit.velocity)
                .for_each(|(t, c)| *t += c * factor);
        }
    }
}

/// Onset velocity at a point, and its derivatives by the six onsets.
pub(crate) fn onset_velocity(lattice: &Lattice, wind: &[f64; 6], point: &V3) -> (V3, [V3; 6]) {
    let units: [V3; 6] = std::array::from_fn(|u| onset(lattice, u, point));
    (units.iter().zip(wind).map(|(v, w)| v * *w).sum(), units)
}

/// The Trefftz plane with the cores of the trailing legs.
fn trefftz_plane(factorised: &Factorised<'_>) -> Plane {
    let lattice = factorised.lattice;
    let core = factorised.method.core;
    let component = |strip: usize| lattice.surfaces[lattice.strips[strip].surface].component;
    Plane::new(lattice, |at, emitting| {
        let strip = &lattice.strips[emitting];
        let radius = if component(at) == component(emitting) {
            CoreRadii::WITHIN * strip.width
        } else {
            (core.chord_fraction * strip.chord).max(core.width_fraction * strip.width)
        };
        radius * radius
    })
}
