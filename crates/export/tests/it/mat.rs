//! MAT-files by a reader of our own.

use crate::support::{any_record, le_doubles, le_u32, same_bits, system};
use albatross_export::{Error, Record, Value, mat, state_space};
use proptest::prelude::*;

/// An array as the file has it.
#[derive(Debug)]
enum Array {
    Numbers {
        size: (usize, usize),
        re: Vec<f64>,
        im: Option<Vec<f64>>,
    },
    Text(String),
    Cells(Vec<Array>),
    Struct(Vec<(String, Array)>),
}

/// Type and data of the element at the beginning, and what follows it.
fn element(bytes: &[u8]) -> (usize, &[u8], &[u8]) {
    let tag = le_u32(bytes);
    if tag >> 16 > 0 {
        return (tag & 0xffff, &bytes[4..4 + (tag >> 16)], &bytes[8..]);
    }
    let length = le_u32(&bytes[4..]);
    (
        tag,
        &bytes[8..8 + length],
        &bytes[8 + length.next_multiple_of(8)..],
    )
}

fn wanted(bytes: &[u8], kind: usize) -> (&[u8], &[u8]) {
    let (found, data, rest) = element(bytes);
    assert_eq!(found, kind);
    (data, rest)
}

fn array(bytes: &[u8]) -> ((String, Array), &[u8]) {
    let (body, after) = wanted(bytes, 14);
    let (flags, body) = wanted(body, 6);
    let (sizes, body) = wanted(body, 5);
    let (name, mut body) = wanted(body, 1);
    assert_eq!((flags.len(), sizes.len()), (8, 8));
    let size = (le_u32(sizes), le_u32(&sizes[4..]));
    let name = String::from_utf8(name.to_vec()).unwrap();
    let value = match flags[0] {
        6 => {
            let (re, rest) = wanted(body, 9);
            let im = (flags[1] & 8 != 0).then(|| le_doubles(wanted(rest, 9).0));
            Array::Numbers {
                size,
                re: le_doubles(re),
                im,
            }
        }
        4 => {
            let (units, _) = wanted(body, 17);
            assert_eq!(size, (usize::from(!units.is_empty()), units.len() / 2));
            let units: Vec<u16> = units
                .as_chunks::<2>()
                .0
                .iter()
                .map(|u| u16::from_le_bytes(*u))
                .collect();
            Array::Text(String::from_utf16(&units).unwrap())
        }
        1 => {
            assert_eq!(size.1, 1);
            let mut cells = Vec::new();
            for _ in 0..size.0 {
                let ((_, cell), rest) = array(body);
                cells.push(cell);
                body = rest;
            }
            assert!(body.is_empty());
            Array::Cells(cells)
        }
        2 => {
            assert_eq!(size, (1, 1));
            let (length, rest) = wanted(body, 5);
            let (names, rest) = wanted(rest, 1);
            body = rest;
            let mut fields = Vec::new();
            for name in names.chunks(le_u32(length)) {
                let end = name.iter().position(|c| *c == 0).unwrap();
                let ((_, value), rest) = array(body);
                fields.push((String::from_utf8(name[..end].to_vec()).unwrap(), value));
                body = rest;
            }
            assert!(body.is_empty());
            Array::Struct(fields)
        }
        class => panic!("class {class}"),
    };
    ((name, value), after)
}

fn read(bytes: &[u8]) -> Vec<(String, Array)> {
    assert_eq!(&bytes[124..128], b"\x00\x01IM");
    let mut rest = &bytes[128..];
    let mut all = Vec::new();
    while !rest.is_empty() {
        let (variable, after) = array(rest);
        all.push(variable);
        rest = after;
    }
    all
}

fn same(value: &Value, found: &Array) -> bool {
    let numbers = |size, re: &[f64], im: Option<&[f64]>| match found {
        Array::Numbers {
            size: s,
            re: r,
            im: i,
        } => {
            size == *s && same_bits(re, r) && im.is_none_or(|im| i.as_ref().is_some_and(|i| same_bits(im, i)))
        }
        _ => false,
    };
    match value {
        Value::Scalar(x) => numbers((1, 1), &[*x], None),
        Value::Column(list) => numbers((list.len(), 1), list, None),
        Value::ComplexColumn(list) => {
            let (re, im): (Vec<f64>, Vec<f64>) = list.iter().map(|z| (z.re, z.im)).unzip();
            numbers((list.len(), 1), &re, Some(&im))
        }
        Value::Matrix(m) => {
            let list: Vec<f64> = (0..m.ncols())
                .flat_map(|j| (0..m.nrows()).map(move |i| m[(i, j)]))
                .collect();
            numbers((m.nrows(), m.ncols()), &list, None)
        }
        Value::Text(text) => matches!(found, Array::Text(t) if t == text),
        Value::Texts(list) => match found {
            Array::Cells(cells) => {
                cells.len() == list.len()
                    && list
                        .iter()
                        .zip(cells)
                        .all(|(t, c)| matches!(c, Array::Text(u) if u == t))
            }
            _ => false,
        },
        Value::Group(record) => matches!(found, Array::Struct(fields) if same_record(record, fields)),
    }
}

fn same_record(record: &Record, found: &[(String, Array)]) -> bool {
    let pairs = record.fields.iter().zip(found);
    record.fields.len() == found.len() && pairs.into_iter().all(|((n, v), (m, w))| n == m && same(v, w))
}

proptest! {
    #[test]
    fn prop_any_record_reads_back_equal(record in any_record()) {
        let bytes = mat::write(&record).unwrap();
        prop_assert!(same_record(&record, &read(&bytes)));
    }
}

#[test]
fn val_a_system_reads_back_equal() {
    let record = state_space(&system(), None).unwrap();
    assert!(same_record(&record, &read(&mat::write(&record).unwrap())));
    let names: Vec<&str> = record.fields.iter().map(|(n, _)| n.as_str()).collect();
    assert_eq!(names[..6], ["A", "B", "C", "D", "StateName", "StateUnit"]);
}

/// The description's own example of a small element, and of the header.
#[test]
fn val_layout_is_that_of_the_description() {
    let bytes = mat::write(&Record::new().with("K", Value::Scalar(1.5))).unwrap();
    assert!(bytes.starts_with(b"MATLAB 5.0 MAT-file"));
    let body = &bytes[128..];
    let expected: [u8; 64] = [
        [14, 0, 0, 0, 56, 0, 0, 0],
        [6, 0, 0, 0, 8, 0, 0, 0],
        [6, 0, 0, 0, 0, 0, 0, 0],
        [5, 0, 0, 0, 8, 0, 0, 0],
        [1, 0, 0, 0, 1, 0, 0, 0],
        [1, 0, 1, 0, b'K', 0, 0, 0],
        [9, 0, 0, 0, 8, 0, 0, 0],
        1.5_f64.to_le_bytes(),
    ]
    .concat()
    .try_into()
    .unwrap();
    assert_eq!(body, expected);
}

#[test]
fn val_names_that_matlab_refuses() {
    for name in ["", "1a", "a b", "_a", "a.b", "é", &"a".repeat(32)] {
        let record = Record::new().with(name, Value::Scalar(0.0));
        let within = Record::new().with("G", Value::Group(record.clone()));
        for record in [record, within] {
            let refused = mat::write(&record).unwrap_err();
            assert!(matches!(refused, Error::Name { .. }), "{name}: {refused}");
        }
    }
}
