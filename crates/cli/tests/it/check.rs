//! `albatross check`: the shipped case passes, and each of many mistakes seeded in a copy of it is found with its cure.

use crate::support::{CaseCopy, albatross, case, fixtures, json};
use serde_json::Value;

/// A mistake in a copy of the F25-like case, and what must be said about it.
struct Seed {
    damage: fn(&CaseCopy),
    severity: &'static str,
    /// Where: the end of the place, or a part of it.
    place: &'static str,
    what: &'static str,
    cure: &'static str,
}

const SEEDS: &[Seed] = &[
    Seed {
        damage: |c| c.replace("case.toml", "trim_control", "trimcontrol"),
        severity: "error",
        place: "case.toml:59",
        what: "`trimcontrol` is no key here",
        cure: "did you mean `trim_control`?",
    },
    Seed {
        damage: |c| c.replace("case.toml", "damping_ratio = 0.01", "# none"),
        severity: "error",
        place: "case.toml:7",
        what: "missing field `damping_ratio`",
        cure: "add the structural damping as a ratio of critical",
    },
    Seed {
        damage: |c| c.replace("case.toml", "deck = \"f25.bdf\"", "deck = \"F25.dat\""),
        severity: "error",
        place: "case.toml:8",
        what: "there is no file `F25.dat`",
        cure: "did you mean `f25.",
    },
    // Units.
    Seed {
        damage: |c| scale_grids(c, 1000.0),
        severity: "error",
        place: "f25.bdf",
        what: "the deck looks like mm",
        cure: "give the deck in m, kg, N and Pa",
    },
    Seed {
        damage: |c| {
            c.replace(
                "f25.bdf",
                "PARAM     GRDPNT",
                "PARAM     WTMASS    .001\nPARAM     GRDPNT",
            )
        },
        severity: "warning",
        place: "f25.bdf",
        what: "masses look like tonnes",
        cure: "give masses in kg",
    },
    Seed {
        damage: |c| c.replace("f25.bdf", "7.+10  2.7+10", " 7.+4   2.7+4"),
        severity: "warning",
        place: "f25.bdf:17",
        what: "E = 7e4 looks like MPa",
        cure: "E and G times 1e6",
    },
    Seed {
        damage: |c| c.replace("case.toml", "path_angle_deg = 0.0", "gravity = 9806.65"),
        severity: "error",
        place: "case.toml:58",
        what: "looks like mm/s2",
        cure: "give m/s2",
    },
    Seed {
        damage: |c| c.replace("case.toml", "altitude = 10258.0", "altitude = 33656.0"),
        severity: "error",
        place: "case.toml:57",
        what: "an altitude of 33656 m",
        cure: "33656 ft is 10258 m",
    },
    // Structure.
    Seed {
        damage: |c| {
            c.replace(
                "f25.bdf",
                "900002    1001       0876.5767",
                "900002    1001       0776.5767",
            )
        },
        severity: "error",
        place: "f25.bdf",
        what: "the deck's mass is 80918.49 kg, the weight generator of f25.f06 printed 81018.49 kg",
        cure: "different mass states",
    },
    Seed {
        damage: |c| c.replace("case.toml", "1000 THRU 1025", "1000 THRU 1026"),
        severity: "error",
        place: "case.toml:17",
        what: "axis `wing_right` has grids that the deck lacks: 1026",
        cure: "near them are 1024, 1025",
    },
    Seed {
        damage: |c| {
            c.replace("f25.bdf", "METHOD = 10", "METHOD = 10\nSPC = 1");
            c.replace("f25.bdf", "MAT1  ", "SPC1           1  123456    1000\nMAT1  ");
        },
        severity: "warning",
        place: "f25.bdf",
        what: "constraints hold the aircraft",
        cure: "take the SPC out of case control",
    },
    Seed {
        damage: |c| c.replace("case.toml", "damping_ratio = 0.01", "damping_ratio = 0.5"),
        severity: "warning",
        place: "case.toml:11",
        what: "a structural damping ratio of 0.5",
        cure: "1 % is 0.01",
    },
    Seed {
        damage: |c| c.replace("case.toml", "modes = 20", "modes = 40"),
        severity: "error",
        place: "f25.f06",
        what: "40 elastic modes are asked for",
        cure: "raise the number of modes on EIGRL",
    },
    Seed {
        damage: |c| c.replace("f25.mass", "20.34355", "21.34355"),
        severity: "warning",
        place: "f25.mass",
        what: "its centre of gravity is at 21.3436, 0, -0.4277, that of the deck at 20.3435, 0, -0.4277",
        cure: "one mass state",
    },
    // Aerodynamics.
    Seed {
        damage: |c| c.replace("f25.avl", "130.1000", "65.0500"),
        severity: "error",
        place: "trim.st",
        what: "Sref is 130.1 here and 65.05 in f25.avl",
        cure: "run AVL again with this geometry",
    },
    Seed {
        damage: |c| {
            c.replace("f25.avl", "130.1000", "65.0500");
            c.replace("avl_out/trim.st", "Sref =  130.10", "Sref =  65.050");
        },
        severity: "warning",
        place: "trim.st",
        what: "the reference area is 65.05 m2, the strips of `Wing` make 130.52",
        cure: "correct Sref",
    },
    Seed {
        damage: |c| c.replace("avl_out/trim.st", "Mach  =     0.692", "Mach  =     0.300"),
        severity: "warning",
        place: "trim.st",
        what: "AVL ran at Mach 0.3, the flight is at 0.7800",
        cure: "run AVL at the Mach number",
    },
    Seed {
        damage: |c| c.replace("avl_out/trim.st", "CLtot =   0.56440", "CLtot =   0.26440"),
        severity: "warning",
        place: "trim.st",
        what: "the AVL run has CL = 0.2644, level flight needs 0.564",
        cure: "write the derivatives at the trimmed lift",
    },
    Seed {
        damage: |c| c.replace("case.toml", "alpha_deg = 2.0", "alpha_deg = 4.0"),
        severity: "warning",
        place: "case.toml:27",
        what: "the strips' lift slope is 2.4",
        cure: "the second would be near 2.0",
    },
    Seed {
        damage: |c| {
            c.replace(
                "case.toml",
                "[aerodynamics]\n",
                "[aerodynamics]\ndihedral = \"general\"\n",
            )
        },
        severity: "warning",
        place: "case.toml:25",
        what: "`VTP` has a lift slope of 0.000 a radian from two incidences",
        cure: "take lift_slopes = ",
    },
    Seed {
        damage: |c| c.replace("case.toml", "avl_out/alpha2.fs", "avl_out/alpha1.fs"),
        severity: "error",
        place: "case.toml:27",
        what: "both strip files are `avl_out/alpha1.fs`",
        cure: "two incidences",
    },
    Seed {
        damage: |c| {
            c.replace(
                "case.toml",
                "lra = \"wing_right\"\nimage_lra = \"wing_left\"",
                "lra = \"wing_left\"\nimage_lra = \"wing_right\"",
            )
        },
        severity: "error",
        place: "case.toml:37",
        what: "axis `wing_left` lies at y from -22.50 to 0.00 m, the strips of `Wing` from 0.16",
        cure: "exchange `lra` and `image_lra`",
    },
    Seed {
        damage: |c| c.replace("case.toml", "name = \"HTP\"", "name = \"HPT\""),
        severity: "error",
        place: "case.toml:41",
        what: "`HPT` is no surface of f25.avl",
        cure: "did you mean `HTP`?",
    },
    Seed {
        damage: |c| c.replace("case.toml", "image_lra = \"htp_left\"\n", ""),
        severity: "error",
        place: "case.toml:41",
        what: "`HTP` has a mirror image (YDUPLICATE), but no axis for it",
        cure: "add `image_lra`",
    },
    Seed {
        damage: |c| c.replace("avl_out/trim.st", "Cma =  -3.339259", "Cma =   3.339259"),
        severity: "warning",
        place: "trim.st",
        what: "a static margin of -46 %; the rigid aircraft is unstable",
        cure: "check the mass state",
    },
    // Flight and controls.
    Seed {
        damage: |c| c.replace("case.toml", "mach = 0.78", "mach = 0.95"),
        severity: "warning",
        place: "case.toml:56",
        what: "Mach 0.950 is above the range of the method",
        cure: "higher fidelity",
    },
    Seed {
        damage: |c| {
            c.replace(
                "case.toml",
                "trim_control = \"elevator\"",
                "trim_control = \"elevtor\"",
            )
        },
        severity: "error",
        place: "case.toml:59",
        what: "`elevtor` is no control of the AVL files",
        cure: "did you mean `elevator`?",
    },
    Seed {
        damage: |c| {
            c.replace(
                "case.toml",
                "trim_control = \"elevator\"",
                "trim_control = \"rudder\"",
            )
        },
        severity: "error",
        place: "case.toml:59",
        what: "`rudder` hardly changes the pitching moment",
        cure: "trim with a control that does: elevator",
    },
    // Engines, corrections, sensors, manoeuvres.
    Seed {
        damage: |c| c.replace("case.toml", "share = 0.5", "share = 0.6"),
        severity: "error",
        place: "case.toml:64",
        what: "the engines' shares of the thrust add up to 1.1",
        cure: "0.5 each for 2 equal engines",
    },
    Seed {
        damage: |c| {
            c.replace("case.toml", "corrections = true", "");
            c.replace("case.toml", "corrections = true", "");
        },
        severity: "warning",
        place: "case.toml:50",
        what: "[corrections] are named, but no variant uses them",
        cure: "add `corrections = true` to a [[variant]]",
    },
    Seed {
        damage: |c| c.replace("case.toml", "grid = 3003", "grid = 3999"),
        severity: "error",
        place: "case.toml:",
        what: "sensor `az_cockpit` is at grid 3999, which the deck lacks",
        cure: "near it are 3092, 3093, 4000, 4001",
    },
    Seed {
        damage: |c| c.replace("case.toml", "input = \"elevator\"", "input = \"elevatr\""),
        severity: "error",
        place: "case.toml:",
        what: "`doublet_0p5Hz` moves `elevatr`, which is no control",
        cure: "did you mean `elevator`?",
    },
    Seed {
        damage: |c| c.replace("case.toml", "amplitude_deg = 1.6", "amplitude_deg = 0.028"),
        severity: "warning",
        place: "case.toml:",
        what: "looks like radians",
        cure: "0.028 rad is 1.604 deg",
    },
    Seed {
        damage: |c| c.replace("case.toml", "dt = 0.001", "dt = 0.05"),
        severity: "error",
        place: "case.toml:",
        what: "a step of 0.05 s is too long for the mode at",
        cure: "give dt below",
    },
];

