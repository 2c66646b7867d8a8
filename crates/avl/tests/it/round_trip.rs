//! What is written reads back the same.

use albatross_avl::geometry::Geometry;
use albatross_avl::mass::MassFile;
use albatross_avl::results::*;
use albatross_avl::run::RunFile;

use crate::support::{fixture_text, third_party};

#[test]
fn val_written_outputs_are_avls_own_byte_for_byte() {
    let text = fixture_text("f25-like/avl_out/trim.st");
    assert_eq!(
        StabilityDerivatives::parse(&text, "trim.st")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
    let text = fixture_text("f25-like/avl_out/alpha2.st");
    assert_eq!(
        StabilityDerivatives::parse(&text, "alpha2.st")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
    for name in ["trim.ft", "alpha0.ft"] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        assert_eq!(RunState::parse(&text, name).unwrap().to_text().unwrap(), text);
    }
    for name in ["alpha0.fs", "alpha1.fs", "alpha2.fs", "alpha4.fs", "trim.fs"] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        assert_eq!(
            StripForces::parse(&text, name).unwrap().to_text().unwrap(),
            text,
            "{name}"
        );
    }
    let Some(text) = third_party("avl/overflow_out/hershey_overflow.fs") else {
        return;
    };
    assert_eq!(
        StripForces::parse(&text, "hershey.fs")
            .unwrap()
            .to_text()
            .unwrap(),
        text
    );
}

#[test]
fn val_a_written_run_file_is_avls_own_byte_for_byte() {
    let Some(text) = third_party("avl/overflow_out/hershey_overflow.run") else {
        return;
    };
    let (run, remarks) = RunFile::parse(&text, "hershey.run").unwrap();
    assert!(remarks.is_empty());
    assert_eq!(run.to_text().unwrap(), text);
}

#[test]
fn input_files_of_the_surrogate_read_back_the_same() {
    let (geometry, _) = Geometry::parse(&fixture_text("f25-like/f25.avl"), "f25.avl").unwrap();
    let (again, _) = Geometry::parse(&geometry.to_text().unwrap(), "again.avl").unwrap();
    assert_eq!(again, geometry);
    let (mass, _) = MassFile::parse(&fixture_text("f25-like/f25.mass"), "f25.mass").unwrap();
    let (again, _) = MassFile::parse(&mass.to_text().unwrap(), "again.mass").unwrap();
    assert_eq!(again, mass);
}

mod properties {
    use albatross_avl::geometry::*;
    use albatross_avl::mass::{MassFile, MassItem, Unit};
    use albatross_avl::results::*;
    use albatross_avl::run::*;
    use proptest::collection::vec;
    use proptest::option;
    use proptest::prelude::*;

