//! Frequency response H(s) = C (sI - A)^-1 B + D, and its magnitude and unwrapped phase.

use std::cell::Cell;
use std::f64::consts::TAU;

use albatross_numerics::matrix::check_shape;
use albatross_numerics::solve::ComplexLu;
use albatross_numerics::{C64, Mat, eigen};

use crate::error::SignalKind;
use crate::reduced::LagReduced;
use crate::state_space::index_of;
use crate::{Error, Result, Signal, StateSpace};

/// How the resolvent is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// [`Method::LagReduced`] when at least a third of the states form a diagonal block, else [`Method::Lu`].
    #[default]
    Auto,
    /// Complex LU factors of sI - A at each frequency: the reference.
    Lu,
    /// One eigen-decomposition, then products; refused when the eigenvectors are nearly dependent.
    Eigen,
    /// States with a diagonal block in A (aerodynamic lags) eliminated, the small rest factorised.
    LagReduced,
}

/// A system prepared for evaluation at many points of the complex plane.
///
/// States that no input reaches or no output sees are dropped first, and the rest are balanced.
#[derive(Debug, Clone)]
pub struct FrequencySolver {
    system: StateSpace,
    form: Form,
}

#[derive(Debug, Clone)]
enum Form {
    Lu,
    /// Eigenvalues, C V and V^-1 B.
    Eigen(Vec<C64>, Mat<C64>, Mat<C64>),
    LagReduced(LagReduced),
}

impl FrequencySolver {
    /// Prepares `system` for `method`.
    ///
    /// # Errors
    /// [`Error::Method`] when an explicitly chosen method does not suit, [`Error::Numerics`], those of
    /// [`StateSpace::check`].
    pub fn new(system: &StateSpace, method: Method) -> Result<Self> {
        system.check()?;
        let system = balanced(system.without_idle_states());
        let form = match method {
            Method::Lu => Form::Lu,
            Method::Eigen => eigen_form(&system)?,
            Method::LagReduced => Form::LagReduced(LagReduced::detect(&system)?),
            Method::Auto => match LagReduced::detect(&system) {
                Ok(reduced) if 3 * reduced.lag_count() >= system.states.len() => Form::LagReduced(reduced),
                _ => Form::Lu,
            },
        };
        Ok(Self { system, form })
    }

    /// Prepares `system` with the named states eliminated as lags.
    ///
    /// # Errors
    /// [`Error::Method`] when the block of those states is not diagonal, [`Error::UnknownSignal`], those of
    /// [`StateSpace::check`].
    pub fn with_lags(system: &StateSpace, lags: &[&str]) -> Result<Self> {
        system.check()?;
        for name in lags {
            system.state_index(name)?;
        }
        let system = balanced(system.without_idle_states());
        let indices: Vec<usize> = (0..system.states.len())
            .filter(|&i| lags.contains(&system.states[i].name.as_str()))
            .collect();
        let form = Form::LagReduced(LagReduced::new(&system, &indices)?);
        Ok(Self { system, form })
    }

    /// H(s), outputs x inputs, at a point `s` in rad/s.
    ///
    /// # Errors
    /// [`Error::PoleAtFrequency`] when `s` is an eigenvalue, [`Error::Domain`] when it or the response is not finite.
    pub fn evaluate(&self, s: C64) -> Result<Mat<C64>> {
        if !s.is_finite() {
            return Err(Error::Domain {
                what: "the frequency",
                value: s.im,
                expected: "a finite number",
            });
        }
        let h = match &self.form {
            Form::Lu => lu_evaluate(&self.system, s)?,
            Form::Eigen(values, cv, vb) => eigen_evaluate(&self.system, (values, cv, vb), s)?,
            Form::LagReduced(reduced) => reduced.evaluate(&[s])?.swap_remove(0),
        };
        finite(h, s)
    }

