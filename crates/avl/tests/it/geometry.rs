//! Geometry files: the surrogate, every liberty of the grammar, and what is refused.

use albatross_avl::geometry::*;
use albatross_avl::{AvlError, Diagnostic};

use crate::support::{fixture_text, third_party};

fn grammar(name: &str) -> (Geometry, Vec<Diagnostic>) {
    Geometry::parse(&fixture_text(&format!("avl/grammar/{name}")), name).unwrap_or_else(|e| panic!("{e}"))
}

/// Whether a remark on a line holds a text.
fn remarked(diagnostics: &[Diagnostic], line: usize, text: &str) -> bool {
    diagnostics
        .iter()
        .any(|d| d.at.line == line && d.message.contains(text))
}

#[test]
fn val_geometry_of_the_surrogate() {
    let (g, remarks) = Geometry::parse(&fixture_text("f25-like/f25.avl"), "f25.avl").unwrap();
    assert_eq!(g.title, "DLR-F25 surrogate (own model, not DLR data)");
    assert_eq!((g.mach, g.i_ysym, g.i_zsym, g.z_sym), (0.692_496, 0, 0, 0.0));
    assert_eq!((g.s_ref, g.c_ref, g.b_ref), (130.1, 3.346_49, 45.0));
    assert_eq!(
        (g.x_ref, g.y_ref, g.z_ref, g.cd_p),
        (20.343_55, 0.0, -0.427_68, Some(0.0209))
    );
    let names: Vec<&str> = g.surfaces.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["Wing", "HTP", "VTP", "Nacelle"]);
    let counts: Vec<usize> = g.surfaces.iter().map(|s| s.sections.len()).collect();
    assert_eq!(counts, [9, 2, 2, 13]);
    let wing = &g.surfaces[0];
    assert_eq!((wing.n_chord, wing.c_space, wing.spanwise), (30, 1.0, None));
    assert_eq!(
        (wing.component, wing.y_duplicate, wing.angle_deg),
        (Some(1), Some(0.0), 2.948_743)
    );
    let sixth = &wing.sections[5];
    assert_eq!(
        (sixth.x_le, sixth.y_le, sixth.chord, sixth.a_inc_deg),
        (21.0545, 13.0, 2.420_77, -2.8313)
    );
    assert_eq!(
        sixth.spanwise,
        Some(Spacing {
            count: 15,
            distribution: 0.0
        })
    );
    assert_eq!(
        sixth.airfoil,
        Airfoil::File {
            path: "airfoils/f25_kink.dat".to_owned(),
            x_range: None
        }
    );
    assert_eq!(sixth.controls[0].name, "aileron_in");
    assert_eq!(
        (sixth.controls[0].x_hinge, sixth.controls[0].sgn_dup),
        (0.75, -1.0)
    );
    assert_eq!(wing.sections[6].controls.len(), 2);
    let vtp = &g.surfaces[2];
    assert_eq!(
        vtp.spanwise,
        Some(Spacing {
            count: 20,
            distribution: 0.0
        })
    );
    assert_eq!(
        vtp.sections[0].airfoil,
        Airfoil::Naca {
            digits: "0011".to_owned(),
            x_range: None
        }
    );
    // AVL's order, as its .ft lists them.
    assert_eq!(
        g.control_names(),
        ["aileron_in", "aileron_out", "elevator", "rudder"]
    );
    assert!(g.design_names().is_empty());
    // The 220 strips and 5274 vortices that AVL reports.
    let strips = |s: &Surface| {
        let own = s.spanwise.map(|p| p.count);
        let inner = s.sections.iter().rev().skip(1);
        let n = own.unwrap_or_else(|| inner.filter_map(|c| c.spanwise).map(|p| p.count).sum());
        if s.y_duplicate.is_some() { 2 * n } else { n }
    };
    assert_eq!(g.surfaces.iter().map(strips).sum::<usize>(), 220);
    assert_eq!(
        g.surfaces.iter().map(|s| strips(s) * s.n_chord).sum::<usize>(),
        5274
    );
    // The header's Mach number is all there is to say.
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    assert!(remarked(&remarks, 2, "never uses it"));
}

