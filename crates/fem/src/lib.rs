//! Finite elements of a Nastran deck: stiffness and mass, constraints, normal modes.

mod context;
mod dofs;
mod error;
mod factor;
mod lanczos;
mod line;
mod listing;
mod mass;
mod mass_model;
mod mass_properties;
mod model;
mod modes;
mod multipoint;
mod rigid;
mod sparse;
mod stiffness;
mod supports;
pub mod text;
mod unknown;

pub use dofs::{Freedoms, Point};
pub use error::Error;
pub use listing::listing;
pub use mass::{BarMass, DeckMass};
pub use mass_model::{GridMass, MassModel};
pub use mass_properties::{MassProperties, MassSource};
pub use model::{Fate, FemModel, ModelOptions};
pub use modes::{ModeScale, Modes, ModesOptions};
pub use rigid::{RIGID_DIRECTIONS, rigid_shape};
pub use sparse::Symmetric;
pub use supports::free_directions;
