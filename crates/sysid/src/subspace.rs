//! Poles by subspace identification: starting values for a search over the output error.
//!
//! Past and future samples are stacked in block-Hankel matrices, those of all experiments side by side. What the
//! future outputs owe to the past, and not to the future inputs, spans the extended observability matrix
//! \[C; C A; C A^2 ...\], and its shift invariance gives A. There is no iteration and no initial value.
//!
//! Sources: M. Verhaegen, P. Dewilde, Int. J. Control 56, 1992, 1187-1241 (MOESP); P. Van Overschee, B. De Moor,
//! Subspace Identification for Linear Systems, 1996, chapters 2 and 4 (N4SID and the weightings).
//!
//! Equations: THEORY (38).

use albatross_numerics::faer::linalg::solvers::Svd;
use albatross_numerics::{C64, Mat, MatRef, eigen, solve};

use crate::thinning::{automatic_factor, thin};
use crate::triangle::Triangle;
use crate::{DataSet, Error, Experiment, Result};

/// Singular values of the inputs and of the past below this part of the largest carry no information.
const NEGLIGIBLE: f64 = 1e-10;

/// Columns of the stacked Hankel matrices that the automatic horizon keeps to.
const WIDEST: usize = 400;

/// Most columns of the past: matrices as large as the square of their number are kept. In messages as well.
const MOST_COLUMNS: usize = 4000;

/// Least magnitude of a discrete pole that is taken at its word, exp(-pi): a real pole at the Nyquist frequency.
const SHORTEST: f64 = 0.043_213_918_263_772_25;

/// What of the past the future outputs are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weighting {
    /// The part of the past that is orthogonal to the future inputs (PO-MOESP).
    #[default]
    Moesp,
    /// The past itself, along the future inputs (N4SID).
    N4sid,
}

/// Choices of [`poles`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SubspaceOptions {
    /// Samples of which one mean is made; `None`: from the spectrum of the outputs and the length of the records.
    pub decimation: Option<usize>,
    /// Block rows of the past, and of the future \[samples after decimation\]; `None`: up to 100, a fifth of the
    /// shortest record.
    pub horizon: Option<usize>,
    /// Weighting of the projection.
    pub weighting: Weighting,
    /// Whether poles in the right half plane are reflected into the left one.
    pub stable: bool,
}

/// Continuous poles and how they were found.
#[derive(Debug, Clone, PartialEq)]
pub struct SubspacePoles {
    /// The poles, as many as asked for, in conjugate pairs \[rad/s\].
    pub poles: Vec<C64>,
    /// Singular values behind the order, descending: a gap after the n-th suggests order n.
    pub singular_values: Vec<f64>,
    /// Samples of which one mean was made.
    pub decimation: usize,
    /// Block rows used.
    pub horizon: usize,
    /// Discrete poles without a continuous one (negative or near zero) that were put at the fast end of the band.
    pub replaced: usize,
}

