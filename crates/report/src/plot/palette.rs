//! Colours, dashes and markers: one look for every figure.
//!
//! Colours are those of Okabe and Ito (*Color Universal Design*, 2008), told apart by people with any of the
//! common colour deficiencies. Their order is chosen for print without colour: neighbours in the sequence
//! differ in lightness, and each comes with a dash pattern of its own.

/// An sRGB colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Colour(
    /// Red, green and blue, 0 to 255.
    pub [u8; 3],
);

impl Colour {
    /// Black.
    pub const BLACK: Self = Self([0x00, 0x00, 0x00]);
    /// Neutral grey for what stands in the background.
    pub const GREY: Self = Self([0x80, 0x80, 0x80]);
    /// Okabe and Ito's blue.
    pub const BLUE: Self = Self([0x00, 0x72, 0xB2]);
    /// Okabe and Ito's orange.
    pub const ORANGE: Self = Self([0xE6, 0x9F, 0x00]);
    /// Okabe and Ito's bluish green.
    pub const GREEN: Self = Self([0x00, 0x9E, 0x73]);
    /// Okabe and Ito's sky blue.
    pub const SKY: Self = Self([0x56, 0xB4, 0xE9]);
    /// Okabe and Ito's vermillion.
    pub const VERMILLION: Self = Self([0xD5, 0x5E, 0x00]);
    /// Okabe and Ito's reddish purple.
    pub const PURPLE: Self = Self([0xCC, 0x79, 0xA7]);

    /// The colour as `#rrggbb`.
    pub fn hex(self) -> String {
        let Self([red, green, blue]) = self;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Pattern of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dash and dot in turn.
    DashDot,
    /// Short dashes.
    ShortDashed,
    /// Dash and two dots in turn.
    DashDotDot,
    /// Dots.
    Dotted,
}

impl Dash {
    /// Lengths of dashes and gaps in pixels for a line of the given width.
    pub(crate) fn lengths(self, width: f64) -> Vec<f64> {
        let pattern: &[f64] = match self {
            Self::Solid => &[],
            Self::Dashed => &[5.0, 2.2],
            Self::DashDot => &[5.0, 1.8, 1.2, 1.8],
            Self::ShortDashed => &[2.6, 1.6],
            Self::DashDotDot => &[5.0, 1.6, 1.1, 1.6, 1.1, 1.6],
            Self::Dotted => &[1.1, 1.7],
        };
        pattern.iter().map(|length| length * width.max(1.0)).collect()
    }
}

/// Shape drawn at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Marker {
    /// Filled disc.
    Disc,
    /// Open circle.
    Circle,
    /// Open square.
    Square,
    /// Open triangle, tip up.
    Triangle,
    /// Open diamond.
    Diamond,
    /// Diagonal cross, the usual sign of a pole.
    Cross,
    /// Upright cross.
    Plus,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Colour of line and markers.
    pub colour: Colour,
    /// Pattern of the line; `None` draws markers alone.
    pub line: Option<Dash>,
    /// Width of the line in pixels.
    pub width: f64,
    /// Shape drawn at the points; where a line joins them and they lie close, at some of them.
    pub marker: Option<Marker>,
}

/// Colour, dash and marker of the models, in order.
const MODELS: [(Colour, Dash, Marker); 6] = [
    (Colour::BLUE, Dash::Solid, Marker::Circle),
    (Colour::ORANGE, Dash::Dashed, Marker::Square),
    (Colour::GREEN, Dash::DashDot, Marker::Triangle),
    (Colour::SKY, Dash::ShortDashed, Marker::Diamond),
    (Colour::VERMILLION, Dash::DashDotDot, Marker::Cross),
    (Colour::PURPLE, Dash::Dotted, Marker::Plus),
];

impl Style {
    /// What the others are measured against: black, solid, wide enough to show below them.
    pub fn reference() -> Self {
        Self {
            colour: Colour::BLACK,
            line: Some(Dash::Solid),
            width: 2.4,
            marker: None,
        }
    }

    /// An input or a figure quoted from elsewhere: grey, thinner.
    pub fn background() -> Self {
        Self {
            colour: Colour::GREY,
            line: Some(Dash::Solid),
            width: 1.6,
            marker: None,
        }
    }

    /// The i-th model (from zero). Six differ in colour and dash; the next six are thinner, and so on.
    pub fn model(i: usize) -> Self {
        let (colour, dash, _) = model(i);
        let width = if (i / MODELS.len()).is_multiple_of(2) {
            1.7
        } else {
            1.0
        };
        Self {
            colour,
            line: Some(dash),
            width,
            marker: None,
        }
    }

