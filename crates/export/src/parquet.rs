//! Time histories as Parquet, read by pandas, Polars, DuckDB, MATLAB.

use crate::Result;
use albatross_flight::TimeHistory;
use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::sync::Arc;

/// One column of doubles a channel, named as in CSV: `t [s]`, `elevator [rad]`. Uncompressed.
///
/// # Errors
/// [`Error::Mismatch`](crate::Error::Mismatch) if a channel has more or fewer samples than there are times;
/// [`Error::Parquet`](crate::Error::Parquet).
pub fn write(history: &TimeHistory) -> Result<Vec<u8>> {
    crate::history::refuse_ragged(history)?;
    let names = history
        .channels
        .iter()
        .map(|c| format!("{} [{}]", c.name, c.unit));
    let names: Vec<String> = std::iter::once("t [s]".to_owned()).chain(names).collect();
    let columns: Vec<&[f64]> = std::iter::once(&history.time)
        .chain(&history.series)
        .map(Vec::as_slice)
        .collect();
    let field = |name: &String| {
        let field =
            Type::primitive_type_builder(name, Physical::DOUBLE).with_repetition(Repetition::REQUIRED);
        Ok(Arc::new(field.build()?))
    };
    let fields = names.iter().map(field).collect::<Result<Vec<_>>>()?;
    let schema = Type::group_type_builder("history").with_fields(fields).build()?;
    // Samples hardly repeat.
    let properties = WriterProperties::builder().set_dictionary_enabled(false).build();
    let mut file = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for values in columns {
        if let Some(mut column) = group.next_column()? {
            column.typed::<DoubleType>().write_batch(values, None, None)?;
            column.close()?;
        }
    }
    group.close()?;
    Ok(file.into_inner()?)
}
