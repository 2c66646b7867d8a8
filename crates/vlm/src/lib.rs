//! Vortex lattice of an AVL geometry, which lands on AVL's digits.
//!
//! # The problem
//! Thin lifting surfaces in a subsonic potential flow carry horseshoe vortices: a bound leg along the first quarter
//! of each element and two legs that trail along +x. Their circulations follow from no flow through the control
//! points,
//!
//! ```text
//! sum_j (n_i . V_ij) gamma_j = -n_i . (V_wind + r_i x omega + V_bodies),
//! ```
//!
//! and the forces from Kutta and Joukowski, `F = rho gamma V x l` (Katz and Plotkin, Low-Speed Aerodynamics, 2nd ed.,
//! ch. 12; Drela, Flight Vehicle Aerodynamics, ch. 6). Controls and design variables turn the normals to first order;
//! the Mach number enters by Prandtl and Glauert's rule. Everything is bilinear in the onset flow and in one plus the
//! controls, so a few unit solutions give the flow at any flight condition, and its derivatives exactly.
//!
//! # Inputs and outputs
//! A [`Geometry`](albatross_avl::geometry::Geometry) and the text of the files it names become a [`Lattice`]. A
//! [`Solver`] factorises the influence matrix once for a Mach number and a [`Method`]: two systems of half the order
//! where the lattice is symmetric left to right. [`Solver::solve`] takes a [`Condition`], [`Solver::trim`] a [`Trim`],
//! and the [`Solution`] fills the structs of AVL's output files:
//!
//! | AVL | method of [`Solution`] |
//! |---|---|
//! | `.ft` | [`run_state`](Solution::run_state) |
//! | `.st` | [`stability_derivatives`](Solution::stability_derivatives) |
//! | `.sb` | [`body_derivatives`](Solution::body_derivatives) |
//! | `.fn`, `.fb` | [`surface_forces`](Solution::surface_forces), [`body_forces`](Solution::body_forces) |
//! | `.fs`, `.fe` | [`strip_forces`](Solution::strip_forces), [`element_forces`](Solution::element_forces) |
//! | `.vm`, `.cnc` | [`shear_moments`](Solution::shear_moments), [`strip_loads`](Solution::strip_loads) |
//! | `.hm` | [`hinge_moments`](Solution::hinge_moments) |
//!
//! [`Solver::strip_slopes`] gives the lift slopes between strips, for corrections of strip theory.
//!
//! Axes are AVL's: positions and vectors x aft, y right, z up; rates and printed coefficients in body axes (x
//! forward, z down). Lengths are in the unit of the geometry file. Angles are in rad, controls in degrees per unit
//! gain, derivatives as AVL prints them.
//!
//! # Limits
//! - Attached flow, small angles of the sheet to the wind, wakes along x; below Mach 1, and in earnest below the
//!   Mach number at which the first local flow turns sonic.
//! - Thickness acts by bodies only; a body's flow is not changed by the surfaces.
//! - Versions of AVL differ in vortex cores between components, in forces on trailing legs and more: [`Method`].
//!   Where surfaces of one component alone matter, the versions agree.
//!
//! # Example
//! ```
//! use albatross_avl::geometry::Geometry;
//! use albatross_vlm::{Condition, Lattice, Method, Solver};
//!
//! let text = "wing\n0.0\n0 0 0\n10.0 1.0 10.0\n0 0 0\nSURFACE\nwing\n6 1.0 20 -2.0\nYDUPLICATE\n0.0\n\
//!             SECTION\n0 0 0 1.0 0\nSECTION\n0 5 0 1.0 0\n";
//! let (geometry, _) = Geometry::parse(text, "wing.avl")?;
//! let (lattice, _) = Lattice::new(&geometry, &|_| None)?;
//! let solver = Solver::new(&lattice, &Method::default(), 0.0)?;
//! let solution = solver.solve(&Condition::at_alpha_deg(2.0, &lattice))?;
//! let derivatives = solution.stability_derivatives("cruise");
//!
//! // Rectangular wing of aspect ratio 10: a lift slope of about 4.85 (lifting-line theory 4.94).
//! assert!((derivatives.alpha.lift - 4.85).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod airfoil;
mod body;
mod coefficients;
mod condition;
mod error;
mod flow;
mod forces;
mod influence;
mod kernel;
mod lattice;
mod method;
mod output;
mod polar;
mod slopes;
mod spacing;
mod symmetry;
mod trefftz;
mod trim;
mod units;

pub use body::LatticeBody;
pub use condition::Condition;
pub use error::{Error, Result};
pub use flow::{Flow, Solver};
pub use influence::{Factorised, Influence};
pub use kernel::{CoreModel, CoreRadii};
pub use lattice::{Files, Lattice, LatticeStrip, LatticeSurface, NormalChange, PanelChange, V3, Vortex};
pub use method::Method;
pub use output::Solution;
pub use trefftz::Trefftz;
pub use trim::{Target, Trim, TrimAxes};
