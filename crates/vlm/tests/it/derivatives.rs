//! Derivatives against central differences of the solution.

use albatross_avl::results::{StabilityColumn, StabilityDerivatives};
use albatross_avl::run::{RunTarget, RunVariable};
use albatross_vlm::{Condition, Method, Solver, Trim, TrimAxes};

use crate::models::{aircraft, lattice};

/// Stability-axis coefficients as a list.
fn values(s: &StabilityDerivatives) -> [f64; 6] {
    let r = &s.run;
    [
        r.c_lift,
        r.c_y,
        r.c_drag,
        r.c_roll_stability,
        r.c_m,
        r.c_n_stability,
    ]
}

fn column(c: &StabilityColumn) -> [f64; 6] {
    [c.lift, c.side_force, c.drag.unwrap(), c.roll, c.pitch, c.yaw]
}

/// A condition from alpha, beta and rates in stability axes, controls, design variable.
fn condition(x: &[f64]) -> Condition {
    let (s, c) = x[0].sin_cos();
    Condition {
        alpha_rad: x[0],
        beta_rad: x[1],
        pb_2v: x[2] * c - x[4] * s,
        qc_2v: x[3],
        rb_2v: x[2] * s + x[4] * c,
        controls: x[5..9].to_vec(),
        designs: vec![x[9]],
    }
}

#[test]
fn val_stability_derivatives_are_the_limits_of_differences() {
    let body = "BODY\nfuse\n12 1.0\nTRANSLATE\n-1 0 0\nBFILE\nfuse.dat\n";
    let text = aircraft() + body;
    let (geometry, _) = albatross_avl::geometry::Geometry::parse(&text, "a").unwrap();
    let fuse = "fuse\n6 0\n5 0.2\n3 0.3\n1 0.25\n0.2 0.12\n0 0\n0.2 -0.12\n1 -0.25\n3 -0.3\n5 -0.2\n6 0\n";
    let (mut lattice, _) = albatross_vlm::Lattice::new(&geometry, &|_| Some(fuse.to_owned())).unwrap();
    lattice.cd_p = 0.02;
    let x0 = [0.06, 0.05, 0.03, 0.01, -0.02, 3.0, -2.0, 1.0, 4.0, 0.5];
    for method in [Method::AVL_352, Method::AVL_332] {
        let method = Method {
            printed_derivatives: false,
            ..method
        };
        let solver = Solver::new(&lattice, &method, 0.4).unwrap();
        let st = |x: &[f64]| solver.solve(&condition(x)).unwrap().stability_derivatives("");
        let base = st(&x0);
        let mut exact = vec![
            column(&base.alpha),
            column(&base.beta),
            column(&base.roll_rate),
            column(&base.pitch_rate),
            column(&base.yaw_rate),
        ];
        exact.extend(
            base.controls
                .iter()
                .chain(&base.designs)
                .map(|c| column(&c.column)),
        );
        let mut worst: f64 = 0.0;
        for (k, exact) in exact.iter().enumerate() {
            // AVL up to 3.40 leaves part of the controls' derivatives out.
            if method.frozen_velocity && k >= 5 {
                continue;
            }
            let h = if k >= 5 { 1e-2 } else { 1e-4 };
            let (mut up, mut down) = (x0, x0);
            up[k] += h;
            down[k] -= h;
            let (up, down) = (values(&st(&up)), values(&st(&down)));
            let size = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (i, exact) in exact.iter().enumerate() {
                let difference = (up[i] - down[i]) / (2.0 * h);
                worst = worst.max((difference - exact).abs() / size);
            }
        }
        println!("worst relative difference {worst:e}");
        // Truncation of the differences is h^2 of 1e-8.
        assert!(worst < 1e-7, "{worst:e}");
    }
}