    /// H at i omega for each circular frequency (rad/s).
    ///
    /// # Errors
    /// As [`FrequencySolver::evaluate`].
    pub fn response(&self, omega_rad_s: &[f64]) -> Result<Response> {
        let values = match &self.form {
            Form::LagReduced(reduced) if omega_rad_s.iter().all(|w| w.is_finite()) => {
                let points: Vec<C64> = omega_rad_s.iter().map(|&w| C64::new(0.0, w)).collect();
                let values = reduced.evaluate(&points)?;
                let with_points = values.into_iter().zip(points);
                with_points.map(|(h, s)| finite(h, s)).collect::<Result<_>>()?
            }
            _ => omega_rad_s
                .iter()
                .map(|&w| self.evaluate(C64::new(0.0, w)))
                .collect::<Result<Vec<_>>>()?,
        };
        Ok(Response {
            omega_rad_s: omega_rad_s.to_vec(),
            inputs: self.system.inputs.clone(),
            outputs: self.system.outputs.clone(),
            values,
        })
    }

    /// Unwrapped phase (deg) of one channel, right on any grid of ascending frequencies.
    ///
    /// Between two frequencies of the grid the phase may turn by more than half a revolution. Here every
    /// interval is cut at the frequencies of the poles inside it and halved until the phase changes by less
    /// than 60 deg from point to point. The first value lies in (-180, 180].
    ///
    /// # Errors
    /// As [`FrequencySolver::evaluate`]; [`Error::UnknownSignal`]; [`Error::Domain`] for frequencies that do
    /// not ascend.
    pub fn phase_deg(&self, output: &str, input: &str, omega_rad_s: &[f64]) -> Result<Vec<f64>> {
        let (i, j) = (self.system.output_index(output)?, self.system.input_index(input)?);
        if let Some(pair) = omega_rad_s.windows(2).find(|w| w[1] < w[0]) {
            return Err(Error::Domain {
                what: "a frequency",
                value: pair[1],
                expected: "frequencies that ascend",
            });
        }
        let mut poles: Vec<f64> = eigen::eigenvalues(self.system.a.as_ref())?
            .iter()
            .map(|v| v.im)
            .collect();
        poles.sort_by(f64::total_cmp);
        let left = Cell::new(0_usize);
        let phase = |w: f64| {
            left.set(left.get().saturating_sub(1));
            self.evaluate(C64::new(0.0, w)).map(|h| principal_deg(h[(i, j)]))
        };

        let mut unwrapped: Vec<f64> = Vec::with_capacity(omega_rad_s.len());
        let Some(&first) = omega_rad_s.first() else {
            return Ok(unwrapped);
        };
        let (mut at, mut angle) = (first, phase(first)?);
        let mut total = angle;
        unwrapped.push(total);
        for &next in &omega_rad_s[1..] {
            let inside = poles
                .iter()
                .copied()
                .filter(|&p| p > at && p < next)
                .collect::<Vec<_>>();
            for stop in inside.into_iter().chain([next]) {
                // A pole exactly on the axis has no phase: step over it.
                let Ok(at_stop) = phase(stop) else { continue };
                left.set(MOST_HALVINGS);
                total += turn_deg(&phase, (at, angle), (stop, at_stop), &left)?;
                (at, angle) = (stop, at_stop);
            }
            if at < next {
                phase(next)?;
            }
            unwrapped.push(total);
        }
        Ok(unwrapped)
    }
}

/// Points that one interval may be halved into. A response that cancels to rounding has a phase of noise, for which no
/// number is enough.
const MOST_HALVINGS: usize = 2000;

/// Change of phase between two frequencies, halving while it is too large to be told from its complement and `left`
/// points remain.
fn turn_deg(
    phase: &impl Fn(f64) -> Result<f64>,
    (w0, p0): (f64, f64),
    (w1, p1): (f64, f64),
    left: &Cell<usize>,
) -> Result<f64> {
    let difference = wrap_deg(p1 - p0);
    let middle = 0.5 * (w0 + w1);
    // A difference that is no number is not halved either.
    let small = difference.is_nan() || difference.abs() < 60.0;
    if small || left.get() == 0 || middle <= w0 || middle >= w1 {
        return Ok(difference);
    }
    let at_middle = phase(middle)?;
    Ok(turn_deg(phase, (w0, p0), (middle, at_middle), left)?
        + turn_deg(phase, (middle, at_middle), (w1, p1), left)?)
}

