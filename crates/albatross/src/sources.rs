//! Where the numbers come from: every file that a case reads, with its size and hash.

use crate::Error;
use crate::case::{LiftSlopes, SOLVE, SignalCase};
use crate::inputs::Inputs;
use albatross_avl::geometry::Airfoil;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Source {
    /// What it is to the case.
    pub role: &'static str,
    /// Path, relative to the case file's directory where it lies below it.
    pub path: String,
    /// Size in bytes.
    pub bytes: usize,
    /// SHA-256 in hexadecimal digits.
    pub sha256: String,
    /// Who wrote it, where the file tells; else empty.
    pub written_by: String,
}

impl Inputs {
    /// All files of the case, the case file first. They are read again, so this belongs close to [`Inputs::read`].
    ///
    /// # Errors
    /// [`Error::Read`].
    pub fn sources(&self, case_file: &Path) -> Result<Vec<Source>, Error> {
        let mut files: Vec<(&'static str, PathBuf)> = vec![("case file", case_file.to_path_buf())];
        let case = &self.case;
        let mut add = |role, name: &str| files.push((role, self.directory.join(name)));

        add("Nastran deck", &case.structure.deck);
        // The main file is known by the name that the case gives it.
        for included in self.deck.origins.files().skip(1) {
            add("file included in the deck", included);
        }
        if case.structure.results != SOLVE {
            add("results of SOL 103", &case.structure.results);
        }
        let aerodynamics = &case.aerodynamics;
        add("AVL geometry", &aerodynamics.geometry);
        if let Some((derivatives, strips)) = aerodynamics.files() {
            add("AVL stability derivatives", derivatives);
            for strip in strips {
                add("AVL strip forces", &strip.file);
            }
        }
        if aerodynamics.files().is_none() || aerodynamics.lift_slopes == LiftSlopes::Lattice {
            for name in self.shape_files() {
                let beside = Path::new(&aerodynamics.geometry).with_file_name(name);
                if self.directory.join(&beside).is_file() {
                    add("aerofoil or body of the geometry", &beside.to_string_lossy());
                }
            }
        }
        if let Some(corrections) = &case.corrections {
            if let Some(file) = &corrections.lift_slopes {
                add("corrected lift slopes", file);
            }
            if let Some(file) = &corrections.derivatives {
                add("corrected derivatives", file);
            }
        }
        for manoeuvre in &case.manoeuvres {
            if let SignalCase::Csv { file, .. } = &manoeuvre.signal {
                add("input signal", file);
            }
        }

        let mut sources: Vec<Source> = Vec::new();
        for (role, path) in files {
            let source = self.source(role, &path)?;
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        Ok(sources)
    }

    /// Names of the aerofoil and body files of the geometry.
    fn shape_files(&self) -> Vec<&str> {
        let aerofoils = self
            .geometry
            .surfaces
            .iter()
            .flat_map(|s| &s.sections)
            .filter_map(|s| match &s.airfoil {
                Airfoil::File { path, .. } => Some(path.as_str()),
                _ => None,
            });
        let bodies = self.geometry.bodies.iter().filter_map(|b| b.file.as_deref());
        let mut names: Vec<&str> = aerofoils.chain(bodies).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    fn source(&self, role: &'static str, path: &Path) -> Result<Source, Error> {
        let content = std::fs::read(path).map_err(|source| Error::Read {
            file: path.display().to_string(),
            source,
        })?;
        let hash = Sha256::digest(&content);
        let written_by = if role == "results of SOL 103" {
            format!("{:?} Nastran layout", self.results.dialect)
        } else {
            String::new()
        };
        Ok(Source {
            role,
            path: self.shown(path),
            bytes: content.len(),
            sha256: hash.iter().map(|byte| format!("{byte:02x}")).collect(),
            written_by,
        })
    }

    /// The path below the case's directory, however it was written; else as it was written.
    fn shown(&self, path: &Path) -> String {
        let below = path.strip_prefix(&self.directory).map(Path::to_path_buf);
        let resolved = || {
            let directory = self.directory.canonicalize().ok()?;
            Some(
                path.canonicalize()
                    .ok()?
                    .strip_prefix(directory)
                    .ok()?
                    .to_path_buf(),
            )
        };
        let shown = below.ok().or_else(resolved).unwrap_or_else(|| path.to_path_buf());
        shown.display().to_string().replace('\\', "/")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_hashes_are_those_of_the_standard() {
        // FIPS 180-2, appendix B.1.
        let hash = Sha256::digest(b"abc");
        assert_eq!(hash[..4], [0xba, 0x78, 0x16, 0xbf]);
    }

    #[test]
    fn val_every_file_of_the_shipped_case_is_listed_once() {
        let file = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/f25-like/case.toml"
        ));
        let sources = Inputs::read(file).unwrap().sources(file).unwrap();
        let paths: Vec<&str> = sources.iter().map(|s| s.path.as_str()).collect();
        assert_eq!(
            paths,
            [
                "case.toml",
                "f25.bdf",
                "f25.f06",
                "f25.avl",
                "avl_out/trim.st",
                "avl_out/alpha1.fs",
                "avl_out/alpha2.fs",
                "reference/strips_reference.csv",
                "reference/derivatives_reference.json",
            ]
        );
        assert!(sources.iter().all(|s| s.sha256.len() == 64 && s.bytes > 0));
    }
}
