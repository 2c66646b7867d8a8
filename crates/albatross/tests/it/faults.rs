//! Numbers that no analysis can use: NaN, infinities, zeros, absurd sizes, geometry that folds onto itself. Each is put
//! into the aircraft that `albatross new` writes, and is refused with the quantity and its place; what is legitimate,
//! one mode or very many, gives its result.

use albatross::analysis::{mode_table_without_lags, trimmed};
use albatross::case::Case;
use albatross::numerics::Mat;
use albatross::{Error, Inputs, Model};

const CASE: &str = include_str!("../../../cli/template/case.toml");
const DECK: &str = include_str!("../../../cli/template/aircraft.bdf");
const GEOMETRY: &str = include_str!("../../../cli/template/aircraft.avl");

/// The text with the first `from` replaced, which must be there.
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "the template has no `{from}`");
    text.replacen(from, to, 1)
}

/// Message of the case file that cannot be used.
fn refused(case: &str) -> String {
    Case::parse(case, "case.toml").unwrap_err().to_string()
}

/// A directory with the three files.
fn written(case: &str, deck: &str, geometry: &str) -> tempfile::TempDir {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(place.path().join(name), text).unwrap();
    write("case.toml", case);
    write("aircraft.bdf", deck);
    write("aircraft.avl", geometry);
    place
}

/// The trimmed aircraft of three files, or the message.
fn flown(case: &str, deck: &str, geometry: &str) -> Result<(Model, Vec<f64>), Error> {
    let place = written(case, deck, geometry);
    let inputs = Inputs::read(&place.path().join("case.toml"))?;
    let model = Model::build(&inputs, &inputs.case.variant(None)?)?;
    let flight = trimmed(&model)?;
    let system = &flight.system;
    let mut numbers = vec![flight.trim.alpha_rad, flight.trim.thrust];
    for matrix in [&system.a, &system.b, &system.c, &system.d] {
        for j in 0..matrix.ncols() {
            numbers.extend(matrix.col(j).iter());
        }
    }
    // Modes are followed from vacuum into the flow one by one, which takes long for many.
    if model.basis.modes.len() < 20 {
        let table = mode_table_without_lags(&model, &flight)?;
        numbers.extend(table.elastic.iter().flat_map(|m| [m.re, m.im]));
    }
    Ok((model, numbers))
}

