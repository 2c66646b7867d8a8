//! How certain an estimate is.
//!
//! With the weighted sensitivities J of all unknowns and the covariance S of the weighted residuals,
//! ```text
//! C = (J'J)^-1 (J' S J) (J'J)^-1
//! ```
//! (the sandwich: Ljung, System Identification, 2nd ed., sec. 9.4; White, Econometrica 50, 1982). For white residuals S is
//! diagonal, with the variance of each record; for coloured ones it is the Toeplitz matrix of their autocorrelation.
//! Frequencies, damping ratios, residues and responses follow by linearisation (delta method).
//!
//! Equations: THEORY (33).

use albatross_lti::Signal;
use albatross_numerics::faer::linalg::solvers::Svd;
use albatross_numerics::solve::triangle;
use albatross_numerics::{C64, Mat};
use serde::Serialize;

use crate::blocks::Block;
use crate::data::mismatch;
use crate::filters::Bank;
use crate::numerator::tangents;
use crate::problem::{Columns, Fitted, Problem};
use crate::{Model, Result};

/// Singular values below this share of the largest are raised to it: what the data do not determine becomes very
/// uncertain instead of infinitely so.
const FLOOR: f64 = 1e-11;
/// Lags of the autocorrelation used for coloured residuals, as a power of the number of samples.
const LAGS_EXPONENT: f64 = 1.0 / 3.0;
/// A mode whose frequency is less certain than this share of itself is not identified.
const LARGEST_RELATIVE_SD: f64 = 0.1;
/// A residue below this many standard deviations is not told from zero.
const LEAST_RESIDUE_SD: f64 = 2.0;

/// Residue of a mode in one output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Residue {
    /// Output.
    pub output: Signal,
    /// Real part, unit of the output per unit of the input and s.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
    /// Modulus.
    pub modulus: f64,
    /// Standard deviation of the modulus.
    pub sd_modulus: f64,
}

/// A pole with its standard deviations: of a conjugate pair the member with positive imaginary part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PoleEstimate {
    /// Real part \[rad/s\].
    pub re: f64,
    /// Imaginary part \[rad/s\], not negative.
    pub im: f64,
    /// Modulus \[rad/s\].
    pub frequency_rad_s: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Standard deviation of the frequency, residuals white \[rad/s\].
    pub sd_frequency_rad_s: f64,
    /// Standard deviation of the damping ratio, residuals white.
    pub sd_damping_ratio: f64,
    /// The same for residuals coloured as they are \[rad/s\].
    pub sd_frequency_coloured_rad_s: f64,
    /// The same for residuals coloured as they are.
    pub sd_damping_ratio_coloured: f64,
    /// Covariance of real and imaginary part: re-re, re-im, im-im \[rad2/s2\].
    pub covariance: [f64; 3],
    /// Residue in every output.
    pub residues: Vec<Residue>,
    /// Frequency certain to 10 % and a residue beyond two standard deviations in some output.
    pub identified: bool,
    /// A zero of some output lies within three standard deviations, or within a thousandth of the modulus: the mode
    /// nearly cancels there. The outputs concerned.
    pub near_cancellation: Vec<String>,
}

/// Covariance of the parameters, and what follows from it.
#[derive(Debug, Clone, Serialize)]
pub struct Uncertainty {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Samples used, over all outputs.
    pub samples: usize,
    /// Standard deviation of the residuals, by output and experiment, unit of the output.
    pub residual_sd: Vec<Vec<f64>>,
    /// Poles, modulus ascending.
    pub modes: Vec<PoleEstimate>,
    /// Covariance of the denominator's parameters and of each output's numerator, residuals white and as they are.
    #[serde(skip)]
    covariance: [Mat<f64>; 2],
    /// How parameters move the numerator coefficients.
    #[serde(skip)]
    numerators: Vec<NumeratorMap>,
    /// Sample time if the delay is an unknown \[s\].
    #[serde(skip)]
    delay_unit: Option<f64>,
}

/// Magnitude and phase of a response with their standard deviations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConfidenceBand {
    /// Angular frequencies \[rad/s\].
    pub omega_rad_s: Vec<f64>,
    /// Response.
    #[serde(skip)]
    pub response: Vec<C64>,
    /// Standard deviation of the magnitude \[dB\].
    pub sd_magnitude_db: Vec<f64>,
    /// Standard deviation of the phase \[deg\].
    pub sd_phase_deg: Vec<f64>,
}