/// AVL 3.32 and 3.52 run this file: lower case, no CDp, commas, `2.0d0`, SCALE and the like behind the sections.
#[test]
fn val_every_liberty_at_once() {
    for name in ["a_ok_quirks.avl", "d_crlf.avl"] {
        let (g, remarks) = grammar(name);
        assert_eq!(
            (g.x_ref, g.y_ref, g.z_ref, g.cd_p),
            (0.0, 0.0, 0.0, None),
            "{name}"
        );
        let wing = &g.surfaces[0];
        assert_eq!(wing.name, "Wing  # not a comment here");
        assert_eq!(
            wing.spanwise,
            Some(Spacing {
                count: 10,
                distribution: -2.0
            })
        );
        assert_eq!(
            (wing.component, wing.y_duplicate, wing.angle_deg),
            (Some(1), Some(0.0), 2.0)
        );
        assert_eq!(wing.translate, [0.1, 0.0, 0.0]);
        let [root, tip] = wing.sections.as_slice() else {
            panic!("two sections")
        };
        assert_eq!(
            root.airfoil,
            Airfoil::Naca {
                digits: "2412".to_owned(),
                x_range: None
            }
        );
        assert_eq!(
            (tip.x_le, tip.y_le, tip.chord, tip.a_inc_deg),
            (0.05, 1.25, 0.2, -1.5)
        );
        assert_eq!(
            tip.airfoil,
            Airfoil::File {
                path: "foil one.dat".to_owned(),
                x_range: Some([0.0, 1.0])
            }
        );
        assert_eq!(tip.claf, 1.05);
        let [aileron, flap] = tip.controls.as_slice() else {
            panic!("two controls")
        };
        assert_eq!(
            (aileron.name.as_str(), aileron.x_hinge, aileron.sgn_dup),
            ("ail", 0.75, -1.0)
        );
        assert_eq!(
            (flap.name.as_str(), flap.gain, flap.x_hinge, flap.sgn_dup),
            ("flap_without_numbers"[..16].into(), 1.0, 0.0, 1.0)
        );
        assert!(remarks.iter().any(|d| d.message.contains("cut to 16 characters")));
        assert!(remarks.iter().any(|d| d.message.contains("`END` is no keyword")));
        assert!(remarks.iter().any(|d| d.message.contains("moves nothing")));
    }
    assert_eq!(grammar("a_ok_quirks.avl"), {
        let (g, mut remarks) = grammar("d_crlf.avl");
        remarks
            .iter_mut()
            .for_each(|d| d.at.file = "a_ok_quirks.avl".to_owned());
        (g, remarks)
    });
}

/// AVL stops on these (`Read error`) for their form alone; here they are read, with a remark.
#[test]
fn val_what_avl_refuses_for_its_form_is_read_with_a_remark() {
    let (g, remarks) = grammar("b_tab_section.avl");
    assert_eq!(g.surfaces[0].sections[1].y_le, 1.25);
    assert!(
        remarked(&remarks, 13, "tabs") && remarked(&remarks, 15, "tabs"),
        "{remarks:?}"
    );

    let (g, remarks) = grammar("f_words_after_5.avl");
    assert_eq!(
        (
            g.surfaces[0].sections[1].a_inc_deg,
            g.surfaces[0].sections[1].spanwise
        ),
        (0.0, None)
    );
    assert!(
        remarked(&remarks, 15, "`|` stands where AVL looks for an optional number"),
        "{remarks:?}"
    );

    let (g, remarks) = grammar("h_repeat.avl");
    let root = &g.surfaces[0].sections[0];
    assert_eq!((root.x_le, root.z_le, root.chord), (0.0, 0.0, 0.25));
    assert!(remarked(&remarks, 13, "3*0."), "{remarks:?}");
}

#[test]
fn val_what_avl_accepts_passes() {
    let (g, remarks) = grammar("c_indented_comment.avl");
    assert_eq!((g.cd_p, g.surfaces[0].name.as_str()), (Some(0.01), "Wing"));
    assert!(
        remarked(&remarks, 7, "is no keyword") && remarked(&remarks, 11, "is no keyword"),
        "{remarks:?}"
    );

    let (g, remarks) = grammar("e_fortran_short.avl");
    assert_eq!(g.surfaces[0].sections[1].chord, 0.1);
    assert_eq!(g.surfaces[0].sections[1].controls[0].hinge_axis, [0.0, 1.0, 0.0]);
    assert_eq!(
        g.surfaces[1].sections[0].spanwise,
        Some(Spacing {
            count: 4,
            distribution: 1.0
        })
    );
    assert!(
        remarks.iter().all(|d| d.message.contains("moves nothing")),
        "{remarks:?}"
    );

    let (g, remarks) = grammar("g_words_after_7.avl");
    assert_eq!(g.surfaces[0].sections[1].chord, 0.25);
    assert!(!remarked(&remarks, 15, "optional"), "{remarks:?}");

    let (g, remarks) = grammar("i_inline_airfoil.avl");
    let Airfoil::Inline { points, .. } = &g.surfaces[0].sections[0].airfoil else {
        panic!("inline")
    };
    assert_eq!((points.len(), points[1]), (7, [0.5, 0.05]));
    let tip = &g.surfaces[0].sections[1];
    assert_eq!(
        tip.airfoil,
        Airfoil::Naca {
            digits: "2412".to_owned(),
            x_range: Some([0.0, 1.0])
        }
    );
    assert!(remarked(&remarks, 13, "AVL up to 3.35 stops"), "{remarks:?}");
    assert!(remarked(&remarks, 23, "ignores this one"), "{remarks:?}");
}