/// A number of the case: text of the template, the text with the number as `{}`, the name in the message.
const NUMBERS: [(&str, &str, &str); 29] = [
    (
        "damping_ratio = 0.01",
        "damping_ratio = {}",
        "[structure] damping_ratio",
    ),
    (
        "damping_ratio = 0.01",
        "damping_ratio = [0.01, {}]",
        "[structure] damping_ratio",
    ),
    (
        "damping_ratio = 0.01",
        "damping_ratio = 0.01\nmean_axes_tolerance = {}",
        "[structure] mean_axes_tolerance",
    ),
    (
        "results = \"solve\"           ",
        "results = \"solve\"\nmodes_ = {}",
        "modes_",
    ),
    (
        "shape_reference",
        "apparent_mass_factor = {}\nshape_reference",
        "[aerodynamics] apparent_mass_factor",
    ),
    (
        "shape_reference",
        "lattice = { mach = {} }\nshape_reference",
        "[aerodynamics.lattice] mach",
    ),
    (
        "shape_reference",
        "lattice = { alphas_deg = [1.0, {}] }\nshape_reference",
        "[aerodynamics.lattice] alphas_deg",
    ),
    (
        "lra = \"fin\"",
        "lra = \"fin\"\ndownwash_gradient = {}",
        "surface `Fin`: downwash_gradient",
    ),
    (
        "[flight]",
        "[reference]\narea = {}\nchord = 1.0\nspan = 1.0\n[flight]",
        "[reference] area",
    ),
    (
        "[flight]",
        "[reference]\narea = 1.0\nchord = {}\nspan = 1.0\n[flight]",
        "[reference] chord",
    ),
    (
        "[flight]",
        "[reference]\narea = 1.0\nchord = 1.0\nspan = {}\n[flight]",
        "[reference] span",
    ),
    ("speed = 50.0", "speed = {}", "[flight] speed"),
    ("speed = 50.0", "mach = {}", "[flight] mach"),
    ("altitude = 1000.0", "altitude = {}", "[flight] altitude"),
    (
        "altitude = 1000.0",
        "altitude = 0.0\npath_angle_deg = {}",
        "[flight] path_angle_deg",
    ),
    (
        "altitude = 1000.0",
        "altitude = 0.0\ngravity = {}",
        "[flight] gravity",
    ),
    (
        "[bode]",
        "[[engine]]\nname = \"left\"\ngrid = 1\nshare = {}\n[bode]",
        "engine `left`: share",
    ),
    (
        "[bode]",
        "[[engine]]\nname = \"left\"\ngrid = 1\nshare = 1.0\nincidence_deg = {}\n[bode]",
        "engine `left`: incidence_deg",
    ),
    (
        "[bode]",
        "[[engine]]\nname = \"left\"\ngrid = 1\nshare = 1.0\ntoe_deg = {}\n[bode]",
        "engine `left`: toe_deg",
    ),
    ("end = 6.0", "end = {}", "manoeuvre `elevator_doublet`: end"),
    ("dt = 0.002", "dt = {}", "manoeuvre `elevator_doublet`: dt"),
    (
        "amplitude_deg = 1.0",
        "amplitude_deg = {}",
        "manoeuvre `elevator_doublet`: amplitude",
    ),
    ("start = 0.5", "start = {}", "manoeuvre `elevator_doublet`: start"),
    (
        "frequency_hz = 0.5",
        "frequency_hz = {}",
        "manoeuvre `elevator_doublet`: frequency_hz",
    ),
    ("unit = 0.3", "unit = {}", "manoeuvre `aileron_3211`: unit"),
    (
        "kind = \"3211\", amplitude_deg = 1.0, start = 0.5, unit = 0.3",
        "kind = \"chirp\", amplitude_deg = 1.0, start = 0.5, duration = {}, from_hz = 0.1, to_hz = 1.0",
        "manoeuvre `aileron_3211`: duration",
    ),
    (
        "kind = \"3211\", amplitude_deg = 1.0, start = 0.5, unit = 0.3",
        "kind = \"chirp\", amplitude_deg = 1.0, start = 0.5, duration = 1.0, from_hz = 0.1, to_hz = {}",
        "manoeuvre `aileron_3211`: to_hz",
    ),
    ("from_rad_s = 0.05", "from_rad_s = {}", "from_rad_s"),
    ("to_rad_s = 200.0", "to_rad_s = {}", "to_rad_s"),
];

/// TOML has `nan` and `inf`: none of them passes, and the message has the file, the key and the number.
#[test]
fn val_numbers_of_the_case_are_refused_by_their_keys() {
    assert!(Case::parse(CASE, "case.toml").is_ok());
    for (from, to, key) in NUMBERS {
        for value in ["nan", "-nan", "inf", "-inf"] {
            let message = refused(&with(CASE, from, &to.replace("{}", value)));
            assert!(message.starts_with("case.toml"), "{key} = {value}: {message}");
            assert!(message.contains(key), "{key} = {value}: {message}");
        }
    }
    // What is finite and cannot be, by key.
    for (key, value) in [
        ("[structure] damping_ratio", "1.0"),
        ("[structure] mean_axes_tolerance", "0.0"),
        ("[flight] speed", "0.0"),
        ("[flight] speed", "1e300"),
        ("[flight] mach", "-0.8"),
        ("[flight] altitude", "33000.0"),
        ("[flight] path_angle_deg", "90.0"),
        ("[flight] gravity", "0.0"),
        ("[reference] chord", "0.0"),
        ("[reference] span", "1e-300"),
        ("[aerodynamics.lattice] mach", "1.0"),
        ("manoeuvre `elevator_doublet`: end", "0.0"),
        ("manoeuvre `elevator_doublet`: dt", "7.0"),
        ("manoeuvre `elevator_doublet`: amplitude", "1e300"),
        ("manoeuvre `elevator_doublet`: frequency_hz", "0.0"),
        ("manoeuvre `aileron_3211`: unit", "-0.3"),
    ] {
        let (from, to, _) = NUMBERS.iter().find(|n| n.2 == key).unwrap();
        let message = refused(&with(CASE, from, &to.replace("{}", value)));
        assert!(
            message.contains(&format!("{key} is ")),
            "{key} = {value}: {message}"
        );
        assert!(message.contains("give a"), "no cure: {message}");
        assert!(message.len() < 200, "{message}");
    }
    for (from, to, expected) in [
        (
            "modes = 12",
            "modes = nan",
            "modes is neither a whole number nor a list",
        ),
        (
            "modes = 12",
            "modes = -1",
            "modes is neither a whole number nor a list",
        ),
        (
            "damping_ratio = 0.01",
            "damping_ratio = \"1 %\"",
            "damping_ratio is neither a number nor a list",
        ),
    ] {
        let message = refused(&with(CASE, from, to));
        assert!(
            message.contains(expected) && message.starts_with("case.toml:1"),
            "{message}"
        );
    }
}

