//! What can go wrong.

use albatross_numerics::ShortNumber;

/// Errors of the flight mechanics.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A quantity that the equations cannot use.
    #[error("{quantity} is {value}, expected {expected}", value = ShortNumber(*value))]
    BadQuantity {
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// Arrays that do not fit.
    #[error(
        "{what}: the size is {found}, expected {expected}; arrays must fit the modes, strips, controls and states"
    )]
    Sizes {
        /// Which array, and what it counts.
        what: &'static str,
        /// Size wanted.
        expected: usize,
        /// Size found.
        found: usize,
    },
    /// Two controls or sensors of one name, or one named like the thrust input.
    #[error("two of the controls, sensors and the input `thrust` are named `{name}`; rename one of them")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// No control of that name.
    #[error("no control is named `{name}`; there are: {known}")]
    UnknownControl {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// An aerodynamic data base lacks something.
    #[error("{what}: {cure}")]
    Derivatives {
        /// What is missing or inconsistent.
        what: String,
        /// How to mend it.
        cure: String,
    },
    /// The static aeroelastic stiffness is singular or negative at the flight point.
    #[error(
        "the flight speed {speed:.3} m/s is at or beyond the divergence speed {divergence_speed:.3} m/s at density \
         {rho:.6} kg/m3: there is no stable elastic trim; lower the speed or stiffen the structure"
    )]
    Divergence {
        /// Flight speed \[m/s\].
        speed: f64,
        /// Divergence speed \[m/s\].
        divergence_speed: f64,
        /// Density \[kg/m³\].
        rho: f64,
    },
    /// The trim equations were not solved.
    #[error(
        "trim did not converge after {iterations} iterations: largest residual {residual:e} in {worst_equation}; \
         check that `{control}` has a pitching-moment derivative and that the speed can carry the weight"
    )]
    TrimNotConverged {
        /// Iterations made.
        iterations: usize,
        /// Largest residual, as an acceleration.
        residual: f64,
        /// The equation it is in.
        worst_equation: &'static str,
        /// The control that trims pitch.
        control: String,
    },
    /// An unknown of the trim has no effect on the equation that it must satisfy.
    #[error("the trim cannot be solved: {unknown} does not change {equation}; {cure}")]
    NoTrimAuthority {
        /// The unknown: a control's name, or the thrust.
        unknown: String,
        /// The equation.
        equation: &'static str,
        /// How to mend it.
        cure: &'static str,
    },
    /// The simulation left the finite numbers.
    #[error(
        "the simulation became non-finite at t = {time:.6} s in state `{state}`; reduce the step of {dt} s or the \
         input, or look for an instability in the mode table", dt = ShortNumber(*dt))]
    Diverged {
        /// Time \[s\].
        time: f64,
        /// First state concerned.
        state: String,
        /// Step \[s\].
        dt: f64,
    },
    /// An input signal is unusable.
    #[error("input signal: {quantity} is {value}, expected {expected}", value = ShortNumber(*value))]
    BadSignal {
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// From the strips.
    #[error(transparent)]
    Strip(#[from] albatross_strip::Error),
    /// From the algebra.
    #[error(transparent)]
    Numerics(#[from] albatross_numerics::Error),
    /// From linear systems.
    #[error(transparent)]
    Lti(#[from] albatross_lti::Error),
}
