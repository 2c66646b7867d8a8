//! Elastic modes among all modes of a file.
//!
//! Frequency alone does not tell: a free model has six rigid modes, a half model three, a model on soft springs none
//! at zero, and a very soft wing bends below any fixed limit. With the mass matrix the shape decides: the share of
//! rigid motion in the kinetic energy is 1 for a rigid mode and 0 for a free-free elastic one.
//!
//! Equations: THEORY (4a).

use albatross_nastran::ModalResults;
use std::f64::consts::TAU;

use crate::basis::ModeInput;
use crate::error::Error;
use crate::mass_matrix::MassMatrix;
use crate::mean_axes::RigidBody;
use crate::options::{BasisOptions, Selection};

/// A mode of the file.
pub(crate) struct Candidate {
    pub(crate) number: usize,
    pub(crate) eigenvalue: f64,
    pub(crate) omega_rad_s: f64,
    pub(crate) generalized_mass: f64,
    pub(crate) shape: Vec<[f64; 6]>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Rigid,
    Elastic,
    /// Free to move without being a rigid motion of the whole: a loose control surface, a part that is not joined.
    Mechanism,
}

/// Rigid share of the kinetic energy from which a mode counts as rigid although its frequency is not near zero.
const RIGID_ON_SPRINGS: f64 = 0.999;
/// Rigid share below which a mode near zero frequency is not rigid.
const NOT_RIGID: f64 = 0.5;

/// A rigid direction that the supports seem to block is free all the same if the rigid modes of the file span it:
/// constraints on freedoms without stiffness, such as rotations of grids on solids, do not hold the model.
pub(crate) fn free_by_rigid_modes(
    candidates: &[Candidate],
    mass: &MassMatrix,
    positions: &[[f64; 3]],
    cg: [f64; 3],
    threshold_hz: f64,
    free: &mut [bool; 6],
) -> Result<(), Error> {
    if free.iter().all(|f| *f) {
        return Ok(());
    }
    let body = RigidBody::new(mass, positions, cg, [true; 6])?;
    let mut spanned = [0.0; 6];
    for mode in candidates.iter().filter(|c| c.omega_rad_s < threshold_hz * TAU) {
        let mu = mass.inner(&mode.shape, &mode.shape);
        if mu > 0.0 {
            for (s, c) in spanned.iter_mut().zip(body.coupling(&mode.shape, mu)) {
                *s += c * c;
            }
        }
    }
    for (f, s) in free.iter_mut().zip(spanned) {
        *f |= s > 0.99;
    }
    Ok(())
}

/// The modes that `options` ask for.
pub(crate) fn select(
    candidates: Vec<Candidate>,
    body: Option<(&MassMatrix, &RigidBody)>,
    results: &ModalResults,
    options: &BasisOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<ModeInput>, Error> {
    let present = numbers(candidates.iter().map(|c| c.number));
    let kinds: Vec<Kind> = candidates
        .iter()
        .map(|c| kind(c, body, options.rigid_threshold_hz, notes))
        .collect();
    let count = |kind| kinds.iter().filter(|k| **k == kind).count();
    if body.is_none() {
        notes.push(format!(
            "without the mass matrix, modes below {} Hz are taken as rigid by frequency alone",
            options.rigid_threshold_hz
        ));
    }
    let chosen: Vec<Candidate> = match &options.modes {
        Selection::Numbers(wanted) => {
            let mut pool: Vec<Option<Candidate>> = candidates.into_iter().map(Some).collect();
            let mut chosen = Vec::with_capacity(wanted.len());
            for &number in wanted {
                let slot = pool
                    .iter_mut()
                    .find(|c| c.as_ref().is_some_and(|c| c.number == number));
                chosen.push(slot.and_then(Option::take).ok_or_else(|| Error::NoSuchMode {
                    file: results.source.clone(),
                    mode: number,
                    problem: if wanted.iter().filter(|&&n| n == number).count() > 1 {
                        "is asked for twice".into()
                    } else {
                        "has no eigenvector".into()
                    },
                    present: present.clone(),
                })?);
            }
            chosen
        }
        Selection::All | Selection::FirstElastic(_) => {
            let mut elastic: Vec<Candidate> = candidates
                .into_iter()
                .zip(&kinds)
                .filter(|(_, k)| **k == Kind::Elastic)
                .map(|(c, _)| c)
                .collect();
            elastic.sort_by(|a, b| {
                a.omega_rad_s
                    .total_cmp(&b.omega_rad_s)
                    .then(a.number.cmp(&b.number))
            });
            if let Selection::FirstElastic(n) = options.modes {
                if elastic.len() < n {
                    return Err(Error::TooFewModes {
                        file: results.source.clone(),
                        wanted: n,
                        found: elastic.len(),
                        rigid: count(Kind::Rigid),
                        excluded: count(Kind::Mechanism),
                    });
                }
                elastic.truncate(n);
            }
            elastic
        }
    };
    Ok(chosen.into_iter().map(input).collect())
}

fn kind(
    mode: &Candidate,
    body: Option<(&MassMatrix, &RigidBody)>,
    threshold_hz: f64,
    notes: &mut Vec<String>,
) -> Kind {
    let frequency_hz = mode.omega_rad_s / TAU;
    let slow = frequency_hz < threshold_hz || mode.eigenvalue <= 0.0;
    let content = body.and_then(|(mass, body)| {
        let mu = mass.inner(&mode.shape, &mode.shape);
        (mu > 0.0).then(|| body.rigid_content(&mode.shape, mu))
    });
    let percent = content.map_or(0.0, |c| 100.0 * c);
    match content {
        Some(content) if slow && content < NOT_RIGID => {
            // Rigid modes and mechanisms are zero to rounding; a real spring is not.
            if frequency_hz < threshold_hz / 100.0 || mode.eigenvalue <= 0.0 {
                notes.push(format!(
                    "mode {} at {frequency_hz:.2e} Hz is a mechanism ({percent:.0} % rigid motion) and is left out: \
                     some part moves without stiffness",
                    mode.number
                ));
                Kind::Mechanism
            } else {
                notes.push(format!(
                    "mode {} at {frequency_hz:.4} Hz is below {threshold_hz} Hz but only {percent:.0} % rigid motion; \
                     taken as elastic",
                    mode.number
                ));
                Kind::Elastic
            }
        }
        Some(content) if !slow && content > RIGID_ON_SPRINGS => {
            notes.push(format!(
                "mode {} at {frequency_hz:.4} Hz is a rigid motion of the whole model (on springs); taken as rigid",
                mode.number
            ));
            Kind::Rigid
        }
        _ if slow => Kind::Rigid,
        _ => Kind::Elastic,
    }
}

fn input(mode: Candidate) -> ModeInput {
    ModeInput {
        number: mode.number,
        omega_rad_s: mode.omega_rad_s,
        generalized_mass: mode.generalized_mass,
        shape: mode.shape,
    }
}

/// Mode numbers as ranges.
pub(crate) fn numbers(modes: impl Iterator<Item = usize>) -> String {
    let mut ids: Vec<u32> = modes.filter_map(|n| u32::try_from(n).ok()).collect();
    ids.sort_unstable();
    crate::text::ranges(&ids)
}
