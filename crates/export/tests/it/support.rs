//! Records of every kind of value.

use albatross_export::{Record, Value};
use albatross_lti::{Signal, StateSpace};
use albatross_numerics::{C64, Mat};
use proptest::prelude::*;

/// Two states, two inputs, one output; numbers that no short text holds, names that need quotes in a table.
pub(crate) fn system() -> StateSpace {
    StateSpace::try_new(
        (
            Mat::from_fn(2, 2, |i, j| [[0.1 + 0.2, 1.0], [-1.0 / 3.0, -2e-300]][i][j]),
            Mat::from_fn(2, 2, |i, j| (i + 2 * j) as f64 / 7.0),
            Mat::from_fn(1, 2, |_, j| [std::f64::consts::PI, f64::MAX][j]),
            Mat::from_fn(1, 2, |_, j| [0.0, -0.0][j]),
        ),
        vec![Signal::new("eta, first", "-"), Signal::new("eta \"rate\"", "1/s")],
        vec![Signal::new("elevator", "rad"), Signal::new("thrust", "N")],
        vec![Signal::new("n_z", "-")],
    )
    .unwrap()
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("a payload of NaN is no number", |x| !x.is_nan()),
        Just(f64::INFINITY),
        Just(-0.0),
    ]
}

/// Also letters beyond one code unit of UTF-16; NumPy takes zeros at the end for padding.
fn text() -> impl Strategy<Value = String> {
    "[a-zA-Z0-9 _/°²αβ\u{1F6E9}]{0,12}"
}

fn plain() -> impl Strategy<Value = Value> {
    prop_oneof![
        number().prop_map(Value::Scalar),
        prop::collection::vec(number(), 0..6).prop_map(Value::Column),
        prop::collection::vec((number(), number()), 0..6)
            .prop_map(|list| Value::ComplexColumn(list.into_iter().map(|(x, y)| C64::new(x, y)).collect())),
        (0_usize..4, 0_usize..4)
            .prop_flat_map(|(m, n)| (Just(m), Just(n), prop::collection::vec(number(), m * n)))
            .prop_map(|(m, n, list)| Value::Matrix(Mat::from_fn(m, n, |i, j| list[i + m * j]))),
        text().prop_map(Value::Text),
        prop::collection::vec(text(), 0..5).prop_map(Value::Texts),
    ]
}

fn of_values(values: impl Strategy<Value = Value>) -> impl Strategy<Value = Record> {
    prop::collection::btree_map("[a-zA-Z][a-zA-Z0-9_]{0,30}", values, 0..5).prop_map(|map| Record {
        fields: map.into_iter().collect(),
    })
}

/// Any record with groups.
pub(crate) fn any_record() -> impl Strategy<Value = Record> {
    of_values(prop_oneof![3 => plain(), 1 => of_values(plain()).prop_map(Value::Group)])
}

pub(crate) fn le_u16(bytes: &[u8]) -> usize {
    u16::from_le_bytes(bytes[..2].try_into().unwrap()).into()
}

pub(crate) fn le_u32(bytes: &[u8]) -> usize {
    u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize
}

pub(crate) fn le_doubles(bytes: &[u8]) -> Vec<f64> {
    let (eights, rest) = bytes.as_chunks::<8>();
    assert!(rest.is_empty());
    eights.iter().map(|b| f64::from_le_bytes(*b)).collect()
}

/// Equal bit by bit: zero is not minus zero.
pub(crate) fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
}
