//! The computation: every variant of the case trimmed, linearised and flown through the reference's manoeuvres.

use super::paper::Paper;
use super::reference::{Eigenvalue, History, MANOEUVRES, QUANTITIES, Reference};
use crate::error::Error;
use albatross::analysis::{self, AeroelasticMode, ModeTable, Trimmed};
use albatross::flight::signal::Signal;
use albatross::flight::{Fidelity, Manoeuvre, Method, TimeHistory, simulate};
use albatross::lti::Response;
use albatross::modal::Symmetry;
use albatross::sysid::{from_trim, nrmse_fit};
use albatross::{Inputs, Model};
use std::path::Path;
use std::time::Instant;

/// The variants of the case that are reported: name in the case, name shown.
pub(crate) const VARIANTS: [(&str, &str); 3] = [
    ("avl", "AVL only"),
    ("corrected", "corrected"),
    ("corrected_lagged", "corrected, lagged elevator"),
];

/// Position of the variant with AVL data alone.
pub(crate) const AVL: usize = 0;
/// Position of the corrected variant.
pub(crate) const CORRECTED: usize = 1;

/// Step of all simulations \[s\]: that of the reference's samples.
pub(crate) const STEP: f64 = 1e-3;

/// Everything that the report shows.
pub(crate) struct Study {
    pub(crate) paper: Paper,
    pub(crate) reference: Reference,
    pub(crate) inputs: Inputs,
    /// In the order of [`VARIANTS`].
    pub(crate) variants: Vec<Variant>,
    pub(crate) measured: Measured,
}

/// One variant of the model and its results.
pub(crate) struct Variant {
    /// Name shown.
    pub(crate) name: &'static str,
    pub(crate) model: Model,
    pub(crate) trimmed: Trimmed,
    /// Modes with unsteady and with quasi-steady aerodynamics; none for a variant that differs from another in its
    /// controls only, which are inputs.
    pub(crate) modes: Option<[ModeTable; 2]>,
    /// Response to the elevator.
    pub(crate) response: Response,
    /// In the order of [`MANOEUVRES`]; driven by the reference's elevator.
    pub(crate) flights: Vec<Flight>,
}

/// A simulated manoeuvre.
pub(crate) struct Flight {
    pub(crate) time: Vec<f64>,
    /// Elevator, trim included \[deg\].
    pub(crate) elevator_deg: Vec<f64>,
    /// In the order of [`QUANTITIES`], in the unit shown, trim included.
    pub(crate) series: Vec<Vec<f64>>,
    /// Fit of the deviations from trim to the reference's \[%\], in the order of [`QUANTITIES`].
    pub(crate) fits: Vec<f64>,
}

/// Times of the machine at hand.
#[derive(Debug, Clone, Default)]
pub(crate) struct Measured {
    /// Wall time of 5 s of the paper's manoeuvre by variant \[s\].
    pub(crate) five_seconds: Vec<f64>,
    /// States of the model.
    pub(crate) states: usize,
    /// Stages in order: name and wall time \[s\].
    pub(crate) stages: Vec<(String, f64)>,
    /// Wall time of all of them, some of which run side by side \[s\].
    pub(crate) all: f64,
}

impl Measured {
    pub(crate) fn stage(&mut self, name: impl Into<String>, since: Instant) {
        self.stage_of(name, since.elapsed().as_secs_f64());
    }

    /// A stage that took some seconds of wall time.
    pub(crate) fn stage_of(&mut self, name: impl Into<String>, seconds: f64) {
        let name = name.into();
        eprintln!("  {seconds:6.2} s  {name}");
        self.stages.push((name, seconds));
    }
}

impl Study {
    /// Runs the case of a workspace.
    pub(crate) fn run(root: &Path) -> Result<Self, Error> {
        let mut measured = Measured::default();
        let case_directory = root.join("fixtures/f25-like");
        let since = Instant::now();
        let inputs = Inputs::read(&case_directory.join("case.toml"))?;
        measured.stage("read the deck, the f06 and the AVL files", since);
        let since = Instant::now();
        let reference = Reference::read(&case_directory.join("reference"))?;
        let paper = Paper::read(&root.join("fixtures/paper"))?;
        measured.stage("read the reference and the paper's tables", since);

        let mut variants = Vec::new();
        for (index, (name, shown)) in VARIANTS.iter().enumerate() {
            let with_modes = index <= CORRECTED;
            let variant = Variant::run(&inputs, &reference, name, shown, with_modes, &mut measured)?;
            variants.push(variant);
        }
        for variant in &variants {
            let seconds = variant.time_five_seconds(&inputs)?;
            measured.five_seconds.push(seconds);
        }
        measured.states = variants
            .first()
            .map_or(0, |v| v.trimmed.equations.layout().n_states());
        Ok(Self {
            paper,
            reference,
            inputs,
            variants,
            measured,
        })
    }

