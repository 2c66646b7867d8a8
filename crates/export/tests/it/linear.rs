//! The linear model as a table, and its operating point.

use crate::support::system;
use albatross_export::{Error, OperatingPoint, Value, state_space, state_space_table};

#[test]
fn val_the_table_reads_back_equal() {
    let system = system();
    let text = state_space_table(&system).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    assert_eq!(
        header,
        [
            "row",
            "name",
            "unit",
            "state eta, first [-]",
            "state eta \"rate\" [1/s]",
            "input elevator [rad]",
            "input thrust [N]"
        ]
    );
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let beginnings: Vec<_> = rows.iter().map(|r| (&r[0], &r[1], &r[2])).collect();
    assert_eq!(
        beginnings,
        [
            ("derivative", "eta, first", "-"),
            ("derivative", "eta \"rate\"", "1/s"),
            ("output", "n_z", "-")
        ]
    );
    for (i, row) in rows.iter().enumerate() {
        for j in 0..4 {
            let expected = match (i < 2, j < 2) {
                (true, true) => system.a[(i, j)],
                (true, false) => system.b[(i, j - 2)],
                (false, true) => system.c[(i - 2, j)],
                (false, false) => system.d[(i - 2, j - 2)],
            };
            assert_eq!(row[3 + j].parse::<f64>().unwrap().to_bits(), expected.to_bits());
        }
    }
}

#[test]
fn val_an_operating_point_must_fit() {
    let mut about = OperatingPoint {
        states: vec![1.0, 2.0],
        inputs: vec![0.1, 3e4],
        outputs: vec![1.0],
    };
    let record = state_space(&system(), Some(&about)).unwrap();
    let Some(Value::Group(trim)) = record.get("Trim") else {
        panic!("no group")
    };
    assert_eq!(trim.get("u"), Some(&Value::Column(vec![0.1, 3e4])));
    about.inputs.pop();
    let refused = state_space(&system(), Some(&about)).unwrap_err();
    assert!(matches!(
        refused,
        Error::Mismatch {
            found: 1,
            expected: 2,
            ..
        }
    ));
}