/// What is put in, and what the message must hold.
struct Fault {
    what: &'static str,
    case: Option<(&'static str, &'static str)>,
    deck: Option<(&'static str, &'static str)>,
    geometry: Option<(&'static str, &'static str)>,
    message: &'static [&'static str],
}

const SOUND: Fault = Fault {
    what: "",
    case: None,
    deck: None,
    geometry: None,
    message: &[],
};

const FAULTS: [Fault; 29] = [
    Fault {
        what: "repeated grid",
        deck: Some(("GRID,101,,2.4,1.,0.35", "GRID,101,,2.4,0.,0.3")),
        message: &[
            "aircraft.bdf:63",
            "CBAR 1",
            "length between grids 100 and 101 is 0 m",
        ],
        ..SOUND
    },
    Fault {
        what: "two grids of one number",
        deck: Some(("GRID,102,", "GRID,101,")),
        message: &["aircraft.bdf", "grid 102, which is not in the deck"],
        ..SOUND
    },
    Fault {
        what: "NaN in a grid",
        deck: Some(("GRID,101,,2.4,1.,", "GRID,101,,2.4,NaN,")),
        message: &["aircraft.bdf:28", "NaN"],
        ..SOUND
    },
    Fault {
        what: "number beyond 64 bits",
        deck: Some(("MAT1,1,7.0E10", "MAT1,1,7.0+400")),
        message: &["aircraft.bdf:18", "7.0+400"],
        ..SOUND
    },
    Fault {
        what: "stars in a mass",
        deck: Some(("CONM2,1002,101,,14.", "CONM2,1002,101,,******")),
        message: &["aircraft.bdf:98", "******"],
        ..SOUND
    },
    Fault {
        what: "negative mass",
        deck: Some(("CONM2,1002,101,,14.", "CONM2,1002,101,,-14.")),
        message: &["grid 101", "its mass", "-1.4", "correct a negative mass"],
        ..SOUND
    },
    Fault {
        what: "more negative mass than the aircraft has",
        deck: Some(("CONM2,1002,101,,14.", "CONM2,1002,101,,-14000.")),
        message: &["grid 101", "its mass", "correct a negative mass"],
        ..SOUND
    },
    Fault {
        what: "negative density",
        deck: Some(("MAT1,1,7.0E10,2.7E10,,0.", "MAT1,1,7.0E10,2.7E10,,-1.E6")),
        message: &["grid ", "its mass", "RHO"],
        ..SOUND
    },
    Fault {
        what: "negative modulus",
        deck: Some(("MAT1,1,7.0E10", "MAT1,1,-7.E10")),
        message: &["aircraft.bdf:18", "MAT1 1", "E = -7e10"],
        ..SOUND
    },
    Fault {
        what: "factor of masses that is no number",
        deck: Some(("PARAM,GRDPNT,0", "PARAM,WTMASS,NAN")),
        message: &["PARAM WTMASS", "NAN", "positive number"],
        ..SOUND
    },
    Fault {
        what: "factor of masses of zero",
        deck: Some(("PARAM,GRDPNT,0", "PARAM,WTMASS,0.")),
        message: &["PARAM WTMASS", "is 0", "positive number"],
        ..SOUND
    },
    Fault {
        what: "beyond divergence",
        deck: Some(("MAT1,1,7.0E10,2.7E10", "MAT1,1,7.0E7,2.7E7")),
        message: &["50.000 m/s is at or beyond the divergence speed 4.5", "stiffen"],
        ..SOUND
    },
    Fault {
        what: "no modes",
        case: Some(("modes = 12", "modes = 0")),
        message: &["the modal basis would be empty", "select at least one"],
        ..SOUND
    },
    Fault {
        what: "more modes than there are",
        case: Some(("modes = 12", "modes = 1000000000")),
        message: &[
            "aircraft.bdf",
            "1000000000 elastic modes are asked for",
            "has only 174",
        ],
        ..SOUND
    },
    Fault {
        what: "one mode twice",
        case: Some(("modes = 12", "modes = [7, 7]")),
        message: &["mode 7 is asked for twice"],
        ..SOUND
    },
    Fault {
        what: "one grid twice in an axis",
        case: Some((
            "wing_right = [100, \"101 THRU 108\"]",
            "wing_right = [100, 101, 101, 102]",
        )),
        message: &["wing_right", "grid 101", "each once"],
        ..SOUND
    },
    Fault {
        what: "two incidences alike",
        case: Some((
            "shape_reference",
            "lattice = { alphas_deg = [1.0, 1.0] }\nshape_reference",
        )),
        message: &["incidences of the two strip files", "two different angles"],
        ..SOUND
    },
    Fault {
        what: "too slow to fly",
        case: Some(("speed = 50.0", "speed = 5.0")),
        message: &["aircraft.avl", "alpha", "cannot be reached"],
        ..SOUND
    },
    Fault {
        what: "shares of the engines",
        case: Some((
            "[bode]",
            "[[engine]]\nname = \"left\"\ngrid = 302\nshare = 0.4\n[[variant]]\nname = \"v\"\nthrust_line = \"engines\"\n[bode]",
        )),
        message: &["shares of the engines", "0.4", "sum of 1"],
        ..SOUND
    },
    Fault {
        what: "chord of zero",
        geometry: Some(("2.12  8.0  0.70  0.70", "2.12  8.0  0.70  0.0")),
        message: &["aircraft.avl", "surface \"Wing\", section 5", "chord is 0"],
        ..SOUND
    },
    Fault {
        what: "negative chord",
        geometry: Some(("2.12  8.0  0.70  0.70", "2.12  8.0  0.70  -0.70")),
        message: &["aircraft.avl", "surface \"Wing\", section 5", "chord is -0.7"],
        ..SOUND
    },
    Fault {
        what: "two sections in one place",
        geometry: Some(("2.12  8.0  0.70  0.70", "2.088  7.2  0.66  0.70")),
        message: &["aircraft.avl", "surface \"Wing\", section 4", "distance"],
        ..SOUND
    },
    Fault {
        what: "NaN in a section",
        geometry: Some(("2.12  8.0  0.70", "2.12  NaN  0.70")),
        message: &["aircraft.avl:45", "NaN"],
        ..SOUND
    },
    Fault {
        what: "NaN as the gain of a control, which AVL may lack",
        geometry: Some(("aileron  1.0  0.75", "aileron  NaN  0.75")),
        message: &["aircraft.avl:37", "NaN", "not a finite number"],
        ..SOUND
    },
    Fault {
        what: "infinity as the hinge of a control",
        geometry: Some(("aileron  1.0  0.75", "aileron  1.0  inf")),
        message: &["aircraft.avl:37", "inf", "not a finite number"],
        ..SOUND
    },
    Fault {
        what: "stars as the hinge of a control",
        geometry: Some(("aileron  1.0  0.75", "aileron  1.0  ****")),
        message: &["aircraft.avl:37", "****"],
        ..SOUND
    },
    Fault {
        what: "NaN as the profile drag, which AVL may lack",
        geometry: Some(("\n0.020\n", "\nNaN\n")),
        message: &["aircraft.avl:11", "NaN", "not a finite number"],
        ..SOUND
    },
    Fault {
        what: "negative Mach number of the geometry",
        geometry: Some(("# Mach number\n0.0", "# Mach number\n-0.3")),
        message: &["aircraft.avl", "Mach number is -0.3"],
        ..SOUND
    },
    Fault {
        what: "control without effect",
        case: Some(("trim_control = \"elevator\"", "trim_control = \"rudder\"")),
        message: &["aircraft.avl", "Cm"],
        ..SOUND
    },
];

