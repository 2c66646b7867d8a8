//! The linearised aircraft in symmetric flight, and what the reference's description says it lacks.

use super::static_derivatives::{CAUSES, Cause, flexible};
use crate::error::Error;
use crate::validate::reference::{QUANTITIES, Reference};
use crate::validate::study::{STEP, Variant, fit};
use albatross::Model;
use albatross::analysis::Trimmed;
use albatross::flight::Quantity;
use albatross::lti::{Hold, Mode, OutputSimulator, StateSpace};
use albatross::numerics::{C64, Mat, eigen};
use albatross::sysid::from_trim;

/// Samples of the reference from one step of a linear simulation to the next; its exact step needs no shorter ones.
pub(super) const EVERY: usize = 2;

/// The linearised aircraft in symmetric flight: elevator to the compared quantities.
#[derive(Debug, Clone)]
pub(super) struct LinearModel {
    system: StateSpace,
    /// Rows of `w'` and `q'`.
    heave: usize,
    pitch: usize,
}

impl LinearModel {
    pub(super) fn of(variant: &Variant) -> Result<Self, Error> {
        Self::new(&variant.model, &variant.trimmed)
    }

    pub(super) fn new(model: &Model, trimmed: &Trimmed) -> Result<Self, Error> {
        let outputs: Vec<&str> = QUANTITIES.iter().map(|q| q.sensor).collect();
        let full = trimmed.system.select(&[model.point.control.as_str()], &outputs)?;
        let lateral = ["v", "p", "r", "phi", "psi", "north", "east"];
        let kept: Vec<usize> = (0..full.states.len())
            .filter(|&i| {
                full.states
                    .get(i)
                    .is_some_and(|s| !lateral.contains(&s.name.as_str()))
            })
            .collect();
        let (n, m, l) = (kept.len(), full.b.ncols(), full.c.nrows());
        let system = StateSpace::try_new(
            (
                Mat::from_fn(n, n, |i, j| full.a[(kept[i], kept[j])]),
                Mat::from_fn(n, m, |i, j| full.b[(kept[i], j)]),
                Mat::from_fn(l, n, |i, j| full.c[(i, kept[j])]),
                full.d.clone(),
            ),
            kept.iter().filter_map(|&i| full.states.get(i).cloned()).collect(),
            full.inputs.clone(),
            full.outputs.clone(),
        )?;
        Ok(Self {
            heave: system.state_index("w")?,
            pitch: system.state_index("q")?,
            system,
        })
    }

    /// With more heave and pitch acceleration by each state and by the input, and what the accelerometers make of it.
    fn with_accelerations(&self, model: &Model, more: &Accelerations) -> Self {
        let mut changed = self.clone();
        let n = self.system.states.len();
        let system = &mut changed.system;
        for j in 0..n {
            system.a[(self.heave, j)] += more.heave[j];
            system.a[(self.pitch, j)] += more.pitch[j];
        }
        system.b[(self.heave, 0)] += more.heave_by_input;
        system.b[(self.pitch, 0)] += more.pitch_by_input;
        for (row, quantity) in QUANTITIES.iter().enumerate() {
            let Some(sensor) = model.aircraft.sensors.iter().find(|s| s.name == quantity.sensor) else {
                continue;
            };
            // a_z = w' - x q' + ..., positive down; n_z = -a_z/g + ...
            let ahead = sensor.point.as_ref().map_or(0.0, |p| p.position[0]);
            let factor = match sensor.quantity {
                Quantity::VerticalAcceleration => 1.0,
                Quantity::LoadFactor => -1.0 / model.aircraft.gravity,
                _ => continue,
            };
            for j in 0..n {
                system.c[(row, j)] += factor * (more.heave[j] - ahead * more.pitch[j]);
            }
            system.d[(row, 0)] += factor * (more.heave_by_input - ahead * more.pitch_by_input);
        }
        changed
    }

    /// With the reference's lift and moment due to the rate of incidence, `alpha' = w'/V`.
    pub(super) fn with_incidence_rate(
        &self,
        variant: &Variant,
        reference: &Reference,
    ) -> Result<Self, Error> {
        let scales = Scales::of(variant);
        let per_rate = 0.5 * scales.chord / scales.speed.powi(2);
        let derivatives = &reference.derivatives;
        let heave = -scales.force * derivatives.CLadot_low_frequency * per_rate / scales.mass;
        let pitch = scales.moment * derivatives.Cmadot_low_frequency * per_rate / scales.inertia;
        // w' = old + heave w' is solved for w'.
        let gain = 1.0 / (1.0 - heave);
        let n = self.system.states.len();
        let old = |j: usize| self.system.a[(self.heave, j)];
        let old_input = self.system.b[(self.heave, 0)];
        Ok(self.with_accelerations(
            &variant.model,
            &Accelerations {
                heave: (0..n).map(|j| (gain - 1.0) * old(j)).collect(),
                pitch: (0..n).map(|j| pitch * gain * old(j)).collect(),
                heave_by_input: (gain - 1.0) * old_input,
                pitch_by_input: pitch * gain * old_input,
            },
        ))
    }

