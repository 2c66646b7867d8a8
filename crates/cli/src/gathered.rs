//! Several files that belong together: gathered in a temporary directory, moved to where they belong at the end.

use crate::output::{Failure, TEMPORARY, make_directory, write};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Tells whether the command that gathers is alive: it holds this file locked.
const LOCK: &str = "in-use.lock";
/// Name of the lock before it is locked.
const UNLOCKED: &str = "not-yet.lock";

/// Files gathered and moved in together at the end: a command that fails leaves nothing behind, and one that is killed
/// leaves nothing but the temporary directory, which the next one removes.
pub(crate) struct Gathered {
    /// Held until the end; none where the file system has no locks. Let go first, as some systems keep the directories
    /// of open files.
    _lock: Option<File>,
    directory: tempfile::TempDir,
}

impl Gathered {
    /// An empty collection for `out`: in it where it is there, so that files move within one file system and its parent
    /// need not be writable, else beside it. Removes what killed commands left in either place.
    pub(crate) fn beside(out: &Path) -> Result<Self, Failure> {
        let parent = out
            .parent()
            .filter(|p| !p.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        remove_abandoned(parent);
        let place = if out.is_dir() {
            remove_abandoned(out);
            out
        } else {
            make_directory(parent)?;
            parent
        };
        let fail = |source| fail(place, source);
        let mut attempts = 0;
        loop {
            let directory = tempfile::Builder::new()
                .prefix(TEMPORARY)
                .tempdir_in(place)
                .map_err(fail)?;
            attempts += 1;
            match lock(directory.path()) {
                Ok(lock) => {
                    return Ok(Self {
                        _lock: lock,
                        directory,
                    });
                }
                // Another command has removed it while it was empty.
                Err(error) if error.kind() == io::ErrorKind::NotFound && attempts < 5 => {}
                Err(error) => return Err(fail(error)),
            }
        }
    }

    /// Where the files are gathered.
    pub(crate) fn path(&self) -> &Path {
        self.directory.path()
    }

    /// Adds a file.
    pub(crate) fn add(&self, name: &str, content: &str) -> Result<(), Failure> {
        write(&self.path().join(name), content)
    }

    /// Adds a file of JSON.
    pub(crate) fn add_json(&self, name: &str, value: &impl serde::Serialize) -> Result<(), Failure> {
        self.add(name, &(serde_json::to_string_pretty(value)? + "\n"))
    }

    /// Names of the files, sorted.
    pub(crate) fn names(&self) -> Result<Vec<String>, Failure> {
        let mut names = Vec::new();
        for entry in fs::read_dir(self.path()).map_err(|e| fail(self.path(), e))? {
            let name = entry.map_err(|e| fail(self.path(), e))?.file_name();
            let name = name.to_string_lossy().into_owned();
            if name != LOCK && name != UNLOCKED {
                names.push(name);
            }
        }
        names.sort();
        Ok(names)
    }

    /// Moves all files into the directory, each at once, in the order of their names.
    pub(crate) fn move_to(self, out: &Path) -> Result<(), Failure> {
        make_directory(out)?;
        for name in self.names()? {
            let target = out.join(&name);
            fs::rename(self.path().join(&name), &target).map_err(|e| fail(&target, e))?;
        }
        Ok(())
    }
}

impl Drop for Gathered {
    fn drop(&mut self) {
        clear(self.path());
    }
}

fn fail(path: &Path, source: io::Error) -> Failure {
    Failure::Write {
        path: path.display().to_string(),
        source,
    }
}

/// A locked file in the directory. It gets its name when it is locked, so that nobody finds it free while its owner lives.
fn lock(directory: &Path) -> io::Result<Option<File>> {
    let before = directory.join(UNLOCKED);
    let file = File::create(&before)?;
    if file.try_lock().is_err() {
        return Ok(None);
    }
    fs::rename(&before, directory.join(LOCK))?;
    Ok(Some(file))
}

/// Removes what is in a temporary directory but its lock: whoever is killed here leaves what the next one recognises.
fn clear(directory: &Path) {
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        if entry.file_name() != LOCK {
            // What cannot be removed stays for the removal of the directory to fail on.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Removes the temporary directories in `place` whose owners are dead: those with a lock that nobody holds, and empty ones.
/// What cannot be removed is left to the user; it disturbs nothing.
fn remove_abandoned(place: &Path) {
    let Ok(entries) = fs::read_dir(place) else {
        return;
    };
    let temporary = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(TEMPORARY) && path.is_dir() && !path.is_symlink()
    };
    for directory in entries.flatten().map(|e| e.path()).filter(temporary) {
        match File::open(directory.join(LOCK)) {
            // Another command may be at the same: what is gone already is as good.
            Ok(file) if file.try_lock().is_ok() => {
                clear(&directory);
                let _ = fs::remove_dir_all(&directory);
            }
            Ok(_) => {}
            // Fails where something is in it.
            Err(_) => {
                let _ = fs::remove_dir(&directory);
            }
        }
    }
}