#[test]
fn val_faults_are_refused_with_quantity_and_place() {
    let put = |text: &str, change: Option<(&str, &str)>| match change {
        Some((from, to)) => with(text, from, to),
        None => text.to_owned(),
    };
    for fault in FAULTS {
        let case = put(CASE, fault.case);
        let deck = put(DECK, fault.deck);
        let geometry = put(GEOMETRY, fault.geometry);
        let message = match flown(&case, &deck, &geometry) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{}: not refused", fault.what),
        };
        for part in fault.message {
            assert!(
                message.contains(part),
                "{}: no `{part}` in: {message}",
                fault.what
            );
        }
    }
}

/// All masses and inertias zero.
#[test]
fn val_zero_mass_is_refused() {
    let mut deck = String::new();
    for line in DECK.lines() {
        // CONM2 and their continuations, whose first field is blank.
        let fields: Vec<&str> = line.split(',').collect();
        let line = match fields.as_slice() {
            ["CONM2", id, grid, ..] => format!("CONM2,{id},{grid},,0."),
            ["", ..] => continue,
            _ => line.to_owned(),
        };
        deck.push_str(&line);
        deck.push('\n');
    }
    let message = flown(CASE, &deck, GEOMETRY).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("no free freedom carries mass"), "{message}");
    assert!(message.contains("CONM2"), "{message}");
}

