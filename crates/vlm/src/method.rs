//! What differs between versions of AVL.

use serde::{Deserialize, Serialize};

use crate::kernel::CoreRadii;
use crate::lattice::Lattice;

/// Choices of the method on which versions of AVL differ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Method {
    /// Vortex cores between components.
    pub core: CoreRadii,
    /// Forces on the trailing legs that lie on the surface count (freestream and rotation only).
    pub leg_forces: bool,
    /// Derivatives with respect to controls and design variables leave out the change of the induced velocity in
    /// the force.
    pub frozen_velocity: bool,
    /// Velocities by bodies enter the force on vortices, not the boundary condition alone.
    pub body_velocity_in_forces: bool,
    /// Strip lift is normal to the velocity with sideslip, not to its projection on the plane of symmetry.
    pub lift_axis_with_sideslip: bool,
    /// Stability derivatives as AVL prints them where they are not the exact ones: `CYb` lacks the side force of the
    /// header's profile drag, and the derivatives by alpha at non-zero roll or yaw rate turn the rotation the wrong
    /// way. All else is exact either way.
    pub printed_derivatives: bool,
    /// Threads, from 1 to [`Method::MOST_THREADS`]; other numbers count as the nearest of these. 1 runs on the caller's
    /// alone. Results do not depend on it.
    pub threads: usize,
}

impl Method {
    /// Most threads that are started.
    pub const MOST_THREADS: usize = 64;

    /// As AVL 3.52.
    pub const AVL_352: Self = Self {
        core: CoreRadii::AVL_352,
        leg_forces: false,
        frozen_velocity: false,
        body_velocity_in_forces: false,
        lift_axis_with_sideslip: true,
        printed_derivatives: true,
        threads: 1,
    };

    /// As AVL 3.32, and up to 3.40.
    pub const AVL_332: Self = Self {
        core: CoreRadii::AVL_332,
        leg_forces: true,
        frozen_velocity: true,
        body_velocity_in_forces: true,
        lift_axis_with_sideslip: false,
        printed_derivatives: true,
        threads: 1,
    };

    /// With a number of threads that can be started.
    pub(crate) fn bounded(&self) -> Self {
        Self {
            threads: self.threads.clamp(1, Self::MOST_THREADS),
            ..*self
        }
    }

    /// Takes the core radii that the geometry sets (`CORE`, AVL 3.5x), if any.
    #[must_use]
    pub fn with_core_of(mut self, lattice: &Lattice) -> Self {
        if let Some(core) = lattice.core {
            self.core.chord_fraction = core.chord_fraction;
            self.core.width_fraction = core.width_fraction;
        }
        self
    }
}

impl Default for Method {
    fn default() -> Self {
        Self::AVL_352
    }
}
