//! The elastic part against the formulas, evaluated without any of the model's shortcuts.

use crate::test_models::{Elasticity, cruise, flexible, two_modes};
use albatross_flight::{
    Aircraft, ControlAerodynamics, EquationsOfMotion, Fidelity, ModelOptions, ShapeReference, atmosphere,
    trim,
};
use albatross_numerics::{Mat, solve};
use albatross_strip::Split;
use albatross_strip::kernels::{JONES, indicial_lags};
use proptest::prelude::*;

fn jig(fidelity: Fidelity) -> ModelOptions {
    ModelOptions {
        fidelity,
        shape_reference: ShapeReference::Jig,
        ..ModelOptions::default()
    }
}

/// `A x`, entry by entry.
fn times(a: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    (0..a.nrows())
        .map(|i| x.iter().enumerate().map(|(j, x)| a[(i, j)] * x).sum())
        .collect()
}

/// Eq. 10 by a dense solve, Eq. 9, and the body forces of Eqs. 7 and 8 as they are printed.
struct Printed {
    etadd: Vec<f64>,
    lag_rates: Vec<f64>,
    body: Vec<f64>,
}

fn printed(aircraft: &Aircraft, equations: &EquationsOfMotion, x: &[f64], u: &[f64]) -> Printed {
    let part = aircraft.elastic.as_ref().unwrap();
    let (layout, model) = (equations.layout(), &part.model);
    let (eta, etad, lags) = (&x[layout.eta()], &x[layout.eta_rate()], &x[layout.lags()]);
    let rho = atmosphere::standard(x[layout.altitude()]).density;
    let v = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
    let n_strips = model.strips.len();
    let sum: Vec<f64> = (0..n_strips)
        .map(|j| (0..model.lags.len()).map(|i| lags[i * n_strips + j]).sum())
        .collect();
    let air = [
        (x[2] / x[0]).atan(),
        (x[1] / v).asin(),
        x[3] * aircraft.reference.span / (2.0 * v),
        x[4] * aircraft.reference.chord / (2.0 * v),
        x[5] * aircraft.reference.span / (2.0 * v),
    ];
    let q_s_c = 0.5 * rho * v * v * aircraft.reference.area * aircraft.reference.chord;
    let q = &model.forces;
    let motion = |q: &albatross_strip::GeneralizedForces| -> Vec<f64> {
        let (a, b, c) = (
            times(&q.eta_eta(), eta),
            times(&q.eta_etad(), etad),
            times(&q.eta_lambda_c, &sum),
        );
        (0..a.len())
            .map(|k| rho * v * v * a[k] + rho * v * (b[k] + c[k]))
            .collect()
    };
    let (by_motion, by_air, by_u) = (motion(q), times(&part.q_x, &air), times(&part.q_u, &u[..1]));
    let (spring, damper) = (
        times(&model.structure.stiffness, eta),
        times(&model.structure.damping, etad),
    );
    let force: Vec<f64> = (0..eta.len())
        .map(|k| by_motion[k] + q_s_c * (part.q_0[k] + by_air[k] + by_u[k]) - spring[k] - damper[k])
        .collect();
    let etadd = solve::solve_vec(model.mass(rho).unwrap().as_ref(), &force).unwrap();
    let apparent = times(&part.rigid_rows.eta_etadd_nc, &etadd);
    let body = motion(&part.rigid_rows)
        .iter()
        .zip(apparent)
        .map(|(f, a)| f + rho * a)
        .collect();
    let (by_etad, by_etadd) = (
        times(&model.downwash.w_eta, etad),
        times(&model.downwash.w_etad, &etadd),
    );
    let lag_rates = (0..lags.len())
        .map(|i| {
            let (lag, j) = (model.lags[i / n_strips], i % n_strips);
            2.0 * v * lag.rate / model.strips[j].chord * lags[i] + lag.gain * (v * by_etad[j] + by_etadd[j])
        })
        .collect();
    Printed {
        etadd,
        lag_rates,
        body,
    }
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / scale
}

