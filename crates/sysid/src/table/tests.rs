use proptest::prelude::*;

use super::*;

fn columns(input: &str, outputs: &[&str]) -> Columns {
    Columns {
        input: input.to_owned(),
        outputs: outputs.iter().map(|s| (*s).to_owned()).collect(),
        ..Columns::default()
    }
}

/// A table of three rows with this header, comma between cells.
fn headed(header: &str) -> Table {
    let cells = header.split(',').count();
    let row = |k: usize| {
        let cells: Vec<String> = (0..cells).map(|i| (10 * i + k).to_string()).collect();
        cells.join(",") + "\n"
    };
    parse(&format!("{header}\n{}{}{}", row(0), row(1), row(2)), "x.csv").unwrap()
}

fn message(text: &str, asked: &Columns) -> String {
    match parse(text, "x.csv").and_then(|t| t.experiment(asked)) {
        Ok(found) => panic!("{found:?}"),
        Err(error) => error.to_string(),
    }
}

/// Times printed by `print`, with an input and an output.
fn timed(samples: usize, print: impl Fn(usize) -> String) -> String {
    let rows = (0..samples).map(|k| format!("{},{},{}\n", print(k), k % 3, k % 5));
    "t,u,y\n".to_owned() + &rows.collect::<String>()
}

fn step(text: &str) -> Result<f64> {
    Ok(parse(text, "x.csv")?.experiment(&columns("u", &["y"]))?.0.dt)
}

#[test]
fn val_reference_records() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/f25-like/reference/doublet_3Hz.csv"
    );
    let text = std::fs::read_to_string(path).unwrap();
    let table = parse(&text, "doublet_3Hz.csv").unwrap();
    assert_eq!(
        (table.columns.len(), table.lines.len(), table.header_line),
        (14, 5001, 12)
    );
    let (experiment, input, outputs) = table
        .experiment(&columns(
            "elevator",
            &["az_cg", "q", "q_cg_struct_deg_s", "nz", "V"],
        ))
        .unwrap();
    assert_eq!((experiment.len(), experiment.dt), (5001, 0.001));
    assert_eq!(input, Signal::new("elevator", "deg"));
    let expected = [
        ("az_cg", "1"),
        ("q", "deg/s"),
        ("q_cg_struct", "deg/s"),
        ("nz", "1"),
        ("V", "m/s"),
    ];
    assert_eq!(outputs, expected.map(|(name, unit)| Signal::new(name, unit)));
    // Second row as printed.
    let second: Vec<f64> = experiment.outputs.iter().map(|y| y[1]).collect();
    assert_eq!(
        second,
        [
            -8.3950123e-15,
            3.06437618e-16,
            1.3413176e-15,
            0.999731802,
            232.70201
        ]
    );
    let error = table.column("az").unwrap_err();
    assert!(
        matches!(&error, Error::UnknownColumn { known, .. } if known.starts_with("t_s, elevator_deg, alpha_deg"))
    );
}

#[test]
fn val_comments_delimiters_and_line_ends() {
    let plain = "time,u,y\n0,1,2\n0.5,3,4\n1,5,6\n";
    let variants = [
        plain.to_owned(),
        format!(
            "\u{feff}# made by hand\r\n\r\n{}",
            plain.replace('\n', "\r\n# between\r\n")
        ),
        plain.replace(',', ";"),
        plain.replace(',', " ; "),
        plain.replace(',', "\t"),
        plain.replace(',', "   "),
        plain.replace('\n', ",\n"),
        plain.replace("0.5,3", "5.0D-1,+3.0d0"),
        "\"time [s]\",\"u\",\"y\"\n\"0\",\"1\",\"2\"\n0.5,3,4\n1,5,6\n".to_owned(),
        "time [s]  u [ m / s ] y (deg)\n 0 1 2\n .5 3. 4\n 1 5 6\n".to_owned(),
        "time,u,y\ns,deg,m/s^2\n0,1,2\n0.5,3,4\n1,5,6\n".to_owned(),
        "time,u,y\n[ms],[V],[-]\n0,1,2\n500,3,4\n1000,5,6\n".to_owned(),
    ];
    for text in variants {
        let (experiment, ..) = parse(&text, "x")
            .unwrap()
            .experiment(&columns("u", &["y"]))
            .unwrap();
        assert_eq!(experiment.dt, 0.5, "{text}");
        assert_eq!(experiment.input, [1.0, 3.0, 5.0], "{text}");
        assert_eq!(experiment.outputs, [[2.0, 4.0, 6.0]], "{text}");
    }
}

