//! Named values: what a result is before it becomes bytes.

use albatross_lti::Signal;
use albatross_numerics::{C64, Mat};

/// A value of a record.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Scalar(f64),
    /// Numbers in a column.
    Column(Vec<f64>),
    /// Complex numbers in a column.
    ComplexColumn(Vec<C64>),
    /// A matrix.
    Matrix(Mat<f64>),
    /// A text.
    Text(String),
    /// A list of texts.
    Texts(Vec<String>),
    /// Values that belong together.
    Group(Record),
}

/// Named values in order: the variables of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Names and values.
    pub fields: Vec<(String, Value)>,
}

impl Record {
    /// A record without values.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The record with one more value.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, value: Value) -> Self {
        self.fields.push((name.into(), value));
        self
    }

    /// The record with two more values, `{kind}Name` and `{kind}Unit`: the properties of MATLAB's model objects.
    #[must_use]
    pub fn with_signals(self, kind: &str, signals: &[Signal]) -> Self {
        let texts =
            |text: fn(&Signal) -> &String| Value::Texts(signals.iter().map(|s| text(s).clone()).collect());
        self.with(format!("{kind}Name"), texts(|s| &s.name))
            .with(format!("{kind}Unit"), texts(|s| &s.unit))
    }

    /// A value by name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.fields
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, value)| value)
    }
}