/// Response of `system` at i omega for each circular frequency (rad/s), method chosen automatically.
///
/// # Errors
/// [`Error::PoleAtFrequency`], [`Error::Domain`].
pub fn frequency_response(system: &StateSpace, omega_rad_s: &[f64]) -> Result<Response> {
    FrequencySolver::new(system, Method::Auto)?.response(omega_rad_s)
}

/// The response, unless it overflowed.
fn finite(h: Mat<C64>, s: C64) -> Result<Mat<C64>> {
    if (0..h.ncols()).all(|j| (0..h.nrows()).all(|i| h[(i, j)].is_finite())) {
        return Ok(h);
    }
    Err(Error::Domain {
        what: "the frequency at which the response overflows",
        value: s.im,
        expected: "a system whose numbers stay in range; check the units of its states, inputs and outputs",
    })
}

/// State scaling by powers of two that balances A.
fn balanced(mut system: StateSpace) -> StateSpace {
    let (a, scaling) = eigen::balance(system.a.as_ref());
    for (i, d) in scaling.iter().enumerate() {
        (0..system.b.ncols()).for_each(|j| system.b[(i, j)] /= d);
        (0..system.c.nrows()).for_each(|j| system.c[(j, i)] *= d);
    }
    system.a = a;
    system
}

fn lu_evaluate(system: &StateSpace, s: C64) -> Result<Mat<C64>> {
    let n = system.states.len();
    let shifted = Mat::from_fn(n, n, |i, j| {
        let diagonal = if i == j { s } else { C64::new(0.0, 0.0) };
        diagonal - system.a[(i, j)]
    });
    let (b, c, d) = (complex(&system.b), complex(&system.c), complex(&system.d));
    let x = ComplexLu::new(shifted.as_ref())
        .and_then(|lu| lu.solve(b.as_ref()))
        .map_err(|e| at_pole(e, s))?;
    Ok(&c * &x + &d)
}

/// A singular resolvent is a pole at `s`.
pub(crate) fn at_pole(error: albatross_numerics::Error, s: C64) -> Error {
    match error {
        albatross_numerics::Error::Singular { .. } => Error::PoleAtFrequency {
            omega_rad_s: s.im,
            re: s.re,
            im: s.im,
        },
        other => other.into(),
    }
}

fn complex(a: &Mat<f64>) -> Mat<C64> {
    albatross_numerics::matrix::to_complex(a.as_ref())
}

fn eigen_form(system: &StateSpace) -> Result<Form> {
    // Rounding is amplified by the condition of the eigenvalues: eight digits are kept.
    const LARGEST_CONDITION: f64 = 1e8;
    let n = system.states.len();
    let eigen = eigen::eigen(system.a.as_ref())?;
    let refuse = |condition: f64| Error::Method {
        method: "the frequency response by eigenvectors",
        reason: format!(
            "an eigenvalue has condition {condition:.1e} (at most {LARGEST_CONDITION:.0e}): choose LU"
        ),
    };
    let inverse = match ComplexLu::new(eigen.vectors.as_ref()) {
        Ok(lu) => lu.solve(Mat::identity(n, n).as_ref())?,
        Err(albatross_numerics::Error::Singular { .. }) => return Err(refuse(f64::INFINITY)),
        Err(other) => return Err(other.into()),
    };
    // Row k of the inverse is the left vector l with l^H r = 1, and |r| = 1.
    let condition = (0..n).map(|k| inverse.row(k).norm_l2()).fold(0.0, f64::max);
    if condition > LARGEST_CONDITION {
        return Err(refuse(condition));
    }
    Ok(Form::Eigen(
        eigen.values,
        complex(&system.c) * &eigen.vectors,
        inverse * complex(&system.b),
    ))
}