#[test]
fn val_names_and_units() {
    for (header, name, unit) in [
        ("elevator_deg", "elevator", Some("deg")),
        ("elevator [deg]", "elevator", Some("deg")),
        ("elevator(deg)", "elevator", Some("deg")),
        ("az_cockpit [m/s^2]", "az_cockpit", Some("m/s^2")),
        ("az_m_s2", "az", Some("m/s^2")),
        ("q_cg_struct_deg_s", "q_cg_struct", Some("deg/s")),
        ("V_m_s", "V", Some("m/s")),
        ("load_pct", "load", Some("%")),
        ("q_deg_s [deg/s]", "q", Some("deg/s")),
        ("inertia_kg_m2", "inertia", Some("kg m^2")),
        ("az_cg", "az_cg", None),
        ("az_cg_struct", "az_cg_struct", None),
        ("h_min", "h_min", None),
        ("t_min", "t", Some("min")),
        ("x(3)", "x(3)", None),
        ("nz [-]", "nz", None),
        ("m_s", "m", Some("s")),
        ("_deg", "_deg", None),
        ("deg", "deg", None),
    ] {
        let table = headed(&format!("{header},other"));
        let column = &table.columns[0];
        assert_eq!(
            (column.name.as_str(), column.unit.as_deref()),
            (name, unit),
            "{header}"
        );
    }
}

#[test]
fn val_full_names_win_and_ambiguous_ones_are_refused() {
    let table = headed("t_s,q_deg_s,q_rad_s,az_cg_struct,az_cg,Elevator [deg],y,Y,twice,twice,az_cg_g");
    let find = |name: &str| table.column(name).map(|c| c.values[0]);
    assert_eq!(find("az_cg"), Ok(40.0));
    assert_eq!(find("q_rad_s"), Ok(20.0));
    assert_eq!(find("elevator"), Ok(50.0));
    assert_eq!(find("ELEVATOR [DEG]"), Ok(50.0));
    assert_eq!((find("y"), find("Y")), (Ok(60.0), Ok(70.0)));
    let text = find("q").unwrap_err().to_string();
    assert!(
        text.starts_with("x.csv:1: ") && text.contains("q_deg_s, q_rad_s"),
        "{text}"
    );
    assert!(find("twice").unwrap_err().to_string().contains("full header"));
    assert!(matches!(find("az"), Err(Error::UnknownColumn { .. })));
    // Two columns share the name q: their signals keep the header.
    let (_, input, outputs) = table.experiment(&columns("q_deg_s", &["az_cg_g"])).unwrap();
    assert_eq!(input, Signal::new("q_deg_s", "deg/s"));
    assert_eq!(outputs, [Signal::new("az_cg_g", "g")]);
}

#[test]
fn val_columns_without_header_are_numbered() {
    let table = parse("# no header\n0 1 2\n1 3 4\n2 5 6\n", "x").unwrap();
    let asked = Columns {
        time: Some("c1".to_owned()),
        ..columns("c2", &["c3"])
    };
    let (experiment, ..) = table.experiment(&asked).unwrap();
    assert_eq!((experiment.dt, experiment.input), (1.0, vec![1.0, 3.0, 5.0]));
    let without = Columns {
        sample_time: Some(0.02),
        ..columns("c2", &["c3"])
    };
    assert_eq!(table.experiment(&without).unwrap().0.dt, 0.02);
    let error = table.experiment(&columns("c2", &["c3"])).unwrap_err().to_string();
    assert!(
        error.contains("--column-time") && error.contains("c1, c2, c3"),
        "{error}"
    );
}

