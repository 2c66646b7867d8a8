//! `cargo xtask validate`: the F25-like case against the paper and the reference.
//!
//! Runs the case of `fixtures/f25-like` for its variants, and writes `docs/validation/`: a page, every table as CSV and
//! JSON, every figure as SVG. `--check` does the same in a temporary directory and compares.
//!
//! | module | subject |
//! |---|---|
//! | [`study`] | the computation |
//! | [`mod@reference`], [`paper`] | what it is compared with |
//! | [`tables`], [`fits`], [`account`], [`figures`] | what is shown |
//! | [`page`] | the page and the provenance of its inputs |
//! | [`check`] | comparison of two directories of results |

mod account;
mod check;
mod figures;
mod fits;
mod page;
mod paper;
mod reference;
mod study;
mod tables;

pub(crate) use paper::read_json;

use crate::error::Error;
use crate::workspace;
use std::path::{Path, PathBuf};
use std::time::Instant;
use study::Study;
use tables::Named;

/// Where the results are kept.
const KEPT: &str = "docs/validation";

/// Options of `cargo xtask validate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Write nothing; compare fresh results with those kept, measured times apart
    #[arg(long)]
    check: bool,
    /// Directory of the results; docs/validation if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Options {
    /// `--check` against the kept results.
    pub(crate) fn check() -> Self {
        Self {
            check: true,
            out: None,
        }
    }
}

/// Runs the case and writes or checks its results.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    let directory = options.out.clone().unwrap_or_else(|| root.join(KEPT));
    let since = Instant::now();
    eprintln!("validate: the F25-like case");
    let results = Results::compute(&root)?;
    if options.check {
        let fresh = tempfile::tempdir().map_err(Error::file(&std::env::temp_dir()))?;
        results.write(fresh.path())?;
        let differences = check::compare(fresh.path(), &directory, &results.measured())?;
        for difference in &differences {
            println!("{difference}");
        }
        if !differences.is_empty() {
            return Err(Error::Failed(format!(
                "{} differences to {}; if they are meant, run `cargo xtask validate` and commit",
                differences.len(),
                directory.display()
            )));
        }
        println!("{} files agree with {}", results.files.len(), directory.display());
    } else {
        results.write(&directory)?;
        println!("{} files written to {}", results.files.len(), directory.display());
    }
    eprintln!("validate: {:.1} s", since.elapsed().as_secs_f64());
    Ok(())
}

/// All files of the report.
struct Results {
    /// Name and text.
    files: Vec<(String, String)>,
    /// Stems of the files with measured times.
    measured: Vec<&'static str>,
}

impl Results {
    fn compute(root: &Path) -> Result<Self, Error> {
        let mut study = Study::run(root)?;
        let since = Instant::now();
        let account = account::run(&study)?;
        study
            .measured
            .stage("experiments on the difference to the reference", since);
        let mut tables: Vec<Named> = vec![Named::new("inputs", page::inputs(root, &study)?)];
        tables.extend(tables::all(&study)?);
        tables.extend(fits::all(&study)?);
        tables.extend(account.tables.iter().cloned());
        let figures = figures::all(&study)?;
        let mut files = vec![(
            "README.md".to_owned(),
            page::write(&study, &account, &tables, &figures)?,
        )];
        for named in &tables {
            files.push((format!("{}.csv", named.stem), named.table.to_csv()));
            files.push((format!("{}.json", named.stem), pretty(&named.table.to_json())?));
        }
        files.extend(figures.into_iter().map(|figure| (figure.file, figure.svg)));
        let measured = tables.iter().filter(|t| t.measured).map(|t| t.stem).collect();
        Ok(Self { files, measured })
    }

    fn measured(&self) -> Vec<&str> {
        self.measured.clone()
    }

    /// Writes every file whole. The page comes last, when all that it shows is there.
    fn write(&self, directory: &Path) -> Result<(), Error> {
        for (name, text) in self.files.iter().rev() {
            let end = if text.ends_with('\n') { "" } else { "\n" };
            workspace::write_whole(&directory.join(name), &format!("{text}{end}"))?;
        }
        Ok(())
    }
}

fn pretty(value: &serde_json::Value) -> Result<String, Error> {
    serde_json::to_string_pretty(value).map_err(Error::json(Path::new("table")))
}