#[test]
fn every_grammar_file_reads_back_the_same_when_written() {
    for name in [
        "a_ok_quirks",
        "b_tab_section",
        "c_indented_comment",
        "e_fortran_short",
        "i_inline_airfoil",
    ] {
        let (g, _) = grammar(&format!("{name}.avl"));
        let (again, _) = Geometry::parse(&g.to_text().unwrap(), "again.avl").unwrap();
        assert_eq!(again, g, "{name}");
    }
}

#[test]
fn val_third_party_hershey_wing() {
    let Some(text) = third_party("avl/hershey_overflow.avl") else {
        return;
    };
    let (g, remarks) = Geometry::parse(&text, "hershey.avl").unwrap();
    assert_eq!((g.s_ref, g.c_ref, g.b_ref), (0.00004, 0.002, 2.0));
    let wing = &g.surfaces[0];
    assert_eq!((wing.scale, wing.sections.len()), ([1.0, 1.0, 0.0], 2));
    assert_eq!(wing.sections[1].controls[0].x_hinge, -0.3);
    assert!(remarks.is_empty(), "{remarks:?}");
}

/// Five header lines, then what a test adds.
fn with_header(rest: &str) -> String {
    format!("Title\n0.0\n0 0 0.0\n1. 1. 1.\n0 0 0\n{rest}")
}

const WING: &str = "SURFACE\nWing\n4 1.0 8 0.\nSECTION\n0 0 0 1 0\nSECTION\n0 1 0 1 0\n";

fn parse(rest: &str) -> Result<(Geometry, Vec<Diagnostic>), AvlError> {
    Geometry::parse(&with_header(rest), "t.avl")
}

#[test]
fn surface_keywords_in_any_order_and_case() {
    let text = "surface\nW\n4 1.0 8 0.\nNOWAKE\nnoalbe\nNoLoad\nIndex\n7\nCDCL\n1. .03 -0.5 .02 .2 .01\nSECTION\n0 0 0 1 0\n\
                CDCL\n0 .1 1 .2 2 .3\nDESIGN\ntwist 0.5\nSECTION\n0 1 0 1 0 3 1.\nScale\n1 2 3\nangle\n-1.\nYDUP\n0.5\n\
                ydup\n0.25\n";
    let (g, remarks) = parse(text).unwrap();
    let s = &g.surfaces[0];
    assert!(s.no_wake && s.no_albe && s.no_load);
    assert_eq!(
        (s.component, s.scale, s.angle_deg, s.y_duplicate),
        (Some(7), [1.0, 2.0, 3.0], -1.0, Some(0.25))
    );
    assert_eq!(
        s.cdcl,
        Some(DragPolar {
            cl: [-0.5, 0.2, 1.0],
            cd: [0.02, 0.01, 0.03]
        })
    );
    assert_eq!(
        s.sections[0].cdcl,
        Some(DragPolar {
            cl: [0.0, 1.0, 2.0],
            cd: [0.1, 0.2, 0.3]
        })
    );
    assert_eq!(
        s.sections[0].designs,
        [Design {
            name: "twist".to_owned(),
            weight: 0.5
        }]
    );
    assert!(
        remarks
            .iter()
            .any(|d| d.keyword == "CDCL" && d.message.contains("3.40"))
    );
}

#[test]
fn bodies_and_core_radii() {
    let text = format!(
        "{WING}BODY\nFuse\n12 1.0\nYDUP\n0.\nTRANS\n0 2 0\nBFILE\n\"fuse shape.dat\"\nBSECT\n0 0 0 .5\nBSECT\n1 0 0 .5 .6\n\
         CORE\n0.1 0.2 0.3\n"
    );
    let (g, _) = parse(&text).unwrap();
    let body = &g.bodies[0];
    assert_eq!(
        (body.spacing.count, body.translate, body.y_duplicate),
        (12, [0.0, 2.0, 0.0], Some(0.0))
    );
    assert_eq!(body.file.as_deref(), Some("fuse shape.dat"));
    assert_eq!(
        body.sections[1],
        BodySection {
            centre: [1.0, 0.0, 0.0],
            radius_y: 0.5,
            radius_z: 0.6
        }
    );
    assert_eq!(body.sections[0].radius_z, 0.5);
    let core = CoreRadii {
        chord_fraction: 0.1,
        width_fraction: 0.2,
        source_fraction: 0.3,
    };
    assert_eq!(g.core, Some(core));
    let (again, _) = Geometry::parse(&g.to_text().unwrap(), "again.avl").unwrap();
    assert_eq!(again, g);
}

