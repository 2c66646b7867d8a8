//! Parquet read back by the reader of the same library.

use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::RowAccessor;
use albatross_export::{Error, parquet};
use albatross_flight::TimeHistory;
use albatross_lti::Signal;

fn history() -> TimeHistory {
    TimeHistory {
        time: vec![0.0, 0.1, 0.2],
        channels: vec![Signal::new("elevator", "rad"), Signal::new("n_z", "-")],
        series: vec![vec![0.0, 0.1 + 0.2, -0.0], vec![1.0, 1.0 / 3.0, f64::MAX]],
        final_state: Vec::new(),
        evaluations: 0,
    }
}

#[test]
fn val_a_history_reads_back_equal() {
    let history = history();
    let bytes = parquet::write(&history).unwrap();
    let path = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(path.path(), bytes).unwrap();
    let reader = SerializedFileReader::new(std::fs::File::open(path.path()).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    let names: Vec<&str> = schema.columns().iter().map(|c| c.name()).collect();
    assert_eq!(names, ["t [s]", "elevator [rad]", "n_z [-]"]);
    for (i, row) in reader.get_row_iter(None).unwrap().enumerate() {
        let row = row.unwrap();
        assert_eq!(row.get_double(0).unwrap(), history.time[i]);
        for (j, series) in history.series.iter().enumerate() {
            assert_eq!(row.get_double(j + 1).unwrap().to_bits(), series[i].to_bits());
        }
    }
}

#[test]
fn val_ragged_histories_are_refused() {
    let mut history = history();
    history.series[1].pop();
    let refused = parquet::write(&history).unwrap_err();
    assert!(
        matches!(
            refused,
            Error::Mismatch {
                found: 2,
                expected: 3,
                ..
            }
        ),
        "{refused}"
    );
    history.series.pop();
    assert!(parquet::write(&history).is_err());
}
