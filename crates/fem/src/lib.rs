//! Finite elements of a Nastran deck: stiffness and mass, constraints, normal modes.

mod context;
mod error;
mod line;
mod mass;
mod mass_model;
mod mass_properties;
mod rigid;
mod supports;
pub mod text;

pub use error::Error;
pub use mass::{BarMass, DeckMass};
pub use mass_model::{GridMass, MassModel};
pub use mass_properties::{MassProperties, MassSource};
pub use rigid::{RIGID_DIRECTIONS, rigid_shape};
pub use supports::free_directions;
