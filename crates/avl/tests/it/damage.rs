//! Damaged files: typed errors. Mutations of files of all readers are tested in the facade,
//! `crates/albatross/tests/it/damage.rs`.

use albatross_avl::AvlError;
use albatross_avl::results::*;

use crate::support::fixture_text;

#[test]
fn announced_sizes_are_not_believed() {
    let fs = fixture_text("f25-like/avl_out/trim.fs");
    let error =
        StripForces::parse(&fs.replacen("# Spanwise = 73", "# Spanwise =999", 1), "t.fs").unwrap_err();
    assert!(
        matches!(
            error,
            AvlError::Count {
                announced: 999,
                found: 73,
                ..
            }
        ),
        "{error}"
    );
    let error =
        StripForces::parse(&fs.replacen("# Spanwise = 73", "# Spanwise = 72", 1), "t.fs").unwrap_err();
    assert!(matches!(error, AvlError::Syntax { .. }), "{error}");
    // A strip lost in the middle.
    let line = fs.lines().find(|l| l.starts_with("     9 ")).unwrap();
    let error = StripForces::parse(&fs.replacen(&format!("{line}\n"), "", 1), "t.fs").unwrap_err();
    assert!(error.to_string().contains("expected strip 9"), "{error}");
}

/// Every cut of a file at the end of a line, and every cut inside its last number, is an error or harmless.
#[test]
fn cut_files_are_refused() {
    for name in ["trim.ft", "trim.sb", "trim.fn", "trim.fs", "trim.hm", "trim.st"] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        let whole = parse_any(&text, name).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for n in (0..lines.len()).step_by(if lines.len() > 100 { 7 } else { 1 }) {
            let cut = lines[..n].join("\n");
            match (parse_any(&cut, name), &whole) {
                (Err(_), _) => {}
                // The head of an `.st` or `.sb` is an `.ft`; asked for the right kind, the reader refuses it.
                (Ok(ResultFile::TotalForces(_)), ResultFile::StabilityDerivatives(_)) => {
                    assert!(matches!(
                        StabilityDerivatives::parse(&cut, name),
                        Err(AvlError::WrongKind { .. })
                    ));
                }
                (Ok(ResultFile::TotalForces(_)), ResultFile::BodyDerivatives(_)) => {
                    assert!(matches!(
                        BodyDerivatives::parse(&cut, name),
                        Err(AvlError::WrongKind { .. })
                    ));
                }
                // Trefftz rows, neutral point and spiral ratio are optional.
                (Ok(ResultFile::StabilityDerivatives(st)), ResultFile::StabilityDerivatives(whole)) => {
                    let pitch = |st: &StabilityDerivatives| {
                        st.controls
                            .iter()
                            .map(|c| (c.column.pitch, c.column.yaw))
                            .collect::<Vec<_>>()
                    };
                    assert_eq!((st.beta, pitch(&st)), (whole.beta, pitch(whole)));
                    assert!(
                        st.neutral_point_x
                            .is_none_or(|x| Some(x) == whole.neutral_point_x)
                    );
                }
                (Ok(cut), whole) => assert_eq!(cut, *whole, "{name} cut at line {n}"),
            }
        }
    }
    let st = fixture_text("f25-like/avl_out/trim.st");
    let st = st
        .split("\n                  aileron_in")
        .next()
        .unwrap()
        .to_owned();
    let st = st.replace(
        "   aileron_in      =   0.00000\n   aileron_out     =   0.00000\n",
        "",
    );
    let st = st.replace(
        "   elevator        =  -0.01128\n   rudder          =   0.00000\n",
        "",
    );
    assert!(StabilityDerivatives::parse(&st, "t.st").is_ok());
    let cut = &st.trim_end()[..st.trim_end().len() - 3];
    assert!(matches!(
        StabilityDerivatives::parse(cut, "t.st"),
        Err(AvlError::Truncated { .. })
    ));
}

