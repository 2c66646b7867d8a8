//! Transfer functions identified from the reference's histories.
//!
//! The four of the paper's Table 4, from the elevator to `a_z` at cockpit, last passenger and right wing tip and to `q`,
//! each by itself, from the three doublets together, at two orders: the paper's, and one searched on these histories.
//!
//! | module | subject |
//! |---|---|
//! | this one | data, estimation |
//! | [`search`] | the search of the orders, and what is kept of it |
//! | [`table4`], [`poles`], [`responses`] | tables |
//! | [`text`] | what the page says of it |

pub(crate) mod poles;
pub(crate) mod responses;
pub(crate) mod search;
mod table4;
pub(crate) mod text;

use super::reference::{MANOEUVRES, QUANTITIES, Quantity, Reference};
use super::study::{STEP, Study};
use super::tables::Named;
use crate::error::Error;
use albatross::lti::Signal;
use albatross::numerics::C64;
use albatross::sysid::{
    DataSet, Detrend, Estimate, Experiment, Intersample, Model, Options, PoleEstimate, from_trim,
    remove_trim, simulate_records,
};
use search::Kept;

/// An output of the paper's Table 4: the paper's code, and its position in [`QUANTITIES`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Target {
    pub(crate) code: &'static str,
    pub(crate) quantity: usize,
}

/// The outputs in the order of the paper's Table 4.
pub(crate) const TARGETS: [Target; 4] = [
    Target {
        code: "CP",
        quantity: 3,
    },
    Target {
        code: "LPAX",
        quantity: 4,
    },
    Target {
        code: "RWT",
        quantity: 5,
    },
    Target {
        code: "CG",
        quantity: 1,
    },
];

impl Target {
    /// The output of a code of the paper, which has two for the centre of gravity.
    pub(crate) fn of_code(code: &str) -> Option<usize> {
        let code = if code == "qCG" { "CG" } else { code };
        TARGETS.iter().position(|target| target.code == code)
    }

    /// Name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self.code {
            "CP" => "a_z, cockpit",
            "LPAX" => "a_z, last passenger",
            "RWT" => "a_z, right wing tip",
            _ => "q, centre of gravity",
        }
    }

    pub(crate) fn shown(self) -> Result<&'static Quantity, Error> {
        QUANTITIES.get(self.quantity).ok_or_else(|| Error::Mismatch {
            what: "quantities".into(),
            found: QUANTITIES.len().to_string(),
            expected: format!("more than {}", self.quantity),
        })
    }

    /// The three records of this output as deviations from trim in rad and SI units.
    pub(crate) fn data(self, reference: &Reference) -> Result<DataSet, Error> {
        let shown = self.shown()?;
        let experiments = MANOEUVRES
            .iter()
            .zip(&reference.histories)
            .map(|((name, _), history)| {
                let input = history.elevator_deg.iter().map(|v| v.to_radians()).collect();
                let series = history.series.get(self.quantity).map_or(&[][..], Vec::as_slice);
                let output = series.iter().map(|v| v / shown.scale).collect();
                let mut experiment = Experiment::new(*name, STEP, input, vec![output]);
                // Half a second of trim precedes every doublet.
                remove_trim(&mut experiment, Detrend::Auto);
                experiment
            })
            .collect();
        let unit = if shown.sensor == "q" { "rad/s" } else { "m/s^2" };
        Ok(DataSet::try_new(
            Signal::new("elevator", "rad"),
            vec![Signal::new(shown.sensor, unit)],
            experiments,
            // Three times continuously differentiable: a straight line between samples is as good as the signal.
            Intersample::Foh,
        )?)
    }
}

/// One identified transfer function.
pub(crate) struct Identified {
    pub(crate) poles: usize,
    pub(crate) zeros: usize,
    /// Fit to every history \[%\], in the order of [`MANOEUVRES`].
    pub(crate) fits: Vec<f64>,
    /// Poles with their standard deviations, modulus ascending; those of complex pairs with positive imaginary part.
    pub(crate) modes: Vec<PoleEstimate>,
    pub(crate) model: Model,
    /// Deviations from trim that it predicts, by history, SI.
    predicted: Vec<Vec<f64>>,
}

impl Identified {
    /// Estimates a transfer function from all histories together.
    fn run(data: &DataSet, poles: usize, zeros: usize) -> Result<Self, Error> {
        let found: Estimate = albatross::sysid::estimate(data, &Options::new(poles, zeros))?;
        let simulated = simulate_records(&found.model, data, found.initial_estimated)?;
        let first = |fits: &[Option<f64>]| fits.first().copied().flatten().unwrap_or(f64::NAN);
        Ok(Self {
            poles,
            zeros,
            fits: simulated.iter().map(|s| first(&s.fits)).collect(),
            predicted: simulated
                .into_iter()
                .map(|s| s.outputs.into_iter().next().unwrap_or_default())
                .collect(),
            modes: found.uncertainty.map(|u| u.modes).unwrap_or_default(),
            model: found.model,
        })
    }

