//! Time histories: fixed steps, no allocation in the loop.

use crate::Error;
use crate::elastic::Workspace;
use crate::equations::{EquationsOfMotion, ensure_size};
use crate::signal::{Side, Signal};
use crate::trim::Trim;
use albatross_lti::Signal as Channel;
use albatross_numerics::integrate::{EtdRk4, Rk4, Stage};

/// Method of integration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The classical fourth-order Runge-Kutta method on all states.
    #[default]
    Rk4,
    /// The same with the decay of the lag states at the trimmed speed exact (exponential time differencing, Cox &
    /// Matthews 2002): stable for any lag however fast.
    ExactLags,
}

/// A simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// Step \[s\].
    pub dt: f64,
    /// End \[s\].
    pub end: f64,
    /// Steps from one output sample to the next.
    pub output_every: usize,
    /// Method of integration.
    pub method: Method,
    /// Deviations from trim by input index (controls \[rad\], then thrust \[N\]).
    pub inputs: Vec<(usize, Signal)>,
}

/// Samples of inputs and outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeHistory {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Inputs, then outputs.
    pub channels: Vec<Channel>,
    /// One series per channel.
    pub series: Vec<Vec<f64>>,
    /// State vector at the end.
    pub final_state: Vec<f64>,
    /// Evaluations of the derivative.
    pub evaluations: usize,
}

impl TimeHistory {
    /// Series of a channel by name.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let index = self.channels.iter().position(|c| c.name == name)?;
        self.series.get(index).map(Vec::as_slice)
    }
}

/// Most samples of a history, all channels together: 0.8 GB.
const MOST_SAMPLES: f64 = 1e8;

impl Manoeuvre {
    fn check(&self, equations: &EquationsOfMotion) -> Result<usize, Error> {
        for (quantity, value) in [("dt", self.dt), ("end", self.end)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(Error::BadSignal {
                    quantity,
                    value,
                    expected: "a positive time in seconds",
                });
            }
        }
        let steps = (self.end / self.dt).round();
        if !(1.0..=1e9).contains(&steps)
            || (steps * self.dt - self.end).abs() > 1e-6 * self.dt * steps.max(1.0)
        {
            return Err(Error::BadSignal {
                quantity: "end/dt",
                value: self.end / self.dt,
                expected: "a whole number of steps, 1 to 1e9",
            });
        }
        if self.output_every == 0 {
            return Err(Error::BadSignal {
                quantity: "output_every",
                value: 0.0,
                expected: "one or more steps",
            });
        }
        let channels = equations.n_inputs() + equations.aircraft().sensors.len() + 1;
        let samples = (steps / self.output_every as f64 + 1.0) * channels as f64;
        if samples > MOST_SAMPLES {
            return Err(Error::BadSignal {
                quantity: "number of output samples",
                value: samples,
                expected: "at most 1e8 in all channels: raise output_every",
            });
        }
        for (index, signal) in &self.inputs {
            if *index >= equations.n_inputs() {
                return Err(Error::Sizes {
                    what: "input index",
                    expected: equations.n_inputs(),
                    found: *index,
                });
            }
            signal.check()?;
        }
        Ok(steps as usize)
    }
}

/// The inputs at one time: trim plus deviations.
struct Inputs<'a> {
    trim: &'a [f64],
    deviations: &'a [(usize, Signal)],
}

impl Inputs<'_> {
    fn at(&self, t: f64, side: Side, u: &mut [f64]) {
        u.copy_from_slice(self.trim);
        for (index, signal) in self.deviations {
            u[*index] += signal.at(t, side);
        }
    }

    /// Stages within a step see the right limit at its start and the left limit at its end.
    fn at_stage(&self, t: f64, stage: Stage, u: &mut [f64]) {
        self.at(
            t,
            if stage == Stage::End {
                Side::Left
            } else {
                Side::Right
            },
            u,
        );
    }
}

