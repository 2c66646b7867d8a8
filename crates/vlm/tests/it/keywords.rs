//! What keywords of the geometry file do to the lattice.

use albatross_avl::geometry::Geometry;
use albatross_vlm::{Lattice, Method, Solver};

use crate::models::{at_alpha, header, lattice, surface};

fn wing(keywords: &str, section: &str) -> String {
    header("0 0 0", 6.0, 1.0, 6.0, 0.25)
        + &surface(
            "w",
            "4 1 8 -1",
            &format!("YDUPLICATE\n0\n{keywords}"),
            &[&format!("0 0 0 1 0\n{section}"), &format!("0 3 0 1 0\n{section}")],
        )
}

#[test]
fn val_no_wake_has_moment_but_no_lift() {
    at_alpha(&lattice(&wing("NOWAKE", "")), 4.0, |s| {
        let run = s.run_state("");
        // No circulation leaves the strips; what remains is of second order in the angle.
        assert!(
            run.c_lift_trefftz.abs() < 1e-12 && run.c_lift.abs() < 5e-3,
            "{}",
            run.c_lift
        );
        assert!(run.c_m > 0.02);
    });
}

#[test]
fn val_no_load_is_left_out_and_no_albe_sees_no_wind() {
    at_alpha(&lattice(&wing("NOLOAD", "")), 4.0, |s| {
        assert_eq!((s.c_lift(), s.trefftz.c_lift), (0.0, 0.0));
        assert!(s.surface_forces().surfaces[0].c_lift > 0.1);
    });
    at_alpha(&lattice(&wing("NOALBE", "")), 4.0, |s| {
        assert_eq!(s.c_lift(), 0.0)
    });
}

#[test]
fn val_claf_scales_the_section_slope() {
    let slope = |claf: f64| {
        let text = header("0 0 0", 2000.0, 1.0, 2000.0, 0.25)
            + &surface(
                "w",
                "1 0 10 1",
                "YDUPLICATE\n0",
                &[
                    &format!("0 0 0 1 0\nCLAF\n{claf}"),
                    &format!("0 1000 0 1 0\nCLAF\n{claf}"),
                ],
            );
        at_alpha(&lattice(&text), 1.0, |s| {
            s.strip_forces().surfaces[0].strips[0].cl
        })
    };
    // One vortex at c/4 with the control point at (1/4 + claf/2) c: exactly proportional in two dimensions.
    assert!((slope(1.1) / slope(1.0) - 1.1).abs() < 1e-3);
}

#[test]
fn val_flat_polar_is_the_profile_drag() {
    at_alpha(&lattice(&wing("", "CDCL\n-1 0.01 0 0.01 1 0.01")), 2.0, |s| {
        let run = s.run_state("");
        assert!(
            (run.c_drag_viscous - 0.01).abs() < 1e-12,
            "{}",
            run.c_drag_viscous
        );
    });
    let plain = at_alpha(&lattice(&wing("", "")), 2.0, |s| s.run_state("").c_drag_induced);
    at_alpha(&lattice(&wing("", "CDCL\n-1 0.03 0 0.01 1 0.03")), 2.0, |s| {
        let run = s.run_state("");
        let strip = s.strip_forces().surfaces[0].strips[2];
        assert!((strip.cdv - (0.01 + 0.02 * strip.cl * strip.cl)).abs() < 1e-5);
        assert!((run.c_drag_induced - plain).abs() < 1e-12);
    });
}

