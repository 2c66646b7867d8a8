//! Input signals: doublet, step, 3-2-1-1, chirp, table.
//!
//! A signal is a function of continuous time with a left and a right limit at its jumps, so that a fixed-step method
//! sees each edge once.

use crate::Error;
use std::f64::consts::TAU;

/// From which side a signal is read at a jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The value just before.
    Left,
    /// The value just after.
    Right,
}

/// Form of the edges of a doublet.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edges {
    /// Jumps.
    #[default]
    Square,
    /// Three times continuously differentiable rises, each a quarter of the period long.
    Smooth,
}

/// An input, as a deviation from trim.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Signal {
    /// Plus, then minus the amplitude, half a period each.
    Doublet {
        /// Amplitude \[unit of the input\].
        amplitude: f64,
        /// Start \[s\].
        start: f64,
        /// Period \[s\].
        period: f64,
        /// Form of the edges.
        edges: Edges,
    },
    /// A jump that stays.
    Step {
        /// Height.
        amplitude: f64,
        /// Time of the jump \[s\].
        start: f64,
    },
    /// Alternating pulses of 3, 2, 1 and 1 units.
    ThreeTwoOneOne {
        /// Amplitude.
        amplitude: f64,
        /// Start \[s\].
        start: f64,
        /// Length of one unit \[s\].
        unit: f64,
    },
    /// A sine whose frequency rises linearly.
    Chirp {
        /// Amplitude.
        amplitude: f64,
        /// Start \[s\].
        start: f64,
        /// Length \[s\].
        duration: f64,
        /// Frequency at the start \[Hz\].
        from_hz: f64,
        /// Frequency at the end \[Hz\].
        to_hz: f64,
    },
    /// Samples, linear between them and held beyond.
    Table {
        /// Times, strictly increasing \[s\].
        time: Vec<f64>,
        /// Values.
        value: Vec<f64>,
    },
}