proptest! {
    /// The fused, pre-diagonalised evaluation is Eqs. 7 to 10 to rounding, in any state.
    #[test]
    fn prop_equations_as_printed(
        velocity in (80.0..250.0_f64, -20.0..20.0_f64, -20.0..20.0_f64),
        rates in prop::array::uniform3(-0.2..0.2_f64),
        altitude in 0.0..15_000.0_f64,
        elastic in prop::array::uniform4(-1.0..1.0_f64),
        lag in -3.0..3.0_f64,
        elevator in -0.2..0.2_f64,
    ) {
        let aircraft = flexible(&two_modes());
        let equations = EquationsOfMotion::new(&aircraft, jig(Fidelity::Unsteady)).unwrap();
        let layout = equations.layout();
        let mut x = vec![velocity.0, velocity.1, velocity.2];
        x.extend(rates);
        x.extend([0.1, 0.05, 0.7, altitude]);
        x.extend(elastic);
        x.extend((0..layout.n_lags).map(|i| lag * (1.0 + i as f64).sin()));
        let u = [elevator, 3e4];
        let mut xdot = vec![0.0; x.len()];
        equations.derivative(&x, &u, &mut equations.workspace(), &mut xdot).unwrap();
        let expected = printed(&aircraft, &equations, &x, &u);
        prop_assert!(largest_difference(&xdot[layout.eta_rate()], &expected.etadd) < 1e-12);
        prop_assert!(largest_difference(&xdot[layout.lags()], &expected.lag_rates) < 1e-12);

        // Body forces: what the same state without modes does not have.
        let rigid = EquationsOfMotion::new(&aircraft, jig(Fidelity::Rigid)).unwrap();
        let mut without = vec![0.0; 10];
        rigid.derivative(&x[..10], &u, &mut rigid.workspace(), &mut without).unwrap();
        let force: Vec<f64> = (0..3).map(|i| aircraft.mass * (xdot[i] - without[i])).collect();
        let angular: Vec<f64> = (3..6).map(|i| xdot[i] - without[i]).collect();
        let moment: Vec<f64> =
            aircraft.inertia.iter().map(|row| row.iter().zip(&angular).map(|(j, a)| j * a).sum()).collect();
        let body: Vec<f64> = force.into_iter().chain(moment).collect();
        prop_assert!(largest_difference(&body, &expected.body) < 1e-9, "{body:?} {:?}", expected.body);
    }
}

/// Torsional divergence of a wing in closed form (Bisplinghoff, Ashley & Halfman 1955, section 8-2): the twist in trim
/// is `eta = q e S_w (c_l0 + a alpha) / (K - q e S_w a)`, and lift and moment balance with the twist's lift added.
#[test]
fn val_jig_trim_is_the_static_solution() {
    let aircraft = flexible(&two_modes());
    let point = cruise();
    let (_, trimmed) = trim(&aircraft, jig(Fidelity::Unsteady), &point).unwrap();
    let q = trimmed.dynamic_pressure;
    // Sums over the wing strips, chord 4 - 0.1 y, width 4, axis 0.6 m behind the aerodynamic centre.
    let wing: Vec<(f64, f64)> = (0..4)
        .map(|i| 2.0 + 4.0 * f64::from(i))
        .map(|y| (2.0 * 4.0 * (4.0 - 0.1 * y), 15.0 + 0.1 * y))
        .collect();
    let area: f64 = wing.iter().map(|(s, _)| s).sum();
    let (slope, zero, arm) = (5.0, 0.25, 0.6);
    let stiffness = 5_000.0 * 40.0_f64.powi(2);
    let twist = q * arm * area * (zero + slope * trimmed.alpha_rad) / (stiffness - q * arm * area * slope);
    assert!(
        (trimmed.eta[0] / twist - 1.0).abs() < 1e-12,
        "{} against {twist}",
        trimmed.eta[0]
    );
    assert!(
        trimmed.eta[1].abs() < 1e-12 * twist,
        "antisymmetric bending {}",
        trimmed.eta[1]
    );

    let (sin, cos) = trimmed.alpha_rad.sin_cos();
    let lift = 0.25 + 5.5 * trimmed.alpha_rad + 0.4 * trimmed.controls_rad[0];
    let drag = 0.02 + 0.045 * lift * lift;
    let weight = aircraft.mass * aircraft.gravity;
    let q_s = q * aircraft.reference.area;
    let twist_lift = q * slope * twist * area;
    let normal = q_s * (lift * cos + drag * sin) + twist_lift - weight * cos;
    let axial = q_s * (lift * sin - drag * cos) + trimmed.thrust - weight * sin;
    let twist_moment: f64 = wing
        .iter()
        .map(|(s, x)| q * slope * twist * s * (crate::test_models::X_CG - x))
        .sum();
    let pitch = q_s * 4.0 * (0.05 - 1.2 * trimmed.alpha_rad - 1.4 * trimmed.controls_rad[0]) + twist_moment;
    assert!(
        normal.abs() < 1e-11 * weight && axial.abs() < 1e-11 * weight,
        "{normal} {axial}"
    );
    assert!(pitch.abs() < 1e-11 * q_s * 4.0, "{pitch}");

    // Lags are zero in steady flight, so the quasi-steady model trims alike.
    let (_, quasi_steady) = trim(&aircraft, jig(Fidelity::QuasiSteady), &point).unwrap();
    assert!((quasi_steady.alpha_rad - trimmed.alpha_rad).abs() < 1e-12);
    assert!((quasi_steady.eta[0] / twist - 1.0).abs() < 1e-11);
}

/// With the flight shape as reference the amplitudes are counted from the trim: the aircraft flies like the rigid one
/// and stays in trim.
#[test]
fn val_trimmed_reference_has_no_amplitudes() {
    let aircraft = flexible(&two_modes());
    let (equations, flexible) = trim(&aircraft, ModelOptions::default(), &cruise()).unwrap();
    let rigid_options = ModelOptions {
        fidelity: Fidelity::Rigid,
        ..ModelOptions::default()
    };
    let (_, rigid) = trim(&aircraft, rigid_options, &cruise()).unwrap();
    assert!(flexible.eta.iter().all(|eta| *eta == 0.0));
    assert!((flexible.alpha_rad - rigid.alpha_rad).abs() < 1e-14);
    assert!((flexible.thrust / rigid.thrust - 1.0).abs() < 1e-13);
    let mut xdot = vec![0.0; equations.layout().n_states()];
    equations
        .derivative(
            &flexible.state,
            &flexible.input,
            &mut equations.workspace(),
            &mut xdot,
        )
        .unwrap();
    let etadd = &xdot[equations.layout().eta_rate()];
    assert!(etadd.iter().all(|a| a.abs() < 1e-11), "{etadd:?}");
}