/// The `np` poles of a linear system that produced the data, all outputs together.
///
/// Offsets of experiments that ask for them are projected out like a further input.
///
/// # Errors
/// Those of [`DataSet::check`]; [`Error::Order`] without poles or with as many as the horizon or more,
/// [`Error::ShortRecord`], [`Error::Constant`] when the input or every output stands still, [`Error::NoModel`] when the
/// data span fewer directions than poles are asked for, [`Error::Domain`] for a factor or a horizon of zero and for a
/// horizon beyond 2000 (in proportion less for several outputs), [`Error::Numerics`].
pub fn poles(data: &DataSet, np: usize, options: &SubspaceOptions) -> Result<SubspacePoles> {
    data.check()?;
    check_moving(data)?;
    let order = || Error::Order {
        poles: np,
        zeros: 0,
        expected: "a subspace method gives at least one pole, and fewer than its horizon",
    };
    if np == 0 || np > data.samples() {
        return Err(order());
    }
    let positive = |what, value: Option<usize>| match value {
        Some(0) => Err(Error::Domain {
            what,
            value: 0.0,
            expected: "at least 1",
        }),
        other => Ok(other),
    };
    let decimation = positive("the decimation factor", options.decimation)?;
    let decimation = decimation.unwrap_or_else(|| automatic_factor(data));
    let thinned = thin(data, decimation)?;
    let horizon = positive("the horizon", options.horizon)?.unwrap_or_else(|| horizon(&thinned, np));
    let layout = Layout::new(&thinned, horizon);
    if np + layout.outputs > layout.future() {
        return Err(order());
    }
    check_length(&thinned, np, decimation, &layout)?;
    if layout.past() > MOST_COLUMNS {
        return Err(Error::Domain {
            what: "the horizon",
            value: horizon as f64,
            expected: "at most 2000 for one output, and less for several: horizon x (1 + outputs) at most 4000",
        });
    }

    let r = stack(&thinned, &layout);
    let (observability, singular_values) = observability(r.as_ref(), &layout, options.weighting)?;
    if observability.ncols() < np {
        return Err(Error::NoModel {
            poles: np,
            zeros: 0,
            starts: 1,
            reason: format!(
                "the past of the data has {} independent directions: lower the order or add data",
                observability.ncols()
            ),
        });
    }
    let gamma = observability.subcols(0, np);
    let kept = layout.future() - layout.outputs;
    let a = solve::least_squares(gamma.subrows(0, kept), gamma.subrows(layout.outputs, kept))?;
    let discrete = eigen::eigenvalues(a.as_ref())?;
    let (poles, replaced) = continuous(&discrete, thinned.dt(), options.stable);
    Ok(SubspacePoles {
        poles,
        singular_values,
        decimation,
        horizon,
        replaced,
    })
}

/// Columns of the stacked matrix: future inputs and constants, past inputs and outputs, future outputs.
struct Layout {
    horizon: usize,
    outputs: usize,
    constants: usize,
}

impl Layout {
    fn new(data: &DataSet, horizon: usize) -> Self {
        Self {
            horizon,
            outputs: data.outputs.len(),
            constants: data.experiments.iter().filter(|e| e.estimate_offset).count(),
        }
    }

    fn known(&self) -> usize {
        self.horizon + self.constants
    }

    fn past(&self) -> usize {
        self.horizon * (1 + self.outputs)
    }

    fn future(&self) -> usize {
        self.horizon.saturating_mul(self.outputs)
    }

    fn width(&self) -> usize {
        self.known() + self.past() + self.future()
    }
}

fn check_moving(data: &DataSet) -> Result<()> {
    let still = |values: &[f64]| values.iter().all(|v| Some(v) == values.first());
    let constant = |signal: &str| Error::Constant {
        experiment: data.names(),
        signal: signal.to_owned(),
        samples: data.samples(),
    };
    if data.experiments.iter().all(|e| still(&e.input)) {
        return Err(constant(&data.input.name));
    }
    let dead = data.experiments.iter().flat_map(|e| &e.outputs).all(|y| still(y));
    match data.outputs.first() {
        Some(output) if dead => Err(constant(&output.name)),
        _ => Ok(()),
    }
}

/// A fifth of the shortest record leaves as many windows as there are unknown rows; not less than the order needs.
fn horizon(data: &DataSet, np: usize) -> usize {
    let outputs = data.outputs.len();
    let shortest = data.experiments.iter().map(Experiment::len).min().unwrap_or(0);
    let most = (WIDEST / (2 + 2 * outputs)).min(100);
    (shortest / 5).min(most).max(np.div_ceil(outputs.max(1)) + 2)
}

fn check_length(data: &DataSet, np: usize, decimation: usize, layout: &Layout) -> Result<()> {
    let after = match decimation {
        0 | 1 => String::new(),
        factor => format!(" left after means of {factor}"),
    };
    let error = |experiment: String, samples, needed| Error::ShortRecord {
        experiment,
        samples,
        after: after.clone(),
        poles: np,
        horizon: layout.horizon,
        needed,
    };
    let window = layout.horizon.saturating_mul(2);
    if let Some(short) = data.experiments.iter().find(|e| e.len() < window) {
        return Err(error(short.name.clone(), short.len(), window));
    }
    // The windows must leave something beside all inputs in them and the states.
    let windows: usize = data.experiments.iter().map(|e| e.len() + 1 - window).sum();
    let needed = window + layout.constants + 2 * np;
    if windows < needed {
        let samples = data.samples();
        return Err(error(data.names(), samples, samples - windows + needed));
    }
    Ok(())
}

