//! The model of each variant, built and trimmed: what the stages themselves refuse, and trims out of the ordinary.

use super::Findings;
use super::document::Document;
use crate::case::Case;
use crate::inputs::Inputs;
use crate::model::Model;
use std::path::Path;

/// Incidence and deflection beyond which coefficients are no longer linear \[deg\].
const LARGE_ALPHA_DEG: f64 = 12.0;
const LARGE_CONTROL_DEG: f64 = 20.0;

pub(super) fn models(document: &Document, case: Case, directory: &Path, found: &mut Findings) {
    let inputs = match Inputs::of_case(case, directory) {
        Ok(inputs) => inputs,
        Err(error) => return found.of_error(&error.to_string(), &document.file),
    };
    let mut variants = inputs.case.variants.clone();
    if variants.is_empty() {
        variants.extend(inputs.case.variant(None));
    }
    for (i, variant) in variants.iter().enumerate() {
        let place = document.at(&format!("variant.{i}.name"));
        let trimmed = Model::build(&inputs, variant).and_then(|model| {
            let (_, trim) = model.trim()?;
            Ok((model, trim))
        });
        let (model, trim) = match trimmed {
            Ok(both) => both,
            Err(error) => {
                found.of_error(&error.to_string(), &place);
                continue;
            }
        };
        let alpha = trim.alpha_rad.to_degrees();
        if alpha.abs() > LARGE_ALPHA_DEG {
            found.warning(
                &place,
                format!(
                    "variant `{}` trims at an incidence of {alpha:.2} deg",
                    variant.name
                ),
                "coefficients are linear: fly faster or lower, and check mass and reference area",
            );
        }
        for (name, value) in model.aircraft.controls.iter().zip(&trim.controls_rad) {
            let value = value.to_degrees();
            if value.abs() > LARGE_CONTROL_DEG {
                found.warning(
                    &place,
                    format!("variant `{}` trims with `{name}` at {value:.2} deg", variant.name),
                    "check the centre of gravity against the neutral point, and the incidence of the tail",
                );
            }
        }
        if trim.thrust < 0.0 {
            found.warning(
                &place,
                format!(
                    "variant `{}` trims with a thrust of {:.4e} N: it brakes",
                    variant.name, trim.thrust
                ),
                "check profile drag (CDp) and the flight-path angle",
            );
        }
    }
}
