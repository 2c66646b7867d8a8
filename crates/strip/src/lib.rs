//! Incremental unsteady strip aerodynamics of a flexible aircraft, and its flutter.
//!
//! # The problem
//! A structure moves in a few mode shapes; on each strip of its lifting surfaces this is a plunge `phi` and a nose-up
//! rotation `gamma` of the load reference axis per unit of each mode. What forces does the air return on the modes,
//! with the memory of the wake, and how does the whole behave?
//!
//! # The equations
//! With `w = V gamma.eta - phi_34.etad` the downwash at the three-quarter chord, each strip of chord c and width dy
//! carries (Theodorsen 1935, Jones 1940)
//!
//! ```text
//! circulatory lift      1/2 rho V c cl_alpha (w + lambda_1 + lambda_2) dy      at the aerodynamic centre
//! lag states            lambda_i' = (2 V a_i / c) lambda_i + A_i w'
//! apparent mass         -pi rho b^2 z_m'' dy at mid chord, pi rho b^2 V theta' dy at three-quarter chord,
//!                       couple -pi rho b^4/8 theta'' dy
//! ```
//!
//! Collected on the modes these are the paper's Eqs. 7 to 12: see [`forces`] and [`elastic`].
//!
//! # Inputs and outputs
//! In: [`Strip`]s, their [`StripShapes`], a [`Structure`].
//!
//! | module | out |
//! |---|---|
//! | [`slopes`] | strips with their lift slopes from AVL's strip files, a table, or thin-airfoil theory |
//! | [`shapes`] | plunge and pitch of the modes on the strips, rigid-body shapes, dihedral |
//! | [`forces`] | generalised force matrices, downwash |
//! | [`quasi_steady`] | forces of rigid-body motion and controls on the modes |
//! | [`elastic`] | Eq. 11's matrices and the state matrix over `[eta, etad, lambda_1, lambda_2]` |
//! | [`kernels`] | Theodorsen, Wagner, Küssner, and lags |
//! | [`flutter`] | the lowest flutter and divergence speeds |
//! | [`neutral`] | every speed at which a mode is neutral, and which way it goes |
//! | [`sweep`] | all modes over a range of speeds, by state space or p-k, with their crossings |
//! | [`section`] | the typical section |
//!
//! # Limits
//! Attached flow, small motion, chordwise-rigid sections. No aerodynamic coupling between strips, unless their influence
//! on each other is given ([`forces::generalized_forces_between`]), which then acts without delay by distance. The lags are those
//! of incompressible flow; compressibility enters by the lift slopes alone. A lift slope other than 2 pi with the
//! downwash at three-quarter chord may feed a mode energy at the smallest speeds, which structural damping covers.
//!
//! Every input is checked: numbers that are not finite, strips without chord, arrays that do not fit are [`Error`]s.
//!
//! # Example
//! A typical section, one strip with plunge and pitch, and its flutter speed:
//!
//! ```
//! use albatross_strip::{flutter, section::TypicalSection};
//! // Perry, NASA/TP-2015-218765, appendix C (units of the report).
//! let section = TypicalSection {
//!     mass: 31.41592653589793, static_moment: 6.283185307179586, inertia: 7.853981633974483,
//!     plunge_stiffness: 78539.81633974482, pitch_stiffness: 78539.81633974482,
//!     semi_chord: 1.0, axis: -0.4, cl_alpha: std::f64::consts::TAU,
//! };
//! let model = section.model(&albatross_strip::kernels::JONES)?;
//! let found = flutter::exact_flutter(&model, 1.0)?.ok_or("no flutter")?;
//! assert!((found.speed - 173.26).abs() < 0.005);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod elastic;
pub mod flutter;
pub mod forces;
pub mod kernels;
pub mod neutral;
mod operator;
pub mod quasi_steady;
pub mod section;
pub mod shapes;
pub mod slopes;
pub mod strip;
pub mod sweep;

mod check;
mod error;

pub use elastic::{AeroelasticModel, Flow, Structure};
pub use error::Error;
pub use forces::{GeneralizedForces, Split};
pub use shapes::{DihedralForm, StripShapes};
pub use strip::{DownwashPoint, Strip, StripTheory};
