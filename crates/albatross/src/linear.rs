//! Linear models as files: the JSON of an identified model or of a state space.

use crate::Error;
use albatross_lti::StateSpace;
use albatross_sysid::Model;
use albatross_sysid::estimate::InitialCondition;
use serde_json::Value;

/// A linear model in either form.
#[derive(Debug, Clone)]
pub enum LinearModel {
    /// A sum of fractions, as identification finds it.
    Identified(Model),
    /// Matrices, as linearisation gives them.
    StateSpace(StateSpace),
}

/// What a file of a linear model holds.
#[derive(Debug, Clone)]
pub struct LinearFile {
    /// The model.
    pub model: LinearModel,
    /// Whether its records began at an unknown state, if the file says so.
    pub initial: Option<InitialCondition>,
}

/// Reads `model.json` or the result of `identify --json`, `state_space.json` or the result of `linearize --json`; `file`
/// is for messages.
///
/// # Errors
/// [`Error::Table`] for text that is neither, for lists of the wrong lengths, more zeros than poles and a negative delay.
pub fn parse(text: &str, file: &str) -> Result<LinearFile, Error> {
    let malformed = |line: usize, message: String| Error::Table {
        file: file.to_owned(),
        line,
        message,
        expected: "the JSON of `identify` or of a state space, as docs/FORMATS.md describes".into(),
    };
    let value: Value = serde_json::from_str(text).map_err(|e| malformed(e.line(), e.to_string()))?;
    let initial = match value.get("initial_condition").and_then(Value::as_str) {
        Some("estimate") => Some(InitialCondition::Estimate),
        Some("zero") => Some(InitialCondition::Zero),
        _ => None,
    };
    let has = |v: &Value, key: &str| v.get(key).is_some();
    let model = if has(&value, "blocks") {
        LinearModel::Identified(identified(value).map_err(|e| malformed(0, e))?)
    } else if value.get("model").is_some_and(|m| has(m, "blocks")) {
        let inner = value.get("model").cloned().unwrap_or_default();
        LinearModel::Identified(identified(inner).map_err(|e| malformed(0, e))?)
    } else if ["a", "b", "c", "d"].iter().all(|key| has(&value, key)) {
        LinearModel::StateSpace(serde_json::from_value(value).map_err(|e| malformed(0, e.to_string()))?)
    } else {
        let keys: Vec<&str> = value
            .as_object()
            .into_iter()
            .flat_map(|map| map.keys().map(String::as_str).take(8))
            .collect();
        let found = if keys.is_empty() {
            "no object".to_owned()
        } else {
            format!("an object with the keys {}", keys.join(", "))
        };
        return Err(malformed(0, found));
    };
    Ok(LinearFile { model, initial })
}

/// A model whose lists have the lengths that its order asks for, and which is proper and causal.
fn identified(value: Value) -> Result<Model, String> {
    let model: Model = serde_json::from_value(value).map_err(|e| e.to_string())?;
    let (order, outputs) = (model.order(), model.outputs.len());
    let fits = model.coefficients.len() == outputs
        && model.direct.len() == outputs
        && model.coefficients.iter().all(|c| c.len() == order);
    if !(fits && outputs > 0 && order > 0) {
        return Err(format!(
            "a model with {order} poles and {outputs} outputs, but {} lists of coefficients of lengths {:?}",
            model.coefficients.len(),
            model.coefficients.iter().map(Vec::len).collect::<Vec<_>>()
        ));
    }
    if model.zeros > order {
        return Err(format!("a model with {order} poles and {} zeros", model.zeros));
    }
    if model.delay < 0.0 {
        return Err(format!("a model with a delay of {} s", model.delay));
    }
    Ok(model)
}
