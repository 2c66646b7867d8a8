//! Neutral models: two JSON layouts by which any tool hands a model to Albatross.
//!
//! [`wing`] reads strips and modes of a clamped wing and returns its matrices, flutter and divergence;
//! [`aircraft`] reads a whole flexible aircraft and returns matrices, trims, eigenvalues, frequency response and time
//! histories. `docs/FORMATS.md` lists every key. Numbers are SI and radians; axes are those of `docs/CONVENTIONS.md`.

pub mod aircraft;
pub mod wing;

use albatross_numerics::{C64, Mat, ShortNumber, matrix};
use albatross_strip::{GeneralizedForces, StripShapes, forces::Downwash};
use serde_json::{Value, json};

/// What is wrong with a neutral model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NeutralError {
    /// Not JSON, or a key is missing or of the wrong type.
    #[error("{file}:{line}:{column}: {message}; the layout is described in docs/FORMATS.md")]
    Json {
        /// File.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column.
        column: usize,
        /// What was found and expected.
        message: String,
    },
    /// Arrays of different length.
    #[error("{file}: `{key}` has {found}, expected {expected}")]
    Length {
        /// File.
        file: String,
        /// Key.
        key: &'static str,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A value that cannot be used.
    #[error("{file}: `{key}` is {value}, expected {expected}", value = ShortNumber(*value))]
    Value {
        /// File.
        file: String,
        /// Key; entries of arrays as `key.row.column`, counted from 0.
        key: String,
        /// Value found.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// From the strip aerodynamics.
    #[error("{file}: {source}")]
    Strip {
        /// File.
        file: String,
        /// Cause.
        source: albatross_strip::Error,
    },
    /// From the flight mechanics.
    #[error("{file}: {source}")]
    Flight {
        /// File.
        file: String,
        /// Cause.
        source: albatross_flight::Error,
    },
    /// From the algebra.
    #[error("{file}: {source}")]
    Numerics {
        /// File.
        file: String,
        /// Cause.
        source: albatross_numerics::Error,
    },
    /// From linear systems.
    #[error("{file}: {source}")]
    Lti {
        /// File.
        file: String,
        /// Cause.
        source: albatross_lti::Error,
    },
}

/// Beyond it a number of a model in SI units is a mistake, and products of such numbers overflow.
const LARGEST: f64 = 1e30;

/// Parses JSON text; errors carry file and place.
fn parse(text: &str, file: &str) -> Result<Value, NeutralError> {
    let document: Value = serde_json::from_str(text).map_err(|e| NeutralError::Json {
        file: file.to_owned(),
        line: e.line(),
        column: e.column(),
        message: e.to_string(),
    })?;
    if let Some((mut way, value)) = too_large(&document) {
        way.reverse();
        return Err(NeutralError::Value {
            file: file.to_owned(),
            key: way.join("."),
            value,
            expected: "a number of at most 1e30 in size; check its exponent and unit",
        });
    }
    Ok(document)
}

/// The first number beyond [`LARGEST`] and the way to it, the innermost name first. Nesting is bounded by the parser.
fn too_large(value: &Value) -> Option<(Vec<String>, f64)> {
    let under = |v: &Value, name: &dyn Fn() -> String| {
        too_large(v).map(|(mut way, number)| {
            way.push(name());
            (way, number)
        })
    };
    match value {
        Value::Number(number) => number
            .as_f64()
            .filter(|v| v.abs() > LARGEST)
            .map(|v| (Vec::new(), v)),
        Value::Array(values) => values
            .iter()
            .enumerate()
            .find_map(|(i, v)| under(v, &|| i.to_string())),
        Value::Object(map) => map.iter().find_map(|(name, v)| under(v, &|| name.clone())),
        _ => None,
    }
}

/// The part of a document under `key`, if it is an object with that key; else the document itself.
fn unwrap_key(document: Value, key: &str) -> Value {
    match document {
        Value::Object(mut map) if map.get(key).is_some_and(Value::is_object) => {
            let rest = map.clone();
            let mut inner = map.remove(key).unwrap_or(Value::Null);
            // Keys beside the wrapped object (rho, speeds, runs) count as its own where it has none.
            if let Value::Object(inner) = &mut inner {
                for (name, value) in rest {
                    if name != key && !inner.contains_key(&name) {
                        inner.insert(name, value);
                    }
                }
            }
            inner
        }
        other => other,
    }
}

fn rows(a: &Mat<f64>) -> Value {
    json!(matrix::to_rows(a.as_ref()))
}

fn complex(values: &[C64]) -> Value {
    json!({
        "re": values.iter().map(|v| v.re).collect::<Vec<_>>(),
        "im": values.iter().map(|v| v.im).collect::<Vec<_>>(),
    })
}

fn generalized_forces(q: &GeneralizedForces, w: &Downwash) -> Value {
    json!({
        "eta_etadd_NC": rows(&q.eta_etadd_nc),
        "eta_etad_NC": rows(&q.eta_etad_nc),
        "eta_etad_C": rows(&q.eta_etad_c),
        "eta_eta_NC": rows(&q.eta_eta_nc),
        "eta_eta_C": rows(&q.eta_eta_c),
        "eta_lambda_C": rows(&q.eta_lambda_c),
        "w_eta": rows(&w.w_eta),
        "w_etad": rows(&w.w_etad),
    })
}

/// A rectangular matrix from JSON rows.
fn table(
    rows: &[Vec<f64>],
    key: &'static str,
    shape: (usize, usize),
    file: &str,
) -> Result<Mat<f64>, NeutralError> {
    let bad = rows.iter().find(|r| r.len() != shape.1);
    if rows.len() != shape.0 || bad.is_some() {
        return Err(NeutralError::Length {
            file: file.to_owned(),
            key,
            found: format!(
                "{} rows of {}",
                rows.len(),
                bad.or(rows.first()).map_or(0, Vec::len)
            ),
            expected: format!("{} rows of {}", shape.0, shape.1),
        });
    }
    matrix::from_rows(rows).map_err(|source| NeutralError::Numerics {
        file: file.to_owned(),
        source,
    })
}

fn length(found: usize, key: &'static str, expected: usize, file: &str) -> Result<(), NeutralError> {
    if found == expected {
        return Ok(());
    }
    Err(NeutralError::Length {
        file: file.to_owned(),
        key,
        found: format!("{found} values"),
        expected: format!("{expected} values"),
    })
}

fn shapes(
    phi: &[Vec<f64>],
    gamma: &[Vec<f64>],
    n_strips: usize,
    n_modes: usize,
    file: &str,
) -> Result<StripShapes, NeutralError> {
    let phi = table(phi, "phi", (n_strips, n_modes), file)?;
    let gamma = table(gamma, "gamma", (n_strips, n_modes), file)?;
    StripShapes::try_new(phi, gamma).map_err(|source| NeutralError::Strip {
        file: file.to_owned(),
        source,
    })
}

/// Strips from parallel arrays.
struct StripArrays<'a> {
    y: &'a [f64],
    width: &'a [f64],
    chord: &'a [f64],
    x_ac: &'a [f64],
    x_lra: &'a [f64],
    cl_alpha: &'a [f64],
}

impl StripArrays<'_> {
    fn strips(&self, file: &str) -> Result<Vec<albatross_strip::Strip>, NeutralError> {
        let n = self.y.len();
        for (key, array) in [
            ("dy", self.width),
            ("c", self.chord),
            ("x_ac", self.x_ac),
            ("x_lra", self.x_lra),
            ("cl_alpha", self.cl_alpha),
        ] {
            length(array.len(), key, n, file)?;
        }
        let columns = self
            .y
            .iter()
            .zip(self.width)
            .zip(self.chord)
            .zip(self.x_ac)
            .zip(self.x_lra)
            .zip(self.cl_alpha);
        Ok(columns
            .map(
                |(((((&y, &width), &chord), &x_ac), &x_lra), &cl_alpha)| albatross_strip::Strip {
                    y,
                    z: 0.0,
                    width,
                    chord,
                    x_ac,
                    x_lra,
                    cl_alpha,
                    dihedral_rad: 0.0,
                },
            )
            .collect())
    }
}
