//! Options of the case file: what must not change the result does not, what must changes it as physics says.

use crate::support::{CaseCopy, json};
use serde_json::Value;

/// The result of a command on the F25-like case with texts replaced.
fn with(changes: &[(&str, &str)], command: &[&str]) -> Value {
    let copy = CaseCopy::new();
    for (from, to) in changes {
        copy.replace("case.toml", from, to);
    }
    let case = copy.arg("case.toml");
    let (stage, rest) = command.split_first().unwrap();
    let arguments: Vec<&str> = [*stage, &case, "--json", "--quiet"]
        .iter()
        .chain(rest)
        .copied()
        .collect();
    json(&arguments)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        other => vec![number(other)],
    }
}

/// Largest difference over the largest magnitude.
fn difference(a: &Value, b: &Value) -> f64 {
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    a.iter().zip(&b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / largest
}

/// Frequency \[rad/s\] and damping of the short period of the flexible aircraft. Quasi-steady, since the lags hardly
/// act so slowly, and without their states the modes are found at once.
fn short_period(changes: &[(&str, &str)]) -> (f64, f64) {
    let quasi_steady = (
        "name = \"avl\"\n",
        "name = \"avl\"\nfidelity = \"quasi_steady\"\n",
    );
    let changes: Vec<(&str, &str)> = changes.iter().copied().chain([quasi_steady]).collect();
    let table = with(&changes, &["modes-table"]);
    let modes = table["rigid_body"].as_array().unwrap();
    let mode = modes.iter().find(|m| m["name"] == "short period").unwrap();
    (
        number(&mode["flexible"]["omega_rad_s"]),
        number(&mode["flexible"]["damping_ratio"]),
    )
}

const AERODYNAMICS: &str = "[aerodynamics]\n";
const SIGNAL_0P5HZ: &str =
    "{ kind = \"doublet\", amplitude_deg = 1.6, start = 0.5, frequency_hz = 0.5, edges = \"smooth\" }";

/// Two ways to say the same: the same matrices.
#[test]
fn val_equal_inputs_give_equal_models() {
    let base = with(&[], &["linearize"]);
    let ratios = format!("damping_ratio = {:?} ", [0.01; 20]);
    let numbers = format!("modes = {:?} ", (7..27).collect::<Vec<_>>());
    // Matrices are equal to the order of their sums.
    for (from, to, tolerance) in [
        ("damping_ratio = 0.01 ", ratios.as_str(), 0.0),
        ("modes = 20 ", numbers.as_str(), 0.0),
        (
            "1000 THRU 1025\"",
            "1000 THRU 1010\", 1011, \"1012 THRU 1025 BY 1\"",
            0.0,
        ),
        (AERODYNAMICS, "[aerodynamics]\nsplit = \"theodorsen\"\n", 1e-13),
    ] {
        let other = with(&[(from, to)], &["linearize"]);
        for matrix in ["a", "b", "c", "d"] {
            let difference = difference(&base[matrix], &other[matrix]);
            assert!(
                difference <= tolerance,
                "{to}: {matrix} differs by {difference:e}"
            );
        }
    }
}

/// The speed that the Mach number means gives the same trim.
#[test]
fn val_speed_and_mach() {
    let base = with(&[], &["trim"]);
    let speed = format!("speed = {:e}", number(&base["speed"]));
    let other = with(&[("mach = 0.78", &speed)], &["trim"]);
    assert!((number(&other["mach"]) - 0.78).abs() < 1e-14);
    assert!((number(&other["alpha_deg"]) - number(&base["alpha_deg"])).abs() < 1e-10);
}

/// Where modes count from does not change the small motion of a linear structure: the short period is that of the other
/// trim but for the trim's incidence, less than 0.1 %. Only the jig shape has modes in trim.
#[test]
fn val_reference_shape() {
    let jig = [("shape_reference = \"trimmed\"", "shape_reference = \"jig\"")];
    let (omega, damping) = short_period(&[]);
    let (jig_omega, jig_damping) = short_period(&jig);
    assert!((jig_omega / omega - 1.0).abs() < 1e-3, "{jig_omega} {omega}");
    assert!(
        (jig_damping / damping - 1.0).abs() < 1e-3,
        "{jig_damping} {damping}"
    );
    assert!(
        numbers(&with(&[], &["trim"])["eta"])
            .iter()
            .all(|eta| *eta == 0.0)
    );
    let bent = with(&jig, &["trim"]);
    // The wing bends up and, swept back, washes out: more incidence.
    assert!(number(&bent["alpha_deg"]) > 1.6, "{}", bent["alpha_deg"]);
}

/// Five degrees of dihedral: the general form moves the short period by the order of 1 - cos(5 deg) = 0.4 %.
#[test]
fn val_dihedral_form() {
    let general = [(AERODYNAMICS, "[aerodynamics]\ndihedral = \"general\"\n")];
    let (omega, _) = short_period(&[]);
    let (general, _) = short_period(&general);
    let change = general / omega - 1.0;
    assert!(change.abs() < 5e-3 && change != 0.0, "{change}");
}

/// Both methods solve the same equations; a smooth doublet at 1 ms is resolved to 1e-6 of the peaks by either.
#[test]
fn val_exact_lags_and_runge_kutta() {
    let command = ["simulate", "--manoeuvre", "doublet_0p5Hz"];
    let short = ("end = 10.0\n", "end = 2.0\n");
    let base = with(&[short], &command);
    let exact = with(
        &[("end = 10.0\n", "end = 2.0\nmethod = \"exact_lags\"\n")],
        &command,
    );
    for (a, b) in base["channels"]
        .as_array()
        .unwrap()
        .iter()
        .zip(exact["channels"].as_array().unwrap())
    {
        let (a, b) = (numbers(&a["values"]), numbers(&b["values"]));
        let peak = a.iter().fold(0.0_f64, |m, v| m.max((v - a[0]).abs()));
        let error = a.iter().zip(&b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
        assert!(error <= 1e-6 * peak, "{error} of {peak}");
    }
}

/// A signal read from a file is that signal: samples of the step of a control, as a total deflection that starts in
/// trim and as a deviation from it.
#[test]
fn val_signal_of_a_file() {
    let copy = CaseCopy::new();
    copy.write(
        "step.csv",
        "# a ramp of one step\ntime,total,deviation\n0.0,3.0,0.0\n0.1,3.0,0.0\n0.101,3.5,0.5\n",
    );
    let history = |signal: &str| {
        copy.restore("case.toml");
        copy.replace("case.toml", "end = 10.0\n", "end = 0.3\n");
        copy.replace("case.toml", SIGNAL_0P5HZ, signal);
        json(&["simulate", &copy.arg("case.toml"), "--json", "--quiet"])
    };
    let file = "kind = \"csv\", file = \"step.csv\", time_column = \"time\"";
    let total = history(&format!("{{ {file}, value_column = \"total\" }}"));
    let deviation = history(&format!(
        "{{ {file}, value_column = \"deviation\", offset = \"zero\" }}"
    ));
    assert_eq!(total, deviation);
    let channels = total["channels"].as_array().unwrap();
    let elevator = numbers(&channels.iter().find(|c| c["name"] == "elevator").unwrap()["values"]);
    let moved = (elevator[300] - elevator[0]).to_degrees();
    assert!((moved - 0.5).abs() < 1e-12, "{moved}");
}

/// Thrust below the centre of gravity raises the nose: the elevator goes down, and the total thrust hardly changes.
#[test]
fn val_engines_in_place() {
    let base = with(&[], &["trim"]);
    let engines = with(&[], &["trim", "--variant", "engines_in_place"]);
    assert!(number(&engines["controls_deg"]["elevator"]) > number(&base["controls_deg"]["elevator"]) + 0.1);
    assert!((number(&engines["thrust"]) / number(&base["thrust"]) - 1.0).abs() < 1e-2);
}
