//! Peaks of the magnitude of a frequency response, and which peak of one response belongs to which of another.

use albatross_numerics::C64;
use serde::Serialize;

use crate::assignment::assign;
use crate::bode_distance::magnitude_db;
use crate::data::mismatch;
use crate::matching::{frequency_cost, relative_percent};
use crate::{Error, Result};

/// A peak of a magnitude response.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResponsePeak {
    /// Circular frequency, rad/s, interpolated between the points of the grid.
    pub omega_rad_s: f64,
    /// Height there, dB of output per input.
    pub magnitude_db: f64,
    /// Height above the higher of the two valleys that part the peak from higher ground (or, at the ends of the grid,
    /// from the end), dB.
    pub prominence_db: f64,
}

/// Peaks with a prominence of at least `prominence_db` (dB), by ascending frequency.
///
/// The grid must resolve the resonances. Maxima at the ends of the grid are not peaks.
///
/// # Errors
/// [`Error::Mismatch`] for lists of unequal length; [`Error::Domain`] for frequencies that are not positive and
/// ascending, or a response that is zero or not finite.
pub fn response_peaks(
    omega_rad_s: &[f64],
    response: &[C64],
    prominence_db: f64,
) -> Result<Vec<ResponsePeak>> {
    if omega_rad_s.len() != response.len() {
        return Err(mismatch(
            "values of the response",
            response.len(),
            format!("{} as there are frequencies", omega_rad_s.len()),
        ));
    }
    let mut before = 0.0;
    for &omega in omega_rad_s {
        if !(omega.is_finite() && omega > before) {
            return Err(Error::Domain {
                what: "a frequency [rad/s]",
                value: omega,
                expected: "positive frequencies that ascend",
            });
        }
        before = omega;
    }
    let height = response
        .iter()
        .map(|&h| magnitude_db(h))
        .collect::<Result<Vec<_>>>()?;
    Ok((1..height.len().saturating_sub(1))
        .filter(|&i| height[i] > height[i - 1] && height[i] >= height[i + 1])
        .filter_map(|i| {
            let prominence = prominence(&height, i);
            // A step on a rising flank, level with its right neighbour, has none.
            (prominence > 0.0 && prominence >= prominence_db).then(|| {
                let (omega, top) = summit(omega_rad_s, &height, i);
                ResponsePeak {
                    omega_rad_s: omega,
                    magnitude_db: top,
                    prominence_db: prominence + (top - height[i]),
                }
            })
        })
        .collect())
}

/// Height of point `i` over the higher of the lowest points on either side, as far as no point is higher than `i`.
fn prominence(height: &[f64], i: usize) -> f64 {
    let valley = |side: &mut dyn Iterator<Item = &f64>| {
        side.take_while(|&&h| h <= height[i])
            .copied()
            .fold(height[i], f64::min)
    };
    let left = valley(&mut height[..i].iter().rev());
    let right = valley(&mut height[i + 1..].iter());
    height[i] - left.max(right)
}

/// Frequency and height (dB) of the peak at grid point `i`, an inner one.
///
/// Near a resonance `1/|H|^2` is a parabola in `w^2`: exactly for one mode, `(1 - (w/w_n)^2)^2 + (2 zeta w/w_n)^2`. In
/// decibels it is far from one as soon as the grid is as wide as the half-power width.
fn summit(omega_rad_s: &[f64], height_db: &[f64], i: usize) -> (f64, f64) {
    let [x0, x1, x2] = [i - 1, i, i + 1].map(|k| (omega_rad_s[k] / omega_rad_s[i]).powi(2));
    let [y0, y1, y2] = [i - 1, i, i + 1].map(|k| 10.0_f64.powf((height_db[i] - height_db[k]) / 10.0));
    // Newton's form: slopes on both sides of the middle, then their change.
    let (left, right) = ((y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1));
    let curvature = (right - left) / (x2 - x0);
    let slope = left + curvature * (x1 - x0);
    let shift = -0.5 * slope / curvature;
    let (square, least) = (x1 + shift, y1 + 0.5 * slope * shift);
    // Level tops, and a resonance so sharp that its parabola reaches zero between the points.
    if curvature > 0.0 && curvature.is_finite() && square > x0 && square < x2 && least > 0.0 {
        (
            omega_rad_s[i] * square.sqrt(),
            height_db[i] - 10.0 * least.log10(),
        )
    } else {
        (omega_rad_s[i], height_db[i])
    }
}

