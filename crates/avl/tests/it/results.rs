//! Output files of AVL 3.52: the F25-like surrogate, and the Hershey wing with its overflows.

use albatross_avl::AvlError;
use albatross_avl::results::*;

use crate::support::{fixture_text, third_party};

const OUT: &str = "f25-like/avl_out";

fn text(name: &str) -> String {
    fixture_text(&format!("{OUT}/{name}"))
}

#[test]
fn val_total_forces_of_the_trimmed_aircraft() {
    let state = RunState::parse(&text("trim.ft"), "trim.ft").unwrap();
    assert_eq!(state.title, "DLR-F25 surrogate (own model, not DLR data)");
    assert_eq!(
        (state.n_surfaces, state.n_strips, state.n_vortices),
        (7, 220, 5274)
    );
    let r = state.reference;
    assert_eq!((r.s_ref, r.c_ref, r.b_ref), (130.10, 3.3465, 45.0));
    assert_eq!((r.x_ref, r.y_ref, r.z_ref), (20.344, 0.0, -0.42768));
    assert_eq!(state.axes, AxisOrientation::Standard);
    assert_eq!(state.run_case, "-unnamed-");
    assert_eq!(
        (state.alpha_deg, state.beta_deg, state.mach),
        (1.33236, 0.0, 0.692)
    );
    assert_eq!((state.c_x, state.c_z, state.c_m), (-0.01559, -0.56492, 0.0));
    assert_eq!((state.c_lift, state.c_drag), (0.56440, 0.02872));
    assert_eq!(
        (state.c_drag_viscous, state.c_drag_induced),
        (0.02090, 0.007_823_3)
    );
    assert_eq!((state.c_lift_trefftz, state.c_drag_trefftz), (0.56372, 0.007_914));
    assert_eq!(state.span_efficiency, 0.8212);
    let names: Vec<&str> = state.controls.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["aileron_in", "aileron_out", "elevator", "rudder"]);
    assert_eq!(state.control("elevator"), Some(-0.01128));
    assert!(state.designs.is_empty());
    // Lift and drag from the body forces: an identity between the printed numbers.
    let (s, c) = state.alpha_deg.to_radians().sin_cos();
    assert!((-state.c_z * c + state.c_x * s - state.c_lift).abs() < 2e-5);
}

#[test]
fn val_stability_derivatives_of_the_trimmed_aircraft() {
    let st = StabilityDerivatives::parse(&text("trim.st"), "trim.st").unwrap();
    let get = |c, v| st.get(c, v).unwrap();
    assert_eq!(get(Coefficient::Lift, Variable::Alpha), 7.296_941);
    assert_eq!(get(Coefficient::Roll, Variable::Alpha), 0.0);
    assert_eq!(get(Coefficient::Roll, Variable::RollRate), -0.623_841);
    assert_eq!(get(Coefficient::Lift, Variable::PitchRate), 17.920_802);
    assert_eq!(get(Coefficient::Pitch, Variable::PitchRate), -93.920_296);
    assert_eq!(get(Coefficient::Drag, Variable::Alpha), 0.203_040);
    assert_eq!(get(Coefficient::Yaw, Variable::YawRate), -0.154_563);
    let elevator = st.control("elevator").unwrap();
    assert_eq!((elevator.lift, elevator.pitch), (0.012_832, -0.076_567));
    assert_eq!(
        (elevator.trefftz_drag, elevator.span_efficiency),
        (Some(0.000_514), Some(-0.016_097))
    );
    assert_eq!(get(Coefficient::Yaw, Variable::Control(3)), 0.002_082);
    assert_eq!(st.get(Coefficient::TrefftzDrag, Variable::Alpha), None);
    assert_eq!(st.get(Coefficient::Lift, Variable::Control(4)), None);
    assert_eq!(st.neutral_point_x, Some(21.874_986));
    assert_eq!(st.spiral_ratio, Some(1.805_952));
    // Xnp = Xref - Cref Cma / CLa, from the printed five digits of Xref and Cref.
    let r = st.run.reference;
    let x_np = r.x_ref - r.c_ref * st.alpha.pitch / st.alpha.lift;
    assert!((x_np - 21.874_986).abs() < 6e-4);
    let ratio = st.beta.roll * st.yaw_rate.yaw / (st.yaw_rate.roll * st.beta.yaw);
    assert!((ratio - 1.805_952).abs() < 1e-4);
    assert_eq!(st.run, RunState::parse(&text("trim.ft"), "trim.ft").unwrap());
}

#[test]
fn val_body_derivatives_of_the_trimmed_aircraft() {
    let sb = BodyDerivatives::parse(&text("trim.sb"), "trim.sb").unwrap();
    assert_eq!((sb.w.x, sb.w.z, sb.w.pitch), (0.530_729, -7.339_574, -3.338_356));
    assert_eq!(
        (sb.u.z, sb.v.y, sb.p.roll, sb.r.yaw),
        (-0.959_431, -0.754_835, -0.626_600, -0.151_804)
    );
    assert_eq!(sb.control("rudder").unwrap().yaw, 0.002_071);
    assert_eq!(
        sb.get(BodyCoefficient::Z, BodyVariable::Control(2)),
        Some(-0.012_840)
    );
}

