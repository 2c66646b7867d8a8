//! `cargo xtask bench`: runs the benches and collects their results in one table, with ratios within each group.

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
    /// Write the results to a JSON file as well
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
    let table = table(&results)?;
    print!("{}", table.to_text());
    if let Some(path) = &options.json {
        let mut text = table.to_json().to_string();
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

    /// Whether a ratio of the two says something: one group, one parameter.
    fn same_group(&self, other: &Self) -> bool {
        (&self.name.group_id, &self.name.value_str) == (&other.name.group_id, &other.name.value_str)
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
            Column::new("throughput", "MB/s", Format::Significant(3)),
            Column::new("times the quickest of its group", "", Format::Fixed(2)),
        ],
    );
    for result in results {
        let quickest = results
            .iter()
            .filter(|other| other.same_group(result))
            .map(Measurement::median_ns)
            .fold(f64::INFINITY, f64::min);
        let interval = &result.estimates.median.confidence_interval;
        let bytes = match result.name.throughput {
            Some(Throughput::Bytes(bytes)) => Some(bytes),
            _ => None,
        };
        table.push([
            Cell::from(result.name.group_id.as_str()),
            result.name.value_str.as_deref().into(),
            result.name.function_id.as_deref().into(),
            (1e-9 * result.median_ns()).into(),
            (1e-9 * interval.lower_bound).into(),
            (1e-9 * interval.upper_bound).into(),
            // Bytes per ns are GB/s.
            bytes.map(|b| 1e3 * b / result.median_ns()).into(),
            (result.median_ns() / quickest).into(),
        ])?;
    }
    Ok(table)
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
        write(directory.path(), "a", "quick", 1e6, "null");
        write(directory.path(), "b", "alone", 5.0, "{\"Elements\":3}");
        let results = collect(directory.path(), SystemTime::UNIX_EPOCH).unwrap();
        let csv = table(&results).unwrap().to_csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines[1], "a,,quick,0.001,1e-9,2e-9,,1");
        assert_eq!(lines[2], "a,,slow,0.004,1e-9,2e-9,250,4");
        assert_eq!(lines[3], "b,,alone,5e-9,1e-9,2e-9,,1");
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