/// Coefficients c of an output as they depend on the parameters: poles x shared and poles x own.
#[derive(Debug, Clone)]
struct NumeratorMap {
    shared: Mat<f64>,
    own: Mat<f64>,
    /// Position of the own unknowns among all.
    at: usize,
    direct: bool,
}

impl Uncertainty {
    /// From the residuals of a fitted point; none when the sensitivities are not finite or there are no spare samples.
    pub(crate) fn of(
        problem: &Problem<'_>,
        fitted: &Fitted,
        predicted: &[Vec<Vec<f64>>],
    ) -> Result<Option<Self>> {
        let (n_shared, n_own) = (
            fitted.point.blocks.iter().map(|b| b.order()).sum::<usize>() + usize::from(problem.free_delay),
            fitted.unknowns.own.first().map_or(0, Vec::len),
        );
        let n_outputs = problem.outputs();
        let n_local: usize = fitted.unknowns.local.iter().flatten().map(Vec::len).sum();
        let unknowns = n_shared + n_outputs * n_own + n_local;
        let samples = problem.data.samples() * n_outputs;
        if samples <= unknowns {
            return Ok(None);
        }
        let spare = (samples - unknowns) as f64 / samples as f64;

        let bank = Bank::new(&fitted.point.blocks, problem.timing(fitted.point.delay))?;
        let every = problem.of_all_samples();
        let mut triangles = Vec::new();
        // J'SJ for white and for coloured residuals.
        let mut meat: [Mat<f64>; 2] = std::array::from_fn(|_| Mat::zeros(unknowns, unknowns));
        let mut residual_sd = vec![Vec::new(); n_outputs];
        let mut at_local = n_shared + n_outputs * n_own;
        for (o, sd) in residual_sd.iter_mut().enumerate() {
            for (e, experiment) in problem.data.experiments.iter().enumerate() {
                let ring = every.ring(&bank, e, problem.free_initial, true);
                let forced = bank.respond(&experiment.input, true, 1);
                let columns = Columns {
                    local: every.local(e, &ring),
                    own: every.own(
                        e,
                        forced.x.clone(),
                        &fitted.freedom,
                        problem.timing(fitted.point.delay),
                    ),
                    shared: every.shared(fitted, e, o, &forced, &ring),
                };
                let residual: Vec<f64> = experiment.outputs[o]
                    .iter()
                    .zip(&predicted[e][o])
                    .map(|(y, p)| y - p)
                    .collect();
                let factor = problem.factors[o][e];
                let variance = residual.iter().map(|r| r * r).sum::<f64>() / (residual.len() as f64 * spare);
                sd.push(variance.sqrt());
                let places: Vec<usize> = (at_local..at_local + columns.local.len())
                    .chain(n_shared + o * n_own..n_shared + (o + 1) * n_own)
                    .chain(0..n_shared)
                    .collect();
                at_local += columns.local.len();
                let mut j = columns.matrix(&[]);
                j *= albatross_numerics::faer::Scale(factor);
                let r = triangle(j.clone());
                let white = r.transpose() * &r * albatross_numerics::faer::Scale(variance * factor * factor);
                let coloured = coloured(&j, &residual, factor / spare.sqrt());
                for (sum, part) in meat.iter_mut().zip([&white, &coloured]) {
                    for (p, &row) in places.iter().enumerate() {
                        for (q, &column) in places.iter().enumerate() {
                            sum[(row, column)] += part[(p, q)];
                        }
                    }
                }
                triangles.push((places, r));
            }
        }
        let Some(inverse) = inverse_information(&triangles, unknowns) else {
            return Ok(None);
        };
        let keep = n_shared + n_outputs * n_own;
        let covariance = meat.map(|m| {
            let all = &inverse * m * &inverse;
            all.submatrix(0, 0, keep, keep).to_owned()
        });
        if covariance
            .iter()
            .any(|c| albatross_numerics::matrix::check_finite("the covariance", c.as_ref()).is_err())
        {
            return Ok(None);
        }
        let numerators = (0..n_outputs)
            .map(|o| NumeratorMap::new(problem, fitted, o, n_shared, n_own))
            .collect();
        Ok(Some(Self {
            unknowns,
            samples,
            residual_sd,
            modes: Vec::new(),
            covariance,
            numerators,
            delay_unit: problem.free_delay.then(|| problem.data.dt()),
        }))
    }

