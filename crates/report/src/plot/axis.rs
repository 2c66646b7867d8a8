//! An axis as asked for, and as fitted to data and room.

use super::ticks::{self, Ticks, power_label};
use crate::error::ReportError;

/// Values beyond this have no place on a drawing and are treated as gaps.
pub(crate) const LARGEST: f64 = 1e300;

/// A range shorter than this part of its values is not resolved by doubles and drawn as a constant.
const UNRESOLVED: f64 = 1e-10;

/// How values are laid out along an axis and where its ticks stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Scale {
    /// Even, with ticks at 1, 2 or 5 times a power of ten.
    Linear,
    /// By decades. Values that are not positive have no place on it: they are left out with a note.
    Log,
    /// Even, with ticks at multiples of 45 (an angle in degrees).
    Degrees,
    /// Even, with ticks at multiples of 10, 20, 40, … (a level in decibels).
    Decibels,
}

/// An axis: what it shows and how.
///
/// In labels and units `_{…}` lowers and `^{…}` raises: `Axis::new("n_{z}", "m/s^{2}")`.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the quantity.
    pub label: String,
    /// Its unit; empty for none.
    pub unit: String,
    /// How values are laid out.
    pub scale: Scale,
    /// Limits; fitted to the data if `None`.
    pub limits: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis with limits fitted to the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            scale: Scale::Linear,
            limits: None,
        }
    }

    /// A logarithmic axis with limits fitted to the data.
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self::new(label, unit).with_scale(Scale::Log)
    }

    /// This axis with another scale.
    #[must_use]
    pub fn with_scale(mut self, scale: Scale) -> Self {
        self.scale = scale;
        self
    }

    /// This axis with prescribed limits; curves are cut off at them.
    #[must_use]
    pub fn with_limits(mut self, low: f64, high: f64) -> Self {
        self.limits = Some((low, high));
        self
    }

    /// Position of a value on the scale, or `None` where it has none.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        match self.scale {
            _ if value.is_nan() || value.abs() > LARGEST => None,
            Scale::Log => (value >= 1.0 / LARGEST).then(|| value.log10()),
            Scale::Linear | Scale::Degrees | Scale::Decibels => Some(value),
        }
    }

    /// Whether a value is left out because the axis is logarithmic.
    pub(crate) fn rejects(&self, value: f64) -> bool {
        self.scale == Scale::Log && value.is_finite() && self.place(value).is_none()
    }

    pub(crate) fn check(&self) -> Result<(), ReportError> {
        let Some((low, high)) = self.limits else {
            return Ok(());
        };
        match (self.place(low), self.place(high)) {
            (Some(a), Some(b)) if b - a > UNRESOLVED * a.abs().max(b.abs()) => Ok(()),
            _ => Err(ReportError::AxisLimits {
                axis: self.label.clone(),
                low,
                high,
            }),
        }
    }

    /// Label and unit, with the power of ten taken out of the tick labels: `Bending moment (10^{6} N m)`.
    pub(crate) fn title(&self, exponent: i32) -> String {
        let unit = match (exponent, self.unit.as_str()) {
            (0, unit) => unit.to_owned(),
            (exponent, "") => power_label(exponent),
            (exponent, unit) => format!("{} {unit}", power_label(exponent)),
        };
        // A label is broken before its unit rather than within.
        let unit = unit.replace(' ', "\u{A0}");
        match (self.label.as_str(), unit.as_str()) {
            (label, "") => label.to_owned(),
            ("", unit) => unit.to_owned(),
            (label, unit) => format!("{label} ({unit})"),
        }
    }
}

/// The smallest interval that holds all places given to it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Extent(Option<(f64, f64)>);

impl Extent {
    pub(crate) fn add(&mut self, place: f64) {
        self.0 = Some(
            self.0
                .map_or((place, place), |(low, high)| (low.min(place), high.max(place))),
        );
    }
}

/// How limits are set around data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Margin {
    /// None, except to a tick close by: the abscissa of curves.
    Snug,
    /// A little, so that curves keep clear of the frame.
    Airy,
}

