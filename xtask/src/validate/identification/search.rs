//! The search of the orders: `cargo xtask validate --search`, and what is kept of it.
//!
//! The search takes minutes, so that `validate` does not repeat it: it reads the orders from `search/orders.json` beside
//! its results and estimates at them. `--search` writes that file, a table of all candidates and a drawing of their fits.

use super::{TARGETS, Target, paper_order};
use crate::error::Error;
use crate::validate::page::fnv1a;
use crate::validate::paper::read_json;
use crate::validate::reference::MANOEUVRES;
use crate::validate::study::Study;
use crate::workspace;
use albatross::report::plot::{Axis, LinePlot, Marker, Panel, Series, Style};
use albatross::report::{Cell, Column, Format, Table};
use albatross::sysid::{self, OrderSearch, SearchOptions, Training};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Directory of the kept files, below that of the results.
pub(crate) const DIRECTORY: &str = "search";
/// The orders.
const ORDERS: &str = "orders.json";
/// Every candidate.
const CANDIDATES: &str = "candidates.csv";
/// Fits against the number of poles.
pub(crate) const DRAWING: &str = "fit_by_order.svg";

/// Numbers of poles tried.
const POLES: [usize; 2] = [4, 26];

/// What is kept of a search.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Kept {
    /// How the file comes about.
    written_by: String,
    /// Rule of the choice.
    criterion: String,
    /// Least and greatest number of poles tried.
    pub(crate) poles: [usize; 2],
    /// Poles less zeros.
    excess: Vec<usize>,
    /// Records on which each order was trained.
    trainings: Vec<String>,
    /// Starts of every estimation.
    starts: usize,
    /// Seed of the starts beyond the sixth.
    seed: u64,
    /// The histories searched on.
    histories: Vec<Checksum>,
    /// Outputs in the order of the paper's Table 4.
    pub(crate) outputs: Vec<Order>,
}

/// A file and the checksum of its text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Checksum {
    file: String,
    fnv1a_64: String,
}

/// The order found for one output.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Order {
    /// Code of the paper.
    pub(crate) output: String,
    pub(crate) poles: usize,
    pub(crate) zeros: usize,
    /// Mean fit on the three histories \[%\].
    pub(crate) score_percent: f64,
    /// Greatest score of any order and the order.
    pub(crate) best_percent: f64,
    pub(crate) best_poles: usize,
    /// Why it was chosen.
    pub(crate) reason: String,
    /// At the paper's order, trained on one history: the best of the three.
    pub(crate) single_at_paper_order: Option<Single>,
}

/// A transfer function trained on one history.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Single {
    /// The history, as shown.
    pub(crate) trained_on: String,
    /// Mean fit on all three \[%\].
    pub(crate) average_percent: f64,
}

/// The kept files: name below the directory of the results, and text.
pub(crate) type Files = Vec<(String, String)>;

impl Kept {
    /// Reads what is kept below the directory of the results, and draws it anew.
    pub(crate) fn read(results: &Path, study: &Study) -> Result<(Self, Files), Error> {
        let directory = results.join(DIRECTORY);
        let kept: Self = read_json(&directory.join(ORDERS))?;
        let orders = workspace::read(&directory.join(ORDERS))?;
        let candidates = workspace::read(&directory.join(CANDIDATES))?;
        let files = kept.files(study, orders, candidates)?;
        Ok((kept, files))
    }

    /// The files of a search: its orders, its candidates, and a drawing of these.
    fn files(&self, study: &Study, orders: String, candidates: String) -> Result<Files, Error> {
        let drawing = self.drawing(study, &rows(&candidates)?)?;
        let files = [(ORDERS, orders), (CANDIDATES, candidates), (DRAWING, drawing)];
        Ok(files
            .map(|(name, text)| (format!("{DIRECTORY}/{name}"), text))
            .into())
    }

    /// The order of an output.
    pub(crate) fn order(&self, target: Target) -> Result<&Order, Error> {
        let found = self.outputs.iter().find(|o| o.output == target.code);
        found.ok_or_else(|| Error::Mismatch {
            what: format!("orders in {ORDERS}"),
            found: "none".into(),
            expected: format!("one for {}; run `cargo xtask validate --search`", target.code),
        })
    }

    /// A remark if the histories are no longer those searched on.
    pub(crate) fn stale(&self, root: &Path) -> Result<Option<String>, Error> {
        Ok((self.histories != checksums(root)?).then(|| {
            format!(
                "{DIRECTORY}/{ORDERS}: the orders were searched on other histories; run `cargo xtask validate --search`"
            )
        }))
    }
}

