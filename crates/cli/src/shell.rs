//! Completions and manual pages.

use crate::args::{Arguments, ManOptions};
use crate::gathered::Gathered;
use crate::output::{Failure, print, print_json};
use clap::CommandFactory;
use clap_complete::Shell;
use serde_json::json;

pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "albatross", &mut script);
    print(&String::from_utf8_lossy(&script))
}

pub(crate) fn man(options: &ManOptions) -> Result<(), Failure> {
    let gathered = Gathered::beside(&options.dir)?;
    clap_mangen::generate_to(Arguments::command(), gathered.path()).map_err(|source| Failure::Write {
        path: options.dir.display().to_string(),
        source,
    })?;
    let names = gathered.names()?;
    gathered.move_to(&options.dir)?;
    let files: Vec<String> = names
        .iter()
        .map(|n| options.dir.join(n).display().to_string())
        .collect();
    if options.json {
        print_json(&json!({ "files": files }))
    } else if options.quiet {
        Ok(())
    } else {
        print(&format!(
            "{} pages are in {}: man {}/albatross.1",
            files.len(),
            options.dir.display(),
            options.dir.display()
        ))
    }
}
