//! How far two frequency responses are apart over a band.
//!
//! The paper chooses its transfer functions by fit and by likeness of the Bode plots to those of the linearised model
//! (section 4.2, 0.1 to 95 rad/s). Here likeness is a number: the root mean square of the difference of magnitude in
//! decibels and of phase in degrees, over a grid with equal steps of log frequency, so that every octave counts alike
//! unless weights say otherwise.

use albatross_lti::{StateSpace, frequency_response};
use albatross_numerics::C64;
use serde::Serialize;

use crate::data::mismatch;
use crate::{Error, Result};

/// A band of frequencies and how finely it is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Band {
    /// Lower end, rad/s; 0.1 unless told.
    pub low_rad_s: f64,
    /// Upper end, rad/s; 95 unless told.
    pub high_rad_s: f64,
    /// Points of the grid, both ends included; 1000 unless told, 0.7 % from point to point: three points across the
    /// half-power width of a mode with 1 % damping.
    pub points: usize,
}

impl Default for Band {
    fn default() -> Self {
        Self {
            low_rad_s: 0.1,
            high_rad_s: 95.0,
            points: 1000,
        }
    }
}

/// Most points of a grid: 80 MB of frequencies.
const MOST_POINTS: usize = 10_000_000;

impl Band {
    /// Circular frequencies (rad/s) in equal steps of their logarithm.
    ///
    /// # Errors
    /// [`Error::Domain`] unless `0 < low < high` and there are two to ten million points.
    pub fn grid(&self) -> Result<Vec<f64>> {
        let domain = |what, value, expected| Error::Domain {
            what,
            value,
            expected,
        };
        let (low, high) = (self.low_rad_s, self.high_rad_s);
        if !(low.is_finite() && low > 0.0) {
            return Err(domain(
                "the lower end of the band [rad/s]",
                low,
                "a positive number",
            ));
        }
        if !(high.is_finite() && high > low) {
            return Err(domain(
                "the upper end of the band [rad/s]",
                high,
                "more than the lower end",
            ));
        }
        if self.points < 2 {
            return Err(domain(
                "the number of frequencies",
                self.points as f64,
                "at least 2",
            ));
        }
        if self.points > MOST_POINTS {
            return Err(domain(
                "the number of frequencies",
                self.points as f64,
                "at most 10000000",
            ));
        }
        let last = self.points - 1;
        let ratio = (high / low).ln();
        Ok((0..self.points)
            .map(|i| match i {
                0 => low,
                _ if i == last => high,
                _ => low * (ratio * i as f64 / last as f64).exp(),
            })
            .collect())
    }
}

/// Distance of a response from a reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BodeDistance {
    /// Root mean square of the difference of magnitude, dB.
    pub rms_magnitude_db: f64,
    /// Mean difference of magnitude, dB: positive if the response lies above the reference.
    pub mean_magnitude_db: f64,
    /// Root mean square of the difference of phase, every difference taken in -180 to 180 deg.
    pub rms_phase_deg: f64,
    /// Points that count.
    pub points: usize,
}

