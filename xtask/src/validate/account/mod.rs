//! Where the difference to the reference comes from.
//!
//! Experiments on the corrected model, none of which is a tuning: the model is given, one after the other, what the
//! reference's own description says it lacks, and flown again.
//!
//! - **Derivatives with `d(alpha)/dt`.** The rigid aircraft's aerodynamics is quasi-steady in Albatross as in the paper;
//!   the reference's low-frequency `CL_alphadot` and `Cm_alphadot` are its first unsteady term.
//! - **Static aeroelastic derivatives.** With the elastic motion in equilibrium, the flexible aircraft has derivatives
//!   of its own. What the model's lack to the reference's is the joint effect of modes beyond the twentieth and of
//!   coupling between wing and tail that strip theory does not have.
//! - **Lift between strips**, which is an option of the program.

mod linear;
mod static_derivatives;

use super::reference::{MANOEUVRES, QUANTITIES};
use super::solved::Solved;
use super::study::{CORRECTED, Flight, STEP, Study, Variant};
use super::tables::Named;
use crate::error::Error;
use albatross::analysis;
use albatross::case::ModeChoice;
use albatross::lti::Mode;
use albatross::numerics::C64;
use albatross::report::{Cell, Column, Format, Table};
use albatross::{Inputs, Model};
use linear::{EVERY, LinearModel};
use static_derivatives::{elevator_rate_table, static_table};

/// Position of the variant with lagged elevator.
const LAGGED: usize = 2;

/// Elastic modes that the f06 of the case holds.
const MODES_IN_FILE: usize = 24;

/// One experiment.
pub(crate) struct Experiment {
    pub(crate) name: String,
    /// Short period of the flexible aircraft.
    pub(crate) short_period: Option<Mode>,
    /// Fits by manoeuvre and output.
    pub(crate) fits: Vec<Vec<f64>>,
}

/// The account: tables and the experiments behind the second.
pub(crate) struct Account {
    pub(crate) tables: Vec<Named>,
    pub(crate) experiments: Vec<Experiment>,
}

/// Runs the experiments.
pub(crate) fn run(study: &Study, solved: &Solved) -> Result<Account, Error> {
    let experiments = experiments(study, solved)?;
    let tables = vec![
        Named::new("account_static_derivatives", static_table(study)?),
        Named::new("account_elevator_rate", elevator_rate_table(study)?),
        Named::new("account_experiments", experiment_table(study, &experiments)?),
    ];
    Ok(Account { tables, experiments })
}

/// Names of the experiments that the page refers to.
pub(crate) const AS_IS: &str = "corrected";
pub(crate) const LINEAR: &str = "corrected, linear";
pub(crate) const RATE: &str = "corrected, linear, with the reference's α̇ derivatives";
pub(crate) const STATIC: &str = "corrected, linear, with the reference's static aeroelastic derivatives";
pub(crate) const BOTH: &str = "corrected, linear, with both";
pub(crate) const LAGGED_AS_IS: &str = "corrected, lagged elevator";
pub(crate) const LAGGED_BOTH: &str = "corrected, lagged elevator, linear, with both";
pub(crate) const ALL_MODES: &str = "corrected, all 24 modes of the f06";
pub(crate) const OWN_TAIL: &str = "corrected, tail strips without the wing's downwash";
pub(crate) const LAGGED_OWN_TAIL: &str =
    "corrected, lagged elevator, tail strips without the wing's downwash";

pub(crate) const BETWEEN: &str = "corrected, lift between strips";
pub(crate) const LAGGED_BETWEEN: &str = "corrected, lagged elevator, lift between strips";

fn experiments(study: &Study, solved: &Solved) -> Result<Vec<Experiment>, Error> {
    let reference = &study.reference;
    let corrected = study.variant(CORRECTED)?;
    let lagged = study.variant(LAGGED)?;
    let short_period = short_period(study)?;
    let linear = |name: &str, model: &LinearModel| -> Result<Experiment, Error> {
        Ok(Experiment {
            name: name.to_owned(),
            short_period: Some(model.mode_near(short_period)?),
            fits: model.fits(reference)?,
        })
    };
    let plain = LinearModel::of(corrected)?;
    let relieved = plain.with_static_derivatives(corrected, reference)?;
    let lagged_relieved = LinearModel::of(lagged)?.with_static_derivatives(lagged, reference)?;
    let as_is = |name: &str, variant: &Variant, model: &LinearModel| -> Result<Experiment, Error> {
        Ok(Experiment {
            name: name.to_owned(),
            short_period: Some(model.mode_near(short_period)?),
            fits: variant.flights.iter().map(|f| f.fits.clone()).collect(),
        })
    };
    Ok(vec![
        as_is(AS_IS, corrected, &plain)?,
        linear(LINEAR, &plain)?,
        linear(RATE, &plain.with_incidence_rate(corrected, reference)?)?,
        linear(STATIC, &relieved)?,
        linear(BOTH, &relieved.with_incidence_rate(corrected, reference)?)?,
        // The elevator's lag changes inputs only, not eigenvalues.
        as_is(LAGGED_AS_IS, lagged, &plain)?,
        linear(
            LAGGED_BOTH,
            &lagged_relieved.with_incidence_rate(lagged, reference)?,
        )?,
        variation(study, ALL_MODES, "corrected", |inputs| {
            inputs.case.structure.modes = ModeChoice::Lowest(MODES_IN_FILE);
        })?,
        variation(study, OWN_TAIL, "corrected", |inputs| own_tail(study, inputs))?,
        variation(study, LAGGED_OWN_TAIL, "corrected_lagged", |inputs| {
            own_tail(study, inputs)
        })?,
        variation(study, BETWEEN, "corrected", |inputs| {
            inputs.slopes_between = solved.slopes.clone();
        })?,
        variation(study, LAGGED_BETWEEN, "corrected_lagged", |inputs| {
            inputs.slopes_between = solved.slopes.clone();
        })?,
    ])
}