    /// Fills the table of poles.
    ///
    /// # Errors
    /// [`crate::Error::Numerics`] when zeros cannot be found.
    pub(crate) fn with_modes(mut self, model: &Model) -> Result<Self> {
        let zeros: Vec<Vec<C64>> = (0..model.outputs.len())
            .map(|o| Ok(model.zpk(o)?.zeros))
            .collect::<Result<_>>()?;
        let mut at = 0;
        let mut modes = Vec::new();
        for block in &model.blocks {
            for pole in block.poles().into_iter().filter(|p| p.im >= 0.0) {
                modes.push(self.mode(model, *block, at, pole, &zeros));
            }
            at += block.order();
        }
        modes.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
        self.modes = modes;
        Ok(self)
    }

    fn mode(&self, model: &Model, block: Block, at: usize, pole: C64, zeros: &[Vec<C64>]) -> PoleEstimate {
        let size = self.covariance[0].nrows();
        let moves = pole_derivative(block, pole);
        let gradient = |part: &dyn Fn(C64) -> f64| -> Vec<f64> {
            let mut g = vec![0.0; size];
            for (i, d) in moves.iter().enumerate() {
                g[at + i] = part(*d);
            }
            g
        };
        let (re, im) = (gradient(&|d| d.re), gradient(&|d| d.im));
        let modulus = pole.norm().max(f64::MIN_POSITIVE);
        // d|p| = Re(conj(p) dp)/|p|;  zeta = -Re p/|p|.
        let frequency = gradient(&|d| (pole.conj() * d).re / modulus);
        let damping = gradient(&|d| -d.re / modulus + pole.re * (pole.conj() * d).re / modulus.powi(3));
        let sd = |which: usize, g: &[f64]| form(&self.covariance[which], g, g).max(0.0).sqrt();
        let covariance = [
            form(&self.covariance[0], &re, &re),
            form(&self.covariance[0], &re, &im),
            form(&self.covariance[0], &im, &im),
        ];
        let residues: Vec<Residue> = (0..model.outputs.len())
            .map(|o| self.residue(model, o, block, at, pole, &moves))
            .collect();
        let spread = covariance[0].max(covariance[2]).max(0.0).sqrt();
        let near_cancellation = zeros
            .iter()
            .zip(&model.outputs)
            .filter(|(zeros, _)| {
                let nearest = zeros
                    .iter()
                    .map(|z| (z - pole).norm())
                    .fold(f64::INFINITY, f64::min);
                nearest < (3.0 * spread).min(0.05 * modulus).max(1e-3 * modulus)
            })
            .map(|(_, output)| output.name.clone())
            .collect();
        let sd_frequency = sd(0, &frequency);
        let identified = sd_frequency <= LARGEST_RELATIVE_SD * modulus
            && residues
                .iter()
                .any(|r| r.modulus > LEAST_RESIDUE_SD * r.sd_modulus);
        PoleEstimate {
            re: pole.re,
            im: pole.im,
            frequency_rad_s: pole.norm(),
            damping_ratio: -pole.re / modulus,
            sd_frequency_rad_s: sd_frequency,
            sd_damping_ratio: sd(0, &damping),
            sd_frequency_coloured_rad_s: sd(1, &frequency),
            sd_damping_ratio_coloured: sd(1, &damping),
            covariance,
            residues,
            identified,
            near_cancellation,
        }
    }

    /// Residue of the block's transfer function at its pole: N(p)/D'(p), N = c1 w^2 + c2 w s or c w.
    fn residue(&self, model: &Model, o: usize, block: Block, at: usize, pole: C64, moves: &[C64]) -> Residue {
        let map = &self.numerators[o];
        let c = &model.coefficients[o][at..at + block.order()];
        let w = block.scale();
        // Value, derivatives with respect to c, and with respect to the block's own parameters.
        let (value, by_c, by_p): (C64, Vec<C64>, Vec<C64>) = match block {
            Block::First { .. } => (
                C64::new(c[0] * w, 0.0),
                vec![C64::new(w, 0.0)],
                vec![C64::new(0.0, 0.0)],
            ),
            Block::Second { a1, .. } => {
                let slope = 2.0 * pole + a1;
                let numerator = c[0] * w * w + c[1] * w * pole;
                let by_p = moves
                    .iter()
                    .enumerate()
                    .map(|(i, dp)| {
                        let da1 = if i == 0 { w } else { 0.0 };
                        (c[1] * w * dp - numerator * (2.0 * dp + da1) / slope) / slope
                    })
                    .collect();
                (numerator / slope, vec![w * w / slope, w * pole / slope], by_p)
            }
        };
        let modulus = value.norm();
        let along = |d: C64| {
            if modulus > 0.0 {
                (value.conj() * d).re / modulus
            } else {
                d.norm()
            }
        };
        let mut gradient = vec![0.0; self.covariance[0].nrows()];
        for (i, d) in by_p.iter().enumerate() {
            gradient[at + i] += along(*d);
        }
        for (i, d) in by_c.iter().enumerate() {
            map.add(at + i, along(*d), &mut gradient);
        }
        Residue {
            output: model.outputs[o].clone(),
            re: value.re,
            im: value.im,
            modulus,
            sd_modulus: form(&self.covariance[0], &gradient, &gradient).max(0.0).sqrt(),
        }
    }

