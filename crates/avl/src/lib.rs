//! Reader and writer of the files of AVL, the vortex lattice program of Drela and Youngren.
//!
//! # The problem
//! AVL's files are Fortran text. Its inputs are read so liberally that files in the wild use every liberty:
//! tabs, commas, `2.0d0`, keywords in any case and order, comments that are none. Its outputs are fixed columns
//! that run together (`46.0673590.2322`), overflow to stars and differ between versions. This crate turns both
//! into plain structs, and says by file, line and field what it could not read. It computes nothing: no unit is
//! changed, no `SCALE` applied, no axis turned.
//!
//! # Inputs
//! | file | reader | writer |
//! |---|---|---|
//! | `.avl` | [`Geometry::parse`](geometry::Geometry::parse) | [`Geometry::to_text`](geometry::Geometry::to_text) |
//! | `.mass` | [`MassFile::parse`](mass::MassFile::parse) | [`MassFile::to_text`](mass::MassFile::to_text) |
//! | `.run` | [`RunFile::parse`](run::RunFile::parse) | [`RunFile::to_text`](run::RunFile::to_text) |
//!
//! These readers return the data and a list of [`Diagnostic`]s: what AVL ignores, replaces or refuses for its
//! form alone, and what its versions treat differently.
//!
//! # Outputs
//! | written by | file | struct |
//! |---|---|---|
//! | OPER > FT | `.ft` | [`RunState`](results::RunState) (alias [`TotalForces`](results::TotalForces)) |
//! | OPER > ST | `.st` | [`StabilityDerivatives`](results::StabilityDerivatives) |
//! | OPER > SB | `.sb` | [`BodyDerivatives`](results::BodyDerivatives) |
//! | OPER > FN | `.fn` | [`SurfaceForces`](results::SurfaceForces) |
//! | OPER > FB | `.fb` | [`BodyForces`](results::BodyForces) |
//! | OPER > FS | `.fs` | [`StripForces`](results::StripForces) |
//! | OPER > FSB | `.fsb` | [`BodyAxesStripForces`](results::BodyAxesStripForces) |
//! | OPER > FE | `.fe` | [`ElementForces`](results::ElementForces) |
//! | OPER > HM | `.hm` | [`HingeMoments`](results::HingeMoments) |
//! | OPER > VM | `.vm` | [`ShearMoments`](results::ShearMoments) |
//! | OPER > CN | `.cnc` | [`StripLoads`](results::StripLoads) |
//! | MODE > W | `.eig` | [`Eigenvalues`](results::Eigenvalues) |
//! | MODE > S | `.sys` | [`SystemMatrix`](results::SystemMatrix) |
//!
//! Every reader takes the text of AVL up to 3.35, of 3.40 and of 3.52, and the machine-readable form (OPER >
//! MRF, 3.40 on) where there is one; [`results::parse_any`] finds the kind by the content. `.ft`, `.st` and
//! `.fs` are also written, column for column as AVL 3.52 does.
//!
//! # Axes and units
//! Lengths are in the unit of the geometry file. Positions are in geometry axes: x aft, y right, z up.
//! Coefficients and rates are as printed, in the [`AxisOrientation`](results::AxisOrientation) that the file
//! announces: x forward, z down by default. Derivatives are per rad for alpha and beta, per unit of `p b/2V`,
//! `q c/2V`, `r b/2V` for the rates, and per unit of the control variable, which is one degree where the
//! control's gain is 1. Lift `CL` and roll `Cl` differ by case only; here they have names.
//!
//! # Limits
//! - Text layouts hold few digits (four decimals for strips, six for derivatives, three for the Mach number):
//!   prefer MRF for small reference areas or small angles.
//! - A number that overflowed its columns is an error, counters included: the value is lost.
//! - One solution per file: what AVL appended to an existing file is refused.
//!
//! # Example
//! ```
//! use albatross_avl::results::{Coefficient, StabilityDerivatives, Variable};
//!
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/f25-like/avl_out/trim.st");
//! let text = albatross_avl::read_text(path)?;
//! let st = StabilityDerivatives::parse(&text, "trim.st")?;
//!
//! // Static margin: -dCm/dCL, which is also (Xnp - Xref) / Cref.
//! let cl_alpha = st.get(Coefficient::Lift, Variable::Alpha).unwrap_or(f64::NAN);
//! let cm_alpha = st.get(Coefficient::Pitch, Variable::Alpha).unwrap_or(f64::NAN);
//! assert!((-cm_alpha / cl_alpha - 0.4576).abs() < 1e-4);
//!
//! // Per degree of elevator.
//! let elevator = st.control("elevator").map(|column| column.pitch);
//! assert_eq!(elevator, Some(-0.076567));
//! # Ok::<(), albatross_avl::AvlError>(())
//! ```
//!
//! # Source
//! M. Drela and H. Youngren, *AVL User Primer* (`avl_doc.txt`), and the output of AVL 3.32, 3.35, 3.40 and 3.52.

// What is read comes from outside: nothing of it is indexed or cut by position.
#![warn(clippy::indexing_slicing, clippy::string_slice)]

mod error;
mod fortran;
mod source;

pub mod geometry;
pub mod mass;
pub mod results;
pub mod run;

pub use error::{AvlError, Diagnostic, Location};
pub use source::read_text;