    /// A variant by its position in [`VARIANTS`].
    pub(crate) fn variant(&self, index: usize) -> Result<&Variant, Error> {
        self.variants.get(index).ok_or_else(|| Error::Mismatch {
            what: "variants of the study".into(),
            found: self.variants.len().to_string(),
            expected: format!("at least {}", index + 1),
        })
    }

    /// The structural modes of one symmetry: ranks in the basis, from 0.
    fn family(&self, symmetry: Symmetry) -> Result<Vec<usize>, Error> {
        let modes = &self.variant(AVL)?.model.basis.modes;
        Ok((0..modes.len())
            .filter(|&k| modes.get(k).is_some_and(|m| m.symmetry == symmetry))
            .collect())
    }

    /// Elastic modes in the flow in the order of the structural modes: within each symmetry, the n-th frequency in
    /// the flow stands beside the n-th in vacuo. Two modes whose frequencies meet and part again, as the second and
    /// third of this aircraft do, exchange their shapes; a table by rank is the same on whichever side of the meeting
    /// a model is.
    pub(crate) fn ranked<'a>(&self, table: &'a ModeTable) -> Result<Vec<Option<&'a AeroelasticMode>>, Error> {
        let mut ranked = vec![None; table.elastic.len()];
        for symmetry in [Symmetry::Symmetric, Symmetry::Antisymmetric, Symmetry::Mixed] {
            let family = self.family(symmetry)?;
            let mut found: Vec<&AeroelasticMode> =
                family.iter().filter_map(|&k| table.elastic.get(k)).collect();
            found.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
            for (k, mode) in family.into_iter().zip(found) {
                if let Some(place) = ranked.get_mut(k) {
                    *place = Some(mode);
                }
            }
        }
        Ok(ranked)
    }

    /// The reference's elastic eigenvalues in the same order.
    pub(crate) fn ranked_reference(&self) -> Result<Vec<Option<&Eigenvalue>>, Error> {
        let mut ranked = vec![None; self.variant(AVL)?.model.basis.modes.len()];
        for symmetry in [Symmetry::Symmetric, Symmetry::Antisymmetric] {
            let found = self.reference.modes.elastic(symmetry == Symmetry::Symmetric);
            for (k, mode) in self.family(symmetry)?.into_iter().zip(found) {
                if let Some(place) = ranked.get_mut(k) {
                    *place = Some(mode);
                }
            }
        }
        Ok(ranked)
    }

    /// Modes of a variant with unsteady and with quasi-steady aerodynamics.
    pub(crate) fn modes(&self, index: usize) -> Result<&[ModeTable; 2], Error> {
        self.variant(index)?
            .modes
            .as_ref()
            .ok_or_else(|| Error::Mismatch {
                what: format!("modes of variant {index}"),
                found: "none".into(),
                expected: "a variant whose modes were followed".into(),
            })
    }
}

impl Variant {
    fn run(
        inputs: &Inputs,
        reference: &Reference,
        name: &str,
        shown: &'static str,
        with_modes: bool,
        measured: &mut Measured,
    ) -> Result<Self, Error> {
        let since = Instant::now();
        let model = Model::build(inputs, &inputs.case.variant(Some(name))?)?;
        let trimmed = analysis::trimmed(&model)?;
        measured.stage(format!("{name}: model, trim, linearisation"), since);

        let modes = if with_modes {
            let since = Instant::now();
            let quasi_steady = analysis::with_fidelity(&model, Fidelity::QuasiSteady)?;
            let tables = [
                analysis::mode_table_without_lags(&model, &trimmed)?,
                analysis::mode_table_without_lags(&model, &quasi_steady)?,
            ];
            measured.stage(format!("{name}: modes followed through the lags"), since);
            Some(tables)
        } else {
            None
        };

        let since = Instant::now();
        let response =
            analysis::frequency_response(&trimmed, &model.point.control, &inputs.case.bode.frequencies())?;
        measured.stage(format!("{name}: frequency response"), since);

        let since = Instant::now();
        let flights = Flight::all(&trimmed, &model.point.control, reference)?;
        measured.stage(format!("{name}: three manoeuvres, 20 s of flight"), since);
        Ok(Self {
            name: shown,
            model,
            trimmed,
            modes,
            response,
            flights,
        })
    }

