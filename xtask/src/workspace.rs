//! Where things are, and files that are written whole or not at all.

use crate::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Root of the workspace.
pub(crate) fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_path_buf()
}

/// Where cargo builds.
pub(crate) fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}

/// Reads a text file.
pub(crate) fn read(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(Error::file(path))
}

/// Writes a file under a temporary name beside its place, then renames it: a reader sees the old file or the new.
pub(crate) fn write_whole(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Error> {
    let directory = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(directory).map_err(Error::file(directory))?;
    let mut file = tempfile::NamedTempFile::new_in(directory).map_err(Error::file(path))?;
    file.write_all(content.as_ref()).map_err(Error::file(path))?;
    // Temporary files are for their owner alone; documents are for everybody.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let everybody = std::fs::Permissions::from_mode(0o644);
        file.as_file()
            .set_permissions(everybody)
            .map_err(Error::file(path))?;
    }
    file.persist(path).map_err(|e| Error::file(path)(e.error))?;
    Ok(())
}
