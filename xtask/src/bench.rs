//! `cargo xtask bench`: runs the benches and collects their results in one table, with ratios within each group and to the
//! floors of the machine that were measured in the same run.

use crate::ci::cargo;
use crate::error::Error;
use crate::validate::read_json;
use crate::workspace;
use albatross::report::{Cell, Column, Format, Table};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Options of `cargo xtask bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Write the ratios to a JSON file as well: times are of one machine and one day, ratios less so
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Run only benches whose name contains this
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
    /// Run nothing; collect what earlier runs left
    #[arg(long)]
    collect_only: bool,
}

/// Runs the benches and prints the table.
pub(crate) fn run(options: &Options) -> Result<(), Error> {
    let root = workspace::root();
    // Results of earlier runs stay where they are; those of this one are newer.
    let mut since = SystemTime::UNIX_EPOCH;
    if !options.collect_only {
        since = SystemTime::now();
        let mut arguments = vec!["bench", "--workspace", "--benches"];
        if let Some(filter) = &options.filter {
            arguments.extend(["--", filter.as_str()]);
        }
        cargo(&arguments, &[])?;
    }
    let results = collect(&workspace::target(&root).join("criterion"), since)?;
    if results.is_empty() {
        return Err(Error::Failed(
            "no results; run without --collect-only, or with another --filter".into(),
        ));
    }
    print!("{}", table(&results)?.to_text());
    if let Some(path) = &options.json {
        let mut text =
            serde_json::to_string_pretty(&ratios(&results)).map_err(Error::json(Path::new("ratios")))?;
        text.push('\n');
        workspace::write_whole(path, &text)?;
        println!("written to {}", path.display());
    }
    Ok(())
}

/// What criterion measured of one function.
#[derive(Debug, Clone)]
struct Measurement {
    name: Benchmark,
    estimates: Estimates,
}

/// `benchmark.json`.
#[derive(Debug, Clone, Deserialize)]
struct Benchmark {
    group_id: String,
    function_id: Option<String>,
    value_str: Option<String>,
    throughput: Option<Throughput>,
}

/// Work of one iteration.
#[derive(Debug, Clone, Copy, Deserialize)]
enum Throughput {
    Bytes(f64),
    /// Floating-point operations, in the benches that give any.
    Elements(f64),
    #[serde(untagged)]
    Other(#[allow(dead_code)] serde::de::IgnoredAny),
}

/// `estimates.json`, times in ns.
#[derive(Debug, Clone, Deserialize)]
struct Estimates {
    median: Estimate,
}

#[derive(Debug, Clone, Deserialize)]
struct Estimate {
    point_estimate: f64,
    confidence_interval: Interval,
}

#[derive(Debug, Clone, Deserialize)]
struct Interval {
    lower_bound: f64,
    upper_bound: f64,
}

impl Measurement {
    fn read(directory: &Path) -> Result<Self, Error> {
        Ok(Self {
            name: read_json(&directory.join("benchmark.json"))?,
            estimates: read_json(&directory.join("estimates.json"))?,
        })
    }

    fn median_ns(&self) -> f64 {
        self.estimates.median.point_estimate
    }

    /// Bytes or operations a nanosecond.
    fn rate(&self) -> Option<f64> {
        self.work().map(|(_, n)| n / self.median_ns())
    }

    /// Time over that of the quickest of its group.
    fn times_the_quickest(&self, all: &[Self]) -> f64 {
        let quickest = all
            .iter()
            .filter(|other| other.same_group(self))
            .map(Self::median_ns)
            .fold(f64::INFINITY, f64::min);
        self.median_ns() / quickest
    }

    /// Bytes (true) or operations of one iteration.
    fn work(&self) -> Option<(bool, f64)> {
        match self.name.throughput {
            Some(Throughput::Bytes(n)) => Some((true, n)),
            Some(Throughput::Elements(n)) => Some((false, n)),
            _ => None,
        }
    }

    /// Whether a ratio of the two says something: one group, one parameter, the same work.
    fn same_group(&self, other: &Self) -> bool {
        let of = |m: &Self| (m.name.group_id.clone(), m.name.value_str.clone(), m.work());
        of(self) == of(other)
    }
}

/// Floors of the machine: the rate of a matrix product \[Gflop/s\] and the bandwidth of a copy \[GB/s\], one core.
#[derive(Debug, Clone, Copy, Default)]
struct Floors {
    product: Option<f64>,
    copy: Option<f64>,
}

impl Floors {
    fn among(results: &[Measurement]) -> Self {
        let rate = |name: &str| {
            let of_name =
                |m: &&Measurement| m.name.group_id == "floor" && m.name.function_id.as_deref() == Some(name);
            results.iter().find(of_name).and_then(Measurement::rate)
        };
        Self {
            product: rate("matrix product"),
            copy: rate("copy"),
        }
    }

    /// Times the time that the floor would take for the work.
    fn ratio(&self, of: &Measurement) -> Option<f64> {
        let floor = match of.name.throughput {
            Some(Throughput::Bytes(_)) => self.copy,
            Some(Throughput::Elements(_)) => self.product,
            _ => None,
        };
        Some(floor? / of.rate()?)
    }
}

/// All measurements below a directory that are not older than `since`, in order of their names.
fn collect(directory: &Path, since: SystemTime) -> Result<Vec<Measurement>, Error> {
    let mut found = Vec::new();
    let mut open = vec![directory.to_owned()];
    while let Some(directory) = open.pop() {
        let Ok(entries) = std::fs::read_dir(&directory) else {
            continue;
        };
        for entry in entries {
            let path = entry.map_err(Error::file(&directory))?.path();
            if path.is_dir() && path.file_name().is_some_and(|name| name == "new") {
                let written = path.join("estimates.json").metadata().and_then(|m| m.modified());
                if written.is_ok_and(|time| time >= since) {
                    found.push(Measurement::read(&path)?);
                }
            } else if path.is_dir() {
                open.push(path);
            }
        }
    }
    let key = |m: &Measurement| {
        (
            m.name.group_id.clone(),
            m.name.value_str.clone(),
            m.name.function_id.clone(),
        )
    };
    found.sort_by_key(key);
    Ok(found)
}

fn table(results: &[Measurement]) -> Result<Table, Error> {
    let time = |name: &str| Column::new(name, "s", Format::Engineering(3));
    let mut table = Table::new(
        "Benches",
        [
            Column::text("group"),
            Column::text("parameter"),
            Column::text("function"),
            time("median"),
            time("95 % from"),
            time("95 % to"),
            Column::new("rate", "GB/s", Format::Significant(3)),
            Column::new("rate", "Gflop/s", Format::Significant(3)),
            Column::new("times the floor", "", Format::Significant(3)),
            Column::new("times the quickest of its group", "", Format::Fixed(2)),
        ],
    );
    let floors = Floors::among(results);
    for result in results {
        let interval = &result.estimates.median.confidence_interval;
        let rate = |bytes: bool| {
            let of_bytes = matches!(result.name.throughput, Some(Throughput::Bytes(_)));
            result.rate().filter(|_| bytes == of_bytes)
        };
        table.push([
            Cell::from(result.name.group_id.as_str()),
            result.name.value_str.as_deref().into(),
            result.name.function_id.as_deref().into(),
            (1e-9 * result.median_ns()).into(),
            (1e-9 * interval.lower_bound).into(),
            (1e-9 * interval.upper_bound).into(),
            rate(true).into(),
            rate(false).into(),
            floors.ratio(result).into(),
            result.times_the_quickest(results).into(),
        ])?;
    }
    Ok(table)
}

/// What the JSON file holds: a list of benches with their ratios, three digits of them.
fn ratios(results: &[Measurement]) -> serde_json::Value {
    let floors = Floors::among(results);
    let rounded = |value: f64| {
        let text = format!("{value:.2e}");
        text.parse::<f64>().unwrap_or(value)
    };
    results
        .iter()
        .filter(|result| result.name.group_id != "floor")
        .map(|result| {
            serde_json::json!({
                "group": result.name.group_id,
                "parameter": result.name.value_str,
                "function": result.name.function_id,
                "times_the_floor": floors.ratio(result).map(rounded),
                "times_the_quickest_of_its_group": rounded(result.times_the_quickest(results)),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(directory: &Path, group: &str, function: &str, median: f64, throughput: &str) {
        let new = directory.join(group).join(function).join("new");
        std::fs::create_dir_all(&new).unwrap();
        let benchmark = format!(
            "{{\"group_id\":\"{group}\",\"function_id\":\"{function}\",\"value_str\":null,\"throughput\":{throughput},\"title\":\"\"}}"
        );
        std::fs::write(new.join("benchmark.json"), benchmark).unwrap();
        let estimates = format!(
            "{{\"median\":{{\"confidence_interval\":{{\"confidence_level\":0.95,\"lower_bound\":1.0,\"upper_bound\":2.0}},\
             \"point_estimate\":{median},\"standard_error\":0.1}}}}"
        );
        std::fs::write(new.join("estimates.json"), estimates).unwrap();
    }

    #[test]
    fn val_ratios_and_throughput() {
        let directory = tempfile::tempdir().unwrap();
        write(directory.path(), "a", "slow", 4e6, "{\"Bytes\":1000000}");
        write(directory.path(), "a", "quick", 1e6, "{\"Bytes\":1000000}");
        write(directory.path(), "b", "alone", 5.0, "{\"Elements\":3}");
        write(directory.path(), "floor", "copy", 1e8, "{\"Bytes\":1000000000}");
        write(
            directory.path(),
            "floor",
            "matrix product",
            1e8,
            "{\"Elements\":3000000000}",
        );
        let results = collect(directory.path(), SystemTime::UNIX_EPOCH).unwrap();
        let csv = table(&results).unwrap().to_csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines[1], "a,,quick,0.001,1e-9,2e-9,1,,10,1");
        assert_eq!(lines[2], "a,,slow,0.004,1e-9,2e-9,0.25,,40,4");
        assert_eq!(lines[3], "b,,alone,5e-9,1e-9,2e-9,,0.6,50,1");
        assert_eq!(lines[4], "floor,,copy,0.1,1e-9,2e-9,10,,1,1");
        assert_eq!(lines[5], "floor,,matrix product,0.1,1e-9,2e-9,,30,1,1");
        // The file holds no times, and no floors.
        let text = ratios(&results).to_string();
        assert_eq!(ratios(&results).as_array().unwrap().len(), 3);
        assert!(
            text.contains("\"times_the_floor\":40.0") && !text.contains("0.004"),
            "{text}"
        );
        assert!(
            collect(
                directory.path(),
                SystemTime::now() + std::time::Duration::from_secs(60)
            )
            .unwrap()
            .is_empty()
        );
    }
}
