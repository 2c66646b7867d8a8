//! What must hold for any strips and shapes.

use albatross_numerics::{Mat, eigen};
use albatross_strip::forces::{Downwash, downwash, generalized_forces};
use albatross_strip::{
    DihedralForm, DownwashPoint, GeneralizedForces, Split, Strip, StripShapes, StripTheory,
};
use proptest::prelude::*;
use std::f64::consts::TAU;

const MODES: usize = 3;

fn a_strip() -> impl Strategy<Value = Strip> {
    (
        (-20.0..20.0, -2.0..2.0, 0.1..2.0, 0.2..4.0),
        (-5.0..5.0, -3.0..3.0, 3.0..7.0),
    )
        .prop_map(|((y, z, width, chord), (x_ac, lever, cl_alpha))| Strip {
            y,
            z,
            width,
            chord,
            x_ac,
            x_lra: x_ac + lever,
            cl_alpha,
            dihedral_rad: 0.0,
        })
}

/// Strips with the displacements and rotations of `MODES` modes.
fn a_wing() -> impl Strategy<Value = (Vec<Strip>, StripShapes)> {
    prop::collection::vec((a_strip(), prop::array::uniform6(-1.0..1.0)), 1..6).prop_map(|rows| {
        let entry = |j: usize, k: usize| -> f64 { rows[j].1[k] };
        let phi = Mat::from_fn(rows.len(), MODES, entry);
        let gamma = Mat::from_fn(rows.len(), MODES, |j, k| entry(j, MODES + k));
        let strips = rows.iter().map(|r| r.0).collect();
        (strips, StripShapes::try_new(phi, gamma).unwrap())
    })
}

fn q(strips: &[Strip], shapes: &StripShapes, theory: &StripTheory) -> GeneralizedForces {
    generalized_forces(strips, shapes, shapes, theory, Split::default()).unwrap()
}

/// Largest difference of the matrices that belong to the modes alone, over their largest entry.
fn difference(a: &GeneralizedForces, b: &GeneralizedForces) -> f64 {
    [
        (&a.eta_etadd_nc, &b.eta_etadd_nc),
        (&a.eta_etad_nc, &b.eta_etad_nc),
        (&a.eta_etad_c, &b.eta_etad_c),
        (&a.eta_eta_nc, &b.eta_eta_nc),
        (&a.eta_eta_c, &b.eta_eta_c),
    ]
    .into_iter()
    .map(|(x, y)| (x - y).norm_max() / x.norm_max().max(1.0))
    .fold(0.0, f64::max)
}

fn rows(shapes: &StripShapes, order: &[usize]) -> StripShapes {
    let pick = |m: &Mat<f64>| Mat::from_fn(order.len(), m.ncols(), |j, k| m[(order[j], k)]);
    StripShapes::try_new(pick(&shapes.phi), pick(&shapes.gamma)).unwrap()
}

/// Downwash of unit coordinates and rates at V = 1.
fn w(strips: &[Strip], shapes: &StripShapes) -> Downwash {
    downwash(strips, shapes, &StripTheory::default()).unwrap()
}

