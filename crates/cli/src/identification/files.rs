//! Results as files of a directory.

use super::identify::Identified;
use super::search::Searched;
use super::{figures, tables};
use crate::gathered::Gathered;
use crate::output::Failure;
use serde_json::Value;
use std::path::Path;

/// Writes all results of an identification, all or none.
pub(crate) fn write(
    out: &Path,
    found: &Identified,
    result: &Value,
    search: Option<&Searched>,
) -> Result<(), Failure> {
    let files = Gathered::beside(out)?;
    let estimate = &found.estimate;
    let model = &estimate.model;
    let data = &found.records.data;
    files.add_json("identify.json", result)?;
    files.add_json("model.json", model)?;
    files.add_json("state_space.json", &model.state_space()?)?;
    files.add(
        "fits.csv",
        &tables::fits(&model.outputs, &found.simulated, &found.training)?.to_csv(),
    )?;
    files.add("poles.csv", &tables::poles(estimate)?.to_csv())?;
    files.add("residuals.csv", &tables::residuals(&found.residuals)?.to_csv())?;
    let title = format!("{} poles, {} zeros", model.order(), model.zeros);
    files.add("fit.svg", &figures::fits(&title, data, &found.simulated)?)?;
    files.add("bode.svg", &figures::bode(found)?)?;
    files.add("poles.svg", &figures::poles(found)?)?;
    files.add(
        "residuals.svg",
        &figures::residuals("Correlation of the residuals", data.dt(), &found.residuals)?,
    )?;
    if let Some(searched) = search {
        files.add("search.csv", &searched.table()?.to_csv())?;
        files.add("search.svg", &searched.figure()?)?;
    }
    files.move_to(out)
}
