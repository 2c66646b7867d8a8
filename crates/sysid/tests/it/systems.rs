//! Systems with known parameters, and records of them.

use albatross_lti::{Hold, Signal, StateSpace, simulate};
use albatross_numerics::{C64, Mat};
use albatross_sysid::{DataSet, Experiment, Intersample};

/// Poles and residues: one of each conjugate pair.
#[derive(Debug, Clone)]
pub(crate) struct Modal {
    pub(crate) poles: Vec<C64>,
    pub(crate) residues: Vec<C64>,
}

impl Modal {
    /// A state space in the real modal form: x' = [re im; -im re] x + [2; 0] u, y = [Re r, Im r] x.
    pub(crate) fn state_space(&self) -> StateSpace {
        let n = 2 * self.poles.len();
        let mut a = Mat::zeros(n, n);
        let (mut b, mut c) = (Mat::zeros(n, 1), Mat::zeros(1, n));
        for (k, (p, r)) in self.poles.iter().zip(&self.residues).enumerate() {
            let i = 2 * k;
            (a[(i, i)], a[(i, i + 1)]) = (p.re, p.im);
            (a[(i + 1, i)], a[(i + 1, i + 1)]) = (-p.im, p.re);
            b[(i, 0)] = 2.0;
            (c[(0, i)], c[(0, i + 1)]) = (r.re, r.im);
        }
        StateSpace::unnamed(a, b, c, Mat::zeros(1, 1)).unwrap()
    }
}

/// Ten pairs of an aircraft's longitudinal motion: the short period and elastic modes, damping ratio 0.35 and 0.02 to
/// 0.1, residues of both signs within a decade and a half.
pub(crate) fn ten_pairs(frequencies: [f64; 10], seed: u64) -> Modal {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut poles = Vec::new();
    let mut residues = Vec::new();
    for (i, w) in frequencies.into_iter().enumerate() {
        let zeta: f64 = if i == 0 { 0.35 } else { 0.02 + 0.08 * random.f64() };
        poles.push(C64::new(-zeta * w, w * (1.0 - zeta * zeta).sqrt()));
        let size = 10_f64.powf(1.5 * random.f64()) * if random.bool() { 1.0 } else { -1.0 };
        residues.push(C64::from_polar(1.0, 0.6 * (random.f64() - 0.5)) * size);
    }
    Modal { poles, residues }
}

pub(crate) const FREQUENCIES: [f64; 10] = [1.75, 18.7, 24.0, 32.3, 37.3, 42.8, 54.3, 65.9, 69.6, 73.4];
pub(crate) const UP_TO_92: [f64; 10] = [1.75, 19.6, 24.2, 32.3, 37.3, 42.7, 54.2, 65.9, 73.4, 92.3];

/// Square doublet of one period after half a second of rest.
pub(crate) fn doublet(frequency: f64, samples: usize) -> Vec<f64> {
    let half = (500.0 / frequency).round() as usize;
    (0..samples)
        .map(|k| match k.checked_sub(500) {
            Some(k) if k < half => 1.0,
            Some(k) if k < 2 * half => -1.0,
            _ => 0.0,
        })
        .collect()
}

/// Exact response of a system to a sampled input.
pub(crate) fn response(system: &StateSpace, u: &[f64], dt: f64, hold: Hold) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = u.iter().map(|v| vec![*v]).collect();
    let history = simulate(system, dt, &rows, None, hold).unwrap();
    (0..u.len()).map(|k| history.outputs.row(k)[0]).collect()
}

/// Doublets of 0.5, 3 and 10 Hz, 5 s at 1 kHz, with white noise of a signal-to-noise ratio in dB.
pub(crate) fn doublets(system: &StateSpace, snr_db: Option<f64>, seed: u64) -> DataSet {
    let mut noise = Noise::new(seed);
    let experiments = [0.5, 3.0, 10.0]
        .iter()
        .map(|f| {
            let u = doublet(*f, 5001);
            let mut y = response(system, &u, 1e-3, Hold::Zero);
            if let Some(snr) = snr_db {
                noise.add(&mut y, snr);
            }
            Experiment::new(format!("{f} Hz"), 1e-3, u, vec![y])
        })
        .collect();
    data(experiments)
}

pub(crate) fn data(experiments: Vec<Experiment>) -> DataSet {
    DataSet::try_new(
        Signal::new("u", "1"),
        vec![Signal::new("y", "1")],
        experiments,
        Intersample::Zoh,
    )
    .unwrap()
}

/// Gaussian noise.
pub(crate) struct Noise(fastrand::Rng);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Box and Muller (1958).
    pub(crate) fn next(&mut self) -> f64 {
        let u = 1.0 - self.0.f64();
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * self.0.f64()).cos()
    }

    /// Adds white noise at a ratio of variances in dB; its standard deviation.
    pub(crate) fn add(&mut self, y: &mut [f64], snr_db: f64) -> f64 {
        let n = y.len() as f64;
        let mean = y.iter().sum::<f64>() / n;
        let variance = y.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        let sd = (variance / 10_f64.powf(snr_db / 10.0)).sqrt();
        y.iter_mut().for_each(|v| *v += sd * self.next());
        sd
    }
}