impl Signal {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::BadSignal`] names the quantity.
    pub fn check(&self) -> Result<(), Error> {
        let positive = |quantity: &'static str, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(Error::BadSignal {
                    quantity,
                    value,
                    expected: "a positive number",
                })
            }
        };
        let finite = |quantity: &'static str, value: f64| {
            if value.is_finite() {
                Ok(())
            } else {
                Err(Error::BadSignal {
                    quantity,
                    value,
                    expected: "a finite number",
                })
            }
        };
        match self {
            Self::Doublet {
                amplitude,
                start,
                period,
                ..
            } => {
                finite("amplitude", *amplitude)?;
                finite("start", *start)?;
                positive("period", *period)
            }
            Self::Step { amplitude, start } => {
                finite("amplitude", *amplitude)?;
                finite("start", *start)
            }
            Self::ThreeTwoOneOne {
                amplitude,
                start,
                unit,
            } => {
                finite("amplitude", *amplitude)?;
                finite("start", *start)?;
                positive("unit", *unit)
            }
            Self::Chirp {
                amplitude,
                start,
                duration,
                from_hz,
                to_hz,
            } => {
                finite("amplitude", *amplitude)?;
                finite("start", *start)?;
                finite("from_hz", *from_hz)?;
                finite("to_hz", *to_hz)?;
                positive("duration", *duration)
            }
            Self::Table { time, value } => {
                if time.is_empty() || time.len() != value.len() {
                    return Err(Error::BadSignal {
                        quantity: "number of values in the table",
                        value: value.len() as f64,
                        expected: "as many values as times, at least one",
                    });
                }
                for (&t, &v) in time.iter().zip(value) {
                    finite("time in the table", t)?;
                    finite("value in the table", v)?;
                }
                match time.windows(2).find(|pair| pair[1] <= pair[0]) {
                    Some(pair) => Err(Error::BadSignal {
                        quantity: "time in the table",
                        value: pair[1],
                        expected: "increasing times",
                    }),
                    None => Ok(()),
                }
            }
        }
    }

    /// Value at `t`, from the given side where the signal jumps. Times within 1e-9 of the signal's own time scale
    /// count as the jump itself.
    pub fn at(&self, t: f64, side: Side) -> f64 {
        match self {
            Self::Doublet {
                amplitude,
                start,
                period,
                edges: Edges::Square,
            } => amplitude * pulses(t - start, 0.5 * period, &[1, 1], side),
            Self::Doublet {
                amplitude,
                start,
                period,
                edges: Edges::Smooth,
            } => amplitude * smooth_doublet((t - start) / period),
            Self::Step { amplitude, start } => {
                let after = before(*start, t, 1.0, side);
                if after { *amplitude } else { 0.0 }
            }
            Self::ThreeTwoOneOne {
                amplitude,
                start,
                unit,
            } => amplitude * pulses(t - start, *unit, &[3, 2, 1, 1], side),
            Self::Chirp {
                amplitude,
                start,
                duration,
                from_hz,
                to_hz,
            } => {
                let s = t - start;
                if s <= 0.0 || s >= *duration {
                    return 0.0;
                }
                amplitude * (TAU * (from_hz + 0.5 * (to_hz - from_hz) * s / duration) * s).sin()
            }
            Self::Table { time, value } => table(time, value, t),
        }
    }
}

/// Whether `edge` lies before `t` as seen from a side; `scale` is the signal's time scale.
fn before(edge: f64, t: f64, scale: f64, side: Side) -> bool {
    if (t - edge).abs() <= 1e-9 * scale.max(t.abs()) {
        side == Side::Right
    } else {
        t > edge
    }
}

/// Alternating pulses that begin at `s = 0` and last `counts` units each, starting positive.
fn pulses(s: f64, unit: f64, counts: &[u32], side: Side) -> f64 {
    let mut edge = 0.0;
    let mut sign = 0.0;
    for (i, &count) in counts.iter().enumerate() {
        if !before(edge, s, unit, side) {
            return sign;
        }
        sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        edge += f64::from(count) * unit;
    }
    if before(edge, s, unit, side) { 0.0 } else { sign }
}

/// A doublet over `0 <= s <= 1` with C3 rises of a quarter period: up, down through zero (half a period), up.
fn smooth_doublet(s: f64) -> f64 {
    let rise = |s: f64| {
        let s = s.clamp(0.0, 1.0);
        let s4 = s * s * s * s;
        s4 * (35.0 - s * (84.0 - s * (70.0 - 20.0 * s)))
    };
    rise(4.0 * s) - 2.0 * rise(4.0 * s - 1.5) + rise(4.0 * s - 3.0)
}

fn table(time: &[f64], value: &[f64], t: f64) -> f64 {
    let after = time.partition_point(|&x| x <= t);
    let at = |i: usize| {
        (
            time.get(i).copied().unwrap_or(0.0),
            value.get(i).copied().unwrap_or(0.0),
        )
    };
    match after {
        0 => at(0).1,
        n if n >= time.len() => at(time.len() - 1).1,
        n => {
            let ((t0, v0), (t1, v1)) = (at(n - 1), at(n));
            v0 + (v1 - v0) * (t - t0) / (t1 - t0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_square_doublet_limits() {
        let d = Signal::Doublet {
            amplitude: 2.0,
            start: 0.5,
            period: 0.2,
            edges: Edges::Square,
        };
        assert_eq!(d.at(0.5, Side::Left), 0.0);
        assert_eq!(d.at(0.5, Side::Right), 2.0);
        assert_eq!(d.at(0.6, Side::Left), 2.0);
        assert_eq!(d.at(0.6, Side::Right), -2.0);
        assert_eq!(d.at(0.7, Side::Left), -2.0);
        assert_eq!(d.at(0.7, Side::Right), 0.0);
        // A time reached by adding steps is the edge too.
        let t = (0..700).fold(0.0, |t: f64, _| t + 0.001);
        assert_eq!(d.at(t, Side::Right), 0.0);
    }

    #[test]
    fn val_three_two_one_one() {
        let s = Signal::ThreeTwoOneOne {
            amplitude: 1.0,
            start: 1.0,
            unit: 0.5,
        };
        let at = |t: f64| s.at(t, Side::Right);
        assert_eq!(
            [at(0.9), at(2.4), at(2.6), at(3.4), at(3.6), at(4.1), at(4.6)],
            [0.0, 1.0, -1.0, -1.0, 1.0, -1.0, 0.0]
        );
    }

    /// A doublet has no mean, and the smooth one reaches its amplitude.
    #[test]
    fn prop_smooth_doublet_is_odd_about_its_middle() {
        for i in 0..=100 {
            let s = f64::from(i) / 200.0;
            assert!((smooth_doublet(0.5 - s) + smooth_doublet(0.5 + s)).abs() < 1e-12);
        }
        assert!((smooth_doublet(0.3) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn val_table_interpolates_and_holds() {
        let s = Signal::Table {
            time: vec![1.0, 2.0],
            value: vec![3.0, 5.0],
        };
        assert_eq!(
            [
                s.at(0.0, Side::Left),
                s.at(1.5, Side::Left),
                s.at(2.0, Side::Left),
                s.at(9.0, Side::Left)
            ],
            [3.0, 4.0, 5.0, 5.0]
        );
        assert!(
            Signal::Table {
                time: vec![1.0, 1.0],
                value: vec![0.0, 0.0]
            }
            .check()
            .is_err()
        );
    }
}
