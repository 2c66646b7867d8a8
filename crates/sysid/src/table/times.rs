//! The sample time from a column of times.
//!
//! Times are seldom exact: they are printed with few decimals, or kept in single precision. Of both the error is known,
//! so that it can be told from times that really are not uniform, such as gaps and jitter of a recorder.

use super::{Column, Columns, Table, fault};
use crate::{Error, Result};

/// Names of columns of times, in small letters.
const NAMES: [&str; 3] = ["t", "time", "zeit"];

/// Deviation from uniform times that is accepted besides the resolution of the times, in sample times.
const JITTER: f64 = 1e-3;

impl Table {
    /// Sample time \[s\] from the column of times, else the one given.
    pub(super) fn sample_time(&self, columns: &Columns) -> Result<f64> {
        let given = columns.sample_time;
        if let Some(dt) = given.filter(|dt| !(dt.is_finite() && *dt > 0.0)) {
            return Err(Error::Domain {
                what: "the sample time [s]",
                value: dt,
                expected: "a positive number",
            });
        }
        let column = match &columns.time {
            Some(name) => Some(self.column(name)?),
            None => match self.time_column() {
                Some(column) => Some(self.column(&column.header)?),
                None => None,
            },
        };
        match (column, given) {
            (Some(column), None) => self.uniform_step(column),
            (Some(column), Some(dt)) => {
                let found = self.uniform_step(column)?;
                if (found - dt).abs() > JITTER * dt {
                    return Err(fault(
                        &self.file,
                        self.header_line,
                        format!("a sample time of {found} s in column {}", column.header),
                        format!("{dt} s as given: leave it away, or remove the column"),
                    ));
                }
                Ok(dt)
            }
            (None, Some(dt)) => Ok(dt),
            (None, None) => Err(fault(
                &self.file,
                self.header_line,
                format!("no column of times among {}", super::headers(self.columns.iter())),
                "one called t, time, t_s or time [s]: name it (--column-time), or give the sample time",
            )),
        }
    }

    /// The first column with a name and a unit of times.
    fn time_column(&self) -> Option<&Column> {
        let named = |c: &&Column| NAMES.contains(&c.name.to_lowercase().as_str());
        let timed = |c: &&Column| seconds(c.unit.as_deref()).is_some();
        self.columns.iter().filter(named).find(timed)
    }

    /// Slope of the times over the samples.
    fn uniform_step(&self, column: &Column) -> Result<f64> {
        let Some(unit) = seconds(column.unit.as_deref()) else {
            return Err(fault(
                &self.file,
                self.header_line,
                format!("times in {}", column.unit.as_deref().unwrap_or_default()),
                "s, ms, us, min or h: convert them or name another column of times",
            ));
        };
        let times = &column.values;
        let largest = times.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let resolution = resolution(column, largest);
        let step = slope(times);
        let deviations = || times.iter().enumerate().map(|(k, t)| t - k as f64 * step);
        let spread = deviations().fold(f64::MIN, f64::max) - deviations().fold(f64::MAX, f64::min);
        // Beyond half a step a lost sample could not be told from a rounded time.
        let allowed = 2.0 * JITTER * step + resolution.min(0.5 * step);
        let uniform = step > 0.0 && spread <= allowed;
        if !uniform {
            return Err(self.not_uniform(column, resolution));
        }
        Ok(unit * plain(step, resolution / times.len() as f64))
    }

    /// Points to the step that differs most from the median step.
    fn not_uniform(&self, column: &Column, resolution: f64) -> Error {
        let next = column.values.iter().skip(1);
        let steps: Vec<f64> = column.values.iter().zip(next).map(|(a, b)| b - a).collect();
        let mut sorted = steps.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let off = |i: &usize| steps.get(*i).map_or(0.0, |s| (s - median).abs());
        let worst = (0..steps.len())
            .max_by(|i, j| off(i).total_cmp(&off(j)))
            .unwrap_or(0);
        let step = steps.get(worst).copied().unwrap_or(0.0);
        let line = self.lines.get(worst + 1).copied().unwrap_or(0);
        // Times rounded too coarsely differ everywhere, those with gaps at few places.
        let often = steps
            .iter()
            .filter(|s| (*s - median).abs() > 0.1 * resolution)
            .count()
            > steps.len() / 20;
        let cure = if often && resolution > 0.5 * slope(&column.values).abs() {
            "uniform times: they are printed too coarsely, write more decimals, or remove the column and give the \
             sample time"
        } else if median > 0.0 {
            "uniform times: resample the record to a constant step by interpolation, or cut it at the gap"
        } else {
            "times that increase: sort the rows and remove those that occur twice"
        };
        fault(
            &self.file,
            line,
            format!(
                "a step of {} in column {}, the median step is {}",
                rounded(step),
                column.header,
                rounded(median)
            ),
            cure,
        )
    }
}

/// Seconds per unit of time; `None` for another unit. Times without unit are seconds.
fn seconds(unit: Option<&str>) -> Option<f64> {
    let Some(unit) = unit else { return Some(1.0) };
    Some(match unit.to_lowercase().as_str() {
        "s" | "sec" | "seconds" | "second" | "sek" => 1.0,
        "ms" => 1e-3,
        "us" | "µs" | "μs" => 1e-6,
        "ns" => 1e-9,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return None,
    })
}

/// Distance of neighbouring times that can be written, or kept in single precision.
fn resolution(column: &Column, largest: f64) -> f64 {
    let magnitude = if largest > 0.0 {
        largest.log10().floor()
    } else {
        0.0
    };
    let printed = 10_f64.powi(column.printed.decimals.saturating_neg());
    let digits = 10_f64.powf(magnitude + 1.0 - f64::from(column.printed.significant));
    let single = f64::from(f32::EPSILON) * largest;
    printed.max(digits).max(single)
}

/// Least squares, which rounding of the times disturbs least.
fn slope(times: &[f64]) -> f64 {
    let n = times.len() as f64;
    let (middle, first) = (0.5 * (n - 1.0), times.first().copied().unwrap_or(0.0));
    let moment: f64 = times
        .iter()
        .enumerate()
        .map(|(k, t)| (k as f64 - middle) * (t - first))
        .sum();
    moment / (n * (n * n - 1.0) / 12.0)
}

/// A round step, or the step of a whole rate, if the times do not tell it from `step`: records of one recorder then
/// have the same sample time.
fn plain(step: f64, uncertainty: f64) -> f64 {
    let near = |candidate: f64| {
        (candidate.is_finite() && (candidate - step).abs() <= uncertainty.max(4.0 * f64::EPSILON * step))
            .then_some(candidate)
    };
    let scale = 10_f64.powf(3.0 - step.log10().floor());
    near((step * scale).round() / scale)
        .or_else(|| near(1.0 / (1.0 / step).round()))
        .unwrap_or(step)
}

fn rounded(value: f64) -> String {
    // Six digits, without the noise of binary fractions.
    format!("{value:.5e}").parse::<f64>().unwrap_or(value).to_string()
}