    /// Response of an output with standard deviations; `coloured` takes the residuals as coloured as they are.
    ///
    /// # Errors
    /// [`crate::Error::Mismatch`] for an output that is not there, and for a model with other numbers of outputs or
    /// poles than the one estimated; those of [`Model::evaluate`].
    pub fn band(
        &self,
        model: &Model,
        output: usize,
        omega_rad_s: &[f64],
        coloured: bool,
    ) -> Result<ConfidenceBand> {
        let response = model.frequency_response(output, omega_rad_s)?;
        let (Some(c), Some(map)) = (model.coefficients.get(output), self.numerators.get(output)) else {
            return Err(mismatch(
                "position of an output",
                output,
                format!(
                    "less than {}, the outputs that were estimated",
                    self.numerators.len()
                ),
            ));
        };
        for (what, found, expected) in [
            ("outputs of the model", model.outputs.len(), self.numerators.len()),
            ("poles of the model", c.len(), map.own.nrows()),
        ] {
            if found != expected {
                return Err(mismatch(what, found, format!("{expected}, as were estimated")));
            }
        }
        let covariance = &self.covariance[usize::from(coloured)];
        let (mut sd_magnitude_db, mut sd_phase_deg) = (Vec::new(), Vec::new());
        for (omega, value) in omega_rad_s.iter().zip(&response) {
            let s = C64::new(0.0, *omega);
            let shift = (-s * model.delay).exp();
            let (mut real, mut imaginary) = (vec![0.0; covariance.nrows()], vec![0.0; covariance.nrows()]);
            // Relative changes: ln G = ln|G| + i arg G.
            let mut add = |place: usize, d: C64| {
                let relative = d / value;
                real[place] += relative.re;
                imaginary[place] += relative.im;
            };
            let mut at = 0;
            let mut states = Vec::with_capacity(c.len());
            for block in &model.blocks {
                let x = block.states(s);
                let n = block.order();
                let part: C64 = (0..n).map(|i| x[i] * c[at + i]).sum();
                match block {
                    Block::First { .. } => add(at, -x[0] * part * shift),
                    Block::Second { .. } => {
                        add(at, -x[1] * part * shift);
                        add(at + 1, -x[0] * part * shift);
                    }
                }
                states.extend_from_slice(&x[..n]);
                at += n;
            }
            if let Some(unit) = self.delay_unit {
                add(at, -s * unit * value);
            }
            if map.direct {
                add(map.at + map.own.ncols(), shift);
            }
            for (i, x) in states.iter().enumerate() {
                let relative = x * shift / value;
                map.add(i, relative.re, &mut real);
                map.add(i, relative.im, &mut imaginary);
            }
            let sd = |g: &[f64]| form(covariance, g, g).max(0.0).sqrt();
            sd_magnitude_db.push(20.0 / std::f64::consts::LN_10 * sd(&real));
            sd_phase_deg.push(sd(&imaginary).to_degrees());
        }
        Ok(ConfidenceBand {
            omega_rad_s: omega_rad_s.to_vec(),
            response,
            sd_magnitude_db,
            sd_phase_deg,
        })
    }
}

impl NumeratorMap {
    fn new(problem: &Problem<'_>, fitted: &Fitted, output: usize, n_shared: usize, n_own: usize) -> Self {
        let c = fitted.coefficients(output);
        let tangents = tangents(&fitted.point.blocks, problem.zeros, &c);
        let count = fitted.freedom.count();
        let own = match fitted.freedom.basis() {
            Some(basis) => basis.clone(),
            None => Mat::identity(c.len(), count),
        };
        Self {
            shared: Mat::from_fn(c.len(), n_shared, |i, j| tangents.get(j).map_or(0.0, |t| t[i])),
            own,
            at: n_shared + output * n_own,
            direct: n_own > count,
        }
    }

