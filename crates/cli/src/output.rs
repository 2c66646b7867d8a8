//! Printing and writing. Files appear whole or not at all.

use crate::excerpt;
use std::io::{IsTerminal, Write};
use std::path::Path;

/// Why a command ended early.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// From the library.
    #[error(transparent)]
    Albatross(#[from] albatross::Error),
    /// From a solver that does not know the file.
    #[error("{}", with_file(file, source))]
    Solver {
        /// File.
        file: String,
        /// Cause.
        source: Box<albatross::Error>,
    },
    /// From a neutral model.
    #[error(transparent)]
    Neutral(#[from] albatross::neutral::NeutralError),
    /// From tables and plots.
    #[error(transparent)]
    Report(#[from] albatross::report::ReportError),
    /// From the export to other formats.
    #[error(transparent)]
    Export(#[from] albatross::export::Error),
    /// From identification.
    #[error(transparent)]
    Sysid(#[from] albatross::sysid::Error),
    /// JSON could not be made.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// A file named on the command line cannot be read.
    #[error("{path}: {source}; check the path")]
    Read {
        /// File.
        path: String,
        /// Cause.
        source: std::io::Error,
    },
    /// Writing failed.
    #[error("{path}: cannot be written: {source}")]
    Write {
        /// File or directory.
        path: String,
        /// Cause.
        source: std::io::Error,
    },
    /// Options that do not fit together.
    #[error("{0}")]
    Usage(String),
    /// `check` found errors, and has printed them.
    #[error("errors were found")]
    Found,
    /// Anything else.
    #[error("{0}")]
    Other(String),
    /// The reader of standard output went away.
    #[error("standard output was closed")]
    Closed,
}

impl From<Box<dyn std::error::Error>> for Failure {
    fn from(error: Box<dyn std::error::Error>) -> Self {
        Self::Other(error.to_string())
    }
}

impl From<albatross::lti::Error> for Failure {
    fn from(error: albatross::lti::Error) -> Self {
        Self::Albatross(error.into())
    }
}

/// The message under the name of its file, unless it begins with a line of it.
fn with_file(file: &str, source: &albatross::Error) -> String {
    let message = source.to_string();
    if message.starts_with(&format!("{file}:")) {
        return message;
    }
    format!("{file}: {message}")
}

/// Prints to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| {
            if text.ends_with('\n') {
                Ok(())
            } else {
                out.write_all(b"\n")
            }
        })
        .and_then(|()| out.flush())
        .map_err(|source| match source.kind() {
            std::io::ErrorKind::BrokenPipe => Failure::Closed,
            _ => Failure::Write {
                path: "standard output".into(),
                source,
            },
        })
}

/// Prints a JSON value.
pub(crate) fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    print(&serde_json::to_string_pretty(value)?)
}

/// A remark on standard error.
pub(crate) fn remark(text: &str) {
    // Nothing can be done about a closed standard error.
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// What a stream may be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Style {
    /// Whether someone looks at it: a terminal, or `CLICOLOR_FORCE` is set.
    pub(crate) terminal: bool,
    /// Whether it takes colours: a terminal without `NO_COLOR`.
    pub(crate) colour: bool,
}

impl Style {
    pub(crate) fn of(stream: &impl IsTerminal) -> Self {
        let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
        let terminal = stream.is_terminal() || set("CLICOLOR_FORCE");
        Self {
            terminal,
            colour: terminal && !set("NO_COLOR"),
        }
    }

    /// Text in a colour: 31 red, 33 yellow, 36 cyan.
    pub(crate) fn paint(self, code: u8, text: &str) -> String {
        if self.colour {
            format!("\u{1b}[1;{code}m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }
}

/// An error on standard error, with its causes; on a terminal with the lines of the files that it names.
pub(crate) fn error(failure: &Failure) {
    let style = Style::of(&std::io::stderr());
    let text = failure.to_string();
    for (i, line) in text.lines().enumerate() {
        // Lists of a reader's remarks bring their own label.
        let message = match line.strip_prefix("error: ") {
            Some(message) => format!("{}: {message}", style.paint(31, "error")),
            None if i == 0 => format!("{}: {line}", style.paint(31, "error")),
            None => line.to_owned(),
        };
        remark(&message);
        if style.terminal
            && let Some(excerpt) =
                excerpt::of_message(line.strip_prefix("error: ").unwrap_or(line), style.colour)
        {
            remark(&excerpt);
        }
    }
}

/// What may help, on a terminal only.
pub(crate) fn hint(text: &str) {
    let style = Style::of(&std::io::stderr());
    if style.terminal {
        remark(&format!("{}: {text}", style.paint(36, "hint")));
    }
}

/// Text of a file named on the command line.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    albatross::inputs::read_text(path).map_err(|error| match error {
        albatross::Error::Read { file, source } => Failure::Read { path: file, source },
        other => Failure::Albatross(other),
    })
}

/// Makes a directory with its parents.
pub(crate) fn make_directory(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(|source| Failure::Write {
        path: path.display().to_string(),
        source,
    })
}

/// Begins the names of files and directories that are not complete.
pub(crate) const TEMPORARY: &str = ".albatross-";

/// Writes a text file as [`write_bytes`] does.
pub(crate) fn write(path: &Path, content: &str) -> Result<(), Failure> {
    write_bytes(path, content.as_bytes())
}

/// Writes a file by way of a temporary one beside it, so that a reader sees the old or the new content.
pub(crate) fn write_bytes(path: &Path, content: &[u8]) -> Result<(), Failure> {
    let fail = |source: std::io::Error| Failure::Write {
        path: path.display().to_string(),
        source,
    };
    let directory = path
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new()
        .prefix(TEMPORARY)
        .tempfile_in(directory)
        .map_err(fail)?;
    file.write_all(content).map_err(fail)?;
    file.as_file().sync_all().map_err(fail)?;
    readable(file.as_file()).map_err(fail)?;
    file.persist(path).map_err(|e| fail(e.error))?;
    Ok(())
}

/// Temporary files are private; results are not.
#[cfg(unix)]
fn readable(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable(_: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}