#[test]
fn val_surface_forces_add_up_to_the_totals() {
    let fn_ = SurfaceForces::parse(&text("trim.fn"), "trim.fn").unwrap();
    assert_eq!(fn_.surfaces.len(), 7);
    assert_eq!(fn_.surfaces[1].name, "Wing (YDUP)");
    assert_eq!(fn_.surfaces[2].c_m, -0.0402);
    assert_eq!(
        (fn_.surfaces[2].average_chord, fn_.surfaces[2].cl_local),
        (2.490, 0.0569)
    );
    assert_eq!(fn_.surfaces[0].cm_le_local, None);
    assert_eq!(fn_.reference.x_ref, 20.3436);
    let lift: f64 = fn_.surfaces.iter().map(|s| s.c_lift).sum();
    // Seven numbers rounded to 5e-5 each.
    assert!((lift - 0.56440).abs() < 7.0 * 5e-5, "{lift}");
}

#[test]
fn val_strip_forces_add_up_to_the_surfaces() {
    for name in ["alpha0.fs", "alpha1.fs", "alpha2.fs", "alpha4.fs", "trim.fs"] {
        let fs = StripForces::parse(&text(name), name).unwrap();
        let sizes: Vec<usize> = fs.surfaces.iter().map(|s| s.strips.len()).collect();
        assert_eq!(sizes, [73, 73, 15, 15, 20, 12, 12]);
        assert_eq!(fs.strips().count(), 220);
        for surface in &fs.surfaces {
            let area: f64 = surface.strips.iter().map(|s| s.area).sum();
            assert!(
                (area - surface.area).abs() < 5e-5 * surface.strips.len() as f64,
                "{}",
                surface.name
            );
        }
    }
    let fs = StripForces::parse(&text("trim.fs"), "trim.fs").unwrap();
    assert_eq!(fs.reference.unwrap().z_ref, -0.42768);
    let wing = fs.surface("Wing").unwrap();
    assert_eq!((wing.n_chord, wing.n_span, wing.first_strip), (30, 73, 1));
    assert_eq!((wing.area, wing.average_chord), (65.261_202, 2.890_426));
    assert_eq!(
        (wing.coefficients.c_roll, wing.coefficients.cl_local),
        (-0.04970, 0.53589)
    );
    let seventh = wing.strips[6];
    assert_eq!(
        (seventh.x_le, seventh.y_le, seventh.z_le),
        (Some(15.0828), 2.1258, Some(-1.1368))
    );
    assert_eq!(
        (seventh.cl_norm, seventh.cl, seventh.xcp),
        (0.6455, 0.5275, Some(0.418))
    );
    // Lift of the wing from its strips; theirs is across their own dihedral.
    let lift: f64 = wing.strips.iter().map(|s| s.cl * s.area).sum();
    assert!((lift / wing.area / wing.coefficients.cl_local - 1.0).abs() < 1e-3);
}

#[test]
fn val_hinge_moments() {
    let hm = HingeMoments::parse(&text("trim.hm"), "trim.hm").unwrap();
    assert_eq!((hm.s_ref, hm.c_ref), (130.1, 3.3465));
    let elevator = hm.control("elevator").unwrap();
    assert_eq!(elevator.c_hinge, -0.9317e-4);
    assert_eq!(elevator.deflection_deg, Some(-0.01128));
    assert_eq!(elevator.moment_n_m, Some(-0.0));
}

#[test]
fn any_file_is_recognised_by_its_content() {
    for (name, kind) in [
        ("trim.ft", FileKind::TotalForces),
        ("trim.st", FileKind::StabilityDerivatives),
        ("trim.sb", FileKind::BodyDerivatives),
        ("trim.fn", FileKind::SurfaceForces),
        ("trim.fs", FileKind::StripForces),
        ("trim.hm", FileKind::HingeMoments),
    ] {
        assert_eq!(recognise_kind(&text(name)), Some(kind));
        parse_any(&text(name), name).unwrap();
    }
}

#[test]
fn the_wrong_kind_is_named_with_the_command_for_the_right_one() {
    let error = StabilityDerivatives::parse(&text("trim.ft"), "trim.ft").unwrap_err();
    assert_eq!(
        error.to_string(),
        "trim.ft: this is a file of total forces (.ft), but a file of stability derivatives (.st) is needed; \
         write it with OPER > ST"
    );
    let error = StripForces::parse(&text("trim.fn"), "trim.fn").unwrap_err();
    assert!(error.to_string().ends_with("write it with OPER > FS"), "{error}");
}

fn hershey(name: &str) -> Option<(String, String)> {
    third_party(&format!("avl/overflow_out/hershey_overflow.{name}"))
        .map(|t| (t, format!("hershey_overflow.{name}")))
}