    /// With rigid derivatives changed so that the static derivatives of the flexible aircraft are the reference's.
    pub(super) fn with_static_derivatives(
        &self,
        variant: &Variant,
        reference: &Reference,
    ) -> Result<Self, Error> {
        let scales = Scales::of(variant);
        let n = self.system.states.len();
        let mut more = Accelerations {
            heave: vec![0.0; n],
            pitch: vec![0.0; n],
            heave_by_input: 0.0,
            pitch_by_input: 0.0,
        };
        for cause in CAUSES {
            let [lift, moment] = flexible(&variant.model, &variant.trimmed, cause)?;
            let wanted = cause.of(reference);
            let heave = -scales.force * (wanted.flex_CL - lift) / scales.mass;
            let pitch = scales.moment * (wanted.flex_Cm - moment) / scales.inertia;
            match cause {
                Cause::Incidence => {
                    more.heave[self.heave] += heave / scales.speed;
                    more.pitch[self.heave] += pitch / scales.speed;
                }
                Cause::PitchRate => {
                    let per_rate = 0.5 * scales.chord / scales.speed;
                    more.heave[self.pitch] += heave * per_rate;
                    more.pitch[self.pitch] += pitch * per_rate;
                }
                Cause::Elevator => {
                    more.heave_by_input += heave;
                    more.pitch_by_input += pitch;
                }
            }
        }
        Ok(self.with_accelerations(&variant.model, &more))
    }

    /// The eigenvalue nearest to a given one.
    pub(super) fn mode_near(&self, wanted: C64) -> Result<Mode, Error> {
        let values = eigen::eigenvalues(self.system.a.as_ref())?;
        let nearest = values
            .into_iter()
            .min_by(|a, b| (a - wanted).norm().total_cmp(&(b - wanted).norm()))
            .unwrap_or_default();
        Ok(Mode::from_eigenvalue(nearest))
    }

    /// Fits to the reference's histories, driven by its elevator.
    pub(super) fn fits(&self, reference: &Reference) -> Result<Vec<Vec<f64>>, Error> {
        let thinned = |series: &[f64]| -> Vec<f64> { series.iter().step_by(EVERY).copied().collect() };
        let simulator = OutputSimulator::new(&self.system, EVERY as f64 * STEP, Hold::First)?;
        let mut all = Vec::new();
        for history in &reference.histories {
            let deflection = from_trim(&thinned(&history.elevator_deg));
            let inputs: Vec<Vec<f64>> = deflection.iter().map(|v| vec![v.to_radians()]).collect();
            let flown = simulator.outputs(&inputs)?;
            let fits = QUANTITIES
                .iter()
                .zip(&history.series)
                .zip(&flown)
                .map(|((quantity, series), own)| {
                    let own: Vec<f64> = own.iter().map(|v| v * quantity.scale).collect();
                    fit(&thinned(series), &own)
                })
                .collect();
            all.push(fits);
        }
        Ok(all)
    }
}

/// More heave and pitch acceleration: by each state, and by the input.
struct Accelerations {
    heave: Vec<f64>,
    pitch: Vec<f64>,
    heave_by_input: f64,
    pitch_by_input: f64,
}

/// What coefficients are multiplied and accelerations divided by.
struct Scales {
    /// Dynamic pressure times area, and times chord.
    force: f64,
    moment: f64,
    chord: f64,
    speed: f64,
    mass: f64,
    inertia: f64,
}

impl Scales {
    fn of(variant: &Variant) -> Self {
        let (aircraft, trim) = (&variant.model.aircraft, &variant.trimmed.trim);
        let force = trim.dynamic_pressure * aircraft.reference.area;
        Self {
            force,
            moment: force * aircraft.reference.chord,
            chord: aircraft.reference.chord,
            speed: trim.speed(),
            mass: aircraft.mass,
            inertia: aircraft.inertia[1][1],
        }
    }
}