proptest! {
    #[test]
    fn prop_order_of_strips_does_not_matter((strips, shapes) in a_wing()) {
        let order: Vec<usize> = (0..strips.len()).rev().collect();
        let reversed: Vec<Strip> = order.iter().map(|&j| strips[j]).collect();
        let theory = StripTheory::default();
        let (a, b) = (q(&strips, &shapes, &theory), q(&reversed, &rows(&shapes, &order), &theory));
        prop_assert!(difference(&a, &b) < 1e-13);
        for (j, &from) in order.iter().enumerate() {
            for k in 0..MODES {
                prop_assert_eq!(b.eta_lambda_c[(k, j)], a.eta_lambda_c[(k, from)]);
            }
        }
    }

    #[test]
    fn prop_a_strip_is_its_two_halves((strips, shapes) in a_wing()) {
        let order: Vec<usize> = (0..strips.len()).flat_map(|j| [j, j]).collect();
        let halves: Vec<Strip> = order
            .iter()
            .map(|&j| Strip { width: 0.5 * strips[j].width, ..strips[j] })
            .collect();
        let theory = StripTheory::default();
        let (a, b) = (q(&strips, &shapes, &theory), q(&halves, &rows(&shapes, &order), &theory));
        prop_assert!(difference(&a, &b) < 1e-13);
    }

    /// The apparent mass takes kinetic energy: symmetric, and no motion has a negative one.
    #[test]
    fn prop_apparent_mass_is_a_mass((strips, shapes) in a_wing()) {
        let added = -&q(&strips, &shapes, &StripTheory::default()).eta_etadd_nc;
        prop_assert!((&added - added.transpose()).norm_max() <= 1e-14 * added.norm_max());
        let (energies, _) = eigen::symmetric_generalized(added.as_ref(), Mat::<f64>::identity(MODES, MODES).as_ref()).unwrap();
        prop_assert!(energies.iter().all(|e| *e >= -1e-12 * added.norm_max()), "{energies:?}");
    }

    /// Where the shapes are referred to does not matter: an LRA elsewhere with the displacement found there.
    #[test]
    fn prop_load_reference_axis_is_free((strips, shapes) in a_wing(), shift in -2.0..2.0f64) {
        let moved: Vec<Strip> = strips.iter().map(|s| Strip { x_lra: s.x_lra + shift, ..*s }).collect();
        let phi = shapes.at(&strips, |s| s.x_lra + shift);
        let there = StripShapes::try_new(phi, shapes.gamma.clone()).unwrap();
        let theory = StripTheory::default();
        prop_assert!(difference(&q(&strips, &shapes, &theory), &q(&moved, &there, &theory)) < 1e-12);
    }

    /// A mode s times as large has generalised forces s times as large as test shape, and again as trial shape.
    #[test]
    fn prop_scaled_mode((strips, shapes) in a_wing(), s in 0.1..10.0f64) {
        let scale = |m: &Mat<f64>| Mat::from_fn(m.nrows(), MODES, |j, k| if k == 1 { s * m[(j, k)] } else { m[(j, k)] });
        let larger = StripShapes::try_new(scale(&shapes.phi), scale(&shapes.gamma)).unwrap();
        let theory = StripTheory::default();
        let (a, b) = (q(&strips, &shapes, &theory), q(&strips, &larger, &theory));
        let factor = |k: usize| if k == 1 { s } else { 1.0 };
        for (x, y) in [(&a.eta_etad_c, &b.eta_etad_c), (&a.eta_eta_c, &b.eta_eta_c), (&a.eta_etadd_nc, &b.eta_etadd_nc)] {
            let expected = Mat::from_fn(MODES, MODES, |k, l| factor(k) * factor(l) * x[(k, l)]);
            prop_assert!((&expected - y).norm_max() <= 1e-13 * expected.norm_max());
        }
    }

    /// Yates's downwash point is the three-quarter chord where the lift slope is that of a thin airfoil.
    #[test]
    fn prop_yates_of_a_thin_airfoil((strips, shapes) in a_wing()) {
        let thin: Vec<Strip> = strips.iter().map(|s| Strip { cl_alpha: TAU, ..*s }).collect();
        let yates = StripTheory { downwash_point: DownwashPoint::Yates, ..StripTheory::default() };
        let (a, b) = (q(&thin, &shapes, &StripTheory::default()), q(&thin, &shapes, &yates));
        prop_assert!(difference(&a, &b) < 1e-13);
    }

    #[test]
    fn prop_general_dihedral_without_dihedral((strips, shapes) in a_wing()) {
        let lateral = Mat::from_fn(strips.len(), MODES, |j, k| 0.3 * (j + k) as f64);
        let [paper, general] = [DihedralForm::Paper, DihedralForm::General].map(|form| {
            StripShapes::from_components(&strips, form, [&lateral, &shapes.phi], [&shapes.gamma, &lateral]).unwrap()
        });
        prop_assert_eq!(&paper.phi, &general.phi);
        prop_assert_eq!(&paper.gamma, &general.gamma);
        let [paper, general] = [DihedralForm::Paper, DihedralForm::General]
            .map(|form| StripShapes::rigid_body(&strips, form, 1.0, 0.5));
        prop_assert_eq!(paper.phi, general.phi);
    }

    /// Rigid motion: unit incidence lifts `rho V^2 sum k` (heave is down in body axes), unit sinking rate does the same
    /// per V, and the moments are those forces times their arms.
    #[test]
    fn prop_rigid_motion((strips, _) in a_wing(), x_cg in -3.0..3.0f64) {
        let rigid = StripShapes::rigid_body(&strips, DihedralForm::Paper, x_cg, 0.0);
        let forces = q(&strips, &rigid, &StripTheory::default());
        let sum = |f: &dyn Fn(&Strip) -> f64| -> f64 { strips.iter().map(f).sum() };
        let scale = sum(&|s| s.lift_factor() * (1.0 + s.y.abs() + (s.x_ac - x_cg).abs() + s.chord).powi(2));
        let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-12 * scale;
        // Pitch: column 4. Heave: 2. Roll: 3.
        prop_assert!(close(forces.eta_eta_c[(2, 4)], -sum(&|s| s.lift_factor())));
        prop_assert!(close(forces.eta_etad_c[(2, 2)], -sum(&|s| s.lift_factor())));
        prop_assert!(close(forces.eta_eta_c[(4, 4)], sum(&|s| (x_cg - s.x_ac) * s.lift_factor())));
        prop_assert!(close(forces.eta_eta_c[(3, 4)], -sum(&|s| s.y * s.lift_factor())));
        prop_assert!(close(forces.eta_etad_c[(3, 3)], -sum(&|s| s.y * s.y * s.lift_factor())));
        // A roll rate to the right wing down makes incidence y p / V there.
        let wash = w(&strips, &rigid);
        for (j, s) in strips.iter().enumerate() {
            prop_assert!((wash.w_etad[(j, 3)] - s.y).abs() < 1e-14 * (1.0 + s.y.abs()));
            prop_assert!((wash.w_etad[(j, 4)] - (s.x_three_quarter() - x_cg)).abs() < 1e-13 * 20.0);
            prop_assert_eq!(wash.w_eta[(j, 4)], 1.0);
        }
    }

    /// Wings that mirror each other, in symmetric motion: no side force, rolling or yawing moment.
    #[test]
    fn prop_symmetric_motion_stays_symmetric((right, shapes) in a_wing(), dihedral in -1.4..1.4f64) {
        let n = right.len();
        let strips: Vec<Strip> = right
            .iter()
            .map(|s| Strip { dihedral_rad: dihedral, ..*s })
            .chain(right.iter().map(|s| Strip { y: -s.y, dihedral_rad: -dihedral, ..*s }))
            .collect();
        let even = |m: &Mat<f64>| Mat::from_fn(2 * n, MODES, |j, k| m[(j % n, k)]);
        let odd = |m: &Mat<f64>| Mat::from_fn(2 * n, MODES, |j, k| if j < n { 0.7 } else { -0.7 } * m[(j % n, k)]);
        for form in [DihedralForm::Paper, DihedralForm::General] {
            let elastic = StripShapes::from_components(
                &strips,
                form,
                [&odd(&shapes.gamma), &even(&shapes.phi)],
                [&even(&shapes.gamma), &odd(&shapes.phi)],
            ).unwrap();
            let rigid = StripShapes::rigid_body(&strips, form, 0.4, 0.1);
            let rows = generalized_forces(&strips, &rigid, &elastic, &StripTheory::default(), Split::Theodorsen).unwrap();
            for m in [&rows.eta_etadd_nc, &rows.eta_etad_nc, &rows.eta_etad_c, &rows.eta_eta_nc, &rows.eta_eta_c] {
                for row in [1, 3, 5] {
                    for k in 0..MODES {
                        prop_assert!(m[(row, k)].abs() <= 1e-12 * m.norm_max().max(1.0), "{form:?} row {row}: {}", m[(row, k)]);
                    }
                }
            }
        }
    }
}