    /// Wall time of 5 s of the case's first manoeuvre: the shorter of two runs, so that the first touch of the memory
    /// does not count.
    fn time_five_seconds(&self, inputs: &Inputs) -> Result<f64, Error> {
        let mut manoeuvre = inputs.case.manoeuvre(MANOEUVRES[0].0)?.clone();
        manoeuvre.end = inputs.case.manoeuvre(MANOEUVRES[1].0)?.end;
        let mut shortest = f64::INFINITY;
        for _ in 0..2 {
            let since = Instant::now();
            analysis::simulate_case(inputs, &self.trimmed, &manoeuvre)?;
            shortest = shortest.min(since.elapsed().as_secs_f64());
        }
        Ok(shortest)
    }
}

impl Flight {
    /// The reference's manoeuvres in the order of [`MANOEUVRES`], driven by its elevator.
    pub(crate) fn all(trimmed: &Trimmed, control: &str, reference: &Reference) -> Result<Vec<Self>, Error> {
        let fly = |history| Self::run(trimmed, control, history);
        reference.histories.iter().map(fly).collect()
    }

    fn run(trimmed: &Trimmed, control: &str, history: &History) -> Result<Self, Error> {
        let index = control_index(&trimmed.equations.aircraft().controls, control)?;
        let deflection = from_trim(&history.elevator_deg);
        let manoeuvre = Manoeuvre {
            dt: STEP,
            end: history.time.last().copied().unwrap_or(0.0),
            output_every: 1,
            method: Method::Rk4,
            inputs: vec![(
                index,
                Signal::Table {
                    time: history.time.clone(),
                    value: deflection.iter().map(|v| v.to_radians()).collect(),
                },
            )],
        };
        let flown = simulate(&trimmed.equations, &trimmed.trim, &manoeuvre)?;
        same_times(&flown.time, &history.time)?;
        let series = QUANTITIES
            .iter()
            .map(|q| Ok(channel(&flown, q.sensor)?.iter().map(|v| v * q.scale).collect()))
            .collect::<Result<Vec<Vec<f64>>, Error>>()?;
        let fits = series
            .iter()
            .zip(&history.series)
            .map(|(model, reference)| fit(reference, model))
            .collect();
        Ok(Self {
            time: flown.time.clone(),
            elevator_deg: channel(&flown, control)?.iter().map(|v| v.to_degrees()).collect(),
            series,
            fits,
        })
    }
}

/// NRMSE fit of the deviations from each one's own trim \[%\]; not a number for a constant reference.
pub(crate) fn fit(reference: &[f64], model: &[f64]) -> f64 {
    nrmse_fit(&from_trim(reference), &from_trim(model)).unwrap_or(f64::NAN)
}

/// Position of a control among the inputs.
pub(crate) fn control_index(controls: &[String], control: &str) -> Result<usize, Error> {
    controls
        .iter()
        .position(|c| c == control)
        .ok_or_else(|| Error::Mismatch {
            what: "controls of the case".into(),
            found: controls.join(", "),
            expected: format!("one named `{control}`"),
        })
}

fn channel<'a>(flown: &'a TimeHistory, name: &str) -> Result<&'a [f64], Error> {
    flown.get(name).ok_or_else(|| Error::Mismatch {
        what: "outputs of the case".into(),
        found: flown
            .channels
            .iter()
            .map(|c| c.name.as_str())
            .collect::<Vec<_>>()
            .join(", "),
        expected: format!("one named `{name}`"),
    })
}

/// Fits compare sample by sample: both histories must have the same times.
fn same_times(model: &[f64], reference: &[f64]) -> Result<(), Error> {
    let apart = model
        .iter()
        .zip(reference)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    if model.len() == reference.len() && apart < 1e-6 {
        return Ok(());
    }
    Err(Error::Mismatch {
        what: "times of the reference's history".into(),
        found: format!("{} samples, up to {apart:.1e} s apart", reference.len()),
        expected: format!("{} samples at steps of {STEP} s", model.len()),
    })
}