#[test]
fn val_trefftz_derivatives_are_the_limits_of_differences() {
    let lattice = lattice(&aircraft());
    let solver = Solver::new(&lattice, &Method::AVL_352, 0.0).unwrap();
    let mut condition = Condition::at_alpha_deg(4.0, &lattice);
    condition.beta_rad = 0.03;
    let at = |c: &Condition| solver.solve(c).unwrap().trefftz;
    let base = solver.solve(&condition).unwrap().stability_derivatives("");
    for (k, control) in base.controls.iter().enumerate() {
        let (mut up, mut down) = (condition.clone(), condition.clone());
        up.controls[k] += 1e-3;
        down.controls[k] -= 1e-3;
        let (up, down) = (at(&up), at(&down));
        let drag = (up.c_drag - down.c_drag) / 2e-3;
        let e = (up.span_efficiency - down.span_efficiency) / 2e-3;
        assert!((drag - control.column.trefftz_drag.unwrap()).abs() < 1e-9);
        assert!((e - control.column.span_efficiency.unwrap()).abs() < 1e-8);
    }
}

#[test]
fn val_strip_slopes_sum_to_the_derivative_by_a_common_incidence() {
    // A design variable that turns every section of the wing turns every strip of it.
    let text = aircraft().replace("DESIGN\ntwist 0.0", "DESIGN\ntwist 1.0");
    let text = text.replacen(
        "0.6 3 0.3 0.8 0\nNACA\n2412\n",
        "0.6 3 0.3 0.8 0\nNACA\n2412\nDESIGN\ntwist 1.0\n",
        1,
    );
    let lattice = lattice(&text);
    let solver = Solver::new(&lattice, &Method::AVL_352, 0.5).unwrap();
    let mut condition = Condition::at_alpha_deg(3.0, &lattice);
    condition.beta_rad = 0.02;
    let wing: Vec<usize> = (0..lattice.surfaces[1].strips.end).collect();
    let slopes = solver.strip_slopes(&condition, &wing).unwrap();
    let c_cl = |g: f64| -> Vec<f64> {
        let mut c = condition.clone();
        c.designs[0] = g;
        let forces = solver.solve(&c).unwrap().strip_forces();
        forces.strips().map(|s| s.c_cl).collect()
    };
    let h = 0.01;
    let (up, down) = (c_cl(h), c_cl(-h));
    for (row, (u, d)) in up.iter().zip(&down).enumerate() {
        let difference = (u - d) / (2.0 * h.to_radians());
        let sum: f64 = (0..wing.len()).map(|k| slopes[(row, k)]).sum();
        assert!((difference - sum).abs() < 1e-6, "{row}: {difference} {sum}");
    }
    // A strip lifts itself most.
    for k in 0..wing.len() {
        assert!((0..wing.len()).all(|r| slopes[(r, k)] <= slopes[(k, k)]));
    }
}

#[test]
fn val_trim_reaches_all_targets_in_both_axes() {
    let lattice = lattice(&aircraft());
    let solver = Solver::new(&lattice, &Method::AVL_352, 0.3).unwrap();
    let control = |name: &str| RunVariable::Control(name.to_owned());
    for axes in [TrimAxes::Stability, TrimAxes::Body] {
        let mut trim = Trim::new(&lattice);
        trim.axes = axes;
        for (variable, target, value) in [
            (RunVariable::Alpha, RunTarget::Lift, 0.6),
            (RunVariable::Beta, RunTarget::Beta, 4.0),
            (RunVariable::RollRate, RunTarget::RollRate, 0.02),
            (control("elevator"), RunTarget::PitchMoment, 0.01),
            (control("aileron"), RunTarget::RollMoment, 0.0),
            (control("rudder"), RunTarget::YawMoment, 0.002),
            (control("flap"), RunTarget::Control("flap".to_owned()), 5.0),
        ] {
            trim.set(&lattice, &variable, target, value).unwrap();
        }
        let s = solver.trim(&trim).unwrap();
        let run = s.run_state("");
        let (roll, yaw, rate) = match axes {
            TrimAxes::Stability => (run.c_roll_stability, run.c_n_stability, run.pb_2v_stability),
            TrimAxes::Body => (run.c_roll, run.c_n, run.pb_2v),
        };
        for (found, wanted) in [
            (run.c_lift, 0.6),
            (run.beta_deg, 4.0),
            (rate, 0.02),
            (run.c_m, 0.01),
            (roll, 0.0),
            (yaw, 0.002),
            (run.controls[0].value, 5.0),
        ] {
            assert!((found - wanted).abs() < 1e-10, "{axes:?}: {found} {wanted}");
        }
    }
}