/// An axis fitted to its data: an interval on the scale, and ticks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ruler {
    axis: Axis,
    low: f64,
    high: f64,
    pub(crate) ticks: Ticks,
}

impl Ruler {
    /// Fits limits and at most `most` labelled ticks.
    pub(crate) fn fit(axis: &Axis, extent: Extent, margin: Margin, most: usize) -> Self {
        let fixed = axis
            .limits
            .and_then(|(low, high)| Some((axis.place(low)?, axis.place(high)?)));
        let (low, high) = fixed.unwrap_or_else(|| around(axis.scale, extent, margin));
        let mut ruler = Self {
            axis: axis.clone(),
            low,
            high,
            ticks: make_ticks(axis.scale, low, high, most),
        };
        if fixed.is_none() && margin == Margin::Snug {
            ruler.reach_close_ticks(most);
        }
        ruler
    }

    /// Widens the limits to the next tick where it is within a fiftieth of the span (9.99 s become 10 s).
    fn reach_close_ticks(&mut self, most: usize) {
        let step = match (self.axis.scale, self.ticks.step) {
            (Scale::Log, _) => 1.0,
            (_, Some(step)) => step.value(),
            (_, None) => return,
        };
        let close = 0.02 * (self.high - self.low);
        let (below, above) = ((self.low / step).floor() * step, (self.high / step).ceil() * step);
        if self.low - below < close {
            self.low = below;
        }
        if above - self.high < close {
            self.high = above;
        }
        self.ticks = make_ticks(self.axis.scale, self.low, self.high, most);
    }

    /// Part of the axis from its low end at which a value stands; outside 0 to 1 beyond the limits.
    pub(crate) fn fraction(&self, value: f64) -> Option<f64> {
        self.axis
            .place(value)
            .map(|place| (place - self.low) / (self.high - self.low))
    }

    /// Whether a fraction lies between the limits, with a hair's breadth for rounding.
    pub(crate) fn holds(&self, value: f64) -> bool {
        self.fraction(value)
            .is_some_and(|part| (-1e-9..=1.0 + 1e-9).contains(&part))
    }

    pub(crate) fn title(&self) -> String {
        self.axis.title(self.ticks.exponent)
    }

    /// Fractions and labels of the major ticks.
    pub(crate) fn major(&self) -> Vec<(f64, &str)> {
        let ticks = self.ticks.major.iter();
        ticks
            .filter_map(|tick| Some((self.fraction(tick.value)?.clamp(0.0, 1.0), tick.label.as_str())))
            .collect()
    }

    /// Fractions of the minor ticks.
    pub(crate) fn minor(&self) -> Vec<f64> {
        self.ticks
            .minor
            .iter()
            .filter_map(|value| Some(self.fraction(*value)?.clamp(0.0, 1.0)))
            .collect()
    }

    /// Where zero stands, if inside the limits and worth a line of its own.
    pub(crate) fn zero(&self) -> Option<f64> {
        let inside = self.axis.scale != Scale::Log && self.low < 0.0 && self.high > 0.0;
        if inside { self.fraction(0.0) } else { None }
    }
}

fn make_ticks(scale: Scale, low: f64, high: f64, most: usize) -> Ticks {
    match scale {
        Scale::Linear => ticks::linear(low, high, most),
        Scale::Log => ticks::logarithmic(10f64.powf(low), 10f64.powf(high), most),
        Scale::Degrees => ticks::degrees(low, high, most),
        Scale::Decibels => ticks::decibels(low, high, most),
    }
}