/// Triangle of the transposed Hankel matrices, one row a window, signals scaled to unit mean square.
fn stack(data: &DataSet, layout: &Layout) -> Mat<f64> {
    let scale = |signals: &mut dyn Iterator<Item = &Vec<f64>>| {
        let (mut energy, mut count) = (0.0, 0);
        for signal in signals {
            energy += signal.iter().map(|v| v * v).sum::<f64>();
            count += signal.len();
        }
        if energy > 0.0 {
            (count as f64 / energy).sqrt()
        } else {
            1.0
        }
    };
    let input_scale = scale(&mut data.experiments.iter().map(|e| &e.input));
    let output_scales: Vec<f64> = (0..layout.outputs)
        .map(|i| scale(&mut data.experiments.iter().filter_map(|e| e.outputs.get(i))))
        .collect();
    let s = layout.horizon;
    let mut triangle = Triangle::new(layout.width());
    let mut row = Vec::with_capacity(layout.width());
    let mut constants = 0..;
    for experiment in &data.experiments {
        let constant = if experiment.estimate_offset {
            constants.next()
        } else {
            None
        };
        for window in 0..(experiment.len() + 1).saturating_sub(2 * s) {
            let (past, future) = (window..window + s, window + s..window + 2 * s);
            row.clear();
            row.extend(experiment.input[future.clone()].iter().map(|u| input_scale * u));
            row.extend((0..layout.constants).map(|c| f64::from(u8::from(constant == Some(c)))));
            row.extend(experiment.input[past.clone()].iter().map(|u| input_scale * u));
            for range in [past, future] {
                // Block rows: all outputs of one time together.
                for k in range {
                    row.extend(
                        (experiment.outputs.iter().zip(&output_scales)).map(|(y, scale)| scale * y[k]),
                    );
                }
            }
            triangle.push(&row);
        }
    }
    triangle.finish()
}

/// Left singular vectors of the projection, (horizon x outputs) x rank, and all its singular values.
///
/// The triangle stands for the data, whose columns it has up to a rotation. Directions are dropped by their
/// singular values, because a doublet leaves many block rows without input: an orthogonal basis of all columns, as
/// the plain algorithm takes it, would project out as many arbitrary directions of the data.
fn observability(r: MatRef<'_, f64>, layout: &Layout, weighting: Weighting) -> Result<(Mat<f64>, Vec<f64>)> {
    let (known, past, future) = (layout.known(), layout.past(), layout.future());
    // Rows below are what the future outputs have of their own.
    let rows = known + past;
    let inputs = r.submatrix(0, 0, known, known);
    let w = r.submatrix(0, known, rows, past);
    let y = r.submatrix(0, known + past, rows, future);

    let span = significant(inputs)?.0;
    let beside = |m: MatRef<'_, f64>| {
        let mut rest = m.to_owned();
        let top = m.subrows(0, known);
        let along = &span * (span.transpose() * top);
        for j in 0..m.ncols() {
            for i in 0..known {
                rest[(i, j)] -= along[(i, j)];
            }
        }
        rest
    };
    let (w_beside, y_beside) = (beside(w), beside(y));
    let (u, s, v) = significant(w_beside.as_ref())?;
    let projected = u.transpose() * &y_beside;
    let projection = match weighting {
        Weighting::Moesp => projected,
        Weighting::N4sid => {
            let scaled = Mat::from_fn(s.len(), future, |i, j| projected[(i, j)] / s[i]);
            w * (v * scaled)
        }
    };
    let svd = decompose(projection.as_ref())?;
    let count = projection.nrows().min(projection.ncols());
    let values = (0..count).map(|k| svd.S()[k]).collect();
    Ok((svd.V().to_owned(), values))
}

