//! `cargo xtask first-hour`: the way from `git clone` to a report in the browser, as a new user goes it.
//!
//! The commands of `docs/FIRST_HOUR.md` are run ([`crate::console`]) in an empty folder, on a clone of what is committed,
//! and each is timed. `--check` compares what they print and tells the times; without it the page and its table of times
//! are renewed. The clone builds where this workspace builds: with an empty target directory (`CARGO_TARGET_DIR`) the time
//! is that of a first build.

use crate::console::{Shell, failed, standard_output};
use crate::error::Error;
use crate::validate::{END_OF_MEASURED, MEASURED, differences_of_pages};
use crate::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Options of `cargo xtask first-hour`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Write nothing; compare what the commands print with the page
    #[arg(long)]
    check: bool,
}

impl Options {
    /// `--check`.
    pub(crate) fn check() -> Self {
        Self { check: true }
    }
}

/// Runs the page.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    let page = root.join("docs/FIRST_HOUR.md");
    let text = workspace::read(&page)?;
    let empty = tempfile::tempdir().map_err(Error::file(&std::env::temp_dir()))?;
    let mut shell = Shell::beside(&page, PathBuf::new(), options.check);
    shell.folder = empty.path().to_owned();
    shell.own = command_of_the_page;
    let fresh = with_times(&shell.rewritten(&text)?, &shell.times)?;
    for (command, time) in &shell.times {
        println!("{:8.1} s  {command}", time.as_secs_f64());
    }
    let total: Duration = shell.times.iter().map(|(_, time)| *time).sum();
    println!("{:8.1} s  from clone to report", total.as_secs_f64());
    if !options.check {
        return workspace::write_whole(&page, &fresh);
    }
    let mut differences = differences_of_pages(&fresh, &text);
    differences.append(&mut shell.differences);
    if differences.is_empty() {
        return Ok(());
    }
    differences.iter().for_each(|d| println!("FIRST_HOUR.md: {d}"));
    Err(Error::Failed(
        "the first hour prints something else; if it is meant, run `cargo xtask first-hour` and commit"
            .into(),
    ))
}

/// What differs from the commands of every page: the clone is one of this repository, the build is not mixed with that
/// of other work, a page is opened without a screen.
fn command_of_the_page(shell: &mut Shell, words: &[String]) -> Option<Result<String, Error>> {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["git", "clone", _address, folder] => {
            let mut process = Command::new("git");
            process.args(["clone", "--quiet"]).arg(workspace::root());
            process.arg(folder).current_dir(&shell.folder);
            Some(standard_output(&mut process, "git clone"))
        }
        ["cargo", arguments @ ..] => {
            let target = workspace::target(&workspace::root());
            let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
            let mut process = Command::new(cargo);
            process.args(arguments).current_dir(&shell.folder);
            process.env("CARGO_TARGET_DIR", &target);
            // The installed program, in effect.
            shell.program = target
                .join("release")
                .join(format!("albatross{}", std::env::consts::EXE_SUFFIX));
            Some(standard_output(&mut process, &words.join(" ")))
        }
        ["open", page] => Some(opened(&shell.folder.join(page))),
        _ => None,
    }
}

/// Opens a report in a browser without a screen, sees that its plots are drawn, and takes a picture beside it.
fn opened(page: &Path) -> Result<String, Error> {
    let Some(browser) = browser() else {
        println!(
            "SKIPPED: no Chromium on the search path; {} was not opened",
            page.display()
        );
        return Ok(String::new());
    };
    let address = format!("file://{}", page.display());
    let profile = tempfile::tempdir().map_err(Error::file(&std::env::temp_dir()))?;
    let with = |arguments: &[&str]| {
        let mut process = Command::new(browser);
        process
            .args([
                "--headless",
                "--no-sandbox",
                "--enable-unsafe-swiftshader",
                "--hide-scrollbars",
            ])
            .args([
                "--window-size=1280,1750",
                "--virtual-time-budget=8000",
                "--force-prefers-reduced-motion",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .args(arguments);
        standard_output(&mut process, browser)
    };
    let drawn = with(&["--dump-dom", &address])?;
    if !drawn.contains("plot-container") {
        return Err(failed("open", format!("shows no plot in {browser}")));
    }
    let picture = format!("--screenshot={}", page.with_extension("png").display());
    with(&[&picture, &address])?;
    Ok(String::new())
}

/// A browser of the Chromium family on the search path.
fn browser() -> Option<&'static str> {
    let found = |name: &&str| {
        let version = Command::new(name).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    };
    [
        "chromium",
        "chromium-browser",
        "google-chrome",
        "google-chrome-stable",
    ]
    .into_iter()
    .find(found)
}

/// The page with its table of times renewed.
fn with_times(page: &str, times: &[(String, Duration)]) -> Result<String, Error> {
    let parts = page.split_once(MEASURED).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END_OF_MEASURED)?;
        Some((before, after))
    });
    let Some((before, after)) = parts else {
        return Err(Error::Mismatch {
            what: "docs/FIRST_HOUR.md".into(),
            found: "no place for the times".into(),
            expected: format!("a line {MEASURED} and a line {END_OF_MEASURED}"),
        });
    };
    let mut table = String::from("| command | seconds |\n|---|---|\n");
    for (command, time) in times {
        let command = command.replace('|', "\\|");
        table.push_str(&format!("| `{command}` | {:.1} |\n", time.as_secs_f64()));
    }
    let total: Duration = times.iter().map(|(_, time)| *time).sum();
    table.push_str(&format!("| all | {:.1} |\n", total.as_secs_f64()));
    Ok(format!("{before}{MEASURED}\n\n{table}\n{END_OF_MEASURED}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_stand_between_their_marks() {
        let page = format!("a\n{MEASURED}\nold\n{END_OF_MEASURED}\nb\n");
        let times = [("albatross x | head -1".to_owned(), Duration::from_millis(1250))];
        let fresh = with_times(&page, &times).unwrap();
        assert!(
            fresh.contains("| `albatross x \\| head -1` | 1.2 |\n| all | 1.2 |"),
            "{fresh}"
        );
        assert!(fresh.starts_with("a\n") && fresh.ends_with("-->\nb\n") && !fresh.contains("old"));
        assert!(with_times("a", &times).is_err());
    }
}
