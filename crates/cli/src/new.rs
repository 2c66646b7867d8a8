//! A case to start from.

use crate::args::NewOptions;
use crate::output::{Failure, make_directory, print, print_json, write};
use serde_json::json;

/// A small complete aircraft: deck, geometry and case.
const FILES: [(&str, &str); 3] = [
    ("case.toml", include_str!("../template/case.toml")),
    ("aircraft.bdf", include_str!("../template/aircraft.bdf")),
    ("aircraft.avl", include_str!("../template/aircraft.avl")),
];

pub(crate) fn new(options: &NewOptions) -> Result<(), Failure> {
    let dir = &options.dir;
    let taken: Vec<&str> = FILES
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| dir.join(name).exists())
        .collect();
    if !taken.is_empty() {
        return Err(Failure::Other(format!(
            "{}: there is already {}; choose another directory, or move {} away",
            dir.display(),
            taken.join(", "),
            if taken.len() == 1 { "it" } else { "them" }
        )));
    }
    make_directory(dir)?;
    for (name, text) in FILES {
        write(&dir.join(name), text)?;
    }
    let files: Vec<String> = FILES
        .iter()
        .map(|(name, _)| dir.join(name).display().to_string())
        .collect();
    if options.json {
        return print_json(&json!({ "files": files }));
    }
    if options.quiet {
        return Ok(());
    }
    let (case, out) = (dir.join("case.toml"), dir.join("out"));
    print(&format!(
        "A case with a small aircraft, deck and geometry, is in {}: {}.\n\n\
         Check it:    albatross check {case}\n\
         Run it:      albatross run {case} --out {}\n\
         Then put your deck and geometry in the place of the two, and name them in {case}.",
        dir.display(),
        FILES.map(|(name, _)| name).join(", "),
        out.display(),
        case = case.display(),
    ))
}