#[test]
fn val_cores_act_between_components_only() {
    let two = |component: &str| {
        let tail = surface(
            "tail",
            "3 1 6 -1",
            &format!("YDUPLICATE\n0\nTRANSLATE\n4 0 0.1\n{component}"),
            &["0 0 0 0.5 0", "0 1 0 0.5 0"],
        );
        wing("COMPONENT\n1", "") + &tail
    };
    let c_m = |text: &str, method: &Method| {
        let lattice = lattice(text);
        let solver = Solver::new(&lattice, method, 0.0).unwrap();
        let condition = albatross_vlm::Condition::at_alpha_deg(3.0, &lattice);
        solver.solve(&condition).unwrap().c_m()
    };
    let (new, old) = (Method::AVL_352, Method::AVL_332);
    let (one_new, one_old) = (c_m(&two("COMPONENT\n1"), &new), c_m(&two("COMPONENT\n1"), &old));
    let (two_new, two_old) = (c_m(&two("COMPONENT\n2"), &new), c_m(&two("COMPONENT\n2"), &old));
    assert!((one_new - one_old).abs() < 1e-8, "{one_new} {one_old}");
    assert!((two_new - one_new).abs() > 1e-4 && (two_new - two_old).abs() > 1e-4);
}

#[test]
fn val_closed_body_has_munks_moment_and_no_lift() {
    // Ellipsoid of revolution: dCm/dalpha = 2 volume/(Sref Cref) in slender-body theory, here with the doublet's
    // full apparent mass.
    let points: Vec<String> = (0..=80)
        .map(|k| {
            let theta = 2.0 * std::f64::consts::PI * f64::from(k) / 80.0;
            format!("{:.9} {:.9}", 3.0 * (1.0 + theta.cos()), 0.3 * theta.sin())
        })
        .collect();
    let file = format!("ellipsoid\n{}\n", points.join("\n"));
    let text = wing("", "") + "BODY\nfuse\n60 1.0\nBFILE\nfuse.dat\n";
    let (geometry, _) = Geometry::parse(&text, "b").unwrap();
    let (lattice, _) = Lattice::new(&geometry, &|_| Some(file.clone())).unwrap();
    at_alpha(&lattice, 1.0, |s| {
        let body = &s.body_forces().bodies[0];
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 3.0 * 0.3 * 0.3;
        assert!((body.volume / volume - 1.0).abs() < 2e-3, "{}", body.volume);
        let munk = 2.0 * volume / 6.0 * 1.0_f64.to_radians().sin() * 1.0_f64.to_radians().cos();
        assert!((body.c_m / munk - 1.0).abs() < 3e-3, "{} {munk}", body.c_m);
        assert!(body.c_lift.abs() < 1e-12);
    });
}

#[test]
fn regress_missing_files_are_remarks() {
    let text = wing("", "AFILE\nnone.dat") + "BODY\nfuse\n10 1.0\nBFILE\nnone.dat\n";
    let (geometry, _) = Geometry::parse(&text, "b").unwrap();
    let (lattice, remarks) = Lattice::new(&geometry, &|_| None).unwrap();
    assert_eq!((remarks.len(), lattice.bodies.len()), (3, 0), "{remarks:?}");
}

#[test]
fn prop_shear_at_the_root_is_the_sum_of_the_strips() {
    let text = header("0 0 0", 6.0, 1.0, 6.0, 0.25)
        + &surface("w", "4 1 60 0", "YDUPLICATE\n0", &["0 0 0 1 0", "1 3 0.3 0.5 -2"]);
    at_alpha(&lattice(&text), 4.0, |s| {
        let (shears, strips, loads) = (s.shear_moments(), s.strip_forces(), s.strip_loads());
        assert_eq!(loads.strips.len(), 120);
        for (shear, strips) in shears.surfaces.iter().zip(&strips.surfaces) {
            let sum: f64 = strips.strips.iter().map(|s| s.c_cl * s.area / s.chord).sum();
            let root = shear.stations.first().unwrap();
            // The trapezoidal rule loses half a strip's width of load at the ends.
            assert!(
                (root.shear * 6.0 / sum - 1.0).abs() < 5e-3,
                "{} {sum}",
                root.shear * 6.0
            );
            assert_eq!(root.moment < 0.0, shear.name.ends_with("(YDUP)"));
            assert_eq!(shear.stations.len(), strips.strips.len() + 2);
        }
    });
}