/// Writes every GRID of the deck with its coordinates times a factor.
fn scale_grids(copy: &CaseCopy, factor: f64) {
    let scaled = |line: &str| {
        let number = |from: usize| {
            let text = line[from..(from + 8).min(line.len())].trim();
            // Nastran leaves the E out: 1.5-3.
            let sign = text.rfind(['+', '-']).filter(|i| *i > 0);
            let full = sign.map_or(text.to_owned(), |i| format!("{}e{}", &text[..i], &text[i..]));
            factor * full.parse::<f64>().unwrap()
        };
        let id = line[8..16].trim();
        format!("GRID,{id},,{:.3},{:.3},{:.3}", number(24), number(32), number(40))
    };
    let deck = copy.read("f25.bdf");
    let lines: Vec<String> = deck
        .lines()
        .map(|l| {
            if l.starts_with("GRID  ") {
                scaled(l)
            } else {
                l.to_owned()
            }
        })
        .collect();
    copy.write("f25.bdf", &(lines.join("\n") + "\n"));
}

fn text<'a>(finding: &'a Value, key: &str) -> &'a str {
    finding[key].as_str().unwrap()
}

#[test]
fn val_every_seeded_mistake_is_found() {
    let mut missed = Vec::new();
    for seed in SEEDS {
        let copy = CaseCopy::new();
        (seed.damage)(&copy);
        let output = albatross(&["check", &copy.arg("case.toml"), "--json"]);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let findings = report["findings"].as_array().unwrap();
        let matches = |f: &&Value| {
            text(f, "severity") == seed.severity
                && text(f, "place").contains(seed.place)
                && text(f, "what").contains(seed.what)
                && text(f, "cure").contains(seed.cure)
        };
        let errors = report["errors"].as_u64().unwrap();
        assert_eq!(output.status.code(), Some(i32::from(errors > 0)), "{}", seed.what);
        if findings.iter().find(matches).is_none() {
            missed.push(format!("{}: {findings:#?}", seed.what));
        }
    }
    assert!(
        missed.is_empty(),
        "{} missed:\n{}",
        missed.len(),
        missed.join("\n")
    );
}

