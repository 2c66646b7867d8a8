//! NumPy's archives by a reader of our own.

use crate::support::{any_record, le_doubles, le_u16, le_u32, same_bits, system};
use albatross_export::{Error, Record, Value, history, npz, state_space};
use albatross_flight::TimeHistory;
use albatross_lti::Signal;
use proptest::prelude::*;

/// Names and contents of the files of an archive, by its directory, each checked against its own header and sum.
fn unpack(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let end = &bytes[bytes.len() - 22..];
    assert!(end.starts_with(b"PK\x05\x06"));
    let mut entry = &bytes[le_u32(&end[16..])..bytes.len() - 22];
    assert_eq!(entry.len(), le_u32(&end[12..]));
    let mut files = Vec::new();
    while !entry.is_empty() {
        assert!(entry.starts_with(b"PK\x01\x02"));
        let (length, name_length) = (le_u32(&entry[24..]), le_u16(&entry[28..]));
        let name = &entry[46..46 + name_length];
        let local = &bytes[le_u32(&entry[42..])..];
        assert!(local.starts_with(b"PK\x03\x04"));
        assert_eq!(local[4..30], entry[6..32], "both headers say the same");
        assert_eq!(&local[30..30 + name_length], name);
        let data = &local[30 + name_length..][..length];
        assert_eq!(crc(data) as usize, le_u32(&entry[16..]));
        files.push((String::from_utf8(name.to_vec()).unwrap(), data.to_vec()));
        entry = &entry[46 + name_length..];
    }
    assert_eq!(files.len(), le_u16(&end[10..]));
    files
}

/// CRC-32 bit by bit, by its definition.
fn crc(data: &[u8]) -> u32 {
    !data.iter().fold(!0_u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |s, _| {
            (s >> 1) ^ (0xedb8_8320 & (s & 1).wrapping_neg())
        })
    })
}

/// Kind, shape and data of an array.
fn array(bytes: &[u8]) -> (String, String, &[u8]) {
    assert!(bytes.starts_with(b"\x93NUMPY\x01\x00"));
    let length = le_u16(&bytes[8..]);
    assert_eq!((10 + length) % 64, 0);
    let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
    assert!(header.ends_with('\n') && header.contains("'fortran_order': True"));
    let between = |from: &str, to: &str| {
        let start = header.find(from).unwrap() + from.len();
        header[start..start + header[start..].find(to).unwrap()].to_owned()
    };
    (
        between("'descr': '", "'"),
        between("'shape': ", ", }"),
        &bytes[10 + length..],
    )
}

fn flat(prefix: &str, record: &Record) -> Vec<(String, Value)> {
    let of = |(name, value): &(String, Value)| match value {
        Value::Group(group) => flat(&format!("{prefix}{name}."), group),
        value => vec![(format!("{prefix}{name}.npy"), value.clone())],
    };
    record.fields.iter().flat_map(of).collect()
}

fn same(value: &Value, bytes: &[u8]) -> bool {
    let (kind, shape, data) = array(bytes);
    let numbers =
        |k: &str, s: String, list: &[f64]| kind == k && shape == s && same_bits(list, &le_doubles(data));
    let texts = |s: String, list: &[String]| {
        let width: usize = kind.strip_prefix("<U").unwrap().parse().unwrap();
        let codes: Vec<u32> = data
            .as_chunks::<4>()
            .0
            .iter()
            .map(|c| u32::from_le_bytes(*c))
            .collect();
        let text = |codes: &[u32]| -> String {
            let letters = codes.iter().take_while(|c| **c != 0);
            letters.map(|c| char::from_u32(*c).unwrap()).collect()
        };
        let found: Vec<String> = codes.chunks(width).map(text).collect();
        shape == s && found == list
    };
    match value {
        Value::Scalar(x) => numbers("<f8", "()".into(), &[*x]),
        Value::Column(list) => numbers("<f8", format!("({},)", list.len()), list),
        Value::ComplexColumn(list) => {
            let parts: Vec<f64> = list.iter().flat_map(|z| [z.re, z.im]).collect();
            numbers("<c16", format!("({},)", list.len()), &parts)
        }
        Value::Matrix(m) => {
            let list: Vec<f64> = (0..m.ncols())
                .flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)]))
                .collect();
            numbers("<f8", format!("({}, {})", m.nrows(), m.ncols()), &list)
        }
        Value::Text(text) => texts("()".into(), std::slice::from_ref(text)),
        Value::Texts(list) => texts(format!("({},)", list.len()), list),
        Value::Group(_) => false,
    }
}

fn reads_back(record: &Record) -> bool {
    let files = unpack(&npz::write(record).unwrap());
    let expected = flat("", record);
    files.len() == expected.len()
        && expected
            .iter()
            .zip(&files)
            .all(|((n, v), (m, bytes))| n == m && same(v, bytes))
}

proptest! {
    #[test]
    fn prop_any_record_reads_back_equal(record in any_record()) {
        prop_assert!(reads_back(&record));
    }
}

#[test]
fn val_a_system_reads_back_equal() {
    assert!(reads_back(&state_space(&system(), None).unwrap()));
    // The check value of CRC-32.
    assert_eq!(crc(b"123456789"), 0xcbf4_3926);
}

/// A text of a million letters among 1,100 short ones: 4.6 GB once all are as long.
#[test]
fn regress_texts_that_grow_beyond_the_format_are_refused() {
    let mut texts = vec![String::new(); 1100];
    texts[7] = "x".repeat(1 << 20);
    let record = Record::new().with("Names", Value::Texts(texts));
    let refused = npz::write(&record).unwrap_err();
    assert!(
        matches!(&refused, Error::TooLarge { what, found, .. } if what == "Names" && *found == 1100 << 22),
        "{refused}"
    );
}

#[test]
fn regress_ragged_histories_are_refused() {
    type Case = (&'static str, fn(&mut TimeHistory));
    let whole = TimeHistory {
        time: vec![0.0, 0.1],
        channels: vec![Signal::new("elevator", "rad"), Signal::new("n_z", "-")],
        series: vec![vec![0.0; 2]; 2],
        final_state: Vec::new(),
        evaluations: 0,
    };
    assert!(history(&whole).is_ok());
    let cases: [Case; 3] = [
        ("samples of `n_z [-]`: found 1, expected 2", |h| {
            h.series[1].truncate(1)
        }),
        ("samples of `elevator [rad]`: found 3, expected 2", |h| {
            h.series[0].push(1.0)
        }),
        ("series of the history: found 1, expected 2", |h| {
            h.series.truncate(1)
        }),
    ];
    for (expected, alter) in cases {
        let mut ragged = whole.clone();
        alter(&mut ragged);
        assert_eq!(history(&ragged).unwrap_err().to_string(), expected);
    }
}
