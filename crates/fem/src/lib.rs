//! Finite elements of a Nastran deck: normal modes without a Nastran licence.
//!
//! # The problem
//! A deck describes a structure as beams, rods, springs, rigid elements and masses between grids. Its free vibration is
//!
//! ```text
//! K phi = lambda M phi,    lambda = omega^2,    phi^T M phi = mu
//! ```
//!
//! on the freedoms that constraints leave free. This crate goes from [`Deck`](albatross_nastran::Deck) to the results
//! that a solver would print, in the structs of the results reader, so that later stages take either.
//!
//! 1. **Elements.** [`FemModel::assemble`] makes stiffness by the flexibility of each element (any taper, offsets,
//!    shear, neutral axis beside the shear centre), so that rigid motion costs no energy; and mass, lumped or coupled
//!    ([`BarMass`], [`DeckMass`]).
//! 2. **Constraints.** RBE2, RBE3, RBAR and MPC make freedoms dependent, `u_g = T u_f`; SPC and PS hold them;
//!    components without stiffness are held as by AUTOSPC. Then `K_ff = T^T K T`, `M_ff = T^T M T`, sparse.
//! 3. **Modes.** [`FemModel::modes`]: block Lanczos on `(K - sigma M)^-1 M` with sigma below the spectrum, by a sparse
//!    factor in approximate minimum degree order of the grids. Rigid modes of a free structure come out at zero without
//!    SUPORT; M may be singular. [`FemModel::count_below`] checks that none is missed.
//! 4. **Beside that.** [`FemModel::static_solution`], [`FemModel::guyan`], [`FemModel::craig_bampton`],
//!    [`FemModel::effective_masses`], mass properties ([`FemModel::properties`], [`FemModel::weight`]), and a
//!    [`listing`] in the layout of a results file.
//!
//! | card | in the model |
//! |---|---|
//! | CBAR with PBAR, PBARL | I12, K1 and K2 (rigid when blank), pins, offsets with every OFFT |
//! | CBEAM with PBEAM, PBEAML | stations with linear constants, K1 and K2 (1 when blank), N1 to N2, M1 to M2, NSI; CW left out with a remark, S1 and S2 refused |
//! | CROD, CONROD, CELAS1, CELAS2, CBUSH | stiffness; CBUSH at its location or offset, in CID or by orientation |
//! | CONM1, CONM2, CMASS1 to CMASS4 | mass |
//! | RBE2, RBE3 (with UM), RBAR, MPC | eliminated; chains in any order |
//! | SPC, SPC1, SPCADD, PS, MPCADD | as case control selects |
//! | PARAM COUPMASS, WTMASS, AUTOSPC, GRDPNT; METHOD with EIGRL, EIGR | honoured |
//!
//! Shapes are in each grid's displacement system (CD); everything is SI once PARAM,WTMASS is applied.
//!
//! # Example
//! Modes of the F25-like surrogate, and what a flight model needs of them:
//! ```
//! use albatross_fem::{FemModel, ModelOptions, ModesOptions, listing};
//! use albatross_nastran::{bdf, f06};
//!
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/f25.bdf");
//! let (deck, _) = bdf::read_strict(file)?;
//! let model = FemModel::assemble(&deck, &ModelOptions::default())?;
//! assert!((model.properties().ok_or("no mass")?.mass - 81018.49).abs() < 0.01);
//!
//! let modes = model.modes(&ModesOptions::of_deck(&deck, None))?;
//! assert!(modes.frequencies_hz[5] < 1e-3); // six rigid modes
//! assert!((modes.frequencies_hz[6] - 2.430880).abs() < 2e-6);
//! let tip = modes.at(6, 1025).ok_or("no grid 1025")?;
//! assert!(tip[2].abs() > 0.01);
//!
//! let results = modes.results(&model, "f25 (own solution)");
//! let text = listing(&results, "F25 surrogate");
//! assert_eq!(f06::parse(text.as_bytes(), "own.f06")?.eigenvectors.len(), 30);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Mistakes
//! Elements that are not modelled are named with their count and stop the run, unless
//! [`ModelOptions::leave_out_unknown`] is set ([`Error::UnknownElements`]). A motion that nothing resists stops a static
//! solution and names a freedom that it moves ([`Error::Mechanism`]); in modes it is a mode at 0 Hz, or, when it has no
//! mass either, it is held and remarked. What was assumed stands in [`FemModel::remarks`] and [`Modes::remarks`].
//!
//! # Limits
//! - Linear and undamped; no prestress, thermal loads, plates or solids.
//! - A range of frequency is found from below: modes below V1 are computed too, and left out.
//! - Eigenvalues carry rounding of about 1e-16 times the highest eigenvalue of the model: with very short stiff elements
//!   the lowest modes lose digits, as in any displacement method. [`Modes::residuals`] shows it.
//! - Shear centres of open PBEAML sections are not known and refused; torsion of open thin walls is b t^3/3.
//! - ASET and OMIT are applied on request only ([`analysis_set`]).
//!
//! # References
//! - MSC Nastran Quick Reference Guide and Linear Static Analysis User's Guide: cards and conventions.
//! - Przemieniecki, Theory of Matrix Structural Analysis, 1968.
//! - Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15, 1994: shifted block Lanczos.

mod context;
mod dofs;
mod effective_mass;
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
mod pencil;
mod reduction;
mod rigid;
mod sparse;
mod statics;
mod stiffness;
mod supports;
pub mod text;
mod unknown;

pub use dofs::{Freedoms, Point};
pub use effective_mass::EffectiveMass;
pub use error::Error;
pub use listing::listing;
pub use mass::{BarMass, DeckMass};
pub use mass_model::{GridMass, MassModel};
pub use mass_properties::{MassProperties, MassSource};
pub use model::{Fate, FemModel, ModelOptions};
pub use modes::{ModeScale, Modes, ModesOptions};
pub use reduction::{ReducedModel, all_components, analysis_set};
pub use rigid::{RIGID_DIRECTIONS, rigid_shape};
pub use sparse::Symmetric;
pub use statics::{NodalLoad, StaticSolution};
pub use supports::free_directions;