#[test]
fn x_ranges_behind_keyword_or_data() {
    let text = "SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 0 1 0\nAFILE\nroot foil.dat 0.1 0.9\nSECTION\n0 1 0 1 0\nNACA\n0012 -1 2.\n";
    let (g, remarks) = parse(text).unwrap();
    let root = &g.surfaces[0].sections[0].airfoil;
    assert_eq!(
        *root,
        Airfoil::File {
            path: "root foil.dat".to_owned(),
            x_range: Some([0.1, 0.9])
        }
    );
    let tip = &g.surfaces[0].sections[1].airfoil;
    assert_eq!(
        *tip,
        Airfoil::Naca {
            digits: "0012".to_owned(),
            x_range: Some([0.0, 1.0])
        }
    );
    assert!(
        remarked(&remarks, 12, "since 3.40") && remarked(&remarks, 16, "since 3.40"),
        "{remarks:?}"
    );
}

#[test]
fn values_that_avl_replaces_are_replaced_with_a_remark() {
    let (g, remarks) = Geometry::parse(
        &format!("T\n0\n0 -3 0.\n0 -1 2\n0 0 0\n{WING}CLAF\n2.5\n"),
        "t.avl",
    )
    .unwrap();
    assert_eq!((g.s_ref, g.c_ref, g.b_ref, g.i_zsym), (1.0, 1.0, 2.0, -1));
    assert_eq!(g.surfaces[0].sections[1].claf, 1.0);
    assert_eq!(remarks.len(), 3, "{remarks:?}");
}

#[test]
fn a_name_that_starts_like_an_earlier_control_is_remarked() {
    let c = |name: &str| format!("CONTROL\n{name} 1 .7 0 0 0 1\n");
    let section = format!("SECTION\n0 0 0 1 0\n{}{}", c("flap1"), c("flap"));
    let (g, remarks) = parse(&format!("SURFACE\nW\n4 1.0 8 0.\n{section}{section}")).unwrap();
    assert_eq!(g.surfaces[0].sections[1].controls.len(), 2);
    assert_eq!(remarks.len(), 1, "{remarks:?}");
    assert!(remarks[0].message.contains("takes `flap` for `flap1`"));
}

#[test]
fn damaged_files_get_typed_errors_with_place_and_cure() {
    let error = |text: &str| Geometry::parse(text, "t.avl").unwrap_err();
    assert!(matches!(error(" \n"), AvlError::Empty { .. }));
    assert!(matches!(
        error("Title\n0.0\n"),
        AvlError::Truncated { line: 2, .. }
    ));
    assert!(matches!(error("Title\nMach\n"), AvlError::Number { .. }));
    let e = parse("SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 O 1 0\n").unwrap_err();
    assert_eq!(
        e.to_string(),
        "t.avl:10:5: field `Xle Yle Zle Chord Ainc Nspan Sspace`: `O` is not a number"
    );
    let e = parse("SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 0 1\n").unwrap_err();
    assert!(
        e.to_string().contains("5 numbers") && e.to_string().contains("found 4"),
        "{e}"
    );
    let e = parse("SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 0 1 NaN\n").unwrap_err();
    assert!(matches!(e, AvlError::NotFinite { .. }), "{e}");
    let e = parse("SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 0 1 0\n").unwrap_err();
    assert!(
        e.to_string()
            .contains("two sections or more in surface `W`, found 1"),
        "{e}"
    );
    let e = parse("SURFACE\nW\n4 1.0 8 0.\nSECTION\n0 0 0 1 0\nNACA\nSECTION\n0 1 0 1 0\n").unwrap_err();
    assert!(e.to_string().contains("on the line below the keyword"), "{e}");
    let e = Geometry::parse(&format!("T\n0\n1 0 0.\n1 1 1\n0 0 0\n{WING}YDUP\n0.\n"), "t.avl").unwrap_err();
    assert!(e.to_string().contains("either iYsym or YDUPLICATE"), "{e}");
    let e = parse("SURFACE\nW\n-4 1.0\n").unwrap_err();
    assert!(e.to_string().contains("a number of elements for Nchord"), "{e}");
    let e = parse(&format!("{WING}TRANS\n0,,0\n")).unwrap_err();
    assert!(e.to_string().contains("between two commas"), "{e}");
}
