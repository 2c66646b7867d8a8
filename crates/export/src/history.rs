//! Time histories.

use crate::Result;
use crate::error::fit;
use crate::record::{Record, Value};
use albatross_flight::TimeHistory;
use albatross_numerics::Mat;

/// `Time` (s), `Data` (samples x channels), `ChannelName`, `ChannelUnit`: inputs, then outputs.
///
/// # Errors
/// [`Error::Mismatch`](crate::Error::Mismatch) if a channel has more or fewer samples than there are times.
pub fn history(history: &TimeHistory) -> Result<Record> {
    refuse_ragged(history)?;
    let channels = history.series.len();
    let value = |i: usize, j: usize| {
        let series = history.series.get(j);
        series.and_then(|s| s.get(i)).copied().unwrap_or(f64::NAN)
    };
    Ok(Record::new()
        .with("Time", Value::Column(history.time.clone()))
        .with(
            "Data",
            Value::Matrix(Mat::from_fn(history.time.len(), channels, value)),
        )
        .with_signals("Channel", &history.channels))
}

/// One series a channel, one sample a time.
pub(crate) fn refuse_ragged(history: &TimeHistory) -> Result<()> {
    fit(
        "series of the history",
        history.series.len(),
        history.channels.len(),
    )?;
    for (channel, series) in history.channels.iter().zip(&history.series) {
        let what = format!("samples of `{} [{}]`", channel.name, channel.unit);
        fit(&what, series.len(), history.time.len())?;
    }
    Ok(())
}