/// Two peaks that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResponsePeakPair {
    /// Of the response.
    pub response: ResponsePeak,
    /// Of the reference.
    pub reference: ResponsePeak,
    /// `100 |w - w_ref|/w_ref`.
    pub relative_percent: f64,
    /// Height of the response less that of the reference, dB.
    pub height_difference_db: f64,
}

/// Pairs of peaks and what is left over, by ascending frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResponsePeakMatching {
    /// The pairs, by frequency of the reference.
    pub pairs: Vec<ResponsePeakPair>,
    /// Peaks of the response that the reference lacks.
    pub unmatched_response: Vec<ResponsePeak>,
    /// Peaks of the reference that the response lacks.
    pub unmatched_reference: Vec<ResponsePeak>,
}

/// Pairs the peaks of a response with those of a reference: the most pairs whose frequencies differ by at most `gate`
/// (a share of the reference's, 0.15 say), and of these the nearest in log frequency.
pub fn match_response_peaks(
    response: &[ResponsePeak],
    reference: &[ResponsePeak],
    gate: f64,
) -> ResponsePeakMatching {
    let costs: Vec<Vec<Option<f64>>> = response
        .iter()
        .map(|p| {
            reference
                .iter()
                .map(|q| frequency_cost(p.omega_rad_s, q.omega_rad_s, gate))
                .collect()
        })
        .collect();
    let chosen = assign(&costs);
    let mut pairs: Vec<ResponsePeakPair> = response
        .iter()
        .zip(&chosen)
        .filter_map(|(&p, &column)| {
            let q = *reference.get(column?)?;
            Some(ResponsePeakPair {
                response: p,
                reference: q,
                relative_percent: relative_percent(p.omega_rad_s, q.omega_rad_s),
                height_difference_db: p.magnitude_db - q.magnitude_db,
            })
        })
        .collect();
    pairs.sort_by(|a, b| a.reference.omega_rad_s.total_cmp(&b.reference.omega_rad_s));
    let mut alone: Vec<ResponsePeak> = response
        .iter()
        .zip(&chosen)
        .filter(|(_, column)| column.is_none())
        .map(|(&p, _)| p)
        .collect();
    let mut missing: Vec<ResponsePeak> = (0..reference.len())
        .filter(|&j| !chosen.contains(&Some(j)))
        .map(|j| reference[j])
        .collect();
    for list in [&mut alone, &mut missing] {
        list.sort_by(|a, b| a.omega_rad_s.total_cmp(&b.omega_rad_s));
    }
    ResponsePeakMatching {
        pairs,
        unmatched_response: alone,
        unmatched_reference: missing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Band;

    /// Sum of modes (frequency, damping ratio, share) of unit static gain.
    fn modes(grid: &[f64], list: &[(f64, f64, f64)]) -> Vec<C64> {
        grid.iter()
            .map(|&w| {
                list.iter()
                    .map(|&(wn, zeta, share)| share / C64::new(1.0 - (w / wn).powi(2), 2.0 * zeta * w / wn))
                    .sum()
            })
            .collect()
    }

    /// A single mode peaks at w_n sqrt(1 - 2 zeta^2) with 1/(2 zeta sqrt(1 - zeta^2)): exact, also with two points across
    /// the half-power width.
    #[test]
    fn val_single_mode() {
        let grid = Band::default().grid().unwrap();
        for (wn, zeta) in [(1.75, 0.4), (18.95, 0.02), (54.0, 0.005)] {
            let found = response_peaks(&grid, &modes(&grid, &[(wn, zeta, 1.0)]), 1.0).unwrap();
            assert_eq!(found.len(), 1);
            let omega = wn * (1.0 - 2.0 * zeta * zeta).sqrt();
            let height = -20.0 * (2.0 * zeta * (1.0 - zeta * zeta).sqrt()).log10();
            assert!(
                (found[0].omega_rad_s / omega - 1.0).abs() < 1e-9,
                "{found:?} {omega}"
            );
            assert!(
                (found[0].magnitude_db - height).abs() < 1e-6,
                "{found:?} {height}"
            );
            // It stands on its static gain of 0 dB.
            assert!((found[0].prominence_db - height).abs() < 0.06);
        }
    }

    /// Prominences by hand: of the heights 0 5 3 4 1 9 2 (dB), 4 stands 1 over its valley 3, 5 stands 4 over the valley 1
    /// on the side of the higher 9, and 9 stands 7 over the end at 2.
    #[test]
    fn val_prominences() {
        let db = [0.0, 5.0, 3.0, 4.0, 1.0, 9.0, 2.0];
        let height: Vec<f64> = db.to_vec();
        assert_eq!([1, 3, 5].map(|i| prominence(&height, i)), [4.0, 1.0, 7.0]);
        let omega: Vec<f64> = (1..=7).map(f64::from).collect();
        let response: Vec<C64> = db
            .iter()
            .map(|d| C64::new(10.0_f64.powf(d / 20.0), 0.0))
            .collect();
        let count = |least: f64| response_peaks(&omega, &response, least).unwrap().len();
        assert_eq!((count(0.0), count(3.0), count(5.0), count(8.0)), (3, 2, 1, 0));
        // A step on a flank is no peak, a level top is one.
        let level = |db: &[f64]| {
            let response: Vec<C64> = db
                .iter()
                .map(|d| C64::new(10.0_f64.powf(d / 20.0), 0.0))
                .collect();
            response_peaks(&omega[..db.len()], &response, 0.0).unwrap().len()
        };
        assert_eq!(
            (level(&[1.0, 2.0, 2.0, 3.0]), level(&[1.0, 2.0, 2.0, 1.0])),
            (0, 1)
        );
        assert!(matches!(
            response_peaks(&[2.0, 1.0], &response[..2], 0.0),
            Err(Error::Domain { .. })
        ));
        assert!(matches!(
            response_peaks(&omega, &response[..2], 0.0),
            Err(Error::Mismatch { .. })
        ));
    }

    /// The same three modes, moved by 2 % and raised by 6.02 dB, with one more mode: three pairs and one peak over.
    #[test]
    fn val_peaks_of_two_responses() {
        let grid = Band {
            points: 4000,
            ..Band::default()
        }
        .grid()
        .unwrap();
        let reference = modes(&grid, &[(2.0, 0.1, 1.0), (19.0, 0.02, 0.1), (54.0, 0.02, 0.05)]);
        let moved = modes(
            &grid,
            &[
                (2.04, 0.1, 2.0),
                (19.38, 0.02, 0.2),
                (55.08, 0.02, 0.1),
                (80.0, 0.01, 0.05),
            ],
        );
        let found = match_response_peaks(
            &response_peaks(&grid, &moved, 1.0).unwrap(),
            &response_peaks(&grid, &reference, 1.0).unwrap(),
            0.15,
        );
        assert_eq!(found.pairs.len(), 3);
        assert_eq!(
            (found.unmatched_response.len(), found.unmatched_reference.len()),
            (1, 0)
        );
        assert!((found.unmatched_response[0].omega_rad_s - 80.0).abs() < 0.2);
        for pair in &found.pairs {
            assert!((pair.relative_percent - 2.0).abs() < 0.1, "{pair:?}");
            assert!((pair.height_difference_db - 6.02).abs() < 0.3, "{pair:?}");
        }
    }
}