/// Non-linear simulation from trim.
///
/// # Errors
/// [`Error::BadSignal`] for an unusable step or input, [`Error::Sizes`] for a trim of another model,
/// [`Error::Diverged`] with the time and the state that ceased to be finite.
pub fn simulate(
    equations: &EquationsOfMotion,
    trim: &Trim,
    manoeuvre: &Manoeuvre,
) -> Result<TimeHistory, Error> {
    let steps = manoeuvre.check(equations)?;
    ensure_size(
        "states of the trim",
        trim.state.len(),
        equations.layout().n_states(),
    )?;
    ensure_size("inputs of the trim", trim.input.len(), equations.n_inputs())?;
    let inputs = Inputs {
        trim: &trim.input,
        deviations: &manoeuvre.inputs,
    };
    let mut run = Run::new(equations, trim, steps / manoeuvre.output_every + 1);
    let mut x = trim.state.clone();
    let mut stepper = Stepper::new(equations, trim, manoeuvre)?;
    for step in 0..steps {
        let t = step as f64 * manoeuvre.dt;
        let sample = step % manoeuvre.output_every == 0;
        if sample {
            run.ensure_finite(t, manoeuvre.dt, &x)?;
        }
        stepper.step(t, manoeuvre.dt, &mut x, |t, stage, x, xdot| {
            inputs.at_stage(t, stage, &mut run.input);
            equations.rates(x, &run.input, &mut run.work, xdot);
            // The first stage is the sample's own evaluation: same state, right limits of the inputs.
            if sample && stage == Stage::Start {
                run.record(t, x, xdot);
            }
        });
    }
    let end = steps as f64 * manoeuvre.dt;
    run.ensure_finite(end, manoeuvre.dt, &x)?;
    if steps % manoeuvre.output_every == 0 {
        let mut xdot = vec![0.0; x.len()];
        inputs.at(end, Side::Right, &mut run.input);
        equations.rates(&x, &run.input, &mut run.work, &mut xdot);
        run.record(end, &x, &xdot);
    }
    Ok(run.finish(x, 4 * steps))
}

enum Stepper {
    Rk4(Rk4),
    ExactLags { method: EtdRk4, diagonal: Vec<f64> },
}

impl Stepper {
    fn new(equations: &EquationsOfMotion, trim: &Trim, manoeuvre: &Manoeuvre) -> Result<Self, Error> {
        Ok(match manoeuvre.method {
            Method::Rk4 => Self::Rk4(Rk4::new(equations.layout().n_states())),
            Method::ExactLags => {
                let s = &trim.state;
                let speed = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]).sqrt();
                let diagonal = equations.lag_diagonal(speed);
                Self::ExactLags {
                    method: EtdRk4::new(&diagonal, manoeuvre.dt)?,
                    diagonal,
                }
            }
        })
    }

    fn step(&mut self, t: f64, dt: f64, x: &mut [f64], mut f: impl FnMut(f64, Stage, &[f64], &mut [f64])) {
        match self {
            Self::Rk4(method) => method.step(t, dt, x, f),
            Self::ExactLags { method, diagonal } => method.step(t, x, |t, stage, x, rest| {
                f(t, stage, x, rest);
                for ((r, l), x) in rest.iter_mut().zip(diagonal.iter()).zip(x) {
                    *r -= l * x;
                }
            }),
        }
    }
}

/// Buffers and samples of one simulation.
struct Run<'a> {
    equations: &'a EquationsOfMotion,
    work: Workspace<f64>,
    input: Vec<f64>,
    output: Vec<f64>,
    time: Vec<f64>,
    series: Vec<Vec<f64>>,
}

impl<'a> Run<'a> {
    fn new(equations: &'a EquationsOfMotion, trim: &Trim, samples: usize) -> Self {
        let n_outputs = equations.aircraft().sensors.len();
        Self {
            equations,
            work: equations.workspace(),
            input: trim.input.clone(),
            output: vec![0.0; n_outputs],
            time: Vec::with_capacity(samples),
            series: vec![Vec::with_capacity(samples); trim.input.len() + n_outputs],
        }
    }

    fn ensure_finite(&self, time: f64, dt: f64, x: &[f64]) -> Result<(), Error> {
        let Some(bad) = x.iter().position(|v| !v.is_finite()) else {
            return Ok(());
        };
        let signals = self.equations.layout().signals();
        let state = signals.get(bad).map_or_else(String::new, |s| s.name.clone());
        Err(Error::Diverged { time, state, dt })
    }

    /// Samples the inputs as they stand and the outputs.
    fn record(&mut self, t: f64, x: &[f64], xdot: &[f64]) {
        self.equations.measure(x, xdot, &mut self.output);
        self.time.push(t);
        for (series, value) in self.series.iter_mut().zip(self.input.iter().chain(&self.output)) {
            series.push(*value);
        }
    }

    fn finish(self, final_state: Vec<f64>, evaluations: usize) -> TimeHistory {
        let aircraft = self.equations.aircraft();
        let mut channels: Vec<Channel> = aircraft.controls.iter().map(|c| Channel::new(c, "rad")).collect();
        channels.push(Channel::new(crate::THRUST, "N"));
        channels.extend(
            aircraft
                .sensors
                .iter()
                .map(|s| Channel::new(&s.name, s.quantity.unit())),
        );
        TimeHistory {
            time: self.time,
            channels,
            series: self.series,
            final_state,
            evaluations,
        }
    }
}