    /// Any finite number that a user may write.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            -1e3..1e3,
            Just(0.0),
            Just(-0.0),
            any::<f64>().prop_filter("finite", |v| v.is_finite())
        ]
    }

    fn vector() -> impl Strategy<Value = [f64; 3]> {
        [number(), number(), number()]
    }

    /// A name without the characters that end a line or start a comment.
    fn name() -> impl Strategy<Value = String> {
        "[A-Za-z0-9_][A-Za-z0-9_ .#()-]{0,20}[A-Za-z0-9_]"
    }

    fn word() -> impl Strategy<Value = String> {
        "[A-Za-z0-9_-]{1,16}"
    }

    fn spacing() -> impl Strategy<Value = Option<Spacing>> {
        option::of((1_usize..400, number()).prop_map(|(count, distribution)| Spacing { count, distribution }))
    }

    fn x_range() -> impl Strategy<Value = Option<[f64; 2]>> {
        option::of([0.0..0.5, 0.5..1.0])
    }

    fn airfoil() -> impl Strategy<Value = Airfoil> {
        prop_oneof![
            Just(Airfoil::Flat),
            ("[0-9]{4}", x_range()).prop_map(|(digits, x_range)| Airfoil::Naca { digits, x_range }),
            (vec([number(), number()], 3..9), x_range())
                .prop_map(|(points, x_range)| Airfoil::Inline { points, x_range }),
            ("[a-z/]{1,9}( [a-z]{1,5})?\\.dat", x_range())
                .prop_map(|(path, x_range)| Airfoil::File { path, x_range }),
        ]
    }

    fn polar() -> impl Strategy<Value = Option<DragPolar>> {
        option::of((vector(), vector()).prop_map(|(mut cl, cd)| {
            cl.sort_by(f64::total_cmp);
            DragPolar { cl, cd }
        }))
    }

    fn control() -> impl Strategy<Value = Control> {
        (word(), number(), number(), vector(), number()).prop_map(
            |(name, gain, x_hinge, hinge_axis, sgn_dup)| Control {
                name,
                gain,
                x_hinge,
                hinge_axis,
                sgn_dup,
            },
        )
    }

    fn design() -> impl Strategy<Value = Design> {
        (word(), number()).prop_map(|(name, weight)| Design { name, weight })
    }

    fn section() -> impl Strategy<Value = Section> {
        let place = (vector(), number(), number(), spacing());
        let shape = (
            airfoil(),
            0.01..1.99,
            polar(),
            vec(control(), 0..3),
            vec(design(), 0..2),
        );
        (place, shape).prop_map(
            |(([x_le, y_le, z_le], chord, a_inc_deg, spanwise), (airfoil, claf, cdcl, controls, designs))| {
                Section {
                    x_le,
                    y_le,
                    z_le,
                    chord,
                    a_inc_deg,
                    spanwise,
                    airfoil,
                    claf,
                    cdcl,
                    controls,
                    designs,
                }
            },
        )
    }

    fn surface() -> impl Strategy<Value = Surface> {
        let head = (name(), 1_usize..99, number(), spacing(), option::of(-9..99));
        let place = (option::of(0.5..2.0), vector(), vector(), number());
        let flags = (any::<bool>(), any::<bool>(), any::<bool>());
        (head, place, flags, polar(), vec(section(), 2..5)).prop_map(
            |(head, place, flags, cdcl, sections)| Surface {
                name: head.0,
                n_chord: head.1,
                c_space: head.2,
                spanwise: head.3,
                component: head.4,
                y_duplicate: place.0,
                scale: place.1,
                translate: place.2,
                angle_deg: place.3,
                no_wake: flags.0,
                no_albe: flags.1,
                no_load: flags.2,
                cdcl,
                sections,
            },
        )
    }

    fn body() -> impl Strategy<Value = Body> {
        let section = (vector(), number(), number()).prop_map(|(centre, radius_y, radius_z)| BodySection {
            centre,
            radius_y,
            radius_z,
        });
        let place = (
            option::of(number()),
            vector(),
            vector(),
            option::of("[a-z]{1,9}( [a-z]{1,5})?"),
        );
        (name(), 1_usize..99, number(), place, vec(section, 0..3)).prop_map(
            |(name, count, distribution, (y_duplicate, scale, translate, file), sections)| Body {
                name,
                spacing: Spacing { count, distribution },
                y_duplicate,
                scale,
                translate,
                file,
                sections,
            },
        )
    }

    fn geometry() -> impl Strategy<Value = Geometry> {
        let reference = ([1e-6..1e6, 1e-6..1e6, 1e-6..1e6], vector());
        let core = option::of(
            vector().prop_map(|[chord_fraction, width_fraction, source_fraction]| CoreRadii {
                chord_fraction,
                width_fraction,
                source_fraction,
            }),
        );
        let head = (name(), number(), -1..=1_i32, number(), option::of(number()), core);
        (head, reference, vec(surface(), 0..3), vec(body(), 0..2)).prop_map(
            |(head, reference, surfaces, bodies)| {
                let ([s_ref, c_ref, b_ref], [x_ref, y_ref, z_ref]) = reference;
                Geometry {
                    title: head.0,
                    mach: head.1,
                    i_ysym: 0,
                    i_zsym: head.2,
                    z_sym: head.3,
                    s_ref,
                    c_ref,
                    b_ref,
                    x_ref,
                    y_ref,
                    z_ref,
                    cd_p: head.4,
                    core: head.5,
                    surfaces,
                    bodies,
                }
            },
        )
    }

    /// A number that `Fw.d` prints exactly: whole multiples of the last decimal.
    fn decimal(range: std::ops::Range<i32>, unit: f64) -> impl Strategy<Value = f64> {
        // Nearest double of the printed decimal.
        range.prop_map(move |n| format!("{:.7}", f64::from(n) * unit).parse().unwrap())
    }

    fn column(full: bool) -> impl Strategy<Value = StabilityColumn> {
        let v = || decimal(-9_999_999..9_999_999, 1e-6);
        ([v(), v(), v(), v(), v(), v()], [v(), v()]).prop_map(move |([a, b, c, d, e, f], [g, h])| {
            StabilityColumn {
                lift: a,
                side_force: b,
                drag: Some(c),
                roll: d,
                pitch: e,
                yaw: f,
                trefftz_drag: full.then_some(g),
                span_efficiency: full.then_some(h),
            }
        })
    }

    fn run_state(n: usize, m: usize) -> impl Strategy<Value = RunState> {
        let v = || decimal(-99_999..99_999, 1e-5);
        let five = vec(v(), 21 + n + m);
        (
            five,
            word(),
            decimal(0..9999, 1e-3),
            decimal(0..9999, 1e-4),
            decimal(0..99_999, 1e-7),
        )
            .prop_map(move |(v, title, mach, span_efficiency, induced)| RunState {
                title,
                n_surfaces: 3,
                n_strips: 40,
                n_vortices: 9999,
                reference: Reference {
                    s_ref: 130.1,
                    c_ref: 3.3465,
                    b_ref: 45.0,
                    x_ref: 0.5,
                    y_ref: 0.0,
                    z_ref: -4e-5,
                },
                axes: AxisOrientation::Geometric,
                run_case: "cruise".to_owned(),
                alpha_deg: v[0],
                beta_deg: v[1],
                mach,
                pb_2v: v[2],
                qc_2v: v[3],
                rb_2v: v[4],
                pb_2v_stability: v[5],
                rb_2v_stability: v[6],
                c_x: v[7],
                c_y: v[8],
                c_z: v[9],
                c_roll: v[10],
                c_m: v[11],
                c_n: v[12],
                c_roll_stability: v[13],
                c_n_stability: v[14],
                c_lift: v[15],
                c_drag: v[16],
                c_drag_viscous: v[17],
                c_drag_induced: induced,
                c_lift_trefftz: v[18],
                c_drag_trefftz: induced,
                c_y_trefftz: v[19],
                span_efficiency,
                controls: (0..n)
                    .map(|k| NamedValue {
                        name: format!("control number{k:02}"),
                        value: v[20 + k],
                    })
                    .collect(),
                designs: (0..m)
                    .map(|k| NamedValue {
                        name: format!("d{k}"),
                        value: v[20 + n + k],
                    })
                    .collect(),
            })
    }

    fn named(columns: Vec<StabilityColumn>, values: &[NamedValue]) -> Vec<NamedColumn<StabilityColumn>> {
        columns
            .into_iter()
            .zip(values)
            .map(|(column, v)| NamedColumn {
                name: v.name.clone(),
                column,
            })
            .collect()
    }

    fn derivatives() -> impl Strategy<Value = StabilityDerivatives> {
        (0_usize..25, 0_usize..3).prop_flat_map(|(n, m)| {
            let columns = (
                column(false),
                column(false),
                column(false),
                column(false),
                column(false),
            );
            let x = || option::of(decimal(-9_999_999..9_999_999, 1e-6));
            (
                run_state(n, m),
                columns,
                vec(column(true), n),
                vec(column(true), m),
                x(),
                x(),
            )
                .prop_map(
                    |(
                        run,
                        (alpha, beta, roll_rate, pitch_rate, yaw_rate),
                        c,
                        d,
                        neutral_point_x,
                        spiral_ratio,
                    )| {
                        let (controls, designs) = (named(c, &run.controls), named(d, &run.designs));
                        StabilityDerivatives {
                            run,
                            alpha,
                            beta,
                            roll_rate,
                            pitch_rate,
                            yaw_rate,
                            controls,
                            designs,
                            neutral_point_x,
                            spiral_ratio,
                        }
                    },
                )
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn prop_geometry_reads_back_what_was_written(g in geometry()) {
            let text = g.to_text().unwrap();
            let (again, _) = Geometry::parse(&text, "again.avl").map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
            prop_assert_eq!(again, g);
        }

        #[test]
        fn prop_mass_reads_back_what_was_written(
            items in vec((number(), vector(), vector(), vector(), "([a-z]{1,9})?"), 1..6),
            units in [1e-6..1e6, 1e-6..1e6, 1e-6..1e6],
            constants in (option::of(number()), option::of(number())),
        ) {
            let unit = |factor, name: &str| Unit { factor, name: name.to_owned() };
            let file = MassFile {
                length_unit: unit(units[0], "ft"),
                mass_unit: unit(units[1], "slug"),
                time_unit: unit(units[2], "s"),
                gravity: constants.0,
                density: constants.1,
                items: items
                    .into_iter()
                    .map(|(mass, position, moments, products, comment)| MassItem { mass, position, moments, products, comment })
                    .collect(),
            };
            let (again, remarks) = MassFile::parse(&file.to_text().unwrap(), "again.mass").unwrap();
            prop_assert_eq!(again, file);
            prop_assert!(remarks.is_empty());
        }

        #[test]
        fn prop_run_reads_back_what_was_written(
            title in "([A-Za-z][A-Za-z0-9 ]{0,20}[a-z0-9])?",
            values in vec(number().prop_map(|v| format!("{v:.5e}").parse::<f64>().unwrap()), 12),
            name in "K[a-z_]{0,8}",
        ) {
            let targets = [RunTarget::Lift, RunTarget::PitchMoment, RunTarget::YawMoment, RunTarget::Control(name.clone())];
            let variables = [RunVariable::Alpha, RunVariable::Beta, RunVariable::YawRate, RunVariable::Control(name)];
            let constraints = variables.into_iter().zip(targets).zip(&values)
                .map(|((variable, target), &value)| Constraint { variable, target, value })
                .collect();
            let parameters = [Parameter::Velocity, Parameter::Izx, Parameter::ViscousMomentAlpha, Parameter::ViscousMomentSpeed]
                .into_iter().zip(&values[4..])
                .map(|(parameter, &value)| ParameterValue { parameter, value, unit: "m/s".to_owned() })
                .collect();
            let file = RunFile { cases: vec![RunCase { index: 7, title, constraints, parameters }] };
            let text = file.to_text().unwrap();
            let (again, _) = RunFile::parse(&text, "again.run").map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
            prop_assert_eq!(again, file);
        }

        #[test]
        fn prop_derivatives_read_back_what_was_written(st in derivatives()) {
            let text = st.to_text().unwrap();
            let again = StabilityDerivatives::parse(&text, "again.st").map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
            prop_assert_eq!(&again, &st);
            let head = st.run.to_text().unwrap();
            prop_assert_eq!(RunState::parse(&head, "again.ft").unwrap(), st.run);
        }

        #[test]
        fn prop_strips_read_back_what_was_written(
            rows in vec((vec(decimal(-9_999_999..9_999_999, 1e-4), 13), option::of(decimal(-1000..2000, 1e-3))), 1..9),
        ) {
            let strips: Vec<Strip> = rows.iter().enumerate().map(|(k, (v, xcp))| Strip {
                index: k + 1,
                x_le: Some(v[0]),
                y_le: v[1],
                z_le: Some(v[2]),
                chord: v[3],
                area: v[4],
                c_cl: v[5],
                ai: v[6],
                cl_norm: v[7],
                cl: v[8],
                cd: v[9],
                cdv: v[10],
                cm_c4: v[11],
                cm_le: Some(v[12]),
                xcp: *xcp,
            }).collect();
            let surface = StripSurface {
                index: 1,
                name: "Wing".to_owned(),
                n_chord: 4,
                n_span: strips.len(),
                first_strip: 1,
                area: 2.5,
                average_chord: 0.5,
                strips,
                ..Default::default()
            };
            let fs = StripForces {
                axes: AxisOrientation::Standard,
                reference: Some(Reference { s_ref: 2.5, c_ref: 0.5, b_ref: 5.0, ..Default::default() }),
                surfaces: vec![surface],
            };
            // Fourteen numbers of eight columns: what does not fit is refused, never cut.
            match fs.to_text() {
                Ok(text) => prop_assert_eq!(StripForces::parse(&text, "again.fs").unwrap(), fs),
                Err(e) => {
                    let refused = matches!(e, albatross_avl::AvlError::DoesNotFit { .. });
                    prop_assert!(refused, "{}", e);
                }
            }
        }
    }
}
