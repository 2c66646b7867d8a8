//! The neutral models: JSON in, JSON out.

use crate::output::{Failure, print_json};
use albatross::neutral::{aircraft, wing};
use std::io::Read;
use std::path::Path;

pub(crate) fn wing(file: &Path) -> Result<(), Failure> {
    let (text, name) = read(file)?;
    print_json(&wing::analyse(&wing::read(&text, &name)?, &name)?)
}

pub(crate) fn aircraft(file: &Path) -> Result<(), Failure> {
    let (text, name) = read(file)?;
    print_json(&aircraft::analyse(&aircraft::read(&text, &name)?, &name)?)
}

fn read(file: &Path) -> Result<(String, String), Failure> {
    if file.as_os_str() == "-" {
        let mut text = String::new();
        let name = "standard input".to_owned();
        std::io::stdin()
            .read_to_string(&mut text)
            .map_err(|source| albatross::Error::Read {
                file: name.clone(),
                source,
            })?;
        return Ok((text, name));
    }
    Ok((albatross::inputs::read_text(file)?, file.display().to_string()))
}
