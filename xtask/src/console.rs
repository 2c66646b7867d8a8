//! Pages with commands: those in blocks of kind `console` are run, and what they print is put below them.
//!
//! Commands stand after `$ `. Of a shell only four things are understood: quotes, `> FILE` at the end, `| head -N` or
//! `| tail -N` at the end, and `cd FOLDER`. A line
//!
//! ```text
//! <!-- picture: out/bode.svg -->
//! ```
//!
//! before an image copies that file to the image's place; or compares what the two say in words, if they are SVG.

use crate::error::Error;
use crate::validate::differences_of_drawings;
use crate::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// What a command of a page itself prints, given as words; nothing for other commands.
pub(crate) type OwnCommand = fn(&mut Shell, &[String]) -> Option<Result<String, Error>>;

/// Where and with what the commands of a page are run.
pub(crate) struct Shell {
    /// Folder of the page: pictures are beside it.
    pub(crate) page_folder: PathBuf,
    /// Working directory of commands.
    pub(crate) folder: PathBuf,
    /// The program `albatross`.
    pub(crate) program: PathBuf,
    /// Pictures are compared, not written.
    pub(crate) check: bool,
    /// Commands that the page handles in its own way, for instance to open a file in a browser.
    pub(crate) own: OwnCommand,
    /// Commands run so far, and how long each took.
    pub(crate) times: Vec<(String, Duration)>,
    /// Pictures that differ from what was drawn.
    pub(crate) differences: Vec<String>,
}

impl Shell {
    /// A shell in the folder of a page.
    pub(crate) fn beside(page: &Path, program: PathBuf, check: bool) -> Self {
        let folder = page.parent().unwrap_or(Path::new(".")).to_owned();
        Self {
            page_folder: folder.clone(),
            folder,
            program,
            check,
            own: |_, _| None,
            times: Vec::new(),
            differences: Vec::new(),
        }
    }

    /// The page with the output of its commands.
    pub(crate) fn rewritten(&mut self, text: &str) -> Result<String, Error> {
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
    fn execute(&mut self, command: &str) -> Result<String, Error> {
        eprintln!("$ {command}");
        let (rest, file) = match command.rsplit_once(" > ") {
            Some((rest, file)) => (rest, Some(self.folder.join(file.trim()))),
            None => (command, None),
        };
        let (rest, filter) = match rest.rsplit_once(" | ") {
            Some((rest, filter)) => (rest, Some(filter)),
            None => (rest, None),
        };
        let words = split(rest);
        let start = Instant::now();
        let printed = match (self.own)(self, &words) {
            Some(printed) => printed?,
            None => self.output(command, &words)?,
        };
        self.times.push((command.to_owned(), start.elapsed()));
        let printed = match filter {
            Some(filter) => filtered(&printed, filter)
                .ok_or_else(|| failed(command, "has a filter other than `head -N` and `tail -N`".into()))?,
            None => printed,
        };
        match file {
            Some(path) => {
                workspace::write_whole(&path, &printed)?;
                Ok(String::new())
            }
            None => Ok(printed),
        }
    }

    /// Standard output of a program that every page may name.
    fn output(&mut self, command: &str, words: &[String]) -> Result<String, Error> {
        let mut process = match words.first().map(String::as_str) {
            Some("cd") => {
                self.folder.push(words.get(1).map_or("", String::as_str));
                return Ok(String::new());
            }
            Some("albatross") => Command::new(&self.program),
            Some("cargo") => Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())),
            _ => {
                return Err(failed(
                    command,
                    "begins with another word than albatross, cargo or cd".into(),
                ));
            }
        };
        process.args(words.iter().skip(1)).current_dir(&self.folder);
        standard_output(&mut process, command)
    }

    /// Copies a file to the place of the image on a line, or compares the two.
    fn take_picture(&mut self, from: &str, line: &str) -> Result<(), Error> {
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
        let (from, to) = (self.folder.join(from), self.page_folder.join(to));
        if !from.exists() && from.extension().is_some_and(|e| e == "png") {
            // A screen as a browser shows it, on a machine without one.
            return std::fs::metadata(&to).map(drop).map_err(Error::file(&to));
        }
        let drawn = std::fs::read(&from).map_err(Error::file(&from))?;
        if !self.check {
            return workspace::write_whole(&to, &drawn);
        }
        let kept = std::fs::read(&to).map_err(Error::file(&to))?;
        if to.extension().is_some_and(|e| e == "svg") {
            let text = String::from_utf8_lossy;
            let found = differences_of_drawings(&text(&drawn), &text(&kept));
            self.differences
                .extend(found.first().map(|first| format!("{}: {first}", to.display())));
        }
        Ok(())
    }
}

/// Runs a process without colours; what it says on standard error is told only where it fails.
pub(crate) fn standard_output(process: &mut Command, command: &str) -> Result<String, Error> {
    let output = process
        .env("NO_COLOR", "1")
        .output()
        .map_err(|e| failed(command, format!("cannot be started: {e}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(failed(command, format!("failed with {}: {said}", output.status)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A command that did not do what its page says.
pub(crate) fn failed(command: &str, outcome: String) -> Error {
    Error::Command {
        command: command.to_owned(),
        outcome,
    }
}

/// The first or last lines.
fn filtered(printed: &str, filter: &str) -> Option<String> {
    let (name, count) = filter.split_once(" -")?;
    let count: usize = count.trim().parse().ok()?;
    let skipped = match name {
        "head" => 0,
        "tail" => printed.lines().count().saturating_sub(count),
        _ => return None,
    };
    Some(
        printed
            .lines()
            .skip(skipped)
            .take(count)
            .map(|line| format!("{line}\n"))
            .collect(),
    )
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

    #[test]
    fn first_and_last_lines() {
        assert_eq!(filtered("a\nb\nc\n", "head -2").as_deref(), Some("a\nb\n"));
        assert_eq!(filtered("a\nb\nc\n", "tail -2").as_deref(), Some("b\nc\n"));
        assert_eq!(filtered("a\n", "sort"), None);
    }

    #[test]
    fn what_stood_below_a_command_is_replaced() {
        let mut shell = Shell::beside(Path::new("page.md"), PathBuf::new(), true);
        shell.own = |_, words| Some(Ok(format!("{}\n", words.join("+"))));
        let text = "Text\n```console\n$ a b\nold\nolder\n```\n```text\n$ c\n```\n";
        assert_eq!(
            shell.rewritten(text).unwrap(),
            "Text\n```console\n$ a b\na+b\n```\n```text\n$ c\n```\n"
        );
        assert_eq!(shell.times.len(), 1);
    }
}
