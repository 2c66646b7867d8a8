//! Sources: length, chapter headings, and what physics must not touch.

use super::{Kind, LONGEST};

/// Modules of the standard library that reach outside the program.
const OUTSIDE: [&str; 6] = ["fs", "io", "time", "env", "process", "net"];

/// What changes files: for programs alone.
const WRITING: [&str; 6] = [
    "fs::write",
    "fs::rename",
    "fs::copy",
    "fs::create_dir",
    "File::create",
    "OpenOptions",
];

/// Macros that print.
const PRINTING: [&str; 5] = ["println!", "eprintln!", "print!", "eprint!", "dbg!"];

/// Checks one source file; `path` is relative to the root.
pub(super) fn check(path: &str, text: &str, kind: Kind) -> Vec<String> {
    let mut found = Vec::new();
    let lines = text.lines().count();
    if lines >= LONGEST {
        found.push(format!("{path}: {lines} lines; split it below {LONGEST}"));
    }
    let name = path.rsplit('/').next().unwrap_or(path);
    if matches!(name, "lib.rs" | "main.rs") && !text.starts_with("//!") {
        found.push(format!("{path}: does not begin with documentation (//!)"));
    }
    // Tests, benches and examples are programs.
    let tested = ["/tests/", "/benches/", "/examples/"]
        .iter()
        .any(|part| path.contains(part))
        || name == "tests.rs";
    if matches!(kind, Kind::Physics | Kind::Report) && !tested {
        found.extend(
            impurities(text)
                .into_iter()
                .map(|(line, what)| format!("{path}:{line}: uses {what}")),
        );
    }
    if kind != Kind::Tool && !tested {
        let before_tests = text
            .lines()
            .take_while(|line| !line.trim_start().starts_with("#[cfg(test)]"));
        for (number, line) in before_tests.enumerate() {
            let code = line.trim_start();
            let writes = WRITING
                .iter()
                .find(|what| code.contains(*what) && !code.starts_with("//"));
            found.extend(
                writes.map(|what| format!("{path}:{}: uses {what}; programs write files", number + 1)),
            );
        }
    }
    found
}

/// Uses of the outside world before the first test module: line and what.
fn impurities(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    // Names that a grouped `use std::{...}` brings in, while its braces are open.
    let mut group = false;
    for (number, line) in text.lines().enumerate() {
        let code = line.trim_start();
        if code.starts_with("#[cfg(test)]") {
            break;
        }
        if code.starts_with("//") {
            continue;
        }
        let code = code.split(" // ").next().unwrap_or(code);
        group |= code.contains("std::{");
        for module in OUTSIDE {
            let named =
                code.contains(&format!("std::{module}")) || (group && words(code).any(|word| word == module));
            if named {
                found.push((number + 1, format!("std::{module}")));
            }
        }
        group &= !code.contains('}');
        let printing = PRINTING.iter().find(|name| {
            // `print!` is also the end of `eprint!`: the whole name counts.
            code.match_indices(*name)
                .any(|(at, _)| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
        });
        found.extend(printing.map(|name| (number + 1, (*name).to_owned())));
    }
    found
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impurities_are_found_before_tests_only() {
        let text = "//! std::fs in prose\nuse std::{\n    collections::BTreeMap,\n    io::Write,\n};\n\
                    fn f() { eprintln!(\"x\"); }\nlet iota = radio;\n\
                    #[cfg(test)]\nmod tests { use std::fs; }\n";
        let found = impurities(text);
        assert_eq!(found, [(4, "std::io".to_owned()), (6, "eprintln!".to_owned())]);
    }

    #[test]
    fn physics_is_pure_and_tools_are_not() {
        let text = "//! x\nuse std::time::Instant;\n";
        assert_eq!(
            check("crates/lti/src/a.rs", text, Kind::Physics),
            ["crates/lti/src/a.rs:2: uses std::time"]
        );
        assert!(check("crates/lti/tests/it/a.rs", text, Kind::Physics).is_empty());
        assert!(check("xtask/src/a.rs", text, Kind::Tool).is_empty());
    }

    #[test]
    fn programs_alone_write_files() {
        let text =
            "//! x\n// fs::write in prose\nstd::fs::write(a, b)?;\n#[cfg(test)]\nmod t { fs::write(); }\n";
        assert_eq!(
            check("crates/avl/src/a.rs", text, Kind::Reader),
            ["crates/avl/src/a.rs:3: uses fs::write; programs write files"]
        );
        assert_eq!(check("crates/albatross/src/a.rs", text, Kind::Facade).len(), 1);
        assert!(check("xtask/src/a.rs", text, Kind::Tool).is_empty());
    }

    #[test]
    fn long_files_and_silent_roots_are_found() {
        let long = "//! x\n".repeat(LONGEST);
        assert_eq!(check("crates/cli/src/a.rs", &long, Kind::Tool).len(), 1);
        assert_eq!(
            check("crates/cli/src/main.rs", "fn main() {}\n", Kind::Tool).len(),
            1
        );
    }
}
