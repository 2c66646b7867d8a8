//! Sizes at the edge: none or many modes, strips, lags, controls, sensors.

use crate::test_models::{Elasticity, all_options, cruise, flexible, strips, transport, two_modes};
use albatross_flight::signal::Signal;
use albatross_flight::{
    Aircraft, ElasticPart, EquationsOfMotion, Error, Manoeuvre, Method, ModelOptions, ShapeReference, Trim,
    linearize, simulate, trim,
};
use albatross_numerics::Mat;
use albatross_strip::{GeneralizedForces, StripShapes};

/// An aircraft with `n` modes of wavy shapes, 1 rad/s apart.
fn with_modes(n: usize) -> Aircraft {
    let shape = |scale: f64| {
        Mat::from_fn(strips().len(), n, |j, k| {
            scale * ((j + 1) as f64 * (k + 1) as f64 * 0.37).sin()
        })
    };
    flexible(&Elasticity {
        shapes: StripShapes::try_new(shape(0.05), shape(0.002)).unwrap(),
        omega_rad_s: (0..n).map(|k| 10.0 + k as f64).collect(),
        damping: vec![0.02; n],
        modal_mass: vec![1_000.0; n],
        ..two_modes()
    })
}

fn fly_a_little(equations: &EquationsOfMotion, t: &Trim) {
    for method in [Method::Rk4, Method::ExactLags] {
        let inputs = vec![(
            0,
            Signal::Step {
                amplitude: 0.001,
                start: 0.0,
            },
        )];
        let m = Manoeuvre {
            dt: 1e-3,
            end: 0.05,
            output_every: 10,
            method,
            inputs,
        };
        let history = simulate(equations, t, &m).unwrap();
        assert!(history.final_state.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn val_one_mode_and_two_hundred() {
    for n in [1, 200] {
        let options = ModelOptions {
            shape_reference: ShapeReference::Jig,
            ..ModelOptions::default()
        };
        let (equations, t) = trim(&with_modes(n), options, &cruise()).unwrap();
        let system = linearize(&equations, &t.state, &t.input).unwrap();
        assert_eq!(system.a.nrows(), 10 + 2 * n + 2 * strips().len());
        fly_a_little(&equations, &t);
    }
}

fn remove_columns(forces: &mut GeneralizedForces, keep_rows: bool) {
    for m in [
        &mut forces.eta_etadd_nc,
        &mut forces.eta_etad_nc,
        &mut forces.eta_etad_c,
        &mut forces.eta_eta_nc,
        &mut forces.eta_eta_c,
    ] {
        *m = Mat::zeros(if keep_rows { m.nrows() } else { 0 }, 0);
    }
}

/// Strips without modes: nothing is left but the rigid aircraft, and lags that nothing excites.
#[test]
fn val_no_modes() {
    let mut aircraft = with_modes(1);
    aircraft.sensors.truncate(4);
    let n_strips = strips().len();
    let ElasticPart {
        model,
        rigid_rows,
        q_x,
        q_u,
        q_0,
        ..
    } = aircraft.elastic.as_mut().unwrap();
    model.structure.mass = Mat::zeros(0, 0);
    model.structure.damping = Mat::zeros(0, 0);
    model.structure.stiffness = Mat::zeros(0, 0);
    remove_columns(&mut model.forces, false);
    remove_columns(rigid_rows, true);
    model.forces.eta_lambda_c = Mat::zeros(0, n_strips);
    model.downwash.w_eta = Mat::zeros(n_strips, 0);
    model.downwash.w_etad = Mat::zeros(n_strips, 0);
    (*q_x, *q_u) = (Mat::zeros(0, 5), Mat::zeros(0, 1));
    q_0.clear();
    for options in all_options() {
        let (equations, t) = trim(&aircraft, options, &cruise()).unwrap();
        assert_eq!(equations.n_modes(), 0);
        linearize(&equations, &t.state, &t.input).unwrap();
        fly_a_little(&equations, &t);
    }
}

/// Modes without strips: they ring, and the air does not see them.
#[test]
fn val_no_strips() {
    let mut aircraft = with_modes(1);
    let ElasticPart {
        model,
        rigid_rows,
        control_incidence,
        ..
    } = aircraft.elastic.as_mut().unwrap();
    model.strips.clear();
    model.forces.eta_lambda_c = Mat::zeros(1, 0);
    rigid_rows.eta_lambda_c = Mat::zeros(6, 0);
    model.downwash.w_eta = Mat::zeros(0, 1);
    model.downwash.w_etad = Mat::zeros(0, 1);
    *control_incidence = Mat::zeros(0, 1);
    for options in all_options() {
        let (equations, t) = trim(&aircraft, options, &cruise()).unwrap();
        assert_eq!(equations.layout().n_lags, 0);
        fly_a_little(&equations, &t);
    }
}

/// Without lags the circulation follows at once (`C = 1`).
#[test]
fn val_no_lags() {
    let (equations, t) = trim(
        &flexible(&Elasticity {
            lags: vec![],
            ..two_modes()
        }),
        ModelOptions::default(),
        &cruise(),
    )
    .unwrap();
    assert_eq!(equations.layout().n_lags, 0);
    fly_a_little(&equations, &t);
}

#[test]
fn val_no_controls_and_no_sensors() {
    let mut bare = transport();
    bare.controls.clear();
    bare.sensors.clear();
    let rigid = &mut bare.rigid;
    for c in [
        &mut rigid.lift,
        &mut rigid.side,
        &mut rigid.roll,
        &mut rigid.pitch,
        &mut rigid.yaw,
    ] {
        c.controls.clear();
    }
    let refused = trim(&bare, ModelOptions::default(), &cruise()).map(|(_, t)| t);
    assert!(matches!(refused, Err(Error::UnknownControl { .. })));
    let equations = EquationsOfMotion::new(&bare, ModelOptions::default()).unwrap();
    let mut x = vec![0.0; 10];
    x[0] = 100.0;
    let system = linearize(&equations, &x, &[1e4]).unwrap();
    assert_eq!((system.b.ncols(), system.c.nrows()), (1, 0));
}
