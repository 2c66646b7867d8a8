//! Time histories.

use crate::record::{Record, Value};
use albatross_flight::TimeHistory;
use albatross_numerics::Mat;

/// `Time` (s), `Data` (samples x channels), `ChannelName`, `ChannelUnit`: inputs, then outputs.
#[must_use]
pub fn history(history: &TimeHistory) -> Record {
    let channels = history.series.len();
    let value = |i: usize, j: usize| {
        let series = history.series.get(j);
        series.and_then(|s| s.get(i)).copied().unwrap_or(f64::NAN)
    };
    Record::new()
        .with("Time", Value::Column(history.time.clone()))
        .with(
            "Data",
            Value::Matrix(Mat::from_fn(history.time.len(), channels, value)),
        )
        .with_signals("Channel", &history.channels)
}
