//! What can go wrong, with the numbers needed to act on it.

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Coordinate systems or points of the deck cannot be resolved.
    #[error(transparent)]
    Nastran(#[from] albatross_nastran::Error),
    /// A card refers to one that the deck lacks.
    #[error("{card}: {missing} is not in the deck; add the card or correct the number")]
    MissingCard {
        /// The card that refers, with its place when known.
        card: String,
        /// What it refers to.
        missing: String,
    },
    /// A card whose numbers cannot be a mass.
    #[error("{card}: {problem}")]
    BadMass {
        /// The card, with its place when known.
        card: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// An element or property that cannot be made into a stiffness.
    #[error("{card}: {problem}")]
    BadElement {
        /// The card, with its place when known.
        card: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// Elements that this crate does not know.
    #[error(
        "the deck has elements or masses that are not modelled: {}; remove them, or ask to leave them out if that is \
         meant", .found.join(", ")
    )]
    UnknownElements {
        /// Counts and names, `12 CQUAD4`.
        found: Vec<String>,
    },
    /// Constraints that contradict each other or cannot be eliminated.
    #[error("{card}: {problem}")]
    BadConstraint {
        /// The card, with its place when known.
        card: String,
        /// What is wrong, and the cure.
        problem: String,
    },
    /// Motions that nothing resists.
    #[error(
        "the structure is a mechanism: {} {} free to move without strain{}; support or connect them, or join the \
         parts that were meant to be connected", .freedoms.join(", "),
        if .freedoms.len() == 1 { "is" } else { "are" },
        if *.with_mass { "" } else { " and without mass" }
    )]
    Mechanism {
        /// One freedom of each free motion, as `grid 12 R1`.
        freedoms: Vec<String>,
        /// Whether the free motions carry mass (a static solution needs supports) or not.
        with_mass: bool,
    },
    /// The model has nothing to vibrate.
    #[error("{problem}")]
    EmptyModel {
        /// What is missing, and the cure.
        problem: String,
    },
    /// An option out of its range.
    #[error("{option} is {value}; expected {expected}")]
    BadOption {
        /// The option.
        option: &'static str,
        /// Its value.
        value: String,
        /// The range, and the cure.
        expected: &'static str,
    },
    /// A point or freedom asked for is not in the model.
    #[error("{what} is not in the model; {cure}")]
    NoSuchFreedom {
        /// What was asked for.
        what: String,
        /// What to do.
        cure: &'static str,
    },
    /// The eigenvalue iteration did not converge.
    #[error(
        "{converged} of {wanted} modes converged after {steps} block steps; the stiffnesses of the model may differ \
         by too many orders of magnitude, or ask for fewer modes"
    )]
    NotConverged {
        /// Modes asked for.
        wanted: usize,
        /// Modes found.
        converged: usize,
        /// Steps made.
        steps: usize,
    },
    /// The sparse factorisation failed for another reason than a mechanism.
    #[error("the {what} cannot be factorised: {reason}")]
    Factorisation {
        /// The matrix.
        what: &'static str,
        /// The library's reason.
        reason: String,
    },
}

impl Error {
    /// Refuses a vector that has another length than the model's.
    pub(crate) fn refuse_length(found: usize, expected: usize) -> Result<(), Self> {
        if found == expected {
            return Ok(());
        }
        Err(Self::BadOption {
            option: "the length of the vector",
            value: format!("{found} where the matrix has the order {expected}"),
            expected: "one number for each free freedom, in the order of the matrix",
        })
    }
}
