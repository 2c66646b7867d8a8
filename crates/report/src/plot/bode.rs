//! Bode diagrams: magnitude over phase, several systems in one, several channels side by side.

use super::Svg;
use super::axis::{Axis, Margin, Scale};
use super::palette::Style;
use super::panel::{Panel, Series};
use super::sheet::{LegendPlace, Sheet, Stack};
use crate::error::ReportError;

/// What is done with the phase before it is drawn. None of it changes the meaning: phases that differ by whole
/// turns are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum PhaseDisplay {
    /// Curves of a channel are shifted by whole turns: all of them so that the one that reaches the lowest
    /// frequency starts between -180 and 180 deg, and the others to lie as close as they can to it.
    #[default]
    Aligned,
    /// Drawn as given.
    AsGiven,
    /// Folded into -180 to 180 deg; the curve is broken where it jumps.
    Wrapped,
}

/// Frequency response of one system in one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct BodeCurve {
    /// Name in the legend.
    pub name: String,
    /// How it is drawn.
    pub style: Style,
    /// Frequencies in ascending order, in the unit of the plot's axis.
    pub frequency: Vec<f64>,
    /// Magnitude in decibels at each frequency.
    pub magnitude_db: Vec<f64>,
    /// Phase in degrees at each frequency, unwrapped if so wanted.
    pub phase_deg: Vec<f64>,
    /// Half widths of a shaded band at each frequency, in decibels and degrees; empty for none.
    pub band: Vec<(f64, f64)>,
}

/// One input-output pair with the responses of the systems compared.
#[derive(Debug, Clone, PartialEq)]
pub struct BodeChannel {
    /// Title above the diagram, such as `δ_{e} to a_{z}, cockpit`.
    pub title: String,
    /// What 0 dB stands for, such as `(m/s^{2})/rad`; empty to leave it out.
    pub magnitude_reference: String,
    /// Responses, from back to front.
    pub curves: Vec<BodeCurve>,
}

impl BodeChannel {
    /// A channel without curves.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            magnitude_reference: String::new(),
            curves: Vec::new(),
        }
    }

    /// This channel with the quantity that 0 dB stands for.
    #[must_use]
    pub fn with_reference(mut self, reference: impl Into<String>) -> Self {
        self.magnitude_reference = reference.into();
        self
    }

    /// This channel with another response in front.
    #[must_use]
    pub fn with(mut self, curve: BodeCurve) -> Self {
        self.curves.push(curve);
        self
    }

    /// The curve that reaches the lowest frequency, and the whole turns of its phase there.
    fn lowest(&self) -> Option<(&BodeCurve, f64)> {
        let start = |curve: &BodeCurve| {
            let points = curve
                .frequency
                .iter()
                .copied()
                .zip(curve.phase_deg.iter().copied());
            points
                .filter(|(_, phase)| phase.is_finite())
                .min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let starts = self
            .curves
            .iter()
            .filter_map(|curve| Some((curve, start(curve)?)));
        let (curve, (_, phase)) = starts.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        Some((curve, (phase / 360.0).round()))
    }

    fn stack(&self, frequency: &Axis, display: PhaseDisplay) -> Result<Stack, ReportError> {
        let unit = match self.magnitude_reference.as_str() {
            "" => "dB".to_owned(),
            reference => format!("dB re {reference}"),
        };
        let mut magnitude = Panel::over(Axis::new("Magnitude", unit).with_scale(Scale::Decibels));
        let mut phase = Panel::over(Axis::new("Phase", "deg").with_scale(Scale::Degrees)).with_height(120.0);
        let anchor = self.lowest();
        for curve in &self.curves {
            let plain = |y: Vec<f64>| Series::new(&*curve.name, curve.style, curve.frequency.clone(), y);
            let banded = |y: Vec<f64>, half: fn(&(f64, f64)) -> f64| {
                let ends = |(y, widths): (&f64, &(f64, f64))| (y - half(widths), y + half(widths));
                let band: Vec<(f64, f64)> = y.iter().zip(&curve.band).map(ends).collect();
                plain(y).with_band(band)
            };
            let series = |y: Vec<f64>| banded(y, |widths| widths.1);
            curve.check()?;
            magnitude
                .series
                .push(banded(curve.magnitude_db.clone(), |widths| widths.0));
            match (display, anchor) {
                (PhaseDisplay::Aligned, Some((anchor, start))) => {
                    let turns = 360.0 * (curve.turns_away_from(anchor) + start);
                    phase
                        .series
                        .push(series(curve.phase_deg.iter().map(|deg| deg - turns).collect()));
                }
                // A folded band would cover the whole diagram at every jump.
                (PhaseDisplay::Wrapped, _) => phase.series.push(wrapped(curve)),
                (PhaseDisplay::Aligned | PhaseDisplay::AsGiven, _) => {
                    phase.series.push(series(curve.phase_deg.clone()))
                }
            }
        }
        let panels = vec![magnitude, phase];
        Ok(Stack {
            title: self.title.clone(),
            x: frequency.clone(),
            panels,
            margin: Margin::Snug,
        })
    }
}