/// A lagged control's lift on the strips builds up as Wagner's function in Jones's form; a quasi-steady one's does at
/// once. Held rigid body and modes, elevator step: the vertical force of the tail alone changes.
#[test]
fn val_lagged_control_follows_wagner() {
    let aircraft = flexible(&two_modes());
    let options = ModelOptions {
        control_aerodynamics: ControlAerodynamics::Lagged,
        ..ModelOptions::default()
    };
    let (equations, trimmed) = trim(&aircraft, options, &cruise()).unwrap();
    let layout = equations.layout();
    let mut work = equations.workspace();
    let mut xdot = vec![0.0; layout.n_states()];
    let mut x = trimmed.state.clone();
    let mut u = trimmed.input.clone();
    let step = 0.01;
    u[0] += step;
    let part = aircraft.elastic.as_ref().unwrap();
    let (tail, speed) = (part.model.strips[4], cruise().speed);
    // Both tail halves: c_l,delta = 2.5.
    let strip_lift = 2.0 * trimmed.dynamic_pressure * tail.area() * 2.5 * step;
    let whole_lift = trimmed.dynamic_pressure * aircraft.reference.area * 0.4 * step;
    let mut before = xdot.clone();
    equations
        .derivative(&x, &trimmed.input, &mut work, &mut before)
        .unwrap();
    // The exact solution of the lag equation over time t, with everything else held.
    let steady = {
        let (_, held) = trim(&aircraft, options, &cruise()).unwrap();
        held.state[layout.lags()].to_vec()
    };
    for s in [0.0, 1.0, 5.0, 40.0, 1e4] {
        let t = s * 0.5 * tail.chord / speed;
        let n_strips = layout.n_strips;
        for i in 0..layout.n_lags {
            let (lag, strip) = (JONES[i / n_strips], i % n_strips);
            let chord = part.model.strips[strip].chord;
            let target = -lag.gain * speed * part.control_incidence[(strip, 0)] * u[0];
            let decay = (2.0 * speed * lag.rate / chord * t).exp();
            x[layout.lags().start + i] = target + (steady[i] - target) * decay;
        }
        equations.derivative(&x, &u, &mut work, &mut xdot).unwrap();
        // Lift of the elevator leans by the incidence; its drag is of second order but its strips' part is normal.
        let (sin, cos) = trimmed.alpha_rad.sin_cos();
        let drag_change = {
            let at = |de: f64| {
                let lift = 0.25 + 5.5 * trimmed.alpha_rad + 0.4 * de;
                0.02 + 0.045 * lift * lift
            };
            trimmed.dynamic_pressure * aircraft.reference.area * (at(u[0]) - at(trimmed.input[0]))
        };
        let missing = 1.0 - indicial_lags(&JONES, s);
        let expected = -(whole_lift * cos + drag_change * sin) + missing * strip_lift;
        let elastic = {
            // Accelerating modes push back with their apparent mass.
            let rho = trimmed.density;
            let etadd: Vec<f64> = xdot[layout.eta_rate()].to_vec();
            rho * times(&part.rigid_rows.eta_etadd_nc, &etadd)[2]
        };
        let found = aircraft.mass * (xdot[2] - before[2]) - elastic;
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "s = {s}: {found} against {expected}"
        );
        // And it is in equilibrium with the rates: the lag equation holds along the exact solution.
        if s == 1e4 {
            let tail_lags = [4, 9].map(|j| layout.lags().start + j);
            assert!(tail_lags.iter().all(|&i| xdot[i].abs() < 1e-6));
        }
    }
}

/// How the terms of pitch and plunge are booked changes nothing, in unsteady and in quasi-steady air.
#[test]
fn val_split_does_not_matter() {
    for fidelity in [Fidelity::Unsteady, Fidelity::QuasiSteady] {
        let [a, b] = [Split::ApparentMass, Split::Theodorsen].map(|split| {
            let aircraft = flexible(&Elasticity { split, ..two_modes() });
            let equations = EquationsOfMotion::new(&aircraft, jig(fidelity)).unwrap();
            let n = equations.layout().n_states();
            let mut x: Vec<f64> = (0..n).map(|i| 0.3 * (i as f64 + 0.5).sin()).collect();
            x[0] = 150.0;
            x[equations.layout().altitude()] = 5_000.0;
            let mut xdot = vec![0.0; n];
            equations
                .derivative(&x, &[0.02, 4e4], &mut equations.workspace(), &mut xdot)
                .unwrap();
            xdot
        });
        assert!(largest_difference(&a, &b) < 1e-13, "{fidelity:?}");
    }
}