fn checksums(root: &Path) -> Result<Vec<Checksum>, Error> {
    MANOEUVRES
        .iter()
        .map(|(name, _)| {
            let file = format!("fixtures/f25-like/reference/{name}.csv");
            Ok(Checksum {
                fnv1a_64: format!("{:016x}", fnv1a(workspace::read(&root.join(&file))?.as_bytes())),
                file,
            })
        })
        .collect()
}

/// Searches the orders of all outputs.
pub(crate) fn run(root: &Path, study: &Study) -> Result<(Kept, Files), Error> {
    let options = SearchOptions::new(POLES[0], POLES[1]);
    let mut searches = Vec::new();
    for target in TARGETS {
        let since = Instant::now();
        eprintln!("search: {}", target.name());
        let told = AtomicUsize::new(0);
        let progress = |done: usize, total: usize| {
            let tenth = 10 * done / total.max(1);
            if told.fetch_max(tenth, Ordering::Relaxed) < tenth {
                eprintln!(
                    "  {:6.1} s  {done} of {total} candidates",
                    since.elapsed().as_secs_f64()
                );
            }
        };
        let found = sysid::search(&target.data(&study.reference)?, &options, &progress)?;
        eprintln!("  {}", found.reason);
        searches.push((target, found));
    }
    let kept = Kept {
        written_by: "cargo xtask validate --search".into(),
        criterion: format!(
            "least number of poles whose mean fit on the three histories, trained on all of them, is within {} points \
             of the best",
            options.tolerance_points
        ),
        poles: options.poles,
        excess: options.excess.clone(),
        trainings: MANOEUVRES
            .iter()
            .map(|(_, shown)| (*shown).to_owned())
            .chain(["all".to_owned()])
            .collect(),
        starts: options.estimation.starts,
        seed: options.estimation.seed,
        histories: checksums(root)?,
        outputs: searches
            .iter()
            .map(|(target, found)| order(study, *target, found))
            .collect::<Result<_, _>>()?,
    };
    let mut orders = serde_json::to_string_pretty(&kept).map_err(Error::json(Path::new(ORDERS)))?;
    orders.push('\n');
    let files = kept.files(study, orders, candidates(&searches)?.to_csv())?;
    Ok((kept, files))
}

