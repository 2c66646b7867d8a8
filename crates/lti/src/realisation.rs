//! State space of zeros, poles and gain: second-order sections in series.

use albatross_numerics::{C64, Mat, eigen};

use crate::polynomial::conjugate_pairs;
use crate::zpk::Zpk;
use crate::{Error, Result, Signal, StateSpace};

/// One or two poles with up to as many zeros; numerator and denominator are monic.
#[derive(Debug, Clone)]
struct Section {
    poles: Poles,
    zeros: Vec<C64>,
}

#[derive(Debug, Clone, Copy)]
enum Poles {
    /// sigma +- i omega.
    Pair(C64),
    Two(f64, f64),
    One(f64),
}

impl Section {
    fn order(&self) -> usize {
        if matches!(self.poles, Poles::One(_)) { 1 } else { 2 }
    }

    fn room(&self) -> usize {
        self.order() - self.zeros.len()
    }

    fn distance(&self, zero: C64) -> f64 {
        match self.poles {
            Poles::Pair(p) => (p - C64::new(zero.re, zero.im.abs())).norm(),
            Poles::Two(p, q) => (zero - p).norm().min((zero - q).norm()),
            Poles::One(p) => (zero - p).norm(),
        }
    }

    /// A, b, c, d with the poles on the diagonal (real) or in a 2 x 2 block (complex), and b = (0, 1).
    fn matrices(&self) -> (Mat<f64>, Mat<f64>, Mat<f64>, f64) {
        // Monic numerator with `order` zeros, or a lower one: n2 s^2 + n1 s + n0.
        let [n2, n1, n0] = match self.zeros.as_slice() {
            [] => [0.0, 0.0, 1.0],
            [z] => [0.0, 1.0, -z.re],
            [y, z, ..] => [1.0, -(y + z).re, (y * z).re],
        };
        match self.poles {
            Poles::One(p) => {
                // (n1 s + n0)/(s - p) = n1 + (n0 + n1 p)/(s - p)
                let one = Mat::from_fn(1, 1, |_, _| 1.0);
                (
                    Mat::from_fn(1, 1, |_, _| p),
                    one,
                    Mat::from_fn(1, 1, |_, _| n0 + n1 * p),
                    n1,
                )
            }
            Poles::Two(p, q) => {
                let side = p.abs().max(q.abs()).max(f64::MIN_POSITIVE);
                let (r1, r0) = (n1 + n2 * (p + q), n0 - n2 * p * q);
                block([p, side, 0.0, q], [(r0 + r1 * p) / side, r1], n2)
            }
            Poles::Pair(p) => {
                let side = p.norm();
                let (r1, r0) = (n1 + n2 * 2.0 * p.re, n0 - n2 * p.norm_sqr());
                block(
                    [p.re, side, -p.im * p.im / side, p.re],
                    [(r0 + r1 * p.re) / side, r1],
                    n2,
                )
            }
        }
    }
}

fn block(a: [f64; 4], c: [f64; 2], d: f64) -> (Mat<f64>, Mat<f64>, Mat<f64>, f64) {
    let b = Mat::from_fn(2, 1, |i, _| i as f64);
    (
        Mat::from_fn(2, 2, |i, j| a[2 * i + j]),
        b,
        Mat::from_fn(1, 2, |_, j| c[j]),
        d,
    )
}