    /// Adds `factor` times the gradient of coefficient `i`.
    fn add(&self, i: usize, factor: f64, gradient: &mut [f64]) {
        for (j, g) in gradient.iter_mut().enumerate().take(self.shared.ncols()) {
            *g += factor * self.shared[(i, j)];
        }
        for (j, g) in gradient
            .iter_mut()
            .skip(self.at)
            .enumerate()
            .take(self.own.ncols())
        {
            *g += factor * self.own[(i, j)];
        }
    }
}

/// Derivative of a pole with respect to the parameters of its block, in units of its scale.
fn pole_derivative(block: Block, pole: C64) -> Vec<C64> {
    let w = block.scale();
    match block {
        Block::First { .. } => vec![C64::new(-w, 0.0)],
        Block::Second { a1, a0 } => {
            // D(p) = 0: dp = -(p da1 + da0)/(2 p + a1). At a double pole the slope vanishes: a finite stand-in.
            let slope = 2.0 * pole + a1;
            let least = 1e-8 * a0.abs().sqrt().max(a1.abs());
            let slope = if slope.norm() < least {
                C64::new(least, 0.0)
            } else {
                slope
            };
            vec![-w * pole / slope, -w * w / slope]
        }
    }
}

/// g' C h.
fn form(c: &Mat<f64>, g: &[f64], h: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (j, h) in h.iter().enumerate().filter(|(_, h)| **h != 0.0) {
        let column: f64 = g.iter().enumerate().map(|(i, g)| g * c[(i, j)]).sum();
        sum += column * h;
    }
    sum
}

/// (J'J)^-1 from the triangles of the records, each with the places of its columns among all unknowns.
fn inverse_information(triangles: &[(Vec<usize>, Mat<f64>)], unknowns: usize) -> Option<Mat<f64>> {
    let rows: usize = triangles.iter().map(|(_, r)| r.nrows()).sum();
    let mut all = Mat::zeros(rows, unknowns);
    let mut at = 0;
    for (places, r) in triangles {
        for (j, &place) in places.iter().enumerate() {
            for i in 0..r.nrows() {
                all[(at + i, place)] = r[(i, j)];
            }
        }
        at += r.nrows();
    }
    let scale: Vec<f64> = (0..unknowns)
        .map(|j| {
            let norm = all.col(j).norm_l2();
            if norm > 0.0 { 1.0 / norm } else { 1.0 }
        })
        .collect();
    let scaled = Mat::from_fn(rows, unknowns, |i, j| all[(i, j)] * scale[j]);
    let r = triangle(scaled);
    albatross_numerics::matrix::check_finite("the sensitivities", r.as_ref()).ok()?;
    let svd = Svd::new_thin(r.as_ref()).ok()?;
    let count = r.nrows().min(unknowns);
    let largest = (0..count).map(|k| svd.S()[k]).fold(0.0, f64::max);
    if largest == 0.0 || count < unknowns {
        return None;
    }
    let half = Mat::from_fn(unknowns, count, |i, k| {
        scale[i] * svd.V()[(i, k)] / svd.S()[k].max(FLOOR * largest)
    });
    Some(&half * half.transpose())
}

/// J' R J with R the Toeplitz matrix of the residuals' autocorrelation, tapered by Bartlett's window (Newey and West,
/// Econometrica 55, 1987, which keeps the sum positive); residuals scaled by `factor`.
fn coloured(j: &Mat<f64>, residual: &[f64], factor: f64) -> Mat<f64> {
    let n = residual.len();
    let lags = ((4.0 * (n as f64).powf(LAGS_EXPONENT)) as usize).min(n.saturating_sub(1));
    let autocorrelation: Vec<f64> = (0..=lags)
        .map(|lag| {
            let sum: f64 = residual
                .iter()
                .zip(residual.iter().skip(lag))
                .map(|(a, b)| a * b)
                .sum();
            let taper = 1.0 - lag as f64 / (lags + 1) as f64;
            taper * factor * factor * sum / n as f64
        })
        .collect();
    let mut filtered = Mat::zeros(j.nrows(), j.ncols());
    for c in 0..j.ncols() {
        let column = j.col_as_slice(c);
        let to = filtered.col_as_slice_mut(c);
        for (lag, r) in autocorrelation.iter().enumerate() {
            albatross_numerics::matrix::axpy(*r, &column[lag..], &mut to[..n - lag]);
            if lag > 0 {
                albatross_numerics::matrix::axpy(*r, &column[..n - lag], &mut to[lag..]);
            }
        }
    }
    j.transpose() * filtered
}
