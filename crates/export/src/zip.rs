//! Archives of files that are stored as they are (APPNOTE 6.3, PKWARE): what an `.npz` file is.

use crate::{Error, Result};

const FORMAT: &str = "zip archive";

/// Version 2.0 of the format, names in UTF-8, stored, 1 January 1980: the same content gives the same bytes.
const COMMON: [u8; 10] = [20, 0, 0, 8, 0, 0, 0, 0, 0x21, 0];

/// An archive of named files.
///
/// # Errors
/// [`Error::TooLarge`] beyond 4 GiB, 65535 files, or for a name of 64 KiB.
pub(crate) fn archive(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>> {
    let mut out = Vec::new();
    let mut directory = Vec::new();
    for (name, data) in files {
        let offset = size("the archive", out.len())?;
        let length = size(name, data.len())?;
        let mut entry = COMMON.to_vec();
        entry.extend(crc32fast::hash(data).to_le_bytes());
        // Compressed and plain: the same.
        entry.extend(length);
        entry.extend(length);
        entry.extend(count("the length of a name", name.len())?);
        entry.extend([0, 0]);
        out.extend(b"PK\x03\x04");
        out.extend(&entry);
        out.extend(name.bytes());
        out.extend(data);

        directory.extend(b"PK\x01\x02");
        directory.extend([20, 0]);
        directory.extend(&entry);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(offset);
        directory.extend(name.bytes());
    }
    let start = size("the archive", out.len())?;
    let files = count("the number of files", files.len())?;
    let length = size("the directory", directory.len())?;
    out.extend(directory);
    out.extend(b"PK\x05\x06");
    out.extend([0; 4]);
    out.extend(files);
    out.extend(files);
    out.extend(length);
    out.extend(start);
    out.extend([0, 0]);
    Ok(out)
}

fn size(what: &str, found: usize) -> Result<[u8; 4]> {
    let value = u32::try_from(found).map_err(|_| too_large(what, found, u32::MAX as usize))?;
    Ok(value.to_le_bytes())
}

fn count(what: &str, found: usize) -> Result<[u8; 2]> {
    let value = u16::try_from(found).map_err(|_| too_large(what, found, u16::MAX as usize))?;
    Ok(value.to_le_bytes())
}

pub(crate) fn too_large(what: &str, found: usize, most: usize) -> Error {
    Error::TooLarge {
        what: what.to_owned(),
        format: FORMAT,
        found,
        most,
    }
}