#[test]
fn val_printed_and_single_precision_times_are_uniform() {
    let exact = |text: &str, dt: f64| assert_eq!(step(text), Ok(dt));
    exact(&timed(5001, |k| format!("{:.4}", 0.001 * k as f64)), 0.001);
    exact(&timed(5001, |k| format!("{:.3}", 0.001 * k as f64)), 0.001);
    // Accumulated in binary, printed in full.
    exact(
        &timed(5001, |k| (0..k).fold(0.0, |t, _| t + 0.001).to_string()),
        0.001,
    );
    // Single precision, at its worst 0.8 % of a step.
    exact(&timed(100_000, |k| (0.001_f32 * k as f32).to_string()), 0.001);
    // Six significant digits, as C++ streams print.
    exact(
        &timed(20_000, |k| {
            let t = 0.001 * k as f64;
            let decimals = if t < 10.0 { 5 } else { 4 };
            format!("{t:.decimals$}")
        }),
        0.001,
    );
    // A third of a hertz's multiple, rounded to a tenth of a step.
    exact(&timed(3000, |k| format!("{:.4}", k as f64 / 300.0)), 1.0 / 300.0);
    exact(&timed(300, |k| format!("{:.3e}", 5.0 + 0.08 * k as f64)), 0.08);
    let coarse = timed(300, |k| format!("{:.2}", k as f64 / 300.0));
    let text = step(&coarse).unwrap_err().to_string();
    assert!(text.contains("too coarsely"), "{text}");
}

#[test]
fn val_units_of_time() {
    for (header, dt) in [
        ("t_ms", 0.001),
        ("Time (us)", 1e-6),
        ("TIME_MIN", 60.0),
        ("t", 1.0),
        ("time_s", 1.0),
    ] {
        let table = headed(&format!("u,y,{header}"));
        let found = table.experiment(&columns("u", &["y"])).unwrap().0.dt;
        assert!((found - dt).abs() < 1e-12 * dt, "{header}: {found}");
    }
    let asked = Columns {
        time: Some("t".to_owned()),
        ..columns("u", &["y"])
    };
    let error = headed("t_deg,u,y").experiment(&asked).unwrap_err().to_string();
    assert!(error.contains("times in deg"), "{error}");
    let contrary = Columns {
        sample_time: Some(0.5),
        ..columns("u", &["y"])
    };
    let error = headed("t,u,y").experiment(&contrary).unwrap_err().to_string();
    assert!(
        error.contains("sample time of 1 s") && error.contains("0.5 s as given"),
        "{error}"
    );
    let bad = Columns {
        sample_time: Some(f64::NAN),
        ..columns("u", &["y"])
    };
    assert!(matches!(
        headed("u,y").experiment(&bad),
        Err(Error::Domain { .. })
    ));
}

#[test]
fn regress_times_that_are_not_uniform() {
    let sample = |k: usize| 0.001 * (if k < 700 { k } else { k + 1 }) as f64;
    for decimals in [3, 4, 9] {
        let text = step(&timed(1000, |k| format!("{:.decimals$}", sample(k))))
            .unwrap_err()
            .to_string();
        // Row 700 stands on line 702.
        let place = "x.csv:702: found a step of 0.002 in column t, the median step is 0.001";
        assert!(text.starts_with(place) && text.contains("resample"), "{text}");
    }
    let jitter = timed(1000, |k| {
        format!("{}", 0.001 * k as f64 + 2e-5 * ((k * 37) % 11) as f64)
    });
    assert!(step(&jitter).is_err());
    let stops = step(&timed(100, |_| "1".to_owned())).unwrap_err().to_string();
    assert!(stops.contains("times that increase"), "{stops}");
    assert!(step(&timed(100, |k| (100 - k).to_string())).is_err());
}

