//! `docs/CASE.md` against the program: every key and choice that a case file may have stands on the page, no other does,
//! and its complete example runs.
//!
//! What the program takes is learnt from its own messages: an unknown key or choice is answered with the known ones.

use crate::support::{CaseCopy, failure, json, page};
use std::collections::BTreeSet;

type Names = BTreeSet<String>;

/// The section of the page under a heading, up to the next one.
fn section<'a>(text: &'a str, heading: &str) -> &'a str {
    let start = text
        .find(&format!("\n## {heading}\n"))
        .unwrap_or_else(|| panic!("no section {heading}"));
    let body = &text[start + 4..];
    &body[..body.find("\n## ").unwrap_or(body.len())]
}

/// Names in backticks.
fn quoted(text: &str) -> Names {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Rows of the tables of a section whose first cell is a single name in backticks: that name and the rest of the row.
fn rows(section: &str) -> Vec<(String, String)> {
    let row = |line: &str| {
        let mut cells = line.strip_prefix("| `")?.splitn(2, "` | ");
        Some((cells.next()?.to_owned(), cells.next()?.to_owned()))
    };
    section.lines().filter_map(row).collect()
}

/// The names that a message lists after "expected one of" or "expected".
fn expected(message: &str) -> Names {
    let list = message
        .split_once(", expected ")
        .unwrap_or_else(|| panic!("no list in {message}"))
        .1;
    quoted(list.split("; see").next().unwrap())
}

/// What the program answers to a case in which `from` is replaced by `to`.
fn answer(from: &str, to: &str) -> String {
    let copy = CaseCopy::new();
    copy.replace("case.toml", from, to);
    failure(&["trim", &copy.arg("case.toml"), "--quiet"])
}

/// Keys of the table that begins after `place`.
fn keys(place: &str) -> Names {
    expected(&answer(place, &format!("{place}not_a_key = 0\n")))
}

#[test]
fn val_every_key_is_documented() {
    let text = std::fs::read_to_string(page("CASE.md")).unwrap();
    for (heading, place) in [
        ("The document", "title = \"F25-like surrogate, cruise\"\n"),
        ("`[structure]`", "[structure]\n"),
        ("`[aerodynamics]`", "[aerodynamics]\n"),
        ("`[[aerodynamics.surface]]`", "[[aerodynamics.surface]]\n"),
        ("`[corrections]`", "[corrections]\n"),
        ("`[flight]`", "[flight]\n"),
        ("`[[engine]]`", "[[engine]]\n"),
        ("`[[variant]]`", "[[variant]]\n"),
        ("`[[sensor]]`", "[[sensor]]\n"),
        ("`[[manoeuvre]]`", "[[manoeuvre]]\n"),
        ("`[bode]`", "[bode]\n"),
    ] {
        // The second table of a section (quantities) has choices in its first column.
        let own = section(&text, heading).split("\n### ").next().unwrap();
        let documented: Names = rows(own)
            .into_iter()
            .map(|(key, _)| key)
            .filter(|key| !key.starts_with('"'))
            .collect();
        assert_eq!(documented, keys(place), "{heading}");
    }
    let inline = expected(&answer(
        "[flight]\n",
        "[aerodynamics.lattice]\nnot_a_key = 0\n\n[flight]\n",
    ));
    let lattice = section(&text, "`[aerodynamics]`").split("### ").nth(1).unwrap();
    assert_eq!(
        rows(lattice).into_iter().map(|(key, _)| key).collect::<Names>(),
        inline
    );
    let reference = expected(&answer("[flight]\n", "[reference]\nnot_a_key = 0\n\n[flight]\n"));
    let documented: Names = rows(section(&text, "`[reference]`"))
        .into_iter()
        .map(|(key, _)| key)
        .collect();
    assert_eq!(documented, reference);
}

#[test]
fn val_every_choice_is_documented() {
    let text = std::fs::read_to_string(page("CASE.md")).unwrap();
    for (heading, key, from) in [
        ("`[structure]`", "on_violation", "on_violation = \"refuse\""),
        ("`[structure]`", "interpolation", "interpolation = \"cubic\""),
        ("`[aerodynamics]`", "lift_slopes", ""),
        ("`[aerodynamics]`", "drag", ""),
        (
            "`[aerodynamics]`",
            "shape_reference",
            "shape_reference = \"trimmed\"",
        ),
        (
            "`[aerodynamics]`",
            "control_aerodynamics",
            "control_aerodynamics = \"quasi_steady\"",
        ),
        ("`[aerodynamics]`", "split", ""),
        ("`[aerodynamics]`", "dihedral", ""),
        ("`[aerodynamics]`", "downwash_point", ""),
        ("`[flight]`", "attitude", ""),
        ("`[[variant]]`", "thrust_line", "thrust_line = \"through_cg\""),
        ("`[[variant]]`", "control_aerodynamics", ""),
        ("`[[variant]]`", "fidelity", ""),
        ("`[[manoeuvre]]`", "method", ""),
    ] {
        let table = heading.trim_matches('`');
        let wrong = format!("{key} = \"not_a_choice\"");
        let message = if from.is_empty() {
            answer(&format!("{table}\n"), &format!("{table}\n{wrong}\n"))
        } else {
            answer(from, &wrong)
        };
        let row = rows(section(&text, heading))
            .into_iter()
            .find(|(name, _)| name == key)
            .unwrap()
            .1;
        let documented: Names = quoted(&row)
            .into_iter()
            .filter(|name| name.starts_with('"'))
            .collect();
        let known: Names = expected(&message)
            .iter()
            .map(|name| format!("\"{name}\""))
            .collect();
        assert_eq!(documented, known, "{heading} {key}");
    }
    let quantities: Names = rows(section(&text, "`[[sensor]]`"))
        .into_iter()
        .map(|(name, _)| name.trim_matches('"').to_owned())
        .filter(|name| !["name", "quantity", "grid"].contains(&name.as_str()))
        .collect();
    assert_eq!(
        quantities,
        expected(&answer("quantity = \"alpha\"", "quantity = \"not_a_choice\""))
    );
}

#[test]
fn val_every_signal_is_documented() {
    let text = std::fs::read_to_string(page("CASE.md")).unwrap();
    let documented = rows(section(&text, "Signals"));
    let signal =
        "{ kind = \"doublet\", amplitude_deg = 1.6, start = 0.5, frequency_hz = 0.5, edges = \"smooth\" }";
    let kinds: Names = documented
        .iter()
        .map(|(kind, _)| kind.trim_matches('"').to_owned())
        .collect();
    assert_eq!(kinds, expected(&answer(signal, "{ kind = \"not_a_kind\" }")));
    for (kind, row) in &documented {
        let keys = quoted(row.split(" | ").next().unwrap());
        let message = answer(signal, &format!("{{ kind = {kind}, not_a_key = 0 }}"));
        assert_eq!(keys, expected(&message), "{kind}");
    }
}

/// The complete example of the page is trimmed as it stands, and so is the shipped case with each signal of the page.
#[test]
fn val_the_small_case_runs() {
    let text = std::fs::read_to_string(page("CASE.md")).unwrap();
    let small = section(&text, "A small case");
    let toml = small
        .split("```toml\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    let copy = CaseCopy::new();
    copy.write("small.toml", toml);
    let trim = json(&["trim", &copy.arg("small.toml"), "--json"]);
    assert_eq!(trim["variant"], "base");
    assert_eq!(trim["eta"].as_array().unwrap().len(), 10);
    // A run without sensors and simulations leaves the response out; asked for by name it is missing.
    let run = json(&[
        "run",
        &copy.arg("small.toml"),
        "--out",
        &copy.arg("out"),
        "--json",
    ]);
    assert_eq!(run["variant"], "base");
    let made = |name: &str| copy.at("out").join(name).exists();
    assert!(made("report.html") && made("root_locus.json") && !made("bode.json"));
    assert!(failure(&["bode", &copy.arg("small.toml")]).contains("no [[sensor]] in the case"));
    assert!(failure(&["simulate", &copy.arg("small.toml")]).contains("no [[manoeuvre]] in the case"));
    let signals = section(&text, "Signals").split("```toml\n").nth(1).unwrap();
    let case = copy.read("case.toml") + "\n" + signals.split("```").next().unwrap();
    copy.write("case.toml", &case);
    let history = json(&[
        "simulate",
        &copy.arg("case.toml"),
        "--manoeuvre",
        "elevator_3211",
        "--json",
    ]);
    assert_eq!(history["t"].as_array().unwrap().len(), 10001);
}
