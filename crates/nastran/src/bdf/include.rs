//! INCLUDE statements and the files they name.

use std::path::{Path, PathBuf};

/// The text of an included file.
#[derive(Debug, Clone)]
pub struct Included {
    /// Name for diagnostics, and for `from` when the file itself includes others. Two INCLUDEs of one file must give
    /// the same name, by which a circle is found.
    pub name: String,
    /// Contents.
    pub text: Vec<u8>,
}

/// An INCLUDE statement whose path may go on over lines.
#[derive(Debug, Default)]
pub(super) struct IncludeStatement {
    path: Vec<u8>,
    quote: Option<u8>,
}

/// What a line gives to an INCLUDE statement.
pub(super) enum Progress {
    /// The path goes on in the next line.
    Open(IncludeStatement),
    /// The path is complete.
    Done(String),
}

/// The text after the keyword if the line (without leading blanks) is an INCLUDE statement.
pub(super) fn after_keyword(line: &[u8]) -> Option<&[u8]> {
    let line = line.trim_ascii_start();
    let (word, rest) = line.split_at_checked(7)?;
    let separated = matches!(rest.first(), None | Some(b' ' | b'\t' | b'\'' | b'"' | b'='));
    (word.eq_ignore_ascii_case(b"INCLUDE") && separated).then(|| {
        let rest = rest.trim_ascii_start();
        rest.strip_prefix(b"=").unwrap_or(rest).trim_ascii_start()
    })
}

impl IncludeStatement {
    /// Takes the text after the keyword, or a further line. A path in quotes ends with the quote, wherever that is;
    /// one without ends with the line.
    pub(super) fn take(mut self, text: &[u8], first: bool) -> Progress {
        let mut text = text.trim_ascii();
        if first && let Some((&quote @ (b'\'' | b'"'), rest)) = text.split_first() {
            self.quote = Some(quote);
            text = rest;
        }
        let Some(quote) = self.quote else {
            let end = text
                .iter()
                .position(|b| b.is_ascii_whitespace() || *b == b'$')
                .unwrap_or(text.len());
            self.path.extend_from_slice(text.get(..end).unwrap_or_default());
            return self.done();
        };
        match text.iter().position(|&b| b == quote) {
            Some(end) => {
                self.path.extend_from_slice(text.get(..end).unwrap_or_default());
                self.done()
            }
            None => {
                self.path.extend_from_slice(text);
                Progress::Open(self)
            }
        }
    }

    fn done(self) -> Progress {
        Progress::Done(String::from_utf8_lossy(&self.path).trim().to_owned())
    }

    /// What has been read of the path.
    pub(super) fn so_far(&self) -> String {
        String::from_utf8_lossy(&self.path).into_owned()
    }
}

/// Reads an included file: relative to the including file, then to the main file; with Windows separators as they
/// are, then as slashes.
pub(super) fn from_disk(include: &str, from: &Path, main_folder: &Path) -> Result<Included, String> {
    let spellings = [PathBuf::from(include), PathBuf::from(include.replace('\\', "/"))];
    let folders = [from.parent().unwrap_or(Path::new("")), main_folder];
    let candidates = spellings
        .iter()
        .flat_map(|s| folders.iter().map(move |f| f.join(s)));
    let mut reason = String::from("the path is empty");
    for path in candidates {
        if !path.is_file() {
            reason = format!("no such file as {}", path.display());
            continue;
        }
        match std::fs::read(&path) {
            // One name for one file, however it is reached, so that circles are found.
            Ok(text) => {
                let name = path.canonicalize().unwrap_or(path).display().to_string();
                return Ok(Included { name, text });
            }
            Err(error) => reason = format!("{} cannot be read: {error}", path.display()),
        }
    }
    Err(format!("{reason}; paths are relative to the including file"))
}