#[test]
fn regress_faults_name_their_place() {
    let asked = columns("u", &["y"]);
    let rows = |bad: &str| format!("# one\nt,u,y,note\n0,1,2,a\n\n1,{bad},2,b\n2,1,1,c\n");
    for (bad, expected) in [
        (
            "x1",
            "x.csv:5: found \"x1\" in column u, expected a finite number",
        ),
        (
            "NaN",
            "x.csv:5: found \"NaN\" in column u, expected a finite number",
        ),
        ("-inf", "x.csv:5: found \"-inf\" in column u"),
        ("1e999", "x.csv:5: found \"1e999\" in column u"),
        ("", "x.csv:5: found \"\" in column u"),
        (
            "1,2",
            "x.csv:5: found 5 cells, expected 4 as the first line has; if these are decimal commas",
        ),
    ] {
        let text = message(&rows(bad), &asked);
        assert!(text.starts_with(expected), "{text}");
    }
    // A first row with dates is no line of units.
    let dates = message("t,u,y\n1/2,1,1\n1/3,1,1\n", &asked);
    assert!(dates.starts_with("x.csv:2: found \"1/2\" in column t"), "{dates}");
    // Texts in columns that nobody asks for do not matter.
    assert!(parse(&rows("7"), "x").unwrap().experiment(&asked).is_ok());
    let few = message("t,u,y\n0,1,2\n1,2\n", &asked);
    assert!(few.starts_with("x.csv:3: found 2 cells, expected 3"), "{few}");
    let comma = message("t;u;y\n0;1,5;2\n1;2;3\n", &asked);
    assert!(
        comma.starts_with("x.csv:2: found \"1,5\"") && comma.contains("decimal points"),
        "{comma}"
    );
    for text in ["0,0;1,5\n1,0;2,5\n", "0,0 1,5\n1,0 2,5\n"] {
        assert!(message(text, &asked).contains("x.csv:1: found numbers with decimal commas"));
    }
    for text in ["", "# only\n\n", "t,u,y\n", "t,u,y\n0,1,2\n"] {
        assert!(message(text, &asked).contains("rows"), "{text}");
    }
}

/// Time goes with the length of a line, not with its square: as that, this would take many minutes.
#[test]
fn regress_a_long_line_is_read_at_once() {
    let list = "[ ".to_owned() + &"0.5 ".repeat(1_250_000) + "]";
    assert!(parse(&list, "x.json").is_err());
    let units = "u".to_owned() + &"_s".repeat(500_000) + ",y\n1,2\n3,4\n";
    let table = parse(&units, "x.csv").unwrap();
    assert_eq!(table.columns[0].unit.as_deref().map(str::len), Some(999_999));
}

proptest! {
    #[test]
    fn prop_no_text_panics(text in "\\PC*", asked in "\\PC{0,6}") {
        if let Ok(table) = parse(&text, "x") {
            let _ = table.experiment(&columns(&asked, &[&asked]));
        }
    }

    #[test]
    fn prop_no_table_panics(
        text in "[tuy0-9.eEdD,; \t\"#\\[\\]()_\n\r°µs-]{0,200}",
        asked in "[tuyc0-9]{1,2}",
    ) {
        if let Ok(table) = parse(&text, "x") {
            let asked = Columns { time: Some("t".to_owned()), ..columns(&asked, &["y"]) };
            let _ = table.experiment(&asked);
        }
    }

    #[test]
    fn prop_numbers_come_back(
        values in prop::collection::vec((prop::num::f64::NORMAL | prop::num::f64::ZERO, -1e9..1e9_f64), 2..40),
        delimiter in prop::sample::select(vec![",", ";", "\t", "  "]),
        dt in 1e-4..10.0_f64,
    ) {
        let mut text = ["t_s", "u_deg", "y\n"].join(delimiter);
        for (k, (u, y)) in values.iter().enumerate() {
            text += &[format!("{}", k as f64 * dt), format!("{u:e}"), format!("{y}\n")].join(delimiter);
        }
        let (experiment, ..) = parse(&text, "x").unwrap().experiment(&columns("u", &["y"])).unwrap();
        prop_assert!((experiment.dt - dt).abs() < 1e-6 * dt);
        for (k, (u, y)) in values.iter().enumerate() {
            prop_assert_eq!(experiment.input[k], *u);
            prop_assert_eq!(experiment.outputs[0][k], *y);
        }
    }
}