/// The sections in series, slow poles first, the gain spread evenly over them.
pub(crate) fn cascade(zpk: &Zpk, input: Signal, output: Signal) -> Result<StateSpace> {
    if zpk.zeros.len() > zpk.poles.len() {
        return Err(Error::Improper {
            zeros: zpk.zeros.len(),
            poles: zpk.poles.len(),
        });
    }
    let sections = sections(zpk)?;
    let share = zpk.gain.abs().powf(1.0 / sections.len().max(1) as f64);
    let mut chain: Option<StateSpace> = None;
    for section in &sections {
        let (a, b, c, d) = section.matrices();
        let c = Mat::from_fn(1, c.ncols(), |_, j| share * c[(0, j)]);
        let next = StateSpace::unnamed(a, b, c, Mat::from_fn(1, 1, |_, _| share * d))?;
        chain = Some(match chain {
            None => next,
            Some(chain) => chain.series(&next)?,
        });
    }
    let gain = |k: f64| {
        StateSpace::unnamed(
            Mat::zeros(0, 0),
            Mat::zeros(0, 1),
            Mat::zeros(1, 0),
            Mat::from_fn(1, 1, |_, _| k),
        )
    };
    let mut system = match chain {
        Some(mut chain) => {
            let sign = if zpk.gain < 0.0 { -1.0 } else { 1.0 };
            chain.c = Mat::from_fn(1, chain.c.ncols(), |_, j| sign * chain.c[(0, j)]);
            chain.d[(0, 0)] *= sign;
            chain
        }
        None => gain(zpk.gain)?,
    };
    balance_with_channel(&mut system);
    system.states = (1..=system.states.len())
        .map(|i| Signal::new(format!("x{i}"), "1"))
        .collect();
    (system.inputs, system.outputs) = (vec![input], vec![output]);
    Ok(system)
}

/// Poles in sections, each with the zeros nearest to it that fit.
fn sections(zpk: &Zpk) -> Result<Vec<Section>> {
    let (pole_pairs, mut real_poles) = conjugate_pairs("poles", &zpk.poles)?;
    let (zero_pairs, real_zeros) = conjugate_pairs("zeros", &zpk.zeros)?;
    real_poles.sort_by(|p, q| p.abs().total_cmp(&q.abs()));
    let real = real_poles.chunks(2).map(|chunk| match chunk {
        [p, q] => Poles::Two(*p, *q),
        [p] | [p, ..] => Poles::One(*p),
        [] => Poles::One(0.0),
    });
    let mut sections: Vec<Section> = pole_pairs
        .into_iter()
        .map(Poles::Pair)
        .chain(real)
        .map(|poles| Section {
            poles,
            zeros: Vec::new(),
        })
        .collect();
    for z in zero_pairs {
        place(&mut sections, &[z, z.conj()]);
    }
    for z in real_zeros {
        place(&mut sections, &[C64::new(z, 0.0)]);
    }
    let slowness = |s: &Section| s.distance(C64::new(0.0, 0.0));
    sections.sort_by(|p, q| slowness(p).total_cmp(&slowness(q)));
    Ok(sections)
}

/// Zeros never outnumber poles and pairs go first, so there is always a section with room.
fn place(sections: &mut [Section], zeros: &[C64]) {
    let nearest = sections
        .iter_mut()
        .filter(|s| s.room() >= zeros.len())
        .min_by(|p, q| p.distance(zeros[0]).total_cmp(&q.distance(zeros[0])));
    if let Some(section) = nearest {
        section.zeros.extend_from_slice(zeros);
    }
}

/// Scales the states by powers of two so that inputs, states and outputs couple evenly.
fn balance_with_channel(system: &mut StateSpace) {
    let n = system.states.len();
    let whole = Mat::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
        (true, true) => system.a[(i, j)],
        (true, false) => system.b[(i, 0)],
        (false, true) => system.c[(0, j)],
        (false, false) => 0.0,
    });
    // With the last scale factor left in place the channel itself is unchanged.
    let (_, scaling) = eigen::balance(whole.as_ref());
    let channel = scaling[n];
    let factor: Vec<f64> = scaling[..n].iter().map(|d| d / channel).collect();
    for (i, f) in factor.iter().enumerate() {
        system.b[(i, 0)] /= f;
        system.c[(0, i)] *= f;
        for (j, g) in factor.iter().enumerate() {
            system.a[(i, j)] *= g / f;
        }
    }
}
