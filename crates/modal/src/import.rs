//! From deck and results to a basis: which vectors, which grids, which mass.

use albatross_nastran::deck::Id;
use albatross_nastran::frames::Frames;
use albatross_nastran::{Deck, Dialect, Eigenvector, ModalResults, PointKind, RealMode};
use std::collections::{BTreeMap, BTreeSet};

use crate::basis::{BasisGrid, BasisMass, ModalBasis};
use crate::error::Error;
use crate::mass_matrix::MassMatrix;
use crate::mean_axes::{MeanAxes, RigidBody};
use crate::options::BasisOptions;
use crate::select::{self, Candidate};
use crate::weight_check;
use albatross_fem::free_directions;
use albatross_fem::{BarMass, DeckMass};
use albatross_fem::{MassProperties, MassSource};

impl ModalBasis {
    /// The modal basis of a modal analysis: the deck gives positions, frames and mass, the results the modes.
    ///
    /// Vectors are turned from each grid's displacement system to the basic axes. Elastic modes are told from rigid
    /// ones by frequency and, where the mass matrix is known, by the share of rigid motion in their kinetic energy.
    ///
    /// # Errors
    /// [`Error::Nastran`] for results without eigenvectors or of another deck; [`Error::NoSuchSubcase`],
    /// [`Error::NoSuchMode`], [`Error::TooFewModes`], [`Error::GridsDiffer`]; [`Error::Fem`] from
    /// the mass cards; and the errors of [`try_new`](Self::try_new).
    pub fn from_nastran(deck: &Deck, results: &ModalResults, options: &BasisOptions) -> Result<Self, Error> {
        options.check()?;
        let frames = Frames::resolve(deck)?;
        let mut notes = Vec::new();
        let (subcase, vectors) = structural_vectors(results, &frames, options.subcase, &mut notes)?;
        let grids = common_grids(results, &vectors, &frames, &mut notes)?;

        let bar_mass = options
            .bar_mass
            .unwrap_or_else(|| program_bar_mass(deck, results.dialect, &mut notes));
        let deck_mass = DeckMass::assemble(deck, &frames, bar_mass)?;
        notes.extend(deck_mass.notes.iter().cloned());
        let properties = mass_properties(deck, &frames, results, &deck_mass, &mut notes);
        let matrix = mass_on(&grids, &deck_mass);

        let candidates = candidates(results, &vectors, &grids)?;
        let cg = properties.map_or([0.0; 3], |p| p.cg);
        let mut free = free_directions(deck, &frames, cg, subcase);
        let positions: Vec<[f64; 3]> = grids.iter().map(|g| g.position).collect();
        let body = match &matrix {
            Ok(m) => {
                select::free_by_rigid_modes(
                    &candidates,
                    m,
                    &positions,
                    cg,
                    options.rigid_threshold_hz,
                    &mut free,
                )?;
                Some((m, RigidBody::new(m, &positions, cg, free)?))
            }
            Err(_) => None,
        };
        let body = body.as_ref().map(|(m, b)| (*m, b));
        let modes = select::select(candidates, body, results, options, &mut notes)?;

        let mass = BasisMass {
            properties,
            matrix,
            free_directions: free,
        };
        let mut basis = Self::try_new(grids, modes, mass, options)?;
        weight_check::generalized_mass(&basis, &mut notes);
        if let MeanAxes::Refused { reason } = &basis.mean_axes {
            notes.push(format!("mean-axes check refused: {reason}"));
        }
        notes.append(&mut basis.notes);
        basis.notes = notes;
        Ok(basis)
    }
}

/// A vector in basic axes with its rows by grid.
struct Vectors<'a> {
    vector: &'a Eigenvector,
    rows: BTreeMap<Id, [f64; 6]>,
}