#[test]
fn overflowing_fields_are_named() {
    for (name, line, column, field) in [
        ("ft", 22, 10, "CZtot"),
        ("st", 22, 10, "CZtot"),
        ("sb", 22, 10, "CZtot"),
        ("fn", 9, 13, "CL"),
    ] {
        let Some((text, file)) = hershey(name) else { return };
        match parse_any(&text, &file) {
            Err(AvlError::Overflow { at, field: found, .. }) => {
                assert_eq!(
                    (at.line, at.column, found.as_str()),
                    (line, column, field),
                    "{name}"
                );
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn val_text_and_machine_readable_forms_agree() {
    let Some((text, file)) = hershey("fs") else { return };
    let plain = StripForces::parse(&text, &file).unwrap();
    let (text, file) = hershey("mrf.fs").unwrap();
    let exact = StripForces::parse(&text, &file).unwrap();
    assert_eq!(plain.surfaces.len(), exact.surfaces.len());
    for (p, e) in plain.strips().zip(exact.strips()) {
        assert_eq!(p.index, e.index);
        for (p, e) in [
            (p.y_le, e.y_le),
            (p.c_cl, e.c_cl),
            (p.cl, e.cl),
            (p.cm_le.unwrap(), e.cm_le.unwrap()),
        ] {
            assert!((p - e).abs() <= 0.5001e-4, "{p} {e}");
        }
    }
    let (text, file) = hershey("fe").unwrap();
    let plain = ElementForces::parse(&text, &file).unwrap();
    let (text, file) = hershey("mrf.fe").unwrap();
    let exact = ElementForces::parse(&text, &file).unwrap();
    let count = |f: &ElementForces| {
        f.surfaces
            .iter()
            .flat_map(|s| &s.strips)
            .map(|s| s.elements.len())
            .sum::<usize>()
    };
    assert_eq!((count(&plain), count(&exact)), (192, 192));
    for (p, e) in plain.surfaces.iter().zip(&exact.surfaces) {
        assert_eq!(
            (&p.name, p.n_span, p.first_strip),
            (&e.name, e.n_span, e.first_strip)
        );
        for (p, e) in p.strips.iter().zip(&e.strips) {
            assert!((p.wake_downwash - e.wake_downwash).abs() <= 0.5001e-5);
            assert_eq!((p.first_vortex, p.index), (e.first_vortex, e.index));
            for (p, e) in p.elements.iter().zip(&e.elements) {
                assert!((p.delta_cp - e.delta_cp).abs() <= 0.5001e-5);
            }
        }
    }
    let (text, file) = hershey("vm").unwrap();
    let plain = ShearMoments::parse(&text, &file).unwrap();
    let (text, file) = hershey("mrf.vm").unwrap();
    let exact = ShearMoments::parse(&text, &file).unwrap();
    assert_eq!(plain.surfaces.len(), 2);
    for (p, e) in plain.surfaces.iter().zip(&exact.surfaces) {
        assert_eq!((p.stations.len(), &p.name), (26, &e.name));
        for (p, e) in p.stations.iter().zip(&e.stations) {
            assert!(
                (p.shear - e.shear).abs() <= 0.5001e-5 * p.shear.abs(),
                "{p:?} {e:?}"
            );
        }
    }
    let (text, file) = hershey("hm").unwrap();
    let plain = HingeMoments::parse(&text, &file).unwrap();
    let (text, file) = hershey("mrf.hm").unwrap();
    let exact = HingeMoments::parse(&text, &file).unwrap();
    assert_eq!(plain.controls[0].name, exact.controls[0].name);
    assert!((plain.controls[0].c_hinge / exact.controls[0].c_hinge - 1.0).abs() < 1e-4);
}

#[test]
fn val_machine_readable_derivatives_where_the_text_overflows() {
    let Some((text, file)) = hershey("mrf.st") else {
        return;
    };
    let st = StabilityDerivatives::parse(&text, &file).unwrap();
    assert_eq!(st.alpha.lift, 4.806_999_816_816_356E4);
    assert_eq!(st.pitch_rate.drag, Some(1.424_641_817_234_568E5));
    assert_eq!(
        st.control("LEflap").unwrap().span_efficiency,
        Some(5.605_427_987_193_823E-3)
    );
    assert_eq!(st.run.c_z, -4.198_197_936_127_357E3);
    assert_eq!(
        (st.neutral_point_x, st.spiral_ratio),
        (Some(4.877_447_041_459_877E-2), None)
    );
    let (text, file) = hershey("mrf.sb").unwrap();
    let sb = BodyDerivatives::parse(&text, &file).unwrap();
    assert_eq!(sb.q.pitch, -7.327_515_829_696_119E7);
    let (text, file) = hershey("mrf.fn").unwrap();
    let surfaces = SurfaceForces::parse(&text, &file).unwrap().surfaces;
    assert_eq!(surfaces[1].c_roll, 3.342_359_946_658_089E2);
    let total: f64 = surfaces.iter().map(|s| s.c_lift).sum();
    assert!((total - st.run.c_lift).abs() < 1e-9);
    for name in ["mrf.ft", "mrf.fb", "fb", "fsb", "cnc"] {
        let (text, file) = hershey(name).unwrap();
        parse_any(&text, &file).unwrap_or_else(|e| panic!("{e}"));
    }
}