    /// Mean of the fits \[%\].
    pub(crate) fn average(&self) -> f64 {
        self.fits.iter().sum::<f64>() / self.fits.len() as f64
    }

    /// The poles of [`Identified::modes`].
    pub(crate) fn poles(&self) -> Vec<C64> {
        self.modes.iter().map(|m| C64::new(m.re, m.im)).collect()
    }

    /// Values of the transfer function at circular frequencies \[rad/s\].
    pub(crate) fn response(&self, omega_rad_s: &[f64]) -> Result<Vec<C64>, Error> {
        Ok(self.model.frequency_response(0, omega_rad_s)?)
    }
}

/// The transfer functions of one output.
pub(crate) struct Output {
    pub(crate) target: Target,
    /// At the paper's order.
    pub(crate) paper: Identified,
    /// At the searched order.
    pub(crate) searched: Identified,
}

/// All that is identified.
pub(crate) struct Identification {
    /// In the order of [`TARGETS`].
    pub(crate) outputs: Vec<Output>,
    pub(crate) kept: Kept,
}

impl Identification {
    /// Estimates at the paper's orders and at those kept of the search, one output beside the other.
    pub(crate) fn run(study: &Study, kept: Kept) -> Result<Self, Error> {
        let outputs = std::thread::scope(|scope| {
            let started: Vec<_> = TARGETS
                .iter()
                .map(|target| scope.spawn(|| Output::run(study, &kept, *target)))
                .collect();
            let joined = started.into_iter().map(|thread| {
                thread
                    .join()
                    .unwrap_or_else(|_| Err(Error::Failed("an identification panicked".into())))
            });
            joined.collect::<Result<Vec<_>, _>>()
        })?;
        Ok(Self { outputs, kept })
    }

    /// The output that stands for a quantity of [`QUANTITIES`].
    pub(crate) fn of_quantity(&self, quantity: usize) -> Option<&Output> {
        self.outputs.iter().find(|o| o.target.quantity == quantity)
    }

    /// The tables.
    pub(crate) fn tables(&self, study: &Study) -> Result<Vec<Named>, Error> {
        let mut tables = vec![
            Named::iterated("table4_fits_of_identified", table4::fits(study, self)?),
            Named::new("table4_search", search::summary(&self.kept)?),
        ];
        tables.extend(poles::all(study, self)?);
        tables.extend(responses::all(study, self)?);
        Ok(tables)
    }
}

impl Output {
    fn run(study: &Study, kept: &Kept, target: Target) -> Result<Self, Error> {
        let data = target.data(&study.reference)?;
        let (poles, zeros) = paper_order(study, target)?;
        let order = kept.order(target)?;
        Ok(Self {
            target,
            paper: Identified::run(&data, poles, zeros)?,
            searched: Identified::run(&data, order.poles, order.zeros)?,
        })
    }

    /// History that the transfer function at the searched order predicts, in the unit shown, from the trim of the
    /// reference.
    pub(crate) fn history(&self, study: &Study, manoeuvre: usize) -> Result<Option<Vec<f64>>, Error> {
        let scale = self.target.shown()?.scale;
        let reference = study.reference.histories.get(manoeuvre);
        let series = reference.and_then(|h| h.series.get(self.target.quantity));
        let (Some(series), Some(predicted)) = (series, self.searched.predicted.get(manoeuvre)) else {
            return Ok(None);
        };
        let trim = series.first().copied().unwrap_or(0.0) - from_trim(series).first().copied().unwrap_or(0.0);
        Ok(Some(predicted.iter().map(|v| trim + v * scale).collect()))
    }
}

/// Poles and zeros of the paper for an output.
pub(crate) fn paper_order(study: &Study, target: Target) -> Result<(usize, usize), Error> {
    let rows = &study.paper.printed.table4.rows;
    let row = rows.iter().find(|r| {
        Target::of_code(&r.output)
            .and_then(|i| TARGETS.get(i))
            .map(|t| t.code)
            == Some(target.code)
    });
    let order = row.and_then(|r| Some((usize::try_from(r.poles).ok()?, usize::try_from(r.zeros).ok()?)));
    order.ok_or_else(|| Error::Mismatch {
        what: "rows of the paper's Table 4".into(),
        found: "none".into(),
        expected: format!("one for {}", target.name()),
    })
}