/// The vectors of one subcase on structural grids, in basic axes. A second block of the same modes on points that
/// are not in the deck (an aerodynamic mesh) is left out.
fn structural_vectors<'a>(
    results: &'a ModalResults,
    frames: &Frames,
    wanted: Option<u32>,
    notes: &mut Vec<String>,
) -> Result<(Option<u32>, Vec<Vectors<'a>>), Error> {
    let all = results.require_eigenvectors()?;
    let subcases: BTreeSet<Option<u32>> = all.iter().map(|v| v.subcase).collect();
    let subcase = match wanted {
        // A file that prints no subcase has one.
        Some(n) if subcases.contains(&Some(n)) => Some(n),
        Some(_) if subcases.len() == 1 && subcases.contains(&None) => None,
        Some(wanted) => {
            let present: Vec<_> = subcases
                .iter()
                .map(|s| s.map_or("an unnamed one".into(), |n| n.to_string()))
                .collect();
            let present = format!("subcase {}", present.join(", "));
            return Err(Error::NoSuchSubcase {
                file: results.source.clone(),
                wanted,
                present,
            });
        }
        None => all.first().and_then(|v| v.subcase),
    };
    if wanted.is_none() && subcases.len() > 1 {
        notes.push(format!(
            "eigenvectors of {} subcases are printed; subcase {} is taken",
            subcases.len(),
            subcase.map_or("without number".into(), |n| n.to_string())
        ));
    }
    let mut merged: BTreeMap<u32, Vectors<'a>> = BTreeMap::new();
    let mut left_out = BTreeSet::new();
    for (vector, turned) in all.iter().zip(turned(results, frames, subcase)?) {
        let Some(turned) = turned else {
            if vector.subcase == subcase {
                left_out.insert(vector.block);
            }
            continue;
        };
        let entry = merged.entry(vector.mode).or_insert_with(|| Vectors {
            vector,
            rows: BTreeMap::new(),
        });
        for row in turned.rows.iter().filter(|r| r.kind == PointKind::Grid) {
            entry.rows.entry(row.id).or_insert(row.values);
        }
    }
    if !left_out.is_empty() {
        notes.push(
            "eigenvectors on points that the deck lacks (such as an aerodynamic mesh) are left out"
                .to_string(),
        );
    }
    Ok((subcase, merged.into_values().collect()))
}

/// Each vector of the subcase in basic axes; `None` for other subcases and for later blocks with points that the
/// deck lacks. The first block of a mode must be of the deck.
fn turned(
    results: &ModalResults,
    frames: &Frames,
    subcase: Option<u32>,
) -> Result<Vec<Option<Eigenvector>>, Error> {
    let in_deck = |v: &Eigenvector| {
        v.rows
            .iter()
            .filter(|r| r.kind == PointKind::Grid)
            .all(|r| frames.grid(r.id).is_some())
    };
    let keep: Vec<bool> = results
        .eigenvectors
        .iter()
        .map(|v| v.subcase == subcase && (v.block == 0 || in_deck(v)))
        .collect();
    let chosen = results
        .eigenvectors
        .iter()
        .zip(&keep)
        .filter(|(_, k)| **k)
        .map(|(v, _)| v.clone())
        .collect();
    let structural = ModalResults {
        source: results.source.clone(),
        dialect: results.dialect,
        eigenvalues: Vec::new(),
        eigenvectors: chosen,
        weights: Vec::new(),
        diagnostics: Vec::new(),
    };
    let mut basic = structural.eigenvectors_in_basic(frames)?.into_iter();
    Ok(keep
        .into_iter()
        .map(|k| if k { basic.next() } else { None })
        .collect())
}

