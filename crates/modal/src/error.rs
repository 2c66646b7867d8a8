//! What can go wrong, with the numbers needed to act on it.

use albatross_nastran::deck::Id;
use albatross_numerics::ShortNumber;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The deck and the results file do not fit, or lack something.
    #[error(transparent)]
    Nastran(#[from] albatross_nastran::Error),
    /// The mass of the deck cannot be assembled.
    #[error(transparent)]
    Fem(#[from] albatross_fem::Error),
    /// The results hold no eigenvector of the subcase asked for.
    #[error("{file}: no eigenvectors for subcase {wanted}; the file has {present}")]
    NoSuchSubcase {
        /// The results file.
        file: String,
        /// The subcase asked for.
        wanted: u32,
        /// The subcases that have eigenvectors.
        present: String,
    },
    /// A mode asked for is not there.
    #[error(
        "{file}: mode {mode} {problem}; the file has eigenvectors of modes {present}. Ask for one of these, or \
         raise the number of modes on EIGRL/EIGR and request DISPLACEMENT(PRINT) = ALL"
    )]
    NoSuchMode {
        /// The results file.
        file: String,
        /// The mode.
        mode: usize,
        /// What is missing.
        problem: String,
        /// The modes with eigenvectors, as ranges.
        present: String,
    },
    /// Fewer elastic modes than asked for.
    #[error(
        "{file}: {wanted} elastic modes are asked for, but the file has only {found} \
         ({rigid} rigid and {excluded} other modes are set aside); raise the number of modes on EIGRL/EIGR or \
         ask for fewer"
    )]
    TooFewModes {
        /// The results file.
        file: String,
        /// Elastic modes asked for.
        wanted: usize,
        /// Elastic modes found.
        found: usize,
        /// Rigid modes found.
        rigid: usize,
        /// Mechanisms found.
        excluded: usize,
    },
    /// No mode at all is selected.
    #[error("the modal basis would be empty; select at least one mode")]
    NoModes,
    /// Two modes are given on different grids.
    #[error(
        "{file}: mode {mode} has {found} grids where mode {reference} has {expected}{example}; the output is cut \
         or the SET of the output request differs: print all modes on the same grids"
    )]
    GridsDiffer {
        /// The results file.
        file: String,
        /// The mode that differs.
        mode: usize,
        /// The first mode of the basis.
        reference: usize,
        /// Number of grids of `mode`.
        found: usize,
        /// Number of grids of `reference`.
        expected: usize,
        /// A grid that only one of them has, as text; may be empty.
        example: String,
    },
    /// A number of a mode or a grid is not finite, or a frequency or generalised mass is not positive.
    #[error("mode {mode}: {what} is {value}; {expected}", value = ShortNumber(*value))]
    BadMode {
        /// Mode number.
        mode: usize,
        /// The quantity.
        what: String,
        /// Its value.
        value: f64,
        /// What is expected, and the cure.
        expected: &'static str,
    },
    /// Two grids of a basis have the same number.
    #[error("grid {id} stands twice in the basis; give each grid once")]
    DuplicateGrid {
        /// The number.
        id: Id,
    },
    /// A grid has a coordinate that is not finite.
    #[error("grid {id} has the coordinate {value}; positions are finite numbers in metres", value = ShortNumber(*value))]
    BadPosition {
        /// The grid.
        id: Id,
        /// The coordinate.
        value: f64,
    },
    /// The shape of a mode has another length than the list of grids.
    #[error("mode {mode} has a shape of {found} grids, the basis has {expected}")]
    ShapeLength {
        /// Mode number.
        mode: usize,
        /// Length of the shape.
        found: usize,
        /// Number of grids.
        expected: usize,
    },
    /// A grid is not in the basis.
    #[error(
        "grid {id} ({wanted_by}) is not in the modal basis; the nearest numbers are {nearest}. Correct the number, \
         or print the grid's displacements: DISPLACEMENT(PRINT) = ALL or a SET that holds it"
    )]
    UnknownGrid {
        /// The number asked for.
        id: Id,
        /// Who asked.
        wanted_by: String,
        /// Numbers nearest to it that are in the basis.
        nearest: String,
    },
    /// The modes move the centre of gravity or have angular momentum.
    #[error(
        "mode {mode} is not a mean-axes mode: |phi^T M R| / sqrt(mu M_RR) = {value:.2e} for rigid {direction}, \
         tolerance {tolerance:.1e} ({count} of {modes} modes exceed it). Rigid motion would be counted twice. The \
         deck's mass is not the mass of the eigenvectors, or the model is not free: check that deck and results \
         belong together, or let the rigid part be removed (orthogonalise)"
    )]
    NotMeanAxes {
        /// The worst mode.
        mode: usize,
        /// Its largest coupling.
        value: f64,
        /// The rigid direction of that coupling.
        direction: &'static str,
        /// The tolerance.
        tolerance: f64,
        /// Modes beyond the tolerance.
        count: usize,
        /// Modes of the basis.
        modes: usize,
    },
    /// A mode has no elastic part: orthogonalising leaves nothing.
    #[error(
        "mode {mode} is a rigid motion: without its rigid part {remaining:.1e} of its generalised mass remains; \
         leave it out of the elastic modes"
    )]
    NothingElastic {
        /// Mode number.
        mode: usize,
        /// Share of the generalised mass that is not rigid.
        remaining: f64,
    },
    /// An operation needs the mass matrix.
    #[error("{operation} needs the mass matrix on the grids of the basis, which is not available: {reason}")]
    NoMassMatrix {
        /// The operation.
        operation: &'static str,
        /// Why there is none.
        reason: String,
    },
    /// The mass matrix has the wrong order, or its entries are not finite.
    #[error("the mass matrix {problem}")]
    BadMassMatrix {
        /// What is wrong.
        problem: String,
    },
    /// A load reference axis that cannot be used.
    #[error("load reference axis \"{axis}\": {problem}")]
    BadAxis {
        /// Name of the axis.
        axis: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// The grids of a load reference axis fold back.
    #[error(
        "load reference axis \"{axis}\": its grids do not advance steadily along the span: grid {second} is at \
         {second_at:.6} m after grid {first} at {first_at:.6} m; list the grids in order from one end to the other, \
         each once"
    )]
    AxisNotMonotonic {
        /// Name of the axis.
        axis: String,
        /// A grid.
        first: Id,
        /// Its running coordinate, m.
        first_at: f64,
        /// The next grid of the list.
        second: Id,
        /// Its running coordinate, m.
        second_at: f64,
    },
    /// A station lies too far beyond the axis.
    #[error(
        "station {index} (y = {y}, z = {z}) of load reference axis \"{axis}\" lies {beyond:.4} m beyond its {end} \
         grid {grid}; at most {allowed:.4} m (5 % of the axis) are extrapolated. Assign the strip to another axis, \
         or extend this one", y = ShortNumber(*y), z = ShortNumber(*z))]
    StationBeyondAxis {
        /// Name of the axis.
        axis: String,
        /// Index of the station, from 0.
        index: usize,
        /// Station's y, m.
        y: f64,
        /// Station's z, m.
        z: f64,
        /// Distance beyond the end along the span, m.
        beyond: f64,
        /// "first" or "last".
        end: &'static str,
        /// The grid at that end.
        grid: Id,
        /// Distance allowed, m.
        allowed: f64,
    },
    /// Two bases cannot be compared.
    #[error("the bases have no grid in common, so no MAC can be formed; compare results of the same model")]
    NoCommonGrids,
    /// An option is out of its range.
    #[error("{option} is {value}, expected {expected}", value = ShortNumber(*value))]
    BadOption {
        /// The option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// The range.
        expected: &'static str,
    },
    /// A numerical method failed.
    #[error("{what}: {source}")]
    Numerics {
        /// What was computed.
        what: String,
        /// The method's reason.
        #[source]
        source: albatross_numerics::Error,
    },
}
