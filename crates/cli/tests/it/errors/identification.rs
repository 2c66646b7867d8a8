//! Records and models that cannot be used, and warnings.

use super::Example;

const IDENTIFY: &[&str] = &[
    "identify",
    "CASE/record.csv",
    "--input",
    "u",
    "--output",
    "y",
    "--np",
    "4",
    "--quiet",
];

pub(super) const FAILURES: &[Example] = &[
    Example {
        name: "identify-no-file",
        command: IDENTIFY,
        damage: |_| (),
    },
    Example {
        name: "identify-unknown-column",
        command: &[
            "identify",
            "CASE/reference/doublet_3Hz.csv",
            "--input",
            "elevatr",
            "--output",
            "q",
            "--np",
            "4",
            "--quiet",
        ],
        damage: |_| (),
    },
    Example {
        name: "identify-not-a-number",
        command: IDENTIFY,
        damage: |c| {
            let lost = |k: usize, row| if k == 25 { "0.50,0.8,NaN\n".to_owned() } else { row };
            c.write("record.csv", &record(lost));
        },
    },
    Example {
        name: "identify-decimal-commas",
        command: IDENTIFY,
        damage: |c| {
            let text = record(|_, row| row).replace(',', ";").replace('.', ",");
            c.write("record.csv", &text);
        },
    },
    Example {
        name: "identify-cells-missing",
        command: IDENTIFY,
        damage: |c| {
            let short = |k: usize, row: String| if k == 50 { "1.00,-0.8\n".to_owned() } else { row };
            c.write("record.csv", &record(short));
        },
    },
    Example {
        name: "identify-gap-in-time",
        command: IDENTIFY,
        damage: |c| {
            let gap = |k: usize, row| if (60..65).contains(&k) { String::new() } else { row };
            c.write("record.csv", &record(gap));
        },
    },
    Example {
        name: "identify-constant-output",
        command: IDENTIFY,
        damage: |c| {
            let still = |_: usize, row: String| {
                let end = row.rfind(',').unwrap();
                format!("{},0.25\n", &row[..end])
            };
            c.write("record.csv", &record(still));
        },
    },
    Example {
        name: "identify-too-few-samples",
        command: IDENTIFY,
        damage: |c| {
            let short = |k: usize, row| if (15..25).contains(&k) { row } else { String::new() };
            c.write("record.csv", &record(short));
        },
    },
    Example {
        name: "identify-zeros",
        command: &[
            "identify",
            "CASE/record.csv",
            "--input",
            "u",
            "--output",
            "y",
            "--np",
            "4",
            "--nz",
            "5",
            "--quiet",
        ],
        damage: |c| c.write("record.csv", &record(|_, row| row)),
    },
    Example {
        name: "compare-nothing",
        command: &["compare", "CASE/model.json"],
        damage: |_| (),
    },
    Example {
        name: "compare-no-model",
        command: &[
            "compare",
            "CASE/f25_reference.json",
            "--reference",
            "CASE/system.json",
        ],
        damage: |_| (),
    },
    Example {
        name: "compare-unknown-output",
        command: &[
            "compare",
            "CASE/system.json",
            "--output",
            "alpha",
            "--reference",
            "CASE/system.json",
        ],
        damage: |c| c.write("system.json", SYSTEM),
    },
];

/// Warnings of identification: the command succeeds, and its summary ends with them.
pub(super) const WARNINGS: &[Example] = &[
    Example {
        name: "warning-order",
        command: &[
            "identify",
            "CASE/record.csv",
            "--input",
            "u",
            "--output",
            "y",
            "--np",
            "8",
            "--quiet",
        ],
        damage: |c| c.write("record.csv", &record(noisy)),
    },
    Example {
        name: "warning-unstable",
        command: &[
            "identify",
            "CASE/record.csv",
            "--input",
            "u",
            "--output",
            "y",
            "--np",
            "1",
            "--unstable",
            "--quiet",
        ],
        damage: |c| c.write("record.csv", &response(-0.8, |_, row| row)),
    },
];

const SYSTEM: &str = r#"{
  "a": [[-1.0]], "b": [[1.0]], "c": [[1.0]], "d": [[0.0]],
  "states": [{"name": "x", "unit": "1"}], "inputs": [{"name": "u", "unit": "1"}], "outputs": [{"name": "y", "unit": "1"}]
}"#;

/// Samples every 0.02 s of the response of 3/(s + 2) to a doublet; each row may be changed.
fn record(change: impl Fn(usize, String) -> String) -> String {
    response(2.0, change)
}

/// Of 3/(s + rate).
fn response(rate: f64, change: impl Fn(usize, String) -> String) -> String {
    let mut text = "t,u,y\n".to_owned();
    let (decay, mut x) = ((-0.02 * rate).exp(), 0.0);
    for k in 0..200_usize {
        let u = match k {
            20..40 => 0.8,
            40..60 => -0.8,
            _ => 0.0,
        };
        text += &change(k, format!("{:.2},{u},{:.6}\n", 0.02 * k as f64, 3.0 * x));
        x = decay * x + (1.0 - decay) / rate * u;
    }
    text
}

/// Adds noise of a linear congruential generator (Numerical Recipes).
fn noisy(k: usize, row: String) -> String {
    let mut state = 17_u32;
    for _ in 0..=k {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    }
    let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
    let end = row.rfind(',').unwrap();
    let y: f64 = row[end + 1..].trim().parse().unwrap();
    format!("{},{:.6}\n", &row[..end], y + 0.02 * noise)
}