/// Distance between two responses given on the same frequencies, each point with its weight (1 without `weights`).
///
/// Weights are those of squares: with an energy spectrum of the input ([`energy_spectrum`]), the band that the input
/// excites decides. Points of weight 0 do not count.
///
/// # Errors
/// [`Error::Mismatch`] for lists of unequal length or if no point counts; [`Error::Domain`] for a response that is zero
/// or not finite at a point that counts, or a weight that is negative or not finite.
pub fn bode_distance(response: &[C64], reference: &[C64], weights: Option<&[f64]>) -> Result<BodeDistance> {
    let n = reference.len();
    for (what, length) in [
        ("frequencies of the response", Some(response.len())),
        ("weights of frequencies", weights.map(<[f64]>::len)),
    ] {
        if let Some(length) = length.filter(|&length| length != n) {
            return Err(mismatch(what, length, format!("{n} as the reference has")));
        }
    }
    let (mut sum, mut db, mut db2, mut phase2, mut points) = (0.0, 0.0, 0.0, 0.0, 0);
    for (i, (&h, &r)) in response.iter().zip(reference).enumerate() {
        let weight = weights.and_then(|w| w.get(i)).copied().unwrap_or(1.0);
        if !(weight.is_finite() && weight >= 0.0) {
            return Err(Error::Domain {
                what: "the weight of a frequency",
                value: weight,
                expected: "a number that is not negative",
            });
        }
        if weight == 0.0 {
            continue;
        }
        let magnitude = magnitude_db(h)? - magnitude_db(r)?;
        let phase = wrapped_deg((h.arg() - r.arg()).to_degrees());
        sum += weight;
        db += weight * magnitude;
        db2 += weight * magnitude * magnitude;
        phase2 += weight * phase * phase;
        points += 1;
    }
    if points == 0 {
        return Err(mismatch(
            "frequencies that count",
            "none",
            "at least one with a positive weight",
        ));
    }
    Ok(BodeDistance {
        rms_magnitude_db: (db2 / sum).sqrt(),
        mean_magnitude_db: db / sum,
        rms_phase_deg: (phase2 / sum).sqrt(),
        points,
    })
}

/// Distance of a system with one input and one output from another over a band; `weights` belong to [`Band::grid`].
///
/// # Errors
/// [`Error::Mismatch`] for a system with several channels (select one first); [`Error::Lti`] where a response has no
/// value; those of [`Band::grid`] and [`bode_distance`].
pub fn state_space_distance(
    system: &StateSpace,
    reference: &StateSpace,
    band: &Band,
    weights: Option<&[f64]>,
) -> Result<BodeDistance> {
    let grid = band.grid()?;
    bode_distance(
        &siso_response(system, &grid)?,
        &siso_response(reference, &grid)?,
        weights,
    )
}

/// Response of a system with one input and one output at circular frequencies in rad/s.
///
/// # Errors
/// [`Error::Mismatch`] for a system with several channels; [`Error::Lti`].
pub fn siso_response(system: &StateSpace, omega_rad_s: &[f64]) -> Result<Vec<C64>> {
    let channels = (system.inputs.len(), system.outputs.len());
    if channels != (1, 1) {
        return Err(mismatch(
            "channels of a system",
            format!("{} inputs and {} outputs", channels.0, channels.1),
            "one input and one output: select them by name",
        ));
    }
    let response = frequency_response(system, omega_rad_s)?;
    Ok(response.values.iter().map(|h| h[(0, 0)]).collect())
}

/// Energy spectrum `|U(i w)|^2` of a sampled input at circular frequencies in rad/s, held between samples
/// `dt` seconds apart; in the input's unit squared times s squared.
///
/// # Errors
/// [`Error::Domain`] for a sample time that is not positive.
pub fn energy_spectrum(input: &[f64], dt: f64, omega_rad_s: &[f64]) -> Result<Vec<f64>> {
    if !(dt.is_finite() && dt > 0.0) {
        return Err(Error::Domain {
            what: "the sample time [s]",
            value: dt,
            expected: "a positive number",
        });
    }
    Ok(omega_rad_s
        .iter()
        .map(|&omega| {
            // Horner's rule in exp(-i w dt) over the samples, and the transform of one held sample.
            let turn = C64::from_polar(1.0, -omega * dt);
            let sum = input
                .iter()
                .rev()
                .fold(C64::new(0.0, 0.0), |sum, &u| sum * turn + u);
            let half = 0.5 * omega * dt;
            let held = if half == 0.0 { dt } else { dt * half.sin() / half };
            (sum * held).norm_sqr()
        })
        .collect())
}

/// 20 log10 of the magnitude.
pub(crate) fn magnitude_db(h: C64) -> Result<f64> {
    let magnitude = h.norm();
    if magnitude.is_finite() && magnitude > 0.0 {
        Ok(20.0 * magnitude.log10())
    } else {
        Err(Error::Domain {
            what: "the magnitude of a response",
            value: magnitude,
            expected: "a positive number, since it is compared in decibels",
        })
    }
}