/// The grids of all modes, in ascending order. Every mode must have the same; grids with a component that is not
/// printed are left out.
fn common_grids(
    results: &ModalResults,
    vectors: &[Vectors<'_>],
    frames: &Frames,
    notes: &mut Vec<String>,
) -> Result<Vec<BasisGrid>, Error> {
    let first = vectors.first().ok_or(Error::NoModes)?;
    let mut incomplete = BTreeSet::new();
    for v in vectors {
        let missing_here = first.rows.keys().find(|id| !v.rows.contains_key(id));
        let missing_there = v.rows.keys().find(|id| !first.rows.contains_key(id));
        if let Some(example) = missing_here.or(missing_there) {
            return Err(Error::GridsDiffer {
                file: results.source.clone(),
                mode: v.vector.mode as usize,
                reference: first.vector.mode as usize,
                found: v.rows.len(),
                expected: first.rows.len(),
                example: format!(" (grid {example} is in one of them only)"),
            });
        }
        incomplete.extend(
            v.rows
                .iter()
                .filter(|(_, m)| m.iter().any(|x| x.is_nan()))
                .map(|(&id, _)| id),
        );
    }
    if !incomplete.is_empty() {
        let ids: Vec<Id> = incomplete.iter().copied().collect();
        notes.push(format!(
            "grids {} are printed without rotations (or with blanks) and are left out of the basis: an axis through \
             them would have no twist; print all six components",
            crate::text::ranges(&ids)
        ));
    }
    let complete = first.rows.keys().filter(|id| !incomplete.contains(id));
    let grids: Vec<BasisGrid> = complete
        .filter_map(|&id| {
            Some(BasisGrid {
                id,
                position: frames.grid(id)?.position.into(),
            })
        })
        .collect();
    if grids.is_empty() {
        return Err(Error::Nastran(albatross_nastran::Error::MissingResult {
            file: results.source.clone(),
            missing: "no grid of the eigenvectors has all six components".into(),
            cure: "print translations and rotations: DISPLACEMENT(PRINT) = ALL without a data recovery that drops \
                   R1 to R3"
                .into(),
        }));
    }
    Ok(grids)
}

fn candidates(
    results: &ModalResults,
    vectors: &[Vectors<'_>],
    grids: &[BasisGrid],
) -> Result<Vec<Candidate>, Error> {
    vectors
        .iter()
        .map(|v| {
            let row: &RealMode = results
                .table_for(v.vector)
                .and_then(|t| t.mode(v.vector.mode))
                .ok_or_else(|| Error::NoSuchMode {
                    file: results.source.clone(),
                    mode: v.vector.mode as usize,
                    problem: "has an eigenvector but no row in the table of real eigenvalues".into(),
                    present: select::numbers(vectors.iter().map(|v| v.vector.mode as usize)),
                })?;
            Ok(Candidate {
                number: v.vector.mode as usize,
                eigenvalue: row.eigenvalue,
                omega_rad_s: row.omega_rad_s,
                generalized_mass: row.generalized_mass,
                shape: grids.iter().filter_map(|g| v.rows.get(&g.id).copied()).collect(),
            })
        })
        .collect()
}

/// MYSTRAN lumps the mass of bars whatever the deck says; the others follow PARAM,COUPMASS.
fn program_bar_mass(deck: &Deck, dialect: Dialect, notes: &mut Vec<String>) -> BarMass {
    let asked = deck
        .params
        .get("COUPMASS")
        .and_then(|p| p.as_integer())
        .is_some_and(|v| v > 0);
    match (asked, dialect) {
        (false, _) => BarMass::Lumped,
        (true, Dialect::Mystran) => {
            notes.push("PARAM,COUPMASS is ignored: MYSTRAN lumps the mass of bars".into());
            BarMass::Lumped
        }
        (true, _) => BarMass::Coupled,
    }
}

fn mass_on(grids: &[BasisGrid], deck_mass: &DeckMass) -> Result<MassMatrix, String> {
    if let Some(reason) = deck_mass.incomplete() {
        return Err(reason);
    }
    let ids: Vec<Id> = grids.iter().map(|g| g.id).collect();
    let matrix = MassMatrix::on_grids(&deck_mass.model, &ids).map_err(|e| match e {
        Error::NoMassMatrix { reason, .. } => reason,
        other => other.to_string(),
    })?;
    if deck_mass.model.properties().is_none() {
        return Err("the deck has no mass".into());
    }
    Ok(matrix)
}

/// Mass properties by the deck's mass cards, or by the weight generator where these are not complete.
fn mass_properties(
    deck: &Deck,
    frames: &Frames,
    results: &ModalResults,
    deck_mass: &DeckMass,
    notes: &mut Vec<String>,
) -> Option<MassProperties> {
    let weight = results.weights.first();
    if deck_mass.other.is_empty() {
        if let Some(weight) = weight {
            weight_check::compare(deck, frames, weight, &deck_mass.model, notes);
        }
        return deck_mass.model.properties();
    }
    let printed = weight.and_then(|w| {
        let reference = weight_check::reference_position(frames, w)?;
        let factor = deck.weight_to_mass();
        let mo = w.mo.map(|row| row.map(|m| m * factor));
        let source = MassSource::GridPointWeight;
        MassProperties::from_rigid_mass(&mo, reference).map(|p| MassProperties { source, ..p })
    });
    notes.push(match printed {
        Some(_) => "mass, centre of gravity and inertia are those of the grid point weight generator".into(),
        None => "mass properties are not known: add PARAM,GRDPNT,0 to the deck and run again".to_string(),
    });
    printed
}