/// Singular vectors and values that matter: left, values, right.
fn significant(a: MatRef<'_, f64>) -> Result<(Mat<f64>, Vec<f64>, Mat<f64>)> {
    let svd = decompose(a)?;
    let values: Vec<f64> = (0..a.nrows().min(a.ncols())).map(|k| svd.S()[k]).collect();
    let largest = values.first().copied().unwrap_or(0.0);
    let kept: Vec<f64> = values.into_iter().filter(|s| *s > NEGLIGIBLE * largest).collect();
    let n = kept.len();
    Ok((
        svd.U().subcols(0, n).to_owned(),
        kept,
        svd.V().subcols(0, n).to_owned(),
    ))
}

fn decompose(a: MatRef<'_, f64>) -> Result<Svd<f64>> {
    Svd::new_thin(a).map_err(|_| {
        Error::Numerics(albatross_numerics::Error::NoConvergence {
            what: "the singular values",
            size: a.ncols(),
        })
    })
}

/// ln(z)/dt with a place for every z, and how many had to be given one.
fn continuous(discrete: &[C64], dt: f64, stable: bool) -> (Vec<C64>, usize) {
    let mut replaced = 0;
    let poles = discrete
        .iter()
        .map(|&z| {
            let s = if z.im == 0.0 && z.re <= SHORTEST {
                // Apart from each other, since equal poles would make their residues indeterminate.
                replaced += 1;
                C64::new(-std::f64::consts::PI / (1.0 + 0.3 * (replaced - 1) as f64), 0.0)
            } else if z.norm() < SHORTEST {
                replaced += 1;
                C64::new(SHORTEST.ln(), z.arg())
            } else {
                z.ln()
            };
            let s = s / dt;
            if stable && s.re >= 0.0 {
                // A pole on the axis would never decay.
                C64::new(-s.re.max(1e-3 * s.norm()), s.im)
            } else {
                s
            }
        })
        .collect();
    (poles, replaced)
}

#[cfg(test)]
mod tests {
    use albatross_lti::{Hold, Signal, StateSpace, simulate};

    use super::*;
    use crate::Intersample;
    use crate::arx::tests::gaussian;

    /// Parallel modes of given frequency (rad/s) and damping, one row of participations an output.
    fn modal(modes: &[(f64, f64)], outputs: &[&[f64]]) -> StateSpace {
        let n = 2 * modes.len();
        let a = Mat::from_fn(n, n, |i, j| {
            let (omega, zeta) = modes[i / 2];
            match (i % 2, j % 2) {
                _ if i / 2 != j / 2 => 0.0,
                (0, 0) => 0.0,
                (0, _) => omega,
                (_, 0) => -omega,
                _ => -2.0 * zeta * omega,
            }
        });
        let b = Mat::from_fn(n, 1, |i, _| (i % 2) as f64);
        let c = Mat::from_fn(
            outputs.len(),
            n,
            |i, j| if j % 2 == 1 { outputs[i][j / 2] } else { 0.0 },
        );
        StateSpace::unnamed(a, b, c, Mat::zeros(outputs.len(), 1)).unwrap()
    }

    /// A square doublet of a frequency in Hz, starting after half a second.
    fn doublet(frequency: f64, dt: f64, duration: f64) -> Vec<f64> {
        let n = (duration / dt).round() as usize;
        (0..n)
            .map(|k| (k as f64 * dt - 0.5 + 1e-9) * frequency)
            .map(|phase| {
                if !(0.0..1.0).contains(&phase) {
                    0.0
                } else if phase < 0.5 {
                    1.0
                } else {
                    -1.0
                }
            })
            .collect()
    }