/// No false alarm on the shipped cases.
#[test]
fn val_shipped_cases_pass() {
    for case in [
        case(),
        fixtures().join("f25-like/case_solve.toml").display().to_string(),
    ] {
        let report = json(&["check", &case, "--strict", "--json"]);
        assert_eq!(
            (&report["errors"], &report["warnings"]),
            (&0.into(), &0.into()),
            "{report:#}"
        );
    }
}

/// A misspelt key does not hide what is wrong elsewhere.
#[test]
fn val_check_goes_on() {
    let copy = CaseCopy::new();
    copy.replace("case.toml", "modes = 20", "mode = 20");
    copy.replace("case.toml", "grid = 3003", "grid = 3999");
    copy.replace("avl_out/trim.st", "CLa =   7.296941", "CLa =   7.29x941");
    copy.replace("f25.mass", "81018.49", "71018.49");
    let output = albatross(&["check", &copy.arg("case.toml")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    for word in [
        "did you mean `modes`?",
        "3999",
        "7.29x941",
        "its mass is 71018.49 kg, that of the deck 81018.49 kg",
        "cannot be used",
    ] {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
}

/// Warnings pass, unless they are asked to count.
#[test]
fn val_strict() {
    let copy = CaseCopy::new();
    copy.replace("case.toml", "damping_ratio = 0.01", "damping_ratio = 0.5");
    let code = |arguments: &[&str]| albatross(arguments).status.code();
    let case = copy.arg("case.toml");
    assert_eq!(code(&["check", &case]), Some(0));
    assert_eq!(code(&["check", &case, "--strict"]), Some(1));
}

/// Files cut anywhere are told, not stumbled over: the exit code is that of findings.
#[test]
fn prop_cut_files_are_told() {
    let copy = CaseCopy::new();
    for file in [
        "case.toml",
        "f25.bdf",
        "f25.f06",
        "f25.avl",
        "f25.mass",
        "avl_out/trim.st",
        "avl_out/alpha1.fs",
        "reference/strips_reference.csv",
        "reference/derivatives_reference.json",
    ] {
        let text = copy.read(file);
        for share in [0.0, 0.03, 0.2, 0.55, 0.93] {
            let end = (share * text.len() as f64) as usize;
            copy.write(file, text.get(..end).unwrap_or_default());
            let output = albatross(&["check", &copy.arg("case.toml"), "--json"]);
            let code = output.status.code().unwrap();
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(code <= 1 && errors.is_empty(), "{file} cut at {end}: {errors}");
            let report: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(code == 1, report["errors"].as_u64().unwrap() > 0);
        }
        copy.restore(file);
    }
}

/// A neighbour of the name that is not there is offered, by `check` and by the other commands.
#[test]
fn val_names_that_may_be_meant() {
    let output = albatross(&["trim", &case(), "--variant", "corected"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("; did you mean `corrected`?"), "{message}");
}
