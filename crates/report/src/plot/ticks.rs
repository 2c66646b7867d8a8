//! Where the ticks of an axis stand and what is written beside them.
//!
//! A tick is an integer multiple of a step `m·10^e` with a small integer `m`. Positions and labels both come
//! from the integers, so that 0.3 reads `0.3` and never `0.30000000000000004`.

/// Distance between ticks: `mantissa · 10^exponent`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Step {
    pub(crate) mantissa: i64,
    pub(crate) exponent: i32,
}

/// A tolerance of this part of a step decides that a tick stands exactly on a limit.
const ON_LIMIT: f64 = 1e-9;

impl Step {
    pub(crate) fn value(self) -> f64 {
        self.multiple(1)
    }

    /// `k` steps from zero, the nearest double to the decimal number.
    fn multiple(self, k: i64) -> f64 {
        let whole = (k * self.mantissa) as f64;
        if self.exponent < 0 {
            whole / 10f64.powi(-self.exponent)
        } else {
            whole * 10f64.powi(self.exponent)
        }
    }

    /// First and last multiple inside an interval. Axes span at least 1e-10 of their values, far from the bound.
    fn range(self, low: f64, high: f64) -> (i64, i64) {
        const BOUND: f64 = 1e13;
        let multiple = |part: f64| part.clamp(-BOUND, BOUND) as i64;
        let step = self.value();
        (
            multiple((low / step - ON_LIMIT).ceil()),
            multiple((high / step + ON_LIMIT).floor()),
        )
    }

    fn count(self, low: f64, high: f64) -> usize {
        let (first, last) = self.range(low, high);
        usize::try_from(last - first + 1).unwrap_or(0)
    }
}

/// A labelled position on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

/// The ticks of an axis. All labels are to be multiplied by `10^exponent`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    pub(crate) major: Vec<Tick>,
    pub(crate) minor: Vec<f64>,
    pub(crate) step: Option<Step>,
    pub(crate) exponent: i32,
}

/// Steps of 1, 2 and 5 times a power of ten.
fn decimal_steps(span: f64, most: usize) -> impl Iterator<Item = Step> {
    // Beyond the exponents of doubles there is nothing to step through: a span of nothing, or more than doubles hold.
    let first = (span / most as f64).log10().floor().clamp(-400.0, 400.0) as i32 - 1;
    (first..first + 6).flat_map(|exponent| [1, 2, 5].map(|mantissa| Step { mantissa, exponent }))
}

/// Whole steps for angles: multiples of 45 deg.
const DEGREES: [i64; 12] = [
    45, 90, 180, 360, 720, 1440, 3600, 7200, 14_400, 36_000, 72_000, 144_000,
];

/// Whole steps for decibels: 20 dB is a factor of ten.
const DECIBELS: [i64; 10] = [1, 2, 5, 10, 20, 40, 60, 100, 200, 500];

/// All multiples of a 1-2-5 step in the interval, at most `most` (two or more).
pub(crate) fn linear(low: f64, high: f64, most: usize) -> Ticks {
    let most = most.max(2);
    let step = decimal_steps(high - low, most).find(|step| step.count(low, high) <= most);
    multiples(step, low, high, true)
}

/// Multiples of 45 deg; of a 1-2-5 step where the interval holds less than two of them.
pub(crate) fn degrees(low: f64, high: f64, most: usize) -> Ticks {
    listed(&DEGREES, low, high, most)
}

/// Multiples of 10, 20, 40, … dB where the interval is long enough.
pub(crate) fn decibels(low: f64, high: f64, most: usize) -> Ticks {
    listed(&DECIBELS, low, high, most)
}

fn listed(mantissas: &[i64], low: f64, high: f64, most: usize) -> Ticks {
    let most = most.max(2);
    let step = mantissas
        .iter()
        .map(|mantissa| Step {
            mantissa: *mantissa,
            exponent: 0,
        })
        .find(|step| step.count(low, high) <= most)
        .filter(|step| step.count(low, high) >= 2);
    if step.is_some() {
        multiples(step, low, high, false)
    } else {
        linear(low, high, most)
    }
}

fn multiples(step: Option<Step>, low: f64, high: f64, with_exponent: bool) -> Ticks {
    let Some(step) = step else {
        return Ticks {
            major: Vec::new(),
            minor: Vec::new(),
            step: None,
            exponent: 0,
        };
    };
    let (first, last) = step.range(low, high);
    let largest = step.multiple(first).abs().max(step.multiple(last).abs());
    let exponent = if with_exponent {
        common_exponent(largest)
    } else {
        0
    };
    let major = (first..=last)
        .map(|k| Tick {
            value: step.multiple(k),
            label: decimal(k * step.mantissa, step.exponent - exponent),
        })
        .collect();
    Ticks {
        major,
        minor: Vec::new(),
        step: Some(step),
        exponent,
    }
}

/// Power of ten (a multiple of three) taken out of labels that would be long: none from 0.01 to 99 999.
fn common_exponent(largest: f64) -> i32 {
    if largest == 0.0 || (0.01..1e5).contains(&largest) {
        0
    } else {
        3 * (largest.log10() / 3.0).floor() as i32
    }
}

