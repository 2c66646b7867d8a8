//! Closed forms of wing theory.

use std::f64::consts::PI;

use albatross_vlm::{Condition, Method, Solver};

use crate::models::{at_alpha, header, lattice, surface};

/// Rectangular wing of unit chord.
fn rectangle(span: f64, mesh: &str, section: &str) -> String {
    header("0 0 0", span, 1.0, span, 0.25)
        + &surface(
            "w",
            mesh,
            "YDUPLICATE\n0",
            &[
                &format!("0 0 0 1 {section}"),
                &format!("0 {} 0 1 {section}", 0.5 * span),
            ],
        )
}

#[test]
fn val_two_dimensional_limit_is_thin_aerofoil_theory() {
    // 2 pi per rad at mid span, for any number of chordwise elements; 2 pi/beta in compressible flow.
    for n_chord in [1, 2, 7] {
        let lattice = lattice(&rectangle(4000.0, &format!("{n_chord} 1.0 20 1.0"), "0"));
        for mach in [0.0, 0.6_f64] {
            let solver = Solver::new(&lattice, &Method::AVL_352, mach).unwrap();
            let cl = |deg: f64| {
                let s = solver.solve(&Condition::at_alpha_deg(deg, &lattice)).unwrap();
                s.strip_forces().surfaces[0].strips[0].cl
            };
            let slope = (cl(0.01) - cl(-0.01)) / 0.02_f64.to_radians();
            let theory = 2.0 * PI / (1.0 - mach * mach).sqrt();
            // The strip is 12 chords wide, the span finite: three parts in a thousand.
            assert!(
                (slope / theory - 1.0).abs() < 3e-3,
                "{n_chord} {mach}: {slope} {theory}"
            );
        }
    }
    // Zero-lift angle of the NACA 2412 mean line: -2.0774 deg (Abbott and von Doenhoff, sec. 4.3).
    let lattice = lattice(&rectangle(4000.0, "10 1.0 10 1.0", "0\nNACA\n2412"));
    at_alpha(&lattice, -2.0774, |s| {
        let strip = s.strip_forces().surfaces[0].strips[0];
        assert!(strip.cl.abs() < 2e-3, "{}", strip.cl);
        println!("cm_c4 {}", strip.cm_c4);
        // Its moment about the quarter chord: -0.0531.
        assert!((strip.cm_c4 + 0.0531).abs() < 5e-4, "{}", strip.cm_c4);
    });
}

#[test]
fn val_munk_stagger_drag_at_the_wings_is_that_in_the_trefftz_plane() {
    // Unswept biplane with equal strips: at the bound legs the velocities of any two horseshoes add up to half of
    // those far downstream, whatever the stagger, so the two drags agree to rounding but for the wake's angle.
    for (stagger, gap) in [(0.0, 1.0), (0.7, 1.0), (4.0, 0.5), (-3.0, 2.0)] {
        let wing = |name: &str, x: f64, z: f64, angle: f64| {
            surface(
                name,
                "3 1 12 0",
                &format!("YDUPLICATE\n0\nCOMPONENT\n1\nANGLE\n{angle}\nTRANSLATE\n{x} 0 {z}"),
                &["0 0 0 1 0", "0 3 0 1 0"],
            )
        };
        let text =
            header("0 0 0", 6.0, 1.0, 6.0, 0.25) + &wing("a", 0.0, 0.0, 3.0) + &wing("b", stagger, gap, 1.0);
        at_alpha(&lattice(&text), 4.0, |s| {
            let run = s.run_state("");
            // The lattice's 1/(4 pi) is AVL's, of eight digits; that of the Trefftz plane is exact.
            let digits = 0.079577472 * 4.0 * PI;
            let far = run.c_drag_trefftz * run.alpha_deg.to_radians().cos() * digits;
            assert!(
                (run.c_drag_induced - far).abs() < 1e-12,
                "{} {far}",
                run.c_drag_induced
            );
        });
    }
}

#[test]
fn val_elliptic_planform_has_the_least_drag_and_the_lift_slope_of_prandtl() {
    // Straight quarter-chord line. The strips at the tip cost some accuracy: e nears 1 with their number.
    let (span, root) = (20.0, 1.0);
    let area = PI / 4.0 * span * root;
    let aspect = span * span / area;
    let run = |n: i32| {
        let sections: Vec<String> = (0..=n)
            .map(|k| {
                let theta = 0.5 * PI * f64::from(k) / (f64::from(n) + 0.4);
                let chord = root * theta.cos();
                format!("{} {} 0 {chord} 0 1 0", -0.25 * chord, 0.5 * span * theta.sin())
            })
            .collect();
        let sections: Vec<&str> = sections.iter().map(String::as_str).collect();
        let text = header("0 0 0", area, 0.8, span, 0.0) + &surface("w", "4 1", "YDUPLICATE\n0", &sections);
        at_alpha(&lattice(&text), 2.0, |s| {
            let st = s.stability_derivatives("");
            [st.alpha.lift, st.run.span_efficiency]
        })
    };
    let (coarse, fine) = (run(20), run(40));
    let prandtl = 2.0 * PI / (1.0 + 2.0 / aspect);
    println!(
        "A = {aspect:.2}: CLa {} (Prandtl {prandtl}), e = {} and {}",
        fine[0], coarse[1], fine[1]
    );
    // Lifting-surface theory takes about 1 % off lifting-line theory at this aspect ratio.
    assert!((fine[0] / prandtl - 1.0).abs() < 0.012);
    assert!((2.0 * fine[1] - coarse[1] - 1.0).abs() < 0.004);
}

#[test]
fn val_refinement_converges() {
    let lift = |n: usize| {
        let text = rectangle(6.0, &format!("{} 1.0 {} -2.0", n, 3 * n), "0");
        at_alpha(&lattice(&text), 3.0, |s| s.stability_derivatives("").alpha.lift)
    };
    let (a, b, c) = (lift(3), lift(6), lift(12));
    let order = ((b - a) / (c - b)).abs().log2();
    println!("lift slope {a} {b} {c}, order {order:.2}");
    assert!(order > 0.9 && (c - b).abs() < 2e-2);
    // Rectangular wing of aspect ratio 6: 4.25 by Kuechemann's rule, 2 pi A/(2 + sqrt(4 + A^2)) = 4.53.
    assert!((c - 4.28).abs() < 0.1, "{c}");
}

#[test]
fn val_flap_effectiveness_is_glauerts() {
    // dcl/ddelta = 2 (pi - theta + sin theta) with the hinge at x = (1 - cos theta)/2.
    let hinge = 0.75_f64;
    let section = format!("0\nCONTROL\nflap 1.0 {hinge} 0 0 0 1");
    let lattice = lattice(&rectangle(4000.0, "48 1.0 10 1.0", &section));
    let solver = Solver::new(&lattice, &Method::AVL_352, 0.0).unwrap();
    let cl = |delta: f64| {
        let mut c = Condition::at_alpha_deg(0.0, &lattice);
        c.controls[0] = delta;
        solver.solve(&c).unwrap().strip_forces().surfaces[0].strips[0].cl
    };
    let slope = (cl(0.1) - cl(-0.1)) / 0.2_f64.to_radians();
    let theta = (1.0 - 2.0 * hinge).acos();
    let theory = 2.0 * (PI - theta + theta.sin());
    // The hinge lies within an element, whose normal turns as a whole by the fraction behind it.
    assert!((slope / theory - 1.0).abs() < 0.012, "{slope} {theory}");
}