/// A wing that is there twice: once as a surface of the same name, once under another.
#[test]
fn val_coincident_strips_are_refused() {
    let start = GEOMETRY.find("SURFACE\nWing").unwrap();
    let end = start + 7 + GEOMETRY[start + 7..].find("SURFACE").unwrap();
    let wing = &GEOMETRY[start..end];
    let twice = format!("{GEOMETRY}\n{wing}");
    let message = flown(CASE, DECK, &twice).map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("aircraft.avl"), "{message}");
    assert!(
        message.contains("of `Wing` and strip") && message.contains("in one place"),
        "{message}"
    );
}

/// One mode, and as many as the deck has: both fly, with finite numbers, and hardly differ in trim, since the flight
/// shape is the reference.
#[test]
fn val_one_mode_and_all_modes_fly() {
    let (usual, _) = flown(CASE, DECK, GEOMETRY).unwrap();
    assert_eq!(usual.basis.modes.len(), 12);
    for count in [1, 174] {
        let case = with(CASE, "modes = 12", &format!("modes = {count}"));
        let (model, numbers) = flown(&case, DECK, GEOMETRY).unwrap();
        assert_eq!(model.basis.modes.len(), count);
        assert!(numbers.len() > 400 && numbers.iter().all(|v| v.is_finite()));
    }
}

/// Damage of a results file, and of the tables of corrections, in the F25-like case.
#[test]
fn val_numbers_of_tables_are_refused() {
    use albatross::tables::{longitudinal, slope_table};
    for value in ["NaN", "inf", "-Infinity", "1e999", "", "****"] {
        let text = format!("surface,y,cl_alpha\nWing,1.0,{value}\n");
        let message = slope_table(&text, "slopes.csv", "test").unwrap_err().to_string();
        assert!(
            message.starts_with("slopes.csv:2: column `cl_alpha`"),
            "{message}"
        );
        let text = format!("surface,y,cl_alpha\nWing,{value},5.0\n");
        let message = slope_table(&text, "slopes.csv", "test").unwrap_err().to_string();
        assert!(message.starts_with("slopes.csv:2: column `y`"), "{message}");
    }
    for value in ["1e999", "NaN", "\"5.0\"", "null", "[1.0]"] {
        let text = format!("{{\"CLa\": {value}}}");
        let message = longitudinal(&text, "derivatives.json").unwrap_err().to_string();
        assert!(message.starts_with("derivatives.json"), "{message}");
    }
}

/// Parts of a model that were made apart: a trim that keeps the quaternion, slopes of other strips, fewer shapes.
#[test]
fn regress_parts_that_do_not_belong_together() {
    let directory = written(
        &with(CASE, "[flight]", "[flight]\nattitude = \"quaternion\""),
        DECK,
        GEOMETRY,
    );
    let mut inputs = Inputs::read(&directory.path().join("case.toml")).unwrap();
    let variant = inputs.case.variant(None).unwrap();
    let mut model = Model::build(&inputs, &variant).unwrap();
    let trimmed = albatross::analysis::trimmed_for_simulation(&model).unwrap();
    let message = mode_table_without_lags(&model, &trimmed).unwrap_err().to_string();
    assert!(
        message.contains("Quaternion") && message.contains("analysis::trimmed"),
        "{message}"
    );

    let whole = albatross::shapes::mode_shapes(&inputs, &model);
    assert!(whole.render().is_ok());
    model.strips.shapes.gamma = Mat::zeros(0, 0);
    assert!(albatross::shapes::mode_shapes(&inputs, &model).render().is_err());

    inputs.slopes_between = Some(Mat::zeros(1, 1));
    let message = Model::build(&inputs, &variant).unwrap_err().to_string();
    assert!(
        message.contains("lift slopes between strips: found 1 x 1"),
        "{message}"
    );
    assert_eq!(
        albatross::root_locus::speeds_around(100.0, 0.5, 1.5, usize::MAX).len(),
        10_000
    );
}
