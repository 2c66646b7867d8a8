//! Models shared by the tests.

use albatross_numerics::{Mat, eigen};
use albatross_strip::kernels::{JONES, Lag};
use albatross_strip::{AeroelasticModel, Split, Strip, StripShapes, StripTheory, Structure};

/// A uniform cantilever wing in bending and torsion (Goland 1945).
#[derive(Debug, Clone, Copy)]
pub(crate) struct UniformWing {
    pub(crate) semi_span: f64,
    pub(crate) chord: f64,
    /// Elastic axis, share of the chord.
    pub(crate) axis: f64,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    /// Static moment about the elastic axis, positive with the centre of gravity aft.
    pub(crate) static_moment: f64,
    pub(crate) bending: f64,
    pub(crate) torsion: f64,
}

impl UniformWing {
    /// Goland's wing with the figures of the oracle's `inputs`.
    pub(crate) fn goland() -> Self {
        Self {
            semi_span: 6.096,
            chord: 1.8288,
            axis: 0.33,
            mass: 35.71,
            inertia: 8.64,
            static_moment: 35.71 * 0.1 * 1.8288,
            bending: 9.77e6,
            torsion: 0.987e6,
        }
    }

    /// Normal modes from `assumed` polynomials each in bending (y^2 P_i) and torsion (y P_i): frequencies, and the
    /// shapes' coefficients.
    fn modes(&self, assumed: usize) -> (Vec<f64>, Mat<f64>) {
        let n = 2 * assumed;
        let length = self.semi_span;
        let (mut mass, mut stiffness) = (Mat::zeros(n, n), Mat::zeros(n, n));
        for (y, weight) in gauss(32, length) {
            let (w, theta) = (self.shape(assumed, y), self.twist(assumed, y));
            for i in 0..assumed {
                for j in 0..assumed {
                    let s = assumed;
                    mass[(i, j)] += weight * self.mass * w[i][0] * w[j][0];
                    mass[(s + i, s + j)] += weight * self.inertia * theta[i][0] * theta[j][0];
                    // A point aft of the axis moves by w - x theta.
                    let coupling = -weight * self.static_moment * w[i][0] * theta[j][0];
                    mass[(i, s + j)] += coupling;
                    mass[(s + j, i)] += coupling;
                    stiffness[(i, j)] += weight * self.bending * w[i][2] * w[j][2];
                    stiffness[(s + i, s + j)] += weight * self.torsion * theta[i][1] * theta[j][1];
                }
            }
        }
        let (squares, modes) = eigen::symmetric_generalized(stiffness.as_ref(), mass.as_ref()).unwrap();
        (squares.into_iter().map(f64::sqrt).collect(), modes)
    }

    pub(crate) fn frequencies(&self, assumed: usize) -> Vec<f64> {
        self.modes(assumed).0
    }

    /// `y^2 P_i` with its first two derivatives.
    fn shape(&self, count: usize, y: f64) -> Vec<[f64; 3]> {
        let scale = 2.0 / self.semi_span;
        legendre(count, scale * y - 1.0)
            .into_iter()
            .map(|[p, d, dd]| {
                let (d, dd) = (scale * d, scale * scale * dd);
                [
                    y * y * p,
                    2.0 * y * p + y * y * d,
                    2.0 * p + 4.0 * y * d + y * y * dd,
                ]
            })
            .collect()
    }

    /// `y P_i` with its derivative.
    fn twist(&self, count: usize, y: f64) -> Vec<[f64; 2]> {
        let scale = 2.0 / self.semi_span;
        legendre(count, scale * y - 1.0)
            .into_iter()
            .map(|[p, d, _]| [y * p, p + y * scale * d])
            .collect()
    }

    /// Strips at `stations` (y, width), the first `n_modes` normal modes.
    pub(crate) fn model(
        &self,
        stations: &[(f64, f64)],
        assumed: usize,
        n_modes: usize,
        lags: &[Lag],
    ) -> AeroelasticModel {
        let (omega, modes) = self.modes(assumed);
        let strips: Vec<Strip> = stations
            .iter()
            .map(|&(y, width)| Strip {
                y,
                z: 0.0,
                width,
                chord: self.chord,
                x_ac: 0.25 * self.chord,
                x_lra: self.axis * self.chord,
                cl_alpha: std::f64::consts::TAU,
                dihedral_rad: 0.0,
            })
            .collect();
        let on_strips = |values: &dyn Fn(f64) -> Vec<f64>, first: usize| {
            Mat::from_fn(strips.len(), n_modes, |j, k| {
                values(stations[j].0)
                    .iter()
                    .enumerate()
                    .map(|(i, v)| v * modes[(first + i, k)])
                    .sum()
            })
        };
        let phi = on_strips(&|y| self.shape(assumed, y).into_iter().map(|w| w[0]).collect(), 0);
        let gamma = on_strips(
            &|y| self.twist(assumed, y).into_iter().map(|t| t[0]).collect(),
            assumed,
        );
        AeroelasticModel::try_new(
            Structure::modal(&vec![1.0; n_modes], &omega[..n_modes], &vec![0.0; n_modes]).unwrap(),
            strips,
            StripShapes::try_new(phi, gamma).unwrap(),
            &StripTheory::default(),
            Split::default(),
            lags,
        )
        .unwrap()
    }

