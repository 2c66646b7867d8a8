//! Manifests: the crate graph, descriptions, lints.

use super::{Kind, PIPELINE};
use crate::error::Error;
use crate::workspace;
use std::collections::BTreeSet;
use std::path::Path;
use toml::{Table, Value};

/// Checks the manifests of the workspace and of every crate of the pipeline.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Error> {
    let mut found = workspace_manifest(&read(&root.join("Cargo.toml"))?);
    for (position, (directory, ..)) in PIPELINE.iter().enumerate() {
        let file = format!("{directory}/Cargo.toml");
        let manifest = read(&root.join(&file))?;
        found.extend(
            crate_manifest(position, &manifest)
                .into_iter()
                .map(|what| format!("{file}: {what}")),
        );
    }
    let known: BTreeSet<&str> = PIPELINE.iter().map(|(directory, ..)| *directory).collect();
    let crates = root.join("crates");
    for entry in std::fs::read_dir(&crates).map_err(Error::file(&crates))? {
        let name = entry.map_err(Error::file(&crates))?.file_name();
        let directory = format!("crates/{}", name.to_string_lossy());
        if !known.contains(directory.as_str()) {
            found.push(format!(
                "{directory}: has no place in the pipeline; give it one in xtask/src/tidy/mod.rs"
            ));
        }
    }
    Ok(found)
}

fn read(path: &Path) -> Result<Table, Error> {
    workspace::read(path)?
        .parse::<Table>()
        .map_err(|e| Error::Mismatch {
            what: path.display().to_string(),
            found: e.message().to_owned(),
            expected: "a TOML table".into(),
        })
}

fn workspace_manifest(manifest: &Table) -> Vec<String> {
    let lint = |group: &str, name: &str| at(manifest, &["workspace", "lints", group, name]).is_some();
    [
        ("rust", "missing_docs"),
        ("rust", "unsafe_code"),
        ("clippy", "unwrap_used"),
    ]
    .into_iter()
    .filter(|(group, name)| !lint(group, name))
    .map(|(group, name)| format!("Cargo.toml: [workspace.lints.{group}] lacks {name}"))
    .collect()
}

fn crate_manifest(position: usize, manifest: &Table) -> Vec<String> {
    let mut found = Vec::new();
    let Some((_, package, kind)) = PIPELINE.get(position) else {
        return found;
    };
    let name = at(manifest, &["package", "name"]).and_then(Value::as_str);
    if name != Some(package) {
        found.push(format!("the package is {name:?}, expected `{package}`"));
    }
    let description = at(manifest, &["package", "description"]).and_then(Value::as_str);
    if description.is_none_or(|text| text.trim().is_empty()) {
        found.push("has no description".into());
    }
    if at(manifest, &["lints", "workspace"]).and_then(Value::as_bool) != Some(true) {
        found.push("does not inherit the workspace's lints ([lints] workspace = true)".into());
    }
    for dependency in dependencies(manifest) {
        let Some(other) = PIPELINE.iter().position(|(_, package, _)| *package == dependency) else {
            continue;
        };
        if other >= position {
            found.push(format!(
                "depends on `{dependency}`, which comes later in the pipeline"
            ));
        } else if matches!(kind, Kind::Reader | Kind::Report) {
            found.push(format!(
                "depends on `{dependency}`; readers and the report crate stand alone"
            ));
        }
    }
    found
}

/// Names of all dependencies, development and build ones included.
fn dependencies(manifest: &Table) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
        if let Some(Value::Table(table)) = manifest.get(section) {
            for (key, value) in table {
                // `name = { package = "other" }` renames.
                let renamed = value.get("package").and_then(Value::as_str);
                names.insert(renamed.unwrap_or(key).to_owned());
            }
        }
    }
    names
}

fn at<'a>(table: &'a Table, path: &[&str]) -> Option<&'a Value> {
    let (first, rest) = path.split_first()?;
    rest.iter()
        .try_fold(table.get(*first)?, |value, key| value.get(key))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(directory: &str, text: &str) -> Vec<String> {
        let position = PIPELINE.iter().position(|(d, ..)| *d == directory).unwrap();
        crate_manifest(position, &text.parse().unwrap())
    }

    const HEAD: &str =
        "[package]\nname = \"albatross-lti\"\ndescription = \"x\"\n[lints]\nworkspace = true\n";

    #[test]
    fn a_sound_manifest_has_no_findings() {
        let text = format!("{HEAD}[dependencies]\nalbatross-numerics.workspace = true\nserde = \"1\"\n");
        assert!(findings("crates/lti", &text).is_empty());
    }

    #[test]
    fn later_crates_are_refused_also_under_another_name() {
        let text =
            format!("{HEAD}[dev-dependencies]\nx = {{ package = \"albatross-flight\", path = \"..\" }}\n");
        assert_eq!(
            findings("crates/lti", &text),
            ["depends on `albatross-flight`, which comes later in the pipeline"]
        );
    }

    #[test]
    fn missing_pieces_are_named() {
        assert_eq!(
            findings("crates/lti", "[package]\nname = \"albatross-lti\"\n").len(),
            2
        );
        let report = HEAD.replace("albatross-lti", "albatross-report");
        let text = format!("{report}[dependencies]\nalbatross-lti.workspace = true\n");
        assert_eq!(
            findings("crates/report", &text),
            ["depends on `albatross-lti`; readers and the report crate stand alone"]
        );
        assert_eq!(
            workspace_manifest(&"[workspace.lints.rust]\nmissing_docs = \"warn\"".parse().unwrap()).len(),
            2
        );
    }
}
