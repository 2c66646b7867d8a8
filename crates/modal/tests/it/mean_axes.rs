//! The mean-axes check, and the removal of rigid parts.

use albatross_modal::{
    BasisGrid, Error, MassMatrix, MassModel, MeanAxes, ModalBasis, ModeInput, OnViolation, rigid_shape,
};
use nalgebra::{Matrix6, Vector3};
use proptest::prelude::*;

use crate::support::{inputs, largest, largest_difference, mass_of, numbered, options};

/// A free body of ten lumped masses with inertia and offsets, and modes that are orthogonal to rigid motion.
struct FreeBody {
    grids: Vec<BasisGrid>,
    model: MassModel,
    elastic: Vec<Vec<[f64; 6]>>,
}

impl FreeBody {
    fn new(numbers: &[f64]) -> Self {
        let mut pool = numbers.iter().copied().cycle();
        let mut next = move || pool.next().unwrap_or(0.5);
        let positions: Vec<[f64; 3]> = (0..10)
            .map(|i| [next() * 10.0 + f64::from(i), next() * 8.0, next() * 3.0])
            .collect();
        let mut model = MassModel::default();
        let grids = numbered(&positions);
        for grid in &grids {
            // A symmetric positive definite block: B^T B + 1.
            let b = Matrix6::from_fn(|_, _| next());
            model.add(
                grid.id,
                Vector3::from(grid.position),
                &(b.transpose() * b + Matrix6::identity()),
            );
        }
        let ids: Vec<u32> = grids.iter().map(|g| g.id).collect();
        let mass = MassMatrix::on_grids(&model, &ids).expect("all grids");
        // Gram-Schmidt in the mass matrix, twice, after the rigid motions: exact to rounding.
        let mut family: Vec<Vec<[f64; 6]>> = (0..6).map(|i| rigid_shape(i, [0.0; 3], &positions)).collect();
        family.extend((0..4).map(|_| {
            (0..10)
                .map(|_| std::array::from_fn(|_| next()))
                .collect::<Vec<[f64; 6]>>()
        }));
        for _ in 0..2 {
            for k in 0..family.len() {
                let (done, rest) = family.split_at_mut(k);
                let Some(shape) = rest.first_mut() else { break };
                for other in done {
                    let c = mass.inner(other, shape);
                    add(shape, other, -c);
                }
                let norm = mass.inner(shape, shape).sqrt();
                shape.iter_mut().flatten().for_each(|v| *v /= norm);
            }
        }
        Self {
            grids,
            model,
            elastic: family.split_off(6),
        }
    }

    fn basis(&self, modes: Vec<ModeInput>, on_violation: OnViolation) -> Result<ModalBasis, Error> {
        ModalBasis::try_new(
            self.grids.clone(),
            modes,
            mass_of(&self.model, &self.grids),
            &options(on_violation),
        )
    }

    /// Modes with rigid motion added: generalised mass grows by the rigid part's, stiffness does not.
    fn contaminated(&self, amounts: &[f64]) -> Vec<ModeInput> {
        let ids: Vec<u32> = self.grids.iter().map(|g| g.id).collect();
        let mass = MassMatrix::on_grids(&self.model, &ids).expect("all grids");
        let positions: Vec<_> = self.grids.iter().map(|g| g.position).collect();
        let mut modes = inputs(self.elastic.clone());
        for (k, mode) in modes.iter_mut().enumerate() {
            for direction in 0..6 {
                let amount = amounts[(k + direction) % amounts.len()];
                add(
                    &mut mode.shape,
                    &rigid_shape(direction, [1.0, 2.0, 3.0], &positions),
                    amount,
                );
            }
            let mu = mass.inner(&mode.shape, &mode.shape);
            mode.omega_rad_s /= mu.sqrt();
            mode.generalized_mass = mu;
        }
        modes
    }
}

fn add(shape: &mut [[f64; 6]], other: &[[f64; 6]], factor: f64) {
    shape
        .iter_mut()
        .flatten()
        .zip(other.iter().flatten())
        .for_each(|(a, b)| *a += factor * b);
}

