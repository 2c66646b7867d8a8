//! Planes of symmetry, halves and images against the whole.

use albatross_vlm::{Condition, Influence, Method, Solver};
use proptest::prelude::*;

use crate::models::{aircraft, at_alpha, header, lattice, surface};

/// All numbers of an `.st` file.
fn numbers(solver: &Solver<'_>, condition: &Condition) -> Vec<f64> {
    let st = solver.solve(condition).unwrap().stability_derivatives("");
    let mut out = vec![
        st.run.c_lift,
        st.run.c_drag,
        st.run.c_m,
        st.run.c_drag_trefftz,
        st.run.c_roll,
    ];
    let columns = [st.alpha, st.beta, st.roll_rate, st.pitch_rate, st.yaw_rate];
    let controls = st.controls.iter().map(|c| c.column);
    for c in columns.into_iter().chain(controls) {
        out.extend([c.lift, c.side_force, c.drag.unwrap(), c.roll, c.pitch, c.yaw]);
    }
    out
}

#[test]
fn val_two_half_systems_are_the_whole() {
    let lattice = lattice(&aircraft());
    let mut condition = Condition::at_alpha_deg(5.0, &lattice);
    condition.beta_rad = 0.1;
    condition.pb_2v = 0.05;
    condition.controls = vec![2.0, 3.0, -1.0, 4.0];
    let halves = Influence::assemble(&lattice, &Method::AVL_352, 0.5).unwrap();
    let whole = Influence::assemble_whole(&lattice, &Method::AVL_352, 0.5).unwrap();
    let (a, b) = (halves.orders(), whole.orders());
    // The fin's twelve vortices lie in the plane of symmetry.
    assert_eq!(
        (a[0] + a[1], a[1] - a[0], b[0]),
        (b[0], 12, lattice.vortices.len())
    );
    let halves = Solver::from_factorised(halves.factorise().unwrap());
    let whole = Solver::from_factorised(whole.factorise().unwrap());
    for (x, y) in numbers(&halves, &condition)
        .iter()
        .zip(numbers(&whole, &condition))
    {
        assert!((x - y).abs() < 1e-11 * (1.0 + y.abs()), "{x} {y}");
    }
}

#[test]
fn regress_threads_change_no_bit() {
    let lattice = lattice(&aircraft());
    let condition = Condition::at_alpha_deg(5.0, &lattice);
    let run = |threads: usize| {
        let method = Method {
            threads,
            ..Method::AVL_352
        };
        numbers(&Solver::new(&lattice, &method, 0.5).unwrap(), &condition)
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert_eq!(one, run(threads));
    }
}

#[test]
fn val_plane_of_symmetry_is_the_mirrored_surface() {
    let sections = ["0 0.2 0 1 2\nNACA\n4412", "0.5 4 0.3 0.6 0\nNACA\n4412"];
    let full = header("0 0 0", 6.4, 0.8, 8.0, 0.2)
        + &surface("w", "5 1 9 -1", "YDUPLICATE\n0\nCOMPONENT\n1", &sections);
    let half = header("1 0 0", 6.4, 0.8, 8.0, 0.2) + &surface("w", "5 1 9 -1", "COMPONENT\n1", &sections);
    let take = |text: &str| {
        at_alpha(&lattice(text), 3.0, |s| {
            let st = s.stability_derivatives("");
            let c = [st.alpha, st.pitch_rate];
            let mut out = vec![st.run.c_lift, st.run.c_drag, st.run.c_m, st.run.c_lift_trefftz];
            out.extend([st.run.c_drag_trefftz, st.run.span_efficiency]);
            out.extend(c.iter().flat_map(|c| [c.lift, c.drag.unwrap(), c.pitch]));
            out
        })
    };
    for (x, y) in take(&full).iter().zip(take(&half)) {
        assert!((x - y).abs() < 1e-12 * (1.0 + y.abs()), "{x} {y}");
    }
}

#[test]
fn val_ground_is_the_wing_upside_down_below() {
    // At zero angle of attack the mirrored wing has the opposite incidence.
    let wing = |name: &str, z: f64, angle: f64| {
        surface(
            name,
            "4 1 10 -1",
            &format!("YDUPLICATE\n0\nCOMPONENT\n1\nANGLE\n{angle}\nTRANSLATE\n0 0 {z}"),
            &["0 0 0 1 0", "0.3 3 0 0.7 0"],
        )
    };
    let ground = header("0 1 -1.0", 5.1, 0.85, 6.0, 0.25) + &wing("w", 0.0, 4.0);
    let explicit = header("0 0 0", 5.1, 0.85, 6.0, 0.25) + &wing("w", 0.0, 4.0) + &wing("below", -2.0, -4.0);
    let of_wing = |text: &str| {
        at_alpha(&lattice(text), 0.0, |s| {
            let f = &s.surface_forces().surfaces[0];
            let row = s.strip_forces().surfaces[0].strips[3];
            [f.c_lift, f.c_drag, f.c_m, row.cl, row.ai]
        })
    };
    for (x, y) in of_wing(&ground).iter().zip(of_wing(&explicit)) {
        assert!((x - y).abs() < 1e-12, "{x} {y}");
    }
    // Near the ground a wing lifts more, far from it as in free air.
    let far = header("0 1 -1e5", 5.1, 0.85, 6.0, 0.25) + &wing("w", 0.0, 4.0);
    let free = header("0 0 0", 5.1, 0.85, 6.0, 0.25) + &wing("w", 0.0, 4.0);
    let (near, far, free) = (of_wing(&ground), of_wing(&far), of_wing(&free));
    assert!(near[0] > 1.02 * free[0] && (far[0] - free[0]).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Mirroring wing and sideslip mirrors the forces.
    #[test]
    fn prop_mirrored_flow(sweep in -0.5..1.0_f64, dihedral in -0.4..0.4_f64, taper in 0.3..1.2_f64,
                          beta in -0.2..0.2_f64, alpha in -6.0..8.0_f64) {
        let text = header("0 0 0", 5.0, 1.0, 6.0, 0.2)
            + &surface("w", "3 1 6 -1", "YDUPLICATE\n0",
                       &["0 0 0 1 1\nCONTROL\nail 1 0.7 0 0 0 -1",
                         &format!("{sweep} 3 {dihedral} {taper} 0\nCONTROL\nail 1 0.7 0 0 0 -1")]);
        let lattice = lattice(&text);
        let solver = Solver::new(&lattice, &Method::AVL_352, 0.0).unwrap();
        let run = |sign: f64| {
            let mut c = Condition::at_alpha_deg(alpha, &lattice);
            (c.beta_rad, c.controls[0], c.pb_2v) = (sign * beta, sign * 3.0, sign * 0.04);
            solver.solve(&c).unwrap().run_state("")
        };
        let (a, b) = (run(1.0), run(-1.0));
        for (x, y) in [(a.c_lift, b.c_lift), (a.c_drag, b.c_drag), (a.c_m, b.c_m),
                       (a.c_y, -b.c_y), (a.c_roll, -b.c_roll), (a.c_n, -b.c_n)] {
            prop_assert!((x - y).abs() < 1e-12, "{x} {y}");
        }
    }
}
