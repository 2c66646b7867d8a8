//! Roots along the wave number, and between which wave numbers they change sides.

use super::Bracket;
use crate::Error;
use crate::kernels::Kernel;
use crate::operator::ModalOperator;
use albatross_numerics::faer::linalg::solvers::{PartialPivLu, Solve};
use albatross_numerics::{C64, Mat};

/// Reduced frequencies between which is searched, on the narrowest and the widest strip.
const HIGHEST_K: f64 = 200.0;
const LOWEST_K: f64 = 1e-4;
/// Where flutter is to be expected, and the steps of ln kappa there and elsewhere.
const USUAL_K: [f64; 2] = [5.0, 0.01];
const USUAL_STEP: f64 = 0.04;
const WIDE_STEP: f64 = 0.12;
/// Steps are not halved below this.
const LEAST_STEP: f64 = 1e-3;
const MOST_STATIONS: usize = 1500;
/// Changes of side beyond this number for each mode are rounding, and to refine them all would take minutes.
const MOST_BRACKETS: usize = 50;
/// Chords that differ by more make the range of wave numbers too long to be searched.
const LARGEST_CHORD_RATIO: f64 = 1e6;
/// Real parts below this share of the modulus are rounding.
const NEUTRAL: f64 = 1e-10;

struct Station {
    ln_kappa: f64,
    roots: Vec<C64>,
}

impl Station {
    fn at(modal: &ModalOperator, kernel: Kernel<'_>, ln_kappa: f64) -> Result<Self, Error> {
        Ok(Self {
            ln_kappa,
            roots: roots(modal, kernel, ln_kappa.exp())?,
        })
    }
}

/// Frequencies of roots that grow at the highest wave number, and brackets of all changes of side below it.
pub(super) fn scan(modal: &ModalOperator, kernel: Kernel<'_>) -> Result<(Vec<f64>, Vec<Bracket>), Error> {
    let mut stations = grid(&modal.operator.semi_chords)?
        .into_iter()
        .map(|ln_kappa| Station::at(modal, kernel, ln_kappa))
        .collect::<Result<Vec<_>, _>>()?;
    while stations.len() < MOST_STATIONS {
        let unclear = unclear_intervals(&stations);
        if unclear.iter().all(|split| !split) {
            break;
        }
        let mut refined = Vec::with_capacity(2 * stations.len());
        let mut following = stations.into_iter().peekable();
        let mut split = unclear.into_iter();
        while let Some(station) = following.next() {
            let middle = following
                .peek()
                .filter(|_| split.next().unwrap_or(false))
                .map(|next| 0.5 * (station.ln_kappa + next.ln_kappa));
            refined.push(station);
            if let Some(middle) = middle {
                refined.push(Station::at(modal, kernel, middle)?);
            }
        }
        stations = refined;
    }
    let mut at_rest: Vec<f64> = stations.first().map_or_else(Vec::new, |first| {
        first
            .roots
            .iter()
            .filter(|p| p.im > 0.0 && side(**p) > 0)
            .map(|p| p.im)
            .collect()
    });
    at_rest.sort_by(f64::total_cmp);
    let brackets: Vec<Bracket> = stations
        .windows(2)
        .flat_map(|pair| match pair {
            [a, b] => changes_of_side(a, b),
            _ => Vec::new(),
        })
        .collect();
    if brackets.len() > MOST_BRACKETS * modal.n_elastic() {
        return Err(Error::BadOption {
            option: "the number of wave numbers at which a root changes its side of the imaginary axis",
            value: brackets.len() as f64,
            expected: "at most 50 for each mode: more is rounding; check the units of lift slopes, masses and frequencies",
        });
    }
    Ok((at_rest, brackets))
}