    fn record(system: &StateSpace, input: Vec<f64>, dt: f64) -> Experiment {
        let rows: Vec<Vec<f64>> = input.iter().map(|u| vec![*u]).collect();
        let table = simulate(system, dt, &rows, None, Hold::Zero).unwrap().outputs;
        let outputs = (0..table.cols())
            .map(|j| (0..table.rows()).map(|k| table.row(k)[j]).collect())
            .collect();
        Experiment::new(format!("record of {}", input.len()), dt, input, outputs)
    }

    fn joined(experiments: Vec<Experiment>) -> DataSet {
        let outputs = (1..=experiments[0].outputs.len())
            .map(|i| Signal::new(format!("y{i}"), "1"))
            .collect();
        DataSet::try_new(Signal::new("u", "1"), outputs, experiments, Intersample::Zoh).unwrap()
    }

    fn doublets(system: &StateSpace) -> DataSet {
        joined(
            [0.5, 3.0, 10.0]
                .map(|f| record(system, doublet(f, 0.001, 5.0), 0.001))
                .to_vec(),
        )
    }

    /// Largest distance of a pole from the nearest one found, over its modulus.
    fn distance(modes: &[(f64, f64)], found: &[C64]) -> f64 {
        modes
            .iter()
            .map(|&(omega, zeta)| {
                let exact = C64::new(-zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
                let nearest = found
                    .iter()
                    .map(|p| (p - exact).norm())
                    .fold(f64::INFINITY, f64::min);
                nearest / omega
            })
            .fold(0.0, f64::max)
    }

    const FLEXIBLE: [(f64, f64); 5] = [
        (1.75, 0.35),
        (18.7, 0.06),
        (24.0, 0.02),
        (32.3, 0.1),
        (37.3, 0.04),
    ];

    fn with_noise(data: &DataSet, level: f64, seed: u64) -> DataSet {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut noisy = data.clone();
        for output in noisy.experiments.iter_mut().flat_map(|e| &mut e.outputs) {
            let rms = (output.iter().map(|y| y * y).sum::<f64>() / output.len() as f64).sqrt();
            let noise = gaussian(&mut random, output.len());
            output
                .iter_mut()
                .zip(noise)
                .for_each(|(y, e)| *y += level * rms * e);
        }
        noisy
    }

    const STABLE: SubspaceOptions = SubspaceOptions {
        decimation: None,
        horizon: None,
        weighting: Weighting::Moesp,
        stable: true,
    };

    /// Three doublets of 5 s at 1 kHz without noise: means of nine samples, a horizon of 0.9 s.
    #[test]
    fn val_poles_of_lightly_damped_systems_from_doublets() {
        let four = poles(&doublets(&modal(&FLEXIBLE[..2], &[&[1.0, 0.4]])), 4, &STABLE).unwrap();
        assert_eq!((four.poles.len(), four.replaced), (4, 0));
        assert!(distance(&FLEXIBLE[..2], &four.poles) < 1e-3);
        assert!(
            (5..=10).contains(&four.decimation) && four.horizon == 100,
            "{four:?}"
        );

        let data = doublets(&modal(&FLEXIBLE, &[&[1.0, 0.4, 0.3, 0.5, 0.2]]));
        let ten = poles(&data, 10, &STABLE).unwrap();
        assert!(distance(&FLEXIBLE, &ten.poles) < 0.01, "{ten:?}");
        // On the raster of the doublets' edges the free responses alone remain, and the method is exact.
        let on_raster = SubspaceOptions {
            decimation: Some(10),
            ..STABLE
        };
        let exact = poles(&data, 10, &on_raster).unwrap();
        assert!(distance(&FLEXIBLE, &exact.poles) < 1e-6);
        let gap = exact.singular_values[10] / exact.singular_values[9];
        assert!(gap < 1e-8, "{gap}");
        let n4sid = SubspaceOptions {
            weighting: Weighting::N4sid,
            ..on_raster
        };
        assert!(distance(&FLEXIBLE, &poles(&data, 10, &n4sid).unwrap().poles) < 1e-6);
    }

    /// Noise at -40 dB on every record.
    #[test]
    fn val_poles_under_noise_are_starting_values() {
        let data = doublets(&modal(&FLEXIBLE, &[&[1.0, 0.4, 0.3, 0.5, 0.2]]));
        for seed in 0..5 {
            let noisy = with_noise(&data, 0.01, seed);
            for np in [10, 14] {
                let found = poles(&noisy, np, &STABLE).unwrap();
                assert_eq!(found.poles.len(), np);
                assert!(found.poles.iter().all(|p| p.re < 0.0));
                let error = distance(&FLEXIBLE, &found.poles);
                assert!(error < 0.03, "{seed} {np}: {error}");
            }
        }
    }

    /// Modes that each output sees only in part; a random input sampled slowly, which is not thinned.
    #[test]
    fn val_several_outputs_share_their_poles() {
        let system = modal(&FLEXIBLE[..3], &[&[1.0, 0.4, 0.0], &[0.0, 0.1, -0.6]]);
        let mut random = fastrand::Rng::with_seed(31);
        let records = [600, 450].map(|n| record(&system, gaussian(&mut random, n), 0.03));
        let found = poles(&joined(records.to_vec()), 6, &STABLE).unwrap();
        assert_eq!((found.decimation, found.horizon), (1, 66));
        assert!(distance(&FLEXIBLE[..3], &found.poles) < 1e-8, "{found:?}");
    }

    #[test]
    fn val_offsets_are_projected_out() {
        let system = modal(&FLEXIBLE[..2], &[&[1.0, 0.4]]);
        let mut data = doublets(&system);
        for (experiment, offset) in data.experiments.iter_mut().zip([0.3, -0.1, 0.05]) {
            experiment.outputs[0].iter_mut().for_each(|y| *y += offset);
        }
        assert!(distance(&FLEXIBLE[..2], &poles(&data, 4, &STABLE).unwrap().poles) > 0.02);
        data.experiments.iter_mut().for_each(|e| e.estimate_offset = true);
        assert!(distance(&FLEXIBLE[..2], &poles(&data, 4, &STABLE).unwrap().poles) < 1e-3);
    }

    #[test]
    fn prop_every_discrete_pole_gets_a_distinct_continuous_one() {
        let z = [-0.3, 0.0, 1e-9, 0.5, 1.5].map(|re| C64::new(re, 0.0));
        let (poles, replaced) = continuous(&z, 0.1, true);
        assert_eq!((poles.len(), replaced), (5, 3));
        assert!(poles.iter().all(|p| p.re < 0.0 && p.is_finite()));
        for i in 0..5 {
            assert!(
                poles[..i].iter().all(|p| (p - poles[i]).norm() > 0.1),
                "{poles:?}"
            );
        }
        assert!(continuous(&z, 0.1, false).0[4].re > 0.0);
    }

    #[test]
    fn val_unusable_data_are_refused() {
        let system = modal(&FLEXIBLE[..2], &[&[1.0, 0.4]]);
        let mut random = fastrand::Rng::with_seed(32);
        let short = joined(vec![record(&system, gaussian(&mut random, 60), 0.02)]);
        let horizon = |horizon| SubspaceOptions {
            horizon: Some(horizon),
            ..STABLE
        };
        assert!(matches!(
            poles(&short, 4, &horizon(31)),
            Err(Error::ShortRecord {
                samples: 60,
                needed: 62,
                ..
            })
        ));
        assert!(matches!(
            poles(&short, 4, &horizon(20)),
            Err(Error::ShortRecord {
                samples: 60,
                needed: 87,
                ..
            })
        ));
        assert!(poles(&short, 4, &STABLE).is_ok());
        assert!(matches!(poles(&short, 4, &horizon(4)), Err(Error::Order { .. })));
        assert!(matches!(poles(&short, 0, &STABLE), Err(Error::Order { .. })));
        assert!(matches!(poles(&short, 4, &horizon(0)), Err(Error::Domain { .. })));
        let still = joined(vec![record(&system, vec![0.0; 100], 0.02)]);
        assert!(matches!(poles(&still, 4, &STABLE), Err(Error::Constant { .. })));
    }
}