    /// The i-th model as markers without a line, for pole maps and measured points.
    pub fn points(i: usize) -> Self {
        let (colour, _, marker) = model(i);
        Self {
            colour,
            line: None,
            width: 1.5,
            marker: Some(marker),
        }
    }

    /// This style with a marker at the points.
    #[must_use]
    pub fn with_marker(mut self, marker: Marker) -> Self {
        self.marker = Some(marker);
        self
    }

    /// This style with another pattern of line.
    #[must_use]
    pub fn with_dash(mut self, dash: Dash) -> Self {
        self.line = Some(dash);
        self
    }

    /// This style with another width of line, in pixels.
    #[must_use]
    pub fn with_width(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// Width that can be drawn: neither invisible nor larger than the plot.
    pub(crate) fn drawn_width(&self) -> f64 {
        if self.width.is_finite() {
            self.width.clamp(0.2, 20.0)
        } else {
            1.7
        }
    }
}

fn model(i: usize) -> (Colour, Dash, Marker) {
    MODELS
        .get(i % MODELS.len())
        .copied()
        .unwrap_or((Colour::BLACK, Dash::Solid, Marker::Disc))
}

/// Path data of one marker around a point; `r` is half its size.
pub(crate) fn marker_path(marker: Marker, (x, y): (f64, f64), r: f64) -> String {
    use super::svg::coordinate as c;
    let polygon = |corners: &[(f64, f64)]| -> String {
        let points: Vec<String> = corners
            .iter()
            .map(|(dx, dy)| format!("{} {}", c(x + dx * r), c(y + dy * r)))
            .collect();
        format!("M{}Z", points.join("L"))
    };
    let stroke = |a: (f64, f64), b: (f64, f64)| {
        format!(
            "M{} {}L{} {}",
            c(x + a.0 * r),
            c(y + a.1 * r),
            c(x + b.0 * r),
            c(y + b.1 * r)
        )
    };
    match marker {
        Marker::Disc | Marker::Circle => {
            let (r, d) = (c(r), c(2.0 * r));
            format!(
                "M{} {}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z",
                c(x - r.parse().unwrap_or(0.0)),
                c(y)
            )
        }
        Marker::Square => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
        Marker::Triangle => polygon(&[(0.0, -1.15), (1.0, 0.75), (-1.0, 0.75)]),
        Marker::Diamond => polygon(&[(0.0, -1.25), (1.1, 0.0), (0.0, 1.25), (-1.1, 0.0)]),
        Marker::Cross => stroke((-0.9, -0.9), (0.9, 0.9)) + &stroke((-0.9, 0.9), (0.9, -0.9)),
        Marker::Plus => stroke((-1.15, 0.0), (1.15, 0.0)) + &stroke((0.0, -1.15), (0.0, 1.15)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE 1976 lightness L* of an sRGB colour (IEC 61966-2-1 and CIE 15).
    fn lightness(colour: Colour) -> f64 {
        let linear = |byte: u8| {
            let c = f64::from(byte) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        let [r, g, b] = colour.0.map(linear);
        116.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b).cbrt() - 16.0
    }

    #[test]
    fn neighbouring_models_differ_in_lightness_and_all_in_dash() {
        for pair in MODELS.windows(2) {
            let difference = (lightness(pair[0].0) - lightness(pair[1].0)).abs();
            // About 2.3 is just noticeable; the closest neighbours here are 6.8 apart.
            assert!(difference > 6.5, "{:?} {difference}", pair);
        }
        // Light enough to print, dark enough to be seen on white (L* = 100).
        assert!(MODELS.iter().all(|(colour, ..)| lightness(*colour) < 75.0));
        let dashes: std::collections::HashSet<Dash> = MODELS.iter().map(|(_, dash, _)| *dash).collect();
        assert_eq!(dashes.len(), MODELS.len());
    }

    #[test]
    fn styles_beyond_the_sixth_are_still_distinct() {
        assert_eq!(Style::model(6).colour, Style::model(0).colour);
        assert_ne!(Style::model(6), Style::model(0));
    }

    #[test]
    fn every_marker_has_a_path() {
        for (i, marker) in [Marker::Disc, Marker::Square, Marker::Plus]
            .into_iter()
            .enumerate()
        {
            assert!(marker_path(marker, (10.0 * i as f64, 5.0), 3.0).starts_with('M'));
        }
    }
}
