//! What can go wrong, with the names and numbers needed to act on it.

use albatross_numerics::ShortNumber;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The geometry has no surface to solve for.
    #[error(
        "the geometry \"{title}\" has no surface with strips: give at least one SURFACE with two SECTIONs"
    )]
    NoSurfaces {
        /// Title of the geometry.
        title: String,
    },
    /// A surface cannot be made into a lattice.
    #[error("surface \"{surface}\", section {section}: {problem}")]
    Surface {
        /// Name of the surface.
        surface: String,
        /// Section, from 1 in the order of the file.
        section: usize,
        /// What was found and what to do about it.
        problem: String,
    },
    /// A body cannot be made into a source line.
    #[error("body \"{body}\": {problem}")]
    Body {
        /// Name of the body.
        body: String,
        /// What was found and what to do about it.
        problem: String,
    },
    /// An aerofoil cannot be made into a camber line.
    #[error("surface \"{surface}\", section {section}, aerofoil {airfoil}: {problem}")]
    Airfoil {
        /// Name of the surface.
        surface: String,
        /// Section, from 1.
        section: usize,
        /// Digits or file name.
        airfoil: String,
        /// What was found and what to do about it.
        problem: String,
    },
    /// A number of the geometry or of the flight condition is out of range.
    #[error("{what} is {value}: {expected}", value = ShortNumber(*value))]
    Value {
        /// Which number.
        what: String,
        /// What was found.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// The surfaces' influence matrix cannot be solved.
    #[error(
        "the {part} system of {order} vortices is singular at vortex {vortex} (surface \"{surface}\", strip {strip}): \
         look for surfaces that coincide or strips of no width there"
    )]
    Singular {
        /// Whole, symmetric or antisymmetric.
        part: &'static str,
        /// Number of unknowns.
        order: usize,
        /// Vortex, from 1.
        vortex: usize,
        /// Surface to which it belongs.
        surface: String,
        /// Strip, from 1.
        strip: usize,
    },
    /// A control or variable is asked for that the geometry does not have.
    #[error("there is no control \"{name}\"; the controls are: {known}")]
    UnknownControl {
        /// The name asked for.
        name: String,
        /// The names there are, separated by commas.
        known: String,
    },
    /// A list has the wrong length.
    #[error("{what}: found {found}, expected {expected}")]
    Length {
        /// Which list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length needed.
        expected: usize,
    },
    /// Two variables of a trim are driven by the same target.
    #[error("{target} is the target of two variables, {first} and {second}: give each variable its own")]
    TargetTwice {
        /// The target.
        target: String,
        /// First variable.
        first: String,
        /// Second variable.
        second: String,
    },
    /// The trim's equations have no unique solution.
    #[error(
        "the trim has no unique solution: {target} does not depend on the variables that are free (iteration {iteration}); \
         choose another variable for it"
    )]
    TrimSingular {
        /// The target that cannot be reached.
        target: String,
        /// Iteration.
        iteration: usize,
    },
    /// The trim did not converge.
    #[error("trim not converged after {iterations} iterations: {target} is off by {residual:e}")]
    TrimNotConverged {
        /// Iterations done.
        iterations: usize,
        /// The worst target.
        target: String,
        /// Its residual.
        residual: f64,
    },
    /// The trim left the range of angles.
    #[error(
        "trim went to {variable} = {value_deg} deg, outside +-{limit_deg} deg: the targets cannot be reached", value_deg = ShortNumber(*value_deg), limit_deg = ShortNumber(*limit_deg))]
    TrimOutOfRange {
        /// Angle of attack or sideslip.
        variable: &'static str,
        /// Where it went.
        value_deg: f64,
        /// Limit.
        limit_deg: f64,
    },
}

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;