fn eigen_evaluate(system: &StateSpace, form: (&[C64], &Mat<C64>, &Mat<C64>), s: C64) -> Result<Mat<C64>> {
    let (values, cv, vb) = form;
    let mut weighted = vb.clone();
    for (k, value) in values.iter().enumerate() {
        let distance = s - value;
        if distance.norm() <= 4.0 * f64::EPSILON * s.norm().max(value.norm()) {
            return Err(Error::PoleAtFrequency {
                omega_rad_s: s.im,
                re: s.re,
                im: s.im,
            });
        }
        let weight = distance.inv();
        (0..vb.ncols()).for_each(|j| weighted[(k, j)] *= weight);
    }
    Ok(cv * &weighted + complex(&system.d))
}

/// Complex response of all channels over frequency.
#[derive(Debug, Clone)]
pub struct Response {
    /// Circular frequencies, rad/s.
    pub omega_rad_s: Vec<f64>,
    /// Inputs, in the order of the columns of each value.
    pub inputs: Vec<Signal>,
    /// Outputs, in the order of the rows of each value.
    pub outputs: Vec<Signal>,
    /// H at each frequency, outputs x inputs.
    pub values: Vec<Mat<C64>>,
}

impl Response {
    /// The response from one input to one output.
    ///
    /// # Errors
    /// [`Error::UnknownSignal`] with the names there are, [`Error::Numerics`] for values of another size.
    pub fn get(&self, output: &str, input: &str) -> Result<Channel> {
        let i = index_of(SignalKind::Output, &self.outputs, output)?;
        let j = index_of(SignalKind::Input, &self.inputs, input)?;
        Ok(Channel {
            omega_rad_s: self.omega_rad_s.clone(),
            values: self
                .values
                .iter()
                .map(|h| {
                    let size = (self.outputs.len(), self.inputs.len());
                    check_shape("a response", (h.nrows(), h.ncols()), size)?;
                    Ok(h[(i, j)])
                })
                .collect::<Result<Vec<_>>>()?,
        })
    }
}

/// Complex response from one input to one output.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Circular frequencies, rad/s.
    pub omega_rad_s: Vec<f64>,
    /// Response at each frequency.
    pub values: Vec<C64>,
}

impl Channel {
    /// Frequencies in Hz.
    pub fn frequency_hz(&self) -> Vec<f64> {
        self.omega_rad_s.iter().map(|w| w / TAU).collect()
    }

    /// Magnitude, in the unit of output per input.
    pub fn magnitude(&self) -> Vec<f64> {
        self.values.iter().map(|h| h.norm()).collect()
    }

    /// Magnitude in decibels, 20 log10 of output per input in their units.
    pub fn magnitude_db(&self) -> Vec<f64> {
        self.values.iter().map(|h| 20.0 * h.norm().log10()).collect()
    }

    /// Phase in degrees without jumps; the first value lies in (-180, 180].
    ///
    /// Each step is taken as the turn of less than half a revolution, so the grid must resolve the
    /// resonances; where it cannot, use [`FrequencySolver::phase_deg`].
    pub fn phase_deg(&self) -> Vec<f64> {
        unwrap_deg(&self.values.iter().map(|&h| principal_deg(h)).collect::<Vec<_>>())
    }
}

/// Argument in degrees, in (-180, 180].
fn principal_deg(h: C64) -> f64 {
    let angle = h.arg().to_degrees();
    if angle <= -180.0 { angle + 360.0 } else { angle }
}

/// The representative in (-180, 180].
fn wrap_deg(angle: f64) -> f64 {
    let wrapped = angle - 360.0 * (angle / 360.0).round();
    if wrapped <= -180.0 {
        wrapped + 360.0
    } else {
        wrapped
    }
}

/// Removes the jumps of a phase in degrees: every step becomes its representative in (-180, 180].
pub fn unwrap_deg(phase_deg: &[f64]) -> Vec<f64> {
    let mut total = phase_deg.first().copied().unwrap_or(0.0);
    let mut previous = total;
    phase_deg
        .iter()
        .map(|&phase| {
            total += wrap_deg(phase - previous);
            previous = phase;
            total
        })
        .collect()
}