    /// Strips of equal width.
    pub(crate) fn equal_strips(&self, n: usize) -> Vec<(f64, f64)> {
        let width = self.semi_span / n as f64;
        (0..n).map(|j| ((j as f64 + 0.5) * width, width)).collect()
    }
}

/// Legendre polynomials P_0 .. P_(count-1) with two derivatives.
fn legendre(count: usize, x: f64) -> Vec<[f64; 3]> {
    let mut p = vec![[1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    for i in 1..count {
        let (n, [b, db, ddb], [a, da, dda]) = (i as f64, p[i], p[i - 1]);
        let c = (2.0 * n + 1.0) / (n + 1.0);
        let e = n / (n + 1.0);
        p.push([
            c * x * b - e * a,
            c * (b + x * db) - e * da,
            c * (2.0 * db + x * ddb) - e * dda,
        ]);
    }
    p.truncate(count);
    p
}

/// Gauss-Legendre points and weights on 0 .. length.
pub(crate) fn gauss(n: usize, length: f64) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..50 {
                let [p, d, _] = legendre(n + 1, x)[n];
                slope = d;
                x -= p / d;
            }
            (0.5 * length * (1.0 + x), length / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// A small generator of reproducible numbers in 0 .. 1 (xorshift64*).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A tapered wing with invented smooth shapes.
pub(crate) fn invented(seed: u64, n_strips: usize, n_modes: usize, xi: f64) -> AeroelasticModel {
    let mut r = Numbers::new(seed);
    let span = r.between(3.0, 20.0);
    let (root, tip) = (r.between(0.5, 4.0), r.between(0.2, 1.0));
    let (axis, taper_of_axis) = (r.between(0.25, 0.5), r.between(-0.1, 0.3));
    let width = span / n_strips as f64;
    let strips: Vec<Strip> = (0..n_strips)
        .map(|j| {
            let y = (j as f64 + 0.5) * width;
            let chord = root * (1.0 - (1.0 - tip) * y / span);
            Strip {
                y,
                z: 0.0,
                width,
                chord,
                x_ac: 0.25 * chord + taper_of_axis * y,
                x_lra: axis * chord + taper_of_axis * y,
                cl_alpha: std::f64::consts::TAU,
                dihedral_rad: 0.0,
            }
        })
        .collect();
    let mut omega: Vec<f64> = (0..n_modes)
        .map(|k| r.between(5.0, 15.0) * (1.0 + 1.5 * k as f64))
        .collect();
    omega.sort_by(f64::total_cmp);
    let mass = r.between(5.0, 60.0) * span;
    let mixes: Vec<[f64; 4]> = (0..n_modes)
        .map(|_| {
            [
                r.between(-1.0, 1.0),
                r.between(-1.0, 1.0),
                r.between(0.0, 6.3),
                r.between(0.0, 6.3),
            ]
        })
        .collect();
    let shape = |j: usize, k: usize, which: usize| {
        let x = strips[j].y / span;
        let [a, b, c, d] = mixes[k];
        let amplitude = if which == 0 { a } else { b };
        let phase = if which == 0 { c } else { d };
        amplitude * x.powi(2 - which as i32) * ((k as f64 + 1.0) * 1.5 * x + phase).cos()
    };
    let phi = Mat::from_fn(n_strips, n_modes, |j, k| shape(j, k, 0));
    let gamma = Mat::from_fn(n_strips, n_modes, |j, k| shape(j, k, 1));
    AeroelasticModel::try_new(
        Structure::modal(&vec![mass; n_modes], &omega, &vec![xi; n_modes]).unwrap(),
        strips,
        StripShapes::try_new(phi, gamma).unwrap(),
        &StripTheory::default(),
        Split::default(),
        &JONES,
    )
    .unwrap()
}