/// Logarithms of the wave numbers to start with, descending.
fn grid(semi_chords: &[f64]) -> Result<Vec<f64>, Error> {
    let narrowest = semi_chords.iter().copied().fold(f64::INFINITY, f64::min);
    let widest = semi_chords.iter().copied().fold(0.0, f64::max);
    let ratio = widest / narrowest;
    let ends = [HIGHEST_K / narrowest, LOWEST_K / widest];
    if !(ratio <= LARGEST_CHORD_RATIO && ends.iter().all(|k| k.is_normal())) {
        return Err(Error::BadOption {
            option: "the ratio of the widest to the narrowest chord",
            value: ratio,
            expected: "at most 1e6, of chords in metres; correct the strip table",
        });
    }
    let (end, usual) = (
        (LOWEST_K / widest).ln(),
        (USUAL_K[1] / widest).ln()..=(USUAL_K[0] / narrowest).ln(),
    );
    let mut grid = vec![(HIGHEST_K / narrowest).ln()];
    while let Some(&last) = grid.last()
        && last > end
    {
        let step = if usual.contains(&last) {
            USUAL_STEP
        } else {
            WIDE_STEP
        };
        grid.push(last - step);
    }
    Ok(grid)
}

/// Roots p of `p^2 A + p D + K`, rigid-body modes' zeros left out.
///
/// With `K = S^2`, `y = S q` and `z = p q` both halves of the companion matrix carry the stiffness alike:
/// `p y = S z`, `p z = -A^-1 (S y + D z)`. Without damping `-p^2` are the eigenvalues of `S A^-1 S`.
pub(super) fn roots(modal: &ModalOperator, kernel: Kernel<'_>, kappa: f64) -> Result<Vec<C64>, Error> {
    let operator = &modal.operator;
    let (n, n_elastic) = (operator.n(), modal.n_elastic());
    let a = operator.apparent_mass(kappa, kernel);
    if !a.norm_max().is_finite() {
        return Err(Error::BadFlow {
            quantity: "the aerodynamic matrix at this density",
            value: a.norm_max(),
        });
    }
    let s = |k: usize| modal.omega[k];
    let damped = operator.damping.norm_max() > 0.0;
    let right = Mat::from_fn(n, if damped { n_elastic + n } else { n_elastic }, |k, l| {
        if l >= n_elastic {
            C64::from(operator.damping[(k, l - n_elastic)])
        } else if k == l {
            C64::from(s(k))
        } else {
            C64::new(0.0, 0.0)
        }
    });
    let solved = PartialPivLu::new(a.as_ref()).solve(&right);
    let matrix = if damped {
        // Coordinates y and z of a mode stand side by side, so that the matrix is graded by frequency.
        let places: Vec<(bool, usize)> = (0..n)
            .flat_map(|k| [(k < n_elastic).then_some((true, k)), Some((false, k))])
            .flatten()
            .collect();
        Mat::from_fn(n + n_elastic, n + n_elastic, |i, j| {
            match (places[i], places[j]) {
                ((true, k), (false, l)) if k == l => C64::from(s(k)),
                ((true, _), _) => C64::new(0.0, 0.0),
                ((false, k), (true, l)) => -solved[(k, l)],
                ((false, k), (false, l)) => -solved[(k, n_elastic + l)],
            }
        })
    } else {
        Mat::from_fn(n_elastic, n_elastic, |k, l| s(k) * solved[(k, l)])
    };
    if (0..matrix.ncols()).any(|j| (0..matrix.nrows()).any(|i| !matrix[(i, j)].is_finite())) {
        // The apparent mass is singular here, which happens at isolated wave numbers only.
        return Ok(Vec::new());
    }
    let values = matrix
        .eigenvalues()
        .map_err(|_| albatross_numerics::Error::NoConvergence {
            what: "the eigenproblem at a wave number",
            size: matrix.nrows(),
        })?;
    let lowest = modal.omega[..n_elastic]
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    Ok(if damped {
        values.into_iter().filter(|p| p.norm() > 1e-9 * lowest).collect()
    } else {
        values
            .into_iter()
            .flat_map(|square| {
                let p = (-square).sqrt();
                [p, -p]
            })
            .collect()
    })
}

/// Which side of the imaginary axis: -1 decays, 1 grows, 0 neither.
fn side(p: C64) -> i8 {
    if p.re.abs() <= NEUTRAL * p.norm() {
        0
    } else if p.re > 0.0 {
        1
    } else {
        -1
    }
}

/// Damping as the sine of the angle to the imaginary axis.
fn slant(p: C64) -> f64 {
    p.re / p.norm()
}

/// Roots whose side matters: oscillatory with positive frequency.
fn oscillates(p: C64) -> bool {
    p.im > 0.0 && slant(p).abs() < 0.5
}