impl BodeCurve {
    /// A frequency response.
    pub fn new(
        name: impl Into<String>,
        style: Style,
        frequency: impl Into<Vec<f64>>,
        magnitude_db: impl Into<Vec<f64>>,
        phase_deg: impl Into<Vec<f64>>,
    ) -> Self {
        Self {
            name: name.into(),
            style,
            frequency: frequency.into(),
            magnitude_db: magnitude_db.into(),
            phase_deg: phase_deg.into(),
            band: Vec::new(),
        }
    }

    /// This response with a shaded band of confidence: half widths in decibels and degrees at each frequency.
    #[must_use]
    pub fn with_band(mut self, half_widths: impl Into<Vec<(f64, f64)>>) -> Self {
        self.band = half_widths.into();
        self
    }

    fn check(&self) -> Result<(), ReportError> {
        let x = self.frequency.len();
        let lists = [
            ("magnitude", self.magnitude_db.len()),
            ("phase", self.phase_deg.len()),
            ("band", if self.band.is_empty() { x } else { self.band.len() }),
        ];
        match lists.into_iter().find(|(_, length)| *length != x) {
            Some((what, y)) => Err(ReportError::SeriesLength {
                series: self.name.clone(),
                what,
                x,
                y,
            }),
            None => Ok(()),
        }
    }

    /// Whole turns by which the phase lies above that of another curve, in the median over the frequencies
    /// that both cover.
    fn turns_away_from(&self, other: &Self) -> f64 {
        let mut differences: Vec<f64> = self
            .frequency
            .iter()
            .zip(&self.phase_deg)
            .filter_map(|(frequency, phase)| Some(phase - other.phase_at(*frequency)?))
            .filter(|difference| difference.is_finite())
            .collect();
        differences.sort_by(f64::total_cmp);
        differences
            .get(differences.len() / 2)
            .map_or(0.0, |median| (median / 360.0).round())
    }

    /// Phase at a frequency by the straight line between its neighbours, if they enclose it.
    fn phase_at(&self, frequency: f64) -> Option<f64> {
        let above = self.frequency.partition_point(|known| *known < frequency);
        let (f1, p1) = (self.frequency.get(above)?, self.phase_deg.get(above)?);
        if *f1 == frequency {
            return Some(*p1);
        }
        let (f0, p0) = (
            self.frequency.get(above.checked_sub(1)?)?,
            self.phase_deg.get(above - 1)?,
        );
        Some(p0 + (p1 - p0) * (frequency - f0) / (f1 - f0))
    }
}

/// The phase folded into -180 to 180 deg, with a gap wherever a curve would run across the whole diagram.
fn wrapped(curve: &BodeCurve) -> Series {
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (frequency, phase) in curve.frequency.iter().zip(&curve.phase_deg) {
        let folded = phase - 360.0 * (phase / 360.0).round();
        if y.last().is_some_and(|last| (folded - last).abs() > 180.0) {
            x.push(*frequency);
            y.push(f64::NAN);
        }
        x.push(*frequency);
        y.push(folded);
    }
    Series::new(&*curve.name, curve.style, x, y)
}