/// Limits around data. Constant data stand in the middle of an interval in proportion to them.
fn around(scale: Scale, extent: Extent, margin: Margin) -> (f64, f64) {
    let Extent(Some((low, high))) = extent else {
        return (0.0, 1.0);
    };
    let (middle, half) = (0.5 * low + 0.5 * high, 0.5 * high - 0.5 * low);
    let size = low.abs().max(high.abs());
    let resolved = half > 0.5 * UNRESOLVED * size && half > 1.0 / LARGEST;
    let custom = match scale {
        Scale::Linear => 0.0,
        Scale::Log => 0.2,
        Scale::Degrees => 47.0,
        Scale::Decibels => 6.0,
    };
    let least = match custom {
        custom if custom > UNRESOLVED * size => custom,
        _ if resolved => 0.0,
        _ if size * LARGEST < 10.0 => 1.0,
        _ => 0.1 * size,
    };
    let room = match margin {
        Margin::Snug if resolved => 1.0,
        Margin::Snug | Margin::Airy => 1.06,
    };
    let half = (half * room).max(least);
    let (low, high) = (middle - half, middle + half);
    // Powers of ten that are doubles.
    if scale == Scale::Log {
        (low.max(-307.0), high.min(307.0))
    } else {
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(axis: &Axis, values: &[f64], margin: Margin) -> Ruler {
        let mut extent = Extent::default();
        values
            .iter()
            .filter_map(|value| axis.place(*value))
            .for_each(|place| extent.add(place));
        Ruler::fit(axis, extent, margin, 6)
    }

    #[test]
    fn an_almost_round_end_is_reached() {
        let ruler = fitted(&Axis::new("t", "s"), &[0.0, 9.99], Margin::Snug);
        assert_eq!((ruler.low, ruler.high), (0.0, 10.0));
        let log = fitted(&Axis::log("f", "Hz"), &[0.0101, 99.0], Margin::Snug);
        assert_eq!((log.low, log.high), (-2.0, 2.0));
    }

    #[test]
    fn constants_and_nothing_get_an_interval_of_their_own() {
        let axis = Axis::new("x", "");
        for values in [
            &[][..],
            &[0.0],
            &[5.0, 5.0],
            &[1e-310],
            &[1e300, -1e300],
            &[232.7, 232.7 + 1e-12],
        ] {
            let ruler = fitted(&axis, values, Margin::Airy);
            assert!(ruler.high > ruler.low && ruler.high.is_finite(), "{values:?}");
            assert!(ruler.ticks.major.len() >= 2, "{values:?}: {:?}", ruler.ticks);
        }
    }

    #[test]
    fn a_logarithmic_axis_holds_all_but_the_last_doubles() {
        let ruler = fitted(&Axis::log("x", ""), &[1e-300, 1e300], Margin::Airy);
        assert_eq!((ruler.low, ruler.high), (-307.0, 307.0));
        assert!(ruler.ticks.major.len() >= 2);
    }

    #[test]
    fn a_steady_phase_has_multiples_of_45_beside_it() {
        let ruler = fitted(
            &Axis::new("Phase", "deg").with_scale(Scale::Degrees),
            &[-180.0],
            Margin::Airy,
        );
        let values: Vec<f64> = ruler.ticks.major.iter().map(|tick| tick.value).collect();
        assert_eq!(values, [-225.0, -180.0, -135.0]);
    }

    #[test]
    fn powers_of_ten_move_into_the_unit() {
        let ruler = fitted(&Axis::new("M_{x}", "N m"), &[0.0, 2.4e6], Margin::Airy);
        assert_eq!(ruler.title(), "M_{x} (10^{6}\u{A0}N\u{A0}m)");
        assert_eq!(Axis::new("n_{z}", "").title(-3), "n_{z} (10^{\u{2212}3})");
    }

    #[test]
    fn limits_that_span_nothing_are_refused() {
        for (axis, low, high) in [
            (Axis::new("x", ""), 1.0, 1.0),
            (Axis::new("x", ""), f64::NAN, 1.0),
            (Axis::log("x", ""), 0.0, 1.0),
            (Axis::new("x", ""), 2.0, 1.0),
        ] {
            let error = axis.with_limits(low, high).check().unwrap_err();
            assert!(matches!(error, ReportError::AxisLimits { .. }));
        }
        assert!(Axis::log("x", "").with_limits(0.1, 10.0).check().is_ok());
    }
}
