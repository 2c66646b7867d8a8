//! The mass matrix against what the program printed: weight generator and generalised masses.

use albatross_nastran::frames::Frames;
use albatross_nastran::{Deck, GridPointWeight};

use crate::basis::ModalBasis;
use crate::mean_axes::MeanAxes;
use albatross_fem::MassModel;
use albatross_fem::RIGID_DIRECTIONS;

/// Basic position of the weight generator's reference point; `None` for a grid that the deck lacks.
pub(crate) fn reference_position(frames: &Frames, weight: &GridPointWeight) -> Option<[f64; 3]> {
    if weight.reference_point == 0 {
        return Some([0.0; 3]);
    }
    frames.grid(weight.reference_point).map(|g| g.position.into())
}

/// Notes entries of the rigid-body mass matrix that differ from MO by more than seven printed digits:
/// |M_ij - MO_ij| > 2e-6 sqrt(M_ii M_jj).
pub(crate) fn compare(
    deck: &Deck,
    frames: &Frames,
    weight: &GridPointWeight,
    model: &MassModel,
    notes: &mut Vec<String>,
) {
    let Some(reference) = reference_position(frames, weight) else {
        notes.push(format!(
            "the weight generator's reference grid {} is not in the deck; its table is not compared",
            weight.reference_point
        ));
        return;
    };
    // The weight generator prints before PARAM,WTMASS.
    let factor = deck.weight_to_mass();
    let own = model.rigid_mass(reference).map(|row| row.map(|m| m / factor));
    let size = |i: usize| own[i][i].max(weight.mo[i][i]).max(0.0).sqrt();
    let upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
    let relative = |&(i, j): &(usize, usize)| {
        let scale = size(i) * size(j);
        if scale > 0.0 {
            (own[i][j] - weight.mo[i][j]).abs() / scale
        } else {
            0.0
        }
    };
    let worst = upper
        .max_by(|p, q| relative(p).total_cmp(&relative(q)))
        .unwrap_or_default();
    let (i, j) = worst;
    // Also where it is not a number.
    if relative(&worst).is_nan() || relative(&worst) > 2e-6 {
        notes.push(format!(
            "the deck's mass differs from the grid point weight generator: {} / {} is {:.7e} by the deck and {:.7e} as \
             printed. Deck and results are of different mass states, or the program treats a mass card differently",
            RIGID_DIRECTIONS[i], RIGID_DIRECTIONS[j], own[i][j], weight.mo[i][j]
        ));
    }
}

/// Notes modes whose phi^T M phi differs from the table's generalised mass by more than 1e-4, the digits of seven
/// printed places being 1e-6.
pub(crate) fn generalized_mass(basis: &ModalBasis, notes: &mut Vec<String>) {
    let MeanAxes::Checked(check) = &basis.mean_axes else {
        return;
    };
    let differs = |(mode, own): &(&crate::BasisMode, &f64)| (*own / mode.generalized_mass - 1.0).abs() > 1e-4;
    let differing: Vec<_> = basis
        .modes
        .iter()
        .zip(&check.shape_generalized_mass)
        .filter(differs)
        .collect();
    if let Some((mode, own)) = differing.first() {
        notes.push(format!(
            "the generalised mass of {} modes differs from the shapes' phi^T M phi: mode {} has {:.6e} in the table \
             and {:.6e} from the deck's mass",
            differing.len(),
            mode.number,
            mode.generalized_mass,
            own
        ));
    }
    if check.orthogonality > 1e-4 {
        notes.push(format!(
            "two modes are not orthogonal in the deck's mass: |phi_k^T M phi_l| / sqrt(mu_k mu_l) = {:.1e}",
            check.orthogonality
        ));
    }
}