/// One wrong, overflowing or infinite number in each labelled field.
#[test]
fn each_bad_field_is_named() {
    let text = fixture_text("f25-like/avl_out/trim.st");
    for (old, field) in [
        ("Sref =  130.10    ", "Sref"),
        ("Alpha =   1.33236", "Alpha"),
        ("Cn'tot =   0.00000", "Cn'tot"),
        ("CDind = 0.0078233", "CDind"),
        ("e =    0.8212", "e"),
        ("elevator        =  -0.01128", "elevator"),
        ("CLa =   7.296941", "CLa"),
        ("Cmd03 =  -0.076567", "Cmd03"),
        ("Xnp =  21.874986", "Xnp"),
    ] {
        assert!(text.contains(old), "{old}");
        let equals = old.find('=').unwrap();
        let width = old.len() - equals - 1;
        let with = |value: &str| text.replacen(old, &format!("{}{value:>width$}", &old[..=equals]), 1);
        let named = |e: &AvlError| match e {
            AvlError::Overflow { field, .. }
            | AvlError::Number { field, .. }
            | AvlError::NotFinite { field, .. } => field.clone(),
            other => panic!("{other}"),
        };
        let e = StabilityDerivatives::parse(&with(&"*".repeat(width)), "t.st").unwrap_err();
        assert!(
            matches!(e, AvlError::Overflow { .. }) && named(&e) == field,
            "{e}"
        );
        let e = StabilityDerivatives::parse(&with("1.2x4"), "t.st").unwrap_err();
        assert!(matches!(e, AvlError::Number { .. }) && named(&e) == field, "{e}");
        let e = StabilityDerivatives::parse(&with("NaN"), "t.st").unwrap_err();
        assert!(
            matches!(e, AvlError::NotFinite { .. }) && named(&e) == field,
            "{e}"
        );
    }
}

#[test]
fn appended_solutions_and_foreign_files_are_refused() {
    let text = fixture_text("f25-like/avl_out/trim.ft");
    let error = RunState::parse(&format!("{text}{text}"), "t.ft").unwrap_err();
    assert!(error.to_string().contains("one solution per file"), "{error}");
    assert!(matches!(parse_any("\n \n", "t"), Err(AvlError::Empty { .. })));
    let error = parse_any("GRID,1\nENDDATA\n", "t.bdf").unwrap_err();
    assert!(
        matches!(&error, AvlError::UnknownKind { first, .. } if first == "GRID,1"),
        "{error}"
    );
    let error = parse_any(&fixture_text("f25-like/f25.avl"), "f25.avl").unwrap_err();
    assert!(
        matches!(
            error,
            AvlError::WrongKind {
                found: FileKind::Geometry,
                ..
            }
        ),
        "{error}"
    );
    let error = parse_any(&fixture_text("f25-like/f25.run"), "f25.run").unwrap_err();
    assert!(
        matches!(
            error,
            AvlError::WrongKind {
                found: FileKind::Run,
                ..
            }
        ),
        "{error}"
    );
    assert!(matches!(
        albatross_avl::read_text("/no/such/file.st"),
        Err(AvlError::Io { .. })
    ));
}

/// Tabs and blanks put in by other tools, line ends of other systems.
#[test]
fn respaced_tables_are_read_by_blanks() {
    let text = fixture_text("f25-like/avl_out/trim.fs");
    let whole = StripForces::parse(&text, "t.fs").unwrap();
    assert_eq!(
        StripForces::parse(&text.replace('\n', "\r\n"), "t.fs").unwrap(),
        whole
    );
    let respaced: Vec<String> = text
        .lines()
        .map(|l| {
            let is_row = l.split_whitespace().count() == 15
                && l.trim_start().starts_with(|c: char| c.is_ascii_digit());
            if is_row {
                l.split_whitespace().collect::<Vec<_>>().join(" ")
            } else {
                l.to_owned()
            }
        })
        .collect();
    assert_eq!(StripForces::parse(&respaced.join("\n"), "t.fs").unwrap(), whole);
}

/// Cut anywhere, inside a number too: the message says that the file was cut, and where it ends.
#[test]
fn files_cut_inside_a_line_are_called_truncated() {
    for (name, at) in [
        ("trim.st", 2200),
        ("trim.st", 3000),
        ("trim.fs", 12_000),
        ("trim.fs", 11_977),
        ("trim.ft", 700),
    ] {
        let text = fixture_text(&format!("f25-like/avl_out/{name}"));
        let cut = &text[..at];
        let error = parse_any(cut, name).unwrap_err();
        let lines = cut.lines().count();
        assert!(
            matches!(&error, AvlError::Truncated { line, .. } if *line == lines),
            "{error}"
        );
    }
}
