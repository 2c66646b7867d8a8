//! The modal basis of a flexible aircraft: from a finite element analysis to the shapes that strips need.
//!
//! # The problem
//! Elastic deformation is a sum of modes, `u(P, t) = sum_k phi_k(P) eta_k(t)`, with generalised mass mu_k and
//! frequency omega_k. A strip method wants, for every strip, the plunge phi (T3, up) and the twist gamma (R2, nose
//! up) of each mode; the equations of flight want modes that do not move the aircraft as a whole.
//!
//! 1. **Which modes.** A file of a free aircraft begins with rigid modes: six, or three for a half model, or none
//!    when the analysis was shifted. They are told from elastic ones by frequency and by their share of rigid
//!    motion ([`Selection`], [`BasisOptions`]).
//! 2. **Which axes.** Programs print vectors in each grid's displacement system. [`ModalBasis::from_nastran`] turns
//!    them to the basic system, which is the structural system here: x aft, y right, z up.
//! 3. **Mean axes.** With the rigid motions R and the mass matrix M of the deck ([`DeckMass`]), the condition is
//!
//!    ```text
//!    Phi^T M R = 0,    checked as  |phi_k^T M R_i| / sqrt(mu_k M_ii) < 1e-6
//!    ```
//!
//!    (Waszak and Schmidt, J. Aircraft 25, 1988). Modes beyond the tolerance are refused, or their rigid part is
//!    removed, `phi - R (R^T M R)^-1 R^T M phi` ([`OnViolation`], [`MeanAxes`]).
//! 4. **To the strips.** Modes are interpolated along load reference axes, lines of grids, and carried to the
//!    aerodynamic centres by a rigid arm ([`interpolate()`]).
//!
//! Around it: mass, centre of gravity and inertia from the deck ([`MassProperties`]), symmetric and antisymmetric
//! families ([`Symmetry`]), kinetic energy by component ([`energy_shares`]), comparison of two analyses ([`mac()`]).
//!
//! # Example
//! The first wing bending of the F25-like surrogate at its right wing tip and at two strips:
//! ```
//! use albatross_modal::{BasisOptions, LoadReferenceAxis, ModalBasis, Selection, Station, Symmetry, interpolate};
//! use albatross_nastran::{bdf, f06};
//! use albatross_numerics::interp::Method;
//!
//! # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like");
//! let (deck, _) = bdf::read_strict(format!("{folder}/f25.bdf"))?;
//! let results = f06::read(format!("{folder}/f25.f06"))?;
//!
//! let options = BasisOptions { modes: Selection::FirstElastic(20), ..BasisOptions::default() };
//! let basis = ModalBasis::from_nastran(&deck, &results, &options)?;
//! let bending = &basis.modes[0];
//! assert_eq!((bending.number, bending.symmetry), (7, Symmetry::Symmetric));
//!
//! let wing = LoadReferenceAxis { name: "right wing".into(), grids: (1000..=1025).collect() };
//! let strips = [Station { x: 18.7, y: 6.0, z: -0.8 }, Station { x: 26.6, y: 22.4, z: 0.64 }];
//! let shapes = interpolate(&basis, &wing, &strips, Method::Cubic)?;
//! let [root, tip] = [shapes.phi_z()[(0, 0)], shapes.phi_z()[(1, 0)]];
//! assert!(tip.abs() > 5.0 * root.abs());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Limits
//! - The mass matrix holds CONM1, CONM2, and the mass of bars, beams and rods. Any other mass in the deck is named,
//!   and the mean-axes check is refused ([`MeanAxes::Refused`]) rather than made with a wrong matrix. The basis
//!   itself is then still given, with the mass properties of the grid point weight generator.
//! - Lengths are metres, masses kilograms after PARAM,WTMASS. A deck in millimetres is not noticed.
//! - Seven printed digits limit what the check can see: free modes of the surrogate come out below 1e-7.
//! - Frequencies and generalised masses are the file's. They are changed only where a rigid part is removed, at
//!   constant strain energy.
//! - This crate reads no files and prints nothing. What it assumed stands in [`ModalBasis::notes`].

mod basis;
mod energy;
mod error;
mod import;
mod interpolate;
mod mac;
mod mass_matrix;
mod mean_axes;
mod options;
mod select;
mod symmetry;
mod text;
mod weight_check;

pub use albatross_fem::{
    BarMass, DeckMass, GridMass, MassModel, MassProperties, MassSource, RIGID_DIRECTIONS, rigid_shape,
};
pub use basis::{BasisGrid, BasisMass, BasisMode, ModalBasis, ModeInput};
pub use energy::{Component, Direction, EnergyShare, describe, energy_shares};
pub use error::Error;
pub use interpolate::{LARGEST_EXTRAPOLATION, LoadReferenceAxis, Station, StationShapes, interpolate};
pub use mac::{ModePair, mac, pair_modes};
pub use mass_matrix::MassMatrix;
pub use mean_axes::{MeanAxes, MeanAxesCheck, OnViolation};
pub use options::{BasisOptions, Normalisation, Selection};
pub use symmetry::{MirrorPairs, Symmetry, symmetry_measure};
