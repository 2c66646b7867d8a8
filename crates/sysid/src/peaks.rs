//! Turning points of a time history, ripples passed over.

/// A turning point of a series.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Peak {
    /// Time \[s\].
    pub time: f64,
    /// Value.
    pub value: f64,
}

/// The first `count` turning points, in time, between which the series moves by more than `prominence` times its
/// whole range: ripples on a swing are passed over.
pub fn peaks(time: &[f64], series: &[f64], count: usize, prominence: f64) -> Vec<Peak> {
    let (low, high) = series
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| {
            (l.min(v), h.max(v))
        });
    let threshold = prominence * (high - low);
    let mut found = Vec::new();
    let Some(&first) = series.first() else {
        return found;
    };
    if threshold.is_nan() || threshold <= 0.0 {
        return found;
    }
    // The extreme candidates since the last accepted turning point.
    let (mut lowest, mut highest) = (
        Peak {
            time: 0.0,
            value: first,
        },
        Peak {
            time: 0.0,
            value: first,
        },
    );
    let mut rising: Option<bool> = None;
    for (&time, &value) in time.iter().zip(series) {
        if value > highest.value {
            highest = Peak { time, value };
        }
        if value < lowest.value {
            lowest = Peak { time, value };
        }
        let turned_down = highest.value - value > threshold && rising != Some(false);
        let turned_up = value - lowest.value > threshold && rising != Some(true);
        if turned_down {
            // Leaving the start is no peak.
            if rising.is_some() {
                found.push(highest);
            }
            rising = Some(false);
            lowest = Peak { time, value };
        } else if turned_up {
            if rising.is_some() {
                found.push(lowest);
            }
            rising = Some(true);
            highest = Peak { time, value };
        }
        if found.len() == count {
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A damped oscillation with a ripple: the turning points of the slow part, in turn minimum and maximum.
    #[test]
    fn val_peaks_pass_over_ripples() {
        let time: Vec<f64> = (0..4000).map(|i| f64::from(i) * 1e-3).collect();
        let series: Vec<f64> = time
            .iter()
            .map(|t| -(-0.3 * t).exp() * (3.0 * t).sin() + 0.01 * (80.0 * t).sin())
            .collect();
        let found = peaks(&time, &series, 3, 0.1);
        assert_eq!(found.len(), 3);
        // d/dt = 0 at tan(3 t) = 10: t = 0.4903, then every pi/3.
        for (i, peak) in found.iter().enumerate() {
            let expected = 10.0_f64.atan() / 3.0 + i as f64 * std::f64::consts::PI / 3.0;
            assert!((peak.time - expected).abs() < 0.05, "{peak:?} {expected}");
            assert_eq!(peak.value < 0.0, i % 2 == 0);
        }
    }
}
