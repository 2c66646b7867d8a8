//! `identify search`: the number of poles and zeros.

use super::args::SearchOptions as Arguments;
use super::figures::short_names;
use super::identify::{Identified, present, settings};
use super::records;
use crate::output::Failure;
use albatross::report::plot::{Axis, LinePlot, Marker, Panel, Series, Style};
use albatross::report::{Cell, Column, Format, ReportError, Table};
use albatross::sysid::search::Training;
use albatross::sysid::{Candidate, OrderSearch, SearchOptions, search as search_orders};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::time::Instant;

/// A search and the names of its records.
pub(crate) struct Searched {
    pub(crate) search: OrderSearch,
    pub(crate) names: Vec<String>,
    pub(crate) seconds: f64,
}

pub(crate) fn search(options: &Arguments) -> Result<(), Failure> {
    let quiet = options.result.quiet;
    let records = records::read(&options.data, quiet)?;
    let all: Vec<usize> = (0..records.data.experiments.len()).collect();
    let [least, greatest] = options.np;
    let mut orders = SearchOptions::new(least, greatest);
    orders.excess.clone_from(&options.excess);
    orders.single = !options.merged_only;
    orders.leave_one_out = options.leave_one_out;
    orders.tolerance_points = options.parsimony;
    orders.estimation = settings(&options.estimation, least, least, &records, &all)?;

    let bar = ProgressBar::with_draw_target(None, target(quiet)).with_style(style());
    let progress = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let start = Instant::now();
    let found = match options.threads {
        None => search_orders(&records.data, &orders, &progress),
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| Failure::Other(format!("--threads {threads}: {e}")))?
            .install(|| search_orders(&records.data, &orders, &progress)),
    };
    bar.finish_and_clear();
    let searched = Searched {
        search: found?,
        names: records.data.experiments.iter().map(|e| e.name.clone()).collect(),
        seconds: start.elapsed().as_secs_f64(),
    };
    let chosen = searched
        .search
        .candidates
        .get(searched.search.chosen)
        .map_or((least, least.saturating_sub(1)), |c| (c.poles, c.zeros));
    // Once more with standard deviations, which the candidates are spared.
    let settings = settings(&options.estimation, chosen.0, chosen.1, &records, &all)?;
    let identified = Identified::new(records, all, settings)?;
    present(
        &identified,
        &options.result,
        options.estimation.log,
        Some(&searched),
    )
}

