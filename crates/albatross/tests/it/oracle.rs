//! The neutral models against an independent numpy implementation (fixtures/oracle) that follows docs/FORMATS.md.
//!
//! Tolerances, relative to the largest entry of each array: matrices and trims 1e-10, eigenvalues 1e-8, flutter 1e-6,
//! time histories 1e-7 of the peak. What is reached is tighter; these bound differences of compilers and libraries.

use albatross::neutral::{aircraft, wing};
use albatross::strip::flutter::{divergence_speed, exact_flutter, lag_flutter};
use albatross::strip::kernels;
use albatross::strip::section::TypicalSection;
use serde_json::{Value, json};

fn fixture(name: &str) -> Value {
    let path = format!("{}/../../fixtures/oracle/{name}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap()
}

fn flatten(value: &Value, into: &mut Vec<f64>) {
    match value {
        Value::Array(items) => items.iter().for_each(|v| flatten(v, into)),
        Value::Object(map) => map.values().for_each(|v| flatten(v, into)),
        other => into.push(other.as_f64().unwrap_or_else(|| panic!("not a number: {other}"))),
    }
}

/// Largest difference over the largest magnitude of the expected array.
fn difference(found: &Value, expected: &Value) -> f64 {
    let (mut a, mut b) = (Vec::new(), Vec::new());
    flatten(found, &mut a);
    flatten(expected, &mut b);
    assert_eq!(a.len(), b.len(), "sizes differ");
    let scale = b.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let worst = a.iter().zip(&b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
    if scale == 0.0 { worst } else { worst / scale }
}

fn check(found: &Value, expected: &Value, tolerance: f64, what: &str) {
    let d = difference(found, expected);
    println!("{what}: {d:.1e}");
    assert!(d <= tolerance, "{what}: {d:e} > {tolerance:e}");
}

#[test]
fn val_kernels() {
    let oracle = fixture("kernels_section_isa.json");
    let k = &oracle["kernels"];
    let list = |key: &str| -> Vec<f64> { serde_json::from_value(k[key].clone()).unwrap() };
    let parts = |f: &dyn Fn(f64) -> albatross::numerics::C64| {
        let values: Vec<_> = list("k").into_iter().map(f).collect();
        json!({ "re": values.iter().map(|v| v.re).collect::<Vec<_>>(), "im": values.iter().map(|v| v.im).collect::<Vec<_>>() })
    };
    check(&parts(&kernels::theodorsen), &k["C_exact"], 1e-13, "C(k)");
    check(
        &parts(&|k| kernels::theodorsen_lags(&kernels::JONES, k)),
        &k["C_jones"],
        1e-14,
        "C(k), Jones",
    );
    let over = |f: &dyn Fn(f64) -> f64| json!(list("s").into_iter().map(f).collect::<Vec<_>>());
    // The file's quadratures are good to 2e-10 (Wagner) and 3e-5 (Kuessner): the strip crate's own test holds both
    // functions to 1e-12 of 30-digit values.
    check(&over(&kernels::wagner), &k["wagner_exact"], 5e-10, "Wagner");
    check(&over(&kernels::kuessner), &k["kussner_exact"], 5e-5, "Kuessner");
    check(
        &over(&|s| kernels::indicial_lags(&kernels::JONES, s)),
        &k["wagner_jones"],
        1e-14,
        "Wagner, Jones",
    );
    check(
        &over(&|s| kernels::indicial_lags(&kernels::KUESSNER_SEARS, s)),
        &k["kussner_jones"],
        1e-14,
        "Kuessner, Sears",
    );
    // Largest error of Jones's C(k) over k = 1e-3 .. 10, from a scan as the oracle made it.
    let worst = (0..=4000)
        .map(|i| 10f64.powf(-3.0 + f64::from(i) / 1000.0))
        .fold(0.0_f64, |m, k| {
            m.max((kernels::theodorsen(k) - kernels::theodorsen_lags(&kernels::JONES, k)).norm())
        });
    assert!(
        (worst / k["max_abs_err_C_jones"].as_f64().unwrap() - 1.0).abs() < 1e-4,
        "{worst}"
    );
}

#[test]
fn val_atmosphere() {
    for row in fixture("kernels_section_isa.json")["isa"].as_array().unwrap() {
        let air = albatross::flight::atmosphere::standard(row["h"].as_f64().unwrap());
        let found = json!([air.temperature, air.pressure, air.density, air.speed_of_sound]);
        for (found, key) in found.as_array().unwrap().iter().zip(["T", "p", "rho", "a"]) {
            check(found, &row[key], 1e-13, key);
        }
    }
}

#[test]
fn val_typical_section() {
    let oracle = fixture("kernels_section_isa.json");
    let (given, expected) = (
        &oracle["nasa_tp_2015_218765"]["inputs"],
        &oracle["nasa_tp_2015_218765"]["expected"],
    );
    let value = |key: &str| given[key].as_f64().unwrap();
    let section = TypicalSection {
        mass: value("m"),
        static_moment: value("S_cg_aft_positive"),
        inertia: value("I_ea"),
        plunge_stiffness: value("k_h"),
        pitch_stiffness: value("k_alpha"),
        semi_chord: value("b"),
        axis: value("a"),
        cl_alpha: value("cl_alpha"),
    };
    let rho = value("rho");
    let model = section.model(&kernels::JONES).unwrap();
    let point = |f: albatross::strip::flutter::Flutter| json!([f.speed, f.omega_rad_s]);
    let pair = |v: &Value| json!([v["V"], v["omega"]]);
    let exact = exact_flutter(&model, rho).unwrap().unwrap();
    check(
        &point(exact),
        &pair(&expected["exact_theodorsen"]),
        1e-10,
        "exact",
    );
    let jones = lag_flutter(&model, rho).unwrap().unwrap();
    check(
        &point(jones),
        &pair(&expected["jones_state_space"]),
        1e-10,
        "Jones",
    );
    let instant = lag_flutter(&section.model(&[]).unwrap(), rho).unwrap().unwrap();
    check(
        &point(instant),
        &pair(&expected["C_equal_1_with_NC"]),
        1e-10,
        "C = 1",
    );
    let divergence = divergence_speed(&model, rho).unwrap().unwrap();
    check(&json!(divergence), &expected["divergence_V"], 1e-12, "divergence");
    let at = &expected["eig_at"];
    let flow = albatross::strip::Flow {
        rho,
        speed: at["V"].as_f64().unwrap(),
    };
    let a = albatross::strip::elastic::state_matrix(&model, flow).unwrap();
    let values = albatross::numerics::eigen::eigenvalues(a.as_ref()).unwrap();
    // The oracle's file lists them by real part; compare as sets.
    let mut found: Vec<(f64, f64)> = values.iter().map(|v| (v.re, v.im)).collect();
    let re: Vec<f64> = serde_json::from_value(at["jones"]["re"].clone()).unwrap();
    let im: Vec<f64> = serde_json::from_value(at["jones"]["im"].clone()).unwrap();
    for (re, im) in re.into_iter().zip(im) {
        let nearest = found
            .iter()
            .enumerate()
            .map(|(i, v)| (i, (v.0 - re).hypot(v.1 - im)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert!(nearest.1 < 1e-8 * 100.0, "{re} {im}: {}", nearest.1);
        found.swap_remove(nearest.0);
    }
}

#[test]
fn val_goland_wing() {
    let oracle = fixture("goland_wing.json");
    let expected = &oracle["neutral_case"]["expected"];
    let mut case = oracle["neutral_case"].clone();
    case["rho"] = oracle["inputs"]["rho"].clone();
    case["speeds"] = json!([expected["eig"]["V"]]);
    let wing = wing::read(&case.to_string(), "goland_wing.json").unwrap();
    let found = wing::analyse(&wing, "goland_wing.json").unwrap();
    for (key, value) in expected["Q"].as_object().unwrap() {
        check(&found["Q"][key], value, 1e-10, key);
    }
    for key in ["jones", "exact"] {
        check(&found[key], &expected[key], 1e-6, key);
    }
    check(
        &found["divergence_V"],
        &expected["divergence_V"],
        1e-8,
        "divergence",
    );
    assert_eq!(found["eig"][0]["V"], expected["eig"]["V"]);
    check(
        &found["eig"][0]["values"],
        &expected["eig"]["values"],
        1e-8,
        "eigenvalues",
    );
}

#[test]
fn val_small_aircraft() {
    let oracle = fixture("aircraft_small.json");
    let expected = &oracle["expected"];
    let mut inputs = oracle["inputs"].clone();
    inputs["runs"] = json!(
        expected["runs"]
            .as_object()
            .unwrap()
            .iter()
            .map(|(frequency, run)| {
                let mut request = run.clone();
                request["frequency_hz"] = json!(frequency.parse::<f64>().unwrap());
                request
            })
            .collect::<Vec<_>>()
    );
    let read = aircraft::read(&inputs.to_string(), "aircraft_small.json").unwrap();
    let found = aircraft::analyse(&read, "aircraft_small.json").unwrap();
    assert_eq!(
        found.as_object().unwrap().keys().collect::<Vec<_>>(),
        expected.as_object().unwrap().keys().collect::<Vec<_>>(),
        "same keys in the same order"
    );
    for block in [
        "Q",
        "FM_rows_Fz_Mx_My",
        "Pi",
        "trim",
        "trim_quasi_steady",
        "trim_rigid",
    ] {
        for (key, value) in expected[block].as_object().unwrap() {
            check(&found[block][key], value, 1e-10, &format!("{block}.{key}"));
        }
    }
    for key in ["QX", "Qu", "Q0"] {
        check(&found[key], &expected[key], 1e-10, key);
    }
    assert_eq!(found["n_states"], expected["n_states"]);
    assert_eq!(found["state_order"], expected["state_order"]);
    for key in ["eig_unsteady", "eig_quasi_steady", "eig_rigid"] {
        for part in ["re", "im"] {
            check(
                &found[key][part],
                &expected[key][part],
                1e-8,
                &format!("{key}.{part}"),
            );
        }
    }
    for part in ["re", "im"] {
        check(
            &found["bode"]["response"][part],
            &expected["bode"]["response"][part],
            1e-8,
            &format!("bode.{part}"),
        );
    }
    for (frequency, run) in expected["runs"].as_object().unwrap() {
        let ours = &found["runs"][frequency];
        check(&ours["t"], &run["t"], 1e-12, "t");
        let column = |v: &Value, i: usize| {
            json!(
                v["nonlinear"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|r| r[i].clone())
                    .collect::<Vec<_>>()
            )
        };
        for i in 0..7 {
            check(
                &column(ours, i),
                &column(run, i),
                1e-7,
                &format!("run {frequency} Hz, output {i}"),
            );
        }
    }
}