fn order(study: &Study, target: Target, found: &OrderSearch) -> Result<Order, Error> {
    let chosen = found.candidates.get(found.chosen);
    let best = found.scores.iter().max_by(|a, b| a.2.total_cmp(&b.2));
    let (Some(chosen), Some(best)) = (chosen, best) else {
        return Err(Error::Failed(format!("{}: no order was found", target.name())));
    };
    let paper = paper_order(study, target)?;
    let single = found
        .candidates
        .iter()
        .filter(|c| (c.poles, c.zeros) == paper && matches!(c.training, Training::Single(_)))
        .filter_map(|c| Some((c, c.average?)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    Ok(Order {
        output: target.code.into(),
        poles: chosen.poles,
        zeros: chosen.zeros,
        score_percent: chosen.average.unwrap_or(f64::NAN),
        best_percent: best.2,
        best_poles: best.0,
        reason: found.reason.clone(),
        single_at_paper_order: single.map(|(c, average_percent)| Single {
            trained_on: trained_on(c.training),
            average_percent,
        }),
    })
}

fn trained_on(training: Training) -> String {
    match training {
        Training::Merged => "all".into(),
        Training::Single(one) => MANOEUVRES.get(one).map_or("", |(_, shown)| *shown).into(),
        Training::AllBut(one) => format!("all but {}", MANOEUVRES.get(one).map_or("", |(_, shown)| *shown)),
    }
}

/// Every candidate of every output.
fn candidates(searches: &[(Target, OrderSearch)]) -> Result<Table, Error> {
    let percent = |name: &str| Column::new(name, "%", Format::Fixed(3));
    let mut heads = vec![
        Column::text("output"),
        Column::new("poles", "", Format::Fixed(0)),
        Column::new("zeros", "", Format::Fixed(0)),
        Column::text("trained on"),
    ];
    heads.extend(MANOEUVRES.iter().map(|(_, shown)| percent(shown).in_group("fit")));
    heads.push(percent("mean fit"));
    heads.push(percent("mean fit on histories not trained on"));
    heads.push(Column::new("Bayesian criterion", "", Format::Fixed(1)));
    heads.push(Column::text("failure"));
    let mut table = Table::new("Candidates of the search", heads);
    // To a thousandth of a point: what lies beyond differs from machine to machine.
    let rounded = |value: Option<f64>| Cell::from(value.map(|v| (1e3 * v).round() / 1e3));
    for (target, found) in searches {
        for candidate in &found.candidates {
            let unseen = candidate.score.filter(|_| candidate.training != Training::Merged);
            let mut row = vec![
                Cell::from(target.name()),
                candidate.poles.into(),
                candidate.zeros.into(),
                trained_on(candidate.training).into(),
            ];
            row.extend(candidate.fits.iter().map(|f| rounded(*f)));
            row.extend([
                rounded(candidate.average),
                rounded(unseen),
                rounded(candidate.bic),
            ]);
            row.push(candidate.failure.as_deref().into());
            table.push(row)?;
        }
    }
    Ok(table)
}

/// What is drawn of a candidate, as its file has it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Row {
    output: String,
    poles: usize,
    #[serde(rename = "trained on")]
    trained_on: String,
    #[serde(rename = "mean fit [%]")]
    mean_fit: Option<f64>,
}

fn rows(candidates: &str) -> Result<Vec<Row>, Error> {
    let mut reader = csv::Reader::from_reader(candidates.as_bytes());
    reader
        .deserialize()
        .collect::<Result<_, _>>()
        .map_err(|e| Error::Mismatch {
            what: CANDIDATES.to_owned(),
            found: e.to_string(),
            expected: "candidates as `cargo xtask validate --search` writes them".into(),
        })
}

impl Kept {
    /// Mean fit of all candidates over the number of poles, a panel for each output.
    fn drawing(&self, study: &Study, rows: &[Row]) -> Result<String, Error> {
        let trainings = (0..MANOEUVRES.len())
            .map(Training::Single)
            .chain([Training::Merged])
            .enumerate();
        let mut plot = LinePlot::new(
            "Mean fit on the three histories against the number of poles",
            Axis::new("Number of poles", "").with_limits(POLES[0] as f64, POLES[1] as f64),
        );
        for target in TARGETS {
            let mut panel = Panel::over(Axis::new(target.shown()?.symbol, "%").with_limits(40.0, 100.0));
            for (index, training) in trainings.clone() {
                let trained_on = trained_on(training);
                let of = rows
                    .iter()
                    .filter(|row| row.output == target.name() && row.trained_on == trained_on);
                let (poles, fits): (Vec<f64>, Vec<f64>) = of
                    .map(|row| (row.poles as f64, row.mean_fit.unwrap_or(f64::NAN)))
                    .unzip();
                let (style, name) = match training {
                    Training::Merged => (Style::reference(), "trained on all three".to_owned()),
                    _ => (Style::model(index), format!("trained on {trained_on} alone")),
                };
                let style = style.with_marker(Marker::Disc);
                panel.series.push(Series::new(name, style, poles, fits));
            }
            let (paper, _) = paper_order(study, target)?;
            let chosen = self.order(target)?.poles;
            panel = if chosen == paper {
                panel.with_guide_x(paper as f64, "paper, chosen")
            } else {
                panel
                    .with_guide_x(paper as f64, "paper")
                    .with_guide_x(chosen as f64, "chosen")
            };
            plot.panels.push(panel.with_height(170.0));
        }
        Ok(plot.without_heading().render()?.markup)
    }
}

/// The searched orders for the page.
pub(crate) fn summary(kept: &Kept) -> Result<Table, Error> {
    let percent = |name: &str| Column::new(name, "%", Format::Fixed(2));
    let mut table = Table::new(
        "The searched orders",
        [
            Column::text("output"),
            Column::text("poles and zeros"),
            percent("mean fit"),
            Column::new("poles of the best", "", Format::Fixed(0)),
            percent("mean fit of the best"),
            Column::text("trained on").in_group("paper's order, best of the single histories"),
            percent("mean fit").in_group("paper's order, best of the single histories"),
        ],
    )
    .with_caption(format!(
        "Written by `cargo xtask validate --search`, which tries {} to {} poles with one zero less, trained on each \
         history alone and on all together, {} starts each. Chosen: the {}. A plain `validate` keeps these figures and \
         estimates anew at the orders found.",
        kept.poles[0], kept.poles[1], kept.starts, kept.criterion
    ));
    for target in TARGETS {
        let order = kept.order(target)?;
        let single = order.single_at_paper_order.as_ref();
        table.push([
            Cell::from(target.name()),
            format!("{} and {}", order.poles, order.zeros).into(),
            order.score_percent.into(),
            order.best_poles.into(),
            order.best_percent.into(),
            single.map(|s| s.trained_on.as_str()).into(),
            single.map(|s| s.average_percent).into(),
        ])?;
    }
    Ok(table)
}