/// The representative within 180 deg of zero.
fn wrapped_deg(angle: f64) -> f64 {
    angle - 360.0 * (angle / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use albatross_lti::{Signal, Zpk};
    use albatross_numerics::Mat;

    fn system(gain: f64, poles: &[C64]) -> StateSpace {
        Zpk::try_new(vec![], poles.to_vec(), gain)
            .unwrap()
            .to_state_space(Signal::new("u", ""), Signal::new("y", ""))
            .unwrap()
    }

    fn pair(omega: f64, zeta: f64) -> [C64; 2] {
        let p = C64::new(-zeta * omega, omega * (1.0 - zeta * zeta).sqrt());
        [p, p.conj()]
    }

    #[test]
    fn val_grid_ends_and_ratio() {
        let band = Band::default();
        let grid = band.grid().unwrap();
        assert_eq!((grid[0], grid[999], grid.len()), (0.1, 95.0, 1000));
        let ratio = 950.0_f64.powf(1.0 / 999.0);
        assert!(grid.windows(2).all(|w| (w[1] / w[0] / ratio - 1.0).abs() < 1e-13));
        for (low, high, points) in [(0.0, 1.0, 10), (2.0, 1.0, 10), (1.0, f64::NAN, 10), (1.0, 2.0, 1)] {
            let band = Band {
                low_rad_s: low,
                high_rad_s: high,
                points,
            };
            assert!(matches!(band.grid(), Err(Error::Domain { .. })));
        }
    }

    /// Twice the gain is 20 log10 2 = 6.0206 dB at every frequency; the opposite sign is 180 deg, a turn of 350 deg is -10.
    #[test]
    fn val_constant_differences() {
        let grid = Band::default().grid().unwrap();
        let reference = siso_response(&system(3.0, &pair(20.0, 0.01)), &grid).unwrap();
        let scaled: Vec<C64> = reference.iter().map(|h| h * -2.0).collect();
        let d = bode_distance(&scaled, &reference, None).unwrap();
        assert!((d.rms_magnitude_db - 6.020_599_913_279_624).abs() < 1e-12);
        assert!((d.mean_magnitude_db - 6.020_599_913_279_624).abs() < 1e-12);
        assert!((d.rms_phase_deg - 180.0).abs() < 1e-12);
        let turned: Vec<C64> = reference
            .iter()
            .map(|h| h * C64::from_polar(1.0, 350.0_f64.to_radians()))
            .collect();
        let d = bode_distance(&turned, &reference, None).unwrap();
        assert!((d.rms_phase_deg - 10.0).abs() < 1e-10 && d.rms_magnitude_db < 1e-12);
    }

    /// Against integrals in closed form: 1/(s + 1) and 1 over x = ln w from -L to L. The difference of magnitude is
    /// -10 log10(1 + e^2x), whose integral needs int ln(1 + e^2x) dx = L^2 + pi^2/12 - e^-2L. That of phase is -a,
    /// a = atan e^x; by symmetry the mean square of a is pi^2/8 minus the mean of a (pi/2 - a), whose integral over all x
    /// is 7 zeta(3)/4, less pi e^-L - e^-2L outside the band.
    #[test]
    fn val_first_order_lag() {
        const ZETA_3: f64 = 1.202_056_903_159_594;
        use std::f64::consts::{LN_10, PI};
        let band = Band {
            low_rad_s: 0.01,
            high_rad_s: 100.0,
            points: 20_001,
        };
        let grid = band.grid().unwrap();
        let lag: Vec<C64> = grid.iter().map(|&w| C64::new(1.0, w).inv()).collect();
        let one = vec![C64::new(1.0, 0.0); grid.len()];
        let d = bode_distance(&lag, &one, None).unwrap();
        let l = 100.0_f64.ln();
        let mean = -10.0 / LN_10 * (l * l + PI * PI / 12.0 - 1e-4) / (2.0 * l);
        // The ends of the grid weigh as much as other points: 1/20000 of half their values.
        assert!((d.mean_magnitude_db - mean).abs() < 1e-3, "{d:?} {mean}");
        let square = PI * PI / 8.0 - (7.0 * ZETA_3 / 4.0 - PI * 0.01 + 1e-4) / (2.0 * l);
        assert!(
            (d.rms_phase_deg.to_radians().powi(2) - square).abs() < 1e-4,
            "{d:?} {square}"
        );
    }

    /// The gain moved by 1 dB, seen through two systems.
    #[test]
    fn val_distance_of_systems() {
        let poles = pair(20.0, 0.02);
        let louder = system(10.0_f64.powf(0.05), &poles);
        let d = state_space_distance(&louder, &system(1.0, &poles), &Band::default(), None).unwrap();
        assert!((d.rms_magnitude_db - 1.0).abs() < 1e-10 && d.rms_phase_deg < 1e-10 && d.points == 1000);
    }

    /// With two weights the rms is the weighted one; a zero weight hides a zero response.
    #[test]
    fn val_weights() {
        let one = C64::new(1.0, 0.0);
        let found = bode_distance(
            &[one * 10.0, one * 0.1, one * 0.0],
            &[one; 3],
            Some(&[3.0, 1.0, 0.0]),
        )
        .unwrap();
        assert!((found.mean_magnitude_db - 10.0).abs() < 1e-12);
        assert!((found.rms_magnitude_db - 20.0).abs() < 1e-12);
        assert_eq!(found.points, 2);
        let refused = |h: &[C64], w: Option<&[f64]>| bode_distance(h, &[one; 2], w).unwrap_err();
        assert!(matches!(refused(&[one], None), Error::Mismatch { .. }));
        assert!(matches!(refused(&[one; 2], Some(&[1.0])), Error::Mismatch { .. }));
        assert!(matches!(
            refused(&[one; 2], Some(&[0.0; 2])),
            Error::Mismatch { .. }
        ));
        assert!(matches!(
            refused(&[one; 2], Some(&[1.0, -1.0])),
            Error::Domain { .. }
        ));
        assert!(matches!(refused(&[one, one * 0.0], None), Error::Domain { .. }));
    }

    /// Doublet of amplitude A and period T: |U| = 4 A sin^2(w T/4)/w, exactly, as its edges lie on samples. Its nulls are
    /// at w = 4 pi/T: a 0.5 Hz doublet does not excite 1 Hz.
    #[test]
    fn val_spectrum_of_a_doublet() {
        let (dt, half) = (1e-3, 1000);
        let input: Vec<f64> = (0..5000)
            .map(|i| match i {
                _ if i < half => 2.0,
                _ if i < 2 * half => -2.0,
                _ => 0.0,
            })
            .collect();
        let omega = [0.3, 1.0, 2.5, std::f64::consts::TAU, 40.0];
        let found = energy_spectrum(&input, dt, &omega).unwrap();
        for (w, found) in omega.iter().zip(&found) {
            let expected = (8.0 * (0.5 * w).sin().powi(2) / w).powi(2);
            assert!((found - expected).abs() < 1e-10, "{w} {found} {expected}");
        }
        assert!(found[3] < 1e-20);
        assert_eq!(energy_spectrum(&[1.0, 2.0], 0.5, &[0.0]).unwrap(), [2.25]);
        assert!(energy_spectrum(&input, 0.0, &omega).is_err());
    }

    #[test]
    fn val_several_channels_are_refused() {
        let zeros = |rows, columns| Mat::<f64>::zeros(rows, columns);
        let two = StateSpace::unnamed(zeros(1, 1), zeros(1, 2), zeros(1, 1), zeros(1, 2)).unwrap();
        let error = siso_response(&two, &[1.0]).unwrap_err();
        assert!(error.to_string().contains("2 inputs and 1 outputs"), "{error}");
    }
}