proptest! {
    /// Orthogonalising gives back the modes before contamination: shape, generalised mass and frequency.
    #[test]
    fn prop_orthogonalise_restores_contaminated_modes(
        numbers in prop::collection::vec(-1.0..1.0_f64, 97),
        amounts in prop::collection::vec(-0.05..0.05_f64, 5),
    ) {
        prop_assume!(amounts.iter().any(|a| a.abs() > 1e-3));
        let body = FreeBody::new(&numbers);
        let got = body.basis(body.contaminated(&amounts), OnViolation::Orthogonalise).expect("elastic");
        for ((mode, exact), number) in got.modes.iter().zip(&body.elastic).zip(1_u32..) {
            prop_assert!(largest_difference(&mode.shape, exact) < 1e-11 * largest(exact));
            prop_assert!((mode.generalized_mass - 1.0).abs() < 1e-11);
            prop_assert!((mode.omega_rad_s - f64::from(number)).abs() < 1e-11 * f64::from(number));
        }
        let MeanAxes::Checked(check) = &got.mean_axes else { panic!("the mass is complete") };
        prop_assert!(check.coupling.iter().flatten().all(|&c| c < 1e-11));
        prop_assert!(check.orthogonality < 1e-11);
        prop_assert!(check.worst > 1e-6);
    }
}

fn example() -> FreeBody {
    let numbers: Vec<f64> = (0..97).map(|i| (f64::from(i) * 1.7).sin()).collect();
    FreeBody::new(&numbers)
}

#[test]
fn contaminated_modes_are_refused_with_figures() {
    let body = example();
    assert!(
        body.basis(inputs(body.elastic.clone()), OnViolation::Refuse)
            .is_ok()
    );
    let error = body
        .basis(body.contaminated(&[1e-4]), OnViolation::Refuse)
        .unwrap_err();
    let Error::NotMeanAxes {
        value,
        tolerance,
        count,
        modes,
        ..
    } = error
    else {
        panic!("{error}")
    };
    assert!(value > 1e-5 && tolerance == 1e-6 && count == 4 && modes == 4);

    let kept = body
        .basis(body.contaminated(&[1e-4]), OnViolation::Accept)
        .expect("accepted");
    assert!(
        kept.notes.iter().any(|n| n.contains("do not fly this basis")),
        "{:?}",
        kept.notes
    );
}

/// For a single direction the coupling is known: phi + a R_z has momentum a M_zz, and mu = 1 + a^2 M_zz.
#[test]
fn val_coupling_of_one_rigid_direction() {
    let body = example();
    let positions: Vec<_> = body.grids.iter().map(|g| g.position).collect();
    let cg = body.model.properties().expect("has mass").cg;
    let m_zz = body.model.rigid_mass(cg)[2][2];
    let a = 1e-3;
    let mut modes = inputs(body.elastic.clone());
    add(&mut modes[1].shape, &rigid_shape(2, cg, &positions), a);
    let got = body.basis(modes, OnViolation::Accept).expect("accepted");
    let MeanAxes::Checked(check) = &got.mean_axes else {
        panic!("the mass is complete")
    };
    let expected = a * m_zz.sqrt() / (1.0 + a * a * m_zz).sqrt();
    assert!(
        (check.coupling[1][2] - expected).abs() < 1e-12,
        "{:?} {expected}",
        check.coupling[1]
    );
    assert!(check.coupling[0].iter().all(|&c| c < 1e-12));
}

#[test]
fn a_rigid_mode_has_nothing_elastic() {
    let body = example();
    let positions: Vec<_> = body.grids.iter().map(|g| g.position).collect();
    let modes = inputs(vec![rigid_shape(4, [0.0; 3], &positions)]);
    let error = body.basis(modes, OnViolation::Orthogonalise).unwrap_err();
    assert!(error.to_string().contains("mode 1 is a rigid motion"), "{error}");
}

#[test]
fn bad_modes_are_refused() {
    let body = example();
    let refuse = |change: &dyn Fn(&mut ModeInput)| {
        let mut modes = inputs(body.elastic.clone());
        change(&mut modes[2]);
        body.basis(modes, OnViolation::Refuse).unwrap_err().to_string()
    };
    assert!(refuse(&|m| m.shape[4][3] = f64::NAN).contains("mode 3: a component of grid 5 is NaN"));
    assert!(refuse(&|m| m.omega_rad_s = 0.0).contains("leave rigid modes and mechanisms out"));
    assert!(refuse(&|m| m.generalized_mass = -1.0).contains("generalised mass is -1"));
    assert!(refuse(&|m| m.shape.truncate(3)).contains("shape of 3 grids, the basis has 10"));
    assert!(body.basis(Vec::new(), OnViolation::Refuse).is_err());
}