/// Bode diagrams of one or more channels, in a grid.
///
/// ```
/// use albatross_report::plot::{Axis, BodeChannel, BodeCurve, BodePlot, Style};
/// # fn main() -> Result<(), albatross_report::ReportError> {
/// // First-order lag 1/(1 + i w).
/// let w: Vec<f64> = (0..=80).map(|i| 10f64.powf(-2.0 + 0.05 * f64::from(i))).collect();
/// let db: Vec<f64> = w.iter().map(|w| -10.0 * (1.0 + w * w).log10()).collect();
/// let deg: Vec<f64> = w.iter().map(|w| -w.atan().to_degrees()).collect();
/// let channel = BodeChannel::new("u to y").with(BodeCurve::new("lag", Style::model(0), w, db, deg));
/// let svg = BodePlot::new("First-order lag", Axis::log("Frequency", "rad/s")).with(channel).render()?;
/// assert!(svg.notes.is_empty());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BodePlot {
    /// Title: the heading, and what a screen reader says.
    pub title: String,
    /// Description for those who do not see the plot.
    pub description: String,
    /// Frequency axis of every channel.
    pub frequency: Axis,
    /// Channels, row by row.
    pub channels: Vec<BodeChannel>,
    /// Channels side by side; two if there is more than one, if `None`.
    pub columns: Option<usize>,
    /// What is done with the phase.
    pub phase: PhaseDisplay,
    /// Width of the whole plot in pixels.
    pub width: f64,
    /// Whether the title is drawn as a heading.
    pub with_heading: bool,
    /// Where the legend stands.
    pub legend: LegendPlace,
}

impl BodePlot {
    /// A plot without channels, 800 px wide, over the frequency axis given (an [`Axis::log`], as a rule).
    pub fn new(title: impl Into<String>, frequency: Axis) -> Self {
        Self {
            title: title.into(),
            description: String::new(),
            frequency,
            channels: Vec::new(),
            columns: None,
            phase: PhaseDisplay::default(),
            width: 800.0,
            with_heading: true,
            legend: LegendPlace::default(),
        }
    }

    /// This plot with another channel.
    #[must_use]
    pub fn with(mut self, channel: BodeChannel) -> Self {
        self.channels.push(channel);
        self
    }

    /// This plot without the title drawn above it.
    #[must_use]
    pub fn without_heading(mut self) -> Self {
        self.with_heading = false;
        self
    }

    /// Draws the plot.
    ///
    /// # Errors
    /// [`ReportError`] if there is no channel, a curve has lists of different lengths, or limits or sizes
    /// cannot be drawn.
    pub fn render(&self) -> Result<Svg, ReportError> {
        self.sheet()?.render()
    }

    pub(crate) fn sheet(&self) -> Result<Sheet<'_>, ReportError> {
        let stacks: Result<Vec<Stack>, ReportError> = self
            .channels
            .iter()
            .map(|channel| channel.stack(&self.frequency, self.phase))
            .collect();
        Ok(Sheet {
            title: &self.title,
            description: &self.description,
            with_heading: self.with_heading,
            legend: self.legend,
            width: self.width,
            panel_height: if self.channels.len() > 1 { 150.0 } else { 220.0 },
            columns: self.columns.unwrap_or(2),
            stacks: stacks?,
            notes: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(phase_deg: &[f64]) -> BodeCurve {
        let frequency: Vec<f64> = (1..=phase_deg.len()).map(|i| i as f64).collect();
        BodeCurve::new(
            "c",
            Style::model(0),
            frequency,
            vec![0.0; phase_deg.len()],
            phase_deg,
        )
    }

    #[test]
    fn whole_turns_between_systems_are_taken_out() {
        let first = curve(&[-10.0, -90.0, -170.0]);
        assert_eq!(curve(&[352.0, 265.0, 180.0]).turns_away_from(&first), 1.0);
        assert_eq!(curve(&[-730.0, -810.0, -890.0]).turns_away_from(&first), -2.0);
        assert_eq!(curve(&[100.0, 20.0, -60.0]).turns_away_from(&first), 0.0);
        assert_eq!(curve(&[]).turns_away_from(&first), 0.0);
    }

    #[test]
    fn a_folded_phase_has_gaps_at_its_jumps() {
        let series = wrapped(&curve(&[-150.0, -200.0, -380.0]));
        assert_eq!(series.y.len(), 4);
        assert_eq!((series.y[0], series.y[2], series.y[3]), (-150.0, 160.0, -20.0));
        assert!(series.y[1].is_nan());
    }

    #[test]
    fn lists_of_different_lengths_are_named() {
        let mut bad = curve(&[0.0, 1.0]);
        bad.phase_deg.pop();
        let plot = BodePlot::new("B", Axis::log("f", "Hz")).with(BodeChannel::new("c").with(bad));
        assert_eq!(
            plot.render().unwrap_err().to_string(),
            "series `c`: 2 abscissae but 1 ordinates (phase); the lists must have one length"
        );
    }
}