/// The decimal number `digits · 10^exponent`, with a typographic minus and thin spaces from five digits on.
fn decimal(digits: i64, exponent: i32) -> String {
    let sign = if digits < 0 { "\u{2212}" } else { "" };
    let mut whole = digits.unsigned_abs().to_string();
    let mut fraction = String::new();
    if let Ok(zeros) = usize::try_from(exponent) {
        if digits != 0 {
            whole += &"0".repeat(zeros);
        }
    } else {
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        let padded = format!("{whole:0>width$}", width = decimals + 1);
        let (front, back) = padded.split_at(padded.len() - decimals);
        fraction = format!(".{back}");
        whole = front.to_owned();
    }
    format!("{sign}{}{fraction}", grouped(&whole))
}

/// Groups of three digits from five digits on, after the ISO custom: 1500, 15 000.
fn grouped(whole: &str) -> String {
    if whole.len() < 5 {
        return whole.to_owned();
    }
    let mut out = String::new();
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            out.push('\u{2009}');
        }
        out.push(digit);
    }
    out
}

/// Powers of ten in a positive interval, at most `most`; 1-2-5 or all digits between them where the interval
/// has less than two.
pub(crate) fn logarithmic(low: f64, high: f64, most: usize) -> Ticks {
    let most = most.max(2);
    let first = (low.log10() - ON_LIMIT).ceil() as i32;
    let last = (high.log10() + ON_LIMIT).floor() as i32;
    let decades = usize::try_from(last - first + 1).unwrap_or(0);
    let inside = |value: f64| value >= low * (1.0 - ON_LIMIT) && value <= high * (1.0 + ON_LIMIT);
    let between = |digits: &[i64]| -> Vec<(i64, i32)> {
        (first - 1..=last)
            .flat_map(|decade| digits.iter().map(move |digit| (*digit, decade)))
            .filter(|(digit, decade)| inside(power(*digit, *decade)))
            .collect()
    };
    if decades >= 2 {
        let stride = decades.div_ceil(most).max(1);
        let labelled = |decade: i32| usize::try_from(decade - first).is_ok_and(|n| n.is_multiple_of(stride));
        let major = (first..=last)
            .filter(|decade| labelled(*decade))
            .map(|decade| Tick {
                value: power(1, decade),
                label: power_label(decade),
            })
            .collect();
        let minor = if stride == 1 {
            between(&[2, 3, 4, 5, 6, 7, 8, 9])
                .into_iter()
                .map(|(digit, decade)| power(digit, decade))
                .collect()
        } else {
            (first..=last)
                .filter(|decade| !labelled(*decade))
                .map(|decade| power(1, decade))
                .collect()
        };
        return Ticks {
            major,
            minor,
            step: None,
            exponent: 0,
        };
    }
    let all = between(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    let chosen = [
        all.clone(),
        between(&[1, 2, 3, 5]),
        between(&[1, 2, 5]),
        between(&[1, 3]),
    ]
    .into_iter()
    .find(|ticks| (2..=most).contains(&ticks.len()));
    let Some(chosen) = chosen else {
        return linear(low, high, most);
    };
    let major = chosen
        .iter()
        .map(|(digit, decade)| {
            let plain = (-3..4).contains(decade);
            let label = if plain {
                decimal(*digit, *decade)
            } else {
                format!("{digit}·{}", power_label(*decade))
            };
            Tick {
                value: power(*digit, *decade),
                label,
            }
        })
        .collect();
    let minor = all
        .iter()
        .filter(|tick| !chosen.contains(tick))
        .map(|(digit, decade)| power(*digit, *decade));
    Ticks {
        major,
        minor: minor.collect(),
        step: None,
        exponent: 0,
    }
}

fn power(digit: i64, decade: i32) -> f64 {
    Step {
        mantissa: digit,
        exponent: decade,
    }
    .value()
}

/// `10^{n}` in the markup of [`super::text`], drawn as a raised exponent.
pub(crate) fn power_label(exponent: i32) -> String {
    if exponent < 0 {
        format!("10^{{\u{2212}{}}}", exponent.unsigned_abs())
    } else {
        format!("10^{{{exponent}}}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn labels_are_the_shortest_that_tell_ticks_apart() {
        assert_eq!(
            labels(&linear(-1.05, 1.05, 5)),
            ["−1.0", "−0.5", "0.0", "0.5", "1.0"]
        );
        assert_eq!(labels(&linear(0.0, 10.0, 6)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(&linear(0.0, 0.35, 4)), ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(
            labels(&linear(0.0, 30_000.0, 4)),
            ["0", "10\u{2009}000", "20\u{2009}000", "30\u{2009}000"]
        );
    }

    #[test]
    fn long_labels_share_a_power_of_ten() {
        let newtons = linear(0.0, 2.4e6, 4);
        assert_eq!((labels(&newtons), newtons.exponent), (vec!["0", "1", "2"], 6));
        let small = linear(0.0, 4.2e-5, 5);
        assert_eq!(
            (labels(&small), small.exponent),
            (vec!["0", "10", "20", "30", "40"], -6)
        );
    }

    #[test]
    fn phase_ticks_are_multiples_of_45() {
        assert_eq!(
            labels(&degrees(-190.0, 10.0, 6)),
            ["−180", "−135", "−90", "−45", "0"]
        );
        assert_eq!(labels(&degrees(-190.0, 10.0, 4)), ["−180", "−90", "0"]);
        assert_eq!(labels(&degrees(-2000.0, 10.0, 4)), ["−1440", "−720", "0"]);
        assert_eq!(labels(&degrees(1.0, 9.0, 5)), ["2", "4", "6", "8"]);
    }

    #[test]
    fn decibel_ticks_prefer_factors_of_ten() {
        assert_eq!(labels(&decibels(-45.0, 45.0, 6)), ["−40", "−20", "0", "20", "40"]);
    }

    #[test]
    fn decades_are_powers_and_short_ranges_plain_numbers() {
        let wide = logarithmic(1e-2, 1e3, 8);
        assert_eq!(labels(&wide)[0], "10^{−2}");
        assert_eq!((wide.major.len(), wide.minor.len()), (6, 40));
        assert_eq!(labels(&logarithmic(0.8, 60.0, 5)), ["10^{0}", "10^{1}"]);
        assert_eq!(
            labels(&logarithmic(0.3, 6.0, 6)),
            ["0.3", "0.5", "1", "2", "3", "5"]
        );
        assert_eq!(labels(&logarithmic(0.3, 6.0, 4)), ["0.5", "1", "2", "5"]);
        assert_eq!(labels(&logarithmic(2.1, 2.9, 5)), ["2.2", "2.4", "2.6", "2.8"]);
        assert_eq!(logarithmic(1e-20, 1e20, 6).major.len(), 6);
    }

    #[test]
    fn regress_spans_beyond_doubles_end() {
        for (low, high) in [
            (0.0, 0.0),
            (1e300, 1e300),
            (-f64::MAX, f64::MAX),
            (5e-324, 1e-323),
        ] {
            assert!(linear(low, high, 5).major.len() <= 5);
            assert!(degrees(low, high, 5).major.len() <= 5);
        }
    }

    /// An interval anywhere on the number line, no shorter than doubles resolve.
    fn interval() -> impl Strategy<Value = (f64, f64)> {
        (-1.0..1.0f64, 1e-9..2.0f64, -200i32..200)
            .prop_map(|(low, span, e)| (low * 10f64.powi(e), (low + span) * 10f64.powi(e)))
    }

    proptest! {
        #[test]
        fn prop_linear_ticks_are_nice_complete_and_few((low, high) in interval(), most in 2usize..15) {
            let ticks = linear(low, high, most);
            let step = ticks.step.unwrap();
            prop_assert!([1, 2, 5].contains(&step.mantissa));
            prop_assert!(ticks.major.len() <= most);
            let slack = 1e-6 * step.value();
            for tick in &ticks.major {
                prop_assert!(tick.value >= low - slack && tick.value <= high + slack);
            }
            for pair in ticks.major.windows(2) {
                prop_assert!((pair[1].value - pair[0].value - step.value()).abs() < slack);
                prop_assert!(pair[0].label != pair[1].label);
            }
            // No tick is left out at either end.
            if let (Some(first), Some(last)) = (ticks.major.first(), ticks.major.last()) {
                prop_assert!(first.value - step.value() < low && last.value + step.value() > high);
            } else {
                prop_assert!(high - low < step.value());
            }
        }

        #[test]
        fn prop_labels_read_back_to_their_ticks((low, high) in interval(), most in 2usize..12) {
            let ticks = linear(low, high, most);
            for tick in &ticks.major {
                let ascii = tick.label.replace('\u{2212}', "-").replace('\u{2009}', "");
                let value: f64 = format!("{ascii}e{}", ticks.exponent).parse().unwrap();
                prop_assert!((value - tick.value).abs() <= 1e-12 * tick.value.abs());
            }
        }

        #[test]
        fn prop_enough_ticks_to_read_a_scale((low, high) in interval(), most in 5usize..15) {
            // The next finer 1-2-5 step is at most 2.5 times finer: of at most five, two always remain.
            prop_assert!(linear(low, high, most).major.len() >= 2);
        }

        #[test]
        fn prop_log_ticks_rise_inside_the_range(low in -30.0..30.0f64, span in 0.001..40.0f64, most in 3usize..12) {
            let (low, high) = (10f64.powf(low), 10f64.powf(low + span));
            let ticks = logarithmic(low, high, most);
            prop_assert!(ticks.major.len() <= most);
            prop_assert!(ticks.major.iter().all(|t| t.value >= low * 0.999 && t.value <= high * 1.001));
            prop_assert!(ticks.major.windows(2).all(|pair| pair[0].value < pair[1].value));
            prop_assert!(ticks.minor.iter().all(|v| *v >= low * 0.999 && *v <= high * 1.001));
        }
    }
}