fn target(quiet: bool) -> ProgressDrawTarget {
    if quiet || !std::io::stderr().is_terminal() {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr()
    }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{bar:40} {pos}/{len} candidates, {elapsed} gone, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Training and excess of poles of a curve, numbers of poles, scores.
type Curve = ((Training, usize), Vec<f64>, Vec<f64>);

impl Searched {
    /// Names of the records without their directories, where that tells them apart.
    fn short_names(&self) -> Vec<&str> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        short_names(&names)
    }

    /// What a candidate was trained on.
    fn training(&self, training: Training) -> String {
        let short = self.short_names();
        let name = |p: usize| short.get(p).copied().unwrap_or_default();
        match training {
            Training::Merged => "all records".to_owned(),
            Training::Single(p) => name(p).to_owned(),
            Training::AllBut(p) => format!("all but {}", name(p)),
        }
    }

    /// All candidates.
    pub(crate) fn table(&self) -> Result<Table, ReportError> {
        let mut columns = vec![
            Column::new("np", "", Format::Fixed(0)),
            Column::new("nz", "", Format::Fixed(0)),
            Column::text("trained on"),
        ];
        columns.extend(
            self.short_names()
                .into_iter()
                .map(|n| Column::new(n, "%", Format::Fixed(2)).in_group("fit")),
        );
        columns.push(Column::new("mean", "%", Format::Fixed(2)));
        columns.push(Column::new("unseen", "%", Format::Fixed(2)));
        columns.push(Column::new("BIC", "", Format::Fixed(1)));
        columns.push(Column::text("remark"));
        let mut table = Table::new("Candidates", columns);
        for (i, candidate) in self.search.candidates.iter().enumerate() {
            table.push(self.row(i, candidate))?;
        }
        Ok(table)
    }

    fn row(&self, i: usize, candidate: &Candidate) -> Vec<Cell> {
        let mut cells = vec![
            Cell::from(candidate.poles),
            Cell::from(candidate.zeros),
            Cell::from(self.training(candidate.training)),
        ];
        cells.extend(candidate.fits.iter().map(|fit| Cell::from(*fit)));
        let unseen = candidate
            .score
            .filter(|_| candidate.training.positions(self.names.len()).len() < self.names.len());
        cells.push(Cell::from(candidate.average));
        cells.push(Cell::from(unseen));
        cells.push(Cell::from(candidate.bic));
        cells.push(Cell::from(match &candidate.failure {
            Some(failure) => failure.clone(),
            None if i == self.search.chosen => "chosen".to_owned(),
            None => String::new(),
        }));
        cells
    }

    /// Mean fit on the records not seen (on all, for models of all records) over the number of poles, a curve for every
    /// training and excess of poles.
    pub(crate) fn figure(&self) -> Result<String, ReportError> {
        let mut curves: Vec<Curve> = Vec::new();
        for candidate in &self.search.candidates {
            let Some(score) = candidate.score else { continue };
            let key = (candidate.training, candidate.poles - candidate.zeros);
            let poles = candidate.poles as f64;
            match curves.iter_mut().find(|(known, ..)| *known == key) {
                Some((_, x, y)) => {
                    x.push(poles);
                    y.push(score);
                }
                None => curves.push((key, vec![poles], vec![score])),
            }
        }
        let excesses = curves
            .iter()
            .any(|((_, excess), ..)| Some(*excess) != curves.first().map(|c| c.0.1));
        // A failed order would hide the differences between good ones.
        let best = curves.iter().flat_map(|(.., y)| y).copied().fold(0.0, f64::max);
        let worst = curves.iter().flat_map(|(.., y)| y).copied().fold(best, f64::min);
        let mut axis = Axis::new("Mean fit on records not used", "%");
        if best > 0.0 && worst < best - 60.0 {
            axis = axis.with_limits((best - 60.0).floor(), best + 1.0);
        }
        let mut panel = Panel::over(axis);
        for (i, ((training, excess), np, score)) in curves.into_iter().enumerate() {
            let mut name = self.training(training);
            if training == Training::Merged {
                // No record is left to score it.
                name += " (on themselves)";
            }
            if excesses {
                name = format!("{name}, nz = np - {excess}");
            }
            let (style, marker) = match training {
                Training::Merged => (Style::reference(), Marker::Disc),
                _ => (Style::model(i), Marker::Circle),
            };
            panel = panel.with(Series::new(name, style.with_marker(marker), np, score));
        }
        if let Some(chosen) = self.search.candidates.get(self.search.chosen) {
            panel = panel.with_guide_x(chosen.poles as f64, format!("chosen: {}", chosen.poles));
        }
        let mut orders = Axis::new("Number of poles", "");
        let poles = self.search.candidates.iter().map(|c| c.poles);
        let (least, most) = (poles.clone().min().unwrap_or(0), poles.max().unwrap_or(0));
        if most - least < 6 {
            // Wide enough for ticks at whole numbers only.
            let low = least.saturating_sub((7 - (most - least)) / 2);
            orders = orders.with_limits(low as f64, (low + 7).max(most + 1) as f64);
        }
        let plot = LinePlot::new("Search for the order", orders).with(panel);
        Ok(plot.render()?.markup)
    }

    pub(crate) fn text(&self) -> Result<String, ReportError> {
        Ok(format!(
            "{}\nchosen: {} ({} candidates in {:.1} s)\n",
            self.table()?.to_text(),
            self.search.reason,
            self.search.candidates.len(),
            self.seconds
        ))
    }

    pub(crate) fn json(&self) -> Value {
        let candidates: Vec<Value> = self
            .search
            .candidates
            .iter()
            .map(|c| {
                let fits: serde_json::Map<String, Value> = self
                    .names
                    .iter()
                    .zip(&c.fits)
                    .map(|(name, fit)| (name.clone(), json!(fit)))
                    .collect();
                json!({
                    "np": c.poles,
                    "nz": c.zeros,
                    "training": c.training.positions(self.names.len()).iter()
                        .filter_map(|&p| self.names.get(p)).collect::<Vec<_>>(),
                    "fits": fits,
                    "score": c.score,
                    "average": c.average,
                    "bic": c.bic,
                    "failure": c.failure,
                })
            })
            .collect();
        let scores: Vec<Value> = self
            .search
            .scores
            .iter()
            .map(|(np, nz, score)| json!({ "np": np, "nz": nz, "score": score }))
            .collect();
        json!({
            "candidates": candidates,
            "chosen": self.search.chosen,
            "scores": scores,
            "reason": self.search.reason,
            "seconds": self.seconds,
        })
    }
}