fn nearest(p: C64, among: &[C64]) -> Option<usize> {
    (0..among.len()).min_by(|&i, &j| (among[i] - p).norm().total_cmp(&(among[j] - p).norm()))
}

fn changes_of_side(a: &Station, b: &Station) -> Vec<Bracket> {
    let kappa = [a.ln_kappa.exp(), b.ln_kappa.exp()];
    let forward = a
        .roots
        .iter()
        .filter_map(|&p| nearest(p, &b.roots).map(|j| [p, b.roots[j]]));
    let backward = b
        .roots
        .iter()
        .filter_map(|&p| nearest(p, &a.roots).map(|i| [a.roots[i], p]));
    let mut found: Vec<Bracket> = Vec::new();
    for p in forward.chain(backward) {
        let relevant = p[0].im > 0.0 && p[1].im > 0.0 && (oscillates(p[0]) || oscillates(p[1]));
        if relevant && side(p[0]) != side(p[1]) && !found.iter().any(|known| known.p == p) {
            found.push(Bracket { kappa, p });
        }
    }
    found
}

/// Intervals between neighbouring stations in which the course of a root near the axis is not clear.
fn unclear_intervals(stations: &[Station]) -> Vec<bool> {
    let mut split = vec![false; stations.len().saturating_sub(1)];
    let width = |i: usize| match (stations.get(i), stations.get(i + 1)) {
        (Some(a), Some(b)) => a.ln_kappa - b.ln_kappa,
        _ => 0.0,
    };
    for (i, pair) in stations.windows(2).enumerate() {
        if let [a, b] = pair {
            split[i] = width(i) > LEAST_STEP && (ambiguous(a, b) || ambiguous(b, a));
        }
    }
    for (i, three) in stations.windows(3).enumerate() {
        let [a, b, c] = three else { continue };
        let turns = b.roots.iter().any(|&p| {
            oscillates(p) && {
                let before = nearest(p, &a.roots).map(|k| a.roots[k]);
                let after = nearest(p, &c.roots).map(|k| c.roots[k]);
                match (before, after) {
                    (Some(before), Some(after)) => {
                        may_touch_axis([before, p, after].map(slant), [width(i), width(i + 1)])
                    }
                    _ => false,
                }
            }
        });
        if turns {
            for k in [i, i + 1] {
                split[k] |= width(k) > LEAST_STEP;
            }
        }
    }
    split
}

/// Whether a root of `a` near the axis has moved far, has no mutual successor, or came by a root on another side.
fn ambiguous(a: &Station, b: &Station) -> bool {
    a.roots.iter().enumerate().any(|(i, &p)| {
        if !oscillates(p) {
            return false;
        }
        let Some(next) = nearest(p, &b.roots).map(|j| b.roots[j]) else {
            return true;
        };
        let moved = (next - p).norm();
        if moved > 0.3 * p.norm() {
            return true;
        }
        let mutual = nearest(next, &a.roots).is_some_and(|k| (a.roots[k] - p).norm() <= 1e-9 * p.norm());
        let sides = [side(p), side(next)];
        let by_another_side =
            a.roots.iter().enumerate().any(|(k, &other)| {
                k != i && (other - p).norm() < 1.5 * moved && !sides.contains(&side(other))
            });
        (!mutual && sides[0] != sides[1]) || by_another_side
    })
}

/// Whether a parabola through three values has its extremum between them and close to or beyond zero, while the
/// values themselves stay on one side.
fn may_touch_axis(slants: [f64; 3], widths: [f64; 2]) -> bool {
    let [a, b, c] = slants;
    if !(a * b > 0.0 && b * c > 0.0) || b.abs() > a.abs() || b.abs() > c.abs() {
        return false;
    }
    let (h, g) = (widths[0], widths[1]);
    // Newton's form about b: s(x) = b + slope x + curvature x^2, x = -h at a, g at c.
    let curvature = ((c - b) / g - (b - a) / h) / (h + g);
    let slope = (b - a) / h + curvature * h;
    let extremum = b - 0.25 * slope * slope / curvature;
    // The margin allows for what the parabola neglects.
    let margin = 0.5 * (a.abs().max(c.abs()) - b.abs());
    extremum * b.signum() < margin
}