/// Downwash far behind an elliptically loaded wing, `d(epsilon)/d(alpha) = 2 CL_alpha / (pi aspect)` (Prandtl), with the
/// aircraft's own lift slope.
fn downwash_gradient(study: &Study) -> Option<f64> {
    let aircraft = &study.variants.get(CORRECTED)?.model.aircraft;
    let aspect = aircraft.reference.span.powi(2) / aircraft.reference.area;
    Some(2.0 * aircraft.rigid.lift.alpha / (std::f64::consts::PI * aspect))
}

fn own_tail(study: &Study, inputs: &mut Inputs) {
    for surface in &mut inputs.case.aerodynamics.surfaces {
        if surface.name == "HTP" {
            surface.downwash_gradient = downwash_gradient(study).unwrap_or(0.0);
        }
    }
}

/// The case with one option changed, flown with the non-linear model.
fn variation(
    study: &Study,
    name: &str,
    variant: &str,
    change: impl FnOnce(&mut Inputs),
) -> Result<Experiment, Error> {
    let mut inputs = study.inputs.clone();
    change(&mut inputs);
    let model = Model::build(&inputs, &inputs.case.variant(Some(variant))?)?;
    let trimmed = analysis::trimmed(&model)?;
    let flights = Flight::all(&trimmed, &model.point.control, &study.reference)?;
    Ok(Experiment {
        name: name.to_owned(),
        short_period: Some(LinearModel::new(&model, &trimmed)?.mode_near(short_period(study)?)?),
        fits: flights.into_iter().map(|f| f.fits).collect(),
    })
}

/// The reference's short period.
fn short_period(study: &Study) -> Result<C64, Error> {
    let mode = study
        .reference
        .modes
        .short_period()
        .ok_or_else(|| Error::Mismatch {
            what: "eigenvalues of the reference".into(),
            found: "no short period".into(),
            expected: "two symmetric oscillations below the elastic modes".into(),
        })?;
    Ok(C64::new(-mode.zeta, (1.0 - mode.zeta.powi(2)).sqrt()) * mode.omega_rad_s)
}

fn experiment_table(study: &Study, experiments: &[Experiment]) -> Result<Table, Error> {
    let mut heads = vec![
        Column::text("model"),
        Column::new("ω", "rad/s", Format::Fixed(3)).in_group("short period"),
        Column::new("ζ", "", Format::Fixed(3)).in_group("short period"),
        Column::text("doublet"),
    ];
    heads.extend(QUANTITIES.iter().map(|q| super::fits::percent_column(q.name)));
    let mut table = Table::new("Experiments on the difference to the reference", heads).with_caption(format!(
        "Fits as above. Linear models are flown with the exact step of {} ms. Without the wing's downwash: \
         dε/dα = 2 CLα/(π Λ) = {:.3} far behind an elliptic wing is taken out of the tail strips' lift slopes for their own \
         motion (downwash_gradient of the case file).",
        1e3 * STEP * EVERY as f64,
        downwash_gradient(study).unwrap_or(f64::NAN)
    ));
    if let Some(mode) = study.reference.modes.short_period() {
        let mut row = vec![Cell::from("reference"), mode.omega_rad_s.into(), mode.zeta.into()];
        row.resize(table.columns().len(), Cell::EMPTY);
        table.push(row)?;
    }
    for experiment in experiments {
        for ((_, doublet), fits) in MANOEUVRES.iter().zip(&experiment.fits) {
            let mut row = vec![Cell::from(experiment.name.as_str())];
            let mode = experiment.short_period.as_ref();
            row.push(mode.map(|m| m.omega_rad_s).into());
            row.push(mode.map(|m| m.damping_ratio).into());
            row.push((*doublet).into());
            row.extend(fits.iter().map(|f| Cell::from(*f)));
            table.push(row)?;
        }
    }
    Ok(table)
}
