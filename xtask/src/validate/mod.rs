//! `cargo xtask validate`: the F25-like case against the paper and the reference.
//!
//! Runs the case of `fixtures/f25-like` for its variants, and writes `docs/validation/`: a page, every table as CSV and
//! JSON, every figure as SVG. `--check` does the same in a temporary directory and compares. `--search` searches the orders
//! of the identified transfer functions first; without it those kept in `docs/validation/search/` are used.
//!
//! | module | subject |
//! |---|---|
//! | [`study`] | the computation |
//! | [`identification`] | transfer functions identified from the reference's histories |
//! | [`mod@reference`], [`paper`] | what it is compared with |
//! | [`solved`] | the same case from deck and geometry alone |
//! | [`tables`], [`fits`], [`account`], [`figures`] | what is shown |
//! | [`page`] | the page and the provenance of its inputs |
//! | [`html`] | the same for a browser, not kept |
//! | [`check`] | comparison of two directories of results |

mod account;
mod check;
mod figures;
mod fits;
mod html;
mod identification;
mod page;
mod paper;
mod reference;
mod solved;
mod study;
mod tables;

pub(crate) use check::{END_OF_MEASURED, MEASURED, differences_of_drawings, differences_of_pages};
pub(crate) use paper::read_json;

use crate::error::Error;
use crate::workspace;
use check::Kind;
use identification::Identification;
use identification::search::{self, Kept};
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
    /// Search the orders of the identified transfer functions first (minutes), and keep them in docs/validation/search
    #[arg(long, conflicts_with = "check")]
    search: bool,
    /// Directory of the results; docs/validation if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Report for a browser, which is too large to be kept; target/validate/report.html if not given
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    html: Option<PathBuf>,
}

impl Options {
    /// `--check` against the kept results.
    pub(crate) fn check() -> Self {
        Self {
            check: true,
            search: false,
            out: None,
            html: None,
        }
    }
}

/// Runs the case and writes or checks its results.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    let directory = options.out.clone().unwrap_or_else(|| root.join(KEPT));
    let since = Instant::now();
    eprintln!("validate: the F25-like case");
    let results = Results::compute(&root, options.search)?;
    if options.check {
        let fresh = tempfile::tempdir().map_err(Error::file(&std::env::temp_dir()))?;
        results.write(fresh.path())?;
        let mut differences = check::compare(fresh.path(), &directory, &results.kinds)?;
        differences.extend(results.stale.iter().cloned());
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
        if let Some(remark) = &results.stale {
            eprintln!("warning: {remark}");
        }
        results.write(&directory)?;
        println!("{} files written to {}", results.files.len(), directory.display());
        let report = options
            .html
            .clone()
            .unwrap_or_else(|| root.join("target/validate/report.html"));
        workspace::write_whole(&report, &results.report)?;
        println!("for a browser: {}", report.display());
    }
    eprintln!("validate: {:.1} s", since.elapsed().as_secs_f64());
    Ok(())
}

/// All files of the report.
struct Results {
    /// Name and text.
    files: Vec<(String, String)>,
    /// Tables of measured and of iterated numbers: stem and kind.
    kinds: Vec<(&'static str, Kind)>,
    /// The report for a browser.
    report: String,
    /// A remark if the kept orders belong to other histories.
    stale: Option<String>,
}

impl Results {
    fn compute(root: &Path, search: bool) -> Result<Self, Error> {
        let start = Instant::now();
        let mut study = Study::run(root)?;
        let (kept, kept_files) = if search {
            search::run(root, &study)?
        } else {
            Kept::read(&root.join(KEPT), &study)?
        };
        let stale = kept.stale(root)?;
        // Neither needs the other's results: side by side.
        let (identified, compared) = std::thread::scope(|scope| {
            let identified = scope.spawn(|| timed(|| Identification::run(&study, kept)));
            let compared = timed(|| solved::run(root, &study)).and_then(|(solved, first)| {
                let (account, second) = timed(|| account::run(&study, &solved))?;
                Ok((solved, first, account, second))
            });
            let panicked = || Err(Error::Failed("the identification panicked".into()));
            (identified.join().unwrap_or_else(|_| panicked()), compared)
        });
        let (solved, solving, account, accounting) = compared?;
        let (identification, identifying) = identified?;
        for (name, seconds) in [
            (
                "the case from deck and geometry alone, twice, and lift between strips",
                solving,
            ),
            ("experiments on the difference to the reference", accounting),
            (
                "beside these: identification of four transfer functions at two orders",
                identifying,
            ),
        ] {
            study.measured.stage_of(name, seconds);
        }
        study.measured.all = start.elapsed().as_secs_f64();
        let mut tables: Vec<Named> = vec![Named::new("inputs", page::inputs(root, &study)?)];
        tables.extend(tables::all(&study)?);
        tables.extend(fits::all(&study)?);
        tables.extend(account.tables.iter().cloned());
        tables.extend(identification.tables(&study)?);
        tables.extend(solved.tables.iter().cloned());
        let figures = figures::all(&study, &identification)?;
        let mut files = vec![(
            "README.md".to_owned(),
            page::write(&study, &account, &identification, &solved, &tables, &figures)?,
        )];
        for named in &tables {
            files.push((format!("{}.csv", named.stem), named.table.to_csv()));
            files.push((format!("{}.json", named.stem), pretty(&named.table.to_json())?));
        }
        for figure in &figures {
            files.push((figure.file.clone(), figure.svg()?));
        }
        files.extend(kept_files);
        let kinds = tables.iter().filter_map(|t| Some((t.stem, t.kind?))).collect();
        let report = html::page(&tables, &figures)?;
        Ok(Self {
            files,
            kinds,
            report,
            stale,
        })
    }

    /// Writes every file whole. The page comes last, when all that it shows is there.
    fn write(&self, directory: &Path) -> Result<(), Error> {
        for (name, text) in self.files.iter().rev() {
            let end = if text.ends_with('\n') { "" } else { "\n" };
            workspace::write_whole(&directory.join(name), format!("{text}{end}"))?;
        }
        Ok(())
    }
}

/// A result with the wall time that it took \[s\].
fn timed<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<(T, f64), Error> {
    let since = Instant::now();
    let result = work()?;
    Ok((result, since.elapsed().as_secs_f64()))
}

fn pretty(value: &serde_json::Value) -> Result<String, Error> {
    serde_json::to_string_pretty(value).map_err(Error::json(Path::new("table")))
}
