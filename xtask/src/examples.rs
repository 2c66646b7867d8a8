//! `cargo xtask examples`: the commands of `examples/*/README.md` are run, and what they print is put below them.
//!
//! A block of kind `console` holds commands after `$ ` and their standard output. Commands run in the folder of the
//! example; `albatross` is the program of this workspace, `cargo` is cargo. Of a shell only three things are understood:
//! quotes, `> FILE` at the end, and `| head -N` or `| tail -N` at the end. A line
//!
//! ```text
//! <!-- picture: out/bode.svg -->
//! ```
//!
//! before an image copies that file to the image's place. `--check` compares words and numbers, these to one unit of the
//! last place, and that pictures are there.

use crate::error::Error;
use crate::validate::differences_of_texts;
use crate::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Options of `cargo xtask examples`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Write nothing; compare what the commands print with what is there
    #[arg(long)]
    check: bool,
    /// Only the examples whose folder begins so
    #[arg(long, value_name = "START")]
    only: Option<String>,
}

impl Options {
    /// `--check` of all.
    pub(crate) fn check() -> Self {
        Self {
            check: true,
            only: None,
        }
    }
}

/// Runs the examples.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    let program = build(&root)?;
    let mut differences = Vec::new();
    let mut pages: Vec<PathBuf> = folders(&root.join("examples"))?
        .into_iter()
        .map(|folder| folder.join("README.md"))
        .collect();
    pages.retain(|page| match &options.only {
        Some(start) => page
            .parent()
            .and_then(Path::file_name)
            .is_some_and(|name| name.to_string_lossy().starts_with(start.as_str())),
        None => true,
    });
    for page in &pages {
        let text = workspace::read(page)?;
        // What an earlier run has left would be in the way of commands that refuse to overwrite.
        let left = page.with_file_name("out");
        if left.is_dir() {
            std::fs::remove_dir_all(&left).map_err(Error::file(&left))?;
        }
        let fresh = Page {
            folder: page.parent().unwrap_or(Path::new(".")),
            program: &program,
            check: options.check,
        }
        .rewritten(&text)?;
        if options.check {
            let found = differences_of_texts(&fresh, &text);
            differences.extend(found.into_iter().map(|d| format!("{}: {d}", page.display())));
        } else {
            workspace::write_whole(page, &fresh)?;
        }
    }
    differences.iter().for_each(|d| println!("{d}"));
    if differences.is_empty() {
        println!("{} examples run", pages.len());
        return Ok(());
    }
    Err(Error::Failed(format!(
        "{} differences in the examples; if they are meant, run `cargo xtask examples` and commit",
        differences.len()
    )))
}

/// The program as tests build it.
fn build(root: &Path) -> Result<PathBuf, Error> {
    crate::ci::cargo(&["build", "--quiet", "-p", "albatross-cli"], &[])?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    Ok(target
        .join("debug")
        .join(format!("albatross{}", std::env::consts::EXE_SUFFIX)))
}

/// Numbered folders in order.
fn folders(examples: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(examples).map_err(Error::file(examples))? {
        let path = entry.map_err(Error::file(examples))?.path();
        if path.join("README.md").is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

struct Page<'a> {
    folder: &'a Path,
    program: &'a Path,
    check: bool,
}

impl Page<'_> {
    /// The page with the output of its commands.
    fn rewritten(&self, text: &str) -> Result<String, Error> {
        let mut out = String::new();
        let mut in_block = false;
        let mut picture: Option<&str> = None;
        for line in text.lines() {
            if line.starts_with("```") {
                in_block = !in_block && line.trim_end() == "```console";
            }
            if !in_block {
                if let Some(from) = picture.take() {
                    self.take_picture(from, line)?;
                }
                picture = line
                    .strip_prefix("<!-- picture: ")
                    .and_then(|rest| rest.strip_suffix(" -->"));
            }
            let command = line.strip_prefix("$ ").filter(|_| in_block);
            // What stood below the commands is replaced.
            if !in_block || line.starts_with("```") || command.is_some() {
                out.push_str(line);
                out.push('\n');
            }
            if let Some(command) = command {
                for printed in self.execute(command)?.lines() {
                    out.push_str(printed.trim_end());
                    out.push('\n');
                }
            }
        }
        Ok(out)
    }

    /// Standard output of a command.
    fn execute(&self, command: &str) -> Result<String, Error> {
        eprintln!("$ {command}");
        let failed = |outcome: String| Error::Command {
            command: command.to_owned(),
            outcome,
        };
        let (rest, file) = match command.rsplit_once(" > ") {
            Some((rest, file)) => (rest, Some(self.folder.join(file.trim()))),
            None => (command, None),
        };
        let (rest, cut) = match rest.rsplit_once(" | ") {
            Some((rest, filter)) => (rest, Some(filter)),
            None => (rest, None),
        };
        let mut words = split(rest).into_iter();
        let program = words.next().unwrap_or_default();
        let mut process = match program.as_str() {
            "albatross" => Command::new(self.program),
            "cargo" => Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())),
            other => {
                return Err(failed(format!(
                    "begins with `{other}`: only albatross and cargo are run"
                )));
            }
        };
        let output = process
            .args(words)
            .current_dir(self.folder)
            .env("NO_COLOR", "1")
            .output()
            .map_err(|e| failed(format!("cannot be started: {e}")))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(failed(format!("failed with {}: {said}", output.status)));
        }
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let printed = match cut
            .map(|filter| filter.split(" -").collect::<Vec<_>>())
            .as_deref()
        {
            None => printed,
            Some(["head", n]) => printed
                .lines()
                .take(number(n))
                .map(|l| format!("{l}\n"))
                .collect(),
            Some(["tail", n]) => {
                let skip = printed.lines().count().saturating_sub(number(n));
                printed.lines().skip(skip).map(|l| format!("{l}\n")).collect()
            }
            Some(_) => return Err(failed("has a filter other than `head -N` and `tail -N`".into())),
        };
        match file {
            Some(path) => {
                workspace::write_whole(&path, &printed)?;
                Ok(String::new())
            }
            None => Ok(printed),
        }
    }

    /// Copies a file to the place of the image on a line, or looks whether both are there.
    fn take_picture(&self, from: &str, line: &str) -> Result<(), Error> {
        let to = line
            .rsplit_once("](")
            .and_then(|(_, rest)| rest.split(')').next());
        let Some(to) = to.filter(|_| line.starts_with("![")) else {
            return Err(Error::Mismatch {
                what: format!("line after the picture {from}"),
                found: line.to_owned(),
                expected: "an image, ![what it shows](name.svg)".into(),
            });
        };
        let drawn = workspace::read(&self.folder.join(from))?;
        if self.check {
            workspace::read(&self.folder.join(to)).map(drop)
        } else {
            workspace::write_whole(&self.folder.join(to), &drawn)
        }
    }
}

fn number(text: &str) -> usize {
    text.trim().parse().unwrap_or(0)
}

/// Words of a command line; double quotes hold words together.
fn split(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for character in command.chars() {
        match character {
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            other => {
                if let Some(word) = words.last_mut() {
                    word.push(other);
                }
            }
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_at_blanks_outside_quotes() {
        assert_eq!(
            split("albatross bode  A.toml --omega \"1 2\""),
            ["albatross", "bode", "A.toml", "--omega", "1 2"]
        );
    }
}
